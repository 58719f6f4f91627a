#include "tables.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "campaign.hpp"
#include "feldspar/output/user_units.hpp"
#include "progress.hpp"

namespace feldspar {
namespace {

using Row = std::vector<std::string>;

// Columns as wide as their widest cell; `left` columns from the first on are flush left, the others flush right.
std::string aligned(const std::vector<Row>& rows, std::size_t left) {
    std::vector<std::size_t> width(rows.front().size(), 0);
    for (const Row& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
    std::string text;
    const auto line = [&](const Row& row) {
        std::string one;
        for (std::size_t c = 0; c < row.size(); ++c) {
            if (c > 0) one += "  ";
            one += c < left ? fmt::format("{:<{}}", row[c], width[c]) : fmt::format("{:>{}}", row[c], width[c]);
        }
        while (!one.empty() && one.back() == ' ') one.pop_back();
        text += one + "\n";
    };
    line(rows.front());
    std::size_t total = 2 * (width.size() - 1);
    for (std::size_t w : width) total += w;
    text += std::string(total, '-') + "\n";
    for (std::size_t r = 1; r < rows.size(); ++r) line(rows[r]);
    return text;
}

std::string number(double value) {
    if (!std::isfinite(value)) return "-";
    const double size = std::abs(value);
    return size >= 99.95 ? fmt::format("{:.1f}", value) : size >= 9.995 ? fmt::format("{:.2f}", value) : fmt::format("{:.3f}", value);
}

std::string words_of(char grade) {
    switch (grade) {
        case 'A': return "A";
        case 'B': return "B";
        default: return "C!";
    }
}

std::string cracks_text(const TestResult& result) {
    const auto tensile = std::count_if(result.cracks.begin(), result.cracks.end(), [](const Crack& c) { return c.mode == CrackMode::tensile; });
    return fmt::format("{} + {}", tensile, static_cast<long long>(result.cracks.size()) - tensile);
}

// What stops a number from being the strength: nothing, or a word behind it.
std::string peak_text(const TestResult& result) {
    const std::string value = number(result.properties.peak_stress_Pa / 1e6);
    return result.properties.peak_reached ? value : "> " + value;
}

}  // namespace

std::string property_table(const Job& job, const PropertySummary& properties) {
    std::map<std::string, std::string> laboratory_name;  // of a property
    for (const auto& [key, value] : job.laboratory) laboratory_name[property_of_laboratory(key)] = key;

    std::vector<std::pair<UserQuantity, std::string>> order;
    for (const auto& [property, statistics] : properties.values) order.emplace_back(user_quantity(property), property);
    std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first.rank < b.first.rank; });
    if (order.empty()) return "No property could be read: no test reached its peak.\n";

    std::vector<Row> rows{{"Property", "unit", "median", "minimum", "maximum", "n", "laboratory", "deviation"}};
    for (const auto& [quantity, property] : order) {
        const PropertyStatistics& s = properties.values.at(property);
        Row row{quantity.label, quantity.unit, number(s.median * quantity.factor), number(s.minimum * quantity.factor),
                number(s.maximum * quantity.factor), std::to_string(s.seeds.size()), "", ""};
        if (const auto found = laboratory_name.find(property); found != laboratory_name.end()) {
            const double measured = laboratory_in_user_units(found->second, job.laboratory.at(found->second));
            row[6] = number(measured);
            if (measured != 0.0) row[7] = fmt::format("{:+.1f} %", 100.0 * (s.median * quantity.factor / measured - 1.0));
        }
        rows.push_back(std::move(row));
    }
    std::string text = aligned(rows, 2);
    text += fmt::format("median, minimum, maximum over n packings; plane {}; strengths are positive magnitudes\n", name(job.model.plane));
    if (!properties.envelope_method.empty()) text += properties.envelope_method + "\n";
    return text;
}

std::string test_table(std::span<const TestResult> results) {
    if (results.empty()) return "No test ran.\n";
    std::vector<Row> rows{{"Test", "seed", "peak MPa", "cracks t + s", "steps", "time", "energy residual", "quasi-static"}};
    for (const TestResult& r : results)
        rows.push_back({title(r.test), std::to_string(r.seed), peak_text(r), cracks_text(r), std::to_string(r.steps), duration_text(r.wall_s),
                        fmt::format("{:.3f} %", 100.0 * r.energy_residual), words_of(r.evidence.grade)});
    std::string text = aligned(rows, 1);
    text += "cracks t + s: tensile + shear; energy residual: largest, of the work supplied; '>': the peak was not reached\n\n";
    text += "Verdicts\n";
    for (const TestResult& r : results)
        text += fmt::format("  {}, seed {}: {}{}\n", title(r.test), r.seed, r.evidence.verdict, r.interrupted ? " (interrupted)" : "");
    return text;
}

std::string test_line(const TestResult& r) {
    return fmt::format("peak {} MPa, {} cracks, {} steps in {}, quasi-static {} ({})", peak_text(r), r.cracks.size(), r.steps,
                       duration_text(r.wall_s), words_of(r.evidence.grade), r.stop_reason.empty() ? "ended" : r.stop_reason);
}

}  // namespace feldspar
