#include "feldspar/lab/damage_thresholds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/base/regression.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double counted_fraction = 0.01;  // (P7)
constexpr double departure_tolerance =
    0.002;  // (P9), (P10): of the elastic strain at the peak; well above the waves of the motion
constexpr double elastic_from = 0.10, elastic_to_least = 0.20, elastic_to_most = 0.40;  // (P9), of the peak

double volumetric(const CurvePoint& p) { return p.strain_gauge + p.lateral_gauge; }

std::size_t volumetric_maximum(const LoadingCurve& curve) {
    const auto top = std::max_element(curve.points.begin(), curve.points.end(),
                                      [](const CurvePoint& a, const CurvePoint& b) { return volumetric(a) < volumetric(b); });
    return static_cast<std::size_t>(top - curve.points.begin());
}

/// (P9): k = (1 - nu) / E of the intact specimen; the crack volumetric strain is eps_v - k (sigma - sigma_origin).
double crack_volume_threshold(const LoadingCurve& curve, double first_crack_Pa) {
    const double peak = curve.peak_Pa();
    double to = elastic_to_most * peak;
    const double first_crack = first_crack_Pa - curve.stress_offset_Pa;
    if (std::isfinite(first_crack)) to = std::clamp(first_crack, elastic_to_least * peak, to);
    std::vector<double> stress, volume;
    for (const CurvePoint& p : window(curve, elastic_from * peak, to)) {
        stress.push_back(p.stress_Pa);
        volume.push_back(volumetric(p));
    }
    const double k = regression_line(stress, volume).slope;
    if (!(k > 0.0)) return nan;

    const auto crack_volume = [&](const CurvePoint& p) { return volumetric(p) - k * p.stress_Pa; };
    double largest = -std::numeric_limits<double>::infinity();
    for (const CurvePoint& p : curve.points) largest = std::max(largest, crack_volume(p));
    const double threshold = largest - departure_tolerance * k * peak;
    for (std::size_t i = curve.points.size(); i-- > 0;) {
        if (crack_volume(curve.points[i]) < threshold) continue;
        const bool still_closed_at_peak = i + 1 == curve.points.size();
        return still_closed_at_peak ? nan : curve.points[i].stress_Pa + curve.stress_offset_Pa;
    }
    return nan;
}

/// (P10): the largest distance of the lateral strain from the straight line between the origin and `end`.
double lateral_strain_threshold(const LoadingCurve& curve, std::size_t end) {
    const CurvePoint& a = curve.points.front();
    const CurvePoint& b = curve.points[end];
    const double rise = b.stress_Pa - a.stress_Pa;
    if (!(rise > 0.0) || !(b.lateral_gauge < 0.0)) return nan;
    double largest = departure_tolerance * -b.lateral_gauge;
    double found = nan;
    for (std::size_t i = 0; i <= end; ++i) {
        const CurvePoint& p = curve.points[i];
        const double line = b.lateral_gauge * (p.stress_Pa - a.stress_Pa) / rise;
        if (p.lateral_gauge - line > largest) {
            largest = p.lateral_gauge - line;
            found = p.stress_Pa + curve.stress_offset_Pa;
        }
    }
    return found;
}

}  // namespace

DamageThresholds damage_thresholds(const LoadingCurve& curve, double first_crack_Pa) {
    if (curve.points.size() < 3) return {nan, nan, nan};
    for (const CurvePoint& p : curve.points) {
        if (!std::isfinite(volumetric(p))) return {nan, nan, nan};
    }
    const std::size_t turn = volumetric_maximum(curve);
    const bool turns = turn > 0 && turn + 1 < curve.points.size();
    DamageThresholds found{nan, nan, nan};
    if (turns) found.reversal_Pa = curve.points[turn].stress_Pa + curve.stress_offset_Pa;
    found.crack_volume_Pa = crack_volume_threshold(curve, first_crack_Pa);
    found.lateral_strain_Pa = lateral_strain_threshold(curve, turns ? turn : curve.points.size() - 1);
    return found;
}

double crack_count_threshold(const TestResult& result, const Peak& peak) {
    const long long peak_step = result.history[peak.row].step;
    std::vector<const Crack*> cracks;
    for (const Crack& crack : result.cracks) {
        if (crack.step <= peak_step) cracks.push_back(&crack);
    }
    if (cracks.empty()) return nan;
    std::stable_sort(cracks.begin(), cracks.end(), [](const Crack* a, const Crack* b) { return a->step < b->step; });
    const auto counted = static_cast<std::size_t>(std::ceil(counted_fraction * static_cast<double>(cracks.size()) - 1e-9));
    return method_of(result.test).loading.sign * cracks[counted - 1]->axial_stress_Pa;
}

}  // namespace feldspar
