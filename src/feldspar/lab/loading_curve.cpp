#include "feldspar/lab/loading_curve.hpp"

#include <algorithm>
#include <cmath>

#include "feldspar/lab/disc_splitting.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {

namespace {

constexpr double drop_fraction = 0.95;     // (P2): a fall to this fraction of the largest stress so far ends a peak
constexpr double fall_in_stage = 0.98;     // of the largest stress of a stage: below it the stage itself has passed a peak
constexpr double first_peak_floor = 0.10;  // drops below this fraction of the largest stress are settling of the plates

bool is_loading(const HistoryRow& row) { return row.phase != Phase::consolidation; }

bool is_finite(const HistoryRow& row) { return std::isfinite(row.axial_stress_Pa) && std::isfinite(row.axial_strain); }

CurvePoint interpolate(const CurvePoint& a, const CurvePoint& b, double stress_Pa) {
    const double rise = b.stress_Pa - a.stress_Pa;
    const double w = rise > 0.0 ? (stress_Pa - a.stress_Pa) / rise : 1.0;
    return {stress_Pa, a.strain + w * (b.strain - a.strain), a.strain_gauge + w * (b.strain_gauge - a.strain_gauge),
            a.lateral_gauge + w * (b.lateral_gauge - a.lateral_gauge), b.row};
}

/// Index of the first point at or above `stress_Pa`, 0 if there is none behind the origin.
std::size_t first_at_or_above(const LoadingCurve& curve, double stress_Pa) {
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
        if (curve.points[i].stress_Pa >= stress_Pa) return i;
    }
    return 0;
}

}  // namespace

bool of_loading_stage(const TestResult& result, const HistoryRow& row) {
    const auto stage = static_cast<std::size_t>(row.stage);
    return stage == 0 || stage > result.stages.size() || result.stages[stage - 1].kind == StageKind::load;
}

const Crack* first_crack(const TestResult& result) {
    const auto first = std::min_element(result.cracks.begin(), result.cracks.end(),
                                        [](const Crack& a, const Crack& b) { return a.step < b.step; });
    return first == result.cracks.end() ? nullptr : &*first;
}

double largest_stress(const TestResult& result) {
    const double sign = method_of(result.test).loading.sign;
    double largest = 0.0;
    for (const HistoryRow& row : result.history) {
        if (is_loading(row) && is_finite(row) && of_loading_stage(result, row))
            largest = std::max(largest, sign * row.axial_stress_Pa);
    }
    return largest;
}

namespace {

/// @param first_only  end at the first fall to drop_fraction, unless that is the settling of the plates
std::optional<Peak> peak_before_a_fall(const TestResult& result, bool first_only) {
    const double sign = method_of(result.test).loading.sign;
    const auto& history = result.history;
    const double overall = largest_stress(result);
    if (!(overall > 0.0)) return std::nullopt;
    Peak peak;
    for (std::size_t i = 0; i < history.size(); ++i) {
        if (!is_loading(history[i]) || !is_finite(history[i])) continue;
        const double stress = sign * history[i].axial_stress_Pa;
        if (stress > peak.stress_Pa) {
            peak = {i, stress, false};
        } else if (stress <= drop_fraction * peak.stress_Pa) {
            peak.reached = true;
            if (first_only && peak.stress_Pa >= first_peak_floor * overall) return peak;
        }
    }
    return peak;
}

/// The same of a test with stages: it is reached if the stress has fallen while a stage behind it, or its own, loaded; or if a
/// later stage loaded the specimen farther, or made it wider, than it was there and met less stress.
std::optional<Peak> peak_in_stages(const TestResult& result) {
    const double sign = method_of(result.test).loading.sign, overall = largest_stress(result);
    if (!(overall > 0.0)) return std::nullopt;
    Peak peak;
    double of_stage = 0.0;
    int stage = 0;
    const HistoryRow* last = nullptr;  // of the stage
    const auto end_stage = [&] {
        const HistoryRow& top = result.history[peak.row];
        if (last == nullptr || last->stage == top.stage || of_stage > drop_fraction * peak.stress_Pa) return;
        const bool farther = sign * last->axial_strain > sign * top.axial_strain,
                   wider = sign * last->lateral_strain_gauge < sign * top.lateral_strain_gauge;
        if (farther || wider) peak.reached = true;
    };
    for (std::size_t i = 0; i < result.history.size(); ++i) {
        const HistoryRow& row = result.history[i];
        if (!is_loading(row) || !is_finite(row) || !of_loading_stage(result, row)) continue;
        if (row.stage != stage) {
            end_stage();
            of_stage = 0.0;
        }
        stage = row.stage;
        last = &row;
        const double stress = sign * row.axial_stress_Pa;
        of_stage = std::max(of_stage, stress);
        if (stress > peak.stress_Pa)
            peak = {i, stress, false};
        else if (stress <= drop_fraction * peak.stress_Pa && stress <= fall_in_stage * of_stage &&
                 of_stage >= first_peak_floor * overall)
            peak.reached = true;
    }
    end_stage();
    return peak;
}

/// The largest stress of the rows up to the one in which the disc is split.
std::optional<Peak> peak_until_split(const TestResult& result) {
    const auto splitting = splitting_crack(result);
    const bool split = splitting && splitting->split();
    Peak peak;
    for (std::size_t i = 0; i < result.history.size(); ++i) {
        const HistoryRow& row = result.history[i];
        if (!is_loading(row) || !is_finite(row)) continue;
        if (row.axial_stress_Pa > peak.stress_Pa) peak = {i, row.axial_stress_Pa, false};
        if (split && row.step >= *splitting->split_step() && row.phase == Phase::loading) break;
    }
    if (!(peak.stress_Pa > 0.0)) return std::nullopt;
    peak.reached = split;
    return peak;
}

}  // namespace

