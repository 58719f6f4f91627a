#include "feldspar/lab/damage_thresholds.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "synthetic_records.hpp"

using namespace feldspar;
using namespace feldspar::synthetic;

namespace {

constexpr double peak = 120e6, ci = 54e6;

/// Axially linear; the lateral strain is elastic up to `ci`, then grows by b (sigma - ci)^2 more.
/// With eps_v = sigma (1 - nu) / E - b (sigma - ci)^2 the volumetric strain turns at ci + (1 - nu) / (2 b E).
TestResult dilating(double b, double offset_Pa = 0.0, int rows = 1200) {
    TestResult r = record(offset_Pa > 0.0 ? methods::biaxial : methods::uniaxial_compression);
    r.test.sigma3_Pa = offset_Pa;
    if (offset_Pa > 0.0) r.history.push_back(row(Phase::consolidation, 0, 0.0, offset_Pa));
    for (int i = 1; i <= rows; ++i) {
        const double q = peak * i / rows;
        HistoryRow h = row(Phase::loading, i, q / E, q + offset_Pa);
        if (q > ci) h.lateral_strain_gauge -= b * (q - ci) * (q - ci);
        r.history.push_back(h);
    }
    r.history.push_back(row(Phase::loading, rows + 1, peak / E, 0.5 * peak));
    return r;
}

constexpr double cd = 95e6;
const double b_for_cd = (1.0 - nu) / (2.0 * E * (cd - ci));

}  // namespace

TEST(DamageThresholds, VolumetricReversalIsSigmaCd) {
    EXPECT_NEAR(measure(dilating(b_for_cd)).sigma_cd_Pa, cd, 0.2e6);
    EXPECT_NEAR(measure(dilating(b_for_cd, 10e6)).sigma_cd_Pa, cd + 10e6, 0.2e6) << "biaxial: total sigma_1";
    EXPECT_TRUE(std::isnan(measure(dilating(0.3 * b_for_cd)).sigma_cd_Pa)) << "turns only beyond the peak";
}

TEST(DamageThresholds, CrackVolumetricStrainTurnsAtSigmaCi) {
    const TestProperties p = measure(dilating(b_for_cd));
    // Departure is seen once b (sigma - ci)^2 = 0.002 (1 - nu) peak / E.
    const double seen = ci + std::sqrt(0.002 * (1.0 - nu) * peak / E / b_for_cd);
    EXPECT_NEAR(p.sigma_ci_crack_volume_Pa, seen, 0.3e6);
    EXPECT_NEAR(measure(dilating(b_for_cd, 10e6)).sigma_ci_crack_volume_Pa, seen + 10e6, 0.3e6);
}

TEST(DamageThresholds, AStrayFirstCrackDoesNotSpoilTheElasticPart) {
    TestResult r = dilating(b_for_cd);
    const double without = measure(r).sigma_ci_crack_volume_Pa;
    r.cracks = {crack(5, 0.5e6)};
    EXPECT_NEAR(measure(r).sigma_ci_crack_volume_Pa, without, 0.3e6);
}

// Extra lateral strain g(sigma) = b (sigma - ci)^2 above ci; the distance to the line ending at cd is
// sigma g(cd) / cd - g(sigma), largest where g'(sigma) = g(cd) / cd.
TEST(DamageThresholds, LateralStrainResponse) {
    const TestProperties p = measure(dilating(b_for_cd));
    const double expected = ci + (cd - ci) * (cd - ci) / (2.0 * cd);
    EXPECT_NEAR(p.sigma_ci_lateral_strain_Pa, expected, 0.3e6);
    EXPECT_LT(p.sigma_ci_lateral_strain_Pa, p.sigma_cd_Pa);
}

TEST(DamageThresholds, CrackCountTakesOnePercentOfTheCracksAtThePeak) {
    TestResult r = dilating(b_for_cd);
    for (int i = 0; i < 250; ++i) r.cracks.push_back(crack(500 + i, 50e6 + 0.1e6 * i));
    for (int i = 0; i < 1000; ++i) r.cracks.push_back(crack(1201 + i, 60e6));  // after the peak: not counted
    EXPECT_NEAR(measure(r).sigma_ci_crack_count_Pa, 50.2e6, 1.0) << "the third of 250";
    EXPECT_DOUBLE_EQ(measure(r).first_crack_Pa, 50e6);
    std::swap(r.cracks[0], r.cracks[249]);  // the order of the list does not matter
    EXPECT_NEAR(measure(r).sigma_ci_crack_count_Pa, 50.2e6, 1.0);
    EXPECT_DOUBLE_EQ(measure(r).first_crack_Pa, 50e6);
}

TEST(DamageThresholds, FewCracksGiveTheFirst) {
    TestResult r = dilating(b_for_cd);
    r.cracks = {crack(700, 70e6), crack(800, 80e6)};
    EXPECT_DOUBLE_EQ(measure(r).sigma_ci_crack_count_Pa, 70e6);
}

TEST(DamageThresholds, TensionCountsCracksAsMagnitudes) {
    TestResult r = linear(methods::direct_tension, 8e6, 100, -1.0);
    r.cracks = {crack(600, -4.8e6), crack(700, -5.6e6)};
    EXPECT_DOUBLE_EQ(measure(r).first_crack_Pa, 4.8e6);
    EXPECT_DOUBLE_EQ(measure(r).sigma_ci_crack_count_Pa, 4.8e6);
}

TEST(DamageThresholds, TooShortACurveHasNone) {
    const DamageThresholds none = damage_thresholds(LoadingCurve{}, 1e6);
    EXPECT_TRUE(std::isnan(none.reversal_Pa) && std::isnan(none.crack_volume_Pa) && std::isnan(none.lateral_strain_Pa));
}
