#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "feldspar/lab/loading_curve.hpp"
#include "feldspar/methods/method.hpp"
#include "synthetic_records.hpp"

using namespace feldspar;
using namespace feldspar::synthetic;

TEST(Measure, LinearCompressionGivesBackItsConstants) {
    const TestProperties p = measure(linear(methods::uniaxial_compression, 120e6));
    EXPECT_DOUBLE_EQ(p.peak_stress_Pa, 120e6);
    EXPECT_TRUE(p.peak_reached);
    EXPECT_NEAR(p.E_secant_Pa / E, 1.0, 1e-12);
    EXPECT_NEAR(p.E_tangent_Pa / E, 1.0, 1e-12);
    EXPECT_NEAR(p.E_average_Pa / E, 1.0, 1e-12);
    EXPECT_NEAR(p.E_gauge_Pa / E, 1.0, 1e-12);
    EXPECT_NEAR(p.nu, nu, 1e-12);
    EXPECT_NEAR(p.E_initial_Pa / E, 1.0, 1e-12);
    EXPECT_NEAR(p.nu_initial, nu, 1e-12);
    EXPECT_TRUE(std::isnan(p.first_crack_Pa));
    EXPECT_TRUE(std::isnan(p.sigma_cd_Pa)) << "a linear body never dilates";
    EXPECT_TRUE(std::isnan(p.sigma_ci_crack_volume_Pa));
    EXPECT_TRUE(std::isnan(p.sigma_ci_lateral_strain_Pa));
    EXPECT_TRUE(std::isnan(p.sigma_ci_crack_count_Pa));
}

TEST(Measure, ARatioAboveOneHalfIsRemarkedOn) {
    TestResult r = linear(methods::uniaxial_compression, 120e6);
    EXPECT_TRUE(measure(r).remarks.empty());
    for (HistoryRow& row : r.history)
        if (row.axial_stress_Pa > 0.2 * 120e6) row.lateral_strain_gauge = -0.65 * row.axial_strain_gauge;  // cracks have opened
    const TestProperties p = measure(r);
    EXPECT_NEAR(p.nu, 0.65, 1e-12);
    ASSERT_EQ(p.remarks.size(), 1u);
    EXPECT_NE(p.remarks.front().find("0.65"), std::string::npos);
    EXPECT_NE(p.remarks.front().find(fmt::format("Before damage it is {:.3g}", nu)), std::string::npos) << p.remarks.front();
}

TEST(Measure, TensionRunsNegativeAndItsStrengthIsPositive) {
    const TestProperties p = measure(linear(methods::direct_tension, 8.3e6, 100, -1.0));
    EXPECT_NEAR(p.peak_stress_Pa, 8.3e6, 1.0);
    EXPECT_TRUE(p.peak_reached);
    EXPECT_NEAR(p.E_secant_Pa / E, 1.0, 1e-12);
    EXPECT_NEAR(p.nu, nu, 1e-12);
    EXPECT_TRUE(std::isnan(p.sigma_cd_Pa));
}

// sigma = E0 eps (1 - eps / (2 e0)) has its peak E0 e0 / 2 at e0, and sigma / peak = 2x - x^2 with x = eps / e0.
TEST(Measure, ParabolaSeparatesSecantTangentAndAverage) {
    const double E0 = 40e9, e0 = 6e-3, peak = 0.5 * E0 * e0;
    TestResult r = record(methods::uniaxial_compression);
    const int rows = 20000;
    for (int i = 1; i <= rows * 3 / 2; ++i) {
        const double x = static_cast<double>(i) / rows;
        r.history.push_back(row(Phase::loading, i, x * e0, peak * (2.0 * x - x * x)));
    }
    const TestProperties p = measure(r);
    EXPECT_NEAR(p.peak_stress_Pa / peak, 1.0, 1e-9);
    const double x50 = 1.0 - std::sqrt(0.5);
    EXPECT_NEAR(p.E_secant_Pa, 0.5 * peak / (x50 * e0), 1e-6 * E0);
    // The regression of a parabola over evenly spaced strains has the slope at the middle of the strain window.
    const auto middle_slope = [&](double a, double b) {
        const double xm = 0.5 * ((1.0 - std::sqrt(1.0 - a)) + (1.0 - std::sqrt(1.0 - b)));
        return E0 * (1.0 - xm);
    };
    EXPECT_NEAR(p.E_tangent_Pa, middle_slope(0.4, 0.6), 1e-4 * E0);
    EXPECT_NEAR(p.E_average_Pa, middle_slope(0.3, 0.7), 1e-4 * E0);
    EXPECT_NEAR(p.E_initial_Pa, middle_slope(0.0, 0.1), 1e-4 * E0);
    EXPECT_GT(p.E_secant_Pa, p.E_tangent_Pa);
}

