// The page of a study whose runs are under way.
#pragma once

#include <chrono>

#include "feldspar/live/live_board.hpp"
#include "feldspar/study/ledger.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {

/// Writes the page of a study (study_report.hpp) with the runs that have ended so far, at once and again as more end, and tells
/// the board of it, which shows it below what is going on. All calls on one thread. A page that cannot be written is given up
/// here: the study goes on, and its last page says what is wrong.
class GrowingPage {
public:
    /// @param study, ledger, board  outlive it
    /// @param pause  at least so long between two pages; longer where one takes more than a fiftieth of it
    GrowingPage(const Study& study, const Ledger& ledger, LiveBoard& board,
                std::chrono::milliseconds pause = std::chrono::seconds(2));

    /// A run has ended.
    void more() { old_ = true; }
    /// Writes the page if runs have ended since it was written, unless that is too short ago.
    void renew_if_due();

private:
    using Clock = std::chrono::steady_clock;

    void write();

    const Study& study_;
    const Ledger& ledger_;
    LiveBoard& board_;
    const Clock::duration pause_;
    Clock::time_point not_before_{};
    bool old_ = true, given_up_ = false;
};

}  // namespace feldspar
