#include "tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <vector>

#include "feldspar/base/text_table.hpp"
#include "feldspar/lab/brazilian_failure.hpp"
#include "feldspar/lab/rock_properties.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/user_units.hpp"
#include "feldspar/output/variant_summary.hpp"
#include "feldspar/study/planned_runs.hpp"
#include "progress.hpp"

namespace feldspar {
namespace {

// A property as a row: strengths under confinement carry their sigma_3 in their name and come last, by sigma_3.
struct Entry {
    UserQuantity quantity;
    std::string property;
    double sigma3_MPa = 0.0;
};

Entry entry_of(const std::string& property) {
    Entry entry{user_quantity(property), property};
    if (const auto pressure_MPa = pressure_of_confined_strength_MPa(property)) {
        entry.sigma3_MPa = *pressure_MPa;
        entry.quantity.label = fmt::format("Strength at sigma_3 = {:g} MPa", entry.sigma3_MPa);
    }
    return entry;
}

std::string cracks_text(const TestResult& result) {
    const auto tensile =
        std::count_if(result.cracks.begin(), result.cracks.end(), [](const Crack& c) { return c.mode == CrackMode::tensile; });
    return fmt::format("{} + {}", tensile, static_cast<long long>(result.cracks.size()) - tensile);
}

// What an error says in several lines, as a sentence of a paragraph.
std::string in_one_line(const std::string& text) { return std::regex_replace(text, std::regex("\\s*\n\\s*"), "; "); }

// What stops a number from being the strength: nothing, or a word behind it.
std::string peak_text(const TestResult& result) {
    const std::string value = table_number(result.properties.peak_stress_Pa / 1e6);
    return result.properties.peak_reached ? value : "> " + value;
}

std::string symbol_with_unit(const UserQuantity& quantity) {
    const std::string symbol = quantity.name.substr(0, quantity.name.find('_'));
    const std::string plain = quantity.name == "hoek_brown_mi" ? "mi" : quantity.name == "friction_angle_deg" ? "phi" : symbol;
    return quantity.unit.empty() ? plain : plain + " " + quantity.unit;
}

std::string median_and_range(const PropertySummary& properties, const std::string& property) {
    const auto found = properties.values.find(property);
    if (found == properties.values.end()) return "-";
    const PropertyStatistics& s = found->second;
    const double factor = user_quantity(property).factor;
    if (s.seeds.size() < 2) return table_number(s.median * factor);
    return fmt::format("{} ({}..{})", table_number(s.median * factor), table_number(s.minimum * factor),
                       table_number(s.maximum * factor));
}

std::string compared_table(const Job& job, const std::vector<VariantSummary>& summaries, std::size_t columns) {
    std::vector<std::string> present;
    for (const RockProperty& property : rock_properties()) {
        const std::string name = property.kept_name();
        const auto has = [&](const VariantSummary& summary) { return summary.properties.values.contains(name); };
        if (property.reported() && std::any_of(summaries.begin(), summaries.end(), has)) present.push_back(name);
    }
    if (present.empty()) return "No property of the rock: no test that defines one has reached its peak.\n";
    std::vector<Row> rows{{"Variant"}};
    for (const std::string& property : present) rows.front().push_back(symbol_with_unit(user_quantity(property)));
    for (const VariantSummary& summary : summaries) {
        rows.push_back({summary.variant->name});
        for (const std::string& property : present) rows.back().push_back(median_and_range(summary.properties, property));
    }
    Row laboratory{"laboratory"};
    for (const std::string& property : present) {
        const auto known = std::find_if(job.laboratory.begin(), job.laboratory.end(),
                                        [&](const auto& entry) { return property_of_laboratory(entry.first) == property; });
        laboratory.push_back(known == job.laboratory.end() ? ""
                                                           : table_number(laboratory_in_user_units(known->first, known->second)));
    }
    if (!job.laboratory.empty()) rows.push_back(laboratory);
    return aligned(rows, 1, columns) + "median (minimum..maximum) over the packings; strengths are positive magnitudes\n";
}

std::string cost_table(const std::vector<VariantSummary>& summaries, std::size_t columns) {
    std::vector<MethodId> kinds;
    for (const VariantSummary& summary : summaries)
        for (const auto& [kind, cost] : summary.ms_per_step)
            if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) kinds.push_back(kind);
    if (kinds.empty()) return {};
    std::sort(kinds.begin(), kinds.end());
    std::vector<Row> rows{{"ms a step"}};
    for (MethodId kind : kinds) rows.front().emplace_back(name(kind));
    for (const VariantSummary& summary : summaries) {
        rows.push_back({summary.variant->name});
        for (MethodId kind : kinds) {
            const auto own = summary.ms_per_step.find(kind), first = summaries.front().ms_per_step.find(kind);
            std::string cell = own == summary.ms_per_step.end() ? "-" : table_number(own->second);
            if (own != summary.ms_per_step.end() && first != summaries.front().ms_per_step.end())
                cell += fmt::format(" ({:.2f} x)", own->second / first->second);
            rows.back().push_back(cell);
        }
    }
    return "\n" + aligned(rows, 1, columns) + fmt::format("in brackets: as a multiple of {}\n", summaries.front().variant->name);
}

// How each disc of a Brazilian test failed: its strength is worth as much as that.
std::string disc_table(std::span<const TestResult> results, std::size_t columns) {
    std::vector<Row> rows{{"Brazilian test", "seed", "BTS MPa", "first dip", "largest", "valid (ISRM)", "arc top", "bottom",
                           "first crack r/R", "at share"}};
    bool flattened = false;
    for (const TestResult& r : results)
        flattened = flattened || (r.specimen && r.specimen->outline.flattened() && method_of(r.test).specimen.own_disc);
    if (flattened) rows.front().emplace_back("k");
    const auto degrees = [](double value) { return std::isfinite(value) ? fmt::format("{:.1f} deg", value) : "-"; };
    for (const TestResult& r : results) {
        if (!method_of(r.test).specimen.own_disc) continue;
        const BrazilianFailure& b = r.properties.brazilian;
        rows.push_back({title(r.variant, r.test), std::to_string(r.seed), peak_text(r), table_number(b.first_dip_Pa / 1e6),
                        table_number(b.largest_Pa / 1e6), validity_in_words(b), degrees(b.contact_arc_top_deg),
                        degrees(b.contact_arc_bottom_deg), table_number(b.first_crack_radius),
                        table_number(b.first_crack_share)});
        if (flattened) rows.back().push_back(table_number(b.flat_coefficient));
    }
    if (rows.size() == 1) return {};
    return "\n" + aligned(rows, 1, columns, 2) +
           wrapped_text(
               "BTS: largest stress until the disc is split ('>': it was not); first dip: before the first fall of 5 %; largest: "
               "of the whole record",
               {}, columns) +
           wrapped_text(
               "valid (ISRM): split by a crack from the central part, r/R up to 0.6; arcs: of contact at the BTS; share: of the "
               "BTS, at the first crack" +
                   std::string(flattened ? "; k: stresses are k 2P / (pi D t)" : ""),
               {}, columns);
}

}  // namespace

