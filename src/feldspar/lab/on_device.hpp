// What a test asks of a graphics card, or of ranks.
#pragma once

#include <string>

#include "feldspar/lab/run_test.hpp"

namespace feldspar {

struct CardNeeds {
    std::string not_ported;  ///< what of the test a card does not know, as a sentence; empty: it can run there
    double bytes = 0.0;      ///< of the card's memory, about
};

/// Builds the test, and runs nothing.
CardNeeds card_needs(const TestSetup& setup, const RunControl& control);

/// How many ranks can make the test together at most. Builds the test, and runs nothing.
int most_ranks(const TestSetup& setup);

}  // namespace feldspar
