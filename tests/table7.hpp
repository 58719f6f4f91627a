// The contact of Table 7 of the paper, for every test that wants it.
#pragma once

#include "feldspar/verify/table7.hpp"

namespace feldspar::fixtures {

using bodies::table7;

}  // namespace feldspar::fixtures
