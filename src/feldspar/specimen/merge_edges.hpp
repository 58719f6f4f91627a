// Short cell edges are merged on the shared vertex graph, so that neighbours keep naming the same vertices.
#pragma once

#include "feldspar/specimen/cell_graph.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Merges the two vertices of every edge shorter than `merge_length` (m), shortest first, and updates the edges around.
/// Two inner vertices meet at their midpoint; an inner vertex moves onto the outline's; two vertices on one edge of the
/// outline meet midway on it (on the circle for a disc); a vertex of the outline never moves. An edge is left as it is where a
/// cell would keep fewer than three vertices or would no longer be star-shaped about its centroid, where a cell would be
/// pinched, or where two different sides of the outline would be drawn together. The sum of the areas does not change,
/// except by the chords of a disc.
/// Vertices that are merged away stay in graph.vertices; drop_unused_vertices removes them.
/// @returns how many edges were merged
int merge_short_edges(CellGraph& graph, const Outline& outline, double merge_length);

/// Renumbers the vertices without those that no face uses, keeping their order.
void drop_unused_vertices(CellGraph& graph);

}  // namespace feldspar
