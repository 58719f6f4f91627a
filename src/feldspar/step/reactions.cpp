#include <cmath>

#include "feldspar/step/step.hpp"

namespace feldspar {

// Nodes of a fixture feel their forces and do not obey them where their motion is imposed: their sum is what the specimen does to
// the fixture.
Vec2 reaction(const Assembly& assembly, const Fixture& fixture) {
    Vec2 sum;
    for (const int node : fixture.nodes) sum += assembly.nodes.force[node];
    return {fixture.imposed.x * sum.x, fixture.imposed.y * sum.y};
}

// What is not imposed moves: its node feels the contacts and the pressure, and what is left of both moves it.
Vec2 felt_by(const Assembly& assembly, const Fixture& fixture) {
    Vec2 force = reaction(assembly, fixture);
    if (fixture.plate < 0) return force;
    const Body& plate = assembly.bodies[fixture.plate];
    for (int e = plate.pressure_begin; e < plate.pressure_end; ++e) {
        const PressureEdge& edge = assembly.pressure_edges[e];
        const double pressing_N =
            assembly.pressure_Pa(assembly.dead_loads[edge.load]) * edge.plate_length_m * assembly.thickness_m;
        force += (pressing_N + dot(assembly.nodes.force[plate.centre_node], edge.outward)) * edge.outward;
    }
    return force;
}

Vec2 dead_resultant(const Assembly& assembly) {
    Vec2 sum;
    for (const DeadLoad& load : assembly.dead_loads) sum += assembly.pressure_Pa(load) * load.resultant_m2;
    for (const Vec2 weight : assembly.weight) sum += weight;
    return sum;
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
        if (fixture.moves())
            motion += fixture.motion;
        else
            rest += reaction(assembly, fixture);
    }
    rest -= dead_resultant(assembly);
    const double length = norm(motion);
    return {loading_reaction(assembly), length > 0.0 ? dot(rest, (1.0 / length) * motion) : 0.0};
}

}  // namespace feldspar
