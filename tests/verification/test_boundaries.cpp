// What a test does to its body: pressure, plates, damping, the section that a stress refers to, where the elastic start ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "feldspar/lab/body_energy.hpp"
#include "feldspar/laws/damping.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/masses.hpp"
#include "fixtures.hpp"
#include "plate_checks.hpp"

namespace feldspar {
namespace {

TEST(Boundaries, PressureActsNormalToTheInitialFacesOverTheirCurrentLength) {  // (L1)
    const auto specimen = fixtures::make(fixtures::rectangle(0.02, 0.04));
    Assembly assembly = assemble(*specimen, ModelSpec{}, fixtures::granite(), fixtures::table7());
    const double pressure = 5e6;
    attach(assembly, *specimen, fixtures::platen_rows(*specimen, pressure));
    const double c = 1.1 * std::cos(0.2), s = 1.1 * std::sin(0.2);  // turned by 0.2 and stretched by 1.1
    for (int n = 0; n < assembly.nodes.count(); ++n) {
        const Vec2 X = assembly.nodes.reference[n];
        assembly.nodes.displacement[n] = Vec2{c * X.x - s * X.y, s * X.x + c * X.y} - X;
    }
    Team team(1);
    evaluate_forces(assembly, team, Strength::unlimited);
    const Array<Vec2> without = assembly.nodes.force;
    assembly.dead_loads.front().pressure_Pa = pressure;
    evaluate_forces(assembly, team, Strength::unlimited);
    Vec2 on_left, on_right;
    for (int n = 0; n < assembly.nodes.count(); ++n)
        (assembly.nodes.reference[n].x < 0.01 ? on_left : on_right) += assembly.nodes.force[n] - without[n];
    const double expected = pressure * 1.1 * 0.04 * assembly.thickness_m;  // both sides are 0.04 m high
    // The stretch's own forces, about 1e5 N a node, are taken away again and leave their rounding, 1e-11 N a node.
    EXPECT_NEAR(on_left.x / expected, 1.0, 1e-9);
    EXPECT_NEAR(on_right.x / expected, -1.0, 1e-9);
    EXPECT_NEAR(on_left.y / expected, 0.0, 1e-9);
    EXPECT_NEAR(on_right.y / expected, 0.0, 1e-9);
}

TEST(Boundaries, DampingOfTheDeviationLeavesTheLoadingMotionAlone) {  // (M3)
    // The affine motion of the loading strains the body: its boundary nodes feel forces that grow with the strain. Nodes that
    // move just like the loading, or more slowly, or the other way, are not braked; those that run ahead of it lose alpha |F|.
    constexpr double alpha = 0.7, loading = 2e-9, F = 30.0;
    for (const double sign : {1.0, -1.0}) {
        const double L = sign * loading;
        EXPECT_EQ(local_drag(L, L, F, alpha), 0.0);
        EXPECT_EQ(local_drag(0.5 * L, L, F, alpha), 0.0);
        EXPECT_DOUBLE_EQ(local_drag(2.0 * L, L, F, alpha), sign * alpha * F);
        EXPECT_DOUBLE_EQ(local_drag(2.0 * L, L, -F, alpha), sign * alpha * F);
        EXPECT_DOUBLE_EQ(local_drag(-0.5 * L, L, F, alpha),
                         -sign * alpha * F);                               // against the loading: braked as the paper does it
        EXPECT_DOUBLE_EQ(local_drag(L, 0.0, F, alpha), sign * alpha * F);  // B = 0 is the paper's own damping
    }
    // It never drives: the drag has the sign of the velocity, whatever the loading motion is.
    for (const double V : {-3.0, -1.0, -0.1, 0.0, 0.1, 1.0, 3.0})
        for (const double L : {-2.0, -0.5, 0.0, 0.5, 2.0})
            for (const double force : {-1.0, 1.0}) EXPECT_GE(local_drag(V, L, force, alpha) * V, 0.0);
}

TEST(Boundaries, TheVelocityBeforeAStepIsFoundAgain) {
    constexpr double alpha = 0.7, push = 0.01;
    for (const double V : {-3.0, -1.0, -0.2, 0.2, 1.0, 3.0})
        for (const double L : {-2.0, -0.5, 0.0, 0.5, 2.0})
            for (const double F : {-1.0, 1.0}) {  // a step changes V by at most 0.017, so that none of these turns
                const double after = V + push * (F - local_drag(V, L, F, alpha));
                EXPECT_NEAR(before_local_drag(after, L, F, push, alpha), V, 1e-15);
            }
}

TEST(Boundaries, ViscousDampingTakesTheEnergyThatItBooks) {
    Assembly assembly =
        assemble(*fixtures::make(fixtures::rectangle(0.02, 0.04)), ModelSpec{}, fixtures::granite(), fixtures::table7());
    set_scaled_masses(assembly, MassBound::tensor, 1.0);
    Team team(1);
    StepSettings settings;
    settings.viscous = 0.1;
    const Vec2 velocity = {0.5e-9, -1e-9};
    PlatenWork none;
    // A translation makes no forces, so that nothing but the damping acts: it loses the factor (1 - c/2) / (1 + c/2) a step.
    for (Vec2& V : assembly.nodes.velocity) V = velocity;
    StepSettings unstepped = settings;
    unstepped.dt = 0.0;
    const double before = motion(assembly, unstepped).kinetic_J, left = std::pow(0.95 / 1.05, 10);
    advance(assembly, team, settings, 0, 10, none);
    for (const Vec2 V : assembly.nodes.velocity)
        EXPECT_LT(norm(V - left * velocity), 1e-6 * norm(velocity));  // rounding of the shapes
    EXPECT_NEAR(stored_energy(assembly, 0.0).damping_J / before, 1.0 - left * left, 1e-6);
}

TEST(Boundaries, PlateContactsHaveTheirStiffnessFrictionAndFirstTouch) {  // (C19)
    expect_plates_on_a_disc(fixtures::model(GrainKind::flexible));
}

TEST(Boundaries, StressRefersToTheInitialSectionOrToTheDiscsOwn) {  // (L2)
    const RunControl control = fixtures::threads(1);
    const TestSetup disc = fixtures::setup(fixtures::make(fixtures::disc(0.03)), methods::brazilian);
    EXPECT_NEAR(Experiment(disc, control).stress(1.0) * std::numbers::pi * 0.03 * 0.08 / 2.0, 1.0, 1e-12);
    const TestSetup bar = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04)), methods::uniaxial_compression);
    EXPECT_NEAR(Experiment(bar, control).stress(1.0) * 0.02 * 0.08, 1.0, 1e-12);
}

