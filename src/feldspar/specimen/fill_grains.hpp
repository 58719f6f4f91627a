// Small discs inside the grains, for models whose grains deform through contacts instead of triangles.
#pragma once

#include <cstdint>

#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Fills every cell with discs of one diameter: a disc in each corner, rows of discs along the edges, and the rest inside.
/// The diameter is the one for which a grain of mean area holds `particles_per_grain` discs; only in a grain too small for
/// three of them are they smaller. Neighbouring discs of a grain are in contact, and so are the rows on the two sides of an
/// edge. Each grain places its discs for itself, so that facing rows do not mirror each other.
/// Source: M. Azevedo et al. 2022, section 3.1 and figure 5e,f. Same input, same bits.
/// @param particles_per_grain  mean over the grains; the total comes within a few discs of it
Filling fill_grains(const Tessellation& cells, double particles_per_grain, std::uint64_t seed);

}  // namespace feldspar
