#include "feldspar/step/step.hpp"

namespace feldspar {

// Nodes under a platen feel the internal forces and, imposed in y, do not obey them: their sum is what the body does to the
// platen. A plate in contact feels the second slots of its contacts.
Reactions platen_reactions(const Assembly& body) {
    std::array<double, 2> sum{};
    for (int side = 0; side < 2; ++side) {
        const Platen& platen = body.platens[side];
        for (const int node : platen.nodes) sum[side] += body.nodes.force[node].y;
        for (const int contact : platen.contacts) sum[side] += body.slots[2 * contact + 1][0].y;
    }
    return {sum[0], sum[1]};
}

}  // namespace feldspar
