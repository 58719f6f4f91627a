#include "feldspar/specimen/join_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"

namespace feldspar {
namespace {

/// A directed edge with what it borders on.
struct HalfEdge {
    int from, to, label;
};

std::vector<HalfEdge> half_edges(const Face& face) {
    std::vector<HalfEdge> result;
    for (std::size_t k = 0; k < face.vertices.size(); ++k) {
        result.push_back({face.vertices[k], face.vertices[(k + 1) % face.vertices.size()], face.labels[k]});
    }
    return result;
}

std::vector<Vec2> corners_of(const Face& face, const std::vector<Vec2>& vertices) {
    std::vector<Vec2> corners;
    for (const int v : face.vertices) corners.push_back(vertices[v]);
    return corners;
}

/// Of the edges that leave the vertex where `arriving` ends, the one that turns most to the left: the face stays in one piece
/// where two of its parts touch in a point only.
std::size_t next_edge(const std::vector<HalfEdge>& edges, const std::vector<char>& used, const HalfEdge& arriving,
                      const std::vector<Vec2>& vertices) {
    std::size_t best = edges.size();
    double best_turn = 0.0;
    const Vec2 in = vertices[arriving.to] - vertices[arriving.from];
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (used[e] || edges[e].from != arriving.to) continue;
        const Vec2 out = vertices[edges[e].to] - vertices[edges[e].from];
        const double turn = std::atan2(cross(in, out), dot(in, out));
        if (best == edges.size() || turn > best_turn) {
            best = e;
            best_turn = turn;
        }
    }
    return best;
}

}  // namespace

std::vector<Face> united(const std::vector<Face>& pieces, int cell, const std::vector<Vec2>& vertices) {
    std::vector<HalfEdge> all, edges;
    for (const Face& piece : pieces) {
        const auto more = half_edges(piece);
        all.insert(all.end(), more.begin(), more.end());
    }
    for (const HalfEdge& e : all) {
        const bool inner =
            std::any_of(all.begin(), all.end(), [&](const HalfEdge& o) { return o.from == e.to && o.to == e.from; });
        if (!inner) edges.push_back(e);
    }
    std::vector<char> used(edges.size(), 0);
    std::vector<Face> faces;
    for (std::size_t start = 0; start < edges.size(); ++start) {
        if (used[start]) continue;
        Face face;
        face.cell = cell;
        for (std::size_t e = start; e < edges.size(); e = next_edge(edges, used, edges[e], vertices)) {
            used[e] = 1;
            face.vertices.push_back(edges[e].from);
            face.labels.push_back(edges[e].label);
            if (edges[e].to == edges[start].from) break;
        }
        faces.push_back(std::move(face));
    }
    return faces;
}

namespace {

/// The piece that holds the site, or the largest.
std::size_t main_piece(const std::vector<Face>& pieces, Vec2 site, const std::vector<Vec2>& vertices) {
    std::size_t largest = 0;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        const auto corners = corners_of(pieces[p], vertices);
        if (contains(corners, site)) return p;
        if (signed_area(corners) > signed_area(corners_of(pieces[largest], vertices))) largest = p;
    }
    return largest;
}

/// Which cell has a directed edge.
using EdgeOwner = std::map<std::pair<int, int>, int>;

EdgeOwner edge_owners(const std::vector<Face>& faces) {
    EdgeOwner owner;
    for (const Face& face : faces) {
        for (const HalfEdge& e : half_edges(face)) owner[{e.from, e.to}] = face.cell;
    }
    return owner;
}

/// The cell with which a stray piece shares the longest boundary, and to which it can be added in one piece; nothing if none.
std::optional<int> adopter(const Face& stray, const std::vector<Face>& cells, const EdgeOwner& owner,
                           const std::vector<Vec2>& vertices) {
    std::map<int, double> shared;
    for (const HalfEdge& e : half_edges(stray)) {
        const auto other = owner.find({e.to, e.from});
        if (other != owner.end()) shared[other->second] += norm(vertices[e.to] - vertices[e.from]);
    }
    std::optional<int> best;
    for (const auto& [cell, length] : shared) {
        if ((!best || length > shared[*best]) && united({cells[cell], stray}, cell, vertices).size() == 1) best = cell;
    }
    return best;
}

