// How the threads of the program are shared out among tests.
#pragma once

#include <algorithm>

namespace feldspar {

/// How many tests may run side by side, and on how many threads each.
class Sharing {
public:
    /// @param at_once  what the user wants; 0 = as suits the size
    /// @param threads  of the whole program
    Sharing(int at_once, int threads) : threads_(threads), at_once_(at_once) {}

    int threads() const { return threads_; }

    /// Most tests at once, this one included, that go with a test of so many bodies.
    int most_at_once(int bodies) const {
        if (at_once_ > 0) return std::min(at_once_, threads_);
        return bodies < large_body_count ? threads_ : 1;
    }

    /// More threads than this make such a test no faster.
    int useful_threads(int bodies) const {
        return at_once_ > 0 ? threads_ : std::clamp(bodies / least_bodies_per_thread, 1, threads_);
    }

private:
    // From here on a test gets all threads: they work together as well as apart, and many tests of this size at once would fill
    // the memory (some 140 MB each).
    static constexpr int large_body_count = 20000;

    // With fewer bodies than this a thread waits at the barriers of a step for longer than it works.
    static constexpr int least_bodies_per_thread = 50;

    int threads_;
    int at_once_;
};

}  // namespace feldspar
