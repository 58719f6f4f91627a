// Ctrl-C and its relatives: the first asks the run to end cleanly, the second ends the program at once.
#pragma once

#include <atomic>

#include "feldspar/output/checkpoints.hpp"

namespace feldspar {

/// Catches SIGINT, SIGTERM and SIGHUP (unless they are ignored already, as under nohup) and SIGUSR1, by which the user asks for
/// the states of running tests to be kept now; turns a broken pipe and a file-size limit into failed writes instead of sudden
/// ends.
void install_signal_handlers();

/// True once the user has asked to stop, or what failed asks the rest to end.
std::atomic<bool>& stop_requested();

/// When running tests keep their states: as often as the command line says, and when the user asks.
CheckpointSettings& checkpoint_settings();

}  // namespace feldspar
