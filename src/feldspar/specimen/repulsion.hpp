// The repulsion of overlapping discs (S2), for the packing of grains as for the filling of one grain with particles.
#pragma once

#include <span>
#include <vector>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// Two discs that may overlap.
struct DiscPair {
    int a = 0, b = 0;
};

/// A force on a disc that another thread owns.
struct DistantPush {
    int disc = 0;
    Vec2 force;  ///< m (stiffness 1)
};

/// Adds the forces of stiffness 1 by which overlapping discs push each other apart: each gets its overlap (m), along the line of
/// centres. Pairs take their turn in the order of the list, so the same list gives the same bits; pairs that do not overlap add
/// nothing and may be missing. Discs in one place part along x.
/// @param factor     of the radii (> 0)
/// @param first_own  forces on discs of lower number are not added but appended to `distant`, in the order of the list
void push_apart(std::span<const DiscPair> pairs, std::span<const Vec2> centres, std::span<const double> radii_m, double factor,
                std::span<Vec2> forces, int first_own, std::vector<DistantPush>& distant);

}  // namespace feldspar
