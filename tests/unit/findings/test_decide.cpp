// Decisions on made-up samples, held against tables of Student's distribution and against repeated draws.
#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <vector>

#include "feldspar/findings/decide.hpp"

namespace feldspar {
namespace {

using Kind = MeanLimit::Kind;

MeanInterval of(int count, double mean, double standard_deviation) {
    const double half = student_quantile(count - 1) * standard_deviation / std::sqrt(static_cast<double>(count));
    return {count, mean, standard_deviation, mean - half, mean + half};
}

TEST(Decide, ChancesAreThoseOfStudentsTables) {
    // t = 2.776445 with 4 degrees of freedom: 2.5 % on one side
    const MeanInterval i = of(5, -2.776445, std::sqrt(5.0));
    EXPECT_NEAR(chance_of_no(i, {Kind::above, 0.0}), 0.025, 1e-6);
    EXPECT_NEAR(chance_of_no(i, {Kind::below, 0.0}), 0.975, 1e-6);
    // t = 2.131847: 5 %
    EXPECT_NEAR(chance_of_no(of(5, 1.0 + 2.131847, std::sqrt(5.0)), {Kind::inside, 1.0}), 0.05, 1e-6);
    EXPECT_NEAR(chance_of_no(of(5, 0.0, std::sqrt(5.0)), {Kind::outside, 2.131847}), 0.05, 1e-6);
    EXPECT_EQ(chance_of_no(of(5, 1.0, 0.0), {Kind::below, 0.0}), 0.0) << "no scatter";
    EXPECT_EQ(chance_of_no({1, 1.0, std::nan(""), std::nan(""), std::nan("")}, {Kind::below, 0.0}), 1.0)
        << "one value says nothing";
}

TEST(Decide, ANoIsFoundWhereItsChanceIsBelowTwoAndAHalfPerCent) {
    for (const Kind kind : {Kind::above, Kind::below, Kind::inside, Kind::outside})
        for (double mean = -3.0; mean <= 3.0; mean += 0.05) {
            const MeanInterval i = of(6, mean, 0.7);
            const MeanLimit target{kind, 1.0};
            EXPECT_EQ(decide(i, target) == Decision::no, chance_of_no(i, target) < 0.025) << mean;
        }
}

TEST(Decide, HolmsProcedureGoesFromTheSmallestOn) {
    const std::vector<double> chances{0.02, 0.001, 0.012, 0.3};  // against 0.05/4, 0.05/3, 0.05/2, 0.05
    EXPECT_EQ(hold_together(chances, 0.05), (std::vector<bool>{true, true, true, false}));
    EXPECT_EQ(hold_together(chances, 0.03), (std::vector<bool>{false, true, false, false})) << "0.012 > 0.03/3 ends it";
    EXPECT_EQ(hold_together(std::vector<double>{0.024}, 0.025), std::vector<bool>{true}) << "one by itself is as ever";
    EXPECT_TRUE(hold_together({}, 0.05).empty());
}

TEST(Decide, NothingIsAnIntervalOfNinetyPerCentInside) {
    const double half = 2.132 * 1.0 / std::sqrt(5.0);  // of 90 %, 4 degrees of freedom
    EXPECT_TRUE(is_nothing(of(5, 0.1, 1.0), half + 0.1 + 1e-3));
    EXPECT_FALSE(is_nothing(of(5, 0.1, 1.0), half + 0.1 - 1e-3));
    EXPECT_FALSE(is_nothing(of(5, 0.0, 1.0), std::nan(""))) << "not looked for";
}

// The promise of packings_to_decide: with so many, four of five draws decide, and with half as many clearly fewer.
TEST(Decide, SoManyPackingsDecideInFourOfFiveCases) {
    boost::random::mt19937 random(7);
    boost::random::normal_distribution<double> normal(0.0, 1.0);
    const auto share_that_decides = [&](double mean, int count, double size) {
        int decided = 0;
        const int draws = 2000;
        for (int d = 0; d < draws; ++d) {
            std::vector<double> values;
            for (int v = 0; v < count; ++v) values.push_back(mean + normal(random));
            const MeanInterval i = mean_interval(values);
            decided += decide(i, {Kind::above, 0.0}) == Decision::yes || is_nothing(i, size) ? 1 : 0;
        }
        return static_cast<double>(decided) / draws;
    };
    const double none = std::nan("");
    const auto needed = packings_to_decide(of(5, 0.5, 1.0), {Kind::above, 0.0}, none);
    ASSERT_TRUE(needed);
    EXPECT_NEAR(*needed, 34, 1) << "of tables of the t test: effect 0.5, power 0.8";
    EXPECT_NEAR(share_that_decides(0.5, *needed, none), 0.8, 0.03) << "three standard errors of 2000 draws";
    EXPECT_LT(share_that_decides(0.5, *needed / 2, none), 0.6);
    const auto nothing =
        packings_to_decide(of(5, 0.0, 1.0), {Kind::above, 0.0}, 0.5);  // a true zero, half of the scatter is nothing
    ASSERT_TRUE(nothing);
    EXPECT_GT(share_that_decides(0.0, *nothing, 0.5), 0.55) << "a mean of zero must miss neither of both limits";
    EXPECT_FALSE(packings_to_decide(of(5, 1e-6, 1.0), {Kind::above, 0.0}, none)) << "more than can be asked for";
}

}  // namespace
}  // namespace feldspar
