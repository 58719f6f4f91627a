#include "feldspar/lab/hole_failure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <queue>
#include <vector>

#include "feldspar/lab/gauges.hpp"
#include "feldspar/methods/round_hole.hpp"

namespace feldspar {
namespace {

constexpr double kSector = M_PI / 6.0;    // to both sides of a pole or a side: cracks there belong to it
constexpr double kBreakout = M_PI / 4.0;  // likewise to a breakout
constexpr double kOnset = 1.0;            // mean grains that a breakout is deep when it begins

enum class At { pole, side };

// Angle between the direction from the hole's centre to a place and the nearest pole or side.
double angle_from(At at, Vec2 out) {
    return at == At::pole ? std::atan2(std::abs(out.x), std::abs(out.y)) : std::atan2(std::abs(out.y), std::abs(out.x));
}

// Axial stress at the first crack of a kind within a grain of the edge.
double first_crack_at(const TestResult& result, const RoundHole& hole, double reach_m, At at, bool tensile_only) {
    for (const Crack& crack : result.cracks) {  // in the order in which they broke
        const Vec2 out = crack.place - hole.centre;
        if (tensile_only && crack.mode != CrackMode::tensile) continue;
        if (norm(out) - hole.radius_m <= reach_m && angle_from(at, out) <= kSector) return crack.axial_stress_Pa;
    }
    return HoleProperties::none;
}

// (P51): how deep the cracks of one side have come, each within a mean grain of those before or of the edge.
class Breakout {
public:
    Breakout(const RoundHole& hole, double step_m) : hole_(hole), step_m_(step_m) {}

    void add(const Crack& crack) {
        waiting_.push(norm(crack.place - hole_.centre) - hole_.radius_m);
        while (!waiting_.empty() && waiting_.top() <= depth_m_ + step_m_) {
            depth_m_ = std::max(depth_m_, waiting_.top());
            waiting_.pop();
        }
    }
    double depth_m() const { return depth_m_; }

private:
    RoundHole hole_;
    double step_m_, depth_m_ = 0.0;
    std::priority_queue<double, std::vector<double>, std::greater<>> waiting_;  // cracks that are too deep yet, the least first
};

// A row of the elastic answer: the end of the computed start, which lies below the first damage; else where loading has begun,
// before contacts soften.
const HistoryRow* elastic_row(const TestResult& result, const Peak& peak) {
    constexpr double kBegun = 0.02;  // of the largest stress
    const HistoryRow* found = nullptr;
    for (const HistoryRow& row : result.history)
        if (row.phase == Phase::elastic) found = &row;
    if (found != nullptr) return found;
    for (const HistoryRow& row : result.history) {
        if (row.cracks_tensile + row.cracks_shear > 0) break;
        if (row.phase == Phase::loading && row.axial_stress_Pa >= kBegun * peak.stress_Pa) return &row;
    }
    return nullptr;
}

}  // namespace

HoleProperties hole_failure(const TestResult& result, const Peak& peak) {
    HoleProperties p;
    if (!result.specimen) return p;
    const RoundHole hole = round_hole_of(result.specimen->outline);
    const double grain_m = result.specimen->quality.mean_diameter_m;
    const int side = gauge_number(result.gauges, side_stress_gauge), pole = gauge_number(result.gauges, pole_stress_gauge);
    p.radius_m = hole.radius_m;
    p.radius_over_grain = hole.radius_m / grain_m;
    if (side < 0 || pole < 0) return p;
    const bool stress_known = result.model.kind != GrainKind::inner_particles;  // docs/decisions, stress at a hole
    if (const HistoryRow* row = elastic_row(result, peak);
        stress_known && row != nullptr && row->sigma3_Pa == 0.0 && row->axial_stress_Pa > 0.0) {
        p.side_factor = row->gauges[side] / row->axial_stress_Pa;
        p.pole_factor = row->gauges[pole] / row->axial_stress_Pa;
    }
    p.pole_crack_Pa = first_crack_at(result, hole, grain_m, At::pole, true);
    p.side_crack_Pa = first_crack_at(result, hole, grain_m, At::side, false);
    std::array sides{Breakout(hole, grain_m), Breakout(hole, grain_m)};
    const Crack* onset = nullptr;
    const long long peak_step = result.history[peak.row].step;
    for (const Crack& crack : result.cracks) {
        const Vec2 out = crack.place - hole.centre;
        if (angle_from(At::side, out) > kBreakout) continue;
        Breakout& there = sides[out.x > 0.0 ? 1 : 0];
        there.add(crack);
        if (onset == nullptr && there.depth_m() >= kOnset * grain_m) onset = &crack;
        if (crack.step <= peak_step) p.depth_at_peak_m = std::max(sides[0].depth_m(), sides[1].depth_m());
    }
    p.depth_at_end_m = std::max(sides[0].depth_m(), sides[1].depth_m());
    if (std::isnan(p.depth_at_peak_m)) p.depth_at_peak_m = 0.0;
    if (onset == nullptr) return p;
    p.breakout_Pa = onset->axial_stress_Pa;
    if (!stress_known) return p;
    const auto then =
        std::ranges::lower_bound(result.history, onset->step, {}, &HistoryRow::step);  // the row that closes the crack's interval
    p.breakout_side_stress_Pa = (then == result.history.end() ? result.history.back() : *then).gauges[side];
    return p;
}

}  // namespace feldspar
