#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "synthetic_records.hpp"

using namespace feldspar;
using namespace feldspar::synthetic;

namespace {

bool says(const QuasiStaticEvidence& e, const std::string& text) { return e.verdict.find(text) != std::string::npos; }

template <class Change>
QuasiStaticEvidence judged(MethodId kind, Change change) {
    TestResult r = linear(kind, 100e6, 100, kind == methods::direct_tension ? -1.0 : 1.0);
    for (HistoryRow& h : r.history) change(h);
    return judge(r);
}

}  // namespace

TEST(Judge, QuietRunIsGradeA) {
    const QuasiStaticEvidence e = judged(methods::uniaxial_compression, [](HistoryRow&) {});
    EXPECT_EQ(e.grade, 'A');
    EXPECT_NEAR(e.residual_mean, 5e-3, 1e-15);
    EXPECT_DOUBLE_EQ(e.residual_at_peak, 5e-3);
    EXPECT_DOUBLE_EQ(e.imbalance_max, 0.0);
    EXPECT_NEAR(e.kinetic_over_strain, 1e-5, 1e-12);
    EXPECT_DOUBLE_EQ(e.damping_over_fracture, 0.25);
    EXPECT_NEAR(e.residual_median, 1.5e-3, 1e-15);
    EXPECT_NEAR(e.load_per_travel_time, 4e-3, 1e-15);
    EXPECT_NEAR(e.error_estimate, 4e-3, 1e-15);
    EXPECT_TRUE(says(e, "Quasi-static to about 0.5 % up to the peak")) << e.verdict;
    EXPECT_TRUE(says(e, "branch after the peak is dynamic"));
}

TEST(Judge, OnlyNineTenthsOfThePeakToThePeakDecide) {
    const QuasiStaticEvidence e = judged(methods::uniaxial_compression, [](HistoryRow& h) {
        if (h.axial_stress_Pa < 49e6 || h.step > 1000) h.residual = h.kinetic_deviation = 1.0;
        if (h.axial_stress_Pa < 89e6 || h.step > 1000) h.residual_median = 1.0;
    });
    EXPECT_NEAR(e.residual_mean, 5e-3, 1e-15);
    EXPECT_EQ(e.grade, 'A') << e.verdict;
}

void set_median(HistoryRow& h, double v) { h.residual_median = v; }
void set_imbalance(HistoryRow& h, double v) {
    h.stress_top_Pa = h.axial_stress_Pa * (1.0 + 0.5 * v);
    h.stress_bottom_Pa = h.axial_stress_Pa * (1.0 - 0.5 * v);
}
void set_growth(HistoryRow& h, double v) { h.platen_speed = v / 400.0 * std::abs(h.platen_displacement_m); }
// An estimated error from the unbalanced force alone.
void set_error(HistoryRow& h, double v) {
    set_median(h, 0.5 * v);
    set_growth(h, 0.0);
}
// The same from the speed alone.
void set_overrun(HistoryRow& h, double v) {
    set_median(h, 0.0);
    set_growth(h, 4.0 * v);
}
void set_tension_error(HistoryRow& h, double v) {
    set_median(h, 3.0 * v);
    set_growth(h, 0.0);
}

struct Limit {
    const char* quantity;
    MethodId kind;
    double a, b;
    void (*set)(HistoryRow&, double);
};

