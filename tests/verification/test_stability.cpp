// The stability bound is the bound: settings above it are refused, and it is where motion starts to grow.
#include <gtest/gtest.h>

#include <cmath>

#include "feldspar/base/error.hpp"
#include "feldspar/base/rng.hpp"
#include "feldspar/lab/stability.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/fixtures.hpp"
#include "feldspar/model/masses.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

// Largest velocity after free vibration from a tiny disturbance, over the largest before.
double growth(Assembly assembly, Damping damping, double alpha, int steps) {
    Team team(1);
    RandomStream random(5, "disturbance");
    for (int n = 0; n < assembly.nodes.count(); ++n) {  // what is imposed stays at rest
        const Vec2 free = assembly.nodes.inverse_mass[n];
        assembly.nodes.velocity[n] = {free.x != 0.0 ? 1e-15 * random.normal() : 0.0,
                                      free.y != 0.0 ? 1e-15 * random.normal() : 0.0};
    }
    StepSettings settings;
    settings.damping = damping;
    settings.alpha = alpha;
    settings.strength = Strength::unlimited;
    PlatenWork work;
    advance(assembly, team, settings, 0, steps, work);
    double largest = 0.0;
    for (const Vec2 v : assembly.nodes.velocity) largest = std::isfinite(norm(v)) ? std::max(largest, norm(v)) : INFINITY;
    return largest / 5e-15;
}

TEST(Stability, MotionGrowsJustAboveTheLimitAndNotBelow) {
    Assembly assembly =
        assemble(*fixtures::make(fixtures::rectangle(0.02, 0.04)), ModelSpec{}, fixtures::granite(), fixtures::table7());
    Team team(1);
    set_scaled_masses(assembly, MassBound::tensor, 1.0);
    const double omega2 = largest_omega2(assembly, team);
    EXPECT_LT(omega2, 4.0);  // the tensor bound is rigorous
    EXPECT_GT(omega2, 3.0);  // and tight
    set_scaled_masses(assembly, MassBound::tensor, omega2 / 4.0 * 1.01);
    EXPECT_LT(growth(assembly, Damping::viscous, 0.0, 2000), 100.0);
    set_scaled_masses(assembly, MassBound::tensor, omega2 / 4.0 * 0.98);
    EXPECT_GT(growth(assembly, Damping::viscous, 0.0, 2000), 1e6);
}

TEST(Stability, LocalDampingLowersTheLimit) {
    Assembly assembly =
        assemble(*fixtures::make(fixtures::rectangle(0.02, 0.04)), ModelSpec{}, fixtures::granite(), fixtures::table7());
    set_scaled_masses(assembly, MassBound::row_sum, 1.7);
    EXPECT_LT(growth(assembly, Damping::local, 0.7, 2000), 10.0);
    set_scaled_masses(assembly, MassBound::row_sum, 1.0);  // m = 0.25 K as printed in the paper
    EXPECT_GT(growth(assembly, Damping::local, 0.7, 2000), 1e6);
    EXPECT_LT(growth(assembly, Damping::local, 0.0, 2000), 100.0);
}

TEST(Stability, LocalDampingNeedsATensorMassOfOnePlusAlphaWhateverPartOfTheMotionItActsOn) {
    Assembly assembly =
        assemble(*fixtures::make(fixtures::rectangle(0.02, 0.04)), ModelSpec{}, fixtures::granite(), fixtures::table7());
    Team team(1);
    set_scaled_masses(assembly, MassBound::tensor, 1.0);
    const double omega2 = largest_omega2(assembly, team);
    for (const double alpha : {0.3, 0.5, 0.7, 0.9}) {
        for (const double share : {0.0, 1.0}) {  // of the loading motion in what the damping leaves alone
            for (int n = 0; n < assembly.nodes.count(); ++n) assembly.nodes.loading_mode[n] = share * Vec2{0.3, -1.0};
            set_scaled_masses(assembly, MassBound::tensor, 1.0 + alpha);  // (M12) with (M6)
            EXPECT_LT(growth(assembly, Damping::local, alpha, 2000), 10.0) << alpha;
        }
        for (Vec2& B : assembly.nodes.loading_mode) B = {};
        set_scaled_masses(assembly, MassBound::tensor,
                          0.9 * (1.0 + alpha) * omega2 / 4.0);  // a tenth below what the eigenvalue asks
        EXPECT_GT(growth(assembly, Damping::local, alpha, 4000), 1e3) << alpha;
    }
}

