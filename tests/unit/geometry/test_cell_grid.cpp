// The grids must find everybody whom a search over all pairs finds.
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "feldspar/base/rng.hpp"
#include "feldspar/geometry/cell_grid.hpp"

namespace feldspar {
namespace {

std::vector<Vec2> random_points(int count, RandomStream& random) {
    std::vector<Vec2> points;
    for (int i = 0; i < count; ++i) {
        const double x = random.uniform(-1.2, 3.2);  // some outside the box
        points.push_back({x, random.uniform(-0.2, 1.2)});
    }
    return points;
}

TEST(CellGrid, FindsEveryPointWithinReachOnce) {
    RandomStream random(1, "cell grid");
    const std::vector<Vec2> points = random_points(500, random);
    for (const double cell : {0.01, 0.1, 1.0, 10.0}) {
        CellGrid grid({{-1, 0}, {3, 1}}, cell, points.size());
        for (int i = 0; i < std::ssize(points); ++i) grid.insert(i, points[i]);
        for (const Vec2 p : random_points(50, random)) {
            std::multiset<int> found;
            grid.for_each_near(p, 0.15, [&](int i) { found.insert(i); });
            for (int i = 0; i < std::ssize(points); ++i) {
                EXPECT_LE(found.count(i), 1U);
                const bool near = norm(points[i] - p) <= 0.15;
                EXPECT_TRUE(!near || found.contains(i)) << "cell size " << cell;
            }
        }
    }
}

TEST(CellGrid, DoesNotVisitEverybody) {
    RandomStream random(2, "cell grid");
    const std::vector<Vec2> points = random_points(1000, random);
    CellGrid grid({{-1, 0}, {3, 1}}, 0.1, points.size());
    for (int i = 0; i < std::ssize(points); ++i) grid.insert(i, points[i]);
    int visited = 0;
    grid.for_each_near({1.0, 0.5}, 0.1, [&](int) { ++visited; });
    EXPECT_LT(visited, 100);
}

TEST(CellGrid, ForgetsWhenCleared) {
    CellGrid grid({{0, 0}, {1, 1}}, 0.1, 1);
    grid.insert(7, {0.5, 0.5});
    grid.clear();
    grid.for_each_near({0.5, 0.5}, 1.0, [](int) { FAIL() << "a point is left"; });
}

TEST(DiscGrid, FindsDiscsOfAllSizes) {
    RandomStream random(3, "disc grid");
    const std::vector<Vec2> centres = random_points(400, random);
    std::vector<double> radii;
    for (std::size_t i = 0; i < centres.size(); ++i) radii.push_back(0.002 * std::pow(100.0, random.uniform()));
    DiscGrid grid({{-1, 0}, {3, 1}}, radii);
    for (int i = 0; i < std::ssize(centres); ++i) grid.insert(i, centres[i]);
    int expected = 0;
    for (int i = 0; i < std::ssize(centres); ++i) {
        std::set<int> found;
        grid.for_each_near(centres[i], radii[i], [&](int j) { found.insert(j); });
        for (int j = 0; j < std::ssize(centres); ++j) {
            if (norm(centres[i] - centres[j]) > radii[i] + radii[j]) continue;
            ++expected;
            EXPECT_TRUE(found.contains(j)) << i << " and " << j;
        }
    }
    EXPECT_GT(expected, 1000);
}

}  // namespace
}  // namespace feldspar
