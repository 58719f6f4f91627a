#include "feldspar/specimen/place_labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"

namespace feldspar {
namespace {

/// How far (m) a point is from where the label holds; 0 there.
double distance_to_place(const PlaceLabelSpec& label, Vec2 p) {
    switch (label.kind) {
        case PlaceKind::disc:
            return std::max(0.0, norm(p - label.a_m) - label.within_m);
        case PlaceKind::line:
            return std::max(0.0, distance_to_segment(p, label.a_m, label.b_m) - label.within_m);
        case PlaceKind::box:
            break;
    }
    const Vec2 lower = {std::min(label.a_m.x, label.b_m.x), std::min(label.a_m.y, label.b_m.y)},
               upper = {std::max(label.a_m.x, label.b_m.x), std::max(label.a_m.y, label.b_m.y)};
    return norm(p - Vec2{std::clamp(p.x, lower.x, upper.x), std::clamp(p.y, lower.y, upper.y)});
}

std::string described(const PlaceLabelSpec& label) {
    const auto point = [](Vec2 p) { return fmt::format("({:.6g}, {:.6g}) mm", 1e3 * p.x, 1e3 * p.y); };
    switch (label.kind) {
        case PlaceKind::disc:
            return fmt::format("within {:.4g} mm of {}", 1e3 * label.within_m, point(label.a_m));
        case PlaceKind::line:
            return fmt::format("within {:.4g} mm of the line from {} to {}", 1e3 * label.within_m, point(label.a_m),
                               point(label.b_m));
        case PlaceKind::box:
            break;
    }
    return fmt::format("in the box from {} to {}", point(label.a_m), point(label.b_m));
}

}  // namespace

void label_by_place(Outline& outline, Tessellation& cells, const OutlineSpec& spec) {
    for (const PlaceLabelSpec& label : spec.labels) {
        const int number = static_cast<int>(outline.edge_labels.size());
        outline.edge_labels.push_back(label.name);
        bool caught = false;
        double nearest = std::numeric_limits<double>::infinity();
        Vec2 nearest_middle;
        std::string nearest_label;
        for (Cell& cell : cells.cells) {
            for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
                if (cell.neighbours[k] >= 0) continue;
                const Vec2 middle =
                    0.5 * (cells.vertices[cell.vertices[k]] + cells.vertices[cell.vertices[(k + 1) % cell.vertices.size()]]);
                const double distance = distance_to_place(label, middle);
                if (distance < nearest) {
                    nearest = distance;
                    nearest_middle = middle;
                    nearest_label = outline.edge_labels[cell.outline_edges[k]];
                }
                if (distance > 0.0) continue;
                cell.outline_edges[k] = number;
                caught = true;
            }
        }
        if (caught) continue;
        throw InputError(
            {"", 0, 0, "specimen.labels"},
            fmt::format("the label \"{}\" catches no edge on the boundary: none has its middle {}", label.name, described(label)),
            "a place at the boundary, a grain wide or more",
            fmt::format("the nearest is {:.3g} mm away, at ({:.6g}, {:.6g}) mm, labelled \"{}\"", 1e3 * nearest,
                        1e3 * nearest_middle.x, 1e3 * nearest_middle.y, nearest_label));
    }
}

}  // namespace feldspar