TEST(Measure, ElasticStartOfTwoRowsIsEnough) {
    TestResult r = record(methods::uniaxial_compression);
    r.history.push_back(row(Phase::elastic, 0, 0.0, 0.0));
    r.history.push_back(row(Phase::elastic, 0, 80e6 / E, 80e6));  // 80 % of the peak in closed form
    r.history.push_back(row(Phase::loading, 10, 100e6 / E, 100e6));
    r.history.push_back(row(Phase::loading, 20, 101e6 / E, 50e6));
    TestProperties p = measure(r);
    EXPECT_NEAR(p.E_secant_Pa / E, 1.0, 1e-12);
    EXPECT_NEAR(p.E_tangent_Pa / E, 1.0, 1e-12);
    EXPECT_NEAR(p.E_average_Pa / E, 1.0, 1e-12);
    EXPECT_NEAR(p.nu, nu, 1e-12);
    r.history.erase(r.history.begin());  // the origin is known without a row
    p = measure(r);
    EXPECT_NEAR(p.E_tangent_Pa / E, 1.0, 1e-12);
}

TEST(Measure, BiaxialReadsTheDeviatorSinceTheStartOfShearing) {
    const double sigma3 = 10e6, strength = 180e6;
    TestResult r = record(methods::biaxial);
    r.test.sigma3_Pa = sigma3;
    for (int i = 1; i <= 5; ++i) {  // consolidation: other stiffness, other lateral strain
        HistoryRow h = row(Phase::consolidation, i, 3e-4 * i / 5.0, sigma3 * i / 5.0);
        h.lateral_strain_gauge = 3e-4 * i / 5.0;
        r.history.push_back(h);
    }
    for (int i = 1; i <= 200; ++i) {
        const double q = (strength - sigma3) * i / 200.0;
        HistoryRow h = row(Phase::loading, 10 * i, 3e-4 + q / E, sigma3 + q);
        h.lateral_strain_gauge = 3e-4 - nu * q / E;
        r.history.push_back(h);
    }
    r.history.push_back(row(Phase::loading, 3000, 9e-3, 100e6));
    const TestProperties p = measure(r);
    EXPECT_DOUBLE_EQ(p.peak_stress_Pa, strength) << "the total axial stress";
    EXPECT_NEAR(p.E_secant_Pa / E, 1.0, 1e-12);
    EXPECT_NEAR(p.E_tangent_Pa / E, 1.0, 1e-12);
    EXPECT_NEAR(p.E_gauge_Pa / E, 1.0, 1e-12);
    EXPECT_NEAR(p.nu, nu, 1e-10);

    r.history.erase(r.history.begin(),
                    r.history.begin() + 5);  // a record that lost its consolidation: the first row is the origin
    EXPECT_NEAR(measure(r).E_secant_Pa / E, 1.0, 1e-12);
}

// Stiffness E up to q = 82 MPa, then E / 2: half of the deviator at the peak (85 MPa) lies above the kink, half of the total
// stress (90 MPa, q = 80 MPa) below it.
TEST(Measure, BiaxialHalfOfThePeakIsHalfOfTheDeviator) {
    TestResult r = record(methods::biaxial);
    r.test.sigma3_Pa = 10e6;
    r.history.push_back(row(Phase::consolidation, 0, 3e-4, 10e6));
    for (int i = 1; i <= 170; ++i) {
        const double q = 1e6 * i;
        r.history.push_back(row(Phase::loading, i, 3e-4 + (q <= 82e6 ? q : 2.0 * q - 82e6) / E, 10e6 + q));
    }
    r.history.push_back(row(Phase::loading, 171, 2e-2, 20e6));
    EXPECT_NEAR(measure(r).E_secant_Pa / E, 85.0 / 88.0, 1e-12);
}

TEST(Measure, TheFirstDipOfADiscIsTheLargestStressBeforeAFallOfFivePercent) {
    TestResult r = record(methods::brazilian);
    long long step = 0;
    const auto add = [&](double stress) {
        ++step;
        r.history.push_back(row(Phase::loading, step, 1e-4 * static_cast<double>(step), stress));
    };
    for (double s : {0.2e6, 0.1e6, 1e6, 4e6, 6e6, 5.9e6, 6.2e6, 5.6e6, 5e6, 7e6, 9e6, 4e6})
        add(s);  // settling, a 2 % dip, the peak, a second one
    const TestProperties p = measure(r);
    EXPECT_DOUBLE_EQ(p.brazilian.first_dip_Pa, 6.2e6);
    EXPECT_DOUBLE_EQ(p.brazilian.largest_Pa, 9e6);
    EXPECT_DOUBLE_EQ(p.peak_stress_Pa, 9e6) << "the disc is whole: a lower bound of its strength";
    EXPECT_FALSE(p.peak_reached);
    EXPECT_TRUE(std::isnan(p.E_secant_Pa));
    EXPECT_TRUE(std::isnan(p.nu));
    EXPECT_TRUE(std::isnan(p.sigma_ci_crack_count_Pa));
    EXPECT_TRUE(std::isnan(p.sigma_cd_Pa));
}