// Largest share of its elastic limit that any bonded point has reached, after the elastic start.
double share_of_first_damage(double tau_Pa, double sigma_nt_Pa) {
    TestSetup s = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04)), methods::uniaxial_compression);
    s.contact.tau_Pa = tau_Pa;
    s.contact.sigma_nt_Pa = sigma_nt_Pa;
    const RunControl control = fixtures::threads(1);
    Experiment e(s, control);
    choose_step(e);
    prepare(e);
    double share = 0.0;
    for (const ContactPoint& point : e.assembly.points) {
        const BondLaw& law = e.assembly.laws[0];
        share = std::max({share, e.assembly.bonds.at(point.state).un_m / law.normal.x0,
                          std::abs(e.assembly.bonds.at(point.state).us_m) / law.shear.x0});
    }
    return share;
}

TEST(Boundaries, TheElasticStartEndsJustBelowTheFirstDamageInTensionOrInShear) {
    for (const double share :
         {share_of_first_damage(29.75e6, 8.5e6), share_of_first_damage(10e6, 1e9), share_of_first_damage(1e9, 4e6)}) {
        EXPECT_LT(share, 1.0);
        EXPECT_GT(share, 0.95);  // 0.98 is aimed at, and accepted to 0.95
    }
}

}  // namespace
}  // namespace feldspar
