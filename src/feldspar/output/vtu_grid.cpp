#include "feldspar/output/vtu_grid.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <type_traits>

#include "feldspar/base/error.hpp"

namespace feldspar {

namespace {

constexpr std::size_t block_B = 1 << 20;

template <class Number>
constexpr const char* vtk_type() {
    if constexpr (std::is_same_v<Number, double>)
        return "Float64";
    else if constexpr (std::is_same_v<Number, float>)
        return "Float32";
    else if constexpr (std::is_same_v<Number, std::int32_t>)
        return "Int32";
    else if constexpr (std::is_same_v<Number, std::int64_t>)
        return "Int64";
    else
        return "UInt8";
}

void append_number(std::string& bytes, std::uint64_t number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace

std::string vtk_compressed(std::string_view bytes) {
    std::string header;
    std::string data;
    append_number(header, (bytes.size() + block_B - 1) / block_B);
    append_number(header, block_B);
    append_number(header, bytes.size() % block_B);
    for (std::size_t from = 0; from < bytes.size(); from += block_B) {
        const std::string_view block = bytes.substr(from, block_B);
        uLongf size = compressBound(block.size());
        std::string packed(size, '\0');
        if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(block.data()), block.size(),
                      5) != Z_OK) {
            throw OutputError("zlib could not compress a field");
        }
        append_number(header, size);
        data.append(packed.data(), size);
    }
    return header + data;
}

template <class Number>
std::string VtuGrid::array(const std::string& name, std::span<const Number> values, int components) {
    std::string xml = fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)"
                                  "\n",
                                  vtk_type<Number>(), name, components, appended_.size());
    appended_ += vtk_compressed({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
    return xml;
}

VtuGrid::VtuGrid(std::span<const double> points, std::span<const std::int32_t> cells, VtkCell type) {
    const std::size_t corners = type == VtkCell::line ? 2 : 3;
    point_count_ = points.size() / 3;
    cell_count_ = cells.size() / corners;
    std::vector<std::int64_t> offsets(cell_count_);
    for (std::size_t c = 0; c < cell_count_; ++c) offsets[c] = static_cast<std::int64_t>((c + 1) * corners);
    const std::vector<std::uint8_t> types(cell_count_, static_cast<std::uint8_t>(type));
    points_ = array("Points", points, 3);
    cells_ = array("connectivity", cells, 1);
    cells_ += array("offsets", std::span<const std::int64_t>(offsets), 1);
    cells_ += array("types", std::span<const std::uint8_t>(types), 1);
}

void VtuGrid::point_data(const std::string& name, std::span<const float> values, int components) {
    point_arrays_ += array(name, values, components);
}
void VtuGrid::cell_data(const std::string& name, std::span<const float> values, int components) {
    cell_arrays_ += array(name, values, components);
}
void VtuGrid::cell_data(const std::string& name, std::span<const std::int32_t> values) { cell_arrays_ += array(name, values, 1); }
void VtuGrid::cell_data(const std::string& name, std::span<const std::int64_t> values) { cell_arrays_ += array(name, values, 1); }

std::string VtuGrid::file(const std::string& comment) const {
    static_assert(std::endian::native == std::endian::little, "the head of the file says LittleEndian");
    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n<!-- {} -->\n"
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
        "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
        comment, point_count_, cell_count_);
    text += "<Points>\n" + points_ + "</Points>\n<Cells>\n" + cells_ + "</Cells>\n<PointData>\n" + point_arrays_ +
            "</PointData>\n<CellData>\n" + cell_arrays_ +
            "</CellData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    return text + appended_ + "\n</AppendedData>\n</VTKFile>\n";
}

}  // namespace feldspar
