// Even packing of discs inside the ring of one grain, by repulsion.
#pragma once

#include <span>

#include "feldspar/base/rng.hpp"
#include "feldspar/specimen/grain_ring.hpp"

namespace feldspar {

/// Adds `count` discs inside the ring, each where there is most room among some random places. They stand after the ring's.
/// @param corners  the cell, counter-clockwise
void add_inner_discs(GrainRing& ring, std::span<const Vec2> corners, int count, RandomStream& random);

/// Lets all discs settle: those that overlap push each other apart, inner discs move freely, edge discs along their edge, corner
/// discs not at all. Minimised as in relax_discs. Inner and edge discs grow or shrink, by 15 % at most, until their neighbours
/// just hold them. An inner disc that overlaps another too much is put elsewhere; one that finds no place is taken away again,
/// and so is an edge disc in the way.
/// @param corners  the cell, counter-clockwise
/// @returns true if discs were put elsewhere, for which numbers of the stream were used
bool settle_discs(GrainRing& ring, std::span<const Vec2> corners, RandomStream& random);

}  // namespace feldspar
