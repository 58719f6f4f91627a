// Sums over the whole body, each in a fixed order: energies, the unbalanced force, forces of the contacts.
#pragma once

#include "feldspar/model/assembly.hpp"

namespace feldspar {

struct StoredEnergy {
    double grains_J = 0.0;     ///< elastic, in the triangles, or between the inner particles of a grain
    double contacts_J = 0.0;   ///< elastic, in the contact points between grains and at plates
    double fracture_J = 0.0;   ///< dissipated so far by softening and breaking
    double friction_J = 0.0;
    double damping_J = 0.0;    ///< taken out so far by the damping
    double pressure_J = 0.0;   ///< put in so far by the lateral pressure
};

StoredEnergy stored_energy(const Assembly& assembly);

struct KineticEnergy {
    double total_J = 0.0;
    double deviation_J = 0.0;  ///< of w = V - v B, the motion that departs from the loading motion
};

/// Over the degrees of freedom whose motion is not imposed. @param speed  v, platen motion per unit of time
KineticEnergy kinetic_energy(const Assembly& assembly, double speed);

/// Sum over free degrees of freedom of |F|, N: the numerator of R*.
double unbalanced_force(const Assembly& assembly);

/// Mean force of the contact points, N.
double mean_contact_force(const Assembly& assembly);

/// Moment that contacts on the fall-back shape functions lose, relative to the moments that their forces make about the
/// grains' centres; 0 without fall-backs.
double fallback_moment_loss(const Assembly& assembly);

}  // namespace feldspar
