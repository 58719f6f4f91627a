// The elastic phase of a test for next to nothing: relax a small load with unlimited strength, scale it to just below the
// first damage, and start from there. (docs/theory/loading.md)
#pragma once

#include <functional>
#include <vector>

#include "feldspar/base/parallel.hpp"
#include "feldspar/model/assembly.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {

/// Everything of a body that moves or remembers, besides velocities.
struct BodyState {
    double platen_travel_m = 0.0;  ///< along the loading platen's mode
    Array<Vec2> displacement_m;
    Bonds bonds;
};

BodyState capture(const Assembly& assembly, double platen_travel_m);
void restore(Assembly& assembly, const BodyState& state);

/// base + factor (state - base) in every displacement and force of intact points: exact for a linear body. Velocities become 0.
BodyState superpose(const BodyState& base, const BodyState& state, double factor);

/// Smallest factor > 0 at which base + factor (state - base) reaches the first damage; infinite if none is ever reached.
double first_damage(const Assembly& assembly, const BodyState& base, const BodyState& state);

struct Relaxation {
    long long steps = 0;
    double residual = 0.0;  ///< mean |F| / mean |contact force| at the stop
    bool converged = false;
};

/// Dynamic relaxation with the platens at rest and adaptive viscous damping: critical for the slowest mode that is still
/// moving, whose frequency is the Rayleigh quotient of the last step (after Underwood 1983).
/// @param stop  asked every step; the relaxation ends early when it returns true
/// @param dt    stable with the masses of the nodes: 1 with scaled masses, else s
Relaxation relax(Assembly& assembly, Team& team, Strength strength, double tolerance, long long maximum_steps,
                 const std::function<bool()>& stop, double dt = 1.0);

}  // namespace feldspar
