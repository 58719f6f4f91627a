// A claims file (docs/claims.md): read, and checked as far as it can be without its studies.
#include <fmt/format.h>

#include <set>

#include "feldspar/findings/claims.hpp"
#include "feldspar/job/toml_reader.hpp"
#include "feldspar/study/base_job.hpp"

namespace feldspar {
namespace {

constexpr std::string_view statement_keys[] = {
    "says",    "study", "also",   "rule",          "property", "also_property", "first",     "second",
    "third",   "where", "axis",   "from",          "to",       "than_property", "than_axis", "than_from",
    "than_to", "bound", "number", "no_difference", "packings", "not_evaluated"};

/// Which keys a rule needs, beside study and property.
struct Needs {
    bool second = false, third = false, axis = false, bound = false, number = false;
    bool may_second = false, may_number = false, may_than = false;
    bool compares = false;  // which of two is larger; it may turn out that neither is
};

Needs needs_of(Rule rule) {
    switch (rule) {
        case Rule::greater:
            return {.second = true, .compares = true};
        case Rule::rises_with:
        case Rule::falls_with:
            return {.axis = true, .compares = true};
        case Rule::negligible:
        case Rule::matters:
        case Rule::linear_with:
            return {.axis = true, .bound = true};
        case Rule::influence_greater:
            return {.axis = true, .may_second = true, .may_than = true, .compares = true};
        case Rule::between:
        case Rule::closer:
            return {.second = true, .third = true, .compares = true};
        case Rule::above:
        case Rule::below:
            return {.number = true, .may_second = true};
        case Rule::within:
            return {.bound = true, .may_second = true, .may_number = true};
    }
    return {};
}

std::string trimmed(const std::string& text) {
    const auto begin = text.find_first_not_of(' ');
    return begin == std::string::npos ? std::string() : text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

Quantity quantity_of(const TableReader& table, std::string_view key, const std::string& text) {
    const auto slash = text.find(" / ");
    Quantity quantity{text, trimmed(text.substr(0, slash)), slash == std::string::npos ? "" : trimmed(text.substr(slash + 3))};
    if (quantity.property.empty() || (slash != std::string::npos && quantity.divisor.empty()))
        table.fail(key, "'" + text + "' is not a property", "a property, or two with ' / ' between them");
    return quantity;
}

std::string label_of(const TableReader& table, const toml::node& node, std::string_view key) {
    return node.is_number() ? axis_label(node) : table.text_of(node, key);
}

/// { grains = "rigid", "tau/sigma_nt" = [1, 2] }; lists only in `where`.
Selection read_selection(const TableReader& table, std::string_view key) {
    Selection selection;
    if (!table.has(key)) return selection;
    const toml::node& node = *table.find(key);
    const bool lists = key == "where";
    const std::string allowed = lists ? "axes with a label, or a list of labels, such as { grains = [\"rigid\", \"flexible\"] }"
                                      : "axes with a label, such as { grains = \"rigid\" }";
    if (!node.is_table() || node.as_table()->empty()) table.fail(key, shown(node) + " chooses no points", allowed);
    for (const auto& [axis, value] : *node.as_table()) {
        std::vector<std::string>& labels = selection[std::string(axis.str())];
        if (!value.is_array()) {
            labels.push_back(label_of(table, value, key));
            continue;
        }
        if (!lists || value.as_array()->empty())
            table.fail_at(value, key, "a list of labels is not allowed here, or it is empty", allowed);
        for (const toml::node& label : *value.as_array()) labels.push_back(label_of(table, label, key));
    }
    return selection;
}

std::string read_label(const TableReader& table, std::string_view key) {
    return table.has(key) ? label_of(table, *table.find(key), key) : std::string();
}

/// Text is a share, a number an amount.
Bound read_bound(const TableReader& table, std::string_view key) {
    return {.size = table.fraction(key, positive), .relative = table.find(key)->is_string()};
}

class StatementReader {
public:
    /// @param usual  what the file calls no difference, of statements that do not say it
    StatementReader(const TableReader& table, const Bound& usual) : table_(table), usual_(usual) {
        statement_.lines[""] = table.line();
        for (const std::string_view key : statement_keys)
            if (table.has(key)) statement_.lines[std::string(key)] = static_cast<int>(table.find(key)->source().begin.line);
    }

    Statement read() {
        statement_.says = table_.text("says");
        if (table_.has("not_evaluated")) {
            statement_.not_evaluated = table_.text("not_evaluated");
            table_.refuse({"study", "also", "rule", "property", "also_property", "first", "second", "third", "where", "axis",
                           "bound", "number", "no_difference"},
                          "not_evaluated");
            return statement_;
        }
        table_.require({"study", "rule", "property"});
        read_studies();
        read_rule();
        read_sides();
        read_numbers();
        return statement_;
    }

private:
    void read_studies() {
        statement_.study = table_.text("study");
        if (!table_.has("also")) return;
        for (const toml::node& node : table_.array("also")) statement_.also.push_back(table_.text_of(node, "also"));
    }

    void read_rule() {
        statement_.rule = table_.choice<Rule>("rule", {{"greater", Rule::greater},
                                                       {"rises_with", Rule::rises_with},
                                                       {"falls_with", Rule::falls_with},
                                                       {"negligible", Rule::negligible},
                                                       {"matters", Rule::matters},
                                                       {"influence_greater", Rule::influence_greater},
                                                       {"linear_with", Rule::linear_with},
                                                       {"between", Rule::between},
                                                       {"closer", Rule::closer},
                                                       {"above", Rule::above},
                                                       {"below", Rule::below},
                                                       {"within", Rule::within}});
        const Needs needs = needs_of(statement_.rule);
        const std::string rule = fmt::format("rule = \"{}\"", name(statement_.rule));
        const auto need = [&](bool needed, bool may, std::string_view key) {
            if (needed) table_.require({key});
            if (!needed && !may) table_.refuse({key}, rule);
        };
        need(needs.second, needs.may_second, "second");
        need(needs.second, true, "first");  // it may choose points for every rule
        need(needs.third, false, "third");
        need(needs.axis, false, "axis");
        need(needs.bound, false, "bound");
        need(needs.number, needs.may_number, "number");
        need(false, needs.compares, "no_difference");
        if (table_.has("second")) table_.require({"first"});
        for (const std::string_view key : {"from", "to"}) need(false, needs.may_than || statement_.rule == Rule::matters, key);
        for (const std::string_view key : {"than_property", "than_axis", "than_from", "than_to"})
            need(false, needs.may_than, key);
    }

    void read_sides() {
        statement_.first.quantity = quantity_of(table_, "property", table_.text("property"));
        if (table_.has("also_property"))
            for (const toml::node& node : table_.array("also_property"))
                statement_.also_property.push_back(quantity_of(table_, "also_property", table_.text_of(node, "also_property")));
        statement_.first.selection = read_selection(table_, "first");
        statement_.first.axis = table_.text("axis", "");
        statement_.first.from = read_label(table_, "from");
        statement_.first.to = read_label(table_, "to");
        statement_.second = statement_.first;
        statement_.has_second = table_.has("second");
        if (statement_.has_second) statement_.second.selection = read_selection(table_, "second");
        if (table_.has("than_property"))
            statement_.second.quantity = quantity_of(table_, "than_property", table_.text("than_property"));
        if (table_.has("than_axis")) {
            statement_.second.axis = table_.text("than_axis");
            statement_.second.from = statement_.second.to = {};
        }
        if (table_.has("than_from")) statement_.second.from = read_label(table_, "than_from");
        if (table_.has("than_to")) statement_.second.to = read_label(table_, "than_to");
        statement_.third = read_selection(table_, "third");
        statement_.where = read_selection(table_, "where");
        if (statement_.rule == Rule::influence_greater && !statement_.has_second && !table_.has("than_property") &&
            !table_.has("than_axis") && !table_.has("than_to"))
            table_.fail("rule", "says nothing that the influence is compared with",
                        "second, than_property, than_axis or than_to");
    }

    void read_numbers() {
        statement_.packings = static_cast<int>(table_.integer("packings", 2, 1000, 5));
        if (table_.has("bound")) {
            statement_.bound = read_bound(table_, "bound");
            const Rule rule = statement_.rule;
            if (!statement_.bound.relative && rule == Rule::linear_with)
                table_.fail("bound", "must be a share of the change over the axis", "text such as \"10 %\"");
        }
        if (needs_of(statement_.rule).compares)
            statement_.no_difference = table_.has("no_difference") ? read_bound(table_, "no_difference") : usual_;
        if (!table_.has("number")) return;
        const bool stress = statement_.first.quantity.property.ends_with("_Pa") && statement_.first.quantity.divisor.empty() &&
                            !statement_.has_second;
        statement_.number = stress ? table_.quantity("number", Dimension::stress, any_value) : table_.number("number", any_value);
        if (statement_.rule == Rule::within && statement_.bound.relative && !(statement_.number > 0.0))
            table_.fail("number", "a share of it cannot be the tolerance", "a number greater than zero");
    }

    TableReader table_;
    Bound usual_;
    Statement statement_;
};

Claim read_claim(const TableReader& table, const Bound& no_difference) {
    table.require({"id", "figure", "says", "statement"});
    Claim claim{table.text("id"), table.text("figure"), table.text("says"), {}};
    for (const TableReader& statement : table.tables("statement", "a statement", statement_keys))
        claim.statements.push_back(StatementReader(statement, no_difference).read());
    return claim;
}

}  // namespace

const char* name(Rule rule) {
    switch (rule) {
        case Rule::greater:
            return "greater";
        case Rule::rises_with:
            return "rises_with";
        case Rule::falls_with:
            return "falls_with";
        case Rule::negligible:
            return "negligible";
        case Rule::matters:
            return "matters";
        case Rule::influence_greater:
            return "influence_greater";
        case Rule::linear_with:
            return "linear_with";
        case Rule::between:
            return "between";
        case Rule::closer:
            return "closer";
        case Rule::above:
            return "above";
        case Rule::below:
            return "below";
        case Rule::within:
            return "within";
    }
    return "";
}

ClaimList parse_claims(const std::string& text, const std::filesystem::path& file) {
    const toml::table tree = parse_toml(text, file.string());
    const TableReader root(tree, "", file.string(), {"title", "source", "no_difference", "claim"});
    root.require({"title", "source", "claim"});
    ClaimList list{file, root.text("title"), root.text("source"), {}};
    Bound no_difference;
    if (root.has("no_difference")) {
        no_difference = read_bound(root, "no_difference");
        if (!no_difference.relative)
            root.fail("no_difference", "an amount cannot hold for all properties", "a share, such as \"2 %\"");
    }
    std::set<std::string> ids;
    for (const TableReader& table : root.tables("claim", "a claim", {"id", "figure", "says", "statement"})) {
        list.claims.push_back(read_claim(table, no_difference));
        if (!ids.insert(list.claims.back().id).second)
            table.fail("id", "'" + list.claims.back().id + "' is the id of another claim", "each claim its own");
    }
    return list;
}

ClaimList read_claims(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "claims.toml";
    return parse_claims(read_toml_file(file, "claims"), file);
}

}  // namespace feldspar
