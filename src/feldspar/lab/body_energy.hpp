// Sums over the whole body, each in a fixed order: energies, the unbalanced force, forces of the contacts.
#pragma once

#include <vector>

#include "feldspar/model/assembly.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {

struct StoredEnergy {
    double grains_J = 0.0;    ///< elastic, in the triangles, or between the inner particles of a grain
    double contacts_J = 0.0;  ///< elastic, in the contact points between grains and at plates
    double fracture_J = 0.0;  ///< dissipated so far by softening and breaking
    double friction_J = 0.0;
    double damping_J = 0.0;   ///< taken out so far by the damping
    double pressure_J = 0.0;  ///< put in so far by the lateral pressure
};

/// Of the state in which the last contact stage was. @param since  time since then: dt after a step, 0 for a state that has not
/// been stepped; the triangles are taken that much earlier
StoredEnergy stored_energy(const Assembly& assembly, double since);

/// The motion at the state of stored_energy(). Velocities live half a step later, and so do the sums of work: with K = 1/2 m v-
/// v+ and without what the sums are ahead by, the balance of a linear body closes exactly (docs/theory/loading.md, (L13)).
struct Motion {
    double kinetic_J = 0.0;
    double deviation_J = 0.0;       ///< of w = V - v B after the last step, the motion that departs from the loading motion
    double ahead_external_J = 0.0;  ///< work of platens and pressure in the half step beyond the state
    double ahead_damping_J = 0.0;   ///< and of the damping
};

/// Over the degrees of freedom whose motion is not imposed.
/// @param settings  those of the last step; dt = 0 for a state that has not been stepped
Motion motion(const Assembly& assembly, const StepSettings& settings);

/// Of each body: sum over its free degrees of freedom of |F|, N.
std::vector<double> unbalanced_forces(const Assembly& assembly);

/// Sum over free degrees of freedom of |F|, N: the numerator of R*.
double unbalanced_force(const Assembly& assembly);

/// Mean force of the contact points, N.
double mean_contact_force(const Assembly& assembly);

/// Moment that contacts on the fall-back shape functions lose, relative to the moments that their forces make about the
/// grains' centres; 0 without fall-backs.
double fallback_moment_loss(const Assembly& assembly);

}  // namespace feldspar
