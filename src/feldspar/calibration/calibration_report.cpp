#include "feldspar/calibration/calibration_report.hpp"

#include <nlohmann/json.hpp>

#include "feldspar/calibration/calibration_files.hpp"
#include "feldspar/output/html_page.hpp"
#include "feldspar/output/provenance_json.hpp"
#include "feldspar/output/report_assets.hpp"
#include "feldspar/output/report_data.hpp"

namespace feldspar {
namespace {

using Json = nlohmann::ordered_json;

Json target_json(const TargetOutcome& outcome) {
    const UserQuantity quantity = user_quantity(outcome.target);
    const auto shown = [&](double value) { return rounded(value * quantity.factor); };
    return {{"name", outcome.target.label()},
            {"label", quantity.label},
            {"unit", quantity.unit},
            {"wanted", shown(outcome.target.value)},
            {"tolerance", shown(outcome.target.tolerance)},
            {"predicted", shown(outcome.predicted)},
            {"deviation", shown(outcome.deviation)},
            {"foreseen", {shown(outcome.foreseen.low), shown(outcome.foreseen.high)}},
            {"probability", rounded(outcome.foreseen.probability)},
            {"grades",
             {{"A", outcome.grades.A},
              {"B", outcome.grades.B},
              {"C", outcome.grades.C},
              {"unfinished", outcome.grades.unfinished},
              {"failed", outcome.grades.failed}}},
            {"missed", outcome.missed},
            {"confirmed",
             {{"n", outcome.confirmed.count},
              {"mean", shown(outcome.confirmed.mean)},
              {"low", shown(outcome.confirmed.low)},
              {"high", shown(outcome.confirmed.high)}}},
            {"met", outcome.met},
            {"lowest", shown(outcome.lowest)},
            {"highest", shown(outcome.highest)}};
}

Json unknown_json(const UnknownOutcome& outcome) {
    const Unknown& unknown = outcome.unknown;
    Json coupled = Json::array();
    for (const auto& [key, factor] : unknown.coupled) coupled.push_back({key, rounded(factor)});
    return {{"name", unknown.name},
            {"key", unknown.key},
            {"times", unknown.times},
            {"coupled", coupled},
            {"unit", unit_word(unknown)},
            {"logarithmic", unknown.logarithmic},
            {"elastic", unknown.elastic},
            {"best", rounded(outcome.best)},
            {"low", rounded(outcome.low)},
            {"high", rounded(outcome.high)},
            {"range", {rounded(unknown.low), rounded(unknown.high)}},
            {"at",
             {rounded(unknown.x_of(outcome.low)), rounded(unknown.x_of(outcome.best)),
              rounded(unknown.x_of(outcome.high))}},  // 0 ... 1 of the range
            {"determined", rounded(outcome.determined)},
            {"at_an_end", outcome.at_an_end}};
}

Json way_json(const WayPoint& point) {
    Json best = Json::array();
    for (const double value : point.best) best.push_back(rounded(value));
    return {{"runs", point.runs},
            {"elastic", point.elastic},
            {"farthest", rounded(point.farthest)},
            {"target", point.target},
            {"doubt", rounded(point.doubt)},
            {"doubtful", point.doubtful},
            {"probability", rounded(point.probability)},
            {"unlikely", point.unlikely},
            {"best", best}};
}

}  // namespace

void write_calibration_report(const Calibration& calibration, const CalibrationResult& result, const Provenance& provenance,
                              const std::filesystem::path& file) {
    Json json{{"name", calibration.name},
              {"runs", result.runs},
              {"budget", calibration.budget},
              {"failed", result.failed},
              {"grade_C", result.grade_C},
              {"seeds", calibration.seeds},
              {"confirm_seeds", calibration.confirm_seeds},
              {"job_file", calibration.base.job().file.string()},
              {"file", calibration.file.string()},
              {"text", calibration.text},
              {"targets", Json::array()},
              {"unknowns", Json::array()},
              {"sensitivity", Json::array()},
              {"findings", result.findings},
              {"way", Json::array()},
              {"provenance", provenance_json(provenance)}};
    for (const TargetOutcome& outcome : result.targets) json["targets"].push_back(target_json(outcome));
    for (const UnknownOutcome& outcome : result.unknowns) json["unknowns"].push_back(unknown_json(outcome));
    for (const std::vector<double>& of_target : result.sensitivity) {
        Json row = Json::array();
        for (const double value : of_target) row.push_back(rounded(value));
        json["sensitivity"].push_back(row);
    }
    for (const WayPoint& point : result.way) json["way"].push_back(way_json(point));
    const RunDirectory directory = RunDirectory::open(file.has_parent_path() ? file.parent_path() : ".");
    directory.write_text(file.filename().string(), html_page(calibration.name, json, asset_calibration_js));
}

}  // namespace feldspar
