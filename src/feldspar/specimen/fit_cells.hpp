// Cells of a file in an outline: the outline that they have, or the one that is given.
#pragma once

#include <vector>

#include "feldspar/specimen/cell_graph.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// The outline that the cells fill: a rectangle with sides along the axes, a disc if all corners on the boundary, 16 or more, lie
/// on a circle, else a polygon. Edges of the polygon at its highest, lowest, rightmost and leftmost places are "top", "bottom",
/// "right", "left", if they run along the axes; others "edge-0", "edge-1", ...
/// @param tolerance  / mean grain diameter: what counts as straight, as a circle, as along an axis
OutlineSpec outline_of_cells(const GivenCells& cells, double tolerance);

/// Cells in their outline, ready to be cut and merged.
struct FittedCells {
    CellGraph graph;          ///< one face a cell, in the file's order
    int moved = 0;            ///< vertices that were moved onto the outline
    double furthest_m = 0.0;  ///< by so much at most
    Vec2 shift;               ///< m, by which all cells were moved; of a rectangle and a disc, whose place Feldspar gives
    std::vector<int>
        origin;  ///< where the outline was cut out: a face: the cell of the file; otherwise empty: face i is of cell i
    std::vector<char> reshaped;  ///< likewise: a face that the outline has cut, or one that has taken a piece in
    int joined = 0;              ///< pieces that were too small for a grain and went to a neighbour
};

/// Puts the cells into the outline, without its cutouts: labels for the edges on the boundary, which are moved exactly onto it. A
/// rectangle's cells are moved so that their lower left corner is at (0, 0), a disc's so that their middle is there. With
/// `spec.cut` the outline, which must be convex, is cut out of the middle of the cells.
/// @throws InputError if the cells do not fill the outline: where, and by how much
FittedCells fit_cells(const GivenCellsSpec& spec, const Outline& outline, Shape shape);

}  // namespace feldspar
