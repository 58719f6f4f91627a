// The option --device of the commands that run tests.
#pragma once

#include <string>

#include "feldspar/output/results.hpp"
#include "feldspar/study/device_use.hpp"

namespace feldspar {

/// Where tests run. @param wanted  "cpu", "gpu", "auto": a card if there is one that can be used, which stderr is told
/// @param provenance  gets the card  @throws InputError for "gpu" without one
DeviceUse device_use(const std::string& wanted, Provenance& provenance);

}  // namespace feldspar
