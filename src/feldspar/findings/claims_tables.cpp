// Verdicts on claims, written out for a reader and for other programs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "feldspar/base/counted.hpp"
#include "feldspar/findings/claims.hpp"
#include "feldspar/findings/decide.hpp"
#include "feldspar/study/study_table.hpp"

namespace feldspar {
namespace {

constexpr Verdict all_verdicts[] = {Verdict::reproduced, Verdict::contradicted, Verdict::no_difference, Verdict::in_part,
                                    Verdict::undecided,  Verdict::not_run,      Verdict::not_evaluated};

/// "11 of 12 reproduced, 1 undecided"
std::string tally(std::size_t total, const std::function<int(Verdict)>& count) {
    std::vector<std::string> parts;
    for (const Verdict verdict : all_verdicts)
        if (const int n = count(verdict); n > 0)
            parts.push_back(fmt::format("{}{} {}", n, parts.empty() ? fmt::format(" of {}", total) : "", name(verdict)));
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::string tally(const StatementResult& statement) {
    return tally(statement.comparisons.size(), [&](Verdict verdict) { return statement.count(verdict); });
}

std::string tally(const ClaimResult& claim) {
    std::size_t votes = 0;
    for (const StatementResult& statement : claim.statements) votes += statement.votes ? 1 : 0;
    return tally(votes, [&](Verdict verdict) {
        return static_cast<int>(std::count_if(claim.statements.begin(), claim.statements.end(),
                                              [&](const StatementResult& s) { return s.votes && s.verdict == verdict; }));
    });
}

/// "figure 12a", "table 4"
std::string place(const Claim& claim) {
    const bool number = !claim.figure.empty() && claim.figure.front() >= '0' && claim.figure.front() <= '9';
    return number ? "figure " + claim.figure : claim.figure;
}

/// "35 of 120 runs missing, 2 failed", or nothing.
std::string lacking(const StatementResult& statement) {
    std::string text;
    if (statement.missing > 0) text = fmt::format("{} of {} runs missing", statement.missing, statement.runs);
    if (statement.failed > 0)
        text += fmt::format("{}{} of {} runs failed", text.empty() ? "" : ", ", statement.failed, statement.runs);
    return text;
}

std::string rule_text(const Statement& statement) {
    std::string text = fmt::format("{}: {}", name(statement.rule), statement.first.quantity.text);
    if (statement.second.quantity.text != statement.first.quantity.text) text += " against " + statement.second.quantity.text;
    if (std::isfinite(statement.bound.size))
        text += statement.bound.relative ? fmt::format(", bound {:g} %", 100.0 * statement.bound.size)
                                         : fmt::format(", bound {:g}", statement.bound.size);
    const Bound& none = statement.no_difference;
    if (std::isfinite(none.size))
        text +=
            none.relative ? fmt::format(", none below {:g} %", 100.0 * none.size) : fmt::format(", none below {:g}", none.size);
    return text;
}

/// "about 34 packings would decide it", of what is undecided; else nothing.
std::string still_needed(const Comparison& c) {
    if (c.verdict != Verdict::undecided || c.interval.count < 2) return "";
    if (c.packings_to_decide) return fmt::format("about {} packings would decide it", *c.packings_to_decide);
    return fmt::format("more than {} packings would be needed", most_packings);
}

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-"; }

/// "34.2 MPa (30.1 to 38.2), 5 packings"
std::string interval_text(const Comparison& comparison) {
    const MeanInterval& i = comparison.interval;
    const std::string unit = comparison.unit.empty() ? "" : " " + comparison.unit;
    return fmt::format("{}{} ({} to {}), {}", number(i.mean), unit, number(i.low), number(i.high), counted(i.count, "packing"));
}

/// Empty where there is no number, as spreadsheets and pandas expect.
std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : std::string(); }

}  // namespace

std::string claims_csv(std::span<const ClaimResult> results) {
    std::string text =
        "claim,figure,claim_verdict,statement,study,votes,statement_verdict,runs,missing,failed,rule,compared,mean,low,high,unit,"
        "packings,verdict,packings_to_decide\n";
    for (const ClaimResult& claim : results)
        for (const StatementResult& s : claim.statements) {
            const std::string head =
                fmt::format("{},{},{},{},{},{},{},{},{},{}", csv_cell(claim.claim.id), csv_cell(claim.claim.figure),
                            name(claim.verdict), csv_cell(s.statement.says), csv_cell(s.study), s.votes ? "yes" : "no",
                            name(s.verdict), s.runs, s.missing, s.failed);
            if (!s.statement.not_evaluated.empty())
                text += fmt::format("{},,{},,,,,,{},\n", head, csv_cell(s.statement.not_evaluated), name(s.verdict));
            for (const Comparison& c : s.comparisons)
                text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", head, csv_cell(rule_text(s.statement)), csv_cell(c.what),
                                    csv_number(c.interval.mean), csv_number(c.interval.low), csv_number(c.interval.high), c.unit,
                                    c.interval.count, name(c.verdict),
                                    c.packings_to_decide ? fmt::format("{}", *c.packings_to_decide) : "");
        }
    return text;
}

