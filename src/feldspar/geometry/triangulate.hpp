// Triangulations and convex partition, by CGAL, behind plain arrays: the only place that includes CGAL.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// A weighted Delaunay triangulation: the dual of the Laguerre (power) diagram.
struct RegularTriangulation {
    std::vector<std::array<int, 3>> triangles;  ///< site numbers, counter-clockwise
    std::vector<int> hidden;                    ///< sites whose Laguerre cell is empty, ascending
};

/// Regular triangulation with exact predicates.
/// @param sites    at least three, not all on a line, no two exactly equal (equal ones count as hidden)
/// @param weights  one a site: the squared radius for a Laguerre tessellation of discs (the unit of the coordinates, squared)
RegularTriangulation regular_triangulation(std::span<const Vec2> sites, std::span<const double> weights);

/// Splits a simple counter-clockwise polygon into convex polygons without adding points; at most four times as many as needed.
/// Vertices on a straight side stay vertices of the part that has them.
/// @returns the parts as vertex numbers, counter-clockwise
std::vector<std::vector<int>> convex_partition(std::span<const Vec2> polygon);

/// Constrained Delaunay triangulation of a simple counter-clockwise polygon with points inside it.
/// @param points          first the polygon's vertices in order, then the interior points; all distinct
/// @param boundary_count  how many of them are the polygon's vertices
/// @returns the triangles inside the polygon, counter-clockwise; no node is added, so each edge of the polygon has one triangle
std::vector<std::array<int, 3>> triangulate_polygon(std::span<const Vec2> points, int boundary_count);

}  // namespace feldspar
