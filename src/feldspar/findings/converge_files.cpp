// converge.csv, converge.json, converge.html and the table of a convergence study.
#include <fmt/format.h>

#include <cmath>

#include "feldspar/base/printable.hpp"
#include "feldspar/base/text_table.hpp"
#include "feldspar/findings/converge.hpp"
#include "feldspar/output/html_page.hpp"
#include "feldspar/output/report_assets.hpp"
#include "feldspar/study/report_json.hpp"
#include "feldspar/study/study_table.hpp"

namespace feldspar {

namespace {

Json verdict_json(const Finding& verdict) {
    return {{"dependence", name(verdict.dependence)},
            {"words", verdict.words},
            {"bound_percent", json_number(100.0 * verdict.bound)},
            {"packings_wanted", verdict.packings > 0 ? Json(verdict.packings) : Json(nullptr)}};
}

Json change_json(const Change& change) {
    return {{"by_packing", change.by_packing},
            {"n", change.count},
            {"mean_percent", json_number(100.0 * change.mean)},
            {"low_percent", json_number(100.0 * change.low)},
            {"high_percent", json_number(100.0 * change.high)},
            {"chance", json_number(change.chance)}};
}

Json along_json(const PropertyAlong& along) {
    const UserQuantity quantity = user_quantity(along.property);
    Json json = quantity_json(quantity);
    json["verdict"] = verdict_json(along.verdict);
    json["values"] = Json::array();
    for (std::size_t v = 0; v < along.values.size(); ++v) {
        const ValueAt& value = along.values[v];
        Json row = {{"label", value.label}, {"number", json_number(value.number)}, {"base", v == along.base}};
        row.update(interval_json(value.mean, quantity.factor));
        row["change"] = v == along.base ? Json(nullptr) : change_json(value.change);
        json["values"].push_back(row);
    }
    return json;
}

Json axis_json(const AxisResult& axis) {
    Json json = {{"name", axis.axis.name},
                 {"unit", axis.axis.unit},
                 {"same_packings", axis.axis.same_packings},
                 {"verdict", verdict_json(axis.verdict)}};
    json["properties"] = Json::array();
    for (const PropertyAlong& along : axis.properties) json["properties"].push_back(along_json(along));
    return json;
}

Json seed_json(const SeedResult& seed) {
    const UserQuantity quantity = user_quantity(seed.property);
    Json json = quantity_json(quantity);
    json.update(interval_json(seed.mean, quantity.factor));
    json["verdict"] = verdict_json(seed.verdict);
    json["subsamples"] = Json::array();
    for (const Subsample& s : seed.subsamples)
        json["subsamples"].push_back({{"n", s.count},
                                      {"half_width_percent", json_number(100.0 * s.half_width)},
                                      {"lowest_percent", json_number(100.0 * (s.lowest - 1.0))},
                                      {"highest_percent", json_number(100.0 * (s.highest - 1.0))}});
    return json;
}

std::vector<TestResult> all_results(std::span<const PointResults> points) {
    std::vector<TestResult> results;
    for (const PointResults& point : points) results.insert(results.end(), point.results.begin(), point.results.end());
    return results;
}

std::string method(double within) {
    return fmt::format(
        "One thing at a time is varied about the job. Means with 95 % intervals over packings by Student's distribution; changes "
        "against the job as it is, on each "
        "packing where the packings are the same, else between means by Welch's interval. Independent: the 95 % intervals of all "
        "changes lie within +- {:g} %. "
        "Depends: a change differs from zero at 5 % with all comparisons of the axis looked at together (Holm), and its interval "
        "leaves +- {:g} %. Else undecided.",
        100.0 * within, 100.0 * within);
}

Json whole_json(const ConvergePlan& plan, const Convergence& result, std::span<const PointResults> points,
                const Provenance& provenance) {
    const Job& job = plan.study.points.front().job;
    const std::vector<TestResult> results = all_results(points);
    Json json = {{"title", plan.study.title},
                 {"job", {{"name", job.name}, {"file", job.file.string()}, {"seeds", job.seeds}}},
                 {"signs", "compression positive; strengths are positive magnitudes"},
                 {"overall", result.overall},
                 {"method", method(plan.within)},
                 {"within_percent", 100.0 * plan.within},
                 {"missing", missing_runs(points)},
                 {"remarks", plan.remarks}};
    json["axes"] = Json::array();
    for (const AxisResult& axis : result.axes) json["axes"].push_back(axis_json(axis));
    Json seeds = {{"verdict", verdict_json(result.seed_verdict)}, {"properties", Json::array()}};
    for (const SeedResult& seed : result.seeds) seeds["properties"].push_back(seed_json(seed));
    json["packings"] = seeds;
    json["grades"] = grades_json(results);
    json["failures"] = failures_json(points);
    json["provenance"] = provenance_json(provenance);
    return json;
}

std::string csv(const ConvergePlan& plan, const Convergence& result, const Provenance& provenance) {
    std::string text = fmt::format(
        "# {}: means over packings with 95 % intervals, and changes against the job as it is\n# strengths are positive "
        "magnitudes\n# feldspar {}, commit {}\n# columns: "
        "axis; value; property with its unit; packings; mean, low, high in that unit; change, change_low, change_high [%]; "
        "by_packing 1: changes formed on each packing, "
        "0: between "
        "means\naxis,value,property,packings,mean,low,high,change_percent,change_low_percent,change_high_percent,by_packing\n",
        printable(plan.study.title, LineEnds::escaped), provenance.version, provenance.commit);
    for (const AxisResult& axis : result.axes)
        for (const PropertyAlong& along : axis.properties)
            for (std::size_t v = 0; v < along.values.size(); ++v) {
                const ValueAt& value = along.values[v];
                const UserQuantity quantity = user_quantity(along.property);
                text += fmt::format("{},{},{},{},{},{},{}", csv_cell(axis.axis.name), csv_cell(value.label), quantity.name,
                                    value.mean.count, csv_number(value.mean.mean * quantity.factor),
                                    csv_number(value.mean.low * quantity.factor), csv_number(value.mean.high * quantity.factor));
                if (v == along.base)
                    text += ",0,,,\n";
                else
                    text +=
                        fmt::format(",{},{},{},{}\n", csv_number(100.0 * value.change.mean), csv_number(100.0 * value.change.low),
                                    csv_number(100.0 * value.change.high), value.change.by_packing ? 1 : 0);
            }
    for (const SeedResult& seed : result.seeds) {
        const UserQuantity quantity = user_quantity(seed.property);
        for (const Subsample& s : seed.subsamples) {
            const double mean = seed.mean.mean * quantity.factor;
            text += fmt::format("packings,{},{},{},{},{},{},,,,\n", s.count, quantity.name, s.count, csv_number(mean),
                                csv_number(mean * (1.0 - s.half_width)), csv_number(mean * (1.0 + s.half_width)));
        }
    }
    return text;
}

/// "+1.3", "-0.2", "0.0".
std::string signed_percent(double share) {
    const double tenths = std::round(1000.0 * share);
    return tenths == 0.0 ? "0.0" : fmt::format("{:+.1f}", 0.1 * tenths);
}

std::string axis_table(const AxisResult& axis, std::size_t columns) {
    std::vector<Row> rows{{axis.axis.name, "property", "unit", "mean", "95 % interval", "n", "change", "95 % interval"}};
    for (const PropertyAlong& along : axis.properties)
        for (std::size_t v = 0; v < along.values.size(); ++v) {
            const ValueAt& value = along.values[v];
            const UserQuantity quantity = user_quantity(along.property);
            Row row{value.label,
                    quantity.name.substr(0, quantity.name.rfind('_')),
                    quantity.unit,
                    table_number(value.mean.mean * quantity.factor),
                    value.mean.count < 2 ? "-"
                                         : table_number(value.mean.low * quantity.factor) + " .. " +
                                               table_number(value.mean.high * quantity.factor),
                    std::to_string(value.mean.count)};
            if (v == along.base) {
                row.insert(row.end(), {"base", ""});
            } else {
                row.push_back(std::isfinite(value.change.mean) ? signed_percent(value.change.mean) + " %" : "-");
                row.push_back(std::isfinite(value.change.low)
                                  ? fmt::format("{} .. {} %", signed_percent(value.change.low), signed_percent(value.change.high))
                                  : "-");
            }
            rows.push_back(std::move(row));
        }
    return aligned(rows, 3, columns, 3);
}

}  // namespace

void write_convergence(const std::filesystem::path& directory, const ConvergePlan& plan, std::span<const PointResults> points,
                       const Provenance& provenance) {
    const Convergence result = judge_convergence(plan, points);
    const Json json = whole_json(plan, result, points, provenance);
    write_beside(directory / "converge.csv", csv(plan, result, provenance));
    write_beside(directory / "converge.json", json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    write_beside(directory / "converge.html", html_page(plan.study.title, json, asset_converge_js));
}

std::string convergence_text(const ConvergePlan& plan, std::span<const PointResults> points, std::size_t columns) {
    const Convergence result = judge_convergence(plan, points);
    std::string text;
    for (const AxisResult& axis : result.axes)
        text += axis_table(axis, columns) + wrapped_text(axis.axis.name + ": " + axis.verdict.words, {}, columns) + "\n";
    for (const std::string& remark : plan.remarks) text += wrapped_text(remark, {}, columns);
    text += wrapped_text("packings: " + result.seed_verdict.words, {}, columns) + "\n";
    return text + wrapped_text(result.overall, {}, columns);
}

}  // namespace feldspar
