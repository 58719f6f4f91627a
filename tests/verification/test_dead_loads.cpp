// Direct shear and end plates with friction. Weight, sliding and springs are checks of verify/specimens.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fixtures.hpp"

namespace feldspar {
namespace {

TEST(DirectShear, HasItsNormalStressAndItsShearForceInBalance) {
    const RunControl control = fixtures::threads(1);
    for (const double stiffness_Pa_m : {0.0, 20e9}) {
        TestSetup s = fixtures::setup(fixtures::rectangle(0.04, 0.02), methods::direct_shear, ModelSpec{});
        s.test = usual_test(methods::direct_shear);
        s.test.sigma3_Pa = 5e6;
        s.test.maximum_strain = 0.01;
        s.test.stop_fraction = 0.8;
        if (stiffness_Pa_m > 0.0) s.test.own["normal_stiffness"] = {stiffness_Pa_m};
        const TestResult r = run_test(s, control);
        const auto value = [&](const char* name) {
            const auto properties = method_of(r.test).properties;
            for (std::size_t i = 0; i < properties.size(); ++i)
                if (properties[i].name == name) return r.properties.of_method[i];
            return std::nan("");
        };
        ASSERT_TRUE(r.properties.peak_reached);
        const HistoryRow& peak =
            *std::max_element(r.history.begin(), r.history.end(),
                              [](const HistoryRow& a, const HistoryRow& b) { return a.axial_stress_Pa < b.axial_stress_Pa; });
        EXPECT_GT(value("shear_strength"), 5e6);
        EXPECT_NEAR(peak.stress_bottom_Pa / peak.stress_top_Pa, 1.0, 0.02);
        const double left = r.length_m / (r.length_m - peak.platen_displacement_m);
        EXPECT_NEAR(value("shear_strength") / (left * r.properties.peak_stress_Pa), 1.0, 1e-3);
        const double given = 5e6 + stiffness_Pa_m * (peak.gauges[0] - r.history[1].gauges[0]);
        EXPECT_NEAR(value("shear_normal_stress") / (left * given), 1.0, 0.01)
            << stiffness_Pa_m;  // what a plate that moves lacks of balance
        EXPECT_LT(r.energy_residual, 2e-3);
    }
}

TEST(DirectShear, UnderANormalStressThatDamagesTheRockBeginsWithoutAComputedStart) {
    const RunControl control = fixtures::threads(1);
    TestSetup s = fixtures::setup(fixtures::rectangle(0.04, 0.02), methods::direct_shear, ModelSpec{});
    s.test = usual_test(methods::direct_shear);
    s.test.sigma3_Pa = 60e6;  // half of the strength in compression
    s.test.maximum_stress_Pa = 20e6;
    const TestResult r = run_test(s, control);
    EXPECT_TRUE(
        std::none_of(r.history.begin(), r.history.end(), [](const HistoryRow& row) { return row.phase == Phase::elastic; }));
    EXPECT_EQ(r.stop_reason, "the stress has reached its maximum of 20 MPa");
    for (const HistoryRow& row : r.history)
        if (row.phase == Phase::loading) {
            EXPECT_NEAR(row.gauges[1] / (60e6 * r.section_m2), 1.0, 0.02);  // the ramp comes to rest within a hundredth
        }
    EXPECT_LT(r.energy_residual, 2e-3);
}

TEST(EndPlates, WithFrictionHoldTheEndsOfASquatSpecimen) {
    const RunControl control = fixtures::threads(1);
    std::array<double, 2> strength{};
    std::array<double, 2> spread{};
    for (const bool rubs : {false, true}) {
        TestSetup s = fixtures::setup(fixtures::rectangle(0.04, 0.02), methods::uniaxial_compression, ModelSpec{});
        if (rubs) s.test.plate_mu = 0.1;
        const TestResult r = run_test(s, control);
        strength[rubs] = r.properties.peak_stress_Pa;
        spread[rubs] = r.properties.nu_initial;
        EXPECT_LT(r.energy_residual, 2e-3);
    }
    EXPECT_GT(strength[1], 1.3 * strength[0]);  // half as high as wide, so it is confined from end to end; measured 1.68
    EXPECT_LT(spread[1], 0.8 * spread[0]);      // measured 0.145 and 0.231
}

TEST(Weight, DoesNotTakeTheSpecimenAwayFromThePlateThatLoadsIt) {
    RunControl control = fixtures::threads(1);
    long long told = -1;  // the last step of the computed start that was told
    control.progress = [&](const TestProgress& p) {
        if (p.stage != "elastic start") return;
        EXPECT_GE(p.step, told);
        EXPECT_LT(p.seconds_left, 0.0) << "nobody knows";
        told = p.step;
    };
    for (const bool weighs_much : {false, true})
        for (const GrainKind kind : {GrainKind::flexible, GrainKind::rigid}) {
            TestSetup s = fixtures::setup(fixtures::rectangle(0.02, 0.04), methods::custom, fixtures::model(kind));
            s.test = usual_test(methods::custom);
            s.test.custom.name = "press";
            // By its weight the column shortens by much more than the first motion of the press; of the larger one, which would
            // damage it, the ramp brings a share after the other.
            s.test.custom.gravity_m_s2 = {0.0, weighs_much ? -8e5 : -1e3};
            s.test.maximum_stress_Pa = weighs_much ? 1e6 : 2e5;
            s.test.custom.fixtures.resize(2);
            for (const bool press : {false, true}) {
                FixtureSpec& plate = s.test.custom.fixtures[press];
                plate.name = press ? "press" : "table";
                plate.kind = FixtureKind::plate;
                plate.part.label = press ? "top" : "bottom";
                plate.normal = {0.0, press ? 1.0 : -1.0};
                plate.contact.mu = 0.4;
                if (press) plate.motion = {0.0, -1.0};
            }
            told = -1;
            Experiment e(s, control);
            choose_step(e);
            prepare(e);
            if (!weighs_much) {
                EXPECT_LE(e.preparation_steps - told, 100);  // a word at least so often
            }
            const Body& press = e.assembly.bodies[e.assembly.fixtures[1].plate];
            const double gone_m = -e.assembly.nodes.displacement[press.centre_node].y;
            constexpr double kDensity = 2650.0, kE_Pa = 25.8e9, kHeight_m = 0.04;
            const double shortened_m = -0.5 * kDensity * s.test.custom.gravity_m_s2.y * kHeight_m * kHeight_m / kE_Pa;
            EXPECT_EQ(e.computed_start, !weighs_much);
            EXPECT_GT((gone_m - e.platen_travel_m) / shortened_m, 0.9) << name(kind);  // after the column: no loading motion
            EXPECT_EQ(e.consolidated.platen_displacement_m, 0.0);
            EXPECT_NEAR(e.consolidated.stress_top_Pa / s.test.maximum_stress_Pa.value(), 0.0, 1e-3);  // just in touch
            evaluate_forces(e.assembly, e.team, Strength::real);
            EXPECT_GT(loading_reaction(e.assembly), 0.0) << name(kind) << (weighs_much ? ", heavy" : "");
        }
}

}  // namespace
}  // namespace feldspar
