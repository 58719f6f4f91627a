// From the user's outline to one that is ready for use: counter-clockwise, labelled, checked.
#pragma once

#include <vector>

#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Checks the spec and makes the outline. Rectangle: [0, width] x [0, height], edges bottom, right, top, left. Disc: centre
/// (0, 0). Polygon: turned counter-clockwise where needed, each label staying with its edge.
/// @throws InputError for lengths that are not positive, a polygon that crosses or touches itself, a wrong number of labels
Outline make_outline(const OutlineSpec& spec);

/// Smallest box around the outline.
Box bounding_box(const Outline& outline);

/// True if `point` lies inside; on the boundary either.
bool contains(const Outline& outline, Vec2 point);

/// Distance from `point` to the boundary (m), never negative.
double distance_to_boundary(const Outline& outline, Vec2 point);

}  // namespace feldspar
