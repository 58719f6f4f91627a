// Fields on the grain mesh, which every kind of grain is drawn with: flexible grains have them at their own nodes and triangles;
// a rigid grain moves its cell as one piece, inner particles move theirs by the linear field that fits them best, and both have
// one stress a grain, from the forces on it.
#pragma once

#include <span>
#include <vector>

#include "feldspar/model/assembly.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Displacement of each node of the grain mesh, m. @param u  displacements of the assembly's nodes at the moment in question
std::vector<Vec2> mesh_displacements(const Assembly& assembly, const Specimen& specimen, std::span<const Vec2> u);

/// Mean Cauchy stress of each grain in the present state from the forces at its contacts, Pa, tension positive and symmetric:
/// sigma = 1/V sum of x (x) F over the contacts with other grains and with plates (Love 1892, Weber 1966).
std::vector<Mat2> grain_stresses(const Assembly& assembly, const Specimen& specimen);

/// The same sums of x (x) F, not yet divided by the grain's volume, J. @param sums  one a grain; they are set
void sum_grain_moments(const Assembly& assembly, const GrainMesh& mesh, std::span<Mat2> sums);

}  // namespace feldspar
