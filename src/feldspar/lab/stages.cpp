#include "feldspar/lab/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/step/step.hpp"

namespace feldspar {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Of what remains to the end of a stage, the share that may pass between two rows; and, of the end's size, by how much it may be
// passed at last.
constexpr double kApproach = 0.5, kPassed = 1e-3;
constexpr double kTurned =
    0.01;  // of the largest volumetric strain, by which it has fallen when it has turned: a crack or two make it dip by less
constexpr double kQuiet = 0.1;           // of the target of R*, at which a specimen at rest is quiet ...
constexpr double kLeastWait = 1.0;       // ... after so many travel times at least; the load takes one to settle
constexpr double kLongestWait = 1000.0;  // travel times; a specimen that has not come to rest by then does not

bool is_of_load(StageEnd end) { return end == StageEnd::stress || end == StageEnd::load; }

double volume(const HistoryRow& row) { return row.axial_strain_gauge + row.lateral_strain_gauge; }

std::string words_of(const StageSpec& stage) {
    switch (stage.end) {
        case StageEnd::stress:
            return "stress";
        case StageEnd::load:
            return "load";
        case StageEnd::axial_strain:
            return "axial strain";
        case StageEnd::lateral_strain:
            return "lateral strain";
        case StageEnd::gauge:
            return "gauge " + stage.gauge;
        default:
            return "end";
    }
}

double quantity_of(const Experiment& e, const StageSpec& stage, double load_N, double travel_m, double lateral,
                   const std::vector<double>& gauges) {
    switch (stage.end) {
        case StageEnd::stress:
        case StageEnd::share_of_peak:
            return load_N / e.section_m2;
        case StageEnd::load:
            return load_N;
        case StageEnd::axial_strain:
            return travel_m / e.length_m;
        case StageEnd::lateral_strain:
            return lateral;
        case StageEnd::gauge:
            return gauges[static_cast<std::size_t>(e.gauges.find(stage.gauge))];
        default:
            return std::numeric_limits<double>::quiet_NaN();
    }
}

}  // namespace

double stage_quantity(const Experiment& e, const StageSpec& stage) {
    const bool strain = stage.end == StageEnd::lateral_strain;
    return quantity_of(e, stage, loading_reaction(e.assembly), e.platen_travel_m, strain ? e.gauge.lateral(e.assembly) : 0.0,
                       stage.end == StageEnd::gauge ? e.gauges.read(e.assembly) : std::vector<double>{});
}

double stage_quantity(const Experiment& e, const StageSpec& stage, const HistoryRow& row) {
    return quantity_of(e, stage, e.direction * row.axial_stress_Pa * e.section_m2, e.direction * row.platen_displacement_m,
                       row.lateral_strain_gauge, row.gauges);
}

void StageCursor::begin(const HistoryRow& row) {
    if (loads_now_) {
        top_ = row;
        loaded_before_ = true;
    }
    loads_now_ = loads();
    begun_step_ = e_->step;
    begun_value_ = value_ = stage_quantity(*e_, now(), row);
    travel_m_ = e_->platen_travel_m;
    slope_ = 0.0;
    largest_volume_ = volume(row);
    if (group_ == 0 && pass_ == 0 && stage_ == 0) first_volume_ = largest_volume_;
    begun_Pa_.clear();
    for (const DeadLoad& load : e_->assembly.dead_loads) begun_Pa_.push_back(load.pressure_Pa);
    begun_load_Pa_ = e_->direction * row.axial_stress_Pa;
}

bool StageCursor::changes(std::size_t load) const {
    return now().fixture.empty() || now().fixture == e_->assembly.dead_loads[load].name;
}

double StageCursor::time_since_begun() const {
    return static_cast<double>(e_->step - begun_step_) * e_->settings.dt / e_->travel_time;
}

// An increment is reached on the side to which the quantity has moved.
double StageCursor::target(double largest_load_Pa) const {
    const StageSpec& stage = now();
    if (stage.end == StageEnd::share_of_peak) return stage.value * largest_load_Pa;
    if (stage.counts == StageValue::reached) return stage.value;
    const double from = stage.counts == StageValue::beyond && loaded_before_ ? stage_quantity(*e_, stage, top_) : begun_value_;
    if (is_of_load(stage.end) || stage.end == StageEnd::axial_strain) return from + sense() * stage.value;
    return from + (value_ < begun_value_ ? -stage.value : stage.value);
}

