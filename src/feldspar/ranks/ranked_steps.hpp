// Steps that ranks make together: each those of its own bodies, with what it has to know of the others exchanged behind each
// step. Behind a block of steps every rank has the whole state, with the bits of a program that is alone.
#pragma once

#include <memory>

#include "feldspar/ranks/communicator.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {

/// What a rank has sent and received, and where its time went, since it was opened.
struct RankTraffic {
    long long steps = 0, blocks = 0;
    double bytes_in_steps = 0.0;   ///< sent by this rank, behind the steps
    double bytes_in_blocks = 0.0;  ///< sent by this rank to each other, behind the blocks
    double own_part = 0.0;         ///< contact points that it has computed last, over all
    double exchange_s = 0.0;       ///< behind steps: sending, and waiting for others
    double gather_s = 0.0;         ///< behind blocks
    double share_s = 0.0;          ///< finding out who does what, when contacts have changed
    double all_s = 0.0;
};

/// What makes the steps of one test. All ranks open one at the same time, and make the same calls.
/// @param traffic  kept up to date; may be null
std::unique_ptr<StepDevice> open_ranks(Communicator& ranks, RankTraffic* traffic = nullptr);

}  // namespace feldspar
