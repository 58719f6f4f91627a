// Which grains still hang together: pieces of a specimen that cracks have cut from each other.
#pragma once

#include <vector>

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// The piece that each grain belongs to after the first `cracks` of these, numbered from 0 on by falling area. Two neighbours
/// hang together while a tenth of the edge between them, or more, is not broken; joints without strength hold, since no crack
/// tells of them.
std::vector<int> fragments(const Specimen& specimen, const std::vector<Crack>& cracks, int count);

}  // namespace feldspar
