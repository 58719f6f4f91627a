#include "feldspar/lab/stop_rule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace feldspar {
namespace {

constexpr double kPastPeak = 0.98;  // share of the peak below which it is one
constexpr double kPressedOn = 2.0;  // a disc that was not split by then, or does not let go, is pressed no farther
constexpr long long kStepsAfterPeak = 100;
constexpr double kMostSteps = 2000.0;  // times the usual number of steps, after which a test ends; studies with much scatter have
                                       // taken 60 times it, bars of two grains that soften slowly more than 200 times
constexpr double kOfDeadLoads = 0.01;  // a largest load of less is what they leave out of balance, and no strength

}  // namespace

StopRule::StopRule(const Experiment& experiment, const TestResult& result) : e_(&experiment), result_(&result) {
    if (const auto disc = loaded_disc(result)) splitting_.emplace(*disc);
    if (const auto& stop = experiment.setup.test.stop_gauge) gauge_ = experiment.gauges.find(stop->gauge);
}

bool StopRule::past_peak(double load_Pa) const {
    return load_Pa < kPastPeak * (e_->stages.empty() ? peak_Pa_ : stage_peak_Pa_) && (!splitting_ || split()) && peak_counts();
}

bool StopRule::peak_counts() const { return peak_Pa_ * e_->section_m2 >= kOfDeadLoads * e_->dead_load_N; }

bool StopRule::steps_are_spent() const { return spent().has_value(); }

std::optional<std::string> StopRule::spent() const {
    const NumericsSpec& numerics = e_->setup.numerics;
    if (numerics.maximum_steps) {
        if (result_->steps < *numerics.maximum_steps) return std::nullopt;
        return fmt::format("the maximum number of steps ({}) is reached", *numerics.maximum_steps);
    }
    if (numerics.kind != NumericsKind::adaptive || static_cast<double>(result_->steps) < kMostSteps * typical_steps(*e_))
        return std::nullopt;
    return fmt::format(
        "it has made {} steps, {:g} times as many as such a test usually takes: its end may never come. numerics.maximum_steps "
        "allows more",
        result_->steps, kMostSteps);
}

std::optional<std::string> StopRule::ended(const HistoryRow& row, bool loads, bool unloading) {
    const double load = e_->direction * row.axial_stress_Pa;
    if (loads) stage_peak_Pa_ = std::max(stage_peak_Pa_, load);
    if (loads && load > peak_Pa_ && !split()) {
        peak_Pa_ = load;
        peak_step_ = e_->step;
        peak_strain_ = row.axial_strain;
    }
    look_for_split();
    const TestSpec& test = e_->setup.test;
    const long long after = e_->step - peak_step_;
    if (splitting_ && after >= kStepsAfterPeak && row.axial_strain >= kPressedOn * peak_strain_)
        return fmt::format("the plates have approached {:g} times as far as at the {}", kPressedOn,
                           split() ? "strength of the disc" : "largest stress, and the disc is not split");
    const bool falls = loads && peak_counts() && (e_->stages.empty() || past_peak(load));
    if (falls && after >= kStepsAfterPeak && load <= test.stop_fraction * peak_Pa_ && !unloading && (!splitting_ || split()))
        return fallen();
    if (std::abs(row.axial_strain) >= test.maximum_strain)
        return fmt::format("the axial strain has reached its maximum of {:.3g}", test.maximum_strain);
    if (gauge_ >= 0) {
        const double now = row.gauges[gauge_], end = test.stop_gauge->value;
        if (end >= 0.0 ? now >= end : now <= end) return fmt::format("the gauge {} has reached its end", test.stop_gauge->gauge);
    }
    if (test.maximum_stress_Pa && load >= *test.maximum_stress_Pa)
        return fmt::format("the stress has reached its maximum of {:.4g} MPa", *test.maximum_stress_Pa / 1e6);
    return spent();
}

std::string StopRule::fallen() const {
    return fmt::format("the stress has fallen to {:.0f} % of the peak", 100.0 * e_->setup.test.stop_fraction);
}

void StopRule::look_for_split() {
    if (!splitting_) return;
    for (; cracks_seen_ < result_->cracks.size(); ++cracks_seen_) splitting_->add(result_->cracks[cracks_seen_]);
}

}  // namespace feldspar
