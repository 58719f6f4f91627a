// Bands: the order in which a specimen larger than the caches takes several steps in one sweep.
//
// Units (packs of grains, and rigid bodies) are numbered from the bottom to the top. Bands are consecutive units and consecutive
// packs of contacts, cut so that the contacts of a band join only bodies of that band and of the one before. So contacts of band
// b wait for bodies of b - 1 and b alone, and bodies of b for contacts of b and b + 1: a step may begin at the bottom while the
// one before is on its way up (step/advance_packs.cpp), and the state between the two stays in the cache. The nodes of the
// loading platen lie in one band or in two that follow each other, so that there is a moment when all feel the forces of the same
// step.
#pragma once

#include <cstdint>
#include <vector>

#include "feldspar/base/parallel.hpp"

namespace feldspar {

struct Assembly;

/// What a thread, a band or a whole step takes of the packs.
struct PackRanges {
    IndexRange contacts, loose_contacts;     ///< into Packs::contacts, Packs::loose_contacts
    IndexRange grains, rigid, loose_bodies;  ///< into Packs::grains, Assembly::bodies, Packs::loose_bodies
};

/// What a program may expect of a core's own cache, and of one that it shares with others. A larger state is swept in bands.
inline constexpr double kOwnCacheBytes = 2.0 * (1 << 20), kSharedCacheBytes = 32.0 * (1 << 20);

struct Bands {
    std::vector<PackRanges> ranges;    ///< from the bottom to the top; those of loose contacts are known from sort_out_packs() on
    int platen = 0;                    ///< once the bodies of this band have moved, the forces on the loading platen are complete
    double bytes = 0.0;                ///< that a step streams through, about
    std::vector<double> window_bytes;  ///< between the first and the last of 2, 3, ... steps at once, where that is most

    /// Of one sweep, so that the window stays in the own cache of a single thread, or in the shared one; 1: sweeps would not pay.
    /// Several threads, which wait for each other twice a band, gain from the shared one only.
    int steps(int threads) const;
};

/// Orders the packs of contacts and the plates by band, and says where each band begins and ends. After packs of contacts, or
/// platens, were made.
void cut_into_bands(Assembly& assembly);

}  // namespace feldspar
