#include "feldspar/findings/decide.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>

namespace feldspar {
namespace {

using Kind = MeanLimit::Kind;

constexpr double one_side = 0.025;  // of an interval of 95 %
constexpr double power = 0.8;

double quantile(int count, double share) { return boost::math::quantile(boost::math::students_t(count - 1), share); }

// The chance of a mean so far above the limit, if the true one is the limit.
double chance_of_above(const MeanInterval& i, double limit) {
    if (i.count < 2 || !std::isfinite(i.mean)) return 1.0;
    const double error = i.standard_deviation / std::sqrt(static_cast<double>(i.count));
    if (error == 0.0) return i.mean > limit ? 0.0 : 1.0;
    return boost::math::cdf(boost::math::complement(boost::math::students_t(i.count - 1), (i.mean - limit) / error));
}

double chance_of_below(const MeanInterval& i, double limit) {
    if (i.count < 2 || !std::isfinite(i.mean)) return 1.0;
    MeanInterval turned = i;
    turned.mean = -i.mean;
    return chance_of_above(turned, -limit);
}

// How far the mean lies from the nearest limit of the target: as far as the interval must shrink.
double distance(const MeanInterval& i, const MeanLimit& target) {
    if (target.kind == Kind::above || target.kind == Kind::below) return std::abs(i.mean - target.limit);
    return std::abs(std::abs(i.mean) - target.limit);
}

}  // namespace

Decision decide(const MeanInterval& i, const MeanLimit& target) {
    if (!std::isfinite(i.low) || !std::isfinite(i.high)) return Decision::open;
    const bool above = i.low > target.limit, below = i.high < target.limit;
    const bool inside = i.low > -target.limit && below, outside = above || i.high < -target.limit;
    const auto finding = [](bool yes, bool no) { return yes ? Decision::yes : no ? Decision::no : Decision::open; };
    switch (target.kind) {
        case Kind::above:
            return finding(above, below);
        case Kind::below:
            return finding(below, above);
        case Kind::inside:
            return finding(inside, outside);
        case Kind::outside:
            return finding(outside, inside);
    }
    return Decision::open;
}

double chance_of_no(const MeanInterval& i, const MeanLimit& target) {
    switch (target.kind) {
        case Kind::above:
            return chance_of_below(i, target.limit);
        case Kind::below:
            return chance_of_above(i, target.limit);
        case Kind::inside:  // it is outside, on one side or on the other
            return std::min(chance_of_above(i, target.limit), chance_of_below(i, -target.limit));
        case Kind::outside:  // it is inside of both limits
            return std::max(chance_of_below(i, target.limit), chance_of_above(i, -target.limit));
    }
    return 1.0;
}

std::vector<bool> hold_together(std::span<const double> chances, double level) {
    std::vector<std::size_t> order(chances.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return chances[i]; });
    std::vector<bool> hold(chances.size(), false);
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (!(chances[order[k]] <= level / static_cast<double>(order.size() - k))) break;
        hold[order[k]] = true;
    }
    return hold;
}

bool is_nothing(const MeanInterval& i, double size) {
    return size > 0.0 && chance_of_below(i, size) < 2.0 * one_side && chance_of_above(i, -size) < 2.0 * one_side;
}

std::optional<int> packings_to_decide(const MeanInterval& i, const MeanLimit& target, double size) {
    if (i.count < 2 || !(i.standard_deviation > 0.0)) return std::nullopt;
    const double to_limit = distance(i, target), to_nothing = size - std::abs(i.mean);
    for (int n = std::max(i.count + 1, 3); n <= most_packings; ++n) {
        const double error = i.standard_deviation / std::sqrt(static_cast<double>(n)), seen = quantile(n, power);
        if ((quantile(n, 1.0 - one_side) + seen) * error < to_limit) return n;
        if ((quantile(n, 1.0 - 2.0 * one_side) + seen) * error < to_nothing) return n;
    }
    return std::nullopt;
}

}  // namespace feldspar
