#include "feldspar/verify/write_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "feldspar/base/counted.hpp"
#include "feldspar/base/text_table.hpp"
#include "feldspar/fast/kernels.hpp"
#include "feldspar/output/html_page.hpp"
#include "feldspar/output/provenance_json.hpp"
#include "feldspar/output/report_assets.hpp"

namespace feldspar {
namespace {

using Json = nlohmann::ordered_json;

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value + 0.0) : "-"; }  // no minus zero

std::string with_unit(const std::string& text, const std::string& unit) { return unit.empty() ? text : text + " " + unit; }

// "0.31 %", "2.1e-09 MPa"
std::string error_text(double error, const Check& check) {
    if (!std::isfinite(error)) return "-";
    if (!check.bound.relative) return with_unit(fmt::format("{:.2g}", error + 0.0), check.unit);
    const double percent = 100.0 * error;
    return fmt::format("{:.2g} %", percent);
}

std::string bound_text(const Check& check) {
    return check.bound.relative ? fmt::format("{:g} %", 100.0 * check.bound.size)
                                : with_unit(fmt::format("{:g}", check.bound.size), check.unit);
}

const char* verdict(bool within) { return within ? "within" : "OUTSIDE"; }

// What the numbers of a machine depend on, in one line.
std::string machine(const Provenance& p) {
    return fmt::format("Feldspar {}, commit {}, {}; instructions {}", p.version, p.commit, p.compiler, best_kernels().name);
}

// Calls visit(topic, its results) for each topic in turn.
template <class Visit>
void by_topic(std::span<const CheckResult> results, const Visit& visit) {
    for (std::size_t begin = 0; begin < results.size();) {
        std::size_t end = begin;
        while (end < results.size() && std::string_view(results[end].topic) == results[begin].topic) ++end;
        visit(results[begin].topic, results.subspan(begin, end - begin));
        begin = end;
    }
}

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json checks_json(std::span<const CheckResult> results, const Provenance& provenance) {
    Json json{
        {"title", "Closed forms"}, {"tally", tally(results)}, {"within_bounds", true}, {"instructions", best_kernels().name}};
    json["topics"] = Json::array();
    by_topic(results, [&](const char* topic, std::span<const CheckResult> of_topic) {
        Json checks = Json::array();
        for (const CheckResult& r : of_topic) {
            const Check& c = *r.check;
            json["within_bounds"] = json["within_bounds"].get<bool>() && r.within();
            Json values = Json::array();
            for (const Judged& j : r.judged)
                values.push_back({{"case", j.comparison.what},
                                  {"expected", finite(j.comparison.expected)},
                                  {"found", finite(j.comparison.found)},
                                  {"error", finite(j.error)},
                                  {"within", j.within}});
            checks.push_back({{"name", c.name},
                              {"sentence", c.sentence},
                              {"formula", c.formula},
                              {"source", c.source},
                              {"unit", c.unit},
                              {"bound", c.bound.size},
                              {"bound_is_relative", c.bound.relative},
                              {"reason", c.reason},
                              {"within", r.within()},
                              {"failure", r.failure},
                              {"seconds", finite(std::round(1e3 * r.seconds) / 1e3)},
                              {"values", values}});
        }
        json["topics"].push_back({{"title", topic}, {"checks", checks}});
    });
    json["provenance"] = provenance_json(provenance);
    return json;
}

// As a cell of a Markdown table.
std::string cell(const std::string& text) {
    std::string safe;
    for (const char letter : text) {
        if (letter == '|' || letter == '<' || letter == '*' || letter == '_') safe += '\\';
        safe += letter;
    }
    return safe;
}

std::string code(const std::string& text) {
    if (text.empty()) return {};
    std::string safe = "`";
    for (const char letter : text) safe += letter == '|' ? std::string("\\|") : std::string(1, letter);
    return safe + "`";
}

