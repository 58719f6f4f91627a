// The page of a run that goes on: its report so far with what is going on above it.
#pragma once

#include <string>

#include "feldspar/live/live_board.hpp"

namespace feldspar {

/// @param report  the text of the run's report.html; empty while there is none
/// @param name    of the run
/// @param over    how the run ended, in words; empty while it goes on
/// @param words   what things are called
std::string live_page(const std::string& report, const std::string& name, const std::string& over, const LiveWords& words = {});

}  // namespace feldspar
