#include "feldspar/calibration/calibration_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "feldspar/base/text_table.hpp"
#include "feldspar/output/provenance_json.hpp"

namespace feldspar {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string with_unit(double value, const std::string& unit) {
    return unit.empty() ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} {}", value, unit);
}

// A mean that is less sure than its tolerance may have met it by luck.
std::string verdict_on(const TargetOutcome& t) {
    if (t.miss == Miss::not_confirmed) return "not confirmed";
    if (!t.met) return "not met";
    return t.confirmed.half_width() <= t.target.tolerance ? "met" : "met, but the mean is less sure than that";
}

// "9/1/0", and what else there was.
std::string grades_text(const TestGrades& grades) {
    std::string text = fmt::format("{}/{}/{}", grades.A, grades.B, grades.C);
    if (grades.unfinished > 0) text += fmt::format(", {} unfinished", grades.unfinished);
    return grades.failed > 0 ? text + fmt::format(", {} failed", grades.failed) : text;
}

std::string range_text(const Unknown& unknown, double low, double high) {
    if (!std::isfinite(low) || !std::isfinite(high)) return "-";
    return fmt::format("{:.4g} ... {}", low, unknown_text(unknown, high));
}

}  // namespace

UserQuantity user_quantity(const Target& target) { return user_quantity(property_of(target)); }

std::string unit_word(const Unknown& unknown) {
    return unknown.unit.substr(std::min(unknown.unit.size(), unknown.unit.find_first_not_of(' ')));
}

std::string target_text(const Target& target, double value) {
    if (!std::isfinite(value)) return "-";
    const UserQuantity quantity = user_quantity(target);
    return with_unit(value * quantity.factor, quantity.unit);
}

std::string unknown_text(const Unknown& unknown, double value) {
    return std::isfinite(value) ? with_unit(value, unit_word(unknown)) : "-";
}

std::string calibration_text(const CalibrationResult& result, std::size_t columns) {
    std::vector<Row> unknowns{{"unknown", "best", "as good (90 %)", "range"}};
    for (const UnknownOutcome& u : result.unknowns)
        unknowns.push_back({u.unknown.name, unknown_text(u.unknown, u.best), range_text(u.unknown, u.low, u.high),
                            range_text(u.unknown, u.unknown.low, u.unknown.high)});
    std::vector<Row> targets{
        {"target", "wanted", "tolerance", "predicted", "confirmed", "95 % interval", "packings", "A/B/C", ""}};
    for (const TargetOutcome& t : result.targets)
        targets.push_back(
            {t.target.label(), target_text(t.target, t.target.value), "± " + target_text(t.target, t.target.tolerance),
             target_text(t.target, t.predicted) + " ± " + target_text(t.target, 0.5 * (t.foreseen.high - t.foreseen.low)),
             target_text(t.target, t.confirmed.mean), "± " + target_text(t.target, t.confirmed.half_width()),
             std::to_string(t.confirmed.count), grades_text(t.grades), verdict_on(t)});
    std::string text = aligned(unknowns, 1, columns) + "\n" + aligned(targets, 1, columns);
    text +=
        "Predicted: what the mean of the confirming packings was to show, 95 %. A/B/C: grades of the tests that confirm; those "
        "of grade C are not in the mean.\n";
    if (std::any_of(result.targets.begin(), result.targets.end(), [](const TargetOutcome& t) { return !t.missed.empty(); }))
        text += "\n";
    for (const TargetOutcome& t : result.targets)
        if (!t.missed.empty()) text += t.missed + "\n";
    if (!result.findings.empty()) text += "\n";
    for (const std::string& finding : result.findings) text += finding + "\n";
    text += fmt::format("\n{} runs were used, confirmation included.", result.runs);
    if (result.failed > 0) text += fmt::format(" {} tests to learn from failed and are left out.", result.failed);
    if (result.grade_C > 0) text += fmt::format(" {} have grade C: upper bounds of the strength, or left out.", result.grade_C);
    return text + "\n";
}

