// Random dense packing of discs inside an outline: insertion at half radius, then relaxation at full radius.
#pragma once

#include <span>

#include "feldspar/base/rng.hpp"
#include "feldspar/specimen/specimen.hpp"
#include "feldspar/specimen/stage_control.hpp"

namespace feldspar {

/// Inserts discs of the given diameters at random without overlap, at half their radius and largest first, then gives them
/// their full radius. The discs come out sorted in rows from the bottom, so that neighbours are near each other in memory.
/// @param phases  of each disc its mineral, which stays with it; may be empty
/// @throws InputError  if a disc finds no room: the grains are too large for the outline
Packing place_discs(const Outline& outline, std::span<const double> diameters_m, RandomStream& random,
                    std::span<const int> phases = {});

/// Places discs and relaxes them (relax_discs).
/// @throws InputError      as place_discs
/// @throws NumericalError  from the relaxation
Packing pack_discs(const Outline& outline, std::span<const double> diameters_m, RandomStream& random,
                   const StageControl& control = {}, std::span<const int> phases = {});

/// When the relaxation may stop.
struct RelaxationCriterion {
    double residual = 1e-3;       ///< mean unbalanced force on a disc / mean contact force, at most
    double loose_overlap = 1e-6;  ///< or: mean overlap / mean diameter below this, for packings too loose to carry force
    int most_steps = 50000;       ///< after so many steps it has failed; the criterion is judged at every tenth
};

/// Moves the discs until their overlaps are spread evenly: linear repulsion of equal stiffness at every overlap of two discs
/// or of a disc and the outline, no cohesion, no friction. In the plane a contact of grains of size d under an even stress
/// carries a force proportional to d, so equal stiffness means overlaps in proportion to d. Minimised by FIRE (Bitzek et al.,
/// Phys. Rev. Lett. 97, 170201, 2006): damped dynamics whose time step grows while the motion goes downhill.
/// Fills overlap_mean, overlap_max, residual and relaxation_steps. Same input, same bits, for any
/// number of threads.
/// @throws NumericalError  if the criterion is not met in the most steps, or a disc has left the outline
void relax_discs(Packing& packing, const Outline& outline, const RelaxationCriterion& criterion = {},
                 const StageControl& control = {});

}  // namespace feldspar
