// The rules of decision (docs/claims.md): from the values of the packings to a verdict.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <functional>

#include "feldspar/findings/claims.hpp"
#include "feldspar/findings/decide.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

using BySeed = std::map<std::uint64_t, double>;
using Labels = std::vector<std::string>;  // of a point, one for each axis

/// The unit in which a quantity is shown, and the factor from SI.
struct Shown {
    std::string unit;
    double factor = 1.0;
};

Shown shown_as(const Quantity& quantity) {
    if (!quantity.divisor.empty()) return {};
    if (quantity.property.ends_with("_deg")) return {"deg", 1.0};
    if (!quantity.property.ends_with("_Pa")) return {};
    return quantity.property.starts_with("E_") ? Shown{"GPa", 1e-9} : Shown{"MPa", 1e-6};
}

const Shown percent{"%", 100.0};

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

BySeed paired_by(const BySeed& first, const BySeed& second, const std::function<double(double, double)>& f) {
    BySeed result;
    for (const auto& [seed, value] : first) {
        const auto other = second.find(seed);
        if (other == second.end()) continue;
        if (const double made = f(value, other->second); std::isfinite(made)) result[seed] = made;
    }
    return result;
}

BySeed difference(const BySeed& first, const BySeed& second) { return paired_by(first, second, std::minus<>()); }
BySeed quotient(const BySeed& first, const BySeed& second) { return paired_by(first, second, std::divides<>()); }
BySeed relative_change(const BySeed& from, const BySeed& to) {
    return paired_by(to, from, [](double b, double a) { return b / a - 1.0; });
}

std::vector<double> values_of(const BySeed& by_seed) {
    std::vector<double> values;
    for (const auto& [seed, value] : by_seed) values.push_back(value);
    return values;
}

double mean_of(const BySeed& by_seed) { return mean_interval(values_of(by_seed)).mean; }

BySeed scaled(const BySeed& by_seed, double factor) {
    BySeed result;
    for (const auto& [seed, value] : by_seed) result[seed] = factor * value;
    return result;
}

double middle(const BySeed& first, const BySeed& second) { return 0.5 * (mean_of(first) + mean_of(second)); }

double sign(double value) { return value < 0.0 ? -1.0 : 1.0; }

/// One statement on one study.
class Evaluation {
public:
    Evaluation(const Statement& statement, const std::string& name, const StudyResults& results)
        : statement_(statement), results_(results) {
        result_.statement = statement;
        result_.study = name;
        for (std::size_t p = 0; p < results.study.points.size(); ++p) points_[labels_of(p)] = p;
    }

    StatementResult run() {
        for (const Labels& base : combinations()) compare(base);
        decide_all();
        for (const std::size_t point : seen_) count_runs(point, result_.runs, result_.missing, result_.failed);
        std::vector<Verdict> verdicts;
        for (const Comparison& comparison : result_.comparisons) verdicts.push_back(comparison.verdict);
        result_.verdict = together(verdicts);
        return std::move(result_);
    }

private:
    Labels labels_of(std::size_t point) const {
        Labels labels;
        for (const AxisValue& value : results_.study.points[point].values) labels.push_back(value.label);
        return labels;
    }

    std::size_t axis_number(const std::string& axis) const {
        const auto& axes = results_.study.axes;
        return static_cast<std::size_t>(std::find(axes.begin(), axes.end(), axis) - axes.begin());
    }

    bool settled(const std::string& axis) const {
        return statement_.first.selection.contains(axis) || statement_.second.selection.contains(axis) ||
               statement_.third.contains(axis) || axis == statement_.first.axis || axis == statement_.second.axis;
    }

    bool allowed(const std::string& axis, const std::string& label) const {
        const auto chosen = statement_.where.find(axis);
        return chosen == statement_.where.end() ||
               std::find(chosen->second.begin(), chosen->second.end(), label) != chosen->second.end();
    }

