// The live view of a run, if the user wants one: the board that the run fills, and the server that shows it.
#pragma once

#include <optional>
#include <string>

#include "commands.hpp"
#include "feldspar/live/live_board.hpp"
#include "feldspar/live/live_server.hpp"

namespace feldspar {

class LiveView {
public:
    /// Listens, and prints where, if the options ask for it; else nothing here does anything. @throws InputError if it cannot
    /// listen there
    LiveView(const LiveOptions& options, const std::string& name, LiveWords words = {});

    /// What the run fills; null without a live view.
    LiveBoard* board() { return board_ ? &*board_ : nullptr; }
    void busy(const std::string& what);
    /// All is over: pages become its report. @param words  how it ended, in sentences
    void over(const std::string& words);

private:
    std::optional<LiveBoard> board_;
    std::optional<LiveServer> server_;  // behind the board, that it goes away first
};

}  // namespace feldspar
