// Cycles read from records by formula: what each loses and keeps is known.
#include "feldspar/lab/cycles.hpp"

#include <gtest/gtest.h>

#include "feldspar/lab/loading_curve.hpp"
#include "feldspar/lab/multi_stage.hpp"
#include "synthetic_records.hpp"

using namespace feldspar;

namespace {

constexpr double MPa_ = 1e6;

// Straight lines from one (strain, lateral strain, stress) to the next, a stage each, of so many rows.
struct Corner {
    StageKind kind;
    double strain, lateral, stress_Pa;
};

TestResult record_of(MethodId kind, const std::vector<Corner>& corners, int rows = 40) {
    TestResult r = synthetic::record(kind);
    HistoryRow row = synthetic::row(Phase::loading, 0, 0.0, 0.0);
    row.lateral_strain_gauge = 0.0;
    row.stage = 1;
    row.energy = {};
    r.history.push_back(row);
    for (const Corner& to : corners) {
        const HistoryRow from = r.history.back();
        StageRecord stage;
        stage.kind = to.kind;
        stage.first_row = r.history.size() - 1;
        for (int i = 1; i <= rows; ++i) {
            const double share = static_cast<double>(i) / rows;
            HistoryRow next =
                synthetic::row(Phase::loading, from.step + 10 * i, from.axial_strain + share * (to.strain - from.axial_strain),
                               from.axial_stress_Pa + share * (to.stress_Pa - from.axial_stress_Pa));
            next.lateral_strain_gauge = from.lateral_strain_gauge + share * (to.lateral - from.lateral_strain_gauge);
            next.stage = static_cast<int>(r.stages.size()) + 1;
            next.energy = {};
            next.energy.external = from.energy.external + 0.5 * i;
            next.energy.fracture = from.energy.fracture + 0.1 * i;
            next.energy.friction = from.energy.friction + 0.02 * i;
            next.energy.damping = from.energy.damping + 0.003 * i;
            r.history.push_back(next);
        }
        stage.last_row = r.history.size() - 1;
        r.stages.push_back(stage);
    }
    return r;
}

// To 50 MPa and back to 1 MPa with 25 GPa and 20 GPa; to 80 MPa with 22 GPa and back with 16 GPa; then to failure at 60 MPa.
TestResult two_cycles() {
    const double back1 = 2e-3 - 49 * MPa_ / 20e9, top2 = back1 + 79 * MPa_ / 22e9, back2 = top2 - 79 * MPa_ / 16e9,
                 top3 = back2 + 59 * MPa_ / 12e9;
    return record_of(methods::cyclic_compression, {{StageKind::load, 2e-3, -5e-4, 50 * MPa_},
                                                   {StageKind::unload, back1, -1.1e-4, 1 * MPa_},
                                                   {StageKind::load, top2, -1.4e-3, 80 * MPa_},
                                                   {StageKind::unload, back2, -6e-4, 1 * MPa_},
                                                   {StageKind::load, top3, -2.4e-3, 60 * MPa_},
                                                   {StageKind::load, top3 + 1e-3, -4e-3, 40 * MPa_}});
}

}  // namespace

TEST(Cycles, HaveTheModuliOfTheirLines) {
    const std::vector<CycleProperties> cycles = cycles_of(two_cycles());
    ASSERT_EQ(cycles.size(), 3U);
    EXPECT_NEAR(cycles[0].unloading_modulus_Pa / 20e9, 1.0, 1e-9);
    EXPECT_NEAR(cycles[1].reloading_modulus_Pa / 22e9, 1.0, 1e-9);
    EXPECT_NEAR(cycles[1].unloading_modulus_Pa / 16e9, 1.0, 1e-9);
    EXPECT_NEAR(cycles[2].reloading_modulus_Pa / 12e9, 1.0, 1e-9);
    EXPECT_TRUE(std::isnan(cycles[0].reloading_modulus_Pa)) << "the first loading begins at nothing";
    EXPECT_TRUE(std::isnan(cycles[2].unloading_modulus_Pa)) << "it fails before";
    EXPECT_EQ(cycles[0].peak_stress_Pa, 50 * MPa_);
    EXPECT_EQ(cycles[1].peak_stress_Pa, 80 * MPa_);
    EXPECT_EQ(cycles[2].last_stage, 6);
}

TEST(Cycles, WhatIsPermanentIsReadWithoutTheLoadThatIsLeft) {
    const std::vector<CycleProperties> cycles = cycles_of(two_cycles());
    const double axial = 2e-3 - 49 * MPa_ / 20e9 - 1 * MPa_ / 20e9, lateral = -1.1e-4 + (5e-4 - 1.1e-4) / 49.0;
    EXPECT_NEAR(cycles[0].permanent_axial_strain, axial, 1e-12);
    EXPECT_NEAR(cycles[0].permanent_lateral_strain, lateral, 1e-12);
    EXPECT_NEAR(cycles[0].permanent_volumetric_strain, axial + lateral, 1e-12);
    EXPECT_NEAR(cycles[0].damage, -(axial + lateral), 1e-12);
    EXPECT_NEAR(cycles[1].damage, -cycles[1].permanent_volumetric_strain, 1e-12) << "the sum of what each cycle adds";
}

