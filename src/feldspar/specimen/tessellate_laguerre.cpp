#include "feldspar/specimen/tessellate_laguerre.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "feldspar/base/error.hpp"
#include "feldspar/base/sort_in_buckets.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/clip_cells.hpp"
#include "feldspar/specimen/cut_cells.hpp"
#include "feldspar/specimen/join_faces.hpp"
#include "feldspar/specimen/join_pieces.hpp"
#include "feldspar/specimen/merge_edges.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

/// Edges of no length arise where four or more cells meet in a point, as on a lattice: below this share of the mean diameter
/// they are merged in any case.
constexpr double no_length = 1e-9;

Cell make_cell(const Face& face, const std::vector<Vec2>& vertices) {
    const std::size_t n = face.vertices.size();
    std::size_t shortest = 0;
    const auto length = [&](std::size_t k) { return norm(vertices[face.vertices[(k + 1) % n]] - vertices[face.vertices[k]]); };
    for (std::size_t k = 1; k < n; ++k) {
        if (length(k) < length(shortest)) shortest = k;
    }
    Cell cell;
    for (std::vector<int>* list : {&cell.vertices, &cell.neighbours, &cell.outline_edges}) list->reserve(n);
    for (std::size_t step = 0; step < n; ++step) {
        const std::size_t k = (shortest + 1 + step) % n;
        cell.vertices.push_back(face.vertices[k]);
        cell.neighbours.push_back(std::max(-1, face.labels[k]));
        cell.outline_edges.push_back(face.labels[k] < 0 ? -1 - face.labels[k] : -1);
    }
    return cell;
}

}  // namespace

Tessellation tessellate_laguerre(const Packing& packing, const Outline& outline, double merge_length_m,
                                 const StageControl& control) {
    double mean_diameter = 0.0;
    std::vector<double> weights;
    for (const double r : packing.radii_m) {
        weights.push_back(r * r);
        mean_diameter += 2.0 * r / static_cast<double>(packing.radii_m.size());
    }
    CellGraph graph = clip_cells(packing.centres, weights, outline, control);
    if (!outline.is_disc && !is_convex_polygon(outline.vertices)) join_pieces(graph, packing.centres, outline);
    return tessellation_of(std::move(graph), outline, mean_diameter, merge_length_m);
}

Tessellation tessellation_of(CellGraph graph, const Outline& outline, double mean_diameter, double merge_length_m) {
    Tessellation result;
    const double least_length = std::max(merge_length_m, no_length * mean_diameter);
    if (!outline.cutouts.empty()) {
        result.merged_edges = merge_short_edges(graph, outline, no_length * mean_diameter);  // edges are cut that have a length
        CutCells cut = cut_cells(graph, outline, mean_diameter, least_length);
        result.disc_of_cell = std::move(cut.disc);
        result.reshaped = std::move(cut.reshaped);
        result.joined_pieces = cut.joined;
    }
    result.merged_edges += merge_short_edges(graph, outline, least_length);
    drop_unused_vertices(graph);
    result.vertices = std::move(graph.vertices);
    result.cells.reserve(graph.faces.size());
    for (Face& face : graph.faces) {
        result.cells.push_back(make_cell(face, result.vertices));
        face = {};  // its memory is enough for the next
    }
    if (!outline.cutouts.empty()) result.crossings = join_faces(result, outline, 0.5 * least_length);
    check_conforming(result);
    return result;
}

std::vector<Vec2> corners_of_cell(const Tessellation& cells, int cell) {
    std::vector<Vec2> corners;
    corners.reserve(cells.cells[cell].vertices.size());
    for (const int v : cells.cells[cell].vertices) corners.push_back(cells.vertices[v]);
    return corners;
}

void check_conforming(const Tessellation& cells) {
    struct Side {
        int low, high, cell, neighbour;
        bool forward;
    };
    std::vector<Side> sides;
    std::size_t count = 0;
    for (const Cell& cell : cells.cells) count += cell.vertices.size();
    sides.reserve(count);
    for (int i = 0; i < std::ssize(cells.cells); ++i) {
        const Cell& cell = cells.cells[i];
        const std::size_t n = cell.vertices.size();
        for (std::size_t k = 0; k < n; ++k) {
            const int a = cell.vertices[k], b = cell.vertices[(k + 1) % n];
            sides.push_back({std::min(a, b), std::max(a, b), i, cell.neighbours[k], a < b});
        }
    }
    sort_in_buckets(
        sides, cells.vertices.size(), [](const Side& side) { return side.low; },
        [](const Side& l, const Side& r) { return std::tie(l.high, l.forward, l.cell) < std::tie(r.high, r.forward, r.cell); });
    for (std::size_t k = 0; k < sides.size();) {
        std::size_t end = k + 1;
        while (end < sides.size() && sides[end].low == sides[k].low && sides[end].high == sides[k].high) ++end;
        const Side& first = sides[k];
        const bool outline_edge = end - k == 1 && first.neighbour < 0;
        const bool shared = end - k == 2 && first.forward != sides[k + 1].forward && first.neighbour == sides[k + 1].cell &&
                            sides[k + 1].neighbour == first.cell;
        if (!outline_edge && !shared) {
            throw NumericalError(
                fmt::format("the cells do not fit together: an edge of cell {} is named by {} cells", first.cell, end - k));
        }
        k = end;
    }
}

}  // namespace feldspar
