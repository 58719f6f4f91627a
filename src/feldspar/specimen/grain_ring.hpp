// The ring of small discs along the edges of one grain: a disc in each corner, and rows between them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Discs along a grain's edges, all of one diameter; later also those inside.
struct GrainRing {
    double diameter_m = 0.0;
    std::vector<Vec2> centres;           ///< m, counter-clockwise
    std::vector<double> radii_m;         ///< half the diameter, until inner discs are added
    std::vector<ParticlePlace> places;   ///< vertex or edge
    std::vector<Vec2> along;             ///< edge discs: direction of their edge, on which they may slide; vertex discs: zero
    std::vector<std::vector<int>> rows;  ///< for each edge of the cell: the discs along it, from its first vertex to its last
    double area_m2 = 0.0;                ///< of the polygon through the corner discs
    double perimeter_m = 0.0;            ///< of the same polygon
};

/// Two discs of one grain overlap by at most this share of their diameter; a third disc is taken away before that.
constexpr double largest_particle_overlap = 0.12;

/// Places the ring in the polygon `corners` (counter-clockwise). The corner discs touch both edges of their corner; an edge
/// too short for two of them has one in its middle; an edge too short even for that lies behind the disc that touches its
/// neighbours. The rows between hold as many discs as have room, evenly spread.
/// @param diameter_m  made smaller, by steps of 5 %, where the grain has no room for three such discs
GrainRing place_ring(std::span<const Vec2> corners, double diameter_m);

/// Takes away disc `gone` and closes the numbering.
void erase_disc(GrainRing& ring, int gone);

}  // namespace feldspar
