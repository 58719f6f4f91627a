// Threads for one computation: a team that stays alive between steps and meets at spin barriers; and for several that have
// nothing to do with each other.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace feldspar {

/// A half-open range of indices.
struct IndexRange {
    int begin = 0;
    int end = 0;
};

/// A fixed number of threads that run the same function side by side. Work is shared out in contiguous ranges; nothing that
/// a thread computes may depend on how many there are, so results have the same bits for any team.
class Team {
public:
    /// @param threads  at least 1; the caller is one of them
    explicit Team(int threads);
    ~Team();
    Team(const Team&) = delete;
    Team& operator=(const Team&) = delete;

    int size() const { return size_; }

    /// More threads from the next run() on; fewer than there are changes nothing. By the caller, between two runs.
    void grow(int threads);

    /// Calls `work(thread)` on every thread, 0 being the caller's, and returns when all have finished. `work` must not throw.
    void run(const std::function<void(int)>& work);

    /// All threads of the running work wait here for each other.
    void barrier();

    /// The contiguous share of [0, count) that belongs to `thread`.
    IndexRange share(int count, int thread) const {
        const auto part = [&](int i) { return static_cast<int>(static_cast<std::int64_t>(count) * i / size_); };
        return {part(thread), part(thread + 1)};
    }

private:
    void serve(int thread, std::uint32_t seen);

    int size_;
    const std::function<void(int)>* work_ = nullptr;
    std::atomic<std::uint32_t> round_{0};  // a new value calls the workers
    std::atomic<int> unfinished_{0};
    std::atomic<int> arrived_{0};
    std::atomic<std::uint32_t> generation_{0};  // of the barrier
    std::atomic<bool> closing_{false};
    std::vector<std::jthread> workers_;
};

/// Calls `work(range, thread)` on every thread of the team for its share of [0, count); without a team on the caller alone, for
/// all. `work` must not throw.
template <class Work>
void in_shares(Team* team, int count, const Work& work) {
    if (team == nullptr || team->size() == 1) return work(IndexRange{0, count}, 0);
    const auto part = [&](int thread) { work(team->share(count, thread), thread); };
    team->run(std::ref(part));  // a reference, so that no call allocates
}

/// Calls work(0) ... work(count - 1), at most `threads` at a time, the caller being one of them. If some throw, none is begun
/// after that, and what the one of the smallest number threw comes out when all have ended: the same whichever was first.
void side_by_side(int count, int threads, const std::function<void(int)>& work);

}  // namespace feldspar
