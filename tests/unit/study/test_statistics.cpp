// Means and intervals against tabulated values of Student's distribution.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "feldspar/study/statistics.hpp"

namespace feldspar {
namespace {

TEST(Statistics, IntervalOfAMeanFollowsStudent) {
    // standard deviation 1, n = 5: t(0.975, 4) = 2.776445 / sqrt(5)
    const std::array values{10.0 - std::sqrt(2.0), 10.0, 10.0, 10.0, 10.0 + std::sqrt(2.0)};
    const MeanInterval interval = mean_interval(values);
    EXPECT_EQ(interval.count, 5);
    EXPECT_DOUBLE_EQ(interval.mean, 10.0);
    EXPECT_NEAR(interval.standard_deviation, 1.0, 1e-14);
    EXPECT_NEAR(interval.half_width(), 2.7764451 / std::sqrt(5.0), 1e-7);  // seven digits of the table
    EXPECT_NEAR(interval.low, 10.0 - interval.half_width(), 1e-14);
}

TEST(Statistics, FewValuesSayLittle) {
    EXPECT_TRUE(std::isnan(mean_interval({}).mean));
    const std::array one{3.0};
    EXPECT_EQ(mean_interval(one).mean, 3.0);
    EXPECT_TRUE(std::isnan(mean_interval(one).low));
}

TEST(Statistics, PairsAreOfTheSamePacking) {
    PropertyStatistics first, second;
    first.seeds = {1, 2, 4};
    first.values = {10.0, 20.0, 40.0};
    second.seeds = {4, 2, 3};
    second.values = {400.0, 200.0, 300.0};
    const PairedValues pairs = paired(first, second);
    EXPECT_EQ(pairs.seeds, (std::vector<std::uint64_t>{2, 4}));
    EXPECT_EQ(pairs.first, (std::vector<double>{20.0, 40.0}));
    EXPECT_EQ(pairs.second, (std::vector<double>{200.0, 400.0}));
}

}  // namespace
}  // namespace feldspar
