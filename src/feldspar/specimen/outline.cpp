#include "feldspar/specimen/outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "feldspar/base/error.hpp"

namespace feldspar {
namespace {

void require_length(double value, const char* key) {
    if (!(value > 0.0) || !std::isfinite(value)) {
        throw InputError({"", 0, 0, key}, fmt::format("{:g} m is not a length of a specimen", value), "a length greater than zero");
    }
}

Outline make_polygon(const OutlineSpec& spec) {
    const std::size_t n = spec.vertices_m.size();
    if (!is_simple_polygon(spec.vertices_m)) {
        throw InputError({"", 0, 0, "specimen.vertices"},
                         fmt::format("the outline of {} vertices crosses or touches itself, or has no area", n),
                         "a simple polygon of at least three different vertices, given once around in either direction");
    }
    if (!spec.edge_labels.empty() && spec.edge_labels.size() != n) {
        throw InputError({"", 0, 0, "specimen.edge_labels"}, fmt::format("{} labels for {} edges", spec.edge_labels.size(), n),
                         "one label an edge, or none at all");
    }
    Outline outline;
    outline.vertices = spec.vertices_m;
    outline.edge_labels = spec.edge_labels;
    if (outline.edge_labels.empty()) {
        for (std::size_t k = 0; k < n; ++k) outline.edge_labels.push_back(fmt::format("edge-{}", k));
    }
    if (signed_area(outline.vertices) < 0.0) {
        // Vertex k becomes vertex n - 1 - k, so edge k (from k to k + 1) becomes edge n - 2 - k, and the last edge stays last.
        std::reverse(outline.vertices.begin(), outline.vertices.end());
        std::reverse(outline.edge_labels.begin(), outline.edge_labels.end() - 1);
    }
    return outline;
}

}  // namespace

Outline make_outline(const OutlineSpec& spec) {
    Outline outline;
    switch (spec.shape) {
        case Shape::rectangle:
            require_length(spec.width_m, "specimen.width");
            require_length(spec.height_m, "specimen.height");
            outline.vertices = {{0.0, 0.0}, {spec.width_m, 0.0}, {spec.width_m, spec.height_m}, {0.0, spec.height_m}};
            outline.edge_labels = {"bottom", "right", "top", "left"};
            outline.area_m2 = spec.width_m * spec.height_m;
            break;
        case Shape::disc:
            require_length(spec.diameter_m, "specimen.diameter");
            outline.is_disc = true;
            outline.radius_m = 0.5 * spec.diameter_m;
            outline.edge_labels = {"circle"};
            outline.area_m2 = std::numbers::pi * outline.radius_m * outline.radius_m;
            break;
        case Shape::polygon:
            outline = make_polygon(spec);
            outline.area_m2 = signed_area(outline.vertices);
            break;
    }
    return outline;
}

Box bounding_box(const Outline& outline) {
    if (!outline.is_disc) return bounding_box(std::span<const Vec2>(outline.vertices));
    const Vec2 half = {outline.radius_m, outline.radius_m};
    return {outline.centre - half, outline.centre + half};
}

bool contains(const Outline& outline, Vec2 point) {
    if (outline.is_disc) return norm(point - outline.centre) <= outline.radius_m;
    return contains(std::span<const Vec2>(outline.vertices), point);
}

double distance_to_boundary(const Outline& outline, Vec2 point) {
    if (outline.is_disc) return std::abs(outline.radius_m - norm(point - outline.centre));
    return distance_to_boundary(std::span<const Vec2>(outline.vertices), point);
}

}  // namespace feldspar
