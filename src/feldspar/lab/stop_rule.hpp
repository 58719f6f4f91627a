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

    /// Whether the largest stress was the strength: the load has fallen below it, and a disc is split, for it dips and rises again before.
    bool past_peak(double load_Pa) const;

    /// Whether all steps that the user allows have been made, those of earlier passages too.
    bool steps_are_spent() const;

    /// @param unloading  the specimen hardly fails (Servo::unloading()): that the stress is low then is no sign of failure
    /// @return why the test ends now, in words; nothing if it goes on
    std::optional<std::string> ended(const HistoryRow& row, bool unloading = false);

private:
    bool split() const { return splitting_ && splitting_->split(); }
    void look_for_split();

    const Experiment* e_;
    const TestResult* result_;
    std::optional<SplittingCrack> splitting_;   // of a Brazilian test: a first dip does not end it
    std::size_t cracks_seen_ = 0;
    int gauge_ = -1;   // that ends the test
    double peak_strain_ = 0.0;
    double peak_Pa_ = 0.0;
    long long peak_step_ = 0;
};

}  // namespace feldspar
