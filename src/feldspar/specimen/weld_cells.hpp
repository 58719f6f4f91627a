// Polygons of a file are put together on one vertex graph, and what is wrong with them is said.
#pragma once

#include <filesystem>

#include "feldspar/specimen/cells_of_file.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Welds vertices of different cells that are nearer than the tolerance (the nearest first, never two of one cell), puts vertices
/// that lie on a neighbour's edge into that edge, and checks that the cells are one partition: every edge has one cell or two,
/// the boundary is one closed line without crossings, the angles around each vertex inside add up to a full turn. Where nothing
/// has to be welded, the vertices keep their order and their bits.
/// @param unit_m     the file's unit of length (m)
/// @param tolerance  / mean grain diameter, the diameter of a circle of the cell's area
/// @param file       stands in messages
/// @throws InputError for cells of fewer than three corners, without area, that cross themselves, overlap, leave gaps or do not
/// hang together, and for cells of which
///                    no point sees all corners, which cannot be meshed; with the line of the cell
GivenCells weld_cells(const CellsOfFile& read, double unit_m, double tolerance, const std::filesystem::path& file);

}  // namespace feldspar
