// What counts as undisturbed, and the numbers that are made of blocks.
#include <gtest/gtest.h>

#include <cmath>

#include "sample_report.hpp"

namespace feldspar::benchmarks {
namespace {

constexpr QuietRule kRule{.share = 0.9, .blocks = 3};

TEST(Median, IsTheMiddleOrTheMeanOfTheMiddleTwo) {
    EXPECT_DOUBLE_EQ(median({3.0, 1.0, 2.0}), 2.0);
    EXPECT_DOUBLE_EQ(median({4.0, 1.0, 2.0, 100.0}), 3.0);
    EXPECT_DOUBLE_EQ(median({7.0}), 7.0);
    EXPECT_TRUE(std::isnan(median({})));
}

TEST(QuietBlock, NeedsBothCalibrationsNearTheBest) {
    Block block = sample_block(1.0);
    EXPECT_TRUE(is_quiet(block, 1, 100.0, kRule));
    EXPECT_TRUE(is_quiet(block, 1, 111.0, kRule));
    EXPECT_FALSE(is_quiet(block, 1, 112.0, kRule));
    block.before.multiply_add = 80.0;
    EXPECT_FALSE(is_quiet(block, 1, 100.0, kRule));
    block = sample_block(1.0);
    block.after.multiply_add = 80.0;
    EXPECT_FALSE(is_quiet(block, 1, 100.0, kRule));
}

TEST(QuietBlock, OfOneThreadMustHaveComputedAllTheTime) {
    Block block = sample_block(1.0);
    block.cpu_s = 0.8 * block.wall_s;  // somebody else had the core for a while, and calibrations on both sides did not see it
    EXPECT_FALSE(is_quiet(block, 1, 100.0, kRule));
    EXPECT_TRUE(is_quiet(block, 2, 100.0, kRule)) << "a thread that waits for another may sleep";
}

TEST(QuietBlock, HadItsCoresAllTheTime) {
    for (const int threads : {1, 2}) {
        Block block = sample_block(1.0);
        block.waited_s = 0.09 * block.wall_s;
        EXPECT_TRUE(is_quiet(block, threads, 100.0, kRule));
        block.waited_s = 0.11 * block.wall_s;
        EXPECT_FALSE(is_quiet(block, threads, 100.0, kRule));
    }
}

TEST(Summary, TakesBestAndMedianOfTheUndisturbedBlocks) {
    Reading reading = sample_reading("a", 0.5);
    reading.blocks.push_back(
        sample_block(0.1, 50.0));  // faster than the others, which its calibration does not explain: not counted
    const Summary summary = summarise(reading, {{1, 100.0}}, kRule);
    EXPECT_DOUBLE_EQ(summary.best_s, 0.5e-3);
    EXPECT_DOUBLE_EQ(summary.median_s, 0.55e-3);
    EXPECT_DOUBLE_EQ(summary.cpu_s, 0.5e-3);
    EXPECT_DOUBLE_EQ(summary.memory_rate, 20.0);
    EXPECT_EQ(summary.quiet_blocks, 3);
    EXPECT_FALSE(summary.disturbed);
}

TEST(Summary, HasTheMedianOfTheSlowerMemoryRates) {
    Reading reading = sample_reading("a", 0.5);
    reading.blocks[0].before.memory = 10.0;
    reading.blocks[1].after.memory = 15.0;
    EXPECT_DOUBLE_EQ(summarise(reading, {{1, 100.0}}, kRule).memory_rate, 15.0);
}

TEST(Summary, IsMarkedWithTooFewUndisturbedBlocks) {
    Reading reading = sample_reading("a", 0.5);
    reading.blocks[1].after.multiply_add = 60.0;  // the fastest
    const Summary summary = summarise(reading, {{1, 100.0}}, kRule);
    EXPECT_TRUE(summary.disturbed);
    EXPECT_EQ(summary.quiet_blocks, 2);
    EXPECT_DOUBLE_EQ(summary.best_s, 0.55e-3);
}

TEST(Summary, TakesAllBlocksIfNoneWasUndisturbed) {
    const Summary summary = summarise(sample_reading("a", 0.5, 60.0), {{1, 100.0}}, kRule);
    EXPECT_TRUE(summary.disturbed);
    EXPECT_EQ(summary.quiet_blocks, 0);
    EXPECT_DOUBLE_EQ(summary.best_s, 0.5e-3);
    EXPECT_DOUBLE_EQ(summary.median_s, 0.55e-3);
}

// A better calibration that comes late shows that earlier readings were disturbed.
TEST(Summary, IsJudgedByTheBestOfTheWholeRun) {
    const Reading reading = sample_reading("a", 0.5, 100.0);
    EXPECT_FALSE(summarise(reading, {{1, 105.0}}, kRule).disturbed);
    EXPECT_TRUE(summarise(reading, {{1, 120.0}}, kRule).disturbed);
}

TEST(Summary, OfNoBlocksIsNotANumber) {
    const Summary summary = summarise(Reading{}, {}, kRule);
    EXPECT_TRUE(std::isnan(summary.best_s));
    EXPECT_TRUE(std::isnan(summary.median_s));
    EXPECT_TRUE(summary.disturbed);
}

}  // namespace
}  // namespace feldspar::benchmarks
