// The rate control on numbers made up for it: travel time 400 steps, platens at 0.4 mm and 80 N.
#include "feldspar/lab/rate_control.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "feldspar/methods/method.hpp"
#include "feldspar/model/assemble.hpp"

using namespace feldspar;

namespace {

constexpr double kTarget = 5e-3, kGrowth = 0.1, kTravelTime = 400.0, kTravel = 4e-4, kForce = 80.0;

RateControl control() { return {{kTarget, kGrowth}, kTravelTime}; }

// As a share of the platen travel so far in a travel time of a wave: of the load, if that is proportional to it.
double per_travel_time(double speed) { return speed * kTravelTime / kTravel; }

double next(RateControl& c, double speed, double typical, double total, double slowest = 0.0) {  // in targets
    return c.next(speed, {total * kTarget * kForce, typical * kTarget * kForce}, kForce, kTravel, slowest);
}
double next_of_new(double speed, double typical, double total) {
    RateControl c = control();
    return next(c, speed, typical, total);
}

}  // namespace

TEST(RateControl, AccuracyAndTargetAreInverse) {
    for (const MethodId kind : std::initializer_list<MethodId>{methods::uniaxial_compression, methods::brazilian}) {
        NumericsSpec numerics;
        numerics.accuracy = 0.013;
        EXPECT_NEAR(accuracy_of(residual_target(numerics, kind), kind), 0.013, 1e-12);
        numerics.residual_target = 2e-3;
        EXPECT_DOUBLE_EQ(residual_target(numerics, kind), 2e-3);
    }
    EXPECT_DOUBLE_EQ(method_of(methods::biaxial).rate.residual_share, 2.0);
    EXPECT_NEAR(residual_target(NumericsSpec{}, methods::direct_tension), 3.0 * residual_target(NumericsSpec{}, methods::biaxial),
                1e-15);
}

TEST(RateControl, HoldsTheSpeedAtTheTarget) {
    const double v = 2e-8;
    EXPECT_DOUBLE_EQ(next_of_new(v, 1.0, 1.0), v);
    EXPECT_GT(next_of_new(v, 0.5, 0.5), v);
    EXPECT_LT(next_of_new(v, 1.5, 2.5), v);
}

TEST(RateControl, SlowsFasterThanItHastens) {
    const double v = 2e-8;
    EXPECT_DOUBLE_EQ(next_of_new(v, 0.0, 0.0), 1.1 * v);
    EXPECT_DOUBLE_EQ(next_of_new(v, 200.0, 200.0), 0.4 * v);
}

TEST(RateControl, AFewRestlessBodiesMayHaveTenTimesTheTarget) {
    const double v = 2e-8;
    EXPECT_DOUBLE_EQ(next_of_new(v, 0.0, 10.0), v);
    EXPECT_LT(next_of_new(v, 0.0, 11.0), v);
    EXPECT_LT(next_of_new(v, 2.0, 10.0), v);
}

TEST(RateControl, ThePlatenComesToRestWhileTheTypicalBodyIsOutOfBalance) {
    RateControl c = control();
    double v = c.start(kTravel);
    EXPECT_GT(v, 0.0);
    int blocks = 0;
    for (; v > 0.0 && blocks < 100; ++blocks) v = next(c, v, 10.0, 10.0);
    EXPECT_LT(blocks, 5);  // a tenth of the fastest speed falls below a hundredth of it by 0.4 a block
    EXPECT_EQ(v, 0.0);
    EXPECT_FALSE(c.balanced());
    EXPECT_EQ(next(c, v, 10.0, 10.0), 0.0);
    v = next(c, v, 0.5, 0.5);  // and sets out again when it is in balance
    EXPECT_TRUE(c.balanced());
    EXPECT_NEAR(per_travel_time(v), 1.1 * 0.01 * kGrowth, 1e-12);
}

TEST(RateControl, TheLoadGrowsByNoMoreThanTheLimitInATravelTime) {
    EXPECT_NEAR(per_travel_time(next_of_new(1.0, 0.0, 0.0)), kGrowth, 1e-12);
    RateControl small({kTarget, 0.3},
                      20.0);  // a small specimen: the record still resolves the load, by a fiftieth a row of ten steps
    EXPECT_NEAR(small.next(1.0, {}, kForce, kTravel) / kTravel, 2e-3, 1e-15);
}

TEST(RateControl, ASpecimenThatFailsIsPassedAtTheSpeedThatIsAskedFor) {
    RateControl c = control();
    EXPECT_NEAR(per_travel_time(next(c, 0.0, 50.0, 50.0, 0.01)), 0.01, 1e-12);
    EXPECT_NEAR(per_travel_time(next(c, 0.0, 50.0, 50.0, 10.0)), kGrowth, 1e-12);
}

