// In a non-convex outline: the pieces of a cell become one again, and stray pieces go to a neighbour.
#pragma once

#include <span>

#include "feldspar/specimen/cell_graph.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Joins the faces that clip_cells made region by region. A cell keeps the piece that holds its site (the largest, if none
/// does); a piece that the outline has cut off goes to the neighbour with which it shares the longest boundary. Afterwards
/// there is one face a cell, in the cells' order, the labels name the neighbours, and the cuts and their vertices are gone.
/// @throws InputError if a piece borders on no other cell: the outline is too narrow for the grains there
void join_pieces(CellGraph& graph, std::span<const Vec2> centres, const Outline& outline);

}  // namespace feldspar
