#include "feldspar/calibration/missed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "feldspar/calibration/calibration_files.hpp"

namespace feldspar {
namespace {

constexpr double notable = 0.05;  // relative change of a target over that of an unknown: below it a wider range would not help

struct Reason {
    Miss miss = Miss::none;
    std::string because;  // goes on after "... missed: ... "
};

std::string plus_minus(const Target& target, double half) { return "± " + target_text(target, half); }

// Enough tests have a strength that counts.
Reason not_confirmed(const TargetOutcome& outcome) {
    const TestGrades& g = outcome.grades;
    std::vector<std::string> words;
    if (g.C > 0) words.push_back(fmt::format("{} of {} tests have grade C", g.C, g.all()));
    if (g.failed > 0) words.push_back(fmt::format("{} of {} failed", g.failed, g.all()));
    if (g.unfinished > 0) words.push_back(fmt::format("{} of {} ended before their strength was known", g.unfinished, g.all()));
    std::string because;
    for (const std::string& word : words) because += (because.empty() ? "" : ", ") + word;
    if (because.empty()) because = "the tests show no value of it";
    std::string change = "look at the runs that failed";
    if (g.C >= g.failed && g.C >= g.unfinished)
        change = "ask for a finer numerics.accuracy";
    else if (g.unfinished > g.failed)
        change = "give the tests a larger maximum_strain";
    return {Miss::not_confirmed, because + "; " + change};
}

// An unknown at an end of its range, beyond which the target would come nearer.
std::string range_that_ends(const CalibrationResult& result, std::size_t t, double wanted_change) {
    for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
        const UnknownOutcome& unknown = result.unknowns[u];
        const double slope = result.sensitivity[t][u];
        if (!unknown.at_an_end || !(std::abs(slope) > notable)) continue;
        const bool at_high =
            std::abs(std::log(unknown.best / unknown.unknown.high)) < std::abs(std::log(unknown.best / unknown.unknown.low));
        if ((slope > 0.0) != (at_high == (wanted_change > 0.0))) continue;
        return fmt::format("{} stands at the {} end of its range, {}; widen it", unknown.unknown.name,
                           at_high ? "upper" : "lower",
                           unknown_text(unknown.unknown, at_high ? unknown.unknown.high : unknown.unknown.low));
    }
    return {};
}

// Packings with which the mean is known to half of the tolerance.
int packings_for(const TargetOutcome& outcome) {
    const double ratio = 2.0 * 1.96 * outcome.confirmed.standard_deviation / outcome.target.tolerance;
    return static_cast<int>(std::ceil(ratio * ratio));
}

// The best set was not even predicted to meet the target.
Reason predicted_to_miss(const Calibration& calibration, const CalibrationResult& result, std::size_t t) {
    const TargetOutcome& outcome = result.targets[t];
    const std::string range = range_that_ends(result, t, outcome.target.value - outcome.foreseen.value);
    if (!range.empty()) return {Miss::range_end, range};
    const double low = outcome.target.value - outcome.target.tolerance, high = outcome.target.value + outcome.target.tolerance;
    if (!(outcome.lowest <= high && outcome.highest >= low))
        return {Miss::conflict,
                fmt::format("no set in the ranges is predicted to meet it together with the others ({}); give way in another "
                            "target, free another unknown or widen the ranges",
                            std::isfinite(outcome.lowest)
                                ? fmt::format("{} to {} is within reach", target_text(outcome.target, outcome.lowest),
                                              target_text(outcome.target, outcome.highest))
                                : std::string("which are never all met"))};
    return {Miss::budget,
            fmt::format(
                "the best set found is predicted to show {}, and {} of {} runs were used; a larger budget may find a better one",
                target_text(outcome.target, outcome.foreseen.value), result.runs, calibration.budget)};
}

Reason reason_for(const Calibration& calibration, const CalibrationResult& result, std::size_t t) {
    const TargetOutcome& outcome = result.targets[t];
    const Target& target = outcome.target;
    const Foresight& f = outcome.foreseen;
    if (!enough_confirmed(outcome)) return not_confirmed(outcome);
    if (std::abs(f.value - target.value) > target.tolerance) return predicted_to_miss(calibration, result, t);
    const double mean = outcome.confirmed.mean;
    if (mean < f.low || mean > f.high)
        return {Miss::prediction, fmt::format("it said {} to {} (95 %), so the rock behaves in a way that was not learned; give "
                                              "a larger budget, or ranges that are narrower about this set",
                                              target_text(target, f.low), target_text(target, f.high))};
    const std::string range = range_that_ends(result, t, target.value - mean);
    const std::string also = range.empty() ? std::string{} : "; " + range;
    if (f.grade > f.doubt && f.grade > f.scatter)
        return {Miss::grade, fmt::format("they may move the mean by {} (95 %); ask for a finer numerics.accuracy{}",
                                         plus_minus(target, 1.96 * f.grade), also)};
    if (f.doubt > f.scatter)
        return {range.empty() ? Miss::prediction : Miss::range_end,
                fmt::format("it was known to {} (95 %) only, and the tolerance is {}; give more seeds and a larger budget{}",
                            plus_minus(target, 1.96 * f.doubt), plus_minus(target, target.tolerance), also)};
    return {
        range.empty() ? Miss::scatter : Miss::range_end,
        fmt::format("the mean of {} is known to {} (95 %), and the tolerance is {}; take {} confirm_seeds and as many seeds, a "
                    "larger specimen or a wider tolerance{}",
                    outcome.confirmed.count, plus_minus(target, outcome.confirmed.half_width()),
                    plus_minus(target, target.tolerance), std::max(packings_for(outcome), 2 * outcome.confirmed.count), also)};
}

const char* in_words(Miss miss) {
    switch (miss) {
        case Miss::range_end:
            return "the end of a range";
        case Miss::conflict:
            return "a conflict of targets";
        case Miss::budget:
            return "the budget";
        case Miss::prediction:
            return "the prediction";
        case Miss::scatter:
            return "the scatter of packings";
        case Miss::grade:
            return "the tests' own errors";
        case Miss::none:
        case Miss::not_confirmed:
            break;
    }
    return "?";
}

}  // namespace

