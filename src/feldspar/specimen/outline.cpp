#include "feldspar/specimen/outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "feldspar/base/angle.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/specimen/cutouts.hpp"
#include "feldspar/specimen/grain_sizes.hpp"

namespace feldspar {
namespace {

void require_length(double value, const char* key) {
    if (!(value > 0.0) || !std::isfinite(value)) {
        throw InputError({"", 0, 0, key}, fmt::format("{:g} m is not a length of a specimen", value),
                         "a length greater than zero");
    }
}

struct Extremes {
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
};

/// Between two heights. The width is linear between the heights of two vertices, so its extremes are there.
Extremes extreme_widths(const Outline& outline, double low, double high) {
    std::vector<double> levels = {low, high};
    const auto note = [&](const std::vector<Vec2>& corners) {
        for (const Vec2 corner : corners) {
            if (corner.y > low && corner.y < high) levels.push_back(corner.y);
        }
    };
    note(outline.vertices);
    for (const Cutout& cutout : outline.cutouts) note(cutout.vertices);
    std::sort(levels.begin(), levels.end());
    Extremes extremes;
    for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
        const double height = levels[i + 1] - levels[i];
        if (!(height > 1e-9 * (high - low))) continue;
        const double third = width_at(outline.vertices, outline.cutouts, levels[i] + height / 3.0),
                     two_thirds = width_at(outline.vertices, outline.cutouts, levels[i] + 2.0 * height / 3.0);
        for (const double width : {2.0 * third - two_thirds, 2.0 * two_thirds - third}) {
            extremes.least = std::min(extremes.least, std::max(0.0, width));
            extremes.most = std::max(extremes.most, width);
        }
    }
    return extremes;
}

std::string in_mm(Vec2 a, Vec2 b) {
    return fmt::format("from ({:.4g}, {:.4g}) to ({:.4g}, {:.4g}) mm", 1e3 * a.x, 1e3 * a.y, 1e3 * b.x, 1e3 * b.y);
}

[[noreturn]] void refuse_arc(const ArcSpec& arc, const char* what, const char* allowed) {
    throw InputError({"", 0, 0, "specimen.arcs"}, fmt::format("the arc of edge {} {}", arc.edge, what), allowed);
}

/// Corners of an arc from `from` to `to`, both left out.
std::vector<Vec2> corners_between(const ArcSpec& arc, Vec2 from, Vec2 to, const GrainScale& grains) {
    const Vec2 a = arc.through_m - from, b = to - from;
    const double twice = 2.0 * cross(a, b), chord = norm(b);
    constexpr double kFlat = 1e-6;  // of the chord: from there on the circle is larger than any specimen
    if (!(std::abs(twice) > 2.0 * kFlat * chord * chord))
        refuse_arc(arc, "goes through a point on the straight edge", "a point beside the edge, through which the arc goes");
    const Vec2 centre = from + (1.0 / twice) * Vec2{b.y * dot(a, a) - a.y * dot(b, b), a.x * dot(b, b) - b.x * dot(a, a)};
    const double radius = norm(from - centre), pi = std::numbers::pi;
    const auto angle = [&](Vec2 p) { return std::atan2(p.y - centre.y, p.x - centre.x); };
    const auto turn = [&](double to_rad) { return to_rad - std::floor(to_rad / (2.0 * pi)) * 2.0 * pi; };
    const double begin = angle(from), through = turn(angle(arc.through_m) - begin), whole = turn(angle(to) - begin);
    const double swept = through < whole ? whole : whole - 2.0 * pi;  // the way round on which the point lies
    const int edges = std::max(2, static_cast<int>(std::lround(arc_edges(radius, grains.mean_m) * std::abs(swept) / (2.0 * pi))));
    std::vector<Vec2> corners = arc_corners(centre, radius, begin, begin + swept, edges);
    return {corners.begin() + 1, corners.end() - 1};
}

/// Puts the corners of the arcs between the vertices; every piece of an arc has the label of its edge.
void bend_edges(Outline& outline, const std::vector<ArcSpec>& arcs, const GrainScale& grains) {
    const auto n = static_cast<int>(outline.vertices.size());
    std::vector<const ArcSpec*> of_edge(outline.vertices.size(), nullptr);
    for (const ArcSpec& arc : arcs) {
        if (arc.edge < 0 || arc.edge >= n) refuse_arc(arc, "is on no edge", "edges from 0 on, one a vertex");
        if (of_edge[static_cast<std::size_t>(arc.edge)] != nullptr) refuse_arc(arc, "is given twice", "one arc an edge");
        of_edge[static_cast<std::size_t>(arc.edge)] = &arc;
    }
    std::vector<Vec2> vertices;
    std::vector<std::string> labels;
    for (std::size_t k = 0; k < of_edge.size(); ++k) {
        const std::string& label = outline.edge_labels[k];
        const Vec2 from = outline.vertices[k];
        vertices.push_back(from);
        labels.push_back(label);
        if (of_edge[k] == nullptr) continue;
        if (label == top_label || label == bottom_label)
            refuse_arc(*of_edge[k], "is labelled as an end that platens press on, which is flat", "another label");
        for (const Vec2 corner : corners_between(*of_edge[k], from, outline.vertices[(k + 1) % of_edge.size()], grains)) {
            vertices.push_back(corner);
            labels.push_back(label);
        }
    }
    if (!is_simple_polygon(vertices))
        throw InputError({"", 0, 0, "specimen.arcs"}, "an arc crosses or touches the rest of the outline",
                         "arcs that bulge less, or to the other side");
    outline.vertices = std::move(vertices);
    outline.edge_labels = std::move(labels);
}

Outline make_polygon(const OutlineSpec& spec, const GrainScale& grains) {
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
    if (const auto fault = end_fault(spec))
        throw InputError({"", 0, 0, "specimen.edge_labels"}, fault->problem, fault->allowed, fault->suggestion);
    Outline outline;
    outline.vertices = spec.vertices_m;
    outline.edge_labels = spec.edge_labels;
    if (outline.edge_labels.empty()) {
        for (std::size_t k = 0; k < n; ++k) outline.edge_labels.push_back(fmt::format("edge-{}", k));
    }
    if (!spec.arcs.empty()) bend_edges(outline, spec.arcs, grains);
    if (signed_area(outline.vertices) < 0.0) {
        // Of n vertices, vertex k becomes n - 1 - k, so edge k (from k to k + 1) becomes edge n - 2 - k, and the last edge stays
        // last.
        std::reverse(outline.vertices.begin(), outline.vertices.end());
        std::reverse(outline.edge_labels.begin(), outline.edge_labels.end() - 1);
    }
    return outline;
}

/// Cuts the two flats: a segment of the circle is gone at the top and one at the bottom.
void flatten(Outline& outline, double angle_rad) {
    if (!(angle_rad > 0.0) || !(angle_rad < std::numbers::pi))
        throw InputError({"", 0, 0, "test.flat_angle"},
                         fmt::format("{:g} degrees is no angle of two flats", in_degrees(angle_rad)),
                         "greater than 0 and less than 180 degrees");
    outline.flat_height_m = outline.radius_m * std::cos(0.5 * angle_rad);
    outline.edge_labels = {"circle", top_label, bottom_label};
    outline.area_m2 -= outline.radius_m * outline.radius_m * (angle_rad - std::sin(angle_rad));
}

/// The arc's edges are odd in number: one lies across its middle, where it is loaded.
void make_half_disc(Outline& outline, double radius_m, const GrainScale& grains) {
    const int edges = arc_edges(radius_m, grains.mean_m) / 2 + (arc_edges(radius_m, grains.mean_m) / 2 + 1) % 2;
    outline.radius_m = radius_m;
    outline.vertices = arc_corners({0.0, 0.0}, radius_m, 0.0, std::numbers::pi, edges);
    outline.vertices.front() = {radius_m, 0.0};
    outline.vertices.back() = {-radius_m, 0.0};
    std::rotate(outline.vertices.begin(), outline.vertices.end() - 1, outline.vertices.end());
    outline.edge_labels.assign(outline.vertices.size(), "arc");
    outline.edge_labels.front() = "flat";
    outline.area_m2 = signed_area(outline.vertices);
}

}  // namespace

