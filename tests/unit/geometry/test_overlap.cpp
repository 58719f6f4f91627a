// Areas that polygons share.
#include <gtest/gtest.h>

#include <vector>

#include "feldspar/geometry/overlap.hpp"

namespace feldspar {
namespace {

const std::vector<Vec2> square{{0, 0}, {2, 0}, {2, 2}, {0, 2}};

TEST(Overlap, IsTheSharedArea) {
    EXPECT_DOUBLE_EQ(overlap_area(square, square), 4.0);
    EXPECT_DOUBLE_EQ(overlap_area(std::vector<Vec2>{{1, 1}, {3, 1}, {3, 3}, {1, 3}}, square), 1.0);
    EXPECT_DOUBLE_EQ(overlap_area(std::vector<Vec2>{{5, 5}, {6, 5}, {6, 6}}, square), 0.0);
    EXPECT_DOUBLE_EQ(overlap_area(square, std::vector<Vec2>{{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}), 4.0);
    EXPECT_NEAR(overlap_area(std::vector<Vec2>{{1, 1}, {4, 1}, {1, 4}}, square), 1.0,
                1e-12);  // a triangle whose corner is the square's quarter
}

TEST(Overlap, OfAPolygonThatFallsApartIsThatOfItsPieces) {
    const std::vector<Vec2> fork{{0, 0}, {3, 0}, {3, 4}, {2, 4}, {2, 1}, {1, 1}, {1, 4}, {0, 4}};  // two prongs a unit wide
    EXPECT_NEAR(overlap_area(fork, std::vector<Vec2>{{-1, 2}, {5, 2}, {5, 3}, {-1, 3}}), 2.0, 1e-12);
}

}  // namespace
}  // namespace feldspar
