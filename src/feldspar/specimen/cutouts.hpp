// Holes and notches: from the user's words to polygons and cuts, checked against the outline, the grains and each other.
#pragma once

#include <span>
#include <vector>

#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Adds the holes and notches of the spec to an outline that has none yet, with their labels, and takes their area off.
/// @throws InputError as make_outline
void add_cutouts(Outline& outline, const OutlineSpec& spec, const GrainScale& grains);

/// Corners (m) of a polygon for an arc, the first at angle `from` and the last at angle `to` (rad), both on the circle.
std::vector<Vec2> arc_corners(Vec2 centre, double radius_m, double from_rad, double to_rad, int edges);

/// Lengths (m) on the horizontal line at `y`: of the polygon's inside without that of the cutouts that are no cuts.
double width_at(std::span<const Vec2> corners, std::span<const Cutout> cutouts, double y);

}  // namespace feldspar