/// Gives the stray pieces away. One may border on other strays alone until those have been taken in.
void place_strays(CellGraph& graph, std::vector<Face> strays) {
    while (!strays.empty()) {
        EdgeOwner owner = edge_owners(graph.faces);
        std::vector<Face> left;
        for (const Face& stray : strays) {
            const auto cell = adopter(stray, graph.faces, owner, graph.vertices);
            if (!cell) {
                left.push_back(stray);
                continue;
            }
            graph.faces[*cell] = united({graph.faces[*cell], stray}, *cell, graph.vertices).front();
            for (const HalfEdge& e : half_edges(graph.faces[*cell])) owner[{e.from, e.to}] = *cell;
        }
        if (left.size() == strays.size()) {
            const Vec2 at = centroid(corners_of(strays.front(), graph.vertices));
            throw InputError({}, fmt::format("the outline is too narrow for the grains near ({:.6g}, {:.6g}) m", at.x, at.y),
                             "grains several times smaller than the narrowest part of the specimen");
        }
        strays = std::move(left);
    }
}

}  // namespace

void name_neighbours(std::vector<Face>& faces) {
    const EdgeOwner owner = edge_owners(faces);
    for (Face& face : faces) {
        for (std::size_t k = 0; k < face.vertices.size(); ++k) {
            if (face.labels[k] < 0) continue;
            const auto other = owner.find({face.vertices[(k + 1) % face.vertices.size()], face.vertices[k]});
            if (other == owner.end()) throw NumericalError(fmt::format("an edge of cell {} has no other side", face.cell));
            face.labels[k] = other->second;
        }
    }
}

namespace {

/// Cut vertices lie on the straight boundary of two cells: they go from both, unless a third cell has come to meet there.
void remove_cut_vertices(CellGraph& graph) {
    std::vector<int> faces_at(graph.vertices.size(), 0);
    for (const Face& face : graph.faces) {
        for (const int v : face.vertices) ++faces_at[v];
    }
    for (std::size_t v = 0; v < graph.place.size(); ++v) {
        if (graph.place[v] == place_cut && faces_at[v] != 2) graph.place[v] = place_inside;
    }
    for (Face& face : graph.faces) {
        Face kept;
        kept.cell = face.cell;
        for (std::size_t k = 0; k < face.vertices.size(); ++k) {
            if (graph.place[face.vertices[k]] == place_cut) continue;
            kept.vertices.push_back(face.vertices[k]);
            kept.labels.push_back(face.labels[k]);
        }
        face = std::move(kept);
    }
}

}  // namespace

void join_pieces(CellGraph& graph, std::span<const Vec2> centres, const Outline& outline) {
    std::vector<std::vector<Face>> pieces(centres.size());
    for (Face& face : graph.faces) pieces[face.cell].push_back(std::move(face));
    graph.faces.clear();
    std::vector<Face> strays;
    for (int i = 0; i < std::ssize(centres); ++i) {
        std::vector<Face> whole = pieces[i].size() == 1 ? std::move(pieces[i]) : united(pieces[i], i, graph.vertices);
        const std::size_t keep = main_piece(whole, centres[i], graph.vertices);
        for (std::size_t p = 0; p < whole.size(); ++p) {
            if (p != keep) strays.push_back(whole[p]);
        }
        graph.faces.push_back(std::move(whole[keep]));
    }
    place_strays(graph, std::move(strays));
    const int outline_edges = static_cast<int>(outline.vertices.size());
    for (const Face& face : graph.faces) {
        for (const int label : face.labels) {
            if (label < -outline_edges) throw NumericalError(fmt::format("cell {} kept a cut through the outline", face.cell));
        }
    }
    name_neighbours(graph.faces);
    remove_cut_vertices(graph);
}

}  // namespace feldspar
