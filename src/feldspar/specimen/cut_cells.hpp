// Holes, slits and cuts are taken out of the cells, on the shared vertex graph.
#pragma once

#include <vector>

#include "feldspar/specimen/cell_graph.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// What became of the cells.
struct CutCells {
    std::vector<int> disc;       ///< a face: the cell that it was cut from
    std::vector<char> reshaped;  ///< a face: a piece of that cell, or one that has taken a piece in
    int joined = 0;              ///< pieces that went to a neighbour
};

/// Below this share of the mean cell's area a piece is too small for a grain ...
inline constexpr double least_piece = 1.0 / 10.0;
/// ... and below this thickness (four areas over the perimeter) / mean grain diameter, too.
inline constexpr double thinnest_piece = 1.0 / 3.0;

/// Cuts the outline's cutouts out of the cells, one face each, exactly along their edges. Where an edge of a cutout crosses one
/// of a cell there is one vertex for both cells; the vertices along a cut without width are doubled, so that each face of it has
/// its own. Pieces of a cell stay grains of their own; those that are too small go to the neighbour on the same side with which
/// they share the longest boundary and make a sound cell. A cell that holds the end of a notch is divided across the notch, along
/// the line of its end (into the grain ahead and those beside it, as where three grains meet); one that bends around a corner so
/// that its middle does not see it whole is divided there. Afterwards there is one face a grain, pieces of a cell one after the
/// other, and labels name the neighbours.
/// @param mean_diameter_m  of the grains
/// @param merge_length_m   a division ends in a vertex of the cell that is nearer than this
/// @throws InputError if the specimen comes apart, or a notch or hole lies within one grain
CutCells cut_cells(CellGraph& graph, const Outline& outline, double mean_diameter_m, double merge_length_m);

/// Of cells that were cut by other means, `reshaped` says by a flag a face which: those that are too small go to a neighbour, as
/// above.
/// @param mean_area_m2  of the cells before they were cut
CutCells join_small_pieces(CellGraph& graph, const Outline& outline, double mean_diameter_m, double mean_area_m2,
                           double merge_length_m, std::vector<char> reshaped);

}  // namespace feldspar