std::optional<Peak> find_peak(const TestResult& result) {
    if (!result.stages.empty()) return peak_in_stages(result);
    return method_of(result.test).reading == Reading::disc ? peak_until_split(result) : peak_before_a_fall(result, false);
}

std::optional<Peak> first_dip(const TestResult& result) { return peak_before_a_fall(result, true); }

LoadingCurve loading_curve(const TestResult& result, const Peak& peak) {
    const double sign = method_of(result.test).loading.sign;
    const auto& history = result.history;
    LoadingCurve curve;
    const bool confined = method_of(result.test).specimen.confined;
    if (confined) curve.stress_offset_Pa = result.test.sigma3_Pa;

    HistoryRow origin;  // unloaded
    if (confined) {
        std::size_t first = history.size();
        for (std::size_t i = 0; i < history.size(); ++i) {
            if (!is_finite(history[i])) continue;
            if (!is_loading(history[i]))
                first = i;  // the last row of the consolidation ...
            else if (first == history.size()) {
                first = i;
                break;
            }  // ... or, without one, the first row there is
            else
                break;
        }
        if (first == history.size()) return {};
        origin = history[first];
    }
    const auto point = [&](const HistoryRow& row, std::size_t i) {
        return CurvePoint{sign * row.axial_stress_Pa - curve.stress_offset_Pa, sign * (row.axial_strain - origin.axial_strain),
                          sign * (row.axial_strain_gauge - origin.axial_strain_gauge),
                          sign * (row.lateral_strain_gauge - origin.lateral_strain_gauge), i};
    };
    curve.points.push_back(point(origin, 0));
    double before_Pa = 0.0, largest_Pa = 0.0;  // in the stages before this one, and so far
    int stage = 0;
    for (std::size_t i = 0; i <= peak.row && i < history.size(); ++i) {
        if (!is_loading(history[i]) || !is_finite(history[i]) || !of_loading_stage(result, history[i])) continue;
        if (history[i].stage != stage) before_Pa = largest_Pa;
        stage = history[i].stage;
        const double stress_Pa = sign * history[i].axial_stress_Pa;
        largest_Pa = std::max(largest_Pa, stress_Pa);
        if (before_Pa > 0.0 && stress_Pa < before_Pa) continue;  // a loop; without stages there is no stage before
        curve.points.push_back(point(history[i], i));
    }
    if (curve.points.size() < 2 || !(curve.peak_Pa() > curve.points.front().stress_Pa)) return {};
    return curve;
}

std::optional<CurvePoint> at_stress(const LoadingCurve& curve, double stress_Pa) {
    const std::size_t i = first_at_or_above(curve, stress_Pa);
    if (i == 0 || curve.points.front().stress_Pa > stress_Pa) return std::nullopt;
    return interpolate(curve.points[i - 1], curve.points[i], stress_Pa);
}

std::vector<CurvePoint> window(const LoadingCurve& curve, double low_Pa, double high_Pa) {
    const auto low = at_stress(curve, low_Pa);
    const auto high = at_stress(curve, high_Pa);
    if (!low || !high) return {};
    std::vector<CurvePoint> points{*low};
    const std::size_t end = first_at_or_above(curve, high_Pa);
    for (std::size_t i = first_at_or_above(curve, low_Pa); i < end; ++i) {
        points.push_back(curve.points[i]);
    }
    points.push_back(*high);
    return points;
}

}  // namespace feldspar
