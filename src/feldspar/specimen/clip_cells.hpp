// Laguerre cells clipped to the outline, on one shared vertex graph.
#pragma once

#include <span>
#include <vector>

#include "feldspar/specimen/cell_graph.hpp"
#include "feldspar/specimen/specimen.hpp"
#include "feldspar/specimen/stage_control.hpp"

namespace feldspar {

/// A straight piece of the boundary of a convex region: part of the outline, or a cut through a non-convex one. Pieces on one
/// line stand together in one side.
struct ClipSide {
    std::vector<int> stops;     ///< outline vertices along the side, both ends included
    std::vector<int> segments;  ///< between stops: the outline's edge k, or the outline's edge count + c for cut c
};

/// A convex region with its sides counter-clockwise.
using ConvexRegion = std::vector<ClipSide>;

/// The outline polygon as convex regions: itself if it is convex, else parts cut along lines between its vertices.
std::vector<ConvexRegion> convex_regions(const Outline& outline);

/// Clips the cells. A vertex is known by what meets there (three cells; two cells and a piece of the outline; an outline
/// vertex), and its position is computed in the same way from every side, so that neighbours share it exactly: this is why
/// the cells are not clipped one by one by a polygon library, after which equal vertices would have to be guessed from
/// nearly equal coordinates. On a disc a cell gets a chord between the points where its edges cross the circle.
/// In a non-convex outline each region gives its own faces, with cut vertices; join_pieces makes them whole.
/// Labels of the faces: cell_graph.hpp, with -1 - (edge count + c) for cut c.
/// @param centres, weights  the discs' centres (m) and squared radii (m^2)
/// @throws InputError for equal centres and for cells that are empty or lie outside the outline
CellGraph clip_cells(std::span<const Vec2> centres, std::span<const double> weights, const Outline& outline,
                     const StageControl& control = {});

}  // namespace feldspar
