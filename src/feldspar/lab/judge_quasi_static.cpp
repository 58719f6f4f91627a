// judge(): was the test slow enough? Evidence from half the peak to the peak, the grade and the sentence
// (docs/theory/loading.md, verdict table (L9)).
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "feldspar/lab/loading_curve.hpp"
#include "feldspar/lab/properties.hpp"

namespace feldspar {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// One line of the verdict table: what was seen, and what grades A and B allow.
struct Criterion {
    double seen;
    double limit_a;
    double limit_b;
    std::string name;

    bool holds_a() const { return seen <= limit_a; }   // false for not-a-number: not shown
    bool holds_b() const { return seen <= limit_b; }
};

std::string percent(double value) { return fmt::format("{:.2g} %", 100.0 * value); }

std::vector<Criterion> criteria(const QuasiStaticEvidence& e, TestKind kind, GrainKind grains) {
    const bool brazilian = kind == TestKind::brazilian;
    const double wider = brazilian && grains != GrainKind::rigid ? 2.0 : 1.0;
    std::vector<Criterion> table{
        {e.residual_mean, 7e-3 * wider, 1.5e-2 * wider, "the mean unbalanced force over the load"},
        {e.residual_at_peak, kind == TestKind::direct_tension ? 4e-2 : 2e-2, 5e-2, "the unbalanced force over the load at the peak"},
        {e.imbalance_max, brazilian ? 5e-2 : 1.5e-2, brazilian ? 5e-2 : 3e-2, "the difference between the two platens' loads"},
        {e.kinetic_over_strain, 2e-4, 1e-3, "the kinetic energy over the strain energy"}};
    if (e.confirmed) {
        table.push_back({std::abs(e.peak_change_at_third), 5e-3, 2e-2, "the change of the strength in the repeat at a third of the target"});
    }
    return table;
}

/// "the mean ... is 2.1 % (0.7 % allowed) and ..." for the criteria that fail.
std::string failures(const std::vector<Criterion>& table, bool against_a) {
    std::string text;
    for (const Criterion& c : table) {
        if (against_a ? c.holds_a() : c.holds_b()) continue;
        if (!text.empty()) text += " and ";
        const double limit = against_a ? c.limit_a : c.limit_b;
        text += std::isfinite(c.seen) ? fmt::format("{} is {} ({} allowed)", c.name, percent(c.seen), percent(limit))
                                      : fmt::format("{} is not known", c.name);
    }
    return text;
}

/// What the user can do about it, as an imperative.
std::string advice(const NumericsSpec& numerics, char grade) {
    switch (numerics.kind) {
        case NumericsKind::adaptive: {
            if (numerics.residual_target) return fmt::format("run with residual_target = {:.1g}", *numerics.residual_target / 3.0);
            const bool asked_for_less = grade == 'B' && numerics.accuracy > 0.0075;
            const double accuracy = asked_for_less ? 0.005 : std::max(numerics.accuracy / 3.0, 0.0005);
            return fmt::format("run with accuracy = \"{:.1g} %\"", 100.0 * accuracy);
        }
        case NumericsKind::paper: return "run at a third of the platen speed, or with adaptive numerics";
        case NumericsKind::dynamic: return "use adaptive numerics (this is a dynamic test)";
    }
    return {};
}

std::string verdict(const QuasiStaticEvidence& e, const std::vector<Criterion>& table, const TestResult& result, bool peak_reached) {
    const std::string until = peak_reached ? "up to the peak" : "up to the largest stress of the record (the peak was not reached)";
    const std::string after = peak_reached ? "; the branch after the peak is dynamic" : "";
    const std::string repeat = e.confirmed ? fmt::format(", strength at a third of the target {:+.2g} %", 100.0 * e.peak_change_at_third) : "";
    if (e.grade == 'A') {
        return fmt::format("Quasi-static to about 0.5 % {} (mean unbalanced force {} of the load, platens agree within {}{}){}.", until,
                           percent(e.residual_mean), percent(e.imbalance_max), repeat, after);
    }
    if (e.grade == 'B') {
        return fmt::format("Quasi-static to about 2 % {}: {}; to reach 0.5 %, {}{}.", until, failures(table, true),
                           advice(result.numerics, e.grade), after);
    }
    return fmt::format("Not shown to be quasi-static {}: {}; the strength may depend on the loading rate: {}{}.", until,
                       failures(table, false), advice(result.numerics, e.grade), after);
}

/// R* at the peak: the median over the loading rows of the last percent of stress before it. The unstable crack that makes the
/// peak starts while the platens, a travel time away, still feel the stress rise; one row would tell of the crack, not of the rate.
double residual_near_peak(const TestResult& result, const Peak& peak, double sign) {
    std::vector<double> residuals;
    for (std::size_t i = 0; i <= peak.row; ++i) {
        const HistoryRow& row = result.history[i];
        if (row.phase == Phase::loading && sign * row.axial_stress_Pa >= 0.99 * peak.stress_Pa) residuals.push_back(row.residual);
    }
    if (residuals.empty() || std::any_of(residuals.begin(), residuals.end(), [](double r) { return std::isnan(r); })) return nan;
    const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
    std::nth_element(residuals.begin(), middle, residuals.end());
    return *middle;
}

}  // namespace