    /// One point for each combination of the labels on the axes that the statement leaves free.
    std::vector<Labels> combinations() const {
        std::vector<Labels> found;
        std::set<Labels> seen;
        const auto& axes = results_.study.axes;
        for (std::size_t p = 0; p < results_.study.points.size(); ++p) {
            const Labels labels = labels_of(p);
            Labels free;
            bool fits = true;
            for (std::size_t a = 0; a < axes.size(); ++a) {
                if (settled(axes[a])) continue;
                fits = fits && allowed(axes[a], labels[a]);
                free.push_back(labels[a]);
            }
            if (fits && seen.insert(free).second) found.push_back(labels);
        }
        return found;
    }

    /// The labels of an axis in the study's order, those that `where` leaves.
    Labels along(const std::string& axis) const {
        Labels labels;
        const std::size_t a = axis_number(axis);
        for (const Point& point : results_.study.points) {
            const std::string& label = point.values[a].label;
            if (allowed(axis, label) && std::find(labels.begin(), labels.end(), label) == labels.end()) labels.push_back(label);
        }
        return labels;
    }

    /// Each adjacent pair of labels on an axis, and its ends.
    std::vector<std::pair<std::string, std::string>> steps(const std::string& axis) const {
        const Labels labels = along(axis);
        std::vector<std::pair<std::string, std::string>> pairs;
        for (std::size_t i = 1; i < labels.size(); ++i) pairs.emplace_back(labels[i - 1], labels[i]);
        if (labels.size() > 2) pairs.emplace_back(labels.front(), labels.back());
        return pairs;
    }

    Labels with(Labels base, const Selection& selection) const {
        for (const auto& [axis, labels] : selection) base[axis_number(axis)] = labels.front();
        return base;
    }

    Labels with(Labels base, const Selection& selection, const std::string& axis, const std::string& label) const {
        base = with(std::move(base), selection);
        base[axis_number(axis)] = label;
        return base;
    }

    BySeed property(std::size_t point, const std::string& name) const {
        BySeed values;
        const auto& known = results_.points[point].properties.values;
        const auto found = known.find(name);
        if (found == known.end()) return values;
        for (std::size_t i = 0; i < found->second.seeds.size(); ++i)
            if (std::isfinite(found->second.values[i])) values[found->second.seeds[i]] = found->second.values[i];
        return values;
    }

    BySeed values(const Labels& labels, const Quantity& quantity) {
        const std::size_t point = points_.at(labels);
        here_.insert(point);
        seen_.insert(point);
        const BySeed above = property(point, quantity.property);
        return quantity.divisor.empty() ? above : quotient(above, property(point, quantity.divisor));
    }

    double number(const Labels& labels, const std::string& axis) const {
        return results_.study.points[points_.at(labels)].values[axis_number(axis)].number;
    }

    void count_runs(std::size_t point, int& runs, int& missing, int& failed) const {
        std::set<MethodId> kinds;
        for (const Quantity& quantity : {statement_.first.quantity, statement_.second.quantity})
            for (const std::string& name : {quantity.property, quantity.divisor})
                if (!name.empty()) kinds.merge(tests_behind(name));
        const PointResults& there = results_.points[point];
        for (const Run& run : results_.study.runs) {
            if (run.point != point || !kinds.contains(run.test().kind)) continue;
            ++runs;
            const bool done = std::any_of(there.results.begin(), there.results.end(), [&](const TestResult& result) {
                return result.seed == run.seed() && result.test.kind == run.test().kind &&
                       result.test.sigma3_Pa == run.test().sigma3_Pa;
            });
            const bool lost = std::any_of(there.failed.begin(), there.failed.end(),
                                          [&](const RunRecord& record) { return record.id == run.id; });
            if (!done) ++(lost ? failed : missing);
        }
    }

    /// Takes one number a packing to be judged. The points that it came from are those read since the last call.
    /// @param size_of_value  the value of which a bound is a share
    void judge(const std::string& what, const BySeed& by_seed, const Shown& shown, MeanLimit target, double size_of_value = nan) {
        Comparison comparison{what, shown.unit, mean_interval(values_of(scaled(by_seed, shown.factor))), Verdict::undecided};
        target.limit *= shown.factor;
        const Bound& none = statement_.no_difference;
        comparison.nothing = shown.factor * none.size * (none.relative ? std::abs(size_of_value) : 1.0);
        int runs = 0, missing = 0, failed = 0;
        for (const std::size_t point : here_) count_runs(point, runs, missing, failed);
        here_.clear();
        if (comparison.interval.count < statement_.packings && missing > 0) comparison.verdict = Verdict::not_run;
        result_.comparisons.push_back(std::move(comparison));
        targets_.push_back(target);
    }

