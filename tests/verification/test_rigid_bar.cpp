// Two rigid grains: how they break and return. Their numbers are checks of verify/two_grains.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "feldspar/model/assemble.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/step/step.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

constexpr double kSide = 0.003, kArea = kSide * 0.08;

TestSetup bar(MethodId kind, ContactKind contact) {
    TestSetup s = fixtures::setup(fixtures::two_grain_bar(kSide), kind);
    s.model = fixtures::model(GrainKind::rigid, contact);
    s.contact = fixtures::table1(GrainKind::rigid);
    s.test.stop_fraction = -1.0;  // to the end of the envelope and beyond
    s.numerics.residual_target = 2e-4;
    return s;
}

// The plates hold each grain at one point, about which it may turn: once three points soften, pulling evenly is unstable and one
// end of the edge opens before the other.
TEST(TwoRigidGrains, BetweenPlatesTheyOpenFromOneEnd) {
    TestSetup s = bar(methods::direct_tension, ContactKind::lobatto3);
    s.test.maximum_strain = 0.006;  // 3.6e-5 m, beyond x_f = 2.7e-5 m
    const TestResult r = run_test(s, fixtures::threads(1));
    EXPECT_GE(r.cracks.size(), 1U);
    for (const Crack& crack : r.cracks) EXPECT_EQ(crack.mode, CrackMode::tensile);
    EXPECT_LE(r.energy_at_end.fracture / (s.contact.Gfn_J_m2 * kArea), 1.005);
}

constexpr double kSkin = 3e-4;

TEST(TwoRigidGrains, ABrokenOpenContactIsDroppedAndReturnsAsFrictionOnTheShorterEdge) {
    Assembly assembly = assemble(*fixtures::two_grain_bar(kSide, 0.8 * kSide), fixtures::model(GrainKind::rigid),
                                 fixtures::granite(), fixtures::table1(GrainKind::rigid));
    set_scaled_masses(assembly, MassBound::tensor, 1.0);
    ContactFinder finder(assembly, kSkin);
    std::fill(assembly.bonds.damage.begin(), assembly.bonds.damage.end(), 1.0);
    const int upper = assembly.bodies[1].centre_node;
    assembly.nodes.displacement[upper] = {0.0, 1.5 * kSkin};
    EXPECT_EQ(finder.update(assembly, 1.0).dropped, 1);
    // Now beside the lower grain: the lower one's right side is kSide long, the upper one's left side 0.8 of it.
    const double touching = 0.9 * kSide;  // radii 0.5 and 0.4 kSide
    const Vec2 beside = assembly.nodes.reference[0] + Vec2{touching, 0.0} - assembly.nodes.reference[upper];
    assembly.nodes.displacement[upper] = beside + Vec2{1e-9, 0.0};
    EXPECT_EQ(finder.update(assembly, 1.0).made, 0);
    const Array<double> mass = assembly.nodes.mass;
    for (Vec2& v : assembly.nodes.velocity) v = {3e-9, 0.0};
    assembly.nodes.displacement[upper] = beside + Vec2{-1e-8, 0.0};
    const ContactFinder::Changes changes = finder.update(assembly, 1.0);
    EXPECT_EQ(changes.made, 1);
    EXPECT_EQ(finder.update(assembly, 1.0).made, 0);  // only once
    ASSERT_EQ(assembly.contacts.size(), 2U);
    const ContactPoint& point = assembly.points.back();
    EXPECT_NEAR(assembly.bonds.at(point.state).un_m, -1e-8, 1e-15);
    EXPECT_EQ(assembly.bonds.at(point.state).damage, 1.0);
    EXPECT_NEAR(point.area_m2, 0.8 * kArea, 1e-15);
    double kinetic = 0.0;
    for (int n = 0; n < assembly.nodes.count(); ++n) {
        EXPECT_GT(assembly.nodes.mass[n], mass[n]);
        kinetic += 0.5 * (assembly.nodes.mass[n] - mass[n]) * 9e-18;
    }
    EXPECT_NEAR(changes.kinetic_J / kinetic, 1.0, 1e-9);
    EXPECT_NEAR(changes.elastic_J / (0.5 * 1.08e13 * 0.8 * kArea * 1e-16), 1.0, 1e-6);  // the overlap is told, and is no fracture
    std::fill(assembly.nodes.velocity.begin(), assembly.nodes.velocity.end(), Vec2{});
    Team team(1);
    evaluate_forces(assembly, team, Strength::real);
    EXPECT_EQ(assembly.bonds.at(point.state).fracture_J, 0.0);
    EXPECT_NEAR(assembly.nodes.force[upper].x / assembly.bonds.at(point.state).Fn_N, 1.0, 1e-6);
    // Sliding by 1e-6 m across: friction.
    assembly.nodes.velocity[upper] = {0.0, 1e-6};
    contact_forces(assembly, {1, 2}, StepSettings{}, 0);
    EXPECT_LT(assembly.slots[3].force.y, 0.0);  // against the motion
}

