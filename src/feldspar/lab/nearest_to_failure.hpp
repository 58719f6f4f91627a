// Which contact is nearest to breaking, read from the state of a test.
#pragma once

#include "feldspar/methods/result.hpp"
#include "feldspar/model/assembly.hpp"

namespace feldspar {

/// The contact point between grains that is nearest to its limit: traction over strength (C8), in tension or in shear. Plates,
/// broken points and contacts without strength do not count. Changes nothing.
NearestToFailure nearest_to_failure(const Assembly& assembly);

}  // namespace feldspar
