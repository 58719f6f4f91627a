#include "feldspar/specimen/write_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "feldspar/base/printable.hpp"
#include "feldspar/geometry/polygon.hpp"

namespace feldspar {
namespace {

/// The edges between the cells and around them, each once.
struct EdgeList {
    std::vector<std::pair<int, int>> ends;  ///< vertices, as the first cell that names it goes along it
    std::vector<std::vector<int>> of_cell;  ///< a cell: its edges from 1 on, negative where it goes along them the other way
    std::vector<int> outline_edge;          ///< an edge: the outline's, or -1 inside
};

EdgeList edges_of(const Tessellation& cells) {
    EdgeList list;
    std::map<std::pair<int, int>, int> number;  // from 1 on
    for (const Cell& cell : cells.cells) {
        std::vector<int>& own = list.of_cell.emplace_back();
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            const int a = cell.vertices[k], b = cell.vertices[(k + 1) % cell.vertices.size()];
            if (const auto other = number.find({b, a}); other != number.end()) {
                own.push_back(-other->second);
                continue;
            }
            list.ends.emplace_back(a, b);
            list.outline_edge.push_back(cell.neighbours[k] < 0 ? cell.outline_edges[k] : -1);
            number.emplace(std::pair{a, b}, static_cast<int>(list.ends.size()));
            own.push_back(static_cast<int>(list.ends.size()));
        }
    }
    return list;
}

/// The line around all cells: its edges in order, counter-clockwise.
std::vector<int> outer_line(const Tessellation& cells, const EdgeList& edges) {
    std::multimap<int, int> leaving;
    for (std::size_t c = 0; c < cells.cells.size(); ++c)
        for (std::size_t k = 0; k < edges.of_cell[c].size(); ++k)
            if (cells.cells[c].neighbours[k] < 0) leaving.emplace(cells.cells[c].vertices[k], edges.of_cell[c][k] - 1);
    std::vector<int> best;
    double largest = 0.0;
    while (!leaving.empty()) {
        std::vector<int> line;
        std::vector<Vec2> points;
        for (auto next = leaving.begin(); next != leaving.end();) {
            line.push_back(next->second);
            points.push_back(cells.vertices[next->first]);
            const int to = edges.ends[next->second].second;
            leaving.erase(next);
            next = leaving.find(to);
        }
        if (points.size() < 3 || signed_area(points) <= largest) continue;
        largest = signed_area(points);
        best = std::move(line);
    }
    return best;
}

using Out = std::back_insert_iterator<std::string>;

void write_domain(std::string& text, const Specimen& specimen, const EdgeList& edges) {
    const Tessellation& cells = specimen.cells;
    const bool square = specimen.spec.outline.shape == Shape::rectangle && !specimen.spec.outline.is_cut();
    std::vector<int> line = outer_line(cells, edges);
    if (line.empty()) return;
    const std::size_t n = line.size();
    const auto from = [&](std::size_t k) { return edges.ends[line[k % n]].first; };
    // Corners are where the line turns.
    const auto turns = [&](std::size_t k) {
        const Vec2 at = cells.vertices[from(k)], in = at - cells.vertices[from(k + n - 1)],
                   out = cells.vertices[from(k + 1)] - at;
        return std::abs(cross(in, out)) > 1e-7 * norm(in) * norm(out) || dot(in, out) < 0.0;
    };
    std::size_t first = 0;
    const auto lower = [&](std::size_t k) { return cells.vertices[from(k)].x + cells.vertices[from(k)].y; };
    for (std::size_t k = 0; k < n; ++k)
        if (turns(k) && (!turns(first) || lower(k) < lower(first))) first = k;
    std::rotate(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(first), line.end());
    std::vector<std::vector<int>> sides;
    std::vector<int> corners;
    for (std::size_t k = 0; k < n; ++k) {
        if (k == 0 || turns(k)) {
            corners.push_back(from(k));
            sides.emplace_back();
        }
        sides.back().push_back(line[k] + 1);
    }
    const std::size_t m = corners.size();
    const std::vector<std::string> of_square{"y0", "x1", "y1", "x0"}, corners_of_square{"x0y0", "x1y0", "x1y1", "x0y1"};
    const bool named = square && m == 4;
    fmt::format_to(Out(text), " **domain\n  *general\n   {}\n  *vertex\n   {}\n", named ? "square" : "planes", m);
    for (std::size_t k = 0; k < m; ++k) {
        const Vec2 at = cells.vertices[corners[k]];
        const std::size_t before = (k + m - 1) % m;
        const std::string label =
            named ? corners_of_square[k] : fmt::format("f{}f{}", std::min(before, k) + 1, std::max(before, k) + 1);
        fmt::format_to(Out(text), "   {} {:.17g} {:.17g} 0 {}\n     1 {}\n", k + 1, at.x, at.y, label, corners[k] + 1);
    }
    fmt::format_to(Out(text), "  *edge\n   {}\n", m);
    for (std::size_t k = 0; k < m; ++k) {
        fmt::format_to(Out(text), "   {} 2 {} {}\n     line\n     0\n     {}\n     {}", k + 1, k + 1, (k + 1) % m + 1,
                       named ? of_square[k] : fmt::format("f{}", k + 1), sides[k].size());
        for (const int e : sides[k]) fmt::format_to(Out(text), " {}", e);
        text += '\n';
    }
}

std::string as_tess(const Specimen& specimen) {
    const Tessellation& cells = specimen.cells;
    const std::size_t n = cells.cells.size();
    const EdgeList edges = edges_of(cells);
    std::string text = fmt::format("***tess\n **format\n   3.5\n **general\n   2 standard\n **cell\n  {}\n  *id\n", n);
    const auto list = [&](auto value) {
        for (std::size_t i = 0; i < n; ++i)
            fmt::format_to(Out(text), "{}{}", i % 12 == 0 ? (i == 0 ? "   " : "\n   ") : " ", value(i));
        text += '\n';
    };
    list([](std::size_t i) { return i + 1; });
    if (!specimen.crystal_of_cell.empty()) {
        text += "  *group\n";
        list([&](std::size_t i) { return specimen.crystal_of_cell[i] + 1; });
    }
    text += "  *seed\n";
    for (std::size_t i = 0; i < n; ++i)
        fmt::format_to(Out(text), "   {} {:.17g} {:.17g} 0 {:.17g}\n", i + 1, specimen.packing.centres[i].x,
                       specimen.packing.centres[i].y, specimen.packing.radii_m[i]);
    fmt::format_to(Out(text), " **vertex\n  {}\n", cells.vertices.size());
    for (std::size_t v = 0; v < cells.vertices.size(); ++v)
        fmt::format_to(Out(text), "   {} {:.17g} {:.17g} 0 0\n", v + 1, cells.vertices[v].x, cells.vertices[v].y);
    fmt::format_to(Out(text), " **edge\n  {}\n", edges.ends.size());
    for (std::size_t e = 0; e < edges.ends.size(); ++e)
        fmt::format_to(Out(text), "   {} {} {} 0\n", e + 1, edges.ends[e].first + 1, edges.ends[e].second + 1);
    fmt::format_to(Out(text), " **face\n  {}\n", n);
    for (std::size_t i = 0; i < n; ++i) {
        const std::vector<int>& corners = cells.cells[i].vertices;
        fmt::format_to(Out(text), "   {} {}", i + 1, corners.size());
        for (const int v : corners) fmt::format_to(Out(text), " {}", v + 1);
        fmt::format_to(Out(text), "\n     {}", corners.size());
        for (const int e : edges.of_cell[i]) fmt::format_to(Out(text), " {}", e);
        text += "\n     0 0 0 1\n     0 -1 0 0 0\n";
    }
    write_domain(text, specimen, edges);
    text += "***end\n";
    return text;
}

/// Points, curves and surfaces are the cells' vertices, edges and cells; nodes at the corners are shared by the grains.
std::string as_msh(const Specimen& specimen) {
    const Tessellation& cells = specimen.cells;
    const GrainMesh& mesh = specimen.mesh;
    const EdgeList edges = edges_of(cells);
    const std::size_t n = cells.cells.size(), vertices = cells.vertices.size();
    const auto node_of = [&](int grain, int node) {  // the corners of a grain come first
        const int local = node - mesh.node_begin[grain], corners = mesh.vertex_count[grain];
        return local < corners ? cells.cells[grain].vertices[local] + 1 : node + 1 + static_cast<int>(vertices);
    };
    std::map<std::string, int> sides;  // labels of the outline, from 1 on
    for (const int edge : edges.outline_edge)
        if (edge >= 0) sides.emplace(specimen.outline.edge_labels[edge], 0);
    int count = 0;
    for (auto& [label, number] : sides) number = ++count;
    std::string text = fmt::format("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n", sides.size() + n);
    for (const auto& [label, number] : sides) {
        std::string name = printable(label, LineEnds::escaped);
        std::replace(name.begin(), name.end(), '"', '\'');  // which would end it
        fmt::format_to(Out(text), "1 {} \"{}\"\n", number, name);
    }
    for (std::size_t i = 0; i < n; ++i) fmt::format_to(Out(text), "2 {} \"grain-{}\"\n", i + 1, i + 1);
    fmt::format_to(Out(text), "$EndPhysicalNames\n$Entities\n{} {} {} 0\n", vertices, edges.ends.size(), n);
    for (std::size_t v = 0; v < vertices; ++v)
        fmt::format_to(Out(text), "{} {:.17g} {:.17g} 0 0\n", v + 1, cells.vertices[v].x, cells.vertices[v].y);
    for (std::size_t e = 0; e < edges.ends.size(); ++e) {
        const auto [a, b] = edges.ends[e];
        const std::vector<Vec2> ends{cells.vertices[a], cells.vertices[b]};
        const Box box = bounding_box(std::span<const Vec2>(ends));
        const std::string physical =
            edges.outline_edge[e] >= 0 ? fmt::format("1 {}", sides.at(specimen.outline.edge_labels[edges.outline_edge[e]])) : "0";
        fmt::format_to(Out(text), "{} {:.17g} {:.17g} 0 {:.17g} {:.17g} 0 {} 2 {} {}\n", e + 1, box.lower.x, box.lower.y,
                       box.upper.x, box.upper.y, physical, a + 1, -(b + 1));
    }
    for (std::size_t i = 0; i < n; ++i) {
        const std::vector<Vec2> corners = corners_of_cell(cells, static_cast<int>(i));
        const Box box = bounding_box(std::span<const Vec2>(corners));
        fmt::format_to(Out(text), "{} {:.17g} {:.17g} 0 {:.17g} {:.17g} 0 1 {} {}", i + 1, box.lower.x, box.lower.y, box.upper.x,
                       box.upper.y, i + 1, edges.of_cell[i].size());
        for (const int e : edges.of_cell[i]) fmt::format_to(Out(text), " {}", e);
        text += '\n';
    }
    std::size_t nodes = vertices;
    for (std::size_t i = 0; i < n; ++i)
        nodes += static_cast<std::size_t>(mesh.node_begin[i + 1] - mesh.node_begin[i] - mesh.vertex_count[i]);
    fmt::format_to(Out(text), "$EndEntities\n$Nodes\n{} {} 1 {}\n", vertices + n, nodes, mesh.nodes.size() + vertices);
    for (std::size_t v = 0; v < vertices; ++v)
        fmt::format_to(Out(text), "0 {} 0 1\n{}\n{:.17g} {:.17g} 0\n", v + 1, v + 1, cells.vertices[v].x, cells.vertices[v].y);
    for (std::size_t i = 0; i < n; ++i) {
        const int first = mesh.node_begin[i] + mesh.vertex_count[i], last = mesh.node_begin[i + 1];
        fmt::format_to(Out(text), "2 {} 0 {}\n", i + 1, last - first);
        for (int node = first; node < last; ++node) fmt::format_to(Out(text), "{}\n", node_of(static_cast<int>(i), node));
        for (int node = first; node < last; ++node)
            fmt::format_to(Out(text), "{:.17g} {:.17g} 0\n", mesh.nodes[node].x, mesh.nodes[node].y);
    }
    const std::size_t elements = edges.ends.size() + mesh.triangles.size();
    fmt::format_to(Out(text), "$EndNodes\n$Elements\n{} {} 1 {}\n", edges.ends.size() + n, elements, elements);
    std::size_t element = 0;
    for (std::size_t e = 0; e < edges.ends.size(); ++e)
        fmt::format_to(Out(text), "1 {} 1 1\n{} {} {}\n", e + 1, ++element, edges.ends[e].first + 1, edges.ends[e].second + 1);
    for (std::size_t i = 0; i < n; ++i) {
        fmt::format_to(Out(text), "2 {} 2 {}\n", i + 1, mesh.triangle_begin[i + 1] - mesh.triangle_begin[i]);
        for (int t = mesh.triangle_begin[i]; t < mesh.triangle_begin[i + 1]; ++t) {
            const auto& corners = mesh.triangles[t];
            fmt::format_to(Out(text), "{} {} {} {}\n", ++element, node_of(static_cast<int>(i), corners[0]),
                           node_of(static_cast<int>(i), corners[1]), node_of(static_cast<int>(i), corners[2]));
        }
    }
    text += "$EndElements\n";
    return text;
}

std::string as_csv(const Specimen& specimen) {
    std::string text = "grain,x_m,y_m\n";
    for (int i = 0; i < std::ssize(specimen.cells.cells); ++i)
        for (const Vec2 at : corners_of_cell(specimen.cells, i))
            fmt::format_to(Out(text), "{},{:.17g},{:.17g}\n", i + 1, at.x, at.y);
    return text;
}

}  // namespace

std::string cells_as_text(const Specimen& specimen, CellFormat format) {
    switch (format) {
        case CellFormat::tess:
            return as_tess(specimen);
        case CellFormat::msh:
            return as_msh(specimen);
        case CellFormat::csv:
            return as_csv(specimen);
    }
    return {};
}

}  // namespace feldspar
