// What the points of a convergence study say, in numbers and in words.
#include "feldspar/findings/converge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/lab/rock_properties.hpp"
#include "feldspar/output/user_units.hpp"

namespace feldspar {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// What is compared: E, nu and the strengths of the tests that were run.
bool is_compared(const std::string& property) {
    const RockProperty* known = kept_rock_property(property);
    if (known == nullptr) return false;
    return known->source == RockProperty::Source::confined_strength ||
           (known->source == RockProperty::Source::test && known->reported());
}

std::vector<std::string> compared_properties(std::span<const PointResults> points, const std::vector<std::size_t>& which) {
    std::vector<std::string> found;
    for (const std::size_t p : which)
        for (const auto& [property, statistics] : points[p].properties.values)
            if (is_compared(property) && std::find(found.begin(), found.end(), property) == found.end())
                found.push_back(property);
    std::sort(found.begin(), found.end(),
              [](const std::string& a, const std::string& b) { return user_quantity(a).rank < user_quantity(b).rank; });
    return found;
}

PropertyStatistics statistics_of(const PointResults& point, const std::string& property) {
    const auto found = point.properties.values.find(property);
    return found == point.properties.values.end() ? PropertyStatistics{} : found->second;
}

PropertyAlong along(const ConvergeAxis& axis, std::size_t a, std::span<const PointResults> points, const std::string& property) {
    PropertyAlong result{property, {}, axis.base, {}};
    const PropertyStatistics base = statistics_of(points[axis.points[axis.base]], property);
    for (const std::size_t p : axis.points) {
        const PropertyStatistics own = statistics_of(points[p], property);
        const AxisValue& value = points[p].values[a];
        ValueAt at{value.label, value.number, mean_interval(own.values), {}};
        at.change = axis.same_packings ? change_by_packing(base, own) : change_between_means(base, own);
        result.values.push_back(std::move(at));
    }
    return result;
}

std::string percent(double share) {
    const double size = 100.0 * std::abs(share);
    return size >= 9.95 ? fmt::format("{:.0f} %", size) : fmt::format("{:.1f} %", size);
}

/// The same rounded upwards, for "within".
std::string percent_up(double share) {
    const double size = 100.0 * std::abs(share);
    return size >= 9.95 ? fmt::format("{:.0f} %", std::ceil(size - 1e-9))
                        : fmt::format("{:.1f} %", 0.1 * std::ceil(10.0 * size - 1e-9));
}

std::string change_words(const PropertyAlong& along, const ValueAt& value) {
    const Change& change = value.change;
    const double least = std::min(std::abs(change.low), std::abs(change.high));
    return fmt::format("{} by {} from {} to {} ({} to {})", change.mean > 0.0 ? "grows" : "falls", percent(change.mean),
                       along.values[along.base].label, value.label, percent(least), percent(change.bound()));
}

std::string packings_words(int packings) {
    if (packings <= 0 || packings > 9999) return "more packings than anyone runs would";
    return fmt::format("about {} packings would", packings);
}

/// Half the interval at which either "independent" or "depends" could be said of such a change.
double deciding_half_width(const Change& change, double within) {
    return std::max(within - std::abs(change.mean), std::abs(change.mean));
}

/// "E", "UCS": a property without its unit.
std::string short_name(const std::string& property) {
    if (const auto pressure_MPa = pressure_of_confined_strength_MPa(property))
        return fmt::format("sigma_1 at {:g} MPa", *pressure_MPa);
    return property.substr(0, property.find('_'));
}

std::string names_of(const std::vector<PropertyAlong>& properties, Dependence dependence) {
    std::vector<std::string> names;
    for (const PropertyAlong& p : properties)
        if (p.verdict.dependence == dependence) names.push_back(short_name(p.property));
    return fmt::format("{}", fmt::join(names, ", "));
}

/// "depends: " and the like taken away.
std::string after_colon(const std::string& words) {
    const std::size_t colon = words.find(": ");
    return colon == std::string::npos ? words : words.substr(colon + 2);
}

Finding summed(const std::vector<PropertyAlong>& properties) {
    Finding verdict{Dependence::independent, {}, 0.0, 0};
    double independent_bound = 0.0;
    for (const PropertyAlong& p : properties) {
        verdict.dependence = std::max(verdict.dependence, p.verdict.dependence);
        verdict.bound = std::isfinite(p.verdict.bound) ? std::max(verdict.bound, p.verdict.bound) : nan;
        verdict.packings = std::max(verdict.packings, p.verdict.packings);
        if (p.verdict.dependence == Dependence::independent) independent_bound = std::max(independent_bound, p.verdict.bound);
    }
    if (properties.empty()) return {Dependence::undecided, "undecided: no property could be read", nan, 0};
    if (verdict.dependence == Dependence::independent) {
        verdict.words = "independent within " + percent_up(verdict.bound);
        return verdict;
    }
    std::vector<std::string> parts;
    for (const PropertyAlong& p : properties)
        if (p.verdict.dependence == Dependence::depends)
            parts.push_back(short_name(p.property) + " " + after_colon(p.verdict.words));
    const bool depends = !parts.empty();
    for (const PropertyAlong& p : properties)
        if (p.verdict.dependence == Dependence::undecided)
            parts.push_back((depends ? "undecided " : "") + short_name(p.property) + ": " + after_colon(p.verdict.words));
    const std::string same = names_of(properties, Dependence::independent);
    if (!same.empty()) parts.push_back(fmt::format("{} independent within {}", same, percent_up(independent_bound)));
    verdict.words = fmt::format("{}: {}", name(verdict.dependence), fmt::join(parts, "; "));
    return verdict;
}

AxisResult judge_axis(const ConvergeAxis& axis, std::size_t a, std::span<const PointResults> points) {
    AxisResult result{axis, {}, {}};
    for (const std::string& property : compared_properties(points, axis.points))
        result.properties.push_back(along(axis, a, points, property));
    return result;
}

/// Which changes of the axis stand beside all its others; [property][value].
std::vector<std::vector<bool>> standing(const AxisResult& axis) {
    std::vector<double> chances;
    for (const PropertyAlong& p : axis.properties)
        for (std::size_t v = 0; v < p.values.size(); ++v) chances.push_back(v == p.base ? nan : p.values[v].change.chance);
    const std::vector<bool> flat = stand_together(chances);
    std::vector<std::vector<bool>> result;
    std::size_t next = 0;
    for (const PropertyAlong& p : axis.properties) {
        result.emplace_back(flat.begin() + static_cast<std::ptrdiff_t>(next),
                            flat.begin() + static_cast<std::ptrdiff_t>(next + p.values.size()));
        next += p.values.size();
    }
    return result;
}

std::vector<SeedResult> judge_seeds(const PointResults& base, double within) {
    std::vector<SeedResult> results;
    for (const std::string& property : compared_properties({&base, 1}, {0})) {
        const std::vector<double> values = statistics_of(base, property).values;
        SeedResult result{property, mean_interval(values), subsamples(values), {}};
        result.verdict = judge_packings(result.mean, within);
        results.push_back(std::move(result));
    }
    return results;
}

Finding summed(const std::vector<SeedResult>& seeds, double within) {
    Finding verdict{Dependence::independent, {}, 0.0, 0};
    std::vector<std::string> parts;
    for (const SeedResult& s : seeds) {
        verdict.dependence = std::max(verdict.dependence, s.verdict.dependence);
        verdict.bound = std::isfinite(s.verdict.bound) ? std::max(verdict.bound, s.verdict.bound) : nan;
        verdict.packings = std::max(verdict.packings, s.verdict.packings);
        parts.push_back(std::isfinite(s.verdict.bound)
                            ? fmt::format("{} +- {}", short_name(s.property), percent_up(s.verdict.bound))
                            : short_name(s.property) + " without an interval");
    }
    if (seeds.empty()) return {Dependence::undecided, "undecided: no property could be read", nan, 0};
    const bool enough = verdict.dependence == Dependence::independent;
    verdict.words = fmt::format("{}: {}", enough ? "enough packings" : "not enough packings", fmt::join(parts, ", "));
    if (!enough && verdict.packings > 0)
        verdict.words += fmt::format("; {} give +- {} for all", packings_words(verdict.packings), percent(within));
    return verdict;
}

std::string overall_of(const Convergence& result) {
    std::string independent, undecided, depends;
    const auto add = [](std::string& list, const std::string& item) { list += (list.empty() ? "" : "; ") + item; };
    for (const AxisResult& axis : result.axes) {
        if (axis.verdict.dependence == Dependence::independent)
            add(independent, fmt::format("{} (within {})", axis.axis.name, percent_up(axis.verdict.bound)));
        if (axis.verdict.dependence == Dependence::undecided) add(undecided, axis.axis.name);
        if (axis.verdict.dependence == Dependence::depends)
            add(depends, fmt::format("{} ({})", axis.axis.name, names_of(axis.properties, Dependence::depends)));
    }
    std::string text;
    if (!depends.empty()) text += fmt::format("The answer depends on {}. ", depends);
    if (!independent.empty()) text += fmt::format("It is independent of {}. ", independent);
    if (!undecided.empty()) text += fmt::format("Undecided: {}. ", undecided);
    const std::string& seeds = result.seed_verdict.words;
    if (!seeds.empty())
        text +=
            std::string(1, static_cast<char>(std::toupper(static_cast<unsigned char>(seeds.front())))) + seeds.substr(1) + ".";
    return text;
}

}  // namespace

