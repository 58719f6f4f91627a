// When a measurement stops, with calibrations that are made up. The times themselves are whatever they are.
#include <gtest/gtest.h>

#include "benchmarks/measure.hpp"

namespace feldspar::benchmarks {
namespace {

// Counts steps, and takes long enough that a block is soon full.
struct Work {
    long long steps = 0;
    void operator()(int count) {
        steps += count;
        volatile double x = 0.0;
        for (int k = 0; k < 20000; ++k) x = x + 1.0;
    }
};

double never() { return 0.0; }  // a thread has to wait for a core

MeasureSettings short_blocks() {
    MeasureSettings settings;
    settings.quiet = {.share = 0.9, .blocks = 4};
    settings.most_blocks = 12;
    settings.block_s = 1e-6;
    return settings;
}

TEST(Measure, StopsWhenEnoughBlocksWereUndisturbed) {
    double best = 100.0;
    Work work;
    const auto blocks = measure([&](int n) { work(n); }, [] { return Rates{100.0, 20.0}; }, never, 2, short_blocks(), best);
    EXPECT_EQ(blocks.size(), 4u);
    for (const Block& block : blocks) {
        EXPECT_GE(block.steps, 1);
        EXPECT_GT(block.wall_s, 0.0);
        EXPECT_GE(block.cpu_s, 0.0);
    }
    EXPECT_GT(work.steps, 4) << "besides the blocks there is a warm-up";
}

TEST(Measure, GivesUpAfterTheMostBlocks) {
    double best = 100.0;
    Work work;
    const auto blocks = measure([&](int n) { work(n); }, [] { return Rates{50.0, 20.0}; }, never, 2, short_blocks(), best);
    EXPECT_EQ(blocks.size(), 12u);
    EXPECT_DOUBLE_EQ(best, 100.0);
}

TEST(Measure, RepeatsDisturbedBlocks) {
    double best = 100.0;
    int calls = 0;
    Work work;
    // The third and fourth calibration are low: they spoil the blocks 2, 3 and 4.
    const auto blocks = measure([&](int n) { work(n); },
                                [&] {
                                    return Rates{++calls == 3 || calls == 4 ? 40.0 : 100.0, 20.0};
                                },
                                never, 2, short_blocks(), best);
    EXPECT_EQ(blocks.size(), 7u);
    EXPECT_DOUBLE_EQ(blocks[1].after.multiply_add, 40.0);
    EXPECT_DOUBLE_EQ(blocks[2].before.multiply_add, 40.0);
}

TEST(Measure, RepeatsBlocksThatHadToWaitForACore) {
    double best = 100.0, waited = 0.0;
    int calls = 0;
    Work work;
    // Two calls a block, and some before in the warm-up; every second block waits for ever.
    const auto blocks = measure([&](int n) { work(n); },
                                [] {
                                    return Rates{100.0, 20.0};
                                },
                                [&] { return ++calls % 4 == 0 ? waited += 1000.0 : waited; }, 2, short_blocks(), best);
    EXPECT_GE(blocks.size(), 7u);
    EXPECT_LE(blocks.size(), 8u);
}

TEST(Measure, LearnsABetterCalibrationAndCountsAnew) {
    double best = 80.0;
    int calls = 0;
    Work work;
    const auto blocks = measure([&](int n) { work(n); },
                                [&] {
                                    return Rates{++calls <= 3 ? 80.0 : 100.0, 20.0};
                                },
                                never, 2, short_blocks(), best);
    EXPECT_DOUBLE_EQ(best, 100.0);
    EXPECT_EQ(blocks.size(), 7u) << "two blocks at 80, one that ends at 100, four at 100";
}

}  // namespace
}  // namespace feldspar::benchmarks
