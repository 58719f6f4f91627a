#include "feldspar/step/step.hpp"

namespace feldspar {

namespace {

// Nodes under a platen, and the node of a plate, feel their forces and, imposed in y, do not obey them: their sum is what the
// specimen does to the platen.
double reaction(const Assembly& assembly, const Platen& platen) {
    double sum = 0.0;
    for (const int node : platen.nodes) sum += assembly.nodes.force[node].y;
    return sum;
}

}  // namespace

double loading_reaction(const Assembly& assembly) { return reaction(assembly, assembly.platens[0]); }

Reactions platen_reactions(const Assembly& assembly) { return {loading_reaction(assembly), reaction(assembly, assembly.platens[1])}; }

}  // namespace feldspar