class StabilityOfRigidModels : public testing::TestWithParam<ModelSpec> {};
INSTANTIATE_TEST_SUITE_P(Models, StabilityOfRigidModels, testing::ValuesIn(fixtures::rigid_models()),
                         [](const auto& tested) { return fixtures::label(tested.param); });

TEST_P(StabilityOfRigidModels, TheBoundHoldsAndIsTightWithPlatesAndMembranesToo) {
    for (const MethodId kind : std::initializer_list<MethodId>{methods::uniaxial_compression, methods::direct_tension,
                                                               methods::biaxial, methods::brazilian}) {
        TestSetup s = fixtures::setup(kind == methods::brazilian ? fixtures::disc(0.03) : fixtures::rectangle(0.02, 0.04), kind,
                                      GetParam());
        s.test.sigma3_Pa = kind == methods::biaxial ? 5e6 : 0.0;
        s.test.membrane_plates = 8;
        const RunControl control = fixtures::threads(1);
        Experiment e(s, control);
        set_scaled_masses(e.assembly, MassBound::tensor, 1.0);
        const double tensor = largest_omega2(e.assembly, e.team);
        EXPECT_LT(tensor, 4.0) << name(kind);
        EXPECT_GT(tensor, 3.0) << name(kind);
        set_scaled_masses(e.assembly, MassBound::row_sum, 1.7);
        EXPECT_LT(largest_omega2(e.assembly, e.team), 4.0 / 1.7) << name(kind);
    }
}

TEST_P(StabilityOfRigidModels, MotionGrowsJustAboveTheLimitAndNotBelow) {
    TestSetup s =
        fixtures::setup(fixtures::rectangle(0.014, 0.028), methods::direct_tension, GetParam());  // glued plates are linear
    const RunControl control = fixtures::threads(1);
    Experiment e(s, control);
    set_scaled_masses(e.assembly, MassBound::tensor, 1.0);
    const double omega2 = largest_omega2(e.assembly, e.team);
    set_scaled_masses(e.assembly, MassBound::tensor, omega2 / 4.0 * 1.01);
    EXPECT_LT(growth(e.assembly, Damping::viscous, 0.0, 1000), 100.0);
    set_scaled_masses(e.assembly, MassBound::tensor, omega2 / 4.0 * 0.98);
    EXPECT_GT(growth(e.assembly, Damping::viscous, 0.0, 1000), 1e6);
    set_scaled_masses(e.assembly, MassBound::row_sum, 1.7);
    EXPECT_LT(growth(e.assembly, Damping::local, 0.7, 1000), 10.0);
}

TEST(Stability, ThePrintedMassWithLocalDampingIsRefusedBeforeItRuns) {
    TestSetup s = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04)), methods::uniaxial_compression);
    s.numerics.kind = NumericsKind::paper;
    s.numerics.mass_factor = 1.0;
    try {
        preview_test(s, fixtures::threads(1));
        FAIL() << "an unstable setting was accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.place().key, "numerics.mass_factor");
        EXPECT_NE(std::string(error.what()).find("unstable"), std::string::npos);
    }
    s.numerics.mass_factor.reset();
    EXPECT_NO_THROW(preview_test(s, fixtures::threads(1)));
}

TEST(Stability, ATimeStepAboveTheLimitIsRefused) {
    TestSetup s = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04)), methods::uniaxial_compression);
    s.numerics.kind = NumericsKind::dynamic;
    s.numerics.speed_m = 0.1;
    const double stable = preview_test(s, fixtures::threads(1)).stable_time_step_s;
    EXPECT_GT(stable, 0.0);
    s.numerics.time_step_s = 0.99 * stable;
    EXPECT_NO_THROW(preview_test(s, fixtures::threads(1)));
    s.numerics.time_step_s = 1.01 * stable;
    EXPECT_THROW(preview_test(s, fixtures::threads(1)), InputError);
}

}  // namespace
}  // namespace feldspar
