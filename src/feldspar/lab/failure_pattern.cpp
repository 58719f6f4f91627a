#include "feldspar/lab/failure_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "feldspar/base/angle.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/lab/loading_curve.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double length(const Crack& crack) { return std::hypot(crack.to.x - crack.from.x, crack.to.y - crack.from.y); }

/// The loading axis is y. Directions have no head, so their angles are doubled before they are averaged.
void read_directions(const TestResult& result, double total, FailurePattern& pattern) {
    double cosine = 0.0, sine = 0.0;
    for (const Crack& crack : result.cracks) {
        const double twice = 2.0 * std::atan2(crack.to.x - crack.from.x, crack.to.y - crack.from.y);
        cosine += length(crack) * std::cos(twice);
        sine += length(crack) * std::sin(twice);
    }
    pattern.crack_alignment = std::hypot(cosine, sine) / total;
    pattern.crack_angle_deg = in_degrees(std::abs(0.5 * std::atan2(sine, cosine)));
}

/// The places count with the whole crack at its middle: a crack is shorter than a grain, a square some grains wide.
double localisation(const TestResult& result, double total) {
    if (!result.specimen || result.specimen->mesh.nodes.empty()) return nan;
    const Box box = bounding_box(result.specimen->mesh.nodes);
    const double side = (box.upper.x - box.lower.x) / 10.0;
    std::map<std::pair<int, int>, double> squares;
    for (const Crack& crack : result.cracks) {
        const auto square = [side](double x, double low) { return static_cast<int>(std::floor((x - low) / side)); };
        squares[{square(crack.place.x, box.lower.x), square(crack.place.y, box.lower.y)}] += length(crack);
    }
    std::vector<double> lengths;
    for (const auto& [square, l] : squares) lengths.push_back(l);
    std::sort(lengths.begin(), lengths.end(), std::greater<>());
    const double tenth = 0.1 * result.specimen->outline.area_m2 / (side * side);   // squares, usually not a whole number
    double inside = 0.0, left = tenth;
    for (const double l : lengths) {
        inside += std::min(1.0, left) * l;
        left -= 1.0;
        if (left <= 0.0) break;
    }
    return inside / total;
}

double post_peak_strain(const TestResult& result) {
    const auto peak = find_peak(result);
    if (!peak || !peak->reached) return nan;
    const double sign = method_of(result.test).loading.sign;
    const auto strain = [&](std::size_t row) { return sign * result.history[row].axial_strain; };
    if (!(strain(peak->row) > 0.0)) return nan;
    const auto high = [&](std::size_t row) { return sign * result.history[row].axial_stress_Pa > 0.8 * peak->stress_Pa; };
    std::size_t row = peak->row;
    if (result.stages.empty()) {
        while (row + 1 < result.history.size() && high(row)) ++row;
    } else {   // cycles go below it and come back: when it is left for good
        row = result.history.size() - 1;
        while (row > peak->row && !high(row - 1)) --row;
    }
    return strain(row) / strain(peak->row) - 1.0;
}

}  // namespace

FailurePattern failure_pattern(const TestResult& result) {
    FailurePattern pattern{nan, nan, nan, nan, post_peak_strain(result)};
    double total = 0.0, tensile = 0.0;
    for (const Crack& crack : result.cracks) {
        total += length(crack);
        if (crack.mode == CrackMode::tensile) tensile += length(crack);
    }
    if (!(total > 0.0)) return pattern;
    pattern.tensile_share = tensile / total;
    read_directions(result, total, pattern);
    pattern.crack_localisation = localisation(result, total);
    return pattern;
}

}  // namespace feldspar
