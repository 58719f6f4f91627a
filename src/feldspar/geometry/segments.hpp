// Two plane segments against each other. Pure geometry in any length unit.
#pragma once

#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// Do the segments a-b and c-d cross in a point inside both? Segments that only touch, or that lie on one line, do not.
bool segments_cross(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

/// Least distance of the segments a-b and c-d, in the unit of the coordinates; 0 where they cross.
double distance_between_segments(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

}  // namespace feldspar
