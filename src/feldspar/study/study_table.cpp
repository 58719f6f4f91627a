#include "feldspar/study/study_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <system_error>

#include "feldspar/base/printable.hpp"
#include "feldspar/base/text_table.hpp"
#include "feldspar/base/units.hpp"
#include "feldspar/output/history_columns.hpp"
#include "feldspar/output/user_units.hpp"
#include "feldspar/study/statistics.hpp"

namespace feldspar {
namespace {

// Of the many, those that answer first what the rock is like.
const std::vector<std::string> main_properties{
    "E_Pa", "nu", "UCS_Pa", "DTS_Pa", "BTS_Pa", "BTS_first_dip_Pa", "cohesion_Pa", "friction_angle_deg", "hoek_brown_mi"};

MeanInterval interval_of(const PointResults& point, const std::string& property) {
    const auto found = point.properties.values.find(property);
    return found == point.properties.values.end() ? mean_interval({}) : mean_interval(found->second.values);
}

std::string mean_text(const MeanInterval& interval, double factor) {
    if (interval.count == 0) return "-";
    const double mean = factor * interval.mean, half = factor * interval.half_width();
    const int digits = std::abs(mean) >= 99.95 ? 1 : std::abs(mean) >= 9.995 ? 2 : 3;
    return std::isnan(half) ? fmt::format("{:.{}f}", mean, digits) : fmt::format("{:.{}f} ± {:.{}f}", mean, digits, half, digits);
}

// With its unit or without: "-5", "-5 MPa", "+10 %". Behind the number stand no signs that a spreadsheet would reckon with.
bool is_a_number(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double number = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (problem != std::errc{}) return false;
    if (end != text.data() + text.size() && (*end == '/' || *end == '.')) return false;
    return std::all_of(end, text.data() + text.size(), [](unsigned char c) {
        return c == ' ' || c == '%' || c == '/' || c == '.' || std::isalnum(c) != 0 || c >= 0x80;
    });
}

std::string number_cell(double value) { return std::isfinite(value) ? format_exact(value) : ""; }

}  // namespace

std::string csv_cell(const std::string& given) {
    std::string text = printable(given);
    if (!text.empty() && std::string_view("=+-@\t").find(text.front()) != std::string_view::npos && !is_a_number(text))
        text.insert(text.begin(), '\'');
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char letter : text) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
    return quoted + "\"";
}

std::vector<std::string> properties_of(std::span<const PointResults> points) {
    std::set<std::string> names;
    for (const PointResults& point : points)
        for (const auto& [name, statistics] : point.properties.values) names.insert(name);
    std::vector<std::string> ordered(names.begin(), names.end());
    std::ranges::stable_sort(ordered, {}, [](const std::string& name) { return user_quantity(name).rank; });
    return ordered;
}

std::string study_text(const Study& study, std::span<const PointResults> points, std::size_t columns) {
    std::vector<std::string> properties = properties_of(points);
    std::erase_if(properties, [](const std::string& name) {
        return std::find(main_properties.begin(), main_properties.end(), name) == main_properties.end();
    });
    std::vector<Row> rows(1, study.axes);
    for (const std::string& property : properties) {
        const UserQuantity quantity = user_quantity(property);
        rows[0].push_back(quantity.symbol + (quantity.unit.empty() ? "" : " " + quantity.unit));
    }
    rows[0].push_back("runs");
    for (const PointResults& point : points) {
        Row& row = rows.emplace_back();
        for (const AxisValue& value : point.values) row.push_back(value.label);
        for (const std::string& property : properties)
            row.push_back(mean_text(interval_of(point, property), user_quantity(property).factor));
        std::string runs = std::to_string(point.results.size());
        if (!point.failed.empty()) runs += fmt::format(", {} failed", point.failed.size());
        if (point.missing > 0) runs += fmt::format(", {} missing", point.missing);
        row.push_back(runs);
    }
    return aligned(rows, study.axes.size(), columns, std::max<std::size_t>(1, study.axes.size()));
}

std::string points_csv(const Study& study, std::span<const PointResults> points) {
    const std::vector<std::string> properties = properties_of(points);
    std::string text = fmt::format("# {}: means over packings with their 95 % intervals; {}\n",
                                   printable(study.title, LineEnds::escaped), sign_convention);
    for (const std::string& axis : study.axes) text += csv_cell(axis) + ",";
    for (const std::string& property : properties) {
        const std::string name = user_quantity(property).name;
        text += fmt::format("{0},{0}_low,{0}_high,{0}_packings,", name);
    }
    text += "runs,failed,missing\n";
    for (const PointResults& point : points) {
        for (const AxisValue& value : point.values) text += csv_cell(value.label) + ",";
        for (const std::string& property : properties) {
            const MeanInterval interval = interval_of(point, property);
            const double factor = user_quantity(property).factor;
            text += fmt::format("{},{},{},{},", number_cell(factor * interval.mean), number_cell(factor * interval.low),
                                number_cell(factor * interval.high), interval.count);
        }
        text += fmt::format("{},{},{}\n", point.results.size(), point.failed.size(), point.missing);
    }
    return text;
}

std::string runs_csv(const Study& study, const Ledger& ledger) {
    std::vector<std::string> ids;
    for (const Run& run : study.runs) ids.push_back(run.id);
    std::map<std::string, RunRecord> records;
    for (RunRecord& record : ledger.find(ids)) records[record.id] = std::move(record);

    std::string text = fmt::format("# {}: runs, in SI units; {}\n", printable(study.title, LineEnds::escaped), sign_convention);
    for (const std::string& axis : study.axes) text += csv_cell(axis) + ",";
    text += "seed,test,sigma3_Pa,state,grade";
    for (const std::string& column : number_columns()) text += "," + column;
    text += ",reason,run\n";
    for (const Run& run : study.runs) {
        for (const AxisValue& value : study.points[run.point].values) text += csv_cell(value.label) + ",";
        const auto found = records.find(run.id);
        const RunRecord* record = found == records.end() ? nullptr : &found->second;
        const auto grade = record == nullptr ? decltype(record->texts.end()){} : record->texts.find("grade");
        text += fmt::format("{},{},{},{},{}", run.seed(), name(run.test().kind), number_cell(run.test().sigma3_Pa),
                            record == nullptr ? "missing" : name(record->state),
                            record != nullptr && grade != record->texts.end() ? csv_cell(grade->second) : "");
        for (const std::string& column : number_columns()) {
            const auto number = record == nullptr ? decltype(record->numbers.end()){} : record->numbers.find(column);
            text += "," + (record != nullptr && number != record->numbers.end() ? number_cell(number->second) : std::string{});
        }
        text += "," + csv_cell(record == nullptr ? "" : record->reason) + "," + run.id + "\n";
    }
    return text;
}

}  // namespace feldspar