// The verdict table (L9), line by line: just inside and just outside each limit.
TEST(Judge, LimitsOfTheVerdictTable) {
    const Limit table[] = {
        {"unbalanced force", methods::uniaxial_compression, 5e-3, 2e-2, set_error},
        {"unbalanced force", methods::biaxial, 5e-3, 2e-2, set_error},
        {"unbalanced force", methods::direct_tension, 1e-2, 2e-2, set_tension_error},
        {"unbalanced force", methods::brazilian, 1e-2, 2e-2, set_tension_error},
        {"overrun", methods::uniaxial_compression, 5e-3, 2e-2, set_overrun},
        {"overrun", methods::direct_tension, 1e-2, 2e-2, set_overrun},
        {"imbalance", methods::uniaxial_compression, 1e-2, 2e-2, set_imbalance},
        {"imbalance", methods::brazilian, 3e-2, 5e-2, set_imbalance},
    };
    for (const Limit& line : table) {
        const auto grade = [&](double value) { return judged(line.kind, [&](HistoryRow& h) { line.set(h, value); }).grade; };
        EXPECT_EQ(grade(0.99 * line.a), 'A') << line.quantity << ", " << name(line.kind);
        EXPECT_EQ(grade(1.01 * line.a), 'B') << line.quantity << ", " << name(line.kind);
        EXPECT_EQ(grade(0.99 * line.b), 'B') << line.quantity << ", " << name(line.kind);
        EXPECT_EQ(grade(1.01 * line.b), 'C') << line.quantity << ", " << name(line.kind);
    }
}

// (L8): both parts add up, and the mean over the rows from 0.9 of the peak on counts.
TEST(Judge, EstimatesTheErrorOfTheStrength) {
    const auto change = [](HistoryRow& h) {
        if (std::abs(h.axial_stress_Pa) < 89.5e6) return set_median(h, 1.0);
        set_median(h, std::abs(h.axial_stress_Pa) < 94.5e6 ? 0.0 : 1.1e-2);  // six of the eleven rows
        set_growth(h, 0.02);
    };
    const QuasiStaticEvidence pressed = judged(methods::uniaxial_compression, change),
                              pulled = judged(methods::direct_tension, change);
    EXPECT_NEAR(pressed.residual_median, 6e-3, 1e-12);
    EXPECT_NEAR(pressed.load_per_travel_time, 0.02, 1e-12);
    EXPECT_NEAR(pressed.error_estimate, 2.0 * 6e-3 + 5e-3, 1e-12);
    EXPECT_NEAR(pulled.error_estimate, 2e-3 + 5e-3, 1e-12);
}

// A crack shakes a few bodies for a moment whatever the speed is: the sum and the largest values do not decide.
TEST(Judge, AFewRestlessBodiesDoNotDecide) {
    const QuasiStaticEvidence e = judged(methods::uniaxial_compression, [](HistoryRow& h) {
        h.residual = 0.1;
        if (h.step == 600) set_imbalance(h, 0.2);
        if (h.step == 700) h.kinetic_deviation = 0.1;
    });
    EXPECT_EQ(e.grade, 'A') << e.verdict;
    EXPECT_NEAR(e.residual_mean, 0.1, 1e-12);
    EXPECT_NEAR(e.imbalance_max, 0.2, 1e-12);
    EXPECT_NEAR(e.kinetic_over_strain, 0.1, 1e-12);
}

TEST(Judge, SaysWhatFailedAndWhatToDo) {
    QuasiStaticEvidence e = judged(methods::uniaxial_compression, [](HistoryRow& h) { set_imbalance(h, 0.042); });
    EXPECT_EQ(e.grade, 'C');
    EXPECT_TRUE(says(e, "Not shown to be quasi-static")) << e.verdict;
    EXPECT_TRUE(says(e, "two platens' loads is 4.2 % (2 % allowed)")) << e.verdict;
    EXPECT_TRUE(says(e, "run with accuracy = \"0.5 %\"")) << e.verdict;  // 2.1 times smaller than the default

    TestResult r = linear(methods::uniaxial_compression, 100e6);
    for (HistoryRow& h : r.history) set_error(h, 1e-2);
    r.numerics.accuracy = 0.02;
    EXPECT_EQ(judge(r).grade, 'B');
    EXPECT_TRUE(says(judge(r), "the estimated error of the strength is 1 % (0.5 % allowed)")) << judge(r).verdict;
    EXPECT_TRUE(says(judge(r), "to reach 0.5 %, run with accuracy = \"1 %\"")) << judge(r).verdict;
    r.numerics.residual_target = 6e-3;
    EXPECT_TRUE(says(judge(r), "run with residual_target = 0.003")) << judge(r).verdict;
    r.numerics.kind = NumericsKind::paper;
    EXPECT_TRUE(says(judge(r), "at a platen speed smaller by a factor of 2,")) << judge(r).verdict;
}