    /// All comparisons must agree for a statement to be reproduced, so each is found by itself. One alone may contradict it: what
    /// contradicts must hold together with all others.
    void decide_all() {
        std::vector<std::size_t> enough;
        std::vector<double> chances;
        for (std::size_t c = 0; c < targets_.size(); ++c) {
            if (result_.comparisons[c].interval.count < statement_.packings) continue;
            enough.push_back(c);
            chances.push_back(chance_of_no(result_.comparisons[c].interval, targets_[c]));
        }
        const std::vector<bool> hold = hold_together(chances, 0.025);
        for (std::size_t k = 0; k < enough.size(); ++k) {
            Comparison& comparison = result_.comparisons[enough[k]];
            if (decide(comparison.interval, targets_[enough[k]]) == Decision::yes)
                comparison.verdict = Verdict::reproduced;
            else if (hold[k])
                comparison.verdict = Verdict::contradicted;
            else if (is_nothing(comparison.interval, comparison.nothing))
                comparison.verdict = Verdict::no_difference;
        }
        for (std::size_t c = 0; c < targets_.size(); ++c) {
            Comparison& comparison = result_.comparisons[c];
            if (comparison.verdict != Verdict::undecided) continue;
            comparison.packings_to_decide = packings_to_decide(comparison.interval, targets_[c], comparison.nothing);
            if (comparison.packings_to_decide)
                comparison.packings_to_decide = std::max(*comparison.packings_to_decide, statement_.packings);
        }
    }

    /// The free labels and what is compared there, in words.
    std::string words(const Labels& base, const std::string& what) const {
        std::vector<std::string> parts;
        const auto& axes = results_.study.axes;
        for (std::size_t a = 0; a < axes.size(); ++a) {
            if (settled(axes[a])) continue;
            const bool bare = !std::isfinite(results_.study.points[points_.at(base)].values[a].number);
            parts.push_back(bare ? base[a] : axes[a] + " " + base[a]);
        }
        const std::string place = fmt::format("{}", fmt::join(parts, ", "));
        return place.empty() ? what : what.empty() ? place : place + ": " + what;
    }

    static std::string words(const Selection& selection) {
        Labels labels;
        for (const auto& [axis, chosen] : selection) {
            const bool number = std::isdigit(static_cast<unsigned char>(chosen.front().front())) != 0;
            labels.push_back(number ? axis + " " + chosen.front() : chosen.front());
        }
        return fmt::format("{}", fmt::join(labels, ", "));
    }

    std::string words(const Side& side, const std::string& from, const std::string& to) const {
        const std::string chosen = words(side.selection);
        const bool two = statement_.first.quantity.text != statement_.second.quantity.text;
        return fmt::format("{}{}{} {} to {}", two ? side.quantity.text + " " : "", chosen.empty() ? "" : chosen + ", ", side.axis,
                           from, to);
    }

    void compare(const Labels& base) {
        switch (statement_.rule) {
            case Rule::greater:
                return compare_greater(base);
            case Rule::rises_with:
            case Rule::falls_with:
            case Rule::negligible:
                return compare_steps(base);
            case Rule::matters:
                return compare_ends(base);
            case Rule::influence_greater:
                return compare_influences(base);
            case Rule::linear_with:
                return compare_line(base);
            case Rule::between:
                return compare_between(base);
            case Rule::closer:
                return compare_distances(base);
            case Rule::above:
            case Rule::below:
            case Rule::within:
                return compare_value(base);
        }
    }

