// Cells for other programs: Neper's .tess, gmsh's .msh, polygons as CSV.
#pragma once

#include <string>

#include "feldspar/specimen/cells_of_file.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// The cells of a specimen as the text of a file: lengths in m, numbers with 17 digits, so that they are read back with the same
/// bits. .tess: format 3.5, two-dimensional, with the discs' centres as seeds, crystals as groups, and the outline as the domain:
/// "square" of a rectangle, else "planes" of a polygon. .msh: format 4.1 with entities, a surface a grain with the triangles of
/// its mesh, and the named curves of the outline. .csv: a row a corner.
std::string cells_as_text(const Specimen& specimen, CellFormat format);

}  // namespace feldspar
