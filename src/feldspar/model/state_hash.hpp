// Fingerprints of what a test has done to its body: two states are the same to the last bit if, and but for chance only if, these
// are.
#pragma once

#include <cstdint>

#include "feldspar/model/assembly.hpp"

namespace feldspar {

/// XXH3, 64 bits, of each part of the state, so that a difference tells where it is. They do not depend on how packs and bands
/// arrange the arrays: bodies, their nodes, contacts and contact points are taken in the order of their numbers.
struct StateHash {
    std::uint64_t motion = 0;  ///< displacements and velocities of the nodes
    std::uint64_t bonds = 0;   ///< un, us, Fn, Fs, the largest un and |us|, and damage of every contact point
    std::uint64_t breaks = 0;  ///< when and how points broke; contacts that were made or dropped
    std::uint64_t work = 0;    ///< of damping and pressure on every body; dissipated by softening and friction at every point
};

StateHash hash_state(const Assembly& assembly);

}  // namespace feldspar