std::string variant_table(const Job& job, std::span<const TestResult> results, std::size_t columns) {
    const std::vector<VariantSummary> summaries = summarise_variants(job, results);
    return compared_table(job, summaries, columns) + cost_table(summaries, columns);
}

std::string property_table(const Job& job, const PropertySummary& properties, std::size_t columns) {
    std::map<std::string, std::string> laboratory_name;  // of a property
    for (const auto& [key, value] : job.laboratory) laboratory_name[property_of_laboratory(key)] = key;

    std::vector<Entry> order;
    for (const auto& [property, statistics] : properties.values) order.push_back(entry_of(property));
    std::stable_sort(order.begin(), order.end(), [](const Entry& a, const Entry& b) {
        return std::pair(a.quantity.rank, a.sigma3_MPa) < std::pair(b.quantity.rank, b.sigma3_MPa);
    });
    if (order.empty()) return "No property of the rock: no test that defines one has reached its peak.\n";

    std::vector<Row> rows{{"Property", "unit", "median", "minimum", "maximum", "n", "laboratory", "deviation"}};
    for (const auto& [quantity, property, sigma3] : order) {
        const PropertyStatistics& s = properties.values.at(property);
        Row row{quantity.label,
                quantity.unit,
                table_number(s.median * quantity.factor),
                table_number(s.minimum * quantity.factor),
                table_number(s.maximum * quantity.factor),
                std::to_string(s.seeds.size()),
                "",
                ""};
        if (const auto found = laboratory_name.find(property); found != laboratory_name.end()) {
            const double measured = laboratory_in_user_units(found->second, job.laboratory.at(found->second));
            row[6] = table_number(measured);
            if (measured != 0.0) row[7] = fmt::format("{:+.1f} %", 100.0 * (s.median * quantity.factor / measured - 1.0));
        }
        rows.push_back(std::move(row));
    }
    std::string text = aligned(rows, 2, columns, 2);
    const ModelSpec& model = job.variants.front().model;
    text += wrapped_text(fmt::format("median, minimum, maximum over n packings; {}strengths are positive magnitudes",
                                     model.kind == GrainKind::flexible ? fmt::format("plane {}; ", name(model.plane)) : ""),
                         {}, columns);
    if (!properties.envelope_method.empty()) text += wrapped_text(properties.envelope_method, {}, columns);
    return text;
}