    void compare_greater(const Labels& base) {
        const Quantity& quantity = statement_.first.quantity;
        const BySeed first = values(with(base, statement_.first.selection), quantity),
                     second = values(with(base, statement_.second.selection), quantity);
        judge(words(base, words(statement_.first.selection) + " less " + words(statement_.second.selection)),
              difference(first, second), shown_as(quantity), {}, middle(first, second));
    }

    void compare_steps(const Labels& base) {
        for (const auto& [from, to] : steps(statement_.first.axis)) compare_change(base, from, to);
    }

    void compare_ends(const Labels& base) {
        const auto [from, to] = ends(statement_.first);
        compare_change(base, from, to);
    }

    std::pair<std::string, std::string> ends(const Side& side) const {
        const Labels labels = along(side.axis);
        return {side.from.empty() ? labels.front() : side.from, side.to.empty() ? labels.back() : side.to};
    }

    void compare_change(const Labels& base, const std::string& from, const std::string& to) {
        const Side& side = statement_.first;
        const BySeed before = values(with(base, side.selection, side.axis, from), side.quantity);
        const BySeed after = values(with(base, side.selection, side.axis, to), side.quantity);
        const std::string chosen = words(side.selection);
        const std::string what =
            words(base, fmt::format("{}{} {} to {}", chosen.empty() ? "" : chosen + ", ", side.axis, from, to));
        using enum MeanLimit::Kind;
        const Rule rule = statement_.rule;
        if (rule == Rule::rises_with || rule == Rule::falls_with)
            return judge(what, difference(after, before), shown_as(side.quantity),
                         {rule == Rule::rises_with ? above : below, 0.0}, middle(before, after));
        const MeanLimit target{rule == Rule::negligible ? inside : outside, statement_.bound.size};
        if (statement_.bound.relative)
            judge(what, relative_change(before, after), percent, target);
        else
            judge(what, difference(after, before), unscaled(side.quantity), target);
    }

    /// An amount is stated in the unit in which the property's name gives it.
    static Shown unscaled(const Quantity& quantity) {
        return {quantity.property.ends_with("_Pa") && quantity.divisor.empty() ? "Pa" : shown_as(quantity).unit, 1.0};
    }

    void compare_influences(const Labels& base) {
        const auto change = [&](const Side& side) {
            const auto [from, to] = ends(side);
            return relative_change(values(with(base, side.selection, side.axis, from), side.quantity),
                                   values(with(base, side.selection, side.axis, to), side.quantity));
        };
        const auto [from, to] = ends(statement_.first);
        const auto [than_from, than_to] = ends(statement_.second);
        const BySeed first = change(statement_.first), second = change(statement_.second);
        const double s1 = sign(mean_of(first)), s2 = sign(mean_of(second));
        const BySeed surplus = paired_by(first, second, [=](double a, double b) { return s1 * a - s2 * b; });
        const std::string what = words(statement_.first, from, to) + " against " + words(statement_.second, than_from, than_to);
        judge(words(base, what), surplus, percent, {}, 1.0);
    }

    void compare_line(const Labels& base) {
        const Side& side = statement_.first;
        const Labels labels = along(side.axis);
        const auto at = [&](const std::string& label) { return with(base, side.selection, side.axis, label); };
        for (std::size_t i = 1; i + 1 < labels.size(); ++i) {
            const BySeed from = values(at(labels.front()), side.quantity), to = values(at(labels.back()), side.quantity);
            const BySeed change = difference(to, from);
            const double x0 = number(at(labels.front()), side.axis), x1 = number(at(labels.back()), side.axis);
            const double t = (number(at(labels[i]), side.axis) - x0) / (x1 - x0);
            const BySeed line = paired_by(from, to, [t](double a, double b) { return a + t * (b - a); });
            const BySeed departure = difference(values(at(labels[i]), side.quantity), line);
            judge(words(base, fmt::format("{} {} from the line through {} and {}", side.axis, labels[i], labels.front(),
                                          labels.back())),
                  scaled(departure, 1.0 / mean_of(change)), percent, {MeanLimit::Kind::inside, statement_.bound.size});
        }
    }

    struct Three {
        BySeed first, second, third;
    };

