// Even packing of discs inside the ring of one grain, by repulsion.
#pragma once

#include <span>

#include "feldspar/base/rng.hpp"
#include "feldspar/specimen/grain_ring.hpp"

namespace feldspar {

/// Adds `count` discs inside the ring, each where there is most room among some random places, and lets all settle: discs
/// that overlap push each other apart, inner discs move freely, edge discs along their edge, corner discs not at all.
/// Minimised as in relax_discs. The inner discs, all of one size, grow or shrink (by 15 % at most) until they fill the room
/// without much overlap. A disc that still overlaps too much is taken away again.
/// The inner discs stand after the ring's; an edge disc may be taken away too, so the rows are renumbered.
/// @param corners  the cell, counter-clockwise
void fill_ring(GrainRing& ring, std::span<const Vec2> corners, int count, RandomStream& random);

}  // namespace feldspar
