#include "feldspar/step/step.hpp"

namespace feldspar {

// Nodes under a platen, and the node of a plate, feel their forces and, imposed in y, do not obey them: their sum is what the
// specimen does to the platen.
Reactions platen_reactions(const Assembly& assembly) {
    std::array<double, 2> sum{};
    for (int side = 0; side < 2; ++side)
        for (const int node : assembly.platens[side].nodes) sum[side] += assembly.nodes.force[node].y;
    return {sum[0], sum[1]};
}

}  // namespace feldspar
