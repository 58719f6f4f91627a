// Tessellations of other programs, read from their files: Neper's .tess, gmsh's .msh, polygons as CSV.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// Cells as a file has them: polygons, perhaps on vertices of their own, in its unit of length.
struct CellsOfFile {
    struct Cell {
        std::string name;          ///< as the file calls it: a number, or a word
        int line = 0;              ///< where it begins in the file, from 1 on
        std::vector<int> corners;  ///< into `vertices`; either orientation
    };
    std::vector<Vec2> vertices;
    std::vector<Cell> cells;
    double unit_m = 0.0;               ///< if the file says its unit; else 0
    std::vector<std::string> remarks;  ///< what was left out, in sentences
};

enum class CellFormat { tess, msh, csv };

/// By the ending of the file's name. @throws InputError for any other ending
CellFormat cell_format_of(const std::filesystem::path& file);

/// What is in a file of cells. @throws InputError if it cannot be read, or is larger than 1 GiB
std::string read_cell_file(const std::filesystem::path& file);

/// Reads the cells of a file.
/// .tess: Neper's text format, versions 2.0 to 3.5, in two dimensions. A face is a cell; seeds, orientations, groups, the domain
/// and the like are passed over. .msh: gmsh's text formats 2.2 and 4.1. Triangles and quadrangles of one physical surface are a
/// cell if every one of them has a physical surface and there are two or more of these; otherwise those of one elementary
/// surface. Nodes on straight borders between two cells are left out. Cells in the order of their tags. .csv: a head that names
/// the columns grain, x, y (or x_mm, y_mm, and so with nm, um, cm, m), a row a corner in the order around the grain, grains one
/// after the other; '#' begins a comment.
/// @param contents  of the file  @param file  stands in messages
/// @throws InputError with the line at which the file is not as it must be
CellsOfFile read_cells(std::string_view contents, const std::filesystem::path& file);

}  // namespace feldspar
