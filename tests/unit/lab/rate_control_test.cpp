// The rate control on numbers made up for it: a specimen 0.16 m high, travel time 400 steps, expected to carry 100 N.
#include <vector>

#include <gtest/gtest.h>

#include "feldspar/lab/rate_control.hpp"
#include "feldspar/model/assemble.hpp"

using namespace feldspar;

namespace {

constexpr double kTarget = 5e-3, kHeight = 0.16, kTravelTime = 400.0, kExpected = 100.0, kTravel = 4e-4;

RateControl control(double relative = 1.0, TestKind kind = TestKind::uniaxial_compression) {
    return {kind, kTarget * relative, relative, kHeight, kTravelTime, kExpected};
}

// As a share of the platen travel so far in a travel time of a wave: of the load, if that is proportional to it.
double per_travel_time(double speed) { return speed * kTravelTime / kTravel; }

}  // namespace

TEST(RateControl, AccuracyAndTargetAreInverse) {
    for (const TestKind kind : {TestKind::uniaxial_compression, TestKind::brazilian}) {
        NumericsSpec numerics;
        numerics.accuracy = 0.013;
        EXPECT_NEAR(accuracy_of(residual_target(numerics, kind, GrainKind::flexible), kind, GrainKind::flexible), 0.013, 1e-12);
    }
    EXPECT_NEAR(accuracy_of(1e-2, TestKind::uniaxial_compression, GrainKind::flexible), 0.02, 1e-12);
}

TEST(RateControl, HoldsTheSpeedAtTheTarget) {
    const double v = 2e-8;
    EXPECT_DOUBLE_EQ(control().next(v, {kTarget * 80.0, kTarget * 80.0}, 80.0, kTravel, 1.0), v);
    EXPECT_GT(control().next(v, {0.5 * kTarget * 80.0, 0.5 * kTarget * 80.0}, 80.0, kTravel, 1.0), v);
    EXPECT_LT(control().next(v, {2.5 * kTarget * 80.0, 1.5 * kTarget * 80.0}, 80.0, kTravel, 1.0), v);
}

TEST(RateControl, SlowsFasterThanItHastens) {
    const double v = 2e-8;
    EXPECT_DOUBLE_EQ(control().next(v, {}, 80.0, kTravel, 1.0), 1.1 * v);
    EXPECT_DOUBLE_EQ(control().next(v, {80.0, 80.0}, 80.0, kTravel, 1.0), 0.4 * v);
}

TEST(RateControl, AFewRestlessBodiesMayHaveTwiceTheTarget) {
    const double v = 2e-8;
    EXPECT_DOUBLE_EQ(control().next(v, {2.0 * kTarget * 80.0, 0.0}, 80.0, kTravel, 1.0), v);
    EXPECT_LT(control().next(v, {2.2 * kTarget * 80.0, 0.0}, 80.0, kTravel, 1.0), v);
    EXPECT_LT(control().next(v, {2.0 * kTarget * 80.0, 2.0 * kTarget * 80.0}, 80.0, kTravel, 1.0), v);
}

TEST(RateControl, UnderBrazilianPlatesAFewBodiesAlwaysRattle) {
    const double v = 1e-8;
    EXPECT_GT(control(1.0, TestKind::brazilian).next(v, {15.0 * kTarget * 50.0, 0.5 * kTarget * 50.0}, 50.0, kTravel, 1.0), v);
    EXPECT_LT(control(1.0, TestKind::brazilian).next(v, {15.0 * kTarget * 50.0, 1.5 * kTarget * 50.0}, 50.0, kTravel, 1.0), v);
    EXPECT_NEAR(per_travel_time(control(1.0, TestKind::brazilian).next(1.0, {}, 31.0, kTravel, 1.0)), 0.05, 1e-12);
}