    Three three(const Labels& base) {
        const Quantity& quantity = statement_.first.quantity;
        return {values(with(base, statement_.first.selection), quantity),
                values(with(base, statement_.second.selection), quantity), values(with(base, statement_.third), quantity)};
    }

    void compare_between(const Labels& base) {
        const Quantity& quantity = statement_.first.quantity;
        const std::string first = words(statement_.first.selection), second = words(statement_.second.selection),
                          third = words(statement_.third);
        const Three v = three(base);
        const double up = sign(mean_of(difference(v.third, v.second)));  // +1: second is the lower bound
        const auto less = [](const std::string& a, const std::string& b) { return a + " less " + b; };
        const std::set<std::size_t> here = here_;
        judge(words(base, up > 0.0 ? less(first, second) : less(second, first)), scaled(difference(v.first, v.second), up),
              shown_as(quantity), {}, middle(v.first, v.second));
        here_ = here;
        judge(words(base, up > 0.0 ? less(third, first) : less(first, third)), scaled(difference(v.third, v.first), up),
              shown_as(quantity), {}, middle(v.third, v.first));
    }

    void compare_distances(const Labels& base) {
        const Three v = three(base);
        const auto distance = [](const BySeed& a, const BySeed& b) {
            return paired_by(a, b, [](double x, double y) { return std::abs(x - y); });
        };
        const std::string first = words(statement_.first.selection);
        judge(words(base,
                    fmt::format("{} from {} less from {}", first, words(statement_.third), words(statement_.second.selection))),
              difference(distance(v.first, v.third), distance(v.first, v.second)), shown_as(statement_.first.quantity), {},
              mean_of(v.first));
    }

    void compare_value(const Labels& base) {
        const Quantity& quantity = statement_.first.quantity;
        const Labels place = with(base, statement_.first.selection);
        BySeed value = values(place, quantity);
        std::string what = words(statement_.first.selection);
        Shown shown = shown_as(quantity);
        if (statement_.has_second) {
            value = quotient(value, values(with(base, statement_.second.selection), quantity));
            what += " over " + words(statement_.second.selection);
            shown = {};
        }
        if (statement_.rule != Rule::within) {
            const bool above = statement_.rule == Rule::above;
            return judge(words(base, fmt::format("{}{}{} {:g}", what, what.empty() ? "" : ", ", above ? "above" : "below",
                                                 statement_.number * shown.factor)),
                         value, shown, {above ? MeanLimit::Kind::above : MeanLimit::Kind::below, statement_.number});
        }
        const bool stated = std::isfinite(statement_.number);
        const double reference =
            stated ? statement_.number : laboratory_value(results_.study.points[points_.at(place)].job, quantity);
        what +=
            fmt::format("{}from {}{:g}", what.empty() ? "" : ", ", stated ? "" : "the laboratory's ", reference * shown.factor);
        BySeed departure;
        for (const auto& [seed, v] : value) departure[seed] = statement_.bound.relative ? v / reference - 1.0 : v - reference;
        judge(words(base, what), departure, statement_.bound.relative ? percent : unscaled(quantity),
              {MeanLimit::Kind::inside, statement_.bound.size});
    }

    const Statement& statement_;
    const StudyResults& results_;
    StatementResult result_;
    std::map<Labels, std::size_t> points_;
    std::vector<MeanLimit> targets_;  // of the comparisons of result_
    std::set<std::size_t> here_;      // points of the comparison in hand
    std::set<std::size_t> seen_;      // of the statement
};

StatementResult not_evaluated(const Statement& statement) {
    StatementResult result;
    result.statement = statement;
    result.verdict = Verdict::not_evaluated;
    return result;
}

}  // namespace

int StatementResult::count(Verdict wanted) const {
    return static_cast<int>(
        std::count_if(comparisons.begin(), comparisons.end(), [&](const Comparison& c) { return c.verdict == wanted; }));
}

const char* name(Verdict verdict) {
    switch (verdict) {
        case Verdict::reproduced:
            return "reproduced";
        case Verdict::contradicted:
            return "contradicted";
        case Verdict::no_difference:
            return "no difference";
        case Verdict::in_part:
            return "in part";
        case Verdict::undecided:
            return "undecided";
        case Verdict::not_run:
            return "not run";
        case Verdict::not_evaluated:
            return "not evaluated";
    }
    return "";
}

