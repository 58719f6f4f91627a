// Ctrl-C and its relatives: the first asks the run to end cleanly, the second ends the program at once.
#pragma once

#include <atomic>

namespace feldspar {

/// Catches SIGINT, SIGTERM and SIGHUP (unless they are ignored already, as under nohup), and turns a broken pipe and a
/// file-size limit into failed writes instead of sudden ends.
void install_signal_handlers();

/// True once the user has asked to stop, or what failed asks the rest to end.
std::atomic<bool>& stop_requested();

}  // namespace feldspar
