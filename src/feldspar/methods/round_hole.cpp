#include "feldspar/methods/round_hole.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {

RoundHole round_hole_of(const Outline& outline) {
    constexpr const char* kAllowed =
        "shape = \"rectangle\" with holes = [{ centre = [\"30 mm\", \"60 mm\"], diameter = \"12 mm\" }]";
    const auto labelled = [&](const char* label) {
        return std::ranges::find(outline.edge_labels, label) != outline.edge_labels.end();
    };
    if (outline.is_disc || outline.vertices.size() != 4 || !labelled("left") || !labelled("right"))
        throw InputError({.key = "test.kind"}, "the specimen is no rectangular plate", kAllowed);
    if (outline.cutouts.size() != 1 || outline.cutouts.front().slit || outline.cutouts.front().is_cut())
        throw InputError({.key = "test.kind"},
                         outline.cutouts.empty() ? "the plate has no hole" : "the plate has more cut out of it than one hole",
                         kAllowed);
    const std::vector<Vec2>& edge = outline.cutouts.front().vertices;
    RoundHole hole;
    hole.centre = centroid(edge);
    hole.radius_m = std::sqrt(std::abs(signed_area(edge)) / M_PI);
    constexpr double kRound = 0.01;  // polygons of 24 edges stay within this
    if (std::ranges::any_of(
            edge, [&](Vec2 corner) { return std::abs(norm(corner - hole.centre) - hole.radius_m) > kRound * hole.radius_m; }))
        throw InputError({.key = "test.kind"}, "the hole is not round", kAllowed);
    const double rock = distance_to_boundary(outline.vertices, hole.centre) - hole.radius_m;
    if (rock < (1.0 - 1e-9) * hole.radius_m)
        throw InputError(
            {.key = "test.kind"},
            fmt::format(
                "the rock beside the hole is {:.4g} mm wide, and the stress at its edge is read over one radius of {:.4g} mm",
                1e3 * rock, 1e3 * hole.radius_m),
            "a hole whose diameter is at most half of the plate's width, in its middle");
    return hole;
}

}  // namespace feldspar
