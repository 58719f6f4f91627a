// Laguerre (power) tessellation of a packing, clipped to the outline.
#pragma once

#include "feldspar/specimen/cell_graph.hpp"
#include "feldspar/specimen/specimen.hpp"
#include "feldspar/specimen/stage_control.hpp"

namespace feldspar {

/// The Laguerre cells of the discs with weights R^2: grain i holds the points x where |x - c_i|^2 - R_i^2 is least. Clipped to
/// the outline, edges shorter than `merge_length_m` merged (0 = only edges of no length at all). Each cell starts so that
/// its shortest edge is its last. Holes and notches are cut out before edges are merged (cut_cells.hpp); a cell that they cut
/// becomes one grain or several.
/// @throws InputError      for equal centres, discs hidden by their neighbours or outside the outline, and an outline too
///                         narrow for its grains
/// @throws NumericalError  if the result is not a partition: an edge inside that two cells do not share
Tessellation tessellate_laguerre(const Packing& packing, const Outline& outline, double merge_length_m,
                                 const StageControl& control = {});

/// What follows the clipping, of cells of any origin: holes and notches are cut out, short edges merged. @param mean_diameter_m
/// of the grains
Tessellation tessellation_of(CellGraph graph, const Outline& outline, double mean_diameter_m, double merge_length_m);

/// Checks that every edge inside is named by exactly two cells, once in each direction, and that each names the other as its
/// neighbour. @throws NumericalError naming the cell
void check_conforming(const Tessellation& cells);

}  // namespace feldspar
