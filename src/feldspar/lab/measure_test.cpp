// measure(): the laboratory numbers of one test, as defined in docs/theory/properties.md (P1)-(P10).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "feldspar/base/regression.hpp"
#include "feldspar/lab/brazilian_failure.hpp"
#include "feldspar/lab/cycles.hpp"
#include "feldspar/lab/damage_thresholds.hpp"
#include "feldspar/lab/disc_splitting.hpp"
#include "feldspar/lab/hole_failure.hpp"
#include "feldspar/lab/loading_curve.hpp"
#include "feldspar/lab/multi_stage.hpp"
#include "feldspar/lab/odd_strength.hpp"
#include "feldspar/lab/post_peak.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/lab/quantities.hpp"
#include "feldspar/lab/specimen_shape.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TestProperties nothing() {
    TestResult unmeasured;
    for (const TestQuantity& quantity : test_quantities()) quantity.put(unmeasured, nan);
    return unmeasured.properties;
}

double first_crack_stress(const TestResult& result) {
    const Crack* first = first_crack(result);
    return first == nullptr ? nan : method_of(result.test).loading.sign * first->axial_stress_Pa;
}

/// Slope of y over x between two fractions of the peak; x and y are members of a curve point.
double slope_between(const LoadingCurve& curve, double from, double to, double CurvePoint::*x, double CurvePoint::*y) {
    std::vector<double> xs, ys;
    for (const CurvePoint& p : window(curve, from * curve.peak_Pa(), to * curve.peak_Pa())) {
        xs.push_back(p.*x);
        ys.push_back(p.*y);
    }
    return regression_line(xs, ys).slope;
}

/// (P3): from the origin to half the peak.
double secant(const LoadingCurve& curve) {
    const auto half = at_stress(curve, 0.5 * curve.peak_Pa());
    if (!half || !(half->strain > 0.0)) return nan;
    return (half->stress_Pa - curve.points.front().stress_Pa) / half->strain;
}

/// (P5): over the same stress as (P3), from the gauges.
double secant_ratio(const LoadingCurve& curve) {
    const auto half = at_stress(curve, 0.5 * curve.peak_Pa());
    if (!half || !(half->strain_gauge > 0.0)) return nan;
    return -half->lateral_gauge / half->strain_gauge;
}

TestProperties read_record(const TestResult& result) {
    TestProperties p = nothing();
    p.first_crack_Pa = first_crack_stress(result);
    const auto peak = find_peak(result);
    if (!peak) return p;
    p.peak_stress_Pa = peak->stress_Pa;
    p.peak_reached = peak->reached;
    const std::span<const MethodProperty> own = method_of(result.test).properties;
    p.of_method.assign(own.size(), nan);
    if (result.specimen) {  // they speak of its measures
        const MethodReading reading{result, peak->row, peak->stress_Pa, peak->reached};
        for (std::size_t i = 0; i < own.size(); ++i) p.of_method[i] = own[i].value(reading);
        if (method_of(result.test).remarks != nullptr) p.remarks = method_of(result.test).remarks(reading);
    }
    switch (method_of(result.test).reading) {
        case Reading::disc:
            p.brazilian = brazilian_failure(result, *peak);
            return p;
        case Reading::stages:
            p.multi_stage = multi_stage(result, *peak);
            return p;
        case Reading::hole:
            p.hole = hole_failure(result, *peak);
            return p;
        case Reading::curve:
            return p;
        case Reading::column:
            break;
    }

    const LoadingCurve curve = loading_curve(result, *peak);
    if (curve.points.empty()) return p;
    p.E_secant_Pa = secant(curve);
    p.E_tangent_Pa = slope_between(curve, 0.4, 0.6, &CurvePoint::strain, &CurvePoint::stress_Pa);
    p.E_average_Pa = slope_between(curve, 0.3, 0.7, &CurvePoint::strain, &CurvePoint::stress_Pa);
    p.E_gauge_Pa = slope_between(curve, 0.4, 0.6, &CurvePoint::strain_gauge, &CurvePoint::stress_Pa);
    p.nu = secant_ratio(curve);
    p.E_initial_Pa = slope_between(curve, 0.0, 0.1, &CurvePoint::strain_gauge, &CurvePoint::stress_Pa);
    p.nu_initial = -slope_between(curve, 0.0, 0.1, &CurvePoint::strain_gauge, &CurvePoint::lateral_gauge);
    p.nu_tangent = -slope_between(curve, 0.4, 0.6, &CurvePoint::strain_gauge, &CurvePoint::lateral_gauge);
    p.post_peak = post_peak(result, *peak, curve, p.E_tangent_Pa);
    if (!peak->reached) return p;  // the thresholds mean nothing before the peak is known

    p.sigma_ci_crack_count_Pa = crack_count_threshold(result, *peak);
    if (!method_of(result.test).loading.widens) return p;  // a pulled specimen has no volumetric reversal
    const DamageThresholds thresholds = damage_thresholds(curve, p.first_crack_Pa);
    p.sigma_ci_crack_volume_Pa = thresholds.crack_volume_Pa;
    p.sigma_ci_lateral_strain_Pa = thresholds.lateral_strain_Pa;
    p.sigma_cd_Pa = thresholds.reversal_Pa;
    return p;
}

// An isotropic elastic body does not lose volume when it is pulled: its ratio is at most one half. More than that at half the
// peak says that cracks have opened and count as widening.
void note_widening(TestProperties& p) {
    constexpr double kMostElastic = 0.5;
    if (!(p.nu > kMostElastic)) return;
    std::string remark = fmt::format(
        "Poisson's ratio of {:.3g} at half the peak is no elastic constant: cracks that open count as widening.", p.nu);
    if (p.nu_initial <= kMostElastic) remark += fmt::format(" Before damage it is {:.3g}.", p.nu_initial);
    p.remarks.push_back(remark);
}

// The wider the arcs on which a disc is loaded, the less tension there is in its centre.
void note_arcs(const TestResult& result, TestProperties& p) {
    constexpr double kEnough = 0.95;  // a strength that is 5 % too high is worth a word
    const BrazilianFailure& b = p.brazilian;
    const double arc_deg = 0.5 * (b.contact_arc_top_deg + b.contact_arc_bottom_deg), share = tension_under_arcs(arc_deg);
    const auto disc = loaded_disc(result);
    if (!disc || disc->flat_height_m > 0.0 || !(share < kEnough)) return;
    p.remarks.push_back(
        fmt::format("The disc was loaded on arcs of {:.0f} degrees: the tension in its centre was down to {:.2g} of 2P / (pi D "
                    "t), and BTS is too high by as much. "
                    "A larger disc, or a stiffer layer on the jaws (plate_Kn), has smaller arcs.",
                    arc_deg, share));
}

}  // namespace

TestProperties measure(const TestResult& result) {
    TestProperties p = read_record(result);
    p.cycles = cycles_of(result);
    for (const CycleProperties& cycle : p.cycles)
        if (std::isfinite(cycle.damage)) p.damage_omega = cycle.damage;
    note_section(result, p);
    note_widening(p);
    note_arcs(result, p);
    for (std::string& sentence : why_odd(result, p)) p.remarks.push_back(std::move(sentence));
    return p;
}

}  // namespace feldspar
