// Fixtures that several methods share: two platens at the ends of a specimen, and a pressure on its sides.
#pragma once

#include <vector>

#include "feldspar/methods/method.hpp"

namespace feldspar {

/// How the plates of a test touch its specimen, as the job or the method says.
PlateContact plate_contact(const MethodInput& in);

/// Platens on the ends labelled "top", which moves, and "bottom": rows of nodes of flexible grains, plates elsewhere, and where
/// they have friction. Under a confining pressure also what carries it: the other edges themselves, or membranes of plates (rigid
/// grains and inner particles).
std::vector<FixtureSpec> between_platens(const MethodInput& in);

/// Of the specimen, along the load, m.
double height_m(const MethodInput& in);

/// Width (m) of the section that axial stresses are taken over: the narrowest across the load.
/// @param loaded_width_m  extent of the loaded end, which is returned bit for bit where no section is narrower
double section_width_m(const Outline& outline, double loaded_width_m);

/// The same times the thickness, m2.
double narrowest_section_m2(const MethodInput& in);

/// How a test between two platens is built.
inline const MethodBuild between_its_platens{between_platens, height_m, narrowest_section_m2, nullptr, {}, nullptr};

}  // namespace feldspar
