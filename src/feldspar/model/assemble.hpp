// From a specimen and its materials to a body that can move: nodes, triangles, contacts, platens, masses.
#pragma once

#include <array>
#include <cmath>

#include "feldspar/model/assembly.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Everything but boundary conditions and masses: triangles with their constants, a bonded contact on each interior cell
/// edge with three Lobatto points (areas 1/6, 2/3, 1/6) or one, initial shape functions.
Assembly assemble(const Specimen& specimen, const ModelSpec& model, const GrainMaterial& grain, const ContactMaterial& contact);

/// Bottom and top rows of nodes (outline labels "bottom", "top") become platens: y imposed, x free except for one bottom
/// node that is held. All other outline edges become pressure edges.
void attach_platen_rows(Assembly& body, const Specimen& specimen);

/// Brazilian test: horizontal plates above and below, touching grains on the outline through one-point frictional contacts.
/// Each point starts at the outermost point of the grain's circle, moved vertically onto the grain's own edge; the plates
/// start at first touch. kn = factor x Kn x 2R t, ks = eta kn.
void attach_plates(Assembly& body, const Specimen& specimen, const ContactMaterial& contact, double stiffness_factor, double mu);

/// Rebuilds the lists by which grains gather their contacts' slots; needed after contacts were added.
void index_slots(Assembly& body);

/// Adds a frictional one-point contact on the closest edge of each of two grains (model.md 7); the point starts at the
/// gap -(RA + RB - d) - `rest_overlap_m`, broken.
void add_new_contact(Assembly& body, int grain_a, int grain_b, double rest_overlap_m, double closing_distance_m);

/// Masses by the tensor bound m = 0.25 factor lambda_max(T) or, for the paper's scheme, 0.25 factor K by row sums.
/// Writes mass, and inverse_mass where the motion is not imposed. (docs/theory/motion-and-mass.md)
enum class MassBound { tensor, row_sum };
void set_scaled_masses(Assembly& body, MassBound bound, double factor);

/// Real lumped masses: a third of each triangle's to each of its nodes.
void set_real_masses(Assembly& body, double density_kg_m3);

/// |N_i| sum|N_j| of the six shape functions of a contact point: what its stiffness counts for at each node (docs/theory:
/// motion-and-mass). A platen has none.
inline void stiffness_shares(const std::array<double, 3>& Na, const std::array<double, 3>& Nb, bool grain_b, std::array<double, 3>& a,
                             std::array<double, 3>& b) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += std::abs(Na[i]) + (grain_b ? std::abs(Nb[i]) : 0.0);
    for (int i = 0; i < 3; ++i) {
        a[i] = sum * std::abs(Na[i]);
        b[i] = grain_b ? sum * std::abs(Nb[i]) : 0.0;
    }
}

/// Adds to a node's mass; 0 in an imposed direction stays. @return kinetic energy that it gained at its present velocity, J.
double add_mass(Nodes& nodes, int node, double mass_kg);

/// Mass that a contact's stiffness asks of the six nodes, added to their masses (new contacts). @return kinetic energy that the
/// heavier nodes gained at their present velocities, J.
double add_contact_mass(Assembly& body, const Contact& contact, double factor);

}  // namespace feldspar
