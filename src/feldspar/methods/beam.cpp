#include "feldspar/methods/beam.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

// Where the vertical at `x` crosses the outline, from below.
std::vector<double> crossings(const Outline& outline, double x) {
    std::vector<double> heights;
    for (std::size_t k = 0; k < outline.vertices.size(); ++k) {
        const Vec2 a = outline.vertices[k], b = outline.vertices[(k + 1) % outline.vertices.size()];
        if ((a.x < x) != (b.x < x)) heights.push_back(a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y));
    }
    std::sort(heights.begin(), heights.end());
    return heights;
}

// Width of the gap in the lower side around `x`.
double mouth_width(const Outline& outline, double x, double bottom) {
    double left = -std::numeric_limits<double>::infinity(), right = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < outline.vertices.size(); ++k) {
        const Vec2 a = outline.vertices[k], b = outline.vertices[(k + 1) % outline.vertices.size()];
        if (a.y > bottom || b.y > bottom) continue;  // not on the lower side
        left = std::max(left, std::max(a.x, b.x) <= x ? std::max(a.x, b.x) : left);
        right = std::min(right, std::min(a.x, b.x) >= x ? std::min(a.x, b.x) : right);
    }
    return right - left;
}

std::string mm(double m) { return fmt::format("{:.4g} mm", 1e3 * m); }

}  // namespace

NotchFromBelow notch_from_below(const Outline& outline, double middle_m, double bottom_m, double height_m) {
    NotchFromBelow notch;
    for (const Cutout& cutout : outline.cutouts) {
        if (cutout.joined) continue;  // nothing is taken away
        const Box box = bounding_box(cutout.vertices);
        constexpr double kClose = 1e-6;  // of the height
        const double axis = 0.5 * (box.lower.x + box.upper.x), close = kClose * height_m, tall = box.upper.y - box.lower.y;
        const bool upright =
            cutout.is_cut() ? box.upper.x - box.lower.x < close : cutout.slit && tall > box.upper.x - box.lower.x;
        if (notch.depth_m > 0.0 || !upright || std::abs(axis - middle_m) > close || box.lower.y > bottom_m + close) {
            notch.otherwise_cut = true;
            continue;
        }
        notch.depth_m = box.upper.y - bottom_m;
        notch.width_m = box.upper.x - box.lower.x;
    }
    if (notch.depth_m >= height_m)
        throw InputError({.key = "specimen.notches"}, "the notch goes through the specimen", "a notch that leaves a ligament");
    return notch;
}

Beam beam_of(const Outline& outline, double thickness_m, const TestSpec& test) {
    if (outline.is_disc)
        throw InputError({.key = "test.kind"}, "a disc is no beam",
                         "a rectangle that lies along x, or a polygon with a notch in the middle of its lower side");
    constexpr double kLeastSpan = 2.5, kUsualShare = 0.9;  // of the height; of the length
    const Box box = bounding_box(outline);
    Beam beam;
    const double length = box.upper.x - box.lower.x;
    beam.height_m = box.upper.y - box.lower.y;
    beam.thickness_m = thickness_m;
    beam.middle_m = 0.5 * (box.lower.x + box.upper.x);
    beam.bottom_m = box.lower.y;
    beam.span_m = test.own_value("span").value_or(std::min(4.0 * beam.height_m, kUsualShare * length));
    if (beam.span_m >= length)
        throw InputError({.key = "test.span"},
                         fmt::format("a span of {} is longer than the beam of {}", mm(beam.span_m), mm(length)),
                         fmt::format("less than {}", mm(length)));
    if (beam.span_m < kLeastSpan * beam.height_m)
        throw InputError({.key = "test.span"},
                         fmt::format("a span of {} is short for a beam {} high: its stresses are not those of bending",
                                     mm(beam.span_m), mm(beam.height_m)),
                         fmt::format("at least {:g} times the height", kLeastSpan),
                         "a longer, flatter specimen, four times as long as high or more: the beam lies along x");
    for (const double x : {beam.middle_m - 0.5 * beam.span_m, beam.middle_m + 0.5 * beam.span_m}) {
        const std::vector<double> there = crossings(outline, x);
        if (there.size() != 2 || there.front() > beam.bottom_m + 1e-9 * beam.height_m)
            throw InputError({.key = "test.span"}, fmt::format("the beam does not lie on its support at x = {}", mm(x)),
                             "a flat lower side over the span");
    }
    const std::vector<double> middle = crossings(outline, beam.middle_m);
    if (middle.size() != 2 || middle.back() < beam.top_m() - 1e-9 * beam.height_m)
        throw InputError({.key = "specimen"}, "the section in the middle of the span is not one piece below the loading roller",
                         "at most a notch from below");
    beam.notch_m = middle.front() - beam.bottom_m;
    if (beam.notch_m <= 1e-9 * beam.height_m) beam.notch_m = 0.0;
    if (beam.notched()) beam.notch_width_m = mouth_width(outline, beam.middle_m, beam.bottom_m + 1e-9 * beam.height_m);
    const NotchFromBelow cut =
        notch_from_below(outline, beam.middle_m, beam.bottom_m, beam.height_m);  // anything else makes the beam another one
    beam.otherwise_cut = cut.otherwise_cut || (beam.notched() && !outline.cutouts.empty());
    if (cut.depth_m > 0.0 && !beam.notched()) {
        beam.notch_m = cut.depth_m;
        beam.notch_width_m = cut.width_m;
    }
    return beam;
}

double flexural_factor(double height_over_span) { return 1.0 - 0.177 * height_over_span; }

// Timoshenko and Goodier, after von Karman and Seewald.
double deflection_factor(const Beam& beam, double nu) {
    const double s = beam.span_m / beam.height_m;
    return 0.25 * s * s * s * (1.0 + (2.4 + 1.5 * nu) / (s * s) - 0.84 / (s * s * s));
}

// Guinea, Pastor, Planas and Elices 1998: for spans of 4 h within 0.7 % of finite elements; short notches have the stress of
// (P36).
double notch_factor(double x, double height_over_span) {
    const double long_span = 1.99 + x * (0.83 - x * (0.31 - 0.14 * x)), four = 1.9 + x * (0.41 + x * (0.51 - 0.17 * x));
    const double p = long_span + 4.0 * height_over_span * (four - long_span);
    return 1.5 * std::sqrt(x) * p / (std::pow(1.0 - x, 1.5) * (1.0 + 3.0 * x));
}

double mouth_factor(double x) {
    return 24.0 * x * (0.76 - 2.28 * x + 3.87 * x * x - 2.04 * x * x * x + 0.66 / ((1.0 - x) * (1.0 - x)));
}

}  // namespace feldspar