TEST(Cycles, ShareTheWorkOfTheTest) {
    const TestResult r = two_cycles();
    double work = 0.0, dissipated = 0.0;
    for (const CycleProperties& cycle : cycles_of(r)) {
        work += cycle.work_J;
        dissipated += cycle.dissipated_J;
    }
    EXPECT_NEAR(work, r.history.back().energy.supplied(), 1e-9);
    const EnergyLedger& end = r.history.back().energy;
    EXPECT_NEAR(dissipated, end.fracture + end.friction + end.damping, 1e-9);
}

TEST(Cycles, ThereAreNoneWithoutUnloading) {
    EXPECT_TRUE(cycles_of(synthetic::linear(methods::uniaxial_compression, 100 * MPa_)).empty());
    EXPECT_TRUE(cycles_of(record_of(methods::cyclic_compression,
                                    {{StageKind::load, 2e-3, -5e-4, 50 * MPa_}, {StageKind::hold, 2e-3, -5e-4, 49 * MPa_}}))
                    .empty());
}

TEST(PeakInStages, IsTheLargestStressThatALoadingHasFallenFrom) {
    const auto peak = find_peak(two_cycles());
    ASSERT_TRUE(peak);
    EXPECT_EQ(peak->stress_Pa, 80 * MPa_);
    EXPECT_TRUE(peak->reached) << "the third loading fails";
    const auto open = find_peak(record_of(methods::cyclic_compression, {{StageKind::load, 2e-3, -5e-4, 50 * MPa_},
                                                                        {StageKind::unload, 0.0, 0.0, 1 * MPa_},
                                                                        {StageKind::load, 2e-3, -5e-4, 49 * MPa_}}));
    ASSERT_TRUE(open);
    EXPECT_FALSE(open->reached) << "what is unloaded has not failed";
    // The second loading ends by its widening, without a fall of its own: it is wider than at the peak and bears less.
    const auto weaker = find_peak(record_of(methods::cyclic_compression, {{StageKind::load, 2e-3, -5e-4, 50 * MPa_},
                                                                          {StageKind::unload, 0.0, -1e-4, 1 * MPa_},
                                                                          {StageKind::load, 2.1e-3, -9e-4, 40 * MPa_}}));
    ASSERT_TRUE(weaker);
    EXPECT_TRUE(weaker->reached);
}

TEST(LoadingCurve, LeavesLoopsOut) {
    const TestResult r = two_cycles();
    const LoadingCurve curve = loading_curve(r, *find_peak(r));
    for (std::size_t i = 1; i < curve.points.size(); ++i) EXPECT_GE(curve.points[i].stress_Pa, curve.points[i - 1].stress_Pa);
    EXPECT_EQ(curve.peak_Pa(), 80 * MPa_);
}

TEST(MultiStage, EarlierStrengthsAreScaledByTheLastStage) {
    // Under 2 MPa the volume turns at 52 MPa, under 5 MPa at 75 MPa, before the peak of 89 MPa there: deviators 50, 70 and 84
    // MPa.
    TestResult r = record_of(methods::multi_stage_biaxial, {{StageKind::load, 2.0e-3, -0.5e-3, 52 * MPa_},
                                                            {StageKind::load, 2.1e-3, -0.8e-3, 51 * MPa_},
                                                            {StageKind::confine, 2.1e-3, -0.7e-3, 51 * MPa_},
                                                            {StageKind::load, 3.0e-3, -0.9e-3, 75 * MPa_},
                                                            {StageKind::load, 3.6e-3, -2.5e-3, 89 * MPa_},
                                                            {StageKind::load, 4.0e-3, -4.0e-3, 60 * MPa_}});
    for (HistoryRow& row : r.history) row.sigma3_Pa = row.stage <= 3 ? 2 * MPa_ : 5 * MPa_;
    // one stage each: lines were used to make the record
    const auto join = [&](std::size_t first, std::size_t last, int number) {
        StageRecord stage = r.stages[first];
        stage.last_row = r.stages[last].last_row;
        for (std::size_t row = stage.first_row + 1; row <= stage.last_row; ++row) r.history[row].stage = number;
        return stage;
    };
    r.stages = {join(0, 1, 1), join(2, 2, 2), join(3, 5, 3)};
    r.history.front().stage = 1;
    const auto peak = find_peak(r);
    ASSERT_TRUE(peak && peak->reached);
    const MultiStageProperties p = multi_stage(r, *peak);
    ASSERT_EQ(p.sigma3_Pa.size(), 2U);
    EXPECT_EQ(p.reversal_Pa[0], 52 * MPa_);
    EXPECT_EQ(p.reversal_Pa[1], 75 * MPa_);
    EXPECT_NEAR(p.peak_over_reversal, 84.0 / 70.0, 1e-12);
    EXPECT_NEAR(p.strength_Pa[0] / MPa_, 2.0 + 50.0 * 1.2, 1e-9);
    EXPECT_EQ(p.strength_Pa[1], 89 * MPa_);
    // N = (89 - 62) / 3 = 9: sin phi = 0.8, and c = (62 - 9 x 2) / (2 x 3)
    EXPECT_NEAR(p.friction_angle_deg, 53.130102, 1e-5);
    EXPECT_NEAR(p.cohesion_Pa / MPa_, 44.0 / 6.0, 1e-9);
}