std::string calibration_json(const Calibration& calibration, const CalibrationResult& result, const Provenance& provenance) {
    Json json{{"name", calibration.name},     {"complete", result.complete}, {"runs", result.runs},
              {"budget", calibration.budget}, {"failed", result.failed},     {"grade_C", result.grade_C}};
    json["unknowns"] = Json::array();
    for (const UnknownOutcome& u : result.unknowns)
        json["unknowns"].push_back({{"name", u.unknown.name},
                                    {"key", u.unknown.key},
                                    {"times", u.unknown.times},
                                    {"unit", u.unknown.unit},
                                    {"best", number(u.best)},
                                    {"as_good_low", number(u.low)},
                                    {"as_good_high", number(u.high)},
                                    {"determined", number(u.determined)},
                                    {"range_low", u.unknown.low},
                                    {"range_high", u.unknown.high},
                                    {"at_an_end", u.at_an_end}});
    json["targets"] = Json::array();
    for (std::size_t t = 0; t < result.targets.size(); ++t) {
        const TargetOutcome& outcome = result.targets[t];
        Json sensitivity = Json::object();
        for (std::size_t u = 0; u < result.unknowns.size(); ++u)
            sensitivity[result.unknowns[u].unknown.name] = number(result.sensitivity[t][u]);
        json["targets"].push_back({{"name", outcome.target.label()},
                                   {"wanted", outcome.target.value},
                                   {"tolerance", outcome.target.tolerance},
                                   {"predicted", number(outcome.predicted)},
                                   {"predicted_deviation", number(outcome.deviation)},
                                   {"foreseen_low", number(outcome.foreseen.low)},
                                   {"foreseen_high", number(outcome.foreseen.high)},
                                   {"foreseen_probability", number(outcome.foreseen.probability)},
                                   {"deviation_of_scatter", number(outcome.foreseen.scatter)},
                                   {"deviation_of_grade", number(outcome.foreseen.grade)},
                                   {"confirmed", number(outcome.confirmed.mean)},
                                   {"confirmed_low", number(outcome.confirmed.low)},
                                   {"confirmed_high", number(outcome.confirmed.high)},
                                   {"packings", outcome.confirmed.count},
                                   {"met", outcome.met},
                                   {"grades",
                                    {{"A", outcome.grades.A},
                                     {"B", outcome.grades.B},
                                     {"C", outcome.grades.C},
                                     {"unfinished", outcome.grades.unfinished},
                                     {"failed", outcome.grades.failed}}},
                                   {"miss", name(outcome.miss)},
                                   {"missed", outcome.missed},
                                   {"reachable_low", number(outcome.lowest)},
                                   {"reachable_high", number(outcome.highest)},
                                   {"sensitivity", sensitivity}});
    }
    json["findings"] = result.findings;
    json["way"] = Json::array();
    for (const WayPoint& point : result.way) {
        Json best = Json::object();
        for (std::size_t u = 0; u < point.best.size(); ++u) best[calibration.unknowns[u].name] = number(point.best[u]);
        json["way"].push_back({{"runs", point.runs},
                               {"elastic", point.elastic},
                               {"farthest", number(point.farthest)},
                               {"target", point.target},
                               {"doubt", number(point.doubt)},
                               {"doubtful", point.doubtful},
                               {"probability", number(point.probability)},
                               {"unlikely", point.unlikely},
                               {"best", best}});
    }
    json["seeds"] = calibration.seeds;
    json["confirm_seeds"] = calibration.confirm_seeds;
    json["provenance"] = provenance_json(provenance);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string calibrated_job(const Calibration& calibration, const CalibrationResult& result) {
    std::string head = fmt::format("# Calibrated by {} from {}; {} runs.\n", calibration.name,
                                   calibration.file.filename().string(), result.runs);
    for (const TargetOutcome& t : result.targets)
        head += fmt::format("#   {}: wanted {}, confirmed {} on {} fresh packings\n", t.target.label(),
                            target_text(t.target, t.target.value), target_text(t.target, t.confirmed.mean), t.confirmed.count);
    return head + "\n" + resolved_toml(result.job);
}

}  // namespace feldspar
