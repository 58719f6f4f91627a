#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "feldspar/base/regression.hpp"
#include "feldspar/lab/quantities.hpp"
#include "feldspar/lab/strength_envelope.hpp"
#include "synthetic_records.hpp"

using namespace feldspar;
using namespace feldspar::synthetic;

namespace {

TestResult tested(MethodId kind, std::uint64_t seed, double strength_Pa, double sigma3_Pa = 0.0) {
    TestResult r = linear(kind, strength_Pa, 100, kind == methods::direct_tension ? -1.0 : 1.0);
    r.seed = seed;
    r.test.sigma3_Pa = sigma3_Pa;
    r.properties = measure(r);
    return r;
}

}  // namespace

TEST(Regression, ExactLineAndDegenerateData) {
    const double x[] = {1.0, 2.0, 4.0}, y[] = {5.0, 7.0, 11.0};
    EXPECT_NEAR(regression_line(x, y).slope, 2.0, 1e-14);
    EXPECT_NEAR(regression_line(x, y).intercept, 3.0, 1e-14);
    const double same[] = {0.1, 0.1, 0.1};
    EXPECT_TRUE(std::isnan(regression_line(same, y).slope));
    EXPECT_TRUE(std::isnan(regression_line({x, 1}, {y, 1}).slope));
    EXPECT_TRUE(std::isnan(regression_line({}, {}).slope));
}

TEST(StrengthEnvelope, TheMeasuredUCSIsThatOfTheUniaxialTest) {
    const double phi = 53.0 * std::numbers::pi / 180.0, c = 21e6;
    const double N = (1.0 + std::sin(phi)) / (1.0 - std::sin(phi)), ucs = 2.0 * c * std::sqrt(N);
    const EnvelopeFit fit = fit_envelopes({0.0, 4e6, 10e6}, {ucs, ucs + N * 4e6, ucs + N * 10e6});
    EXPECT_DOUBLE_EQ(fit.UCS_measured_Pa, ucs);
}

TEST(StrengthEnvelope, LineOfMohrAndCoulomb) {
    const double phi = 53.0 * std::numbers::pi / 180.0, N = (1.0 + std::sin(phi)) / (1.0 - std::sin(phi));
    EXPECT_NEAR(mohr_coulomb_slope(53.0), N, 1e-12 * N);
    EXPECT_NEAR(mohr_coulomb_UCS_Pa(21e6, 53.0), 2.0 * 21e6 * std::sqrt(N), 1e-6);
    const EnvelopeFit fit = fit_envelopes({0.0, 4e6, 10e6}, {125e6, 125e6 + N * 4e6, 125e6 + N * 10e6});
    EXPECT_NEAR(fit.friction_angle_deg, 53.0, 1e-9);
    EXPECT_NEAR(mohr_coulomb_UCS_Pa(fit.cohesion_Pa, fit.friction_angle_deg), 125e6, 1e-3);
}

TEST(StrengthEnvelope, NotANumberWhereThePointsDecideNothing) {
    EXPECT_TRUE(std::isnan(fit_envelopes({4e6}, {150e6}).cohesion_Pa));
    EXPECT_TRUE(std::isnan(fit_envelopes({4e6, 4e6}, {150e6, 160e6}).friction_angle_deg)) << "one sigma_3 only";
    const EnvelopeFit falling = fit_envelopes({0.0, 10e6}, {120e6, 100e6});
    EXPECT_TRUE(std::isnan(falling.cohesion_Pa) && std::isnan(falling.friction_angle_deg));
    EXPECT_DOUBLE_EQ(falling.UCS_fitted_Pa, 120e6);
    EXPECT_TRUE(std::isnan(fit_envelopes({4e6, 10e6}, {150e6, 400e6}).hoek_brown_mi)) << "sigma_ci^2 would be negative";
    EXPECT_TRUE(std::isnan(fit_envelopes({4e6, 10e6}, {150e6, 190e6}).UCS_measured_Pa));
}

