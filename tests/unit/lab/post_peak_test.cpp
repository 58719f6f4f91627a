// The branch behind the peak, on records whose answer is known.
#include <gtest/gtest.h>

#include <cmath>

#include "feldspar/lab/properties.hpp"
#include "synthetic_records.hpp"

using namespace feldspar;
namespace syn = feldspar::synthetic;

namespace {

constexpr double kPeak = 100e6;

// Linear up to the peak, then down to a quarter of it along a straight branch: strain changes by `compliance` times the fall of
// the stress.
TestResult straight(double compliance, double offset_Pa = 0.0) {
    TestResult r = syn::record(offset_Pa > 0.0 ? methods::biaxial : methods::uniaxial_compression);
    r.test.control = LoadControl::dissipation;
    r.test.sigma3_Pa = offset_Pa;
    long long step = 0;
    if (offset_Pa > 0.0) r.history.push_back(syn::row(Phase::consolidation, 0, 0.0, offset_Pa));
    for (int i = 0; i <= 100; ++i)
        r.history.push_back(syn::row(Phase::loading, step += 10, i / 100.0 * kPeak / syn::E, offset_Pa + i / 100.0 * kPeak));
    for (int i = 1; i <= 75; ++i) {
        const double fall = i / 100.0 * kPeak;
        r.history.push_back(syn::row(Phase::loading, step += 10, kPeak / syn::E - compliance * fall, offset_Pa + kPeak - fall));
    }
    return r;
}

}  // namespace

TEST(PostPeak, StraightBranchesGiveTheirSlope) {
    for (const double M : {-50e9, -10e9, 40e9, 200e9}) {
        const PostPeak p = measure(straight(1.0 / M)).post_peak;
        EXPECT_NEAR(p.modulus_Pa / M, 1.0, 1e-9) << M;
        EXPECT_NEAR(p.brittleness, (M - syn::E) / M, 1e-9) << "k1 of Tarasov and Potvin";
    }
    EXPECT_LT(measure(straight(1.0 / 40e9)).post_peak.brittleness, 1.0) << "class II";
    EXPECT_GT(measure(straight(-1.0 / 40e9)).post_peak.brittleness, 1.0) << "class I";
}

TEST(PostPeak, AnUprightBranchHasABrittlenessOfOne) { EXPECT_NEAR(measure(straight(0.0)).post_peak.brittleness, 1.0, 1e-9); }

TEST(PostPeak, UnderPressureTheDeviatorCounts) {
    const PostPeak p = measure(straight(1.0 / 40e9, 20e6)).post_peak;
    EXPECT_NEAR(p.modulus_Pa, 40e9, 1.0);
}

TEST(PostPeak, LoopsOfUnloadingAreNoBranch) {
    TestResult r = straight(1.0 / 200e9);
    const PostPeak plain = measure(r).post_peak;
    // At 0.7 of the peak the platen goes back by a fifth of the stress with the elastic slope, and on again.
    std::size_t at = 0;
    for (std::size_t i = 0; i < r.history.size(); ++i)
        if (i > 101 && std::abs(r.history[i].axial_stress_Pa - 0.7 * kPeak) < 1.0) at = i;
    ASSERT_GT(at, 0u);
    std::vector<HistoryRow> loop;
    for (int i = 1; i <= 39; ++i) {
        const double back = (i <= 20 ? i : 40 - i) / 20.0 * 0.2 * kPeak;
        HistoryRow row = r.history[at];
        row.axial_stress_Pa -= back;
        row.axial_strain -= back / syn::E;
        loop.push_back(row);
    }
    r.history.insert(r.history.begin() + static_cast<std::ptrdiff_t>(at) + 1, loop.begin(), loop.end());
    EXPECT_NEAR(measure(r).post_peak.modulus_Pa / plain.modulus_Pa, 1.0, 1e-6);
}

TEST(PostPeak, WithoutServoControlTheBranchIsNotTheRocks) {
    TestResult r = straight(1.0 / 40e9);
    r.test.control = LoadControl::displacement;
    EXPECT_TRUE(std::isnan(measure(r).post_peak.modulus_Pa));
    EXPECT_TRUE(std::isnan(measure(r).post_peak.brittleness));
    r.test.control = LoadControl::dissipation;
    r.numerics.kind = NumericsKind::paper;
    EXPECT_TRUE(std::isnan(measure(r).post_peak.modulus_Pa)) << "a fixed speed follows nothing";
}

TEST(PostPeak, ARecordThatEndsAboveHalfThePeakHasNoModulus) {
    TestResult r = straight(1.0 / 40e9);
    std::erase_if(r.history, [](const HistoryRow& row) { return row.step > 1010 && row.axial_stress_Pa < 0.55 * kPeak; });
    const PostPeak p = measure(r).post_peak;
    EXPECT_TRUE(std::isnan(p.modulus_Pa));
    EXPECT_TRUE(std::isnan(p.brittleness));
}

TEST(PostPeak, SharesOfTheEnergyAreThoseSpentBehindThePeak) {
    TestResult r = straight(1.0 / 40e9);
    r.history.back().energy.fracture += 1.0;
    r.history.back().energy.friction += 4.0;
    r.history.back().energy.damping += 5.0;
    const PostPeak p = measure(r).post_peak;
    EXPECT_NEAR(p.fracture_share, 0.1, 1e-12);
    EXPECT_NEAR(p.friction_share, 0.4, 1e-12);
    EXPECT_NEAR(p.damping_share, 0.5, 1e-12);
}
