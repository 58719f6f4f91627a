// Elastic stress fields around a round hole and around the tip of a crack, fitted to the stresses of grains
// (docs/theory/properties.md, (P43)-(P45)). A fit is worked out once; what remains to be done of it is a sum of weights times
// stresses.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// A stress field of plane elasticity: symmetric, tension positive, at a place relative to the field's centre, m.
using StressField = std::function<Mat2(Vec2)>;

/// Fields that leave the edge of a round hole free of traction, of Michell's series: those that are uniform far from it, and
/// those that grow with the distance and with its square, which a near boundary or a bent body add.
/// @param radius_m      of the hole, > 0
/// @param uniform_only  the three that are uniform far from it, no more
std::vector<StressField> fields_around_hole(double radius_m, bool uniform_only = false);

/// Fields that leave the faces of a crack free of traction, of Williams' series: six that open it and five that shear it. The
/// first of all has K_I = 1 Pa sqrt(m), the first that shears it, which is the second of all, K_II = 1 Pa sqrt(m).
/// @param ahead     unit vector from the tip away from the crack
/// @param extent_m  about the distance from the tip up to which they are used, > 0, for scaling
std::vector<StressField> fields_around_tip(Vec2 ahead, double extent_m);

/// A point at which a field is compared with the stress of a cell: a triangle or a grain.
struct StressSample {
    std::int32_t cell = 0;
    double area_m2 = 0.0;  ///< of the cell that the point stands for
    Vec2 at;               ///< m, relative to the field's centre
};

/// What the stress of a cell contributes to a value: weight.xx times xx plus weight.xy times xy and so on.
struct StressTerm {
    std::int32_t cell = 0;
    Mat2 weight;
};

/// Weights with which stresses of cells give the sum of `wanted` times the factors of the fields that fit them best: least
/// squares over the area. Samples of a cell follow each other; the stress of a cell stands for the mean of a field over its
/// samples.
/// @param wanted  one a field. @return no terms if the cells do not determine the factors
std::vector<StressTerm> fitted_value(std::span<const StressSample> samples, std::span<const StressField> fields,
                                     std::span<const double> wanted);

}  // namespace feldspar
