// Laws that contacts have of their own: of rocks whose contacts are not alike. Quantity by quantity, so that a pack of contacts
// reads a vector of each.
#pragma once

#include <cstdint>

#include "feldspar/base/array.hpp"
#include "feldspar/laws/bond.hpp"

namespace feldspar {

struct OwnLaws {
    LawForm form;
    LawConstants<Array<double>> constants;

    bool empty() const { return constants.mu.empty(); }
    /// @return the number of the law
    std::int32_t add(const LawConstants<double>& law);
    LawConstants<double> at(std::int32_t i) const;
    double memory_bytes() const;
};

}  // namespace feldspar
