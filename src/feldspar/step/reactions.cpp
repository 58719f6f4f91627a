#include <cmath>

#include "feldspar/step/step.hpp"

namespace feldspar {

// Nodes of a fixture feel their forces and do not obey them where their motion is imposed: their sum is what the specimen does to the fixture.
Vec2 reaction(const Assembly& assembly, const Fixture& fixture) {
    Vec2 sum;
    for (const int node : fixture.nodes) sum += assembly.nodes.force[node];
    return {fixture.imposed.x * sum.x, fixture.imposed.y * sum.y};
}

double loading_reaction(const Assembly& assembly) {
    double sum = 0.0;
    for (const Fixture& fixture : assembly.fixtures)
        if (fixture.moves()) sum -= dot(reaction(assembly, fixture), fixture.motion);
    return sum;
}

Reactions reactions(const Assembly& assembly) {
    Vec2 motion, rest;
    for (const Fixture& fixture : assembly.fixtures) {
        if (fixture.moves()) motion += fixture.motion;
        else rest += reaction(assembly, fixture);
    }
    const double length = norm(motion);
    return {loading_reaction(assembly), length > 0.0 ? dot(rest, (1.0 / length) * motion) : 0.0};
}

}  // namespace feldspar
