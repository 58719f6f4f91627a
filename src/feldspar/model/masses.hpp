// Masses that make a step stable, and real ones (docs/theory/motion-and-mass.md).
#pragma once

#include <array>
#include <cmath>

#include "feldspar/model/assembly.hpp"

namespace feldspar {

/// Masses by the tensor bound m = 0.25 factor lambda_max(T) or, for the paper's scheme, 0.25 factor K by row sums. A rigid body
/// has one mass for its three degrees of freedom, the turn being an arc at its radius. Writes mass, and inverse_mass where the
/// motion is not imposed.
enum class MassBound { tensor, row_sum };
void set_scaled_masses(Assembly& assembly, MassBound bound, double factor);

/// Real masses: a third of each triangle's to each of its nodes; a rigid body's own, with its moment of inertia. A plate of a
/// membrane weighs as much as a strip of rock of the mean density that is one mean grain radius thick.
void set_real_masses(Assembly& assembly);

/// What gravity does to each node, N, with the real masses of grains and particles; plates have no weight.
Array<Vec2> weights(const Assembly& assembly, Vec2 gravity_m_s2);

/// |N_i| sum|N_j| of the six shape functions of a contact point between flexible bodies: what its stiffness counts for at each
/// node. @param b_moves  false if side B is a plate whose motion is imposed
inline void stiffness_shares(const std::array<double, 3>& Na, const std::array<double, 3>& Nb, bool b_moves,
                             std::array<double, 3>& a, std::array<double, 3>& b) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += std::abs(Na[i]) + (b_moves ? std::abs(Nb[i]) : 0.0);
    for (int i = 0; i < 3; ++i) {
        a[i] = sum * std::abs(Na[i]);
        b[i] = b_moves ? sum * std::abs(Nb[i]) : 0.0;
    }
}

/// Adds to a node's mass; 0 in an imposed direction stays. @return kinetic energy that it gained at its present velocity, J.
double add_mass(Nodes& nodes, int node, double mass_kg);

/// Mass that a contact's stiffness asks of its bodies' nodes, added to their masses (new contacts). @return kinetic energy that
/// the heavier nodes gained at their present velocities, J.
double add_contact_mass(Assembly& assembly, const Contact& contact, double factor);

}  // namespace feldspar
