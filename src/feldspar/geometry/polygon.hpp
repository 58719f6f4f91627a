// Plane polygons and segments: area, centroid, simplicity, point location, distance. Pure geometry in any length unit.
#pragma once

#include <span>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// Signed area, positive when the vertices run counter-clockwise. Zero for fewer than three vertices.
double signed_area(std::span<const Vec2> polygon);

/// Centroid of the area. The polygon must have a non-zero area; with none, the mean of the vertices is returned.
Vec2 centroid(std::span<const Vec2> polygon);

/// True if the closed polygon has at least three vertices, a non-zero area, and no two edges that cross, touch or overlap
/// except at the vertex that neighbours share. A vertex in the middle of a straight side is allowed, a spike is not.
/// Contacts closer than 1e-12 of the polygon's size count as touching. All pairs of edges: O(n^2).
bool is_simple_polygon(std::span<const Vec2> polygon);

/// True if `point` lies inside the simple polygon (either orientation). On the boundary the answer may be either.
bool contains(std::span<const Vec2> polygon, Vec2 point);

/// The point of the segment a-b that is closest to `point`.
Vec2 closest_on_segment(Vec2 point, Vec2 a, Vec2 b);

/// Distance from `point` to the segment a-b, in the unit of the coordinates.
double distance_to_segment(Vec2 point, Vec2 a, Vec2 b);

/// Distance from `point` to the nearest edge of the polygon: the same inside and outside, never negative.
double distance_to_boundary(std::span<const Vec2> polygon, Vec2 point);

/// True if no corner of the counter-clockwise polygon turns to the right by more than round-off (1e-12 of the edges' product).
bool is_convex_polygon(std::span<const Vec2> polygon);

/// An axis-parallel box.
struct Box {
    Vec2 lower;
    Vec2 upper;
};

/// Smallest box around the points. There must be at least one.
Box bounding_box(std::span<const Vec2> points);

}  // namespace feldspar