TEST(TwoFilledGrains, DiscsThatReturnTouchOnTheSmallerDiameter) {
    const ModelSpec model = fixtures::model(GrainKind::inner_particles);
    Assembly assembly =
        assemble(*fixtures::two_grain_bar(kSide, kSide, 26.0), model, fixtures::granite(), fixtures::material(model));
    const int bonded = static_cast<int>(assembly.contacts.size());
    ContactFinder finder(assembly, 1e-4);
    int across = 0;
    for (const Contact& contact : assembly.contacts) {
        if (contact.material == inside_grains) continue;
        assembly.bonds.damage[assembly.points[contact.first_point].state] = 1.0;
        ++across;
    }
    const auto lift = [&](double by) {
        for (const Body& body : assembly.bodies)
            if (body.grain == 1) assembly.nodes.displacement[body.centre_node] = {0.0, by};
    };
    lift(5e-4);
    EXPECT_EQ(finder.update(assembly, 0.0).dropped, across);
    EXPECT_EQ(static_cast<int>(assembly.contacts.size()), bonded);
    lift(-1.5e-4);  // a quarter of a disc into each other
    EXPECT_GT(finder.update(assembly, 0.0).made, 2);
    EXPECT_GT(static_cast<int>(assembly.contacts.size()), bonded);
    for (int c = bonded; c < static_cast<int>(assembly.contacts.size()); ++c) {
        const Contact& contact = assembly.contacts[c];
        const Body &a = assembly.bodies[contact.a.body], &b = assembly.bodies[contact.b.body];
        EXPECT_NE(a.grain, b.grain);
        EXPECT_EQ(contact.material, between_grains);
        const ContactPoint& point = assembly.points[contact.first_point];
        EXPECT_DOUBLE_EQ(point.area_m2, 2.0 * std::min(a.radius_m, b.radius_m) * 0.08);
        EXPECT_EQ(assembly.bonds.at(point.state).damage, 1.0);
        const double d = norm(assembly.centre(contact.b.body) - assembly.centre(contact.a.body));
        EXPECT_NEAR(assembly.bonds.at(point.state).un_m, d - a.radius_m - b.radius_m, 1e-15);
        EXPECT_LT(assembly.bonds.at(point.state).un_m, 0.0);
    }
}

TEST(RigidSpecimens, StartWithoutAnyContactToMake) {
    for (const ModelSpec& model : {fixtures::model(GrainKind::rigid), fixtures::model(GrainKind::inner_particles)}) {
        const auto s = fixtures::make(fixtures::filled_for(model, fixtures::rectangle(0.04, 0.08)));
        Assembly assembly = assemble(*s, model, fixtures::granite(), fixtures::material(model));
        ContactFinder finder(assembly, kSkin);
        EXPECT_EQ(finder.update(assembly, 1.0).made, 0) << name(model.kind);
    }
}

}  // namespace
}  // namespace feldspar