TEST(RateControl, BehindThePeakWhatIsOutOfBalanceCountsAgainstHalfTheLargestLoad) {
    RateControl c = control();
    const Unbalanced little{0.5 * kTarget * kForce, 0.5 * kTarget * kForce};
    c.next(2e-8, little, kForce, kTravel);
    EXPECT_DOUBLE_EQ(c.residual(), 0.5 * kTarget);
    c.next(2e-8, little, 0.8 * kForce, kTravel);
    EXPECT_DOUBLE_EQ(c.residual(), 0.5 * kTarget / 0.8);
    c.next(2e-8, little, 0.1 * kForce, kTravel);  // the specimen bears next to nothing
    EXPECT_DOUBLE_EQ(c.residual(), kTarget);
}

TEST(RateControl, ACrackThatRunsAwayIsSeenBeforeTheTargetIsReached) {
    RateControl c = control();
    const double v = 2e-8;
    for (const double quiet : {0.50, 0.52, 0.54, 0.60}) EXPECT_GT(next(c, v, 0.0, quiet), v);  // as the speed would have it
    EXPECT_GT(next(c, v, 0.0, 0.70), v);
    EXPECT_DOUBLE_EQ(next(c, v, 0.0, 0.90), 0.4 * v);  // 1.67 times that of three blocks ago
    RateControl small = control();
    for (const double share : {0.05, 0.06, 0.08}) next(small, v, 0.0, share);
    EXPECT_GT(next(small, v, 0.0, 0.4), v);  // too little to matter
}

TEST(Unbalanced, TheTypicalBodyLeavesOutTheFew) {
    Assembly assembly;
    for (int b = 0; b < 5; ++b) {
        Body body;
        body.kind = BodyKind::rigid;
        body.first_node = assembly.nodes.add({}, {1.0, 1.0});
        body.node_count = 1;
        assembly.bodies.push_back(body);
        assembly.nodes.force[body.first_node] = b == 2 ? Vec2{-900.0, 0.0} : Vec2{-1.0, 2.0};
    }
    Body plate;
    plate.kind = BodyKind::plate;
    plate.first_node = assembly.nodes.add({}, {0.0, 1.0});
    plate.node_count = 1;
    assembly.bodies.push_back(plate);
    assembly.nodes.force[plate.first_node] = {50.0, 7.0};  // x is imposed and no imbalance
    for (int n = 0; n < assembly.nodes.count(); ++n) assembly.nodes.inverse_mass[n] = {n == plate.first_node ? 0.0 : 1.0, 1.0};
    index_bodies(assembly);
    const Unbalanced sum = unbalanced(assembly);
    EXPECT_DOUBLE_EQ(sum.total_N, 4 * 3.0 + 900.0 + 7.0);
    EXPECT_DOUBLE_EQ(sum.typical_N, 5 * 3.0);
}

TEST(LoadingMode, FollowsTheMeanMotionAndIsBounded) {
    Assembly assembly;
    Nodes& nodes = assembly.nodes;
    for (int n = 0; n < 3; ++n) nodes.add({}, {1.0, 1.0});
    nodes.inverse_mass = {{1.0, 1.0}, {1.0, 0.0}, {1.0, 1.0}};
    nodes.loading_mode = {{0.0, -1.0}, {0.0, -1.0}, {0.0, 0.0}};
    LoadingModeUpdate update(20.0);
    update.observe(assembly, 0, 1e-6);
    nodes.displacement = {{0.0, -0.5e-9}, {0.2e-9, -1e-9}, {100e-9, -100e-9}};
    update.observe(assembly, 10, 1.5e-6);  // the window is not over
    EXPECT_EQ(nodes.loading_mode[0].y, -1.0);
    nodes.displacement = {{0.0, -0.5e-6}, {0.2e-6, -1e-6}, {100e-6, -100e-6}};  // the last one jumped, beside a crack
    update.observe(assembly, 20, 2e-6);
    EXPECT_NEAR(nodes.loading_mode[0].y, -0.75, 1e-12);
    EXPECT_NEAR(nodes.loading_mode[1].x, 0.1, 1e-12);
    EXPECT_EQ(nodes.loading_mode[1].y, -1.0);  // imposed
    EXPECT_NEAR(nodes.loading_mode[2].x, 0.75, 1e-12);
    EXPECT_NEAR(nodes.loading_mode[2].y, -0.75, 1e-12);
    update.observe(assembly, 40, 3e-6);  // at rest since
    EXPECT_NEAR(nodes.loading_mode[2].x, 0.375, 1e-12);
    update.observe(assembly, 60, 3e-6);  // no travel, nothing to learn
    EXPECT_NEAR(nodes.loading_mode[2].x, 0.375, 1e-12);
}
