// Rollers that bend a specimen: one above, which loads it, and two below.
#pragma once

#include <vector>

#include "feldspar/methods/method.hpp"

namespace feldspar {

/// Where the rollers of a bending test touch its specimen, m.
struct RollerPlaces {
    Vec2 above, left, right;
    double radius_m = 0.0;  ///< of all three
};

/// The loading roller, which comes down and keeps the specimen from sliding away by its friction, and two supports that roll.
std::vector<FixtureSpec> three_rollers(const MethodInput& in, const RollerPlaces& places);

/// One roller: above it comes down and loads by its friction too, below it is at rest and rolls. @param at  where it touches, m
FixtureSpec roller(const MethodInput& in, const char* name, Vec2 at, double radius_m, bool loads);

/// Friction of the loading roller unless a job gives another.
inline constexpr double kRollerHolds = 0.4;

}  // namespace feldspar
