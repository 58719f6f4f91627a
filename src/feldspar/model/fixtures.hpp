// What loads or holds a specimen (model/fixture_spec.hpp), put to its boundary.
#pragma once

#include <span>
#include <string>

#include "feldspar/model/assembly.hpp"
#include "feldspar/model/fixture_spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Puts the fixtures to the boundary, in their order. A plate starts at first touch: curved ones differ from flat ones in the
/// gaps that are left there. @throws InputError  if a part catches no edge, a membrane's side is not straight along its plates,
/// or one of its plates has no body behind it
void attach(Assembly& assembly, const Specimen& specimen, std::span<const FixtureSpec> fixtures);

/// Extent of the boundary with this label along x, undeformed, m; 0 without any.
double labelled_width_m(const Specimen& specimen, const std::string& label);

}  // namespace feldspar
