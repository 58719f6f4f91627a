// What each rank does of a step, and what it has to know of the others': follows from bodies and contacts, and every rank finds
// the same.
#pragma once

#include <cstdint>
#include <vector>

#include "feldspar/model/assembly.hpp"

namespace feldspar {

/// A rank's part of the bodies, and of the contacts whose state it hands on. Every body, and every contact, is of one rank.
struct OwnPart {
    IndexRange grains, rigid;                 ///< packs of grains; rigid bodies
    std::vector<std::int32_t> loose_bodies;   ///< by number
    std::vector<IndexRange> nodes;            ///< of all these bodies
    std::vector<std::int32_t> bodies;         ///< all these
    std::vector<std::int32_t> contact_packs;  ///< into Packs::contacts
    std::vector<std::int32_t> loose_contacts;
};

/// What two ranks have to tell each other behind each step.
struct Border {
    int other = 0;
    std::vector<std::int32_t> lines_out, lines_in;  ///< into Packs::lines
    std::vector<std::int32_t> nodes_out, nodes_in;  ///< for contacts that are in no pack
};

/// One rank's share of the work, and what all own.
struct Share {
    std::vector<OwnPart> parts;               ///< of all ranks
    std::vector<std::int32_t> contact_packs;  ///< that this rank computes: those at its bodies
    std::vector<std::int32_t> loose_contacts;
    std::vector<Border> borders;  ///< of this rank
};

/// How many units there are to share out: packs of grains, rigid bodies, and grains in no pack.
int units_to_share(const Assembly& assembly);

/// The share of `rank` of `size`, at most as many as there are units. After sort_out_packs().
Share share_of_rank(const Assembly& assembly, int rank, int size);

}  // namespace feldspar