std::array<Vec2, 4> flat_corners(const Outline& outline) {
    const double height = outline.flat_height_m,
                 half = std::sqrt(std::max(0.0, outline.radius_m * outline.radius_m - height * height));
    return {outline.centre + Vec2{-half, height}, outline.centre + Vec2{half, height}, outline.centre + Vec2{-half, -height},
            outline.centre + Vec2{half, -height}};
}

std::optional<EndFault> end_fault(const OutlineSpec& spec) {
    const std::vector<Vec2>& corners = spec.vertices_m;
    const int n = static_cast<int>(corners.size());
    if (spec.edge_labels.size() != corners.size()) return {};
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double lowest_top = infinity, highest_bottom = -infinity, mean_top = 0.0, mean_bottom = 0.0;
    int first_top = -1, first_bottom = -1, tops = 0, bottoms = 0;
    for (int k = 0; k < n; ++k) {
        const Vec2 a = corners[k], b = corners[(k + 1) % n];
        if (spec.edge_labels[k] == top_label) {
            if (first_top < 0) first_top = k;
            lowest_top = std::min({lowest_top, a.y, b.y});
            mean_top += 0.5 * (a.y + b.y);
            ++tops;
        } else if (spec.edge_labels[k] == bottom_label) {
            if (first_bottom < 0) first_bottom = k;
            highest_bottom = std::max({highest_bottom, a.y, b.y});
            mean_bottom += 0.5 * (a.y + b.y);
            ++bottoms;
        }
    }
    if (first_top < 0 || first_bottom < 0) return {};
    const std::string allowed =
        "\"top\" on the upper end and \"bottom\" on the lower one, both within 10 degrees of horizontal; y points up, and the "
        "load acts along it";
    constexpr double least_cosine = 0.984807753012208;  // of 10 degrees
    const double turn = signed_area(corners) > 0.0 ? 1.0 : -1.0;
    for (int k = 0; k < n; ++k) {
        const bool top = spec.edge_labels[k] == top_label;
        if (!top && spec.edge_labels[k] != bottom_label) continue;
        const Vec2 a = corners[k], b = corners[(k + 1) % n];
        if (std::abs(b.x - a.x) < least_cosine * norm(b - a)) {
            const double slope = in_degrees(std::atan2(std::abs(b.y - a.y), std::abs(b.x - a.x)));
            return EndFault{k,
                            fmt::format("the edge labelled \"{}\", {}, is {:.0f} degrees from horizontal", spec.edge_labels[k],
                                        in_mm(a, b), slope),
                            allowed,
                            "turn the outline so that the load acts along y, or label the horizontal ends; edge i runs from "
                            "vertex i to vertex i + 1"};
        }
    }
    if (mean_top / tops < mean_bottom / bottoms)
        return EndFault{first_top, "the label \"top\" lies below \"bottom\"", allowed,
                        "exchange the labels \"top\" and \"bottom\""};
    for (int k = 0; k < n; ++k) {
        const bool top = spec.edge_labels[k] == top_label;
        if (!top && spec.edge_labels[k] != bottom_label) continue;
        const Vec2 a = corners[k], b = corners[(k + 1) % n];
        if ((turn * (b.x - a.x) < 0.0) !=
            top)  // counter-clockwise, the rock lies left of an edge: under one that runs to the left
            return EndFault{k,
                            fmt::format("the edge labelled \"{}\", {}, has the rock {} it", spec.edge_labels[k], in_mm(a, b),
                                        top ? "above" : "below"),
                            allowed, "label the other side; edge i runs from vertex i to vertex i + 1"};
    }
    if (!(lowest_top > highest_bottom))
        return EndFault{first_top, "an edge labelled \"top\" does not lie above every edge labelled \"bottom\"", allowed,
                        "label one end with each"};
    return {};
}

