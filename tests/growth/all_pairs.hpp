// A search that grows faster than the specimen, for the test that must notice such a thing.
#pragma once

#include <span>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// How many pairs of points are nearer to each other than `reach`: every point looks at every other.
int near_pairs_of_all(std::span<const Vec2> points, double reach);

}  // namespace feldspar
