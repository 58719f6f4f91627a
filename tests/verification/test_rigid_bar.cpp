// Two rigid grains, pulled, sheared and pressed: every number is known beforehand.
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

struct Torn {
    double work_J = 0.0, peak_N = 0.0;
    double damage = 0.0;
    double fracture_J = 0.0;
};

// The upper grain moves by `travel_m` in equal steps, along the normal or across it, and the contact tears.
Torn tear(ContactKind kind, bool shear, double travel_m) {
    Assembly assembly = assemble(*fixtures::two_grain_bar(kSide), fixtures::model(GrainKind::rigid, kind), fixtures::granite(),
                                 fixtures::table1(GrainKind::rigid));
    const int centre = assembly.bodies[1].centre_node;
    constexpr int kSteps = 300000;
    Torn torn;
    Vec2 before{};
    for (int k = 0; k < kSteps; ++k) {
        const Vec2 n = contact_frame(assembly, assembly.contacts[0]).n;
        const Vec2 move = (travel_m / kSteps) * (shear ? rot90(n) : n);
        assembly.nodes.velocity[centre] = move;
        assembly.nodes.displacement[centre] += move;
        contact_forces(assembly, {0, 1}, StepSettings{}, k);
        const Vec2 force = assembly.slots[1].force;
        torn.work_J -= 0.5 * dot(before + force, move);
        torn.peak_N = std::max(torn.peak_N, norm(force));
        before = force;
    }
    torn.damage = 1.0;
    for (int p = 0; p < std::ssize(assembly.points); ++p) {
        torn.damage = std::min(torn.damage, assembly.bond(p).damage);
        torn.fracture_J += assembly.bond(p).fracture_J;
    }
    return torn;
}

TEST(TwoRigidGrains, TornApartOrShearedOffTheyTakeTheFractureEnergyAndHaveTheStrength) {
    const ContactMaterial c = fixtures::table1(GrainKind::rigid);
    for (const ContactKind kind : {ContactKind::lobatto3, ContactKind::point}) {
        const Torn pulled = tear(kind, false, 4e-5);  // x_f = x0 + 2.5 L = 2.7e-5 m
        EXPECT_EQ(pulled.damage, 1.0) << name(kind);
        EXPECT_NEAR(pulled.work_J / (c.Gfn_J_m2 * kArea), 1.0, 1e-3) << name(kind);
        EXPECT_NEAR(pulled.fracture_J / (c.Gfn_J_m2 * kArea), 1.0, 1e-3) << name(kind);
        EXPECT_NEAR(pulled.peak_N / (c.sigma_nt_Pa * kArea), 1.0, 1e-4) << name(kind);
        const Torn sheared = tear(kind, true, 4e-4);  // x_f = 3.0e-4 m; the normal turns by a tenth on the way
        EXPECT_EQ(sheared.damage, 1.0) << name(kind);
        EXPECT_NEAR(sheared.work_J / (c.Gfs_J_m2 * kArea), 1.0, 1e-3) << name(kind);
        EXPECT_NEAR(sheared.fracture_J / (c.Gfs_J_m2 * kArea), 1.0, 1e-3) << name(kind);
        EXPECT_NEAR(sheared.peak_N / (c.tau_Pa * kArea), 1.0, 1e-4) << name(kind);
    }
}

TestSetup bar(MethodId kind, ContactKind contact) {
    TestSetup s = fixtures::setup(fixtures::two_grain_bar(kSide), kind);
    s.model = fixtures::model(GrainKind::rigid, contact);
    s.contact = fixtures::table1(GrainKind::rigid);
    s.test.stop_fraction = -1.0;  // to the end of the envelope and beyond
    s.numerics.residual_target = 2e-4;
    return s;
}