const char* name(Dependence dependence) {
    switch (dependence) {
        case Dependence::independent:
            return "independent";
        case Dependence::undecided:
            return "undecided";
        case Dependence::depends:
            return "depends";
    }
    return "?";
}

Finding judge_property(const PropertyAlong& along, const std::vector<bool>& stands, double within) {
    Finding verdict{Dependence::undecided, {}, 0.0, 0};
    std::vector<std::string> changes, not_read;
    int least_count = std::numeric_limits<int>::max();
    for (std::size_t v = 0; v < along.values.size(); ++v) {
        if (v == along.base) continue;
        const Change& change = along.values[v].change;
        least_count = std::min(least_count, change.count);
        if (change.count < 2) {
            not_read.push_back(along.values[v].label);
            continue;
        }
        verdict.bound = std::max(verdict.bound, change.bound());
        if (change.bound() <= within) continue;
        if (stands[v]) changes.push_back(change_words(along, along.values[v]));
        verdict.packings = std::max(verdict.packings, packings_for_change(change, deciding_half_width(change, within)));
    }
    if (!not_read.empty()) verdict.bound = nan;
    if (!changes.empty()) {
        verdict.dependence = Dependence::depends;
        verdict.packings = 0;
        verdict.words = fmt::format("depends: {}", fmt::join(changes, ", "));
    } else if (least_count < 2) {
        verdict.words = least_count == 1 ? "undecided: one packing allows no statement; two at least would"
                                         : fmt::format("undecided: there is no value at {}", fmt::join(not_read, ", "));
    } else if (verdict.bound <= within) {
        verdict.dependence = Dependence::independent;
        verdict.words = "independent within " + percent_up(verdict.bound);
    } else {
        verdict.words = fmt::format("undecided: the scatter of {} packings allows no statement below {}; {}", least_count,
                                    percent_up(verdict.bound), packings_words(std::max(verdict.packings, least_count + 1)));
    }
    return verdict;
}

