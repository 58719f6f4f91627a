// What loads a specimen: rows of its own nodes as platens, plates in contact, the pressure on its sides.
#pragma once

#include "feldspar/model/assembly.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Flexible grains between platens. Bottom and top rows of nodes (outline labels "bottom", "top") become platens: y imposed, x
/// free except for one bottom node that is held. All other outline edges become pressure edges.
void attach_platen_rows(Assembly& assembly, const Specimen& specimen);

/// How plates and grains touch.
struct PlateContact {
    double Kn_Pa_m = 0.0;      ///< normal stiffness per area
    double eta = 0.0;          ///< ks / kn
    double mu = 0.0;           ///< friction; 0 = frictionless
    bool glued = false;        ///< unbreakable in the normal direction and free along the plate (direct tension)
    double jaw_radius_m = 0.0; ///< of curved jaws of a Brazilian test, more than that of the disc; 0 = flat
};

/// Horizontal plates below and above a disc, touching grains on the outline through one-point contacts. Each point starts at the
/// outermost point of the body's circle, moved vertically onto the grain's own edge; the plates start at first touch. kn = Kn 2R t.
/// Curved jaws differ in the gaps that are left at first touch; they press along the loading axis as plates do. On the flats of a
/// flattened disc each edge is pressed in its middle, with kn = Kn x edge length x t.
void attach_brazilian_plates(Assembly& assembly, const Specimen& specimen, const PlateContact& contact);

/// Horizontal plates on the outline's edges "bottom" and "top": a one-point contact for each grain edge there (for the share of
/// each inner particle), beside the body's centre, with kn = Kn x edge length x t.
void attach_end_plates(Assembly& assembly, const Specimen& specimen, const PlateContact& contact);

/// The flexible membrane of rigid grains and inner particles: each of the other outline edges, which must be vertical, is covered
/// by `plates` equal plates that move horizontally only, each under the lateral pressure. kn = Kn x edge length x t.
/// @throws InputError  if a side is not vertical, or a plate would have no body behind it
void attach_membranes(Assembly& assembly, const Specimen& specimen, const PlateContact& contact, int plates);

/// The width over which the top platen loads the specimen, undeformed, m.
double loaded_width_m(const Assembly& assembly, const Specimen& specimen);

}  // namespace feldspar
