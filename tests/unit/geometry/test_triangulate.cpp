// The wrappers around CGAL: they must hand over what was asked for.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "feldspar/base/rng.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/geometry/triangulate.hpp"

namespace feldspar {
namespace {

double area_of(const std::vector<Vec2>& points, const std::vector<int>& numbers) {
    std::vector<Vec2> corners;
    for (const int i : numbers) corners.push_back(points[i]);
    return signed_area(corners);
}

TEST(RegularTriangulation, CoversTheConvexHullWithPositiveTriangles) {
    std::vector<Vec2> sites = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    RandomStream random(1, "sites");
    for (int i = 0; i < 200; ++i) {
        const double x = random.uniform();
        sites.push_back({x, random.uniform()});
    }
    const std::vector<double> weights(sites.size(), 0.0);
    const auto result = regular_triangulation(sites, weights);
    double area = 0.0;
    for (const auto& t : result.triangles) {
        const double a = area_of(sites, {t[0], t[1], t[2]});
        EXPECT_GT(a, 0.0);
        area += a;
    }
    EXPECT_NEAR(area, 1.0, 1e-14);
    EXPECT_TRUE(result.hidden.empty());
    EXPECT_EQ(result.triangles.size(), 2 * sites.size() - 2 - 4);  // Euler, with four sites on the hull
}

TEST(RegularTriangulation, WeightsDecideTheDiagonal) {
    // A square: the heavier pair of opposite sites is joined.
    const std::vector<Vec2> sites = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const auto joins = [&](const std::vector<double>& weights, int a, int b) {
        const auto triangles = regular_triangulation(sites, weights).triangles;
        return std::all_of(triangles.begin(), triangles.end(), [&](const std::array<int, 3>& t) {
            return std::count(t.begin(), t.end(), a) == 1 && std::count(t.begin(), t.end(), b) == 1;
        });
    };
    EXPECT_TRUE(joins({0.1, 0, 0.1, 0}, 0, 2));
    EXPECT_TRUE(joins({0, 0.1, 0, 0.1}, 1, 3));
}

TEST(RegularTriangulation, NamesHiddenAndEqualSites) {
    const std::vector<Vec2> sites = {{0, 0}, {1, 0}, {0, 1}, {0.2, 0.2}, {1, 0}};
    const auto result = regular_triangulation(sites, std::vector<double>{1.0, 1.0, 1.0, 0.0, 1.0});
    EXPECT_EQ(result.hidden.size(), 2U);
    EXPECT_EQ(std::count(result.hidden.begin(), result.hidden.end(), 3), 1);
}

TEST(ConvexPartition, PartsAreConvexAndFillThePolygon) {
    const std::vector<Vec2> comb = {{0, 0}, {5, 0}, {5, 3}, {4, 3}, {4, 1}, {3, 1},
                                    {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
    const auto parts = convex_partition(comb);
    double area = 0.0;
    for (const auto& part : parts) {
        std::vector<Vec2> corners;
        for (const int i : part) corners.push_back(comb[i]);
        EXPECT_TRUE(is_convex_polygon(corners));
        area += signed_area(corners);
    }
    EXPECT_NEAR(area, signed_area(comb), 1e-14);
    EXPECT_GE(parts.size(), 3U);
}

TEST(TriangulatePolygon, StaysInsideAndAddsNoNodes) {
    const std::vector<Vec2> points = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0.5, 0.5}};
    const auto triangles = triangulate_polygon(points, 6);
    EXPECT_EQ(triangles.size(), 2U * 1 + 6 - 2);
    double area = 0.0;
    std::set<std::pair<int, int>> directed;
    for (const auto& t : triangles) {
        area += area_of(points, {t[0], t[1], t[2]});
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(directed.emplace(t[k], t[(k + 1) % 3]).second);
    }
    EXPECT_NEAR(area, 3.0, 1e-14);
    for (int k = 0; k < 6; ++k) EXPECT_TRUE(directed.contains({k, (k + 1) % 6})) << "outer edge " << k;
}

}  // namespace
}  // namespace feldspar
