// A bar of two grains pulled apart: how it breaks and ends. Its numbers are checks of verify/two_grains.cpp.
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

TEST(TwoGrains, PulledApartTheyBreakInTensionAtAllTheirPoints) {
    const TestResult r = run_test(bar(methods::direct_tension), fixtures::threads(1));
    EXPECT_LT(std::abs(r.history.back().axial_stress_Pa), 1e-3 * r.properties.peak_stress_Pa);
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

TEST(TwoGrains, BrittleContactBreaksAllAtOnce) {
    TestSetup s = bar(methods::direct_tension);
    s.contact.law = ContactLaw::brittle;
    const TestResult r = run_test(s, fixtures::threads(1));
    ASSERT_EQ(r.cracks.size(), 3U);
    EXPECT_LE(r.cracks.back().step - r.cracks.front().step, 200);
}

TEST(TwoGrains, CompressionThatNeverComesCloserToFailureIsSaid) {
    TestSetup s = bar(methods::uniaxial_compression);
    s.test.maximum_strain = 0.001;
    EXPECT_THROW(run_test(s, fixtures::threads(1)),
                 std::runtime_error);  // nothing ever comes closer to failure: said, not looped
}

}  // namespace
}  // namespace feldspar