TEST(TwoRigidGrains, BetweenPlatesTheyHaveThreeContactsInSeries) {
    for (const ContactKind kind : {ContactKind::lobatto3, ContactKind::point}) {
        TestSetup s = bar(methods::direct_tension, kind);
        s.test.maximum_strain = 0.006;  // 3.6e-5 m, beyond x_f = 2.7e-5 m
        const TestResult r = run_test(s, fixtures::threads(1));
        const HistoryRow& elastic = r.history[10];
        ASSERT_EQ(elastic.phase, Phase::elastic);
        const double stiffness = elastic.axial_stress_Pa / elastic.platen_displacement_m;
        EXPECT_NEAR(stiffness * 3.0 / s.contact.Kn_Pa_m, 1.0, 1e-3) << name(kind);  // the relaxation's residual
        EXPECT_NEAR(r.properties.peak_stress_Pa / s.contact.sigma_nt_Pa, 1.0, 5e-3) << name(kind);
        for (const Crack& crack : r.cracks) EXPECT_EQ(crack.mode, CrackMode::tensile);
        // The plates hold each grain at one point, about which it may turn: once three points soften, pulling evenly is unstable
        // and one end of the edge opens before the other. One point knows no turning, and tears for the whole fracture energy.
        if (kind == ContactKind::lobatto3) {
            EXPECT_GE(r.cracks.size(), 1U);
            EXPECT_LE(r.energy_at_end.fracture / (s.contact.Gfn_J_m2 * kArea), 1.005);
            continue;
        }
        EXPECT_EQ(r.cracks.size(), 1U);
        EXPECT_NEAR(r.energy_at_end.supplied() / (s.contact.Gfn_J_m2 * kArea), 1.0, 5e-3);
        EXPECT_NEAR(r.energy_at_end.fracture / (s.contact.Gfn_J_m2 * kArea), 1.0, 5e-3);
        EXPECT_LT(std::abs(r.history.back().axial_stress_Pa), 5e-3 * s.contact.sigma_nt_Pa);  // what still rings
    }
}

TEST(TwoRigidGrains, TheStepOfABodyThatAttainsTheBoundKeepsAMargin) {
    // All stiffness of the two grains lies in one direction, where the bound behind the masses is exact.
    for (const NumericsKind kind : {NumericsKind::adaptive, NumericsKind::paper}) {
        TestSetup s = bar(methods::direct_tension, ContactKind::point);
        s.numerics.kind = kind;
        const TestPreview preview = preview_test(s, fixtures::threads(1));
        EXPECT_NEAR(preview.omega2 / preview.omega2_limit, 0.99, 1e-6) << name(kind);
    }
}

TEST(TwoRigidGrains, PressedBetweenPlatesTheyHaveThreeContactsInSeriesToo) {
    TestSetup s = bar(methods::uniaxial_compression, ContactKind::lobatto3);
    s.numerics.kind = NumericsKind::paper;
    s.numerics.speed_m = 3e-10;  // many travel times of a wave over 6 mm
    s.test.maximum_strain = 0.0001;
    const TestResult r = run_test(s, fixtures::threads(1));
    EXPECT_TRUE(r.cracks.empty());
    const HistoryRow& end = r.history.back();
    EXPECT_NEAR(end.axial_stress_Pa / end.platen_displacement_m * 3.0 / s.contact.Kn_Pa_m, 1.0, 0.01);  // waves that are left
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
    EXPECT_NEAR(assembly.bonds.at(point.state).Fn_N / (1.08e13 * 0.8 * kArea * 1e-8), 1.0, 1e-6);
    EXPECT_NEAR(assembly.nodes.force[upper].x / assembly.bonds.at(point.state).Fn_N, 1.0, 1e-6);
    // Sliding by 1e-6 m across: friction, limited by mu Fn.
    assembly.nodes.velocity[upper] = {0.0, 1e-6};
    contact_forces(assembly, {1, 2}, StepSettings{}, 0);
    EXPECT_NEAR(std::abs(assembly.bonds.at(point.state).Fs_N) / (0.5 * assembly.bonds.at(point.state).Fn_N), 1.0, 1e-12);
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