TEST(RateControl, TheSlowestSpeedIsAShareOfTheLoadInATravelTime) {
    const auto slowest = [](double relative) { return per_travel_time(control(relative).next(1e-12, {80.0, 80.0}, 80.0, kTravel, 1.0)); };
    EXPECT_NEAR(slowest(1.0), 0.005, 1e-12);
    EXPECT_NEAR(slowest(1.0 / 3.0), 0.005 / 3.0, 1e-12);   // a repeat is slower everywhere
    EXPECT_NEAR(slowest(3.0), 0.01, 1e-12);
}

TEST(RateControl, TheStrengthIsApproachedSlowly) {
    const auto fastest = [](double force, double relative) { return per_travel_time(control(relative).next(1.0, {}, force, kTravel, 1.0)); };
    EXPECT_NEAR(fastest(89.0, 1.0), 0.4, 1e-12);   // the record's own bound would be 0.8 a travel time
    EXPECT_NEAR(fastest(91.0, 1.0), 0.05, 1e-12);
    EXPECT_NEAR(fastest(91.0, 1.0 / 3.0), 0.05 / 3.0, 1e-12);
}

TEST(RateControl, AFailingSpecimenIsNotCrawledAfterAndASoftBranchNotRacedDown) {
    const Unbalanced failing{10.0, 10.0}, quiet{};
    const auto next = [&](double v, const Unbalanced& u, double share) { return control().next(v, u, 80.0, kTravel, share) / kHeight; };
    EXPECT_NEAR(next(1e-12, failing, 0.99), 0.005 * kTravel / kTravelTime / kHeight, 1e-15);   // a new peak may come
    EXPECT_NEAR(next(1e-12, failing, 0.97), 1e-7, 1e-15);
    EXPECT_NEAR(next(1e-12, failing, 0.90), 3e-7, 1e-15);
    EXPECT_NEAR(next(1.0, quiet, 0.97), 1e-7, 1e-15);
    EXPECT_NEAR(next(1.0, quiet, 0.90), 3e-7, 1e-15);
}

TEST(RateControl, ACrackThatRunsAwayIsSeenBeforeTheTargetIsReached) {
    RateControl c = control();
    const double v = 2e-8;
    const auto next = [&](double share_of_target) { return c.next(v, {share_of_target * kTarget * 80.0, 0.0}, 80.0, kTravel, 1.0); };
    for (const double quiet : {0.50, 0.52, 0.54, 0.60}) EXPECT_GT(next(quiet), v);   // as the speed would have it
    EXPECT_GT(next(0.70), v);
    EXPECT_DOUBLE_EQ(next(0.90), 0.4 * v);   // 1.67 times that of three blocks ago
    RateControl small = control();
    for (const double share : {0.05, 0.06, 0.08}) small.next(v, {share * kTarget * 80.0, 0.0}, 80.0, kTravel, 1.0);
    EXPECT_GT(small.next(v, {0.4 * kTarget * 80.0, 0.0}, 80.0, kTravel, 1.0), v);   // too little to matter
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
    assembly.nodes.force[plate.first_node] = {50.0, 7.0};   // x is imposed and no imbalance
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
    update.observe(assembly, 10, 1.5e-6);   // the window is not over
    EXPECT_EQ(nodes.loading_mode[0].y, -1.0);
    nodes.displacement = {{0.0, -0.5e-6}, {0.2e-6, -1e-6}, {100e-6, -100e-6}};   // the last one jumped, beside a crack
    update.observe(assembly, 20, 2e-6);
    EXPECT_NEAR(nodes.loading_mode[0].y, -0.75, 1e-12);
    EXPECT_NEAR(nodes.loading_mode[1].x, 0.1, 1e-12);
    EXPECT_EQ(nodes.loading_mode[1].y, -1.0);   // imposed
    EXPECT_NEAR(nodes.loading_mode[2].x, 0.75, 1e-12);
    EXPECT_NEAR(nodes.loading_mode[2].y, -0.75, 1e-12);
    update.observe(assembly, 40, 3e-6);   // at rest since
    EXPECT_NEAR(nodes.loading_mode[2].x, 0.375, 1e-12);
    update.observe(assembly, 60, 3e-6);   // no travel, nothing to learn
    EXPECT_NEAR(nodes.loading_mode[2].x, 0.375, 1e-12);
}
