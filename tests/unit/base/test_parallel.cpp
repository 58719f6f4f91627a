// Teams, computations side by side, and how threads are shared between them.
#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "feldspar/base/parallel.hpp"
#include "feldspar/base/thread_shares.hpp"
#include "feldspar/base/usable_cores.hpp"

namespace feldspar {
namespace {

// Every share once, whatever the number of threads.
void expect_all_done(Team& team) {
    std::vector<int> done(1000, 0);
    team.run([&](int thread) {
        const IndexRange share = team.share(1000, thread);
        for (int i = share.begin; i < share.end; ++i) ++done[static_cast<std::size_t>(i)];
        team.barrier();
    });
    EXPECT_EQ(done, std::vector<int>(1000, 1)) << team.size();
}

TEST(Team, GrowsBetweenTwoRuns) {
    Team team(1);
    for (int threads : {1, 2, 2, 1, 3, 5}) {
        team.grow(threads);
        EXPECT_GE(team.size(), threads);
        for (int round = 0; round < 20; ++round) expect_all_done(team);
    }
    EXPECT_EQ(team.size(), 5);  // it never shrinks
}

TEST(Team, MayGrowWithoutEverRunning) {
    Team team(2);
    team.grow(4);
    EXPECT_EQ(team.size(), 4);
}

TEST(SideBySide, CallsEachOnceOnAnyNumberOfThreads) {
    for (int threads : {1, 2, 7}) {
        std::vector<std::atomic<int>> calls(40);
        side_by_side(40, threads, [&](int i) { ++calls[static_cast<std::size_t>(i)]; });
        for (const auto& count : calls) EXPECT_EQ(count, 1);
    }
    side_by_side(0, 4, [](int) { FAIL(); });
}

TEST(SideBySide, ThrowsWhatTheFirstInOrderThrew) {
    for (int threads : {1, 2, 3}) {
        std::atomic<bool> later_failed{false};
        std::atomic<int> begun{0};
        std::string message;
        try {
            side_by_side(1000, threads, [&](int i) {
                ++begun;
                if (i == 3) {
                    while (threads > 1 && !later_failed) std::this_thread::yield();  // it fails last in time
                    throw std::runtime_error("3");
                }
                if (i > 3) {
                    later_failed = true;
                    throw std::runtime_error("later");
                }
            });
        } catch (const std::runtime_error& error) {
            message = error.what();
        }
        EXPECT_EQ(message, "3") << threads;
        EXPECT_LT(begun, 20);  // the rest was not begun
    }
}

TEST(ThreadShares, TheFreeThreadsGoToThoseThatStart) {
    EXPECT_EQ(share_for_next(2, 2, 100), 1);
    EXPECT_EQ(share_for_next(16, 16, 100), 1);
    EXPECT_EQ(share_for_next(16, 3, 100), 5);
    EXPECT_EQ(share_for_next(11, 2, 100), 5);
    EXPECT_EQ(share_for_next(6, 1, 100), 6);
    EXPECT_EQ(share_for_next(6, 1, 4), 4);    // no more than it can use
    EXPECT_EQ(share_for_next(1, 5, 100), 1);  // never none
    EXPECT_EQ(share_for_next(8, 1, 0), 1);
}

TEST(ThreadShares, FreeThreadsGoToThoseWithTheFewest) {
    using List = std::vector<int>;
    const List many{100, 100, 100};
    EXPECT_EQ(shares_with(2, List{1, 1, 2}, many), (List{2, 2, 2}));
    EXPECT_EQ(shares_with(3, List{1, 5, 1}, many), (List{3, 5, 2}));
    EXPECT_EQ(shares_with(9, List{1, 1, 1}, List{2, 1, 3}), (List{2, 1, 3}));
    EXPECT_EQ(shares_with(0, List{1, 2, 1}, many), (List{1, 2, 1}));
    EXPECT_TRUE(shares_with(4, List{}, List{}).empty());
}

TEST(UsableCores, FollowTheAffinityOfTheProcess) {
    const int before = usable_cores();
    EXPECT_GE(before, 1);
    cpu_set_t all, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
    int core = 0;
    while (!CPU_ISSET(core, &all)) ++core;
    CPU_ZERO(&one);
    CPU_SET(core, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    EXPECT_EQ(usable_cores(), 1);
    ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
    EXPECT_EQ(usable_cores(), before);
}

TEST(UsableCores, ReadTheShareOfAControlGroup) {
    EXPECT_EQ(cores_of_quota("150000 100000"), 1.5);
    EXPECT_EQ(cores_of_quota("max 100000"), std::nullopt);
    EXPECT_EQ(cores_of_quota("-1 100000"), std::nullopt);
    EXPECT_EQ(cores_of_quota(" "), std::nullopt);
    EXPECT_EQ(cores_of_quota("rubbish"), std::nullopt);
}

}  // namespace
}  // namespace feldspar
