// A plate with a round hole: where the hole is, and the names of what is read at its edge.
#pragma once

#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// The hole of a plate that is loaded along y: its sides lie to the left and right, its poles above and below.
struct RoundHole {
    Vec2 centre;  ///< m
    double radius_m = 0.0;
};

/// The hole of a plate. @throws InputError  if the outline is no rectangle with one round hole and nothing else cut out, or if
/// rock is missing within a radius of the hole's edge, where the stress around it is read
RoundHole round_hole_of(const Outline& outline);

/// Gauges of the stress along the edge of the hole, means of both sides and of both poles.
inline constexpr const char* side_stress_gauge = "side-stress";
inline constexpr const char* pole_stress_gauge = "pole-stress";

}  // namespace feldspar
