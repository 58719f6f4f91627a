// Small helpers with numbers.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "feldspar/base/angle.hpp"
#include "feldspar/base/counted.hpp"
#include "feldspar/base/mean.hpp"
#include "feldspar/base/median.hpp"
#include "feldspar/base/stopwatch.hpp"

namespace feldspar {
namespace {

TEST(Angle, DegreesAndRadians) {
    EXPECT_EQ(in_degrees(std::numbers::pi), 180.0);
    EXPECT_EQ(in_radians(180.0), std::numbers::pi);
    EXPECT_DOUBLE_EQ(in_radians(in_degrees(0.3)), 0.3);
}

TEST(Counted, OneThingAndSeveral) {
    EXPECT_EQ(counted(1, "packing"), "1 packing");
    EXPECT_EQ(counted(0, "packing"), "0 packings");
    EXPECT_EQ(counted(std::size_t{12}, "finished test"), "12 finished tests");
}

TEST(Mean, IsTheSumInOrderOverTheCount) {
    EXPECT_EQ(mean_of(std::vector{1.0, 2.0, 6.0}), 3.0);
    EXPECT_EQ(mean_of(std::vector{1e16, 1.0, -1e16, 1.0}), 0.25);  // the first 1 is lost in that order
    EXPECT_TRUE(std::isnan(mean_of({})));
}

TEST(Median, IsTheMiddleOrTheMeanOfTheMiddleTwo) {
    EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
    EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 2.5);
    EXPECT_EQ(median({7.0}), 7.0);
}

TEST(Median, TheUpperOneIsOneOfTheValues) {
    for (const auto& [values, middle] :
         std::vector<std::pair<std::vector<double>, double>>{{{3.0, 1.0, 2.0}, 2.0}, {{4.0, 1.0, 3.0, 2.0}, 3.0}, {{7.0}, 7.0}}) {
        std::vector<double> own = values;
        EXPECT_EQ(upper_median(own), middle);
    }
}

TEST(Stopwatch, RunsForwardInSeconds) {
    const auto start = std::chrono::steady_clock::now() - std::chrono::minutes(2);
    EXPECT_GE(seconds_since(start), 120.0);
    EXPECT_LT(seconds_since(start), 7200.0);
}

}  // namespace
}  // namespace feldspar