bool worse_than_asked(const TestResult& result) {
    const double asked = result.numerics.kind == NumericsKind::adaptive && !result.numerics.residual_target
                             ? result.numerics.accuracy
                             : NumericsSpec{}.accuracy;
    return result.evidence.grade == 'C' || !(result.evidence.error_estimate <= asked);
}

std::string test_table(std::span<const TestResult> results, std::span<const FailedTest> failed, std::size_t columns) {
    if (results.empty() && failed.empty()) return "No test ran.\n";
    std::vector<Row> rows{{"Test", "seed", "peak MPa", "cracks t + s", "steps", "time", "energy residual", "quasi-static"}};
    for (const TestResult& r : results)
        rows.push_back({title(r.variant, r.test), std::to_string(r.seed), peak_text(r), cracks_text(r), std::to_string(r.steps),
                        duration_text(r.wall_s), fmt::format("{:.3f} %", 100.0 * r.energy_residual),
                        std::string(1, r.evidence.grade)});
    for (const FailedTest& f : failed)
        rows.push_back({title(f.variant, f.test), std::to_string(f.seed), "failed", "-", "-", "-", "-", "-"});
    std::string text = aligned(rows, 1, columns, 2);
    text += wrapped_text(
        "cracks t + s: tensile + shear; energy residual: largest, of the work supplied; '>': the peak was not reached", {},
        columns);
    text += wrapped_text("quasi-static: A to about 0.5 %, B to about 2 %, C not shown", {}, columns);
    text += disc_table(results, columns);
    for (const FailedTest& f : failed)
        text += wrapped_text(fmt::format("{}, seed {}: failed: {}", title(f.variant, f.test), f.seed, in_one_line(f.reason)), {},
                             columns);
    for (const TestResult& r : results) {  // a section other than the whole width is said beside the number
        for (const std::string& remark : r.properties.remarks)
            text += wrapped_text(fmt::format("{}, seed {}: {}", title(r.variant, r.test), r.seed, remark), {}, columns);
    }
    for (const TestResult& r : results) {
        if (r.interrupted)
            text += wrapped_text(fmt::format("{}, seed {}: interrupted", title(r.variant, r.test), r.seed), {}, columns);
        if (!worse_than_asked(r)) continue;
        text += fmt::format("\n{}, seed {}: worse than asked\n", title(r.variant, r.test), r.seed);
        text += wrapped_text(r.evidence.verdict, "  ", columns);
    }
    return text;
}

std::string test_line(const TestResult& r) {
    return fmt::format("peak {} MPa, {} cracks, {} steps in {}, quasi-static {} ({})", peak_text(r), r.cracks.size(), r.steps,
                       duration_text(r.wall_s), r.evidence.grade, r.stop_reason.empty() ? "ended" : r.stop_reason);
}

}  // namespace feldspar
