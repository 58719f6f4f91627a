// Whole elastic specimens: what no closed form says of them. Those that one says are checks of verify/specimens.cpp and
// discs.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "feldspar/methods/flattened_disc.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

using fixtures::make;
using fixtures::setup;
using fixtures::threads;

TEST(ElasticBodies, AFlattenedDiscIsPressedOverItsFlatsAndItsStressIsTheLoadsTimesK) {
    SpecimenSpec spec = fixtures::disc(0.08);
    spec.outline.flat_angle_rad = 20.0 * std::numbers::pi / 180.0;
    TestSetup s = setup(make(spec), methods::brazilian);
    s.numerics.maximum_steps = 10;
    const TestResult r = run_test(s, threads(2));
    const HistoryRow& row = r.history.back();
    EXPECT_NEAR(row.contact_arc_top_deg, 20.0, 0.5) << "seen from the centre of the undeformed disc";
    EXPECT_NEAR(row.contact_arc_bottom_deg, 20.0, 0.5);
    const Experiment e(s, threads(1));
    EXPECT_NEAR(e.section_m2 * flat_coefficient(*s.specimen, s.model, s.grain, s.contact, s.test),
                0.5 * std::numbers::pi * 0.08 * 0.08, 1e-12);
    EXPECT_DOUBLE_EQ(e.length_m, 0.08 * std::cos(10.0 * std::numbers::pi / 180.0));
    EXPECT_NEAR(row.stress_top_Pa / row.stress_bottom_Pa, 1.0, 5e-3);
}

struct Elastic {
    double E_Pa, nu, top_over_bottom;
};

Elastic elastic_constants(PlaneState plane) {
    TestSetup s = setup(make(fixtures::rectangle(0.08, 0.16)), methods::uniaxial_compression);
    s.model.plane = plane;
    s.numerics.maximum_steps = 10;
    const TestResult r = run_test(s, threads(2));
    const auto start =
        std::find_if(r.history.begin(), r.history.end(), [](const HistoryRow& row) { return row.phase == Phase::loading; });
    return {start->axial_stress_Pa / start->axial_strain, -start->lateral_strain_gauge / start->axial_strain_gauge,
            start->stress_top_Pa / start->stress_bottom_Pa};
}

TEST(ElasticBodies, PaperSizeSpecimenHasThePrototypesConstants) {  // 24.3 GPa and 0.232, an independent program's
    const Elastic e = elastic_constants(PlaneState::stress);
    EXPECT_NEAR(e.E_Pa, 24.3e9, 0.02 * 24.3e9);
    EXPECT_NEAR(e.nu, 0.232, 0.01);
    EXPECT_NEAR(e.top_over_bottom, 1.0, 2e-3);
}

TEST(ElasticBodies, PlaneStrainGivesTheHigherRatio) {  // nu / (1 - nu) = 0.299 for the grains; the prototype's 0.296
    EXPECT_NEAR(elastic_constants(PlaneState::strain).nu, 0.296, 0.01);
}

TEST(ElasticBodies, ConsolidationIsIsotropicBeforeShearing) {
    for (const NumericsKind kind : {NumericsKind::adaptive, NumericsKind::paper}) {
        TestSetup s = setup(make(fixtures::rectangle(0.02, 0.04)), methods::biaxial);
        s.test.sigma3_Pa = 10e6;
        s.numerics.kind = kind;
        s.numerics.maximum_steps = 50;
        const TestResult r = run_test(s, threads(1));
        const auto isotropic = std::find_if(r.history.rbegin(), r.history.rend(),
                                            [](const HistoryRow& row) { return row.phase == Phase::consolidation; });
        ASSERT_NE(isotropic, r.history.rend());
        EXPECT_NEAR(isotropic->axial_stress_Pa, 10e6, 3e-3 * 10e6) << name(kind);  // the servo's own tolerance is 2e-3
        EXPECT_EQ(isotropic->sigma3_Pa, 10e6);
        // Isotropic plane stress: strain (1 - nu) sigma / E in the grains, and the contacts' share on top.
        EXPECT_NEAR(isotropic->axial_strain_gauge / isotropic->lateral_strain_gauge, 1.0, 0.1) << name(kind);
        EXPECT_NEAR(isotropic->axial_strain_gauge, 0.77 * 10e6 / 24.3e9, 0.08 * 0.77 * 10e6 / 24.3e9) << name(kind);
    }
}

}  // namespace
}  // namespace feldspar
