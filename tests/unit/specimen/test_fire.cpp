// FIRE on energies whose minimum is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "feldspar/base/rng.hpp"
#include "feldspar/specimen/fire.hpp"

namespace feldspar {
namespace {

/// A chain of points held by springs of stiffness 1 between fixed ends: at the minimum they stand evenly on the line.
struct Chain {
    Vec2 first{0.0, 0.0}, last{1.0, 2.0};
    std::vector<Vec2> points;

    explicit Chain(int count) {
        RandomStream random(1, "chain");
        for (int i = 0; i < count; ++i) {
            const double x = random.uniform(-1.0, 1.0);
            points.push_back({x, random.uniform(-1.0, 1.0)});
        }
    }
    Vec2 rest(int i) const { return first + ((i + 1.0) / (static_cast<double>(points.size()) + 1.0)) * (last - first); }
    std::vector<Vec2> forces() const {
        std::vector<Vec2> result;
        const int n = static_cast<int>(points.size());
        for (int i = 0; i < n; ++i) {
            const Vec2 before = i > 0 ? points[i - 1] : first, after = i + 1 < n ? points[i + 1] : last;
            result.push_back((before - points[i]) + (after - points[i]));
        }
        return result;
    }
    double distance_to_rest() const {
        double largest = 0.0;
        for (int i = 0; i < std::ssize(points); ++i) largest = std::max(largest, norm(points[i] - rest(i)));
        return largest;
    }
};

class FireOnChain : public testing::TestWithParam<bool> {};

TEST_P(FireOnChain, FindsTheMinimum) {
    Chain chain(20);
    Fire fire(chain.points.size(), {.shortest_step = 0.02, .steps_back = GetParam(), .farthest_move_m = 0.5});
    for (int step = 0; step < 1000; ++step) fire.advance(chain.points, chain.forces());
    EXPECT_LT(chain.distance_to_rest(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(UphillRules, FireOnChain, testing::Bool());

TEST(Fire, SoftAndStiffDirectionsConverge) {
    std::vector<Vec2> point = {{3.0, -2.0}}, force(1);
    Fire fire(1, {.farthest_move_m = 1.0});
    for (int step = 0; step < 2000; ++step) {
        force[0] = {-0.05 * (point[0].x - 1.0), -10.0 * (point[0].y - 0.5)};
        fire.advance(point, force);
    }
    EXPECT_NEAR(point[0].x, 1.0, 1e-9);
    EXPECT_NEAR(point[0].y, 0.5, 1e-9);
}

TEST(Fire, NoPointMovesFartherThanAllowedInAStep) {
    Chain chain(10);
    const double farthest = 1e-3;
    Fire fire(chain.points.size(), {.steps_back = false, .farthest_move_m = farthest});
    for (int step = 0; step < 200; ++step) {
        const std::vector<Vec2> before = chain.points;
        fire.advance(chain.points, chain.forces());
        for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LE(norm(chain.points[i] - before[i]), farthest * (1.0 + 1e-12));
    }
}

TEST(Fire, SameBitsForAnyNumberOfThreads) {
    Chain alone(3001), together(3001);
    const FireLimits limits = {.farthest_move_m = 0.1};
    Fire fire(alone.points.size(), limits), shared(together.points.size(), limits);
    Team team(3);
    for (int step = 0; step < 50; ++step) {
        fire.advance(alone.points, alone.forces());
        shared.advance(together.points, together.forces(), &team);
    }
    EXPECT_EQ(alone.points, together.points);
}

TEST(Fire, PointsWithoutForceStay) {
    std::vector<Vec2> points = {{0.0, 0.0}, {7.0, -3.0}};
    Fire fire(2, {.farthest_move_m = 1.0});
    for (int step = 0; step < 100; ++step) fire.advance(points, std::vector<Vec2>{{1.0 - points[0].x, 0.0}, {}});
    EXPECT_EQ(points[1], (Vec2{7.0, -3.0}));
    EXPECT_NEAR(points[0].x, 1.0, 1e-3);
}

}  // namespace
}  // namespace feldspar
