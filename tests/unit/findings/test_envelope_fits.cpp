// Envelopes of rocks that follow a known law exactly, or scatter about it by known amounts.
#include <gtest/gtest.h>

#include <numbers>

#include "feldspar/findings/envelope_fits.hpp"
#include "synthetic_points.hpp"

namespace feldspar {
namespace {

constexpr double c_MPa = 21.0, phi_deg = 53.0;

double N() {
    const double sine = std::sin(phi_deg * std::numbers::pi / 180.0);
    return (1.0 + sine) / (1.0 - sine);
}
double line(double sigma3) { return 2.0 * c_MPa * std::sqrt(N()) + N() * sigma3; }
double parabola(double sigma3) { return sigma3 + 120.0 * std::sqrt(15.0 * sigma3 / 120.0 + 1.0); }

const EnvelopeConstant& constant(const EnvelopeFits& fits, const std::string& property) {
    for (const EnvelopeConstant& c : fits.constants)
        if (c.property == property) return c;
    throw std::logic_error("no constant " + property);
}

TEST(EnvelopeFits, AnExactLineIsFound) {
    const EnvelopeFits fits =
        fit_series(synthetic_series({1, 2, 3}, {3, 6, 12}, [](std::uint64_t, double s) { return line(s); }), false);
    ASSERT_EQ(fits.packings.size(), 3u);
    ASSERT_EQ(fits.strengths.size(), 4u);
    EXPECT_NEAR(constant(fits, "cohesion_Pa").packings.mean, c_MPa * in_MPa, 1.0);
    EXPECT_NEAR(constant(fits, "friction_angle_deg").packings.mean, phi_deg, 1e-6);
    EXPECT_NEAR(constant(fits, "mohr_coulomb_N").joint, N(), 1e-6);
    EXPECT_NEAR(constant(fits, "UCS_fitted_Pa").joint, line(0.0) * in_MPa, 1.0);
    EXPECT_NEAR(constant(fits, "mohr_coulomb_tension_Pa").joint, line(0.0) / N() * in_MPa, 1.0);
    EXPECT_NEAR(constant(fits, "cohesion_Pa").packings.low, c_MPa * in_MPa, 1.0);  // packings agree
    EXPECT_NEAR(fits.joint.mohr_coulomb.rms_Pa, 0.0, 1.0);
    EXPECT_NEAR(fits.joint.mohr_coulomb.R2, 1.0, 1e-9);
    EXPECT_GT(fits.joint.hoek_brown.rms_Pa, 1e5);
    EXPECT_LT(fits.mohr_coulomb.misfit_Pa, fits.hoek_brown.misfit_Pa);
}

TEST(EnvelopeFits, AnExactParabolaIsFoundWithItsTension) {
    const EnvelopeFits fits =
        fit_series(synthetic_series({1, 2}, {4, 10, 20}, [](std::uint64_t, double s) { return parabola(s); }), false);
    EXPECT_NEAR(fits.joint.fit.hoek_brown_mi, 15.0, 1e-6);
    EXPECT_NEAR(fits.joint.fit.hoek_brown_UCS_Pa, 120.0 * in_MPa, 10.0);
    EXPECT_NEAR(fits.joint.hoek_brown.rms_Pa, 0.0, 10.0);
    EXPECT_NEAR(fits.joint.hoek_brown_at(7.0 * in_MPa), parabola(7.0) * in_MPa, 10.0);
    // sigma_1 vanishes at -sigma_t
    const double tension = fits.joint.hoek_brown_tension_Pa;
    EXPECT_NEAR(fits.joint.hoek_brown_at(-tension), 0.0, 100.0);
    EXPECT_TRUE(std::isnan(fits.joint.hoek_brown_at(-3.0 * tension)));
    EXPECT_NEAR(constant(fits, "hoek_brown_tension_Pa").packings.mean, tension, 10.0);
}

TEST(EnvelopeFits, TensilePointsAreInOnlyWhenAsked) {
    std::vector<TestResult> results = synthetic_series({1, 2}, {4, 10, 20}, [](std::uint64_t, double s) { return parabola(s); });
    for (const std::uint64_t seed : {1, 2}) results.push_back(synthetic_test(methods::direct_tension, seed, 5.0));
    const EnvelopeFits without = fit_series(results, false), with = fit_series(results, true);
    EXPECT_NEAR(without.joint.fit.hoek_brown_mi, 15.0, 1e-6);
    EXPECT_GT(std::abs(with.joint.fit.hoek_brown_mi - 15.0), 0.01);
    EXPECT_DOUBLE_EQ(with.joint.fit.cohesion_Pa, without.joint.fit.cohesion_Pa);  // the line keeps to compression
    ASSERT_EQ(with.tension.size(), 1u);
    EXPECT_NEAR(with.tension.front().measured.mean, 5.0 * in_MPa, 1e-3);
    EXPECT_NE(with.method.find("-DTS"), std::string::npos);
    EXPECT_NE(without.method.find("no tensile points"), std::string::npos);
}

TEST(EnvelopeFits, IntervalsComeFromThePackings) {
    // three packings whose line stands 10 MPa lower or higher: cohesion scatters, the angle does not
    const EnvelopeFits fits = fit_series(
        synthetic_series({1, 2, 3}, {5, 10},
                         [](std::uint64_t seed, double s) { return line(s) + 10.0 * (static_cast<double>(seed) - 2.0); }),
        false);
    const MeanInterval ucs = constant(fits, "UCS_fitted_Pa").packings;
    EXPECT_EQ(ucs.count, 3);
    EXPECT_NEAR(ucs.mean, line(0.0) * in_MPa, 10.0);
    EXPECT_NEAR(ucs.half_width(), 4.302652729749 * 10.0 / std::sqrt(3.0) * in_MPa, 100.0);
    EXPECT_NEAR(constant(fits, "friction_angle_deg").packings.half_width(), 0.0, 1e-6);
    EXPECT_NEAR(fits.scatter_Pa, 10.0 * in_MPa, 10.0);
    EXPECT_NEAR(fits.joint.mohr_coulomb.rms_Pa, 10.0 * std::sqrt(2.0 / 3.0) * in_MPa, 10.0);
    EXPECT_EQ(fits.mohr_coulomb.through, 3);
    EXPECT_EQ(fits.mohr_coulomb.judged, 3);
}

TEST(EnvelopeFits, OnePackingHasFitsButNoInterval) {
    const EnvelopeFits fits =
        fit_series(synthetic_series({7}, {3, 6, 12}, [](std::uint64_t, double s) { return parabola(s); }), false);
    ASSERT_EQ(fits.packings.size(), 1u);
    EXPECT_EQ(fits.packings.front().fit.seed, 7u);
    EXPECT_TRUE(std::isnan(constant(fits, "hoek_brown_mi").packings.low));
    EXPECT_NEAR(constant(fits, "hoek_brown_mi").packings.mean, 15.0, 1e-6);
    EXPECT_TRUE(std::isnan(fits.scatter_Pa));
    EXPECT_NE(fits.verdict.find("One packing"), std::string::npos) << fits.verdict;
}

TEST(EnvelopeFits, OneConfiningStressSaysNothingOfTheCurve) {
    const EnvelopeFits fits = fit_series(synthetic_series({1, 2}, {10}, [](std::uint64_t, double s) { return line(s); }), false);
    EXPECT_NEAR(constant(fits, "cohesion_Pa").packings.mean, c_MPa * in_MPa, 1.0);
    EXPECT_TRUE(std::isnan(fits.joint.mohr_coulomb.R2));
    EXPECT_TRUE(std::isnan(fits.mohr_coulomb.misfit_Pa));
    EXPECT_NE(fits.verdict.find("Two confining stresses"), std::string::npos) << fits.verdict;
}

TEST(EnvelopeFits, WithoutConfinementThereIsNothingToFit) {
    const EnvelopeFits uniaxial =
        fit_series(synthetic_series({1, 2, 3}, {}, [](std::uint64_t, double s) { return line(s); }), false);
    EXPECT_TRUE(uniaxial.packings.empty());
    EXPECT_EQ(uniaxial.UCS_measured.count, 3);
    EXPECT_TRUE(uniaxial.method.empty());
    EXPECT_TRUE(fit_series({}, false).strengths.empty());
}

TEST(EnvelopeFits, TestsWithoutAPeakAreInNoFit) {
    std::vector<TestResult> results = synthetic_series({1, 2}, {5, 10}, [](std::uint64_t, double s) { return line(s); });
    results[1].properties.peak_reached = false;
    results[1].properties.peak_stress_Pa = 1.0;
    const EnvelopeFits fits = fit_series(results, false);
    EXPECT_EQ(fits.points.size(), 5u);
    EXPECT_NEAR(constant(fits, "cohesion_Pa").joint, c_MPa * in_MPa, 1.0);
}

}  // namespace
}  // namespace feldspar
