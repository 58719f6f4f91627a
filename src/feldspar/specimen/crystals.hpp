// Crystals of several cells each: the second level of a tessellation.
#pragma once

#include <vector>

#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Gives each cell to the crystal in whose Laguerre cell its centroid lies. @param crystals  discs, one a crystal
/// @return of each cell its crystal, numbered from 0 on without gaps, in the order of their first cells
std::vector<int> group_into_crystals(const Tessellation& cells, const Packing& crystals);

}  // namespace feldspar
