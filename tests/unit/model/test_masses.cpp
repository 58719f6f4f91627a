// Real masses are those of the bodies, and scaled ones make a step of 1 stable.
#include <gtest/gtest.h>

#include <cmath>

#include "feldspar/model/assemble.hpp"
#include "feldspar/model/masses.hpp"
#include "fixtures.hpp"

using namespace feldspar;

namespace {

constexpr double kDensity = 2650.0;

Assembly of(const Specimen& specimen, GrainKind grains) {
    return assemble(specimen, fixtures::model(grains), fixtures::granite(), fixtures::table7());
}

}  // namespace

// A third of each triangle's mass goes to each of its nodes, and all of a rigid grain's to its centre.
TEST(Masses, RealOnesAddUpToTheSpecimens) {
    const auto specimen = fixtures::make(fixtures::rectangle(0.02, 0.03));
    const double whole_kg = kDensity * 0.02 * 0.03 * specimen->spec.thickness_m;
    for (const GrainKind grains : {GrainKind::flexible, GrainKind::rigid}) {
        Assembly assembly = of(*specimen, grains);
        set_real_masses(assembly);
        double sum_kg = 0.0;
        for (const Body& body : assembly.bodies) {
            if (body.kind == BodyKind::rigid)
                sum_kg += assembly.nodes.mass[body.centre_node];
            else
                for (const int n : body.nodes()) sum_kg += assembly.nodes.mass[n];
        }
        EXPECT_NEAR(sum_kg / whole_kg, 1.0, 1e-9);  // sums of triangles against a product
    }
}

TEST(Masses, WeightIsThatOfTheSpecimenAndTurnsNothing) {
    const auto specimen = fixtures::make(fixtures::rectangle(0.02, 0.03));
    const double whole_kg = kDensity * 0.02 * 0.03 * specimen->spec.thickness_m;
    for (const GrainKind grains : {GrainKind::flexible, GrainKind::rigid}) {
        const Assembly assembly = of(*specimen, grains);
        Vec2 sum;
        for (const Vec2 weight : weights(assembly, {2.0, -9.81})) sum += weight;
        EXPECT_NEAR(sum.x, 2.0 * whole_kg, 1e-9 * whole_kg);
        EXPECT_NEAR(sum.y, -9.81 * whole_kg, 1e-9 * whole_kg);
        if (grains == GrainKind::rigid) {
            EXPECT_EQ(weights(assembly, {2.0, -9.81})[assembly.bodies[5].centre_node + 1], Vec2{});
        }
    }
}

// The rotation of a rigid body is an arc at its radius, so its inertia counts as a mass at that radius: m (gyration / radius)^2.
TEST(Masses, OfTheRotationIsTheMomentOfInertiaOverTheRadiusSquared) {
    const auto specimen = fixtures::make(fixtures::rectangle(0.02, 0.03));
    Assembly assembly = of(*specimen, GrainKind::rigid);
    set_real_masses(assembly);
    for (const Body& body : assembly.bodies) {
        const double mass_kg = assembly.nodes.mass[body.centre_node];
        EXPECT_NEAR(assembly.nodes.mass[body.centre_node + 1], mass_kg * body.gyration_m2 / (body.radius_m * body.radius_m),
                    1e-12 * mass_kg);
    }
}

// Twice the factor, twice the mass; and the tensor bound is never above that by sums of rows.
TEST(Masses, ScaledOnesAreInProportionToTheFactorAndTheTensorIsTheTighterBound) {
    const auto specimen = fixtures::make(fixtures::rectangle(0.02, 0.03));
    for (const GrainKind grains : {GrainKind::flexible, GrainKind::rigid}) {
        Assembly one = of(*specimen, grains), two = one, rows = one;
        set_scaled_masses(one, MassBound::tensor, 1.0);
        set_scaled_masses(two, MassBound::tensor, 2.0);
        set_scaled_masses(rows, MassBound::row_sum, 1.0);
        double tensor_kg = 0.0, rows_kg = 0.0;
        for (int n = 0; n < one.nodes.count(); ++n) {
            EXPECT_NEAR(two.nodes.mass[n], 2.0 * one.nodes.mass[n], 1e-12 * two.nodes.mass[n]);
            // The largest eigenvalue of a 2 x 2 matrix is at least half its larger sum of a row.
            EXPECT_GE(one.nodes.mass[n], 0.5 * (1.0 - 1e-12) * rows.nodes.mass[n]);
            tensor_kg += one.nodes.mass[n];
            rows_kg += rows.nodes.mass[n];
        }
        EXPECT_LE(tensor_kg, rows_kg);
    }
}