SectionWidths section_widths(const Outline& outline) {
    if (outline.is_disc) return {};
    const Box box = bounding_box(outline);
    double low = box.lower.y, high = box.upper.y;
    for (std::size_t k = 0; k < outline.vertices.size(); ++k) {
        const double a = outline.vertices[k].y, b = outline.vertices[(k + 1) % outline.vertices.size()].y;
        if (outline.edge_labels[k] == bottom_label) low = std::max({low, a, b});
        if (outline.edge_labels[k] == top_label) high = std::min({high, a, b});
    }
    if (!(high > low)) return {};
    const Extremes all = extreme_widths(outline, low, high);
    const double middle = 0.5 * (box.lower.y + box.upper.y), quarter = 0.25 * (box.upper.y - box.lower.y);
    const Extremes gauge = extreme_widths(outline, std::max(low, middle - quarter), std::min(high, middle + quarter));
    return {all.least, all.most, gauge.least, gauge.most};
}

Outline make_outline(const OutlineSpec& spec, const GrainScale& grains) {
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
            if (spec.flat_angle_rad != 0.0) flatten(outline, spec.flat_angle_rad);
            break;
        case Shape::polygon:
            outline = make_polygon(spec, grains);
            outline.area_m2 = signed_area(outline.vertices);
            break;
        case Shape::half_disc:
            require_length(spec.diameter_m, "specimen.diameter");
            make_half_disc(outline, 0.5 * spec.diameter_m, grains);
            break;
        case Shape::ring:
            require_length(spec.diameter_m, "specimen.diameter");
            require_length(spec.hole_diameter_m, "specimen.hole_diameter");
            if (!(spec.hole_diameter_m < spec.diameter_m))
                throw InputError({"", 0, 0, "specimen.hole_diameter"}, "the hole of the ring is not smaller than the ring",
                                 "less than the diameter");
            outline.is_disc = true;
            outline.radius_m = 0.5 * spec.diameter_m;
            outline.edge_labels = {"circle"};
            outline.area_m2 = std::numbers::pi * outline.radius_m * outline.radius_m;
            break;
    }
    add_cutouts(outline, spec, grains);
    return outline;
}