Verdict together(std::span<const Verdict> verdicts) {
    const auto any = [&](Verdict wanted) { return std::find(verdicts.begin(), verdicts.end(), wanted) != verdicts.end(); };
    const auto all = [&](Verdict wanted) {
        return std::all_of(verdicts.begin(), verdicts.end(), [&](Verdict verdict) { return verdict == wanted; });
    };
    if (verdicts.empty()) return Verdict::undecided;
    const bool denied = any(Verdict::contradicted) || any(Verdict::no_difference);
    if (any(Verdict::in_part) || (denied && any(Verdict::reproduced))) return Verdict::in_part;
    if (any(Verdict::contradicted)) return Verdict::contradicted;
    if (any(Verdict::not_run)) return Verdict::not_run;
    for (const Verdict verdict : {Verdict::reproduced, Verdict::no_difference, Verdict::not_evaluated})
        if (all(verdict)) return verdict;
    return Verdict::undecided;
}

void add_run_numbers(PointResults& point, std::span<const RunRecord> records) {
    for (const RunRecord& record : records) {
        const auto method = find_method(record.test);
        if (record.state != RunState::done || (method && method_of(*method).specimen.confined)) continue;
        for (const auto& [column, value] : record.numbers) {
            if (!std::isfinite(value)) continue;
            PropertyStatistics& statistics = point.properties.values[column + " of " + record.test];
            statistics.seeds.push_back(record.seed);
            statistics.values.push_back(value);
        }
    }
}

void add_results(StudiesByName& studies) {
    for (auto& [stem, results] : studies) {
        const Study& study = results.study;
        results.points.assign(study.points.size(), {});
        for (std::size_t p = 0; p < study.points.size(); ++p) results.points[p].values = study.points[p].values;
        if (!std::filesystem::exists(study.results / "ledger.sqlite")) continue;
        const Ledger ledger(study.results, Ledger::Access::read);
        results.points = point_results(study, ledger);
        std::vector<std::vector<std::string>> ids(study.points.size());
        for (const Run& run : study.runs) ids[run.point].push_back(run.id);
        for (std::size_t p = 0; p < ids.size(); ++p) add_run_numbers(results.points[p], ledger.find(ids[p]));
    }
}

namespace {

std::vector<std::string> studies_of(const Statement& statement) {
    std::vector<std::string> studies{statement.study};
    studies.insert(studies.end(), statement.also.begin(), statement.also.end());
    return studies;
}

/// The same statement by another definition of its property. A second side that compares another property keeps that.
Statement by_another(const Statement& statement, const Quantity& quantity) {
    Statement other = statement;
    other.says += ", by " + quantity.text;
    if (other.second.quantity.text == statement.first.quantity.text) other.second.quantity = quantity;
    other.first.quantity = quantity;
    return other;
}

}  // namespace

ClaimResult evaluate(const Claim& claim, const StudiesByName& studies) {
    ClaimResult result;
    result.claim = claim;
    std::vector<Verdict> verdicts;
    for (const Statement& statement : claim.statements) {
        if (!statement.not_evaluated.empty()) {
            result.statements.push_back(not_evaluated(statement));
        } else {
            result.statements.push_back(Evaluation(statement, statement.study, studies.at(statement.study)).run());
        }
        verdicts.push_back(result.statements.back().verdict);
        for (const std::string& study : statement.also) {
            result.statements.push_back(Evaluation(statement, study, studies.at(study)).run());
            result.statements.back().votes = false;
        }
        for (const Quantity& quantity : statement.also_property) {
            const Statement other = by_another(statement, quantity);
            for (const std::string& study : studies_of(statement)) {
                result.statements.push_back(Evaluation(other, study, studies.at(study)).run());
                result.statements.back().votes = false;
            }
        }
    }
    result.verdict = together(verdicts);
    return result;
}

}  // namespace feldspar
