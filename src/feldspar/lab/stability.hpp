// Is a step stable? The largest frequency of the initial state, judged before anything runs.
#pragma once

#include "feldspar/base/parallel.hpp"
#include "feldspar/model/assembly.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {

/// Largest eigenvalue of M^-1 K of the intact body with every contact closed, times dt^2 for dt = 1 (Lanczos, matrix-free: the
/// stiffness is applied by the stages of the step themselves). @param body  at rest, without displacements; afterwards as before,
/// without forces of nodes
double largest_omega2(Assembly& body, Team& team);

/// omega^2 dt^2 that the scheme tolerates: 4 with viscous damping, 4 / (1 + alpha) with local damping.
inline double omega2_limit(Damping damping, double alpha) { return damping == Damping::local ? 4.0 / (1.0 + alpha) : 4.0; }

}  // namespace feldspar
