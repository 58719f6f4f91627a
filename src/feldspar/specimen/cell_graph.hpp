// The cells while they are being made: one shared vertex graph, and where each vertex may go.
#pragma once

#include <cstdint>
#include <vector>

#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Where a vertex of the graph lies. Values from 0 on: on that edge of the outline, along which it may move.
enum VertexPlace : int {
    place_inside = -1,  ///< free
    place_corner = -2,  ///< a vertex of the outline: never moves
    place_cut = -3,     ///< where a cut through a non-convex outline crosses a cell edge; such vertices go when pieces are joined
};

/// What an edge of a cell borders on: a neighbouring cell j is j (>= 0), edge k of the outline is -1 - k.
constexpr int outline_label(int edge) { return -1 - edge; }

/// An edge from one vertex to another, as one number.
constexpr std::uint64_t dart(int from, int to) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(from)) << 32 | static_cast<std::uint32_t>(to);
}

/// A closed chain of edges, counter-clockwise, of one cell: the cell itself, or a piece of it in a non-convex outline.
struct Face {
    int cell = 0;
    std::vector<int> vertices;
    std::vector<int> labels;  ///< an edge, from vertices[k] to vertices[k + 1]: what it borders on
};

/// All faces on shared vertices.
struct CellGraph {
    std::vector<Vec2> vertices;  ///< m
    std::vector<int> place;      ///< a vertex: VertexPlace, or the number of an outline edge
    std::vector<Face> faces;
};

}  // namespace feldspar
