// Rigid motions do nothing, homogeneous strains do what the closed form says, contacts conserve momentum.
#include <gtest/gtest.h>

#include <cmath>

#include "feldspar/base/rng.hpp"
#include "feldspar/lab/body_energy.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/attachment.hpp"
#include "feldspar/model/fixtures.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/step/step.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

using fixtures::granite;
using fixtures::make;
using fixtures::rectangle;
using fixtures::table7;

double largest_force(const Assembly& assembly) {
    double largest = 0.0;
    for (const Vec2 f : assembly.nodes.force) largest = std::max(largest, norm(f));
    return largest;
}

Assembly small_body() { return assemble(*make(rectangle(0.02, 0.04)), ModelSpec{}, granite(), table7()); }

// Force scale of the guide's check: E t x 1 mm.
double force_scale(const Assembly& assembly) { return 25.8e9 * assembly.thickness_m * 1e-3; }

TEST(Kinematics, RigidRotationMakesNoForceInTheTriangles) {
    Assembly assembly = small_body();
    Team team(1);
    for (int n = 0; n < assembly.nodes.count(); ++n)
        assembly.nodes.displacement[n] = turned(assembly.nodes.reference[n], 0.3) - assembly.nodes.reference[n];
    evaluate_forces(assembly, team, Strength::real);
    EXPECT_LT(largest_force(assembly) / force_scale(assembly), 1e-9);
}

TEST(Kinematics, RigidRotationInAThousandStepsOpensNoContact) {
    Assembly assembly = small_body();
    constexpr int kSteps = 1000;
    StepSettings settings;
    for (int k = 1; k <= kSteps; ++k) {
        for (int n = 0; n < assembly.nodes.count(); ++n) {
            const Vec2 X = assembly.nodes.reference[n], after = turned(X, 0.3 * k / kSteps) - X;
            assembly.nodes.velocity[n] = after - assembly.nodes.displacement[n];
            assembly.nodes.displacement[n] = after;
        }
        contact_forces(assembly, {0, static_cast<int>(assembly.contacts.size())}, settings, k);
    }
    double largest = 0.0;
    for (int p = 0; p < std::ssize(assembly.points); ++p)
        largest = std::max({largest, std::abs(assembly.bond(p).un_m), std::abs(assembly.bond(p).us_m)});
    EXPECT_LT(largest, 1e-15);
    EXPECT_GT(largest, 0.0);  // the points did move: an exact zero would mean that nothing was computed
}

TEST(Kinematics, HomogeneousStrainLeavesInteriorNodesAtRestAndHasItsClosedFormEnergy) {
    Assembly assembly = small_body();
    Team team(1);
    const double xx = 1e-6, yy = -2e-6, xy = 0.5e-6;
    for (int n = 0; n < assembly.nodes.count(); ++n) {
        const Vec2 X = assembly.nodes.reference[n];
        assembly.nodes.displacement[n] = {xx * X.x + xy * X.y, xy * X.x + yy * X.y};
    }
    evaluate_forces(assembly, team, Strength::real);
    double largest = 0.0, volume = 0.0;
    for (std::size_t g = 0; g < assembly.bodies.size(); ++g) {
        const Body& grain = assembly.bodies[g];
        const int vertices = grain.edge_end - grain.edge_begin;
        for (int i = vertices; i < grain.node_count; ++i) largest = std::max(largest, norm(assembly.nodes.force[grain.node(i)]));
    }
    for (const Triangle& t : assembly.triangles) volume += t.volume_m3;
    EXPECT_LT(largest / (25.8e9 * 2e-6 * assembly.thickness_m * 1e-3), 1e-8);  // over the forces that cancel
    const PlaneElasticity D = plane_elasticity(25.8e9, 0.23, PlaneState::stress);
    const double density = 0.5 * (D.D11 * (xx * xx + yy * yy) + 2.0 * D.D12 * xx * yy + 2.0 * (D.D11 - D.D12) * xy * xy);
    EXPECT_NEAR(stored_energy(assembly, 0.0).grains_J / (density * volume), 1.0, 1e-5);  // the strain itself is 2e-6
}

TEST(Kinematics, ContactForcesConserveLinearAndAngularMomentum) {
    Assembly assembly = small_body();
    RandomStream random(7, "momentum");
    for (int n = 0; n < assembly.nodes.count(); ++n) {
        const Vec2 X = assembly.nodes.reference[n];
        const Vec2 strain = {1e-4 * random.normal(), 1e-4 * random.normal()};  // large enough that shapes are extrapolated
        assembly.nodes.displacement[n] = turned(X, 0.1) - X + 1e-3 * strain;
        assembly.nodes.velocity[n] = {1e-9 * random.normal(), 1e-9 * random.normal()};
    }
    contact_forces(assembly, {0, static_cast<int>(assembly.contacts.size())}, StepSettings{}, 0);
    for (std::size_t c = 0; c < assembly.contacts.size(); ++c) {
        const Contact& contact = assembly.contacts[c];
        Vec2 sum;
        double moment = 0.0, size = 0.0;
        const auto on_corners = [&](const ContactSide& side, const SlotForces& slot) {
            return forces_on_corners(corners(assembly.nodes, side.node), assembly.centre(side.body), slot);
        };
        const auto on_a = on_corners(contact.a, assembly.slots[2 * c]), on_b = on_corners(contact.b, assembly.slots[2 * c + 1]);
        for (int i = 0; i < 3; ++i) {
            const Vec2 fa = on_a[i], fb = on_b[i];
            sum += fa + fb;
            moment +=
                cross(assembly.nodes.position(contact.a.node[i]), fa) + cross(assembly.nodes.position(contact.b.node[i]), fb);
            size += norm(fa) + norm(fb);
        }
        EXPECT_LT(norm(sum), 1e-12 * size);
        EXPECT_LT(std::abs(moment), 1e-11 * size * 0.04);  // lever arms of up to the body's height
    }
}

TEST(Kinematics, FallBackShapesAreUsedOnlyFarFromTheStartAndTheirMomentLossIsMeasured) {
    Assembly assembly = small_body();
    EXPECT_EQ(choose_shape_functions(assembly, 0.0).fallback_sides, 0);
    EXPECT_EQ(fallback_moment_loss(assembly), 0.0);
    const Contact& contact = assembly.contacts[0];
    for (const int n : assembly.bodies[contact.b.body].nodes())
        assembly.nodes.displacement[n] = {1.5e-3, 1.0e-3};  // half a grain away
    EXPECT_GT(choose_shape_functions(assembly, 0.0).fallback_sides, 0);
    ASSERT_TRUE(assembly.contacts[0].initial_shape);
    for (int n = 0; n < assembly.nodes.count(); ++n) assembly.nodes.velocity[n] = {1e-9 * (n % 7), -1e-9 * (n % 5)};
    contact_forces(assembly, {0, static_cast<int>(assembly.contacts.size())}, StepSettings{}, 0);
    EXPECT_GT(fallback_moment_loss(assembly), 0.0);
}

}  // namespace
}  // namespace feldspar
