// Ctrl-C and its relatives: the first asks the run to end cleanly, the second ends the program at once.
#pragma once

#include <atomic>

namespace feldspar {

/// Catches SIGINT, SIGTERM and SIGHUP (unless they are ignored already, as under nohup), and turns a broken pipe and a
/// file-size limit into failed writes instead of sudden ends.
void install_signal_handlers();

/// As if the user had asked: everything that runs ends at its next record.
void request_stop();

/// True once the user has asked to stop.
const std::atomic<bool>& stop_requested();

}  // namespace feldspar
