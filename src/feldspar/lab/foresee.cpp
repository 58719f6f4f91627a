#include "feldspar/lab/foresee.hpp"

#include <algorithm>
#include <cmath>

#include "feldspar/lab/rate_control.hpp"

namespace feldspar {
namespace {

// How many times as long as a plain test one with stages typically takes: a stage about a third of it.
double stages_over_test(const Experiment& e) {
    constexpr double kOfATest = 0.3;
    constexpr int kUntilTheEnd = 8;  // repetitions of what is repeated until the test ends
    double stages = 0.0;
    for (const StageGroup& group : e.stages)
        stages += static_cast<double>(group.stages.size()) * (group.times == 0 ? kUntilTheEnd : group.times);
    return stages > 1.0 ? 1.0 + kOfATest * (stages - 1.0) : 1.0;
}

// The time of a wave by which loading goes, in steps. In a travel time the load may grow by L0 (L4), but from step to step by no
// more than the record resolves: a body that a wave crosses in fewer than half the steps which that takes is loaded no faster.
// Rigid grains of few rows are such bodies (40 steps; they take a fifth of what a flexible body of 250 steps does in each of
// them).
double loading_time(const Experiment& e) {
    constexpr double kGrowth = 0.6, kLoadPerStep = 2e-3;  // the widest limits of the first passage
    // The time of a mode is known once the elastic answer is; a beam with a span of 4 h takes 1.5 times as long as a wave through
    // its whole length.
    constexpr double kModeOverWave = 1.5;
    const double time = e.travel_time * (e.method.start.time_of_mode && e.preparation_steps == 0 ? kModeOverWave : 1.0);
    return std::max(time, 0.5 * kGrowth / kLoadPerStep);
}

// How many times as long as without a pressure on its sides. A confined specimen yields on a plateau of many events, and the
// longer the more the pressure is beside the rock's strength, of which the contacts' cohesion is about a quarter.
double plateau_over_test(const Experiment& e) {
    constexpr double kPlateau = 10.0, kMost = 15.0;
    const double pressure = e.setup.test.sigma3_Pa, cohesion = e.setup.contact.tau_Pa;
    if (!e.method.loading.on_envelope || !(pressure > 0.0)) return 1.0;  // others were measured under their pressure
    return cohesion > 0.0 ? std::min(1.0 + kPlateau * pressure / cohesion, kMost) : kMost;
}

// Of the usual number, the bounds between which nine tests in ten lie: how often the strength is passed again, and how far the
// rock goes on at it, differs from packing to packing by three, from a brittle to a tough rock by ten. Measured:
// docs/performance.
struct Spread {
    double low, high;
};
constexpr Spread kAdaptive{0.4, 6.0}, kConfined{0.35, 4.0}, kFixedSpeed{0.5, 2.0};

Spread spread_of(const Experiment& e) {
    if (e.setup.numerics.kind != NumericsKind::adaptive) return kFixedSpeed;
    return plateau_over_test(e) > 1.0 ? kConfined : kAdaptive;
}

}  // namespace

double typical_steps(const Experiment& e) {
    const NumericsSpec& n = e.setup.numerics;
    const MethodId kind = e.setup.test.kind;
    if (n.kind != NumericsKind::adaptive) {
        return e.method.rate.fixed_speed_strain * e.length_m / (n.speed_m.value_or(kPaperSpeed) * e.settings.dt);
    }
    // In travel times, at the usual accuracy: medians over eight rocks (docs/validation, true strengths).
    return stages_over_test(e) * plateau_over_test(e) * e.method.rate.travel_times * loading_time(e) *
           std::sqrt(residual_target(NumericsSpec{}, kind) / residual_target(n, kind));
}

Foreseen foreseen_steps(const Experiment& e) {
    const double usual = typical_steps(e);
    const Spread spread = spread_of(e);
    Foreseen steps{spread.low * usual, usual, spread.high * usual};
    if (const auto most = e.setup.numerics.maximum_steps)
        for (double* bound : {&steps.low, &steps.usual, &steps.high}) *bound = std::min(*bound, static_cast<double>(*most));
    return steps;
}

}  // namespace feldspar
