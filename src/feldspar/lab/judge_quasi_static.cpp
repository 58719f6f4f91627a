// judge(): was the test slow enough? The evidence, the estimated error of the strength, the grade and the sentence
// (docs/theory/loading.md, estimate (L8) and verdict table (L9)).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "feldspar/base/median.hpp"
#include "feldspar/lab/brazilian_failure.hpp"
#include "feldspar/lab/loading_curve.hpp"
#include "feldspar/lab/per_cent.hpp"
#include "feldspar/lab/post_peak.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/lab/rate_control.hpp"
#include "feldspar/lab/specimen_shape.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// The error of a strength that is estimated from the test alone has two parts (L8): what the typical body leaves unbalanced is
// carried by inertia and damping instead of the rock (MethodRate::residual_share), and the load rises on while an unstable crack
// takes a quarter of a travel time to show.
constexpr double kTravelTimesToShow = 0.25;
constexpr double kInBalance = 0.02;   // part of the unbalanced force in the error, with which a body counts as balanced: grade B
constexpr double kNearPeak = 0.9;     // share of the peak from which on the evidence decides
constexpr double kOfTheRepeat = 1.5;  // an error in proportion to the rate loses two thirds of itself in a repeat at a third; the
                                      // slower of two passages has less

/// One line of the verdict table: what was seen, and what grades A and B allow.
struct Criterion {
    double seen;
    double limit_a;
    double limit_b;
    std::string name;

    bool holds_a() const { return seen <= limit_a; }  // false for not-a-number: not shown
    bool holds_b() const { return seen <= limit_b; }
};

std::vector<Criterion> criteria(const QuasiStaticEvidence& e, MethodId kind) {
    const MethodVerdict& allowed = method_of(kind).verdict;
    return {{e.error_estimate, allowed.error_a, grade_b_error,
             e.confirmed ? "one and a half times the change of the strength in a slower repeat"
                         : "the estimated error of the strength"},
            {e.imbalance_mean, allowed.imbalance_a, allowed.imbalance_b, "the mean difference between the two platens' loads"}};
}

/// "the mean ... is 2.1 % (0.7 % allowed) and ..." for the criteria that fail.
std::string failures(const std::vector<Criterion>& table, bool against_a) {
    std::string text;
    for (const Criterion& c : table) {
        if (against_a ? c.holds_a() : c.holds_b()) continue;
        if (!text.empty()) text += " and ";
        const double limit = against_a ? c.limit_a : c.limit_b;
        text += std::isfinite(c.seen) ? fmt::format("{} is {} ({} allowed)", c.name, per_cent(c.seen), per_cent(limit))
                                      : fmt::format("{} is not known", c.name);
    }
    return text;
}

/// By how much the worst criterion misses, as a factor; 3 where that is not known.
double excess(const std::vector<Criterion>& table, bool against_a) {
    double worst = 1.0;
    for (const Criterion& c : table) {
        const double ratio = c.seen / (against_a ? c.limit_a : c.limit_b);
        if (!std::isfinite(ratio)) return 3.0;
        worst = std::max(worst, ratio);
    }
    return worst;
}

/// What the user can do about it, as an imperative. @param slower  by which factor the target or the speed should fall
std::string advice(const TestResult& result, double slower) {
    switch (result.numerics.kind) {
        case NumericsKind::adaptive: {
            const double target = residual_target(result.numerics, result.test.kind) / slower;
            const double accuracy = accuracy_of(target, result.test.kind);
            const bool by_accuracy = !result.numerics.residual_target && accuracy >= 0.0005;
            return by_accuracy ? fmt::format("run with accuracy = \"{:.1g} %\"", 100.0 * accuracy)
                               : fmt::format("run with residual_target = {:.1g}", target);
        }
        case NumericsKind::paper:
            return fmt::format("run at a platen speed smaller by a factor of {:.2g}, or with adaptive numerics", slower);
        case NumericsKind::dynamic:
            return "use adaptive numerics (this is a dynamic test)";
    }
    return {};
}

/// Between which forces are compared.
const char* sides_of(const TestSpec& test) {
    return method_of(test).start.strained_evenly ? "platens" : "what loads and what holds";
}

std::string verdict(const QuasiStaticEvidence& e, const std::vector<Criterion>& table, const TestResult& result,
                    bool peak_reached) {
    const std::string until =
        peak_reached ? "up to the peak" : "up to the largest stress of the record (the peak was not reached)";
    const std::string after = peak_reached && !branch_is_followed(result) ? "; the branch after the peak is dynamic" : "";
    const std::string repeat =
        e.confirmed ? fmt::format(", strength changed by {:+.2g} % in a slower repeat", 100.0 * e.peak_change_at_third) : "";
    const double slower = std::max(1.5, excess(table, e.grade != 'C'));
    const std::string grade_a = per_cent(table.front().limit_a);
    if (e.grade == 'A') {
        return fmt::format("Quasi-static to about {} {} (estimated error of the strength {}, {} agree within {}{}){}.", grade_a,
                           until, per_cent(e.error_estimate), sides_of(result.test), per_cent(e.imbalance_mean), repeat, after);
    }
    if (e.grade == 'B') {
        return fmt::format("Quasi-static to about 2 % {}: {}; to reach {}, {}{}.", until, failures(table, true), grade_a,
                           advice(result, slower), after);
    }
    const std::string balanced =
        std::isfinite(e.balanced_stress_Pa) ? fmt::format(" (in balance up to {:.4g} MPa)", 1e-6 * e.balanced_stress_Pa) : "";
    return fmt::format("Not shown to be quasi-static {}: {}; the strength may depend on the loading rate{}: {}{}.", until,
                       failures(table, false), balanced, advice(result, slower), after);
}

