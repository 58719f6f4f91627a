// Polygons against closed forms.
#include <gtest/gtest.h>

#include <vector>

#include "feldspar/geometry/polygon.hpp"

namespace feldspar {
namespace {

const std::vector<Vec2> unit_square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
const std::vector<Vec2> ell = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};

TEST(Polygon, AreaIsSignedByOrientation) {
    EXPECT_DOUBLE_EQ(signed_area(unit_square), 1.0);
    EXPECT_DOUBLE_EQ(signed_area(ell), 3.0);
    EXPECT_DOUBLE_EQ(signed_area(std::vector<Vec2>(ell.rbegin(), ell.rend())), -3.0);
    EXPECT_EQ(signed_area(std::vector<Vec2>{{0, 0}, {1, 1}}), 0.0);
}

TEST(Polygon, SmallPolygonFarAwayKeepsItsArea) {
    std::vector<Vec2> far = unit_square;
    for (Vec2& v : far) v = 1e-3 * v + Vec2{1000.0, 1000.0};
    EXPECT_NEAR(signed_area(far), 1e-6, 1e-15);
}

TEST(Polygon, CentroidOfTheAreaNotOfTheVertices) {
    const Vec2 c = centroid(ell);  // squares of area 2 x 1 and 1 x 1
    EXPECT_NEAR(c.x, (2.0 * 1.0 + 1.0 * 0.5) / 3.0, 1e-15);
    EXPECT_NEAR(c.y, (2.0 * 0.5 + 1.0 * 1.5) / 3.0, 1e-15);
}

TEST(Polygon, SimplePolygonsAreRecognised) {
    EXPECT_TRUE(is_simple_polygon(unit_square));
    EXPECT_TRUE(is_simple_polygon(ell));
    EXPECT_TRUE(is_simple_polygon(std::vector<Vec2>(ell.rbegin(), ell.rend())));
    EXPECT_TRUE(is_simple_polygon(std::vector<Vec2>{{0, 0}, {0.5, 0}, {1, 0}, {1, 1}}));  // a vertex on a straight side
}

TEST(Polygon, PolygonsThatTouchOrCrossThemselvesAreNotSimple) {
    EXPECT_FALSE(is_simple_polygon(std::vector<Vec2>{{0, 0}, {1, 1}, {1, 0}, {0, 1}})) << "bow tie";
    EXPECT_FALSE(is_simple_polygon(std::vector<Vec2>{{0, 0}, {4, 0}, {0, 3}, {4, 2}})) << "a bow tie with an area";
    EXPECT_FALSE(is_simple_polygon(std::vector<Vec2>{{0, 0}, {1, 0}})) << "two vertices";
    EXPECT_FALSE(is_simple_polygon(std::vector<Vec2>{{0, 0}, {1, 0}, {2, 0}})) << "no area";
    EXPECT_FALSE(is_simple_polygon(std::vector<Vec2>{{0, 0}, {1, 0}, {1, 0}, {0, 1}})) << "a vertex twice in a row";
    EXPECT_FALSE(is_simple_polygon(std::vector<Vec2>{{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}})) << "a vertex on another edge";
    EXPECT_FALSE(is_simple_polygon(std::vector<Vec2>{{0, 0}, {2, 0}, {2, 2}, {2, 1}, {0, 2}})) << "a spike";
    EXPECT_FALSE(is_simple_polygon(std::vector<Vec2>{{0, 0}, {1, 0}, {1, std::nan("")}})) << "not a number";
}

TEST(Polygon, PointsAreLocated) {
    EXPECT_TRUE(contains(ell, {0.5, 1.5}));
    EXPECT_TRUE(contains(ell, {1.5, 0.5}));
    EXPECT_FALSE(contains(ell, {1.5, 1.5}));
    EXPECT_FALSE(contains(ell, {-0.1, 1.0}));
    EXPECT_FALSE(contains(ell, {3.0, 1.0}));
    EXPECT_TRUE(contains(std::vector<Vec2>(ell.rbegin(), ell.rend()), {0.5, 1.5}));
}

TEST(Polygon, DistancesToSegments) {
    EXPECT_DOUBLE_EQ(distance_to_segment({0.5, 2.0}, {0, 0}, {1, 0}), 2.0);
    EXPECT_DOUBLE_EQ(distance_to_segment({4.0, 4.0}, {0, 0}, {1, 0}), 5.0);
    EXPECT_DOUBLE_EQ(distance_to_segment({3.0, 4.0}, {0, 0}, {0, 0}), 5.0);
    EXPECT_DOUBLE_EQ(distance_to_boundary(ell, {0.5, 0.6}), 0.5);
    EXPECT_DOUBLE_EQ(distance_to_boundary(ell, {1.5, 1.25}), 0.25);
}

TEST(Polygon, Convexity) {
    EXPECT_TRUE(is_convex_polygon(unit_square));
    EXPECT_TRUE(is_convex_polygon(std::vector<Vec2>{{0, 0}, {0.5, 0}, {1, 0}, {1, 1}}));
    EXPECT_FALSE(is_convex_polygon(ell));
}

}  // namespace
}  // namespace feldspar
