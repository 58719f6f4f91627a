// Changes between points: by packing, between means, and what stands when many are looked at.
#include <gtest/gtest.h>

#include "feldspar/findings/comparison.hpp"
#include "synthetic_points.hpp"

namespace feldspar {
namespace {

TEST(Comparison, ChangesByPackingDoNotFeelWhatPackingsShare) {
    // packings differ by tens of per cent, every one of them grows by 2 % +- 1
    const Change change = change_by_packing(statistics_from({100, 150, 200}), statistics_from({101, 153, 206}));
    EXPECT_TRUE(change.by_packing);
    EXPECT_EQ(change.count, 3);
    EXPECT_NEAR(change.mean, 0.02, 1e-12);
    EXPECT_NEAR(change.deviation, 0.01, 1e-12);
    EXPECT_NEAR(change.high, 0.02 + 4.302652729749 * 0.01 / std::sqrt(3.0), 1e-9);
    EXPECT_NEAR(change.chance, 0.0742, 1e-4);  // t = 3.4641 with 2 degrees of freedom
}

TEST(Comparison, OnlyPackingsThatBothHaveCount) {
    const Change change = change_by_packing(statistics_from({100, 110}, 1), statistics_from({121, 130}, 2));
    EXPECT_EQ(change.count, 1);
    EXPECT_NEAR(change.mean, 0.1, 1e-12);
    EXPECT_TRUE(std::isnan(change.low));
}

TEST(Comparison, WelchOfTwoKnownSamples) {
    // means 20 and 22, variances 4 and 16, n = 3 and 4: standard error sqrt(4/3 + 4) = 2.3094, 4.5714 degrees of freedom
    const Change change = change_between_means(statistics_from({18, 20, 22}),
                                               statistics_from({22 - std::sqrt(24.0), 22, 22, 22 + std::sqrt(24.0)}));
    EXPECT_FALSE(change.by_packing);
    EXPECT_EQ(change.count, 3);
    EXPECT_NEAR(change.mean, 0.1, 1e-12);
    EXPECT_NEAR(change.high - change.mean, 2.6448 * 2.3094 / 20.0, 1e-4);
}

TEST(Comparison, EqualPackingsAreEqual) {
    const Change same = change_by_packing(statistics_from({1, 2}), statistics_from({1, 2}));
    EXPECT_EQ(same.low, 0.0);
    EXPECT_EQ(same.high, 0.0);
    EXPECT_EQ(same.chance, 1.0);
    const Change none = change_between_means(statistics_from({}), statistics_from({1, 2}));
    EXPECT_EQ(none.count, 0);
    EXPECT_TRUE(std::isnan(none.mean));
}

TEST(Comparison, HowManyPackingsWouldDo) {
    // t(9) 0.10 / sqrt(10) = 0.0715, t(10) 0.10 / sqrt(11) = 0.0672
    EXPECT_EQ(packings_for_mean(0.10, 0.07), 11);
    EXPECT_EQ(packings_for_mean(0.0, 0.01), 2);
    Change change;
    change.deviation = 0.10;
    change.by_packing = true;
    EXPECT_EQ(packings_for_change(change, 0.07), 11);
    change.by_packing = false;
    EXPECT_GT(packings_for_change(change, 0.07), 11);  // two means scatter more than one
    EXPECT_EQ(packings_for_change(change, 0.0), 100000);
}

TEST(Comparison, HolmKeepsWhatStandsBesideTheOthers) {
    const double nan = std::nan("");
    EXPECT_EQ(stand_together(std::vector{0.04}), (std::vector{true}));
    EXPECT_EQ(stand_together(std::vector{0.04, 0.5, 0.6}), (std::vector{false, false, false}));
    EXPECT_EQ(stand_together(std::vector{0.5, nan, 0.001, 0.02}), (std::vector{false, false, true, true}));
}

TEST(Comparison, SubsamplesOfAllSizes) {
    const std::vector<Subsample> found = subsamples(std::vector{90.0, 100.0, 110.0});
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].count, 2);
    EXPECT_NEAR(found[0].lowest, 0.95, 1e-12);
    EXPECT_NEAR(found[0].highest, 1.05, 1e-12);
    EXPECT_NEAR(found[1].half_width, 4.302652729749 * 0.1 / std::sqrt(3.0), 1e-9);
    EXPECT_EQ(found[1].lowest, found[1].highest);
    std::vector<double> many;
    for (int i = 0; i < 40; ++i) many.push_back(100.0 + i % 7);
    const std::vector<Subsample> of_many = subsamples(many);
    ASSERT_EQ(of_many.size(), 39u);
    EXPECT_GT(of_many.front().half_width, of_many.back().half_width);
    EXPECT_TRUE(subsamples(std::vector{1.0}).empty());
}

}  // namespace
}  // namespace feldspar
