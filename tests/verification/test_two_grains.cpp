// A bar of two grains pulled apart: every number is known beforehand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fixtures.hpp"

namespace feldspar {
namespace {

constexpr double kSide = 0.003;

TestSetup bar(MethodId kind) {
    TestSetup s = fixtures::setup(fixtures::two_grain_bar(kSide), kind);
    s.grain.nu = 0.0;  // the ends slide freely, so the bar is in uniaxial stress for any nu; 0 makes it homogeneous too
    s.test.stop_fraction = -1.0;  // to the end of the envelope and beyond
    s.test.maximum_strain = 0.0025;
    s.numerics.residual_target = 2e-4;
    return s;
}

TEST(TwoGrains, PulledApartTheyShowStiffnessStrengthAndFractureEnergy) {
    const TestSetup s = bar(methods::direct_tension);
    const TestResult r = run_test(s, fixtures::threads(1));
    const HistoryRow& elastic = r.history[10];
    ASSERT_EQ(elastic.phase, Phase::elastic);
    const double stiffness = elastic.axial_stress_Pa / elastic.platen_displacement_m;
    const double H = 2.0 * kSide, area = kSide * 0.08;
    EXPECT_NEAR(stiffness * (H / s.grain.E_Pa + 1.0 / s.contact.Kn_Pa_m), 1.0, 5e-3);
    EXPECT_NEAR(r.properties.peak_stress_Pa, 8.5e6, 5e-3 * 8.5e6);
    const EnergyLedger& e = r.energy_at_end;
    EXPECT_NEAR(e.supplied() / (s.contact.Gfn_J_m2 * area), 1.0, 5e-3);
    EXPECT_NEAR(e.fracture / (s.contact.Gfn_J_m2 * area), 1.0, 5e-3);
    EXPECT_LT(std::abs(r.history.back().axial_stress_Pa), 1e-3 * 8.5e6);
    ASSERT_EQ(r.cracks.size(), 3U);
    for (const Crack& crack : r.cracks) EXPECT_EQ(crack.mode, CrackMode::tensile);
}

TEST(TwoGrains, EndAtTheStressThatIsEnough) {
    TestSetup s = bar(methods::direct_tension);
    s.test.maximum_stress_Pa = 6e6;  // the strength is 8.5 MPa
    const TestResult r = run_test(s, fixtures::threads(1));
    EXPECT_FALSE(r.properties.peak_reached) << r.stop_reason;
    EXPECT_GE(r.properties.peak_stress_Pa, 6e6);
    EXPECT_LT(r.properties.peak_stress_Pa, 8.4e6);
    EXPECT_EQ(r.stop_reason, "the stress has reached its maximum of 6 MPa");
    EXPECT_TRUE(r.cracks.empty());
}

TEST(TwoGrains, BrittleContactBreaksAtItsStrengthAllAtOnce) {
    TestSetup s = bar(methods::direct_tension);
    s.contact.law = ContactLaw::brittle;
    const TestResult r = run_test(s, fixtures::threads(1));
    EXPECT_NEAR(r.properties.peak_stress_Pa, 8.5e6, 5e-3 * 8.5e6);
    ASSERT_EQ(r.cracks.size(), 3U);
    EXPECT_LE(r.cracks.back().step - r.cracks.front().step, 200);
}

TEST(TwoGrains, OnePointCarriesTheSameForceAsThree) {
    TestSetup s = bar(methods::direct_tension);
    s.model.contact = ContactKind::point;
    const TestResult r = run_test(s, fixtures::threads(1));
    EXPECT_NEAR(r.properties.peak_stress_Pa, 8.5e6, 5e-3 * 8.5e6);
    EXPECT_NEAR(r.energy_at_end.fracture / (s.contact.Gfn_J_m2 * kSide * 0.08), 1.0, 5e-3);
    EXPECT_EQ(r.cracks.size(), 1U);
}

TEST(TwoGrains, CompressionStaysElasticFarBeyondTheTensileStrength) {
    TestSetup s = bar(methods::uniaxial_compression);
    s.test.maximum_strain = 0.001;
    EXPECT_THROW(run_test(s, fixtures::threads(1)),
                 std::runtime_error);  // nothing ever comes closer to failure: said, not looped
    s.numerics.kind = NumericsKind::paper;
    s.numerics.speed_m = 3e-10;  // many travel times of a wave over 6 mm
    s.test.maximum_strain = 0.0001;
    const TestResult r = run_test(s, fixtures::threads(1));
    EXPECT_TRUE(r.cracks.empty());
    EXPECT_NEAR(r.history.back().axial_stress_Pa / r.history.back().axial_strain / s.grain.E_Pa,
                1.0 / (1.0 + s.grain.E_Pa / s.contact.Kn_Pa_m / (2.0 * kSide)), 0.01);
}

}  // namespace
}  // namespace feldspar
