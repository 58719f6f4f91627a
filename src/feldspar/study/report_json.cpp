#include "feldspar/study/report_json.hpp"

#include <fmt/format.h>

#include <cmath>

#include "feldspar/output/report_data.hpp"

namespace feldspar {

Json json_number(double value) { return rounded(value); }

Json interval_json(const MeanInterval& interval, double factor) {
    return {{"n", interval.count},
            {"mean", rounded(interval.mean * factor)},
            {"low", rounded(interval.low * factor)},
            {"high", rounded(interval.high * factor)},
            {"deviation", rounded(interval.standard_deviation * factor)}};
}

Json quantity_json(const UserQuantity& quantity) {
    return {{"name", quantity.name}, {"label", quantity.label}, {"symbol", quantity.symbol}, {"unit", quantity.unit}};
}

Json grades_json(std::span<const TestResult> results) {
    Json grades = {{"A", 0}, {"B", 0}, {"C", 0}};
    for (const TestResult& result : results) {
        const std::string grade(1, result.evidence.grade);
        grades[grades.contains(grade) ? grade : "C"] = grades[grades.contains(grade) ? grade : "C"].get<int>() + 1;
    }
    return grades;
}

Json failures_json(std::span<const PointResults> points) {
    Json list = Json::array();
    for (const PointResults& point : points)
        for (const RunRecord& run : point.failed)
            list.push_back({{"point", point_label(point)},
                            {"test", run.test},
                            {"sigma3_MPa", rounded(run.sigma3_Pa * MPa)},
                            {"seed", run.seed},
                            {"reason", run.reason}});
    return list;
}

Json laboratory_json(const Job& job) {
    Json json = Json::object();
    for (const auto& [key, value] : job.laboratory)
        json[user_quantity(property_of_laboratory(key)).name] = json_number(laboratory_in_user_units(key, value));
    return json;
}

std::string point_label(const PointResults& point) {
    std::string label;
    for (const AxisValue& value : point.values) label += (label.empty() ? "" : ", ") + value.label;
    return label;
}

int missing_runs(std::span<const PointResults> points) {
    int missing = 0;
    for (const PointResults& point : points) missing += point.missing;
    return missing;
}

std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string(); }

void write_beside(const std::filesystem::path& file, const std::string& text) {
    RunDirectory::open(file.has_parent_path() ? file.parent_path() : ".").write_text(file.filename().string(), text);
}

}  // namespace feldspar
