#include "feldspar/lab/failure_pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
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

/// The most cracked tenth of the specimen, by squares. The places count with the whole crack at its middle: a crack is shorter
/// than a grain, a square some grains wide.
void read_concentration(const TestResult& result, double total, FailurePattern& pattern) {
    if (!result.specimen || result.specimen->mesh.nodes.empty()) return;
    const Box box = bounding_box(result.specimen->mesh.nodes);
    const double side = (box.upper.x - box.lower.x) / 10.0;
    struct Square {
        double length = 0.0;
        Vec2 first;                           // sum of length times place
        double xx = 0.0, yy = 0.0, xy = 0.0;  // and of the products of its coordinates
    };
    std::map<std::pair<int, int>, Square> squares;
    for (const Crack& crack : result.cracks) {
        const auto square = [side](double x, double low) { return static_cast<int>(std::floor((x - low) / side)); };
        Square& own = squares[{square(crack.place.x, box.lower.x), square(crack.place.y, box.lower.y)}];
        const double l = length(crack);
        const Vec2 at = crack.place - box.lower;
        own.length += l;
        own.first = own.first + l * at;
        own.xx += l * at.x * at.x;
        own.yy += l * at.y * at.y;
        own.xy += l * at.x * at.y;
    }
    std::vector<Square> ordered;
    for (const auto& [place, square] : squares) ordered.push_back(square);
    std::stable_sort(ordered.begin(), ordered.end(), [](const Square& l, const Square& r) { return l.length > r.length; });
    const double tenth = 0.1 * result.specimen->outline.area_m2 / (side * side);  // squares, usually not a whole number
    double inside = 0.0, left = tenth;
    Square sum;
    for (const Square& square : ordered) {
        const double share = std::min(1.0, left);
        inside += share * square.length;
        sum.first = sum.first + share * square.first;
        sum.xx += share * square.xx;
        sum.yy += share * square.yy;
        sum.xy += share * square.xy;
        left -= 1.0;
        if (left <= 0.0) break;
    }
    pattern.crack_localisation = inside / total;
    const double x = sum.first.x / inside, y = sum.first.y / inside, xx = sum.xx / inside - x * x, yy = sum.yy / inside - y * y,
                 xy = sum.xy / inside - x * y;
    const double mean = 0.5 * (xx + yy), radius = std::hypot(0.5 * (xx - yy), xy);
    if (!(mean > 0.0)) return;
    pattern.band_angle_deg = 90.0 - std::abs(in_degrees(0.5 * std::atan2(2.0 * xy, xx - yy)));
    pattern.band_elongation = std::sqrt((mean + radius) / std::max(mean - radius, 1e-6 * mean));
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
    } else {  // cycles go below it and come back: when it is left for good
        row = result.history.size() - 1;
        while (row > peak->row && !high(row - 1)) --row;
    }
    return strain(row) / strain(peak->row) - 1.0;
}

}  // namespace

FailurePattern failure_pattern(const TestResult& result) {
    FailurePattern pattern{nan, nan, nan, nan, nan, nan, post_peak_strain(result)};
    double total = 0.0, tensile = 0.0;
    for (const Crack& crack : result.cracks) {
        total += length(crack);
        if (crack.mode == CrackMode::tensile) tensile += length(crack);
    }
    if (!(total > 0.0)) return pattern;
    pattern.tensile_share = tensile / total;
    read_directions(result, total, pattern);
    read_concentration(result, total, pattern);
    return pattern;
}

FailureMode failure_mode(const TestResult& result) {
    // Bounds between forms, chosen on the numbers of some thirty specimens of the examples.
    constexpr std::size_t kFewest = 30;                                // cracks
    constexpr double kBand = 2.0, kInclined = 15.0, kSteepest = 60.0;  // elongation, and angles from the loading axis, degrees
    constexpr double kAligned = 0.25, kEven = 0.3;  // alignment and localisation below which cracks go everywhere
    const TestMethod& method = method_of(result.test);
    const bool compression = method.loading.on_envelope || (method.reading == Reading::stages && method.loading.sign > 0.0);
    const auto peak = find_peak(result);
    if (!compression || !peak || !peak->reached || result.cracks.size() < kFewest) return {};
    const FailurePattern p = failure_pattern(result);
    if (!std::isfinite(p.band_elongation)) return {};
    FailureMode mode{"axial cracks without one form", {}};
    if (p.band_elongation >= kBand && p.band_angle_deg >= kInclined && p.band_angle_deg <= kSteepest)
        mode.name = "shear band";
    else if (p.crack_alignment < kAligned && p.crack_localisation < kEven)
        mode.name = "crushing";
    else if (p.band_elongation >= kBand && p.band_angle_deg < kInclined && p.crack_angle_deg < kInclined)
        mode.name = "axial splitting";
    mode.words = fmt::format(
        "The most cracked tenth of the specimen has {:.0f} % of the crack length; it is {:.1f} times as long as wide, at {:.0f} "
        "degrees to the loading axis. "
        "{:.0f} % of the crack length is tensile; cracks lie at {:.0f} degrees to the axis in the mean, with an alignment of "
        "{:.2f}",
        100.0 * p.crack_localisation, p.band_elongation, p.band_angle_deg, 100.0 * p.tensile_share, p.crack_angle_deg,
        p.crack_alignment);
    return mode;
}

}  // namespace feldspar