std::string claims_text(std::span<const ClaimResult> results) {
    std::string text;
    for (const ClaimResult& claim : results) {
        text += fmt::format("{}  {}: {}\n  {}: {}\n", claim.claim.id, place(claim.claim), claim.claim.says, name(claim.verdict),
                            tally(claim));
        for (const StatementResult& s : claim.statements) {
            text += fmt::format("  - {}\n", s.statement.says);
            if (!s.statement.not_evaluated.empty()) {
                text += fmt::format("    not evaluated: {}\n", s.statement.not_evaluated);
                continue;
            }
            const std::string lack = lacking(s);
            text += fmt::format("    {}{}: {} ({}){}; {}\n", s.study, s.votes ? "" : " (no vote)", name(s.verdict), tally(s),
                                lack.empty() ? "" : ", " + lack, rule_text(s.statement));
            for (const Comparison& c : s.comparisons) {
                if (c.interval.count == 0) continue;
                const std::string more = still_needed(c);
                text += fmt::format("      {:14} {}: {}{}\n", name(c.verdict), c.what, interval_text(c),
                                    more.empty() ? "" : "; " + more);
            }
        }
        text += "\n";
    }
    text += fmt::format("Claims: {}\n", tally(results.size(), [&](Verdict verdict) {
                            return static_cast<int>(std::count_if(results.begin(), results.end(), [&](const ClaimResult& claim) {
                                return claim.verdict == verdict;
                            }));
                        }));
    return text;
}

std::string claims_markdown(const ClaimList& list, std::span<const ClaimResult> results) {
    std::string text =
        fmt::format("# {}\n\n{}\n\n| claim | figure | what it says | verdict | statements |\n|---|---|---|---|---|\n", list.title,
                    list.source);
    for (const ClaimResult& claim : results)
        text += fmt::format("| {} | {} | {} | {} | {} |\n", claim.claim.id, claim.claim.figure, claim.claim.says,
                            name(claim.verdict), tally(claim));
    for (const ClaimResult& claim : results) {
        text +=
            fmt::format("\n## {}: {}\n\n{}: {}.\n", claim.claim.id, name(claim.verdict), place(claim.claim), claim.claim.says);
        for (const StatementResult& s : claim.statements) {
            if (!s.statement.not_evaluated.empty()) {
                text += fmt::format("\n**{}**: not evaluated, because {}.\n", s.statement.says, s.statement.not_evaluated);
                continue;
            }
            const std::string lack = lacking(s);
            text += fmt::format(
                "\n**{}**: {} ({}){}. Study `{}`{}, `{}`.\n\n| compared | mean | 95 % interval | packings | "
                "|\n|---|---|---|---|---|\n",
                s.statement.says, name(s.verdict), tally(s), lack.empty() ? "" : ", " + lack, s.study,
                s.votes ? "" : " (shown beside, without a vote)", rule_text(s.statement));
            for (const Comparison& c : s.comparisons)
                text += fmt::format(
                    "| {} | {}{} | {} to {} | {} | {} |\n", c.what, number(c.interval.mean), c.unit.empty() ? "" : " " + c.unit,
                    number(c.interval.low), number(c.interval.high), c.interval.count,
                    still_needed(c).empty() ? name(c.verdict) : fmt::format("{}; {}", name(c.verdict), still_needed(c)));
        }
    }
    return text;
}

}  // namespace feldspar