const char* name(Miss miss) {
    switch (miss) {
        case Miss::none:
            return "none";
        case Miss::not_confirmed:
            return "not confirmed";
        case Miss::range_end:
            return "range end";
        case Miss::conflict:
            return "conflict";
        case Miss::budget:
            return "budget";
        case Miss::prediction:
            return "prediction";
        case Miss::scatter:
            return "scatter";
        case Miss::grade:
            return "grade";
    }
    return "?";
}

void say_what_is_missed(const Calibration& calibration, CalibrationResult& result) {
    for (std::size_t t = 0; t < result.targets.size(); ++t) {
        TargetOutcome& outcome = result.targets[t];
        if (outcome.met) continue;
        const Reason reason = reason_for(calibration, result, t);
        const double off = outcome.confirmed.mean - outcome.target.value;
        outcome.miss = reason.miss;
        if (reason.miss == Miss::not_confirmed)
            outcome.missed = fmt::format("{} is not confirmed: {}.", outcome.target.label(), reason.because);
        else
            outcome.missed = fmt::format(
                "{} is missed: {} for {}, {:.2g} tolerances too {}; the reason is {}: {}.", outcome.target.label(),
                target_text(outcome.target, outcome.confirmed.mean), target_text(outcome.target, outcome.target.value),
                std::abs(off) / outcome.target.tolerance, off > 0.0 ? "high" : "low", in_words(reason.miss), reason.because);
    }
}

bool enough_confirmed(const TargetOutcome& outcome) {
    return std::isfinite(outcome.confirmed.mean) && 2 * outcome.grades.in_mean() >= outcome.grades.all();
}

}  // namespace feldspar
