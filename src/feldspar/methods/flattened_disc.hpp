// The flattened Brazilian disc: the share of 2P / (pi D t) that counts as its stress, (P31) in docs/theory/properties.md.
#pragma once

#include "feldspar/methods/test_spec.hpp"
#include "feldspar/model/spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// What presses on the flats.
struct FlatLoading {
    double hardness =
        0.0;  ///< stiffness of the plate per area times half the width of a flat, over the disc's E, >= 0; 0 presses uniformly
    double eta = 0.0;  ///< shear over normal stiffness of the plate, >= 0
    double mu = 0.0;   ///< friction of the plate, >= 0
};

/// k in sigma_t = k 2P / (pi D t): Griffith's stress in the centre of an elastic disc. Exactly 1 for a whole disc.
/// 2 alpha = 20 degrees: 0.964 under a uniform pressure, 0.940 under a rigid plate, 0.913 under one with a friction of 0.4.
/// @param angle_rad  2 alpha of a flat, seen from the centre: 0, or from 10 to 40 degrees
double flat_coefficient(double angle_rad, const FlatLoading& loading);

/// The same for a Brazilian test.
double flat_coefficient(const Specimen& specimen, const ModelSpec& model, const GrainMaterial& grain,
                        const ContactMaterial& contact, const TestSpec& test);

}  // namespace feldspar