QuasiStaticEvidence judge(const TestResult& result) {
    QuasiStaticEvidence e;
    e.peak_change_at_third = result.evidence.peak_change_at_third;   // found by a second run, not by this record
    e.confirmed = result.evidence.confirmed;
    e.residual_mean = e.residual_at_peak = e.imbalance_max = e.kinetic_over_strain = e.damping_over_fracture = nan;

    const auto peak = find_peak(result);
    if (!peak) {
        e.verdict = "Not judged: the record has no loaded row.";
        return e;
    }
    const double sign = loading_sign(result.test.kind);
    double residuals = 0.0, imbalance = 0.0, kinetic = 0.0;
    int rows = 0;
    bool above_half = false;
    for (std::size_t i = 0; i <= peak->row; ++i) {
        const HistoryRow& row = result.history[i];
        const double stress = sign * row.axial_stress_Pa;
        if (row.phase != Phase::loading) continue;
        above_half = above_half || stress >= 0.5 * peak->stress_Pa;
        if (!above_half || !(stress > 0.0)) continue;
        ++rows;
        residuals += row.residual;
        const double difference = std::abs(row.stress_top_Pa - row.stress_bottom_Pa) / stress;
        const double strain_energy = row.energy.elastic_grains + row.energy.elastic_contacts;
        const double motion = strain_energy > 0.0 ? row.kinetic_deviation / strain_energy : nan;
        // A not-a-number must stay: std::max would drop it.
        imbalance = difference > imbalance || std::isnan(difference) ? difference : imbalance;
        kinetic = motion > kinetic || std::isnan(motion) ? motion : kinetic;
    }
    if (rows == 0) {
        e.verdict = "Not judged: the record has no loading step between half the peak and the peak.";
        return e;
    }
    const HistoryRow& top = result.history[peak->row];
    e.residual_mean = residuals / rows;
    e.residual_at_peak = residual_near_peak(result, *peak, sign);
    e.imbalance_max = imbalance;
    e.kinetic_over_strain = kinetic;
    if (top.energy.fracture > 0.0) e.damping_over_fracture = top.energy.damping / top.energy.fracture;

    const auto table = criteria(e, result.test.kind, result.model.kind);
    const bool a = std::all_of(table.begin(), table.end(), [](const Criterion& c) { return c.holds_a(); });
    const bool b = std::all_of(table.begin(), table.end(), [](const Criterion& c) { return c.holds_b(); });
    e.grade = a ? 'A' : b ? 'B' : 'C';
    e.verdict = verdict(e, table, result, peak->reached);
    return e;
}

}  // namespace feldspar
