// Claims held against the studies that they name, before anything is evaluated: no statement may speak of what a study does not
// have.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "feldspar/base/error.hpp"
#include "feldspar/findings/claims.hpp"
#include "feldspar/job/toml_reader.hpp"
#include "feldspar/lab/rock_properties.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/user_units.hpp"

namespace feldspar {
namespace {

/// Names of PropertySummary and the tests that they are read from.
const std::map<std::string, std::set<MethodId>, std::less<>>& summary_properties() {
    static const std::map<std::string, std::set<MethodId>, std::less<>> known = [] {
        std::map<std::string, std::set<MethodId>, std::less<>> map;
        for (const RockProperty& property : rock_properties()) {
            using enum RockProperty::Source;
            if (property.source == test || property.source == ratio || property.source == envelope ||
                property.source == shear_envelope)
                map[property.kept_name()] = property.tests;
        }
        return map;
    }();
    return known;
}

/// Stands at the key's line, or else at the head of the statement.
[[noreturn]] void fail(const ClaimList& list, const Statement& statement, const std::string& key, const std::string& problem,
                       const std::string& allowed, const std::string& suggestion = {}) {
    const auto line = statement.lines.find(key);
    throw InputError(
        {list.file.string(), line == statement.lines.end() ? statement.lines.at("") : line->second, 1, "claim.statement." + key},
        problem, allowed, suggestion);
}

class StatementCheck {
public:
    StatementCheck(const ClaimList& list, const Statement& statement, const Study& study)
        : list_(list), statement_(statement), study_(study) {}

    void run() const {
        check_quantity("property", statement_.first.quantity);
        for (const Quantity& quantity : statement_.also_property) check_quantity("also_property", quantity);
        check_quantity("than_property", statement_.second.quantity);
        check_selection("first", statement_.first.selection);
        if (statement_.has_second) check_selection("second", statement_.second.selection);
        check_selection("third", statement_.third);
        check_selection("where", statement_.where);
        check_moving("axis", "from", "to", statement_.first);
        check_moving("than_axis", "than_from", "than_to", statement_.second);
        check_sides();
        if (statement_.rule == Rule::linear_with) check_numbers();
        if (statement_.rule == Rule::within && std::isnan(statement_.number)) check_laboratory();
    }

private:
    void check_quantity(const std::string& key, const Quantity& quantity) const {
        for (const std::string& property : {quantity.property, quantity.divisor}) {
            if (property.empty()) continue;
            const std::set<MethodId> kinds = tests_behind(property);
            if (kinds.empty()) {
                std::vector<std::string_view> names;
                for (const auto& [known, tests] : summary_properties()) names.push_back(known);
                fail(list_, statement_, key, "'" + property + "' is not a property",
                     listed(names) + ", or a number of the ledger as 'ms_per_step of brazilian'", did_you_mean(property, names));
            }
            for (const MethodId kind : kinds)
                if (std::none_of(study_.runs.begin(), study_.runs.end(), [&](const Run& run) { return run.test().kind == kind; }))
                    fail(list_, statement_, key,
                         fmt::format("'{}' needs a test that the study '{}' does not run: {}", property, statement_.study,
                                     name(kind)),
                         "a property of the study's tests");
        }
    }

    std::size_t axis_number(const std::string& key, const std::string& axis) const {
        const auto found = std::find(study_.axes.begin(), study_.axes.end(), axis);
        if (found == study_.axes.end()) {
            const std::vector<std::string_view> names(study_.axes.begin(), study_.axes.end());
            fail(list_, statement_, key, fmt::format("'{}' is not an axis of the study '{}'", axis, statement_.study),
                 listed(names), did_you_mean(axis, names));
        }
        return static_cast<std::size_t>(found - study_.axes.begin());
    }

    void check_label(const std::string& key, const std::string& axis, const std::string& label) const {
        const std::size_t a = axis_number(key, axis);
        std::vector<std::string_view> labels;
        for (const Point& point : study_.points) {
            const std::string& there = point.values[a].label;
            if (there == label) return;
            if (std::find(labels.begin(), labels.end(), there) == labels.end()) labels.push_back(there);
        }
        fail(list_, statement_, key,
             fmt::format("'{}' is not a value of the axis '{}' of the study '{}'", label, axis, statement_.study), listed(labels),
             did_you_mean(label, labels));
    }

    void check_selection(const std::string& key, const Selection& selection) const {
        for (const auto& [axis, labels] : selection)
            for (const std::string& label : labels) check_label(key, axis, label);
    }

