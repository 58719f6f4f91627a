// Ratios of two reports, and which of them count.
#include <gtest/gtest.h>

#include "benchmarks/compare.hpp"
#include "benchmarks/table.hpp"
#include "sample_report.hpp"

namespace feldspar::benchmarks {
namespace {

Report report_of(std::vector<Reading> readings) {
    Report report = sample_report();
    report.readings = std::move(readings);
    return report;
}

TEST(Compare, GivesTheRatioOfTheBestTimes) {
    const Comparison c = compare(report_of({sample_reading("a", 1.0), sample_reading("b", 1.0), sample_reading("c", 1.0)}),
                                 report_of({sample_reading("a", 1.2), sample_reading("b", 0.5), sample_reading("c", 1.04)}));
    ASSERT_EQ(c.changes.size(), 3u);
    EXPECT_NEAR(c.changes[0].ratio, 1.2, 1e-12);
    EXPECT_TRUE(c.changes[0].slower());
    EXPECT_NEAR(c.changes[1].ratio, 0.5, 1e-12);
    EXPECT_TRUE(c.changes[1].faster());
    EXPECT_FALSE(c.changes[2].slower() || c.changes[2].faster()) << "within 5 %";
    ASSERT_TRUE(worst_slowdown_percent(c).has_value());
    EXPECT_NEAR(*worst_slowdown_percent(c), 20.0, 1e-9);
}

TEST(Compare, DoesNotTrustDisturbedReadings) {
    for (const bool disturbed_before : {true, false}) {
        const Comparison c = compare(report_of({sample_reading("a", 1.0, disturbed_before ? 60.0 : 100.0)}),
                                     report_of({sample_reading("a", 2.0, disturbed_before ? 100.0 : 60.0)}));
        ASSERT_EQ(c.changes.size(), 1u);
        EXPECT_NEAR(c.changes[0].ratio, 2.0, 1e-12);
        EXPECT_FALSE(c.changes[0].slower());
        EXPECT_FALSE(worst_slowdown_percent(c).has_value());
    }
}

// The calibration in registers does not see who else uses the shared cache.
TEST(Compare, DoesNotTrustAnotherMemoryRate) {
    for (const double rate : {20.0, 23.0, 18.0}) {
        Reading reading = sample_reading("a", 2.0);
        for (Block& block : reading.blocks) block.before.memory = block.after.memory = rate;
        EXPECT_TRUE(compare(report_of({sample_reading("a", 1.0)}), report_of({reading})).changes[0].slower()) << rate;
    }
    for (const double rate : {25.0, 15.0}) {
        Reading reading = sample_reading("a", 2.0);
        for (Block& block : reading.blocks) block.before.memory = block.after.memory = rate;
        EXPECT_FALSE(compare(report_of({sample_reading("a", 1.0)}), report_of({reading})).changes[0].slower()) << rate;
    }
}

TEST(Compare, DoesNotTrustAnotherSpecimen) {
    Reading smaller = sample_reading("a", 2.0);
    smaller.counts.points -= 1;
    EXPECT_FALSE(compare(report_of({sample_reading("a", 1.0)}), report_of({smaller})).changes[0].slower());
    Reading layout = sample_reading("a", 2.0);  // other numbers of nodes and bytes are another layout of the same work
    layout.counts.nodes += 8;
    layout.counts.memory_bytes *= 2.0;
    EXPECT_TRUE(compare(report_of({sample_reading("a", 1.0)}), report_of({layout})).changes[0].slower());
}

TEST(Compare, NamesWhatOnlyOneReportHas) {
    const Comparison c = compare(report_of({sample_reading("a", 1.0), sample_reading("gone", 1.0)}),
                                 report_of({sample_reading("new", 1.0), sample_reading("a", 1.0)}));
    EXPECT_EQ(c.changes.size(), 1u);
    EXPECT_EQ(c.only_old, std::vector<std::string>{"gone"});
    EXPECT_EQ(c.only_new, std::vector<std::string>{"new"});
}

TEST(Compare, SaysWhatElseDiffers) {
    Report before = sample_report(), after = sample_report();
    EXPECT_TRUE(compare(before, after).differences.empty());
    after.machine.processor = "another";
    after.machine.build_type = "Debug";
    after.best[1] = 70.0;
    after.machine.commit = "def";  // that is what is compared
    EXPECT_EQ(compare(before, after).differences.size(), 3u);
}

TEST(ComparisonTable, MarksWhatBecameSlower) {
    const std::string table = comparison_table(
        compare(report_of({sample_reading("a", 1.0), sample_reading("b", 1.0), sample_reading("c", 1.0)}),
                report_of({sample_reading("a", 1.2), sample_reading("b", 1.2, 60.0), sample_reading("c", 1.0)})));
    EXPECT_NE(table.find("1.200  SLOWER\n"), std::string::npos) << table;
    EXPECT_NE(table.find("1.200  disturbed\n"), std::string::npos) << table;
    EXPECT_NE(table.find("1.000\n"), std::string::npos) << table;
    EXPECT_NE(table.find("1 slower and 0 faster by more than 5 %, of 2 cases"), std::string::npos) << table;
}

}  // namespace
}  // namespace feldspar::benchmarks