TEST(Summarise, MedianAndRangeOverPackings) {
    std::vector<TestResult> results;
    const double ucs[] = {120e6, 110e6, 130e6, 100e6}, dts[] = {8e6, 10e6, 8e6, 8e6}, bts[] = {6e6, 11e6, 9e6};
    for (int i = 0; i < 4; ++i) results.push_back(tested(methods::uniaxial_compression, 1 + i, ucs[i]));
    for (int i = 0; i < 4; ++i) results.push_back(tested(methods::direct_tension, 1 + i, dts[i]));
    for (int i = 0; i < 3; ++i) results.push_back(tested(methods::brazilian, 1 + i, bts[i]));
    const PropertySummary s = summarise(results);
    EXPECT_NEAR(s.values.at("UCS_Pa").median, 115e6, 1.0) << "even count: the mean of the middle two";
    EXPECT_NEAR(s.values.at("UCS_Pa").minimum, 100e6, 1.0);
    EXPECT_NEAR(s.values.at("UCS_Pa").maximum, 130e6, 1.0);
    EXPECT_EQ(s.values.at("UCS_Pa").seeds, (std::vector<std::uint64_t>{1, 2, 3, 4}));
    EXPECT_NEAR(s.values.at("BTS_Pa").median, 9e6, 1.0);
    EXPECT_NEAR(s.values.at("E_Pa").median / E, 1.0, 1e-12);
    EXPECT_NEAR(s.values.at("nu").median, nu, 1e-12);
    EXPECT_NEAR(s.values.at("UCS_over_DTS").median, 13.75, 1e-9) << "paired on each packing: 15, 11, 16.25, 12.5";
    EXPECT_NEAR(s.values.at("BTS_over_DTS").median, 1.1, 1e-9) << "0.75, 1.1, 1.125";
    EXPECT_EQ(s.values.at("UCS_over_BTS").seeds, (std::vector<std::uint64_t>{1, 2, 3}));
    EXPECT_EQ(s.values.count("cohesion_Pa"), 0u);
    EXPECT_EQ(s.values.count("sigma_cd_Pa"), 0u) << "no value, no entry";
    EXPECT_TRUE(s.envelope_method.empty());
}

TEST(Summarise, EnvelopesAreFittedOnEachPacking) {
    std::vector<TestResult> results;
    for (std::uint64_t seed : {1, 2, 3}) {
        const double N = 8.0 + static_cast<double>(seed), base = 110e6 + 5e6 * static_cast<double>(seed);
        results.push_back(tested(methods::uniaxial_compression, seed, base));
        results.push_back(tested(methods::biaxial, seed, base + N * 4e6, 4e6));
        results.push_back(tested(methods::biaxial, seed, base + N * 10e6, 10e6));
    }
    results.push_back(tested(methods::uniaxial_compression, 4, 90e6));  // no biaxial test: not in the fit
    const PropertySummary s = summarise(results);
    ASSERT_EQ(s.fits.size(), 3u);
    EXPECT_EQ(s.fits[1].seed, 2u);
    EXPECT_NEAR(s.fits[1].UCS_fitted_Pa, 120e6, 1.0);
    EXPECT_NEAR(s.values.at("UCS_fitted_Pa").median, 120e6, 1.0);
    EXPECT_NEAR(s.values.at("friction_angle_deg").median, std::asin(9.0 / 11.0) * 180.0 / std::numbers::pi, 1e-6);
    EXPECT_NEAR(s.values.at("cohesion_Pa").median, 120e6 / (2.0 * std::sqrt(10.0)), 1.0);
    EXPECT_NEAR(s.values.at("sigma1_at_sigma3_4MPa_Pa").median, 160e6, 1.0);
    EXPECT_NEAR(s.values.at("sigma1_at_sigma3_10MPa_Pa").maximum, 235e6, 1.0);
    EXPECT_EQ(s.values.count("hoek_brown_mi"), 1u);
    EXPECT_NE(s.envelope_method.find("uniaxial and biaxial tests (sigma_3 = 4, 10 MPa)"), std::string::npos) << s.envelope_method;
    EXPECT_NE(s.envelope_method.find("from 0 to 10 MPa"), std::string::npos);
    EXPECT_NE(s.envelope_method.find("3 packings (seeds 1, 2, 3)"), std::string::npos);
}

TEST(Summarise, StrengthsOfUnfinishedTestsAreLeftOut) {
    std::vector<TestResult> results{tested(methods::uniaxial_compression, 1, 120e6),
                                    tested(methods::uniaxial_compression, 2, 120e6)};
    results[0].history.resize(90);  // stopped on purpose: the modulus stands, the strength does not
    results[0].properties = measure(results[0]);
    results[1].history.resize(3);  // interrupted early
    results[1].properties = measure(results[1]);
    results[1].interrupted = true;
    const PropertySummary s = summarise(results);
    EXPECT_EQ(s.values.count("UCS_Pa"), 0u);
    ASSERT_EQ(s.values.count("E_Pa"), 1u);
    EXPECT_EQ(s.values.at("E_Pa").seeds, (std::vector<std::uint64_t>{1}));
}

