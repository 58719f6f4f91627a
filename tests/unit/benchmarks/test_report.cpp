// Reports are kept as JSON and read back; what is no report is refused.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "benchmarks/table.hpp"
#include "feldspar/base/error.hpp"
#include "sample_report.hpp"

namespace feldspar::benchmarks {
namespace {

void expect_same(const Report& a, const Report& b) {
    EXPECT_EQ(a.machine, b.machine);
    EXPECT_EQ(a.quiet.share, b.quiet.share);
    EXPECT_EQ(a.quiet.blocks, b.quiet.blocks);
    EXPECT_EQ(a.best, b.best);
    EXPECT_EQ(a.on_record, b.on_record);
    ASSERT_EQ(a.readings.size(), b.readings.size());
    for (std::size_t i = 0; i < a.readings.size(); ++i) {
        const Reading &r = a.readings[i], &s = b.readings[i];
        EXPECT_EQ(r.name, s.name);
        EXPECT_EQ(r.stage, s.stage);
        EXPECT_EQ(r.threads, s.threads);
        EXPECT_EQ(r.counts, s.counts);
        ASSERT_EQ(r.blocks.size(), s.blocks.size());
        for (std::size_t k = 0; k < r.blocks.size(); ++k) {
            EXPECT_EQ(r.blocks[k].steps, s.blocks[k].steps);
            EXPECT_EQ(r.blocks[k].wall_s, s.blocks[k].wall_s);
            EXPECT_EQ(r.blocks[k].cpu_s, s.blocks[k].cpu_s);
            EXPECT_EQ(r.blocks[k].waited_s, s.blocks[k].waited_s);
            EXPECT_EQ(r.blocks[k].before.multiply_add, s.blocks[k].before.multiply_add);
            EXPECT_EQ(r.blocks[k].before.memory, s.blocks[k].before.memory);
            EXPECT_EQ(r.blocks[k].after.multiply_add, s.blocks[k].after.multiply_add);
            EXPECT_EQ(r.blocks[k].after.memory, s.blocks[k].after.memory);
        }
    }
}

TEST(Report, ComesBackFromItsJson) {
    Report report = sample_report();
    report.readings[0].blocks[0].wall_s = 0.1 / 3.0;  // every digit
    report.readings[0].blocks[0].waited_s = 0.001;
    report.readings[0].blocks[1].before = {.multiply_add = 1.0, .memory = 2.0};
    report.readings[0].blocks[1].after = {.multiply_add = 3.0, .memory = 4.0};
    report.readings[1].threads = 2;
    expect_same(from_json(to_json(report), "text"), report);
    expect_same(from_json(to_json(Report{}), "text"), Report{});
}

TEST(Report, HasItsSummariesForOtherPrograms) {
    const auto all = nlohmann::json::parse(to_json(sample_report()));
    const auto& reading = all.at("readings").at(0);
    EXPECT_DOUBLE_EQ(reading.at("best_ms"), 0.5);
    EXPECT_DOUBLE_EQ(reading.at("median_ms"), 0.55);
    EXPECT_EQ(reading.at("disturbed"), false);
    EXPECT_EQ(reading.at("quiet_blocks"), 3);
}

TEST(Report, ThatIsNoneIsRefused) {
    for (const char* text : {"", "{", "[]", "{}", R"({"format": "another"})", R"({"format": "feldspar benchmark 1"})"})
        EXPECT_THROW(from_json(text, "text"), InputError) << text;
    std::string wrong = to_json(sample_report());
    wrong.replace(wrong.find("\"steps\": 10"), 11, "\"steps\": \"x\"");
    EXPECT_THROW(from_json(wrong, "text"), InputError);
}

TEST(Report, IsWrittenAndRead) {
    const auto file = std::filesystem::path(testing::TempDir()) / "feldspar-benchmark-report.json";
    write_report(sample_report(), file);
    expect_same(read_report(file), sample_report());
    EXPECT_FALSE(std::filesystem::exists(file.string() + ".part"));
    std::filesystem::remove(file);
    EXPECT_THROW(read_report(file), InputError);
    EXPECT_THROW(write_report(sample_report(), file / "in" / "no" / "folder"), OutputError);
}

TEST(Table, ShowsEveryReadingItsGoalAndWhetherItWasDisturbed) {
    Report report = sample_report();
    report.readings.push_back(sample_reading("rigid/uniaxial/paper/breaking/step/1t", 0.3, 50.0));
    const std::string table = report_table(report);
    for (const Reading& reading : report.readings) EXPECT_NE(table.find(reading.name), std::string::npos) << reading.name;
    EXPECT_NE(table.find("0.25"), std::string::npos) << "the goal of vectors of 256 bits";
    EXPECT_NE(table.find("1 of 3 readings stayed disturbed"), std::string::npos);
    EXPECT_NE(table.find("333.33"), std::string::npos) << "0.5 ms over 1500 triangles, ns";
    EXPECT_NE(table.find("595.24"), std::string::npos) << "0.5 ms over 840 points, ns";
    EXPECT_NE(table.find("95.0 GFLOP/s a core; an earlier run saw 110.0"), std::string::npos);
    EXPECT_EQ(table.find("100.0 GFLOP/s a core;"), std::string::npos);
    EXPECT_NE(table.find("7.50"), std::string::npos) << "kB a grain";
}

}  // namespace
}  // namespace feldspar::benchmarks
