// Segments that cross, touch, or keep apart.
#include <gtest/gtest.h>

#include <cmath>

#include "feldspar/geometry/segments.hpp"

namespace feldspar {
namespace {

TEST(Segments, CrossInAPointInsideBoth) {
    EXPECT_TRUE(segments_cross({0, 0}, {4, 2}, {1, 2}, {2, -1}));
    EXPECT_TRUE(segments_cross({4, 2}, {0, 0}, {1, 2}, {2, -1})) << "whichever way they go";
    EXPECT_FALSE(segments_cross({0, 0}, {4, 2}, {1, 2}, {1.5, 1})) << "the second ends before the first";
    EXPECT_FALSE(segments_cross({0, 0}, {0.5, 0.25}, {1, 2}, {2, -1})) << "the first ends before the second";
    EXPECT_FALSE(segments_cross({0, 0}, {4, 0}, {2, 0}, {2, 3})) << "touches with an end";
    EXPECT_FALSE(segments_cross({0, 0}, {4, 0}, {1, 0}, {6, 0})) << "on one line";
}

TEST(Segments, DistanceIsThatOfTheirNearestPoints) {
    EXPECT_EQ(distance_between_segments({0, 0}, {4, 2}, {1, 2}, {2, -1}), 0.0);
    EXPECT_EQ(distance_between_segments({0, 0}, {4, 0}, {2, 0}, {2, 3}), 0.0);
    EXPECT_DOUBLE_EQ(distance_between_segments({0, 0}, {4, 0}, {2, 0.5}, {2, 3}), 0.5) << "an end against a side";
    EXPECT_DOUBLE_EQ(distance_between_segments({2, 0.5}, {2, 3}, {0, 0}, {4, 0}), 0.5);
    EXPECT_DOUBLE_EQ(distance_between_segments({0, 0}, {1, 0}, {4, 4}, {9, 4}), 5.0) << "two ends";
    EXPECT_DOUBLE_EQ(distance_between_segments({0, 0}, {4, 0}, {-3, 1}, {7, 1}), 1.0) << "side by side";
    EXPECT_DOUBLE_EQ(distance_between_segments({0, 0}, {4, 0}, {5, 0}, {9, 0}), 1.0) << "on one line";
}

}  // namespace
}  // namespace feldspar