namespace {

// A plane of 0.1 m x 0.05 m that is sheared: elastic to 0.2 mm, down to the residual strength at 0.3 mm, on to 2 mm; it dilates
// with a slope of 0.2 from 0.15 to 0.3 mm. Stresses on what is left of the plane are c + sigma tan(phi), and 2 MPa + sigma tan(30
// degrees) at last.
TestResult sheared(double sigma_Pa, double cohesion_Pa, double phi) {
    constexpr double L = 0.1, t = 0.05, peak_m = 0.2e-3, fallen_m = 0.3e-3, end_m = 2e-3;
    TestResult r = record(methods::direct_shear);
    r.test.sigma3_Pa = sigma_Pa;
    r.specimen = std::make_shared<Specimen>();
    r.length_m = L;
    r.section_m2 = L * t;
    r.gauges.resize(2);
    r.gauges[0].name = "dilation";
    r.gauges[1].name = "normal-force";
    const double strength_Pa = cohesion_Pa + sigma_Pa * std::tan(phi),
                 residual_Pa = 2e6 + sigma_Pa * std::tan(std::numbers::pi / 6.0);
    for (int i = -1; i <= 400; ++i) {
        const double u = std::max(0, i) * end_m / 400.0, left = (L - u) / L;
        const double tau = u <= peak_m     ? strength_Pa * u / peak_m
                           : u <= fallen_m ? strength_Pa + (residual_Pa - strength_Pa) * (u - peak_m) / (fallen_m - peak_m)
                                           : residual_Pa;
        HistoryRow h = row(i < 0 ? Phase::consolidation : Phase::loading, i, u / L, left * tau);
        h.platen_displacement_m = u;
        h.gauges = {0.2 * std::clamp(u - 0.15e-3, 0.0, 0.15e-3), left * sigma_Pa * L * t};
        r.history.push_back(h);
    }
    r.properties = measure(r);
    return r;
}

}  // namespace

TEST(Summarise, DirectShearGivesBackItsLinesAndItsDilation) {  // (P59)-(P63)
    const double phi = std::atan(0.8);
    const std::vector<TestResult> results{sheared(2e6, 5e6, phi), sheared(6e6, 5e6, phi), sheared(10e6, 5e6, phi)};
    for (const TestResult& r : results) {
        EXPECT_NEAR(test_quantity("shear_strength").value(r), 5e6 + 0.8 * r.test.sigma3_Pa, 1.0);
        EXPECT_NEAR(test_quantity("shear_normal_stress").value(r), r.test.sigma3_Pa, 1.0);
        EXPECT_NEAR(test_quantity("shear_strength_residual").value(r), 2e6 + r.test.sigma3_Pa / std::sqrt(3.0), 1.0);
        EXPECT_NEAR(test_quantity("dilation_angle").value(r), std::atan(0.2) * 180.0 / std::numbers::pi, 1e-6);
        EXPECT_NEAR(test_quantity("shear_stiffness").value(r) / ((5e6 + 0.8 * r.test.sigma3_Pa) / 0.2e-3), 1.0, 1e-9);
    }
    const PropertySummary s = summarise(results);
    ASSERT_EQ(s.shear_fits.size(), 1U);
    EXPECT_NEAR(s.values.at("shear_cohesion_Pa").median, 5e6, 10.0);
    EXPECT_NEAR(s.values.at("shear_friction_angle_deg").median, phi * 180.0 / std::numbers::pi, 1e-4);
    EXPECT_NEAR(s.values.at("residual_cohesion_Pa").median, 2e6, 10.0);
    EXPECT_NEAR(s.values.at("residual_friction_angle_deg").median, 30.0, 1e-4);
    EXPECT_TRUE(summarise({results.data(), 1}).shear_fits.empty());  // a line needs two points
    TestResult short_of_it = results[0];                             // the record ends before three times the way of the peak
    short_of_it.history.resize(102);
    short_of_it.properties = measure(short_of_it);
    EXPECT_TRUE(std::isnan(test_quantity("shear_strength_residual").value(short_of_it)));
}

TEST(Summarise, NothingGivesNothing) {
    EXPECT_TRUE(summarise({}).values.empty());
    EXPECT_TRUE(summarise({}).fits.empty());
}
