// One VTK unstructured grid as the text and bytes of a .vtu file: appended raw data, compressed with zlib, 64-bit headers.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar {

enum class VtkCell : std::uint8_t { vertex = 1, line = 3, triangle = 5 };

/// Collects points, cells and data arrays, then gives the file. All cells have one type. Arrays are compressed as they come, so
/// a copy of a grid shares that work: what all snapshots have in common is added before the copy is made.
class VtuGrid {
public:
    /// @param points  x, y, z of each point, m
    /// @param cells   point numbers, 1 for each vertex, 2 for each line or 3 for each triangle
    VtuGrid(std::span<const double> points, std::span<const std::int32_t> cells, VtkCell type);

    /// `values` holds `components` numbers for each point, or for each cell.
    void point_data(const std::string& name, std::span<const float> values, int components = 1);
    void cell_data(const std::string& name, std::span<const float> values, int components = 1);
    void cell_data(const std::string& name, std::span<const std::int32_t> values);
    void cell_data(const std::string& name, std::span<const std::int64_t> values);

    /// The whole file. @param comment  goes into the head of the file
    std::string file(const std::string& comment) const;

private:
    template <class Number>
    std::string array(const std::string& name, std::span<const Number> values, int components);

    std::size_t point_count_ = 0;
    std::size_t cell_count_ = 0;
    std::string points_, cells_, point_arrays_, cell_arrays_;  ///< the XML of each part
    std::string appended_;                                     ///< the data behind it
};

/// Whether zlib looks for repeated bytes; where there are none the search costs most of the time.
enum class Repeats { searched, not_searched };

/// VTK's compressed block format: number of blocks, their size, the size of the last if it is shorter, the compressed sizes,
/// the blocks. @throws OutputError if zlib fails
std::string vtk_compressed(std::string_view bytes, Repeats repeats = Repeats::searched);

}  // namespace feldspar
