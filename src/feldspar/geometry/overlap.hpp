// How much of a polygon lies in a convex one.
#pragma once

#include <span>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// Area that a polygon shares with a convex one; both counter-clockwise, the first one simple. In the square of the coordinates' unit.
double overlap_area(std::span<const Vec2> polygon, std::span<const Vec2> convex);

}  // namespace feldspar