TEST(Judge, TheRepeatAtAThirdOfTheTargetTakesThePlaceOfTheEstimate) {
    TestResult r = linear(methods::uniaxial_compression, 100e6);
    for (HistoryRow& h : r.history) set_error(h, 0.03);
    EXPECT_EQ(judge(r).grade, 'C');
    r.evidence.confirmed = true;
    r.evidence.peak_change_at_third = -0.003;
    EXPECT_EQ(judge(r).grade, 'A');
    EXPECT_TRUE(judge(r).confirmed);
    EXPECT_NEAR(judge(r).error_estimate, 0.0045, 1e-12);  // in proportion to the rate: two thirds of it show
    EXPECT_TRUE(says(judge(r), "-0.3 %")) << judge(r).verdict;
    r.evidence.peak_change_at_third = -0.012;
    EXPECT_EQ(judge(r).grade, 'B');
    r.evidence.peak_change_at_third = 0.014;
    EXPECT_EQ(judge(r).grade, 'C');
}

TEST(Judge, WhereDampingMattersTheVerdictSaysSo) {
    TestResult r = linear(methods::uniaxial_compression, 100e6);
    EXPECT_FALSE(says(judge(r), "damping")) << judge(r).verdict;
    r.evidence.other_damping = 0.5;
    r.evidence.peak_change_at_other_damping = -0.004;
    EXPECT_TRUE(says(judge(r), "At a damping of 0.5 the strength changes by -0.4 %.")) << judge(r).verdict;
    r.evidence.peak_change_at_other_damping = -0.04;
    EXPECT_TRUE(says(judge(r), "-4 %: it depends on the numerical damping")) << judge(r).verdict;
}

TEST(Judge, AStrengthOutOfBalanceStandsBesideTheLargestStressInBalance) {
    TestResult r = linear(methods::uniaxial_compression, 100e6);
    for (HistoryRow& h : r.history) h.residual_median = h.axial_stress_Pa > 80.5e6 ? 0.2 : 1e-3;
    EXPECT_EQ(judge(r).grade, 'C');
    EXPECT_NEAR(judge(r).balanced_stress_Pa, 80e6, 1e6);
    EXPECT_TRUE(says(judge(r), "in balance up to 80")) << judge(r).verdict;
}

TEST(Judge, WhatIsNotKnownIsNotShown) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (auto set : {set_median, set_imbalance, set_growth}) {
        const QuasiStaticEvidence e = judged(methods::uniaxial_compression, [&](HistoryRow& h) {
            if (h.step == 950) set(h, nan);
        });
        EXPECT_EQ(e.grade, 'C');
        EXPECT_TRUE(says(e, "is not known")) << e.verdict;
    }
    TestResult r = linear(methods::uniaxial_compression, 100e6);
    r.travel_time = 0.0;
    EXPECT_EQ(judge(r).grade, 'C');
}

TEST(Judge, PartialRecords) {
    TestResult r = record(methods::uniaxial_compression);
    EXPECT_EQ(judge(r).grade, 'C');
    EXPECT_TRUE(says(judge(r), "Not judged"));
    r.history = {row(Phase::elastic, 0, 0.0, 0.0), row(Phase::elastic, 0, 1e-3, 25e6)};
    EXPECT_EQ(judge(r).grade, 'C');
    EXPECT_TRUE(says(judge(r), "no loading step"));
    r = linear(methods::uniaxial_compression, 100e6);
    r.history.resize(80);
    EXPECT_TRUE(says(judge(r), "peak was not reached")) << judge(r).verdict;
    EXPECT_FALSE(says(judge(r), "after the peak"));
}
