// How rigid grains and inner particles are loaded: plates at the ends and on a disc, and the membrane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "feldspar/base/error.hpp"
#include "feldspar/lab/grain_fields.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/fixtures.hpp"
#include "feldspar/step/step.hpp"
#include "fixtures.hpp"
#include "plate_checks.hpp"

namespace feldspar {
namespace {

std::vector<ModelSpec> plate_models() { return {fixtures::model(GrainKind::rigid), fixtures::model(GrainKind::inner_particles)}; }

class PlatesOf : public testing::TestWithParam<ModelSpec> {};
INSTANTIATE_TEST_SUITE_P(Models, PlatesOf, testing::ValuesIn(plate_models()),
                         [](const auto& tested) { return fixtures::label(tested.param); });

TEST_P(PlatesOf, EndsCoverTheWholeSectionAndTouchEveryGrainThere) {
    const TestSetup s = fixtures::setup(fixtures::rectangle(0.02, 0.04), methods::uniaxial_compression, GetParam());
    const RunControl control = fixtures::threads(1);
    const Experiment e(s, control);
    EXPECT_EQ(e.assembly.laws[at_plates].mu, 0.0);
    EXPECT_EQ(e.assembly.laws[at_plates].Kn_Pa_m, s.contact.Kn_Pa_m);
    for (const Fixture& platen : e.assembly.fixtures) {
        double area = 0.0, sites = 0.0;
        for (const Contact* contact : contacts_of(e.assembly, platen.plate)) {
            const ContactPoint& point = e.assembly.points[contact->first_point];
            const ContactOrigin& origin = e.assembly.origins[contact - e.assembly.contacts.data()];
            EXPECT_DOUBLE_EQ(point.area_m2, norm(origin.to - origin.from) * e.assembly.thickness_m);
            EXPECT_NEAR(e.assembly.bonds.at(point.state).un_m, 0.0, 1e-15);  // the end is straight: all touch at once
            area += point.area_m2;
            ++sites;
        }
        EXPECT_NEAR(area / (0.02 * 0.08), 1.0, 1e-12);
        EXPECT_GE(sites, 5);
    }
    EXPECT_NEAR(e.section_m2 / (0.02 * 0.08), 1.0, 1e-12);
}

TEST_P(PlatesOf, OnADiscHaveTheStiffnessOfTheirDiametersAndStartAtFirstTouch) { expect_plates_on_a_disc(GetParam()); }  // (C19)

TEST_P(PlatesOf, FeelTheSumOfTheirContactsForces) {
    TestSetup s = fixtures::setup(fixtures::disc(0.03), methods::brazilian, GetParam());
    const RunControl control = fixtures::threads(1);
    Experiment e(s, control);
    choose_step(e);
    prepare(e);
    evaluate_forces(e.assembly, e.team, Strength::real);
    const Reactions reactions = feldspar::reactions(e.assembly);
    for (int side = 0; side < 2; ++side) {
        double sum = 0.0;
        for (const Contact* contact : contacts_of(e.assembly, e.assembly.fixtures[side].plate))
            sum += e.assembly.bond(contact->first_point).Fn_N * e.assembly.bodies[contact->b.body].normal.y;
        EXPECT_GT(std::abs(sum), 0.0);
        EXPECT_NEAR((side == 0 ? reactions.loading : -reactions.rest) / sum, 1.0, 1e-12);
    }
    EXPECT_NEAR(reactions.loading / reactions.rest, 1.0, 2e-3);
}

TestSetup pressed(const ModelSpec& model, NumericsKind numerics) {
    TestSetup s = fixtures::setup(fixtures::rectangle(0.02, 0.04), methods::biaxial, model);
    s.test.sigma3_Pa = 5e6;
    s.test.membrane_plates = 8;  // of 5 mm, each with a grain behind it
    s.numerics.kind = numerics;
    return s;
}

TEST_P(PlatesOf, MembranesMoveSidewaysOnlyAndCarryThePressureOverTheWholeHeight) {
    TestSetup s = fixtures::setup(fixtures::rectangle(0.02, 0.08), methods::biaxial, GetParam());  // with the usual 16 plates
    s.test.sigma3_Pa = 5e6;
    const RunControl control = fixtures::threads(1);
    Experiment e(s, control);
    Assembly& assembly = e.assembly;
    std::array<std::vector<int>, 2> sides;  // left, right
    std::array<double, 2> covered{};
    for (int b = 0; b < std::ssize(assembly.bodies); ++b) {
        const Body& body = assembly.bodies[b];
        if (body.kind != BodyKind::plate || b == assembly.fixtures[0].plate || b == assembly.fixtures[1].plate) continue;
        const int side = body.normal.x < 0.0 ? 0 : 1;
        sides[side].push_back(b);
        EXPECT_NE(assembly.nodes.inverse_mass[body.centre_node].x, 0.0);
        EXPECT_EQ(assembly.nodes.inverse_mass[body.centre_node].y, 0.0);
        for (const Contact* contact : contacts_of(assembly, b)) {
            EXPECT_EQ(contact->material, at_membranes);
            covered[side] += assembly.points[contact->first_point].area_m2;
        }
    }
    EXPECT_EQ(assembly.laws[at_membranes].mu, 0.0);
    Team team(1);
    for (const double displaced : {0.0, 1e-3}) {  // plates keep their length
        for (int side = 0; side < 2; ++side)
            for (const int b : sides[side])
                assembly.nodes.displacement[assembly.bodies[b].centre_node].x = (side == 0 ? -1.0 : 1.0) * displaced;
        for (DeadLoad& load : assembly.dead_loads) load.pressure_Pa = 0.0;
        evaluate_forces(assembly, team, Strength::real);
        const Array<Vec2> without = assembly.nodes.force;
        for (DeadLoad& load : assembly.dead_loads) load.pressure_Pa = 5e6;
        evaluate_forces(assembly, team, Strength::real);
        for (int side = 0; side < 2; ++side) {
            ASSERT_EQ(sides[side].size(), 16U);
            EXPECT_NEAR(covered[side] / (0.08 * 0.08), 1.0, 1e-12);
            Vec2 force;
            for (const int b : sides[side])
                force += assembly.nodes.force[assembly.bodies[b].centre_node] - without[assembly.bodies[b].centre_node];
            EXPECT_NEAR(force.x / ((side == 0 ? 1.0 : -1.0) * 5e6 * 0.08 * 0.08), 1.0, 1e-12);
            EXPECT_EQ(force.y, 0.0);
        }
    }
}

// Mean over the specimen, tension positive.
Mat2 mean_stress(const Experiment& e) {
    const std::vector<Mat2> stresses = grain_stresses(e.assembly, *e.setup.specimen);
    std::vector<double> volume(stresses.size(), 0.0);
    for (const Body& body : e.assembly.bodies)
        if (body.grain >= 0) volume[body.grain] += body.volume_m3;
    Mat2 mean;
    double whole = 0.0;
    for (std::size_t g = 0; g < volume.size(); ++g) whole += volume[g];
    for (std::size_t g = 0; g < volume.size(); ++g) {
        mean.xx += volume[g] / whole * stresses[g].xx;
        mean.xy += volume[g] / whole * stresses[g].xy;
        mean.yy += volume[g] / whole * stresses[g].yy;
    }
    return mean;
}

TEST_P(PlatesOf, ConsolidationIsIsotropicBeforeShearing) {
    for (const NumericsKind kind : {NumericsKind::adaptive, NumericsKind::paper}) {
        TestSetup s = pressed(GetParam(), kind);
        const RunControl control = fixtures::threads(1);
        Experiment e(s, control);
        choose_step(e);
        prepare(e);
        EXPECT_NEAR(e.consolidated.axial_stress_Pa / 5e6, 1.0, 3e-3) << name(kind);  // the servo's own tolerance is 2e-3
        EXPECT_EQ(e.consolidated.sigma3_Pa, 5e6);
        EXPECT_NEAR(e.consolidated.axial_strain_gauge / e.consolidated.lateral_strain_gauge, 1.0, 0.2)
            << name(kind);  // some ten grains wide
        // The computed start has gone on to the first damage; the plain one stands at the isotropic state, at rest to a
        // hundredth.
        evaluate_forces(e.assembly, e.team, Strength::unlimited);
        const Reactions reactions = feldspar::reactions(e.assembly);
        const Mat2 mean = mean_stress(e);
        const double axial = e.stress(0.5 * (reactions.loading + reactions.rest));
        EXPECT_NEAR(mean.xx / -5e6, 1.0, 0.01) << name(kind);
        EXPECT_NEAR(mean.yy / -axial, 1.0, 0.01) << name(kind);
        EXPECT_LT(std::abs(mean.xy), 0.02 * axial) << name(kind);
        if (kind == NumericsKind::paper) {
            EXPECT_NEAR(axial / 5e6, 1.0, 0.01);
        } else {
            EXPECT_GT(axial, 10e6);
        }
    }
}

TEST(Membranes, APlateWithoutAGrainBehindItIsRefused) {
    TestSetup s = pressed(fixtures::model(GrainKind::rigid), NumericsKind::adaptive);
    s.test.membrane_plates = 16;  // of 2.5 mm, where grains are up to 4 mm
    const RunControl control = fixtures::threads(1);
    try {
        const Experiment e(s, control);
        FAIL() << "a plate that touches nothing was accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.place().key, "membrane_plates");
        EXPECT_NE(std::string(error.what()).find("too many"), std::string::npos);
    }
}

TEST_P(PlatesOf, SlantedSidesAreRefusedUnderAMembrane) {
    SpecimenSpec spec = fixtures::rectangle(0.0, 0.0);
    spec.outline.shape = Shape::polygon;
    spec.outline.vertices_m = {{0, 0}, {0.02, 0}, {0.018, 0.04}, {0.002, 0.04}};
    spec.outline.edge_labels = {"bottom", "right", "top", "left"};
    TestSetup s = fixtures::setup(spec, methods::biaxial, GetParam());
    s.test.sigma3_Pa = 5e6;
    const RunControl control = fixtures::threads(1);
    try {
        const Experiment e(s, control);
        FAIL() << "a slanted side was accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("not vertical"), std::string::npos);
    }
    s.test.sigma3_Pa = 0.0;
    EXPECT_NO_THROW(Experiment(s, control));  // without a membrane they may be
    s.model = fixtures::model(GrainKind::flexible);
    s.contact = fixtures::table7();
    s.test.sigma3_Pa = 5e6;
    EXPECT_NO_THROW(Experiment(s, control));  // and flexible grains are pressed directly
}

// The pressure on the sides is given, and exact. The platens follow it by a servo.
TEST(Consolidation, ComesToItsPressureWithoutOvershoot) {
    for (const ModelSpec& model : {ModelSpec{}, fixtures::model(GrainKind::rigid)}) {
        TestSetup s = fixtures::setup(fixtures::rectangle(0.02, 0.04), methods::biaxial, model);
        s.test.sigma3_Pa = 10e6;
        s.test.membrane_plates = 4;
        s.test.maximum_strain = 1e-4;
        s.numerics.kind = NumericsKind::paper;  // whose consolidation is always the ramp
        double largest_Pa = 0.0;
        RunControl control = fixtures::threads(1);
        control.progress = [&](const TestProgress& p) {
            if (p.stage == "consolidation") largest_Pa = std::max(largest_Pa, p.axial_stress_Pa);
        };
        Experiment e(s, control);
        choose_step(e);
        prepare(e);
        EXPECT_GT(largest_Pa, 9.9e6) << name(model.kind);
        EXPECT_LT(largest_Pa, 1.005 * 10e6) << name(model.kind);
        EXPECT_EQ(e.consolidated.sigma3_Pa, 10e6);
        EXPECT_NEAR(e.consolidated.axial_stress_Pa, 10e6, 0.005 * 10e6) << name(model.kind);
    }
}

}  // namespace
}  // namespace feldspar
