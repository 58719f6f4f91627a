// Cuts whose faces stay in contact: the cells on both sides become neighbours again, on a line that is exactly straight.
#pragma once

#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Makes the cells along the two faces of each joined cut neighbours. Where a vertex lies on one face only, the other gets it;
/// vertices that are nearer to each other than `snap_m` become one. Where cuts cross, or one ends on another, all cells around
/// the place share one vertex there.
/// @return how many such places there are
int join_faces(Tessellation& cells, const Outline& outline, double snap_m);

}  // namespace feldspar