TEST(Measure, PeakIsReachedOnlyAfterAFallOfFivePercent) {
    TestResult r = record(methods::uniaxial_compression);
    r.history = {row(Phase::loading, 1, 1e-3, 50e6), row(Phase::loading, 2, 2e-3, 100e6), row(Phase::loading, 3, 2.1e-3, 96e6)};
    EXPECT_FALSE(measure(r).peak_reached);
    r.history.push_back(row(Phase::loading, 4, 2.2e-3, 95e6));
    EXPECT_TRUE(measure(r).peak_reached);
    r.history.push_back(row(Phase::loading, 5, 3e-3, 110e6));  // climbs again: the new maximum is not passed yet
    EXPECT_FALSE(measure(r).peak_reached);
    EXPECT_DOUBLE_EQ(measure(r).peak_stress_Pa, 110e6);
}

TEST(Measure, StoppedBeforeThePeakKeepsModuliButNoThresholds) {
    TestResult r = linear(methods::uniaxial_compression, 60e6);
    r.history.resize(100);
    r.cracks = {crack(500, 30e6)};
    const TestProperties p = measure(r);
    EXPECT_FALSE(p.peak_reached);
    EXPECT_DOUBLE_EQ(p.peak_stress_Pa, 60e6);
    EXPECT_NEAR(p.E_tangent_Pa / E, 1.0, 1e-12);
    EXPECT_DOUBLE_EQ(p.first_crack_Pa, 30e6);
    EXPECT_TRUE(std::isnan(p.sigma_ci_crack_count_Pa));
}

TEST(Measure, DegenerateRecordsGiveNotANumberAndNeverCrash) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const MethodId kind : std::initializer_list<MethodId>{methods::uniaxial_compression, methods::direct_tension,
                                                               methods::biaxial, methods::brazilian}) {
        TestResult r = record(kind);
        r.test.sigma3_Pa = kind == methods::biaxial ? 4e6 : 0.0;
        const double sign = method_of(kind).loading.sign;
        EXPECT_TRUE(std::isnan(measure(r).peak_stress_Pa)) << name(kind) << ": empty";
        EXPECT_FALSE(measure(r).peak_reached);

        r.history = {row(Phase::consolidation, 1, 1e-4, 4e6)};
        EXPECT_TRUE(std::isnan(measure(r).peak_stress_Pa)) << name(kind) << ": consolidation only";

        r.history = {row(Phase::loading, 1, 0.0, 0.0), row(Phase::loading, 2, 0.0, 0.0)};
        EXPECT_TRUE(std::isnan(measure(r).peak_stress_Pa)) << name(kind) << ": all zero";

        r.history = {row(Phase::loading, 1, nan, nan)};
        EXPECT_TRUE(std::isnan(measure(r).peak_stress_Pa)) << name(kind) << ": not a number";

        r.history = {row(Phase::loading, 1, sign * 1e-4, sign * 5e6)};
        EXPECT_DOUBLE_EQ(measure(r).peak_stress_Pa, 5e6) << name(kind) << ": one row";

        r.history = {row(Phase::loading, 1, 0.0, sign * 5e6), row(Phase::loading, 2, 0.0, sign * 6e6),
                     row(Phase::loading, 3, 0.0, sign * 1e6)};
        EXPECT_TRUE(std::isnan(measure(r).E_secant_Pa)) << name(kind) << ": no strain";
        EXPECT_TRUE(std::isnan(measure(r).E_tangent_Pa)) << name(kind);

        r.history = {row(Phase::loading, 1, -sign * 1e-4, -sign * 5e6)};
        EXPECT_TRUE(std::isnan(measure(r).peak_stress_Pa)) << name(kind) << ": loaded the other way";

        r.history = {row(Phase::loading, 1, sign * 1e-4, sign * 5e6), row(Phase::loading, 2, sign * 2e-4, sign * 9e6),
                     row(Phase::loading, 3, sign * 2e-4, sign * 4e6)};
        for (HistoryRow& h : r.history) h.axial_strain_gauge = h.lateral_strain_gauge = nan;  // no gauges
        EXPECT_TRUE(std::isnan(measure(r).nu)) << name(kind);
        EXPECT_TRUE(std::isnan(measure(r).E_gauge_Pa)) << name(kind);
        EXPECT_TRUE(std::isnan(measure(r).sigma_cd_Pa)) << name(kind);
        EXPECT_NO_THROW(judge(r));
        EXPECT_NO_THROW(summarise({&r, 1}));
    }
}
