// Where the two faces of a crack are when the specimen deforms: each face moves with the nodes of its own grain.
#pragma once

#include <array>
#include <vector>

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// One face of a crack: its ends lie between two nodes of its grain, at the given fractions.
struct CrackFace {
    int node_0 = -1;  ///< -1: the grain's edge was not found; the face does not move
    int node_1 = -1;
    double fraction_from = 0.0;  ///< of Crack::from on the way from node_0 to node_1
    double fraction_to = 1.0;    ///< of Crack::to
};

/// Both faces of each crack.
struct CrackFaces {
    CrackFace a;  ///< on Crack::grain_a
    CrackFace b;  ///< on Crack::grain_b
};

std::vector<CrackFaces> find_crack_faces(const Specimen& specimen, const std::vector<Crack>& cracks);

/// Displacement of the face's two ends (m).
std::array<Vec2, 2> face_displacement(const CrackFace& face, const std::vector<Vec2>& displacement_m);

}  // namespace feldspar
