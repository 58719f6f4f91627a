// How a state of an assembly is kept (base/state_archive.hpp): what of its structures does not show its members by itself.
#pragma once

#include "feldspar/base/state_archive.hpp"
#include "feldspar/model/assembly.hpp"

namespace feldspar {

static_assert(sizeof(SideLine) == 8 * sizeof(double));
template <>
inline constexpr bool kept_as_doubles<SideLine> = true;

template <class Archive>
void keep(Archive& archive, BondLaw& law) {
    static_assert(sizeof(BondLaw) == sizeof(BondLawOf<double>), "a law of one class has no members of its own");
    archive(static_cast<BondLawOf<double>&>(law));
}

}  // namespace feldspar