Outline make_outline(const SpecimenSpec& spec) {
    if (!spec.outline.is_cut() && spec.outline.shape != Shape::half_disc && spec.outline.arcs.empty())
        return make_outline(spec.outline);
    const GrainSizeSpec& sizes = spec.grain_sizes;
    if (spec.given_cells.given())
        return make_outline(spec.outline, {spec.given_cells.cells->mean_diameter_m, spec.given_cells.cells->largest_diameter_m});
    return make_outline(spec.outline, {counting_diameter(sizes),
                                       sizes.kind == GrainSizeKind::sieve ? largest_of_sieve_m(sizes.sieve) : sizes.maximum_m});
}

int arc_edges(double radius_m, double mean_grain_m) {
    constexpr int least = 24, most = 3600;  // multiples of four: an edge across each axis
    if (!(mean_grain_m > 0.0)) return least;
    return std::clamp(4 * static_cast<int>(std::ceil(0.5 * std::numbers::pi * std::min(radius_m / mean_grain_m, 1e4))), least,
                      most);
}

double packed_area_m2(const Outline& outline) {
    double area = outline.area_m2;
    for (const Cutout& cutout : outline.cutouts) {
        if (!cutout.packed_around) area += cutout.area_m2;
    }
    return area;
}

OutlineSpec scaled(const OutlineSpec& spec, double factor) {
    OutlineSpec result = spec;
    const auto scale = [factor](std::vector<Vec2>& points) {
        for (Vec2& p : points) p = {p.x * factor, p.y * factor};
    };
    for (double* length : {&result.width_m, &result.height_m, &result.diameter_m, &result.hole_diameter_m}) *length *= factor;
    scale(result.vertices_m);
    for (ArcSpec& arc : result.arcs) arc.through_m = factor * arc.through_m;
    for (HoleSpec& hole : result.holes) {
        hole.centre_m *= factor;
        hole.diameter_m *= factor;
        scale(hole.vertices_m);
    }
    for (NotchSpec& notch : result.notches) {
        notch.from_m *= factor;
        notch.to_m *= factor;
        notch.width_m *= factor;
    }
    for (PlaceLabelSpec& label : result.labels) {
        label.a_m *= factor;
        label.b_m *= factor;
        label.within_m *= factor;
    }
    return result;
}

Box bounding_box(const OutlineSpec& spec) {
    const double radius = 0.5 * spec.diameter_m;
    switch (spec.shape) {
        case Shape::rectangle:
            return {{0.0, 0.0}, {spec.width_m, spec.height_m}};
        case Shape::polygon:
            return spec.arcs.empty() ? bounding_box(std::span<const Vec2>(spec.vertices_m)) : bounding_box(make_outline(spec));
        case Shape::half_disc:
            return {{-radius, 0.0}, {radius, radius}};
        case Shape::disc:
        case Shape::ring:
            break;
    }
    return {{-radius, -radius}, {radius, radius}};
}

Box bounding_box(const Outline& outline) {
    if (!outline.is_disc) return bounding_box(std::span<const Vec2>(outline.vertices));
    const Vec2 half = {outline.radius_m, outline.flattened() ? outline.flat_height_m : outline.radius_m};
    return {outline.centre - half, outline.centre + half};
}

namespace {

bool contains_uncut(const Outline& outline, Vec2 point) {
    if (outline.flattened() && std::abs(point.y - outline.centre.y) > outline.flat_height_m) return false;
    if (outline.is_disc) return norm(point - outline.centre) <= outline.radius_m;
    return contains(std::span<const Vec2>(outline.vertices), point);
}

double distance_uncut(const Outline& outline, Vec2 point) {
    if (outline.flattened()) {
        const auto corners = flat_corners(outline);
        const double to_flats =
            std::min(distance_to_segment(point, corners[0], corners[1]), distance_to_segment(point, corners[2], corners[3]));
        const Vec2 out = point - outline.centre;  // the arcs are nearest along the radius, where they have not been cut off
        const bool faces_arc = std::abs(out.y) * outline.radius_m <= outline.flat_height_m * norm(out);
        return faces_arc ? std::min(to_flats, std::abs(outline.radius_m - norm(out))) : to_flats;
    }
    if (outline.is_disc) return std::abs(outline.radius_m - norm(point - outline.centre));
    return distance_to_boundary(std::span<const Vec2>(outline.vertices), point);
}

}  // namespace

bool contains(const Outline& outline, Vec2 point) {
    return contains_uncut(outline, point) &&
           std::none_of(outline.cutouts.begin(), outline.cutouts.end(), [&](const Cutout& cutout) {
               return cutout.packed_around && contains(std::span<const Vec2>(cutout.vertices), point);
           });
}

double distance_to_boundary(const Outline& outline, Vec2 point) {
    double least = distance_uncut(outline, point);
    for (const Cutout& cutout : outline.cutouts) {
        if (cutout.packed_around) least = std::min(least, distance_to_boundary(std::span<const Vec2>(cutout.vertices), point));
    }
    return least;
}

}  // namespace feldspar
