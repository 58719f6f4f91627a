// From a specimen and its materials to bodies that can move: nodes, triangles, rigid bodies, contacts.
#pragma once

#include <array>

#include "feldspar/model/assembly.hpp"
#include "feldspar/model/heterogeneity_spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Everything but boundary conditions and masses, by the kind of grains:
///   flexible          a body a grain with its triangles
///   rigid             a body a grain with three degrees of freedom
///   inner particles   a rigid disc for each particle of the filling, joined inside its grain by unbreakable elastic contacts
/// Flexible and rigid grains get a bonded contact on each interior cell edge, with three Lobatto points (areas 1/6, 2/3, 1/6) or
/// one; inner particles the one-point contacts across the edges, whose areas add up to the edge's.
/// Where grains or contacts of the rock differ, grains get elastic constants and densities of their own, and all contacts between
/// grains laws of their own; inside a grain of inner particles the stiffness is that of its mineral's contacts.
/// @throws InputError  inner particles are asked for, but the specimen is not filled; a rock that does not suit the specimen
/// (texture.hpp)
Assembly assemble(const Specimen& specimen, const ModelSpec& model, const GrainMaterial& grain, const ContactMaterial& contact,
                  const Heterogeneity& rock = {});

/// The side of a contact that hangs on these nodes of a body. @param edge  into Assembly::edges, -1 of a disc or a plate
ContactSide side_of(const Assembly& assembly, int body, const SideNodes& node, int edge);

/// Adds a contact with its origin and, between flexible bodies, its remembered shape functions; its points must stand at the
/// end of Assembly::points.
void add_contact(Assembly& assembly, const Contact& contact, const ContactOrigin& origin);

/// Rebuilds what follows from the bodies: their work, and the packs of grains. Needed after bodies were added.
void index_bodies(Assembly& assembly);

/// Rebuilds what follows from the contacts: the lists by which bodies gather their slots, and the packs of contacts. Needed after
/// contacts were added or dropped.
void index_contacts(Assembly& assembly);

/// Gives back what arrays that have grown hold beyond their ends: up to half of their memory.
void release_spare_memory(Assembly& assembly);

/// Adds a frictional one-point contact on the closest edge of each of two bodies; the point starts at the
/// gap -(RA + RB - d) - `rest_overlap_m`, broken, with the force of that gap. The area is that of the shorter edge; of discs, of
/// the smaller diameter.
void add_new_contact(Assembly& assembly, int body_a, int body_b, double rest_overlap_m, double closing_distance_m);

}  // namespace feldspar
