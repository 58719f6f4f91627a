// Forces between overlapping discs against all pairs, one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "feldspar/base/rng.hpp"
#include "feldspar/specimen/repulsion.hpp"

namespace feldspar {
namespace {

struct Cloud {
    std::vector<Vec2> centres;
    std::vector<double> radii;
    std::vector<DiscPair> pairs;  // all of them, by the first disc, then by the second

    explicit Cloud(int count) {
        RandomStream random(1, "cloud");
        for (int i = 0; i < count; ++i) {
            const double x = random.uniform(0.0, 10.0);
            centres.push_back({x, random.uniform(0.0, 10.0)});
            radii.push_back(random.uniform(0.2, 1.0));
            for (int j = 0; j < i; ++j) pairs.push_back({i, j});
        }
    }
};

TEST(Repulsion, PushesByTheOverlapAlongTheLineOfCentres) {
    const std::vector<Vec2> centres = {{0.0, 0.0}, {3.0, 4.0}, {20.0, 0.0}};
    const std::vector<double> radii = {2.0, 4.0, 1.0};
    const std::vector<DiscPair> pairs = {{1, 0}, {2, 0}, {2, 1}};
    std::vector<Vec2> forces(3);
    std::vector<DistantPush> distant;
    push_apart(pairs, centres, radii, 1.0, forces, 0, distant);
    EXPECT_NEAR(forces[0].x, -0.6, 1e-15);
    EXPECT_NEAR(forces[0].y, -0.8, 1e-15);
    EXPECT_EQ(forces[1], -forces[0]);
    EXPECT_EQ(forces[2], Vec2{});
    EXPECT_TRUE(distant.empty());
    std::fill(forces.begin(), forces.end(), Vec2{});
    push_apart(pairs, centres, radii, 0.5, forces, 0, distant);  // half the radii: none overlap
    EXPECT_EQ(forces, std::vector<Vec2>(3));
}

TEST(Repulsion, SameBitsAsPairByPair) {
    const Cloud cloud(60);  // 1770 pairs: several chunks
    std::vector<Vec2> expected(cloud.centres.size()), forces(cloud.centres.size());
    for (const auto [a, b] : cloud.pairs) {
        const Vec2 apart = cloud.centres[a] - cloud.centres[b];
        const double reach = 1.25 * (cloud.radii[a] + cloud.radii[b]), distance = norm(apart);
        if (dot(apart, apart) >= reach * reach) continue;
        expected[a] += ((reach - distance) / distance) * apart;
        expected[b] -= ((reach - distance) / distance) * apart;
    }
    std::vector<DistantPush> distant;
    push_apart(cloud.pairs, cloud.centres, cloud.radii, 1.25, forces, 0, distant);
    EXPECT_EQ(forces, expected);
}

TEST(Repulsion, ForcesOnDiscsOfOthersAreHandedOver) {
    const Cloud cloud(60);
    const int first_own = 25;
    std::vector<Vec2> whole(cloud.centres.size()), own(cloud.centres.size());
    std::vector<DistantPush> distant;
    push_apart(cloud.pairs, cloud.centres, cloud.radii, 1.0, whole, 0, distant);
    const auto first = std::find_if(cloud.pairs.begin(), cloud.pairs.end(), [&](DiscPair p) { return p.a >= first_own; });
    push_apart({cloud.pairs.begin(), first}, cloud.centres, cloud.radii, 1.0, own, 0, distant);
    EXPECT_TRUE(distant.empty());
    push_apart({first, cloud.pairs.end()}, cloud.centres, cloud.radii, 1.0, own, first_own, distant);
    EXPECT_FALSE(distant.empty());
    for (const DistantPush& push : distant) {
        EXPECT_LT(push.disc, first_own);
        own[push.disc] += push.force;
    }
    EXPECT_EQ(own, whole);
}

TEST(Repulsion, DiscsInOnePlacePartAlongX) {
    const std::vector<Vec2> centres(2, {1.0, 2.0});
    std::vector<Vec2> forces(2);
    std::vector<DistantPush> distant;
    push_apart(std::vector<DiscPair>{{1, 0}}, centres, std::vector<double>{0.5, 0.25}, 1.0, forces, 0, distant);
    EXPECT_EQ(forces[1], (Vec2{0.75, 0.0}));
    EXPECT_EQ(forces[0], (Vec2{-0.75, 0.0}));
}

}  // namespace
}  // namespace feldspar
