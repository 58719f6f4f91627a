// Provenance as JSON: the same block in every JSON file and page.
#pragma once

#include <nlohmann/json.hpp>

#include "feldspar/output/results.hpp"

namespace feldspar {

nlohmann::ordered_json provenance_json(const Provenance& provenance);

}  // namespace feldspar
