// The surrogate: what it recovers, how sure it is, and what packings in common are worth.
#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>

#include "feldspar/calibration/gaussian_process.hpp"
#include "feldspar/calibration/search.hpp"

namespace feldspar {
namespace {

double smooth(const std::vector<double>& x) {
    return 2.0 + 1.5 * x[0] - 0.8 * x[1] + 0.6 * x[0] * x[1] + 0.2 * std::sin(3.0 * x[1]);
}

TEST(GaussianProcess, RecoversASmoothFunction) {
    std::vector<Observation> seen;
    for (const auto& x : evenly(2, 40)) seen.push_back({x, seen.size() % 4, smooth(x)});
    const GaussianProcess process(seen);
    double largest = 0.0;
    for (const auto& x : evenly(2, 50, 100)) {
        const Belief belief = process.at(x);
        largest = std::max(largest, std::abs(belief.mean - smooth(x)));
        EXPECT_LT(std::abs(belief.mean - smooth(x)), 5.0 * std::sqrt(belief.variance) + 1e-3);
    }
    EXPECT_LT(largest, 0.02);  // a percent of the function's range
    EXPECT_LT(process.noise_variance(), 1e-3);
    EXPECT_LT(process.packing_variance(), 1e-3);
}

TEST(GaussianProcess, AStraightLineIsFollowedBeyondWhatWasSeen) {
    std::vector<Observation> seen;
    for (int i = 0; i < 8; ++i) seen.push_back({{0.05 * i}, 0, 1.0 + 2.0 * 0.05 * i});
    const Belief belief = GaussianProcess(seen).at({1.0});
    EXPECT_NEAR(belief.mean, 3.0, 0.1);
    EXPECT_GT(belief.variance, GaussianProcess(seen).at({0.2}).variance);
}

TEST(GaussianProcess, TellsPackingsFromNoise) {
    boost::random::mt19937_64 engine(3);
    boost::random::normal_distribution<double> normal;
    std::vector<double> packing(6);
    for (double& effect : packing) effect = 0.3 * normal(engine);
    std::vector<Observation> seen;
    for (const auto& x : evenly(2, 90)) {
        const std::uint64_t seed = seen.size() % packing.size();
        seen.push_back({x, seed, smooth(x) + packing[seed] + 0.02 * normal(engine)});
    }
    const GaussianProcess process(seen);
    EXPECT_NEAR(std::sqrt(process.noise_variance()), 0.02, 0.02);
    EXPECT_GT(std::sqrt(process.packing_variance()), 0.1);
    // the difference of two points is known far better than the level, which so few packings leave open
    const double difference = process.at({0.8, 0.5}).mean - process.at({0.2, 0.5}).mean;
    EXPECT_NEAR(difference, smooth({0.8, 0.5}) - smooth({0.2, 0.5}), 0.03);
    const double level_deviation = std::sqrt(process.at({0.5, 0.5}).variance);
    EXPECT_GT(level_deviation, 0.05);
    EXPECT_LT(std::abs(process.at({0.5, 0.5}).mean - smooth({0.5, 0.5})), 3.0 * level_deviation);
}

TEST(GaussianProcess, BelievingMakesSureWithoutMovingTheMean) {
    std::vector<Observation> seen;
    for (const auto& x : evenly(1, 4)) seen.push_back({x, seen.size(), 1.0 + x[0] * x[0]});
    GaussianProcess process(seen);
    const Belief before = process.at({0.95});
    process.believe({0.95});
    const Belief after = process.at({0.95});
    EXPECT_LT(after.variance, before.variance);
    EXPECT_NEAR(after.mean, before.mean, 1e-6 * std::abs(before.mean));
}

TEST(GaussianProcess, OneObservationAndEqualOnesAreEnough) {
    EXPECT_NEAR(GaussianProcess({{{0.5}, 1, 7.0}}).at({0.5}).mean, 7.0, 1e-9);
    EXPECT_NEAR(GaussianProcess({{{0.2}, 1, 7.0}, {{0.8}, 1, 7.0}, {{0.5}, 2, 7.0}}).at({0.4}).mean, 7.0, 1e-6);
}

TEST(Search, PointsFillTheCubeEvenly) {
    const auto points = evenly(3, 64);
    for (int axis = 0; axis < 3; ++axis) {
        int lower = 0;
        for (const auto& x : points) {
            EXPECT_GT(x[axis], 0.0);
            EXPECT_LT(x[axis], 1.0);
            lower += x[axis] < 0.5;
        }
        EXPECT_NEAR(lower, 32, 2);  // a Sobol sequence is balanced but for its first point
    }
}

// Known all over, and met: what a run could still show lies where the target is met, not at whatever candidate comes first.
TEST(Search, RunsAreMadeOnlyWhereTheyPromiseSomething) {
    const Observable strength{"UCS", methods::uniaxial_compression, 0.0, "strength_Pa"};
    const auto truth = [](const std::vector<double>& x) {
        return 1e8 * std::exp(2.0 * x[0] - x[1] + 0.3 * std::sin(5.0 * x[1]));
    };
    Target target;
    target.name = "UCS";
    target.value = truth({0.4, 0.6});
    target.tolerance = 0.03 * target.value;
    Learner learner({strength}, {target});
    std::uint64_t seed = 0;
    for (const auto& x : evenly(2, 60, 1)) {
        learner.observe(0, x, ++seed % 6, {truth(x)});
        learner.observe(0, x, ++seed % 6, {1.02 * truth(x)});
    }
    ASSERT_TRUE(learner.learn());
    for (std::size_t round = 0; round < 4; ++round)
        for (const auto& x : promising_points(learner, 2, 3, round))
            EXPECT_NEAR(truth(x), target.value, 4.0 * target.tolerance) << round;
}

// What ended at a bound is taken for what the rest says, and for the bound where the rest says less.
TEST(Learner, BoundsHoldWhatIsLearnedUpAndNotDown) {
    const Observable strength{"UCS", methods::uniaxial_compression, 0.0, strength_column};
    const auto truth = [](double x) { return 1e8 * std::exp(2.0 * x); };
    Learner above({strength}, {Target{"UCS", 0.0, 1e8, 1e6}}), below = above;
    for (int i = 0; i < 8; ++i) {
        const double x = 0.08 * i;
        above.observe(0, {x}, static_cast<std::uint64_t>(i % 4), {truth(x)});
        below.observe(0, {x}, static_cast<std::uint64_t>(i % 4), {1e8});
    }
    for (const double x : {0.8, 0.9, 1.0}) {
        above.observe(0, {x}, 1, {2e8, Says::at_least});  // the truth is 5 to 7 e8
        below.observe(0, {x}, 1, {2e8, Says::at_least});  // the rest would say 1e8
    }
    ASSERT_TRUE(above.learn());
    ASSERT_TRUE(below.learn());
    EXPECT_NEAR(std::log(above.beliefs({1.0})[0].mean / truth(1.0)), 0.0, 0.1);
    EXPECT_GT(below.beliefs({0.9})[0].mean, 1.9e8);
    EXPECT_NEAR(below.beliefs({0.2})[0].mean, 1e8, 0.05e8);
    Learner bounds_alone({strength}, {Target{"UCS", 0.0, 1e8, 1e6}});
    EXPECT_FALSE(bounds_alone.learn());
    bounds_alone.observe(0, {0.5}, 1, {2e8, Says::at_least});
    EXPECT_TRUE(bounds_alone.learn());
}

// Two sets are predicted to meet the target; the one that was seen often is the answer.
TEST(Search, OfEquallyGoodSetsTheBestKnownIsChosen) {
    const Observable strength{"UCS", methods::uniaxial_compression, 0.0, "strength_Pa"};
    Target target;
    target.name = "UCS";
    target.value = 1e8;
    target.tolerance = 0.02e8;
    Learner learner({strength}, {target});
    const auto truth = [](double x) { return 1e8 * std::exp(8.0 * (x - 0.2) * (x - 0.8)); };  // met at 0.2 and at 0.8
    for (int i = 0; i < 12; ++i)
        learner.observe(0, {0.5 * i / 11.0}, static_cast<std::uint64_t>(i % 4),
                        {truth(0.5 * i / 11.0) * (1.0 + 0.01 * (i % 3 - 1))});
    for (int i = 0; i < 12; ++i)
        learner.observe(0, {0.2}, static_cast<std::uint64_t>(i % 4), {truth(0.2) * (1.0 + 0.01 * (i % 3 - 1))});
    learner.observe(0, {0.95}, 1, {truth(0.95)});
    ASSERT_TRUE(learner.learn());
    EXPECT_NEAR(best_point(learner, 1, {0.8})[0], 0.2, 0.03);
}

}  // namespace
}  // namespace feldspar
