// Local non-viscous damping of what departs from the loading motion, one component of one node.
//
// Source: Cundall's local damping (paper, equations (2)-(3)), here on the deviation; docs/theory/motion-and-mass.md (M2)-(M3).
//   V        velocity                      F      sum of all forces but the damping
//   L = v B  loading motion                w      V - L, the deviation; with L = 0 this is the paper's own damping
//   drag  =  alpha |F| sign(w)  where w V > 0, else 0,      m dV/dt = F - drag
// The condition leaves out what would drive the body instead of braking it: a node that moves more slowly than the loading
// motion, or any node while the platen moves back. So the damping takes energy always.
//
// Written for any number type that has comparisons and the conditional operator lane by lane: double, or a vector of doubles.
#pragma once

#include "feldspar/laws/number.hpp"

namespace feldspar {

/// The force that opposes the deviation, N. @param alpha  share of the unbalanced force, 0 <= alpha < 1
template <class Real>
FELDSPAR_LAW Real local_drag(Real V, Real loading, Real F, double alpha) {
    const Real none{}, size = alpha * F, magnitude = F < none ? -size : size, w = V - loading;
    const Real drag = w > none ? magnitude : -magnitude;
    return w * V > none ? drag : none;
}

/// The velocity before a step that ended with the velocity V: the inverse of V = before + push (F - drag(before)), push = dt / m.
/// Where the component has just turned, two velocities before lead to the same one after; then the one with more drag is taken.
template <class Real>
FELDSPAR_LAW Real before_local_drag(Real V, Real loading, Real F, Real push, double alpha) {
    const Real none{}, size = alpha * F, magnitude = F < none ? -size : size;
    const Real forward = V - push * (F - magnitude), backward = V - push * (F + magnitude), free = V - push * F;
    const Real other = ((backward < loading) & (backward < none)) ? backward : free;
    return ((forward > loading) & (forward > none)) ? forward : other;
}

}  // namespace feldspar
