// Servo control on real specimens: the strength is that of displacement control, and the branch behind it is followed with the
// books in order.
#include <gtest/gtest.h>

#include "fixtures.hpp"

namespace feldspar {
namespace {

TestResult followed(LoadControl control, MethodId kind = methods::uniaxial_compression, double stop_fraction = 0.4) {
    TestSetup setup = fixtures::setup(fixtures::make(fixtures::rectangle(0.024, 0.048)), kind);
    setup.test.control = control;
    setup.test.stop_fraction = stop_fraction;
    if (kind == methods::biaxial) setup.test.sigma3_Pa = 2e6;
    setup.numerics.accuracy = 0.02;
    return run_test(setup, {});
}

double slowest(const TestResult& result) {
    double speed = 0.0;
    for (const HistoryRow& row : result.history) speed = std::min(speed, row.platen_speed);
    return speed;
}

void expect_books_in_order(const TestResult& result) {
    EXPECT_LT(result.energy_residual, 1e-3) << "of the work supplied, at any row";
    double damping = 0.0;
    for (const HistoryRow& row : result.history) {
        // The ledger takes the half step beyond the state off (L13), so that a row may be behind the one before by that little.
        EXPECT_GE(row.energy.damping, damping - 1e-9 * row.energy.supplied());
        damping = row.energy.damping;
    }
}

class ServoBranch : public testing::TestWithParam<LoadControl> {};
INSTANTIATE_TEST_SUITE_P(Controls, ServoBranch, testing::Values(LoadControl::dissipation, LoadControl::lateral_strain),
                         [](const auto& tested) {
                             return tested.param == LoadControl::dissipation ? "dissipation" : "lateral_strain";
                         });

TEST_P(ServoBranch, HasTheStrengthOfDisplacementControlToTheBit) {
    const TestResult servo = followed(GetParam()), plain = followed(LoadControl::displacement);
    EXPECT_EQ(servo.properties.peak_stress_Pa, plain.properties.peak_stress_Pa);
    EXPECT_EQ(servo.evidence.error_estimate, plain.evidence.error_estimate);
    EXPECT_EQ(slowest(plain), 0.0) << "displacement control never goes back";
}

TEST_P(ServoBranch, IsFollowedDownByPlatensThatGoBack) {
    const TestResult result = followed(GetParam());
    EXPECT_EQ(result.stop_reason, "the stress has fallen to 40 % of the peak");
    EXPECT_LE(result.history.back().axial_stress_Pa, 0.4 * result.properties.peak_stress_Pa);
    EXPECT_LT(slowest(result), 0.0);
    EXPECT_TRUE(std::isfinite(result.properties.post_peak.brittleness));
    EXPECT_NEAR(result.properties.post_peak.fracture_share + result.properties.post_peak.friction_share +
                    result.properties.post_peak.damping_share,
                1.0, 1e-12);
    expect_books_in_order(result);
}

TEST(ServoBranch, UnderPressureItIsFollowedToo) {
    const TestResult result = followed(LoadControl::dissipation, methods::biaxial, 0.8);
    EXPECT_TRUE(result.properties.peak_reached);
    expect_books_in_order(result);
}

}  // namespace
}  // namespace feldspar