Finding judge_packings(const MeanInterval& mean, double within) {
    if (mean.count < 2)
        return {Dependence::undecided, "undecided: one packing has no scatter to judge by; two at least would", nan, 0};
    const double scale = std::abs(mean.mean), half = mean.half_width() / scale;
    if (half <= within)
        return {Dependence::independent, fmt::format("known to +- {} with {} packings", percent_up(half), mean.count), half, 0};
    const int packings = std::max(packings_for_mean(mean.standard_deviation / scale, within), mean.count + 1);
    return {Dependence::undecided,
            fmt::format("known to +- {} only with {} packings; {} give +- {}", percent_up(half), mean.count,
                        packings_words(packings), percent(within)),
            half, packings};
}

Convergence judge_convergence(const ConvergePlan& plan, std::span<const PointResults> points) {
    Convergence result;
    for (std::size_t a = 0; a < plan.axes.size(); ++a) {
        AxisResult axis = judge_axis(plan.axes[a], a, points);
        const std::vector<std::vector<bool>> stands = standing(axis);
        for (std::size_t p = 0; p < axis.properties.size(); ++p)
            axis.properties[p].verdict = judge_property(axis.properties[p], stands[p], plan.within);
        axis.verdict = summed(axis.properties);
        result.axes.push_back(std::move(axis));
    }
    result.seeds = judge_seeds(points.front(), plan.within);
    result.seed_verdict = summed(result.seeds, plan.within);
    result.overall = overall_of(result);
    return result;
}

}  // namespace feldspar
