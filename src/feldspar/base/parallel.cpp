#include "feldspar/base/parallel.hpp"

#include <algorithm>
#include <exception>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace feldspar {
namespace {

// Spins while `waiting()` holds. A barrier between two stages is a matter of 100 ns, so spinning is right as long as every
// thread has a core of its own; after a while we give the core away, because then it has not.
template <class Condition>
void spin_while(Condition waiting) {
    for (int turn = 0; waiting(); ++turn) {
        if (turn < 300) {
#if defined(__x86_64__)
            _mm_pause();
#endif
        } else {
            std::this_thread::yield();
        }
    }
}

}  // namespace

Team::Team(int threads) : size_(1) { grow(threads); }

void Team::grow(int threads) {
    const std::uint32_t seen = round_.load(std::memory_order_relaxed);  // a newcomer has no part in earlier rounds
    for (; size_ < threads; ++size_) workers_.emplace_back([this, thread = size_, seen] { serve(thread, seen); });
}

Team::~Team() {
    closing_ = true;
    ++round_;
    round_.notify_all();
}

void Team::run(const std::function<void(int)>& work) {
    if (size_ == 1) return work(0);
    work_ = &work;
    unfinished_ = size_ - 1;
    ++round_;
    round_.notify_all();
    work(0);
    spin_while([this] { return unfinished_.load(std::memory_order_acquire) > 0; });
}

void Team::serve(int thread, std::uint32_t seen) {
    for (;;) {
        for (int turn = 0; turn < 20000 && round_.load(std::memory_order_acquire) == seen; ++turn) {
#if defined(__x86_64__)
            _mm_pause();
#endif
        }
        round_.wait(seen);  // sleeps only if no new round has come
        seen = round_.load(std::memory_order_acquire);
        if (closing_) return;
        (*work_)(thread);
        unfinished_.fetch_sub(1, std::memory_order_release);
    }
}

void Team::barrier() {
    if (size_ == 1) return;
    const std::uint32_t generation = generation_.load(std::memory_order_relaxed);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == size_) {
        arrived_.store(0, std::memory_order_relaxed);
        generation_.store(generation + 1, std::memory_order_release);
    } else {
        spin_while([&] { return generation_.load(std::memory_order_acquire) == generation; });
    }
}

void side_by_side(int count, int threads, const std::function<void(int)>& work) {
    std::vector<std::exception_ptr> thrown(static_cast<std::size_t>(std::max(count, 0)));
    std::atomic<int> next{0};
    std::atomic<bool> failed{false};
    const auto take_turns = [&] {
        // whoever takes a number works on it, and they are taken in order: all before one that failed are done, so that the
        // smallest that fails is found
        while (!failed) {
            const int i = next++;
            if (i >= count) return;
            try {
                work(i);
            } catch (...) {
                thrown[static_cast<std::size_t>(i)] = std::current_exception();
                failed = true;
            }
        }
    };
    {
        std::vector<std::jthread> others;
        for (int thread = 1; thread < std::min(threads, count); ++thread) others.emplace_back(take_turns);
        take_turns();
    }
    for (const std::exception_ptr& problem : thrown)
        if (problem) std::rethrow_exception(problem);
}

}  // namespace feldspar
