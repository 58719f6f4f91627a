// What a page that looks at a run is sent: news since the last time, as JSON.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "feldspar/live/live_board.hpp"

namespace feldspar {

/// The news of a board for one page. The first ones hold everything.
///
/// `run`: name, what it is busy with, tests, at_most (whether there may be fewer), ended, failed, seconds_left, reports (how
/// often the report has been written), over (how the run ended; null while it goes on), ending, cost (LiveBoard::cost()).
/// `tests`, those of which there is something new: n (from 0 on), label, state, words, progress; and of a running one the parts
/// `axes`; `curve` and `cracks` with `from` (how many the page has already: those behind are to be forgotten) and the new ones by
/// columns; `outline`, once: corners of the grains in steps of `scale` from (x0, y0), mm (`begin` int32, `points` uint16 x, y);
/// `frame`: displacements of these corners (int16 all x, then all y, in steps of `scale` mm). Numbers in blocks are
/// little-endian, as base64.
class LiveStream {
public:
    explicit LiveStream(LiveBoard& board);
    ~LiveStream();
    LiveStream(const LiveStream&) = delete;
    LiveStream& operator=(const LiveStream&) = delete;

    /// Waits for news, at most so long. @return them; empty if there are none
    std::string next(std::chrono::milliseconds at_most);
    /// Whether the page has been told that the run is over.
    bool at_end() const { return at_end_; }

private:
    // What the page has of a test.
    struct Seen {
        std::uint64_t version = 0;
        int curve_round = 0, crack_round = 0;
        std::size_t points = 0, cracks = 0;
        bool axes = false, outline = false;
        std::shared_ptr<const LiveFrame> frame;
    };

    LiveBoard& board_;
    std::uint64_t version_ = 0;
    std::vector<Seen> seen_;
    bool at_end_ = false;
};

/// "waiting", "running", "writing", "ended" or "failed".
const char* name(LiveState state);

}  // namespace feldspar
