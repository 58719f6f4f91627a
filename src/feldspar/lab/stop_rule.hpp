// When a test is over, and where its strength was.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "feldspar/lab/disc_splitting.hpp"
#include "feldspar/lab/experiment.hpp"

namespace feldspar {

/// Watches the record of a test, row by row. It may be copied with the state of a test, and set back with it.
class StopRule {
public:
    StopRule(const Experiment& experiment, const TestResult& result);

    /// Strength so far, a positive magnitude, Pa; and when it was.
    double peak() const { return peak_Pa_; }
    long long peak_step() const { return peak_step_; }

    /// Whether the largest stress was the strength: the load has fallen below it, and a disc is split, for it dips and rises
    /// again before.
    bool past_peak(double load_Pa) const;

    /// Largest load of the stage under way, Pa.
    double stage_peak() const { return stage_peak_Pa_; }

    /// Whether the strength so far was in the stage under way.
    bool peak_in_stage() const { return peak_step_ >= stage_step_; }

    /// A new stage begins: what fell in the one before is none of its falls.
    void stage_began() {
        stage_peak_Pa_ = 0.0;
        stage_step_ = e_->step;
    }

    /// Whether all steps have been made that the user allows, or that such a test may take, those of earlier passages too.
    bool steps_are_spent() const;

    /// @param loads      the row is of a stage that loads: what falls elsewhere has not failed
    /// @param unloading  the specimen hardly fails (Servo::unloading()): that the stress is low then is no sign of failure
    /// @return why the test ends now, in words; nothing if it goes on
    std::optional<std::string> ended(const HistoryRow& row, bool loads, bool unloading = false);

    /// That the stress has fallen to the share of the peak at which the test ends, in words.
    std::string fallen() const;

    template <class Archive>
    void keep(Archive& archive) {
        auto& [experiment, result, splitting, cracks_seen, gauge, peak_strain, peak, stage_peak, stage_step, peak_step] =
            *this;  // the first two are whose rule it is
        archive(splitting, cracks_seen, gauge, peak_strain, peak, stage_peak, stage_step, peak_step);
    }

private:
    std::optional<std::string> spent() const;  // that all steps have been made, in words
    bool split() const { return splitting_ && splitting_->split(); }
    bool peak_counts() const;
    void look_for_split();

    const Experiment* e_;
    const TestResult* result_;
    std::optional<SplittingCrack> splitting_;  // of a Brazilian test: a first dip does not end it
    std::size_t cracks_seen_ = 0;
    int gauge_ = -1;  // that ends the test
    double peak_strain_ = 0.0;
    double peak_Pa_ = 0.0;
    double stage_peak_Pa_ = 0.0;  // largest load of the stage under way
    long long stage_step_ = 0;    // when it began
    long long peak_step_ = 0;
};

}  // namespace feldspar
