// Where a test stands among its stages, and when one ends (docs/theory/loading.md, section 7).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "feldspar/lab/experiment.hpp"

namespace feldspar {

/// What the end of a stage looks at, in the present state: SI, stress and load positive in the sense of the loading. Not-a-number
/// where the end has none.
double stage_quantity(const Experiment& experiment, const StageSpec& stage);
/// The same of a row of the history.
double stage_quantity(const Experiment& experiment, const StageSpec& stage, const HistoryRow& row);

/// Goes through the stages of a test. It may be copied with the state of a test, and set back with it.
class StageCursor {
public:
    explicit StageCursor(const Experiment& experiment) : e_(&experiment) {}

    bool staged() const { return !e_->stages.empty(); }
    const StageSpec& now() const { return group().stages[stage_]; }
    StageKind kind() const { return staged() ? now().kind : StageKind::load; }
    bool loads() const { return kind() == StageKind::load; }
    /// Of the loading motion: 1 grows, -1 goes back, 0 rests.
    double sense() const { return loads() ? 1.0 : kind() == StageKind::unload ? -1.0 : 0.0; }
    int group_number() const { return group_; }
    int pass() const { return pass_; }

    /// The stage begins in the state of this row.
    void begin(const HistoryRow& row);

    /// To be asked of every row of the stage. @param largest_load_Pa  of the test so far  @param past_peak  the load has fallen
    /// below the largest one of this stage  @param residual  R* of the typical body over its target
    /// @return why the stage ends at this row, in words
    std::optional<std::string> ended(const HistoryRow& row, double largest_load_Pa, bool past_peak, double residual);

    /// Why the stage cannot go on and its end has not come; empty while it can.
    std::optional<std::string> stuck(const HistoryRow& row) const;

    /// Whether a stage that has ended went farther than all before, under less load than a specimen that has not failed bears.
    /// @param stage_peak_Pa  largest stress of the stage  @param failed_Pa  the one at which the test ends
    bool failed(double stage_peak_Pa, double failed_Pa) const;

    /// To the next stage. @return false if there is none
    bool next();

    /// To the last group of all, which has just been added.
    void go_to_last();

    /// How far the loading motion may go until the next row, so that the stage's end is not passed by more than a thousandth, m.
    /// @param largest_load_Pa  of the test so far
    double approach_m(double largest_load_Pa) const;

    /// Pressure of a dead load (Assembly::dead_loads) when the stage began, and whether a stage of confining changes it.
    double begun_Pa(std::size_t load) const { return begun_Pa_[load]; }
    bool changes(std::size_t load) const;
    /// Stress at which the stage began, positive in the sense of the loading.
    double begun_load_Pa() const { return begun_load_Pa_; }

    template <class Archive>
    void keep(Archive& archive) {
        auto& [experiment, group, pass, stage, begun_step, begun_value, begun_load, begun, value, travel, slope, top,
               loaded_before, loads, first_volume, largest_volume] = *this;
        archive(group, pass, stage, begun_step, begun_value, begun_load, begun, value, travel, slope, top, loaded_before, loads,
                first_volume, largest_volume);
    }

private:
    const StageGroup& group() const { return e_->stages[static_cast<std::size_t>(group_)]; }
    double target(double largest_load_Pa) const;
    double time_since_begun() const;

    const Experiment* e_;
    int group_ = 0, pass_ = 0;
    std::size_t stage_ = 0;
    long long begun_step_ = 0;
    double begun_value_ = 0.0, begun_load_Pa_ = 0.0;
    std::vector<double> begun_Pa_;         // of the dead loads
    double value_ = 0.0, travel_m_ = 0.0;  // in the last row
    double slope_ = 0.0;                   // change of the value per loading motion between the last two rows, magnitude
    HistoryRow top_;                       // at the end of the last loading, if there was one
    bool loaded_before_ = false, loads_now_ = false;
    double first_volume_ = 0.0, largest_volume_ = 0.0;  // volumetric strain: where the test began, and the largest of the stage
};

}  // namespace feldspar
