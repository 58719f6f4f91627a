// In a non-convex outline: the pieces of a cell become one again, and stray pieces go to a neighbour.
#pragma once

#include <span>
#include <vector>

#include "feldspar/specimen/cell_graph.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Joins the faces that clip_cells made region by region. A cell keeps the piece that holds its site (the largest, if none
/// does); a piece that the outline has cut off goes to the neighbour with which it shares the longest boundary. Afterwards
/// there is one face a cell, in the cells' order, the labels name the neighbours, and the cuts and their vertices are gone.
/// @throws InputError if a piece borders on no other cell: the outline is too narrow for the grains there
void join_pieces(CellGraph& graph, std::span<const Vec2> centres, const Outline& outline);

/// Faces of one cell put together: edges that occur in both directions go, the rest is traced into closed chains.
std::vector<Face> united(const std::vector<Face>& pieces, int cell, const std::vector<Vec2>& vertices);

/// Labels from the faces themselves: the owner of the same edge in the other direction; those of the outline stay.
/// @throws NumericalError for an edge without another side
void name_neighbours(std::vector<Face>& faces);

}  // namespace feldspar