    void check_moving(const std::string& axis_key, const std::string& from_key, const std::string& to_key,
                      const Side& side) const {
        if (side.axis.empty()) return;
        (void)axis_number(axis_key, side.axis);
        if (!side.from.empty()) check_label(from_key, side.axis, side.from);
        if (!side.to.empty()) check_label(to_key, side.axis, side.to);
    }

    /// An axis that one side fixes or moves along must be fixed or moved along by the others too.
    void check_sides() const {
        std::map<std::string, const Selection*> sides{{"first", &statement_.first.selection}};
        const bool two = statement_.has_second || statement_.rule == Rule::influence_greater;
        if (two) sides["second"] = &statement_.second.selection;
        if (!statement_.third.empty()) sides["third"] = &statement_.third;
        const auto moves = [&](const std::string& side, const std::string& axis) {
            return axis == (side == "first" ? statement_.first.axis : side == "second" ? statement_.second.axis : std::string());
        };
        for (const std::string& axis : study_.axes) {
            const auto settled = [&](const auto& side) { return side.second->contains(axis) || moves(side.first, axis); };
            if (std::none_of(sides.begin(), sides.end(), settled)) continue;
            for (const auto& side : sides) {
                if (!settled(side))
                    fail(list_, statement_, side.first, "does not say which value of the axis '" + axis + "' is meant",
                         "a label of that axis");
                if (side.second->contains(axis) && moves(side.first, axis))
                    fail(list_, statement_, side.first, "fixes the axis '" + axis + "', along which it moves",
                         "labels of the other axes");
            }
        }
    }

    void check_numbers() const {
        const std::size_t a = axis_number("axis", statement_.first.axis);
        for (const Point& point : study_.points)
            if (!std::isfinite(point.values[a].number))
                fail(list_, statement_, "axis", "'" + point.values[a].label + "' is not a number, which linear_with needs",
                     "an axis of numbers");
    }

    void check_laboratory() const {
        for (const Point& point : study_.points)
            if (!std::isfinite(laboratory_value(point.job, statement_.first.quantity)) || statement_.has_second)
                fail(list_, statement_, "number", "the job has no laboratory value of '" + statement_.first.quantity.text + "'",
                     "a number, or a value in the job's [laboratory]");
    }

    const ClaimList& list_;
    const Statement& statement_;
    const Study& study_;
};

}  // namespace

std::set<MethodId> tests_behind(const std::string& property) {
    const auto& known = summary_properties();
    if (const auto found = known.find(property); found != known.end()) return found->second;
    if (pressure_of_confined_strength_MPa(property)) return {method_of_confined_strength()};
    const auto of = property.find(" of ");
    if (of == std::string::npos) return {};
    const std::vector<std::string>& columns = number_columns();
    if (std::find(columns.begin(), columns.end(), property.substr(0, of)) == columns.end()) return {};
    // a column of a test that is run once on a packing: under confinement there is one for each pressure
    if (const auto method = find_method(property.substr(of + 4)); method && !method_of(*method).specimen.confined)
        return {*method};
    return {};
}

double laboratory_value(const Job& job, const Quantity& quantity) {
    const RockProperty* property = kept_rock_property(quantity.property);
    if (property == nullptr || !quantity.divisor.empty()) return std::nan("");
    const auto found = job.laboratory.find(std::string(property->laboratory));
    return found == job.laboratory.end() ? std::nan("") : laboratory_as_kept(found->first, found->second);
}

void check_claims(const ClaimList& list, const StudiesByName& studies) {
    for (const Claim& claim : list.claims)
        for (const Statement& statement : claim.statements) {
            if (!statement.not_evaluated.empty()) continue;
            std::vector<std::string> names{statement.study};
            names.insert(names.end(), statement.also.begin(), statement.also.end());
            for (const std::string& study : names) StatementCheck(list, statement, studies.at(study).study).run();
        }
}

StudiesByName read_studies(const ClaimList& list) {
    StudiesByName studies;
    const auto read = [&](const Statement& statement, const std::string& key, const std::string& study) {
        if (studies.contains(study)) return;
        const std::filesystem::path file = list.file.parent_path() / (study + ".toml");
        if (!std::filesystem::exists(file))
            fail(list, statement, key, "there is no study file " + file.string(), "the stem of a study file beside the claims");
        studies[study].study = read_study(file);
    };
    for (const Claim& claim : list.claims)
        for (const Statement& statement : claim.statements) {
            if (!statement.not_evaluated.empty()) continue;
            read(statement, "study", statement.study);
            for (const std::string& study : statement.also) read(statement, "also", study);
        }
    check_claims(list, studies);
    return studies;
}

}  // namespace feldspar
