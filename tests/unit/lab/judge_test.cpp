#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "synthetic_records.hpp"

using namespace feldspar;
using namespace feldspar::synthetic;

namespace {

bool says(const QuasiStaticEvidence& e, const std::string& text) { return e.verdict.find(text) != std::string::npos; }

template <class Change>
QuasiStaticEvidence judged(TestKind kind, Change change) {
    TestResult r = linear(kind, 100e6, 100, kind == TestKind::direct_tension ? -1.0 : 1.0);
    for (HistoryRow& h : r.history) change(h);
    return judge(r);
}

}  // namespace

TEST(Judge, QuietRunIsGradeA) {
    const QuasiStaticEvidence e = judged(TestKind::uniaxial_compression, [](HistoryRow&) {});
    EXPECT_EQ(e.grade, 'A');
    EXPECT_NEAR(e.residual_mean, 5e-3, 1e-15);
    EXPECT_DOUBLE_EQ(e.residual_at_peak, 5e-3);
    EXPECT_DOUBLE_EQ(e.imbalance_max, 0.0);
    EXPECT_NEAR(e.kinetic_over_strain, 1e-5, 1e-12);
    EXPECT_DOUBLE_EQ(e.damping_over_fracture, 0.25);
    EXPECT_TRUE(says(e, "Quasi-static to about 0.5 % up to the peak")) << e.verdict;
    EXPECT_TRUE(says(e, "branch after the peak is dynamic"));
}

TEST(Judge, OnlyHalfThePeakToThePeakCounts) {
    const QuasiStaticEvidence e = judged(TestKind::uniaxial_compression, [](HistoryRow& h) {
        if (h.axial_stress_Pa < 49e6 || h.step > 1000) h.residual = h.kinetic_deviation = 1.0;
    });
    EXPECT_EQ(e.grade, 'A') << e.verdict;
}

struct Limit {
    const char* quantity;
    TestKind kind;
    double a, b;
    void (*set)(HistoryRow&, double);
};

void set_residual(HistoryRow& h, double v) { h.residual = v; }
void set_peak_residual(HistoryRow& h, double v) { h.residual = h.step == 1000 ? v : 1e-4; }
void set_imbalance(HistoryRow& h, double v) {
    h.stress_top_Pa = h.axial_stress_Pa * (1.0 + 0.5 * v);
    h.stress_bottom_Pa = h.axial_stress_Pa * (1.0 - 0.5 * v);
}
void set_kinetic(HistoryRow& h, double v) { h.kinetic_deviation = v * (h.energy.elastic_grains + h.energy.elastic_contacts); }

// The verdict table (L9), line by line: just inside and just outside each limit.
TEST(Judge, LimitsOfTheVerdictTable) {
    const Limit table[] = {
        {"mean R*", TestKind::uniaxial_compression, 7e-3, 1.5e-2, set_residual},
        {"mean R*", TestKind::biaxial, 7e-3, 1.5e-2, set_residual},
        {"mean R*", TestKind::direct_tension, 7e-3, 1.5e-2, set_residual},
        {"mean R*", TestKind::brazilian, 1.4e-2, 3e-2, set_residual},
        {"R* at the peak", TestKind::uniaxial_compression, 2e-2, 5e-2, set_peak_residual},
        {"R* at the peak", TestKind::direct_tension, 4e-2, 5e-2, set_peak_residual},
        {"imbalance", TestKind::uniaxial_compression, 1.5e-2, 3e-2, set_imbalance},
        {"imbalance", TestKind::brazilian, 5e-2, 5e-2, set_imbalance},
        {"kinetic", TestKind::uniaxial_compression, 2e-4, 1e-3, set_kinetic},
        {"kinetic", TestKind::brazilian, 2e-4, 1e-3, set_kinetic},
    };
    for (const Limit& line : table) {
        const auto grade = [&](double value) {
            return judged(line.kind, [&](HistoryRow& h) { line.set(h, value); }).grade;
        };
        EXPECT_EQ(grade(0.99 * line.a), 'A') << line.quantity << ", " << name(line.kind);
        if (line.b > line.a) {
            EXPECT_EQ(grade(1.01 * line.a), 'B') << line.quantity << ", " << name(line.kind);
            EXPECT_EQ(grade(0.99 * line.b), 'B') << line.quantity << ", " << name(line.kind);
        }
        EXPECT_EQ(grade(1.01 * line.b), 'C') << line.quantity << ", " << name(line.kind);
    }
}

TEST(Judge, SaysWhatFailedAndWhatToDo) {
    QuasiStaticEvidence e = judged(TestKind::uniaxial_compression, [](HistoryRow& h) { set_imbalance(h, 0.042); });
    EXPECT_EQ(e.grade, 'C');
    EXPECT_TRUE(says(e, "Not shown to be quasi-static")) << e.verdict;
    EXPECT_TRUE(says(e, "two platens' loads is 4.2 % (3 % allowed)")) << e.verdict;
    EXPECT_TRUE(says(e, "run with accuracy = \"0.2 %\"")) << e.verdict;

    TestResult r = linear(TestKind::uniaxial_compression, 100e6);
    for (HistoryRow& h : r.history) h.residual = 1e-2;
    r.numerics.accuracy = 0.02;
    EXPECT_EQ(judge(r).grade, 'B');
    EXPECT_TRUE(says(judge(r), "to reach 0.5 %, run with accuracy = \"0.5 %\"")) << judge(r).verdict;
    r.numerics.kind = NumericsKind::paper;
    EXPECT_TRUE(says(judge(r), "a third of the platen speed")) << judge(r).verdict;
}

TEST(Judge, TheRepeatAtAThirdOfTheTargetIsPartOfTheEvidence) {
    TestResult r = linear(TestKind::uniaxial_compression, 100e6);
    r.evidence.confirmed = true;
    r.evidence.peak_change_at_third = -0.003;
    EXPECT_EQ(judge(r).grade, 'A');
    EXPECT_TRUE(judge(r).confirmed);
    EXPECT_TRUE(says(judge(r), "-0.3 %")) << judge(r).verdict;
    r.evidence.peak_change_at_third = -0.012;
    EXPECT_EQ(judge(r).grade, 'B');
    r.evidence.peak_change_at_third = 0.06;
    EXPECT_EQ(judge(r).grade, 'C');
}

TEST(Judge, WhatIsNotKnownIsNotShown) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (auto set : {set_residual, set_imbalance, set_kinetic}) {
        const QuasiStaticEvidence e = judged(TestKind::uniaxial_compression, [&](HistoryRow& h) {
            if (h.step == 700) set(h, nan);
        });
        EXPECT_EQ(e.grade, 'C');
        EXPECT_TRUE(says(e, "is not known")) << e.verdict;
    }
}

TEST(Judge, PartialRecords) {
    TestResult r = record(TestKind::uniaxial_compression);
    EXPECT_EQ(judge(r).grade, 'C');
    EXPECT_TRUE(says(judge(r), "Not judged"));
    r.history = {row(Phase::elastic, 0, 0.0, 0.0), row(Phase::elastic, 0, 1e-3, 25e6)};
    EXPECT_EQ(judge(r).grade, 'C');
    EXPECT_TRUE(says(judge(r), "no loading step"));
    r = linear(TestKind::uniaxial_compression, 100e6);
    r.history.resize(80);
    EXPECT_TRUE(says(judge(r), "peak was not reached")) << judge(r).verdict;
    EXPECT_FALSE(says(judge(r), "after the peak"));
}
