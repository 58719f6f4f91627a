// The runs of a ledger on a live board (live/live_board.hpp) while they are made.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "feldspar/live/live_board.hpp"
#include "feldspar/study/growing_page.hpp"
#include "feldspar/study/run_record.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {

/// Told of runs by execute(). What it shows changes nothing of them, but a run that the user ends on a page has no result.
/// plan() is called before runs begin; watch() on the thread of its run; all else on the thread of execute().
class LiveRuns {
public:
    /// @param board  outlives it
    /// @param label  "rigid: biaxial at 4 MPa, seed 1"
    /// @param words  "114 MPa, grade B", or why it failed
    /// @param page   is renewed as runs end; may be null
    LiveRuns(LiveBoard& board, std::function<std::string(const Run&)> label, std::function<std::string(const RunRecord&)> words,
             GrowingPage* page = nullptr)
        : board_(board), label_(std::move(label)), words_(std::move(words)), page_(page) {}

    /// These are to be made, those besides that it knows already.
    void plan(std::span<const Run* const> runs);
    /// Done or failed, here, before, or by another process.
    void settled(const RunRecord& record);
    /// Its packing is made.
    void begins(const Run& run);
    /// It runs on this specimen. @return who looks at it, until the board goes away
    TestWatch& watch(const Run& run, std::shared_ptr<const Specimen> specimen);
    void progress(const Run& run, const TestProgress& state);
    /// It no longer runs, and its files are being written.
    void written(const Run& run);
    /// It was interrupted.
    void waits(const Run& run);

private:
    std::size_t number_of(const std::string& id) const { return numbers_.at(id); }

    LiveBoard& board_;
    std::function<std::string(const Run&)> label_;
    std::function<std::string(const RunRecord&)> words_;
    GrowingPage* page_;
    std::map<std::string, std::size_t> numbers_;  // on the board, by the runs' ids
};

}  // namespace feldspar
