// Nodes and triangles inside each Laguerre cell.
#pragma once

#include <optional>
#include <vector>

#include "feldspar/specimen/specimen.hpp"
#include "feldspar/specimen/stage_control.hpp"

namespace feldspar {

/// Meshes every cell. No node lies on a cell edge, so edge k of a grain belongs to exactly one triangle.
///
/// Fixed topology (triangles_per_grain = 0), nv vertices v_0 ... v_(nv-1), centroid c, ring r_k = c + (v_k - c) / 2:
///   edge k                (v_k, v_k+1, r_k)      owns the edge: edge_triangle
///                         (v_k+1, r_k+1, r_k)
///                         (c, r_k, r_k+1)
/// The shortest ring edge is collapsed to its midpoint; the cell is read from the vertex after it, so that it is always the
/// last one, nv - 1, of which only the first triangle is left: 2 nv nodes and 3 nv - 2 triangles. The whole ring is kept, with
/// 2 nv + 1 nodes and 3 nv triangles, when nv = 3 or when a triangle around the centroid would fall under 1 % of the ring's
/// area. The triangles stand in this order, edge by edge, so the topology follows from nv and from collapsed or not, provided
/// that each cell's shortest edge is its last (tessellate_laguerre sees to it; otherwise the collapsed edge stands where it is).
///
/// Finer meshes: interior points on a regular triangular lattice about the centroid, spaced so that about
/// `triangles_per_grain` triangles result, in a constrained Delaunay triangulation.
///
/// A cell at a re-entrant corner of the outline may not be star-shaped about its centroid: its centre node then stands at the
/// centroid of its kernel (the points that see all of it).
/// @throws InputError if a cell has no kernel: the grains are too large for the outline's re-entrant corners
GrainMesh mesh_grains(const Tessellation& cells, int triangles_per_grain, const StageControl& control = {});

/// Where the middle node of a cell stands (m): its centroid, or the centroid of its kernel if the centroid does not see all
/// corners. Nothing if no point does: such a cell cannot be meshed. @param corners  counter-clockwise
std::optional<Vec2> centre_of_grain(const std::vector<Vec2>& corners);

}  // namespace feldspar
