// How much of a polygon lies in a convex one.
#pragma once

#include <span>
#include <vector>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// What of a polygon lies in a convex one; both counter-clockwise, the first one simple. A polygon that falls apart keeps edges
/// of no width between its pieces, which add no area; empty if nothing is left.
std::vector<Vec2> clipped(std::span<const Vec2> polygon, std::span<const Vec2> convex);

/// Area that a polygon shares with a convex one; both counter-clockwise, the first one simple. In the square of the coordinates'
/// unit.
double overlap_area(std::span<const Vec2> polygon, std::span<const Vec2> convex);

}  // namespace feldspar
