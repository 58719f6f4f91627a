// Small discs inside the grains, for models whose grains deform through contacts instead of triangles.
#pragma once

#include <cstdint>

#include "feldspar/specimen/specimen.hpp"
#include "feldspar/specimen/stage_control.hpp"

namespace feldspar {

/// Fills every cell with nearly equal discs: one in each corner, rows along the edges, and the rest inside. Corner discs have
/// the common diameter for which the grains hold `particles_per_grain` on average, the others up to 15 % more or less, as they
/// find room; only a grain too small for three of them gets smaller ones. Neighbouring discs of a grain are in contact, and so
/// are the rows on the two sides of an edge. Each grain places its discs for itself, so that facing rows are no mirror images.
/// Theory: specimen.md, section 6. Source: the paper, section 3.1 and figure 5e,f. Same input, same bits, for any number of
/// threads.
/// @param particles_per_grain  mean over the grains, from 7 to 500; with some tens, the total comes within 0.1 % of it
Filling fill_grains(const Tessellation& cells, double particles_per_grain, std::uint64_t seed, const StageControl& control = {});

}  // namespace feldspar
