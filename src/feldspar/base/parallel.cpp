#include "feldspar/base/parallel.hpp"

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

Team::Team(int threads) : size_(threads < 1 ? 1 : threads) {
    for (int thread = 1; thread < size_; ++thread) workers_.emplace_back([this, thread] { serve(thread); });
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

void Team::serve(int thread) {
    std::uint32_t seen = 0;
    for (;;) {
        for (int turn = 0; turn < 20000 && round_.load(std::memory_order_acquire) == seen; ++turn) {
#if defined(__x86_64__)
            _mm_pause();
#endif
        }
        round_.wait(seen);   // sleeps only if no new round has come
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

}  // namespace feldspar