std::string checks_markdown(std::span<const CheckResult> results, const Provenance& provenance) {
    std::string text = fmt::format(
        "# Closed forms\n\n{}.\n\nThis page was written by the program itself (`verify.md` of its "
        "results):\n\n```\n{}\n```\n\n{}, "
        "{}.\nThe page `verify.html` and `verify.json` beside it have the same numbers.\n\n"
        "An error is relative to the expected value where its bound is given in per cent, else it is the difference.\nEquations "
        "such as (C9) are those of the [theory](../theory/README.md).\n",
        tally(results), provenance.command_line, machine(provenance), counted(provenance.threads, "thread"));
    by_topic(results, [&](const char* topic, std::span<const CheckResult> of_topic) {
        text += fmt::format(
            "\n## {}\n\n| what is checked | case | expected | found | error | bound | verdict |\n|---|---|---|---|---|---|---|\n",
            topic);
        for (const CheckResult& r : of_topic) {
            const Check& c = *r.check;
            std::string head = fmt::format("{} {}; {} (`{}`)", cell(c.sentence), code(c.formula), cell(c.source), c.name),
                        bound = fmt::format("{}: {}", bound_text(c), cell(c.reason));
            if (r.judged.empty())
                text += fmt::format("| {} | | | | | {} | {} |\n", head, bound,
                                    r.failure.empty() ? "OUTSIDE" : "failed: " + cell(r.failure));
            for (const Judged& j : r.judged) {
                text +=
                    fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", head, cell(j.comparison.what),
                                with_unit(number(j.comparison.expected), c.unit), with_unit(number(j.comparison.found), c.unit),
                                error_text(j.error, c), bound, verdict(j.within));
                head.clear();
                bound.clear();
            }
        }
    });
    return text;
}

}  // namespace

std::string tally(std::span<const CheckResult> results) {
    return fmt::format("{} of {} within their bounds",
                       std::ranges::count_if(results, [](const CheckResult& r) { return r.within(); }), results.size());
}

std::string checks_text(std::span<const CheckResult> results, const Provenance& provenance, std::size_t columns) {
    std::string text;
    by_topic(results, [&](const char* topic, std::span<const CheckResult> of_topic) {
        text += fmt::format("{}\n\n", topic);
        for (const CheckResult& r : of_topic) {
            const Check& c = *r.check;
            text += wrapped_text(fmt::format("{}: {}", c.name, c.sentence), {}, columns);
            text += wrapped_text(fmt::format("{}{}{}", c.formula, c.formula.empty() || c.source.empty() ? "" : "; ", c.source),
                                 "  ", columns);
            std::vector<Row> rows{{"case", "unit", "expected", "found", "error", "bound", "verdict"}};
            for (const Judged& j : r.judged)
                rows.push_back({j.comparison.what.empty() ? "-" : j.comparison.what, c.unit.empty() ? "-" : c.unit,
                                number(j.comparison.expected), number(j.comparison.found), error_text(j.error, c), bound_text(c),
                                verdict(j.within)});
            if (rows.size() > 1) text += aligned(rows, 2, columns);
            if (!r.failure.empty()) text += wrapped_text("FAILED: " + r.failure, "  ", columns);
            if (rows.size() == 1 && r.failure.empty()) text += "  OUTSIDE: it compares nothing\n";
            text += "\n";
        }
    });
    std::vector<Row> outside{{"Outside", "case", "expected", "found", "error", "bound"}};
    for (const CheckResult& r : results) {
        if (r.within()) continue;
        for (const Judged& j : r.judged)
            if (!j.within)
                outside.push_back({r.check->name, j.comparison.what.empty() ? "-" : j.comparison.what,
                                   number(j.comparison.expected), number(j.comparison.found), error_text(j.error, *r.check),
                                   bound_text(*r.check)});
        if (r.judged.empty()) outside.push_back({r.check->name, r.failure.empty() ? "-" : "failed", "-", "-", "-", "-"});
    }
    if (outside.size() > 1) text += aligned(outside, 2, columns) + "\n";
    text += wrapped_text(machine(provenance), {}, columns);
    return text + tally(results) + "\n";
}

std::string checks_list(const std::vector<Topic>& topics, const std::function<bool(const Check&)>& filter, std::size_t columns) {
    std::string text;
    for (const Topic& topic : topics) {
        bool first = true;
        for (const Check& check : topic.checks) {
            if (filter && !filter(check)) continue;
            if (first) text += fmt::format("{}{}\n", text.empty() ? "" : "\n", topic.title);
            first = false;
            text += wrapped_text(fmt::format("{}: {}", check.name, check.sentence), "  ", columns);
        }
    }
    return text;
}

void write_checks(const RunDirectory& directory, std::span<const CheckResult> results, const Provenance& provenance) {
    const Json json = checks_json(results, provenance);
    directory.write_text("verify.json", json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    directory.write_text("verify.md", checks_markdown(results, provenance));
    directory.write_text("verify.html", html_page("Closed forms", json, asset_verify_js));
}

}  // namespace feldspar
