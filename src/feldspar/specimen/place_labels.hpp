// Labels by place: for the edges of cells on the boundary.
#pragma once

#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Appends the names to the outline's labels and gives them to the cell edges on the boundary whose middle lies at the place; a
/// later label overrides an earlier one.
/// @throws InputError for a label that catches no edge: it says where the nearest is
void label_by_place(Outline& outline, Tessellation& cells, const OutlineSpec& spec);

}  // namespace feldspar
