#include "feldspar/study/study_report.hpp"

#include "feldspar/output/html_page.hpp"
#include "feldspar/output/report_assets.hpp"
#include "feldspar/study/report_json.hpp"
#include "feldspar/study/study_table.hpp"

namespace feldspar {

namespace {

/// One cell: the mean with its interval and the value of each packing; null where no packing has the property.
Json cell_json(const PointResults& point, const std::string& property) {
    const auto found = point.properties.values.find(property);
    if (found == point.properties.values.end()) return nullptr;
    const double factor = user_quantity(property).factor;
    Json cell = interval_json(mean_interval(found->second.values), factor);
    cell["seeds"] = found->second.seeds;
    cell["values"] = Json::array();
    for (const double value : found->second.values) cell["values"].push_back(json_number(value * factor));
    return cell;
}

Json point_json(const PointResults& point, const std::vector<std::string>& properties) {
    Json json = {{"labels", Json::array()},       {"numbers", Json::array()}, {"done", point.results.size()},
                 {"failed", point.failed.size()}, {"missing", point.missing}, {"grades", grades_json(point.results)},
                 {"cells", Json::array()}};
    double steps = 0.0, wall_s = 0.0;
    for (const TestResult& result : point.results) {
        steps += static_cast<double>(result.steps);
        wall_s += result.wall_s;
    }
    json["steps"] = json_number(steps);
    json["wall_s"] = json_number(wall_s);
    for (const AxisValue& value : point.values) {
        json["labels"].push_back(value.label);
        json["numbers"].push_back(json_number(value.number));
    }
    for (const std::string& property : properties) json["cells"].push_back(cell_json(point, property));
    return json;
}

// Of one point, by names.
Json named_json(const Study& study, const PointResults& point, const std::vector<std::string>& properties) {
    Json json = {{"labels", Json::object()},     {"numbers", Json::object()},
                 {"properties", Json::object()}, {"grades", grades_json(point.results)},
                 {"done", point.results.size()}, {"failed", point.failed.size()},
                 {"missing", point.missing}};
    for (std::size_t a = 0; a < point.values.size() && a < study.axes.size(); ++a) {
        json["labels"][study.axes[a]] = point.values[a].label;
        json["numbers"][study.axes[a]] = json_number(point.values[a].number);
    }
    for (const std::string& property : properties) json["properties"][user_quantity(property).name] = cell_json(point, property);
    return json;
}

}  // namespace

std::string study_json(const Study& study, std::span<const PointResults> points) {
    const std::vector<std::string> properties = properties_of(points);
    Json json = {{"name", study.name},
                 {"title", study.title.empty() ? study.name : study.title},
                 {"axes", study.axes},
                 {"points", Json::array()},
                 {"failures", failures_json(points)},
                 {"laboratory", study.points.empty() ? Json::object() : laboratory_json(study.points.front().job)}};
    for (const PointResults& point : points) json["points"].push_back(named_json(study, point, properties));
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_study_report(const Study& study, std::span<const PointResults> points, const std::filesystem::path& file) {
    const std::vector<std::string> properties = properties_of(points);
    const Provenance here = collect_provenance("", 1);
    Json json = {{"title", study.title.empty() ? study.name : study.title},
                 {"name", study.name},
                 {"axes", study.axes},
                 {"signs", "compression positive; strengths are positive magnitudes"},
                 {"properties", Json::array()},
                 {"points", Json::array()},
                 {"failures", failures_json(points)},
                 {"laboratory", study.points.empty() ? Json::object() : laboratory_json(study.points.front().job)},
                 {"written", {{"version", here.version}, {"commit", here.commit}, {"at", here.started}}},
                 {"file", study.file.string()},
                 {"text", study.text}};
    for (const std::string& property : properties) json["properties"].push_back(quantity_json(user_quantity(property)));
    for (const PointResults& point : points) json["points"].push_back(point_json(point, properties));
    write_beside(file, html_page(json["title"].get<std::string>(), json, asset_study_js));
}

}  // namespace feldspar