std::optional<std::string> StageCursor::ended(const HistoryRow& row, double largest_load_Pa, bool past_peak, double residual) {
    const StageSpec& stage = now();
    const double before = value_, moved = std::abs(e_->platen_travel_m - travel_m_);
    value_ = stage_quantity(*e_, stage, row);
    if (moved > 0.0) slope_ = std::abs(value_ - before) / moved;
    travel_m_ = e_->platen_travel_m;
    largest_volume_ = std::max(largest_volume_, volume(row));
    if (stage.kind == StageKind::hold) {
        const double waited = time_since_begun();
        if (stage.travel_times)
            return waited >= *stage.travel_times ? std::optional(fmt::format("held for {:g} travel times", *stage.travel_times))
                                                 : std::nullopt;
        return waited >= kLeastWait && residual <= kQuiet ? std::optional<std::string>("the specimen is at rest") : std::nullopt;
    }
    if (stage.kind == StageKind::confine) {
        const std::vector<DeadLoad>& loads = e_->assembly.dead_loads;
        for (std::size_t i = 0; i < loads.size(); ++i)
            if (changes(i) && loads[i].pressure_Pa != stage.sigma3_Pa) return std::nullopt;
        return residual <= 1.0 ? std::optional(fmt::format("the pressure is {:.4g} MPa", stage.sigma3_Pa / 1e6)) : std::nullopt;
    }
    switch (stage.end) {
        case StageEnd::test:
            return std::nullopt;
        case StageEnd::share_of_peak: {
            const bool fallen = stage.kind == StageKind::unload || past_peak;
            return fallen && value_ <= target(largest_load_Pa)
                       ? std::optional(fmt::format("the load has fallen to {:.3g} % of the largest", 100.0 * stage.value))
                       : std::nullopt;
        }
        case StageEnd::reversal: {
            const double grown = largest_volume_ - first_volume_;
            return grown > 0.0 && volume(row) < largest_volume_ - kTurned * grown
                       ? std::optional<std::string>("the volumetric strain has turned")
                       : std::nullopt;
        }
        case StageEnd::gauge:
        case StageEnd::lateral_strain: {
            const double end = target(largest_load_Pa);
            const bool rising = end > begun_value_;
            if (rising ? value_ < end : value_ > end) return std::nullopt;
            break;
        }
        default:
            if (sense() * (value_ - target(largest_load_Pa)) < 0.0) return std::nullopt;
    }
    return fmt::format("the {} has {}", words_of(stage),
                       stage.counts == StageValue::reached ? "reached its value" : "changed by its step");
}

std::optional<std::string> StageCursor::stuck(const HistoryRow& row) const {
    const StageSpec& stage = now();
    if (stage.kind == StageKind::unload && !is_of_load(stage.end) && e_->direction * row.axial_stress_Pa <= 0.0)
        return fmt::format("the specimen is unloaded, and the {} of the stage that unloads it is not reached", words_of(stage));
    if ((stage.kind == StageKind::hold || stage.kind == StageKind::confine) && !stage.travel_times &&
        time_since_begun() > kLongestWait)
        return fmt::format("the specimen has not come to rest within {:g} travel times of a stage that {}", kLongestWait,
                           stage.kind == StageKind::hold ? "holds it" : "changes the pressure");
    return std::nullopt;
}

bool StageCursor::failed(double stage_peak_Pa, double failed_Pa) const {
    return loads() && now().counts == StageValue::beyond && !is_of_load(now().end) && stage_peak_Pa <= failed_Pa;
}

bool StageCursor::next() {
    if (++stage_ < group().stages.size()) return true;
    stage_ = 0;
    ++pass_;
    if (group().times == 0 || pass_ < group().times) return true;
    pass_ = 0;
    if (group_ + 1 == static_cast<int>(e_->stages.size())) return false;
    ++group_;
    return true;
}

void StageCursor::go_to_last() {
    group_ = static_cast<int>(e_->stages.size()) - 1;
    pass_ = 0;
    stage_ = 0;
}

double StageCursor::approach_m(double largest_load_Pa) const {
    const StageSpec& stage = now();
    const double end = target(largest_load_Pa), left = std::abs(end - value_);
    double size = std::max(std::abs(end), std::abs(end - begun_value_)), slope = slope_;
    switch (stage.end) {
        case StageEnd::share_of_peak:
            if (stage.kind == StageKind::load) return kInfinity;  // the load falls by itself
            [[fallthrough]];
        case StageEnd::stress:
            size = std::max(std::abs(end), 0.1 * largest_load_Pa);
            slope = std::max(slope, e_->axial_stiffness / e_->section_m2);
            break;
        case StageEnd::load:
            size = std::max(std::abs(end), 0.1 * largest_load_Pa * e_->section_m2);
            slope = std::max(slope, e_->axial_stiffness);
            break;
        case StageEnd::axial_strain:
            slope = 1.0 / e_->length_m;
            break;
        case StageEnd::lateral_strain:
        case StageEnd::gauge:
            break;
        case StageEnd::test:
        case StageEnd::reversal:
            return kInfinity;
    }
    return slope > 0.0 ? std::max(kApproach * left, kPassed * size) / slope : kInfinity;
}

}  // namespace feldspar