/// What a repeat at another damping has shown; empty without one.
std::string damping_remark(const QuasiStaticEvidence& e) {
    if (!(e.other_damping > 0.0)) return {};
    const bool matters = std::abs(e.peak_change_at_other_damping) > std::max(0.01, e.error_estimate);
    return fmt::format(" At a damping of {:g} the strength changes by {:+.2g} %{}.", e.other_damping,
                       100.0 * e.peak_change_at_other_damping,
                       matters ? ": it depends on the numerical damping, which no slower loading takes away" : "");
}

/// R* at the peak: the median over the loading rows of the last percent of stress before it. The unstable crack that makes the
/// peak starts while the platens, a travel time away, still feel the stress rise; one row would tell of the crack, not of the
/// rate.
double residual_near_peak(const TestResult& result, const Peak& peak, double sign) {
    std::vector<double> residuals;
    for (std::size_t i = 0; i <= peak.row; ++i) {
        const HistoryRow& row = result.history[i];
        if (row.phase == Phase::loading && of_loading_stage(result, row) && sign * row.axial_stress_Pa >= 0.99 * peak.stress_Pa)
            residuals.push_back(row.residual);
    }
    if (residuals.empty() || std::any_of(residuals.begin(), residuals.end(), [](double r) { return std::isnan(r); })) return nan;
    return upper_median(residuals);
}

}  // namespace

QuasiStaticEvidence judge(const TestResult& result) {
    QuasiStaticEvidence e;
    e.peak_change_at_third = result.evidence.peak_change_at_third;  // found by a second run, not by this record
    e.confirmed = result.evidence.confirmed;
    e.other_damping = result.evidence.other_damping;
    e.peak_change_at_other_damping = result.evidence.peak_change_at_other_damping;
    for (double QuasiStaticEvidence::*value :
         {&QuasiStaticEvidence::error_estimate, &QuasiStaticEvidence::residual_median, &QuasiStaticEvidence::load_per_travel_time,
          &QuasiStaticEvidence::imbalance_mean, &QuasiStaticEvidence::residual_mean, &QuasiStaticEvidence::residual_at_peak,
          &QuasiStaticEvidence::imbalance_max, &QuasiStaticEvidence::kinetic_over_strain,
          &QuasiStaticEvidence::damping_over_fracture, &QuasiStaticEvidence::balanced_stress_Pa})
        e.*value = nan;

    const auto peak = find_peak(result);
    if (!peak) {
        e.verdict = "Not judged: the record has no loaded row.";
        return e;
    }
    const double sign = method_of(result.test).loading.sign;
    double residuals = 0.0, imbalance = 0.0, kinetic = 0.0;
    double medians_near = 0.0, speeds_near = 0.0, imbalances_near = 0.0;
    int rows = 0, rows_near = 0;
    bool above_half = false;
    for (std::size_t i = 0; i <= peak->row; ++i) {
        const HistoryRow& row = result.history[i];
        const double stress = sign * row.axial_stress_Pa;
        if (row.phase != Phase::loading || !of_loading_stage(result, row)) continue;
        above_half = above_half || stress >= 0.5 * peak->stress_Pa;
        if (!above_half || !(stress > 0.0)) continue;
        ++rows;
        residuals += row.residual;
        if (method_of(result.test).rate.residual_share * row.residual_median <= kInBalance && !(stress <= e.balanced_stress_Pa))
            e.balanced_stress_Pa = stress;
        const double difference = std::abs(row.stress_top_Pa - row.stress_bottom_Pa) / stress;
        const double strain_energy = row.energy.elastic_grains + row.energy.elastic_contacts;
        const double motion = strain_energy > 0.0 ? row.kinetic_deviation / strain_energy : nan;
        // A not-a-number must stay: std::max would drop it.
        imbalance = difference > imbalance || std::isnan(difference) ? difference : imbalance;
        kinetic = motion > kinetic || std::isnan(motion) ? motion : kinetic;
        if (stress < kNearPeak * peak->stress_Pa) continue;
        ++rows_near;
        medians_near += row.residual_median;
        speeds_near += std::abs(row.platen_speed / row.platen_displacement_m);
        imbalances_near += difference;
    }
    if (rows == 0) {
        e.verdict = "Not judged: the record has no loading step between half the peak and the peak.";
        return e;
    }
    const HistoryRow& top = result.history[peak->row];
    if (rows_near > 0) {
        e.residual_median = medians_near / rows_near;
        e.load_per_travel_time = result.travel_time > 0.0 ? speeds_near / rows_near * result.travel_time : nan;
        e.imbalance_mean = imbalances_near / rows_near;
        e.error_estimate =
            method_of(result.test).rate.residual_share * e.residual_median + kTravelTimesToShow * e.load_per_travel_time;
    }
    if (e.confirmed) e.error_estimate = kOfTheRepeat * std::abs(e.peak_change_at_third);  // measured instead of estimated
    e.residual_mean = residuals / rows;
    e.residual_at_peak = residual_near_peak(result, *peak, sign);
    e.imbalance_max = imbalance;
    e.kinetic_over_strain = kinetic;
    if (top.energy.fracture > 0.0) e.damping_over_fracture = top.energy.damping / top.energy.fracture;

    const auto table = criteria(e, result.test.kind);
    const bool a = std::all_of(table.begin(), table.end(), [](const Criterion& c) { return c.holds_a(); });
    const bool b = std::all_of(table.begin(), table.end(), [](const Criterion& c) { return c.holds_b(); });
    e.grade = a ? 'A' : b ? 'B' : 'C';
    e.verdict = verdict(e, table, result, peak->reached) + start_remark(result, *peak) + damping_remark(e);
    look_at_buckling(result, e);
    return e;
}

}  // namespace feldspar
