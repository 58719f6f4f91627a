// Every closed form of src/feldspar/verify as a test, and how they are judged and written.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <stdexcept>

#include "../temporary_folder.hpp"
#include "feldspar/verify/write_checks.hpp"

namespace feldspar {
namespace {

std::vector<std::pair<const Check*, const char*>> all_checks() {
    std::vector<std::pair<const Check*, const char*>> all;
    for (const Topic& topic : all_topics())
        for (const Check& check : topic.checks) all.emplace_back(&check, topic.title);
    return all;
}

class Checks : public testing::TestWithParam<std::pair<const Check*, const char*>> {};
INSTANTIATE_TEST_SUITE_P(All, Checks, testing::ValuesIn(all_checks()), [](const auto& tested) {
    return std::regex_replace(tested.param.first->name, std::regex("[^a-z0-9]"), "_");
});

TEST_P(Checks, LieWithinTheirBounds) {
    const auto& [check, topic] = GetParam();
    const CheckResult result = run_check(*check, topic);
    EXPECT_TRUE(result.within()) << result.failure;
    for (const Judged& j : result.judged)
        EXPECT_TRUE(j.within) << j.comparison.what << ": expected " << j.comparison.expected << ", found " << j.comparison.found
                              << ", error " << j.error << ", bound " << check->bound.size;
}

TEST(ListOfChecks, IsWhole) {
    std::set<std::string> names;
    for (const auto& [check, topic] : all_checks()) {
        EXPECT_TRUE(names.insert(check->name).second) << check->name << " is there twice";
        EXPECT_TRUE(std::regex_match(check->name, std::regex("[a-z0-9-]+\\.[a-z0-9-]+"))) << check->name;
        for (const std::string* text : {&check->sentence, &check->formula, &check->source, &check->reason})
            EXPECT_FALSE(text->empty()) << check->name;
        EXPECT_TRUE(std::isfinite(check->bound.size) && check->bound.size > 0.0) << check->name;
        EXPECT_LE(check->bound.relative ? check->bound.size : 0.0, 0.05) << check->name << ": a closed form is nearer than that";
        EXPECT_TRUE(check->compare) << check->name;
    }
    EXPECT_GT(names.size(), 60U);
}

Check sample(CheckBound bound, double expected, double found) {
    return {.name = "sample.check",
            .sentence = "Two | three <b>.",
            .formula = "a | b",
            .source = "nobody",
            .unit = "MPa",
            .bound = bound,
            .reason = "none",
            .compare = [=] {
                return std::vector<CheckedValue>{{"case", expected, found}};
            }};
}

bool within(const Check& check) { return run_check(check, "sample").within(); }

TEST(Judging, TellsWhatLiesOutside) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(within(sample(relative(0.01), 200.0, 201.9)));
    EXPECT_FALSE(within(sample(relative(0.01), 200.0, 202.1)));
    EXPECT_FALSE(within(sample(relative(0.01), -200.0, -197.9)));
    EXPECT_TRUE(within(sample(absolute(0.5), 0.0, -0.49)));
    EXPECT_FALSE(within(sample(absolute(0.5), 0.0, 0.51)));
    EXPECT_FALSE(within(sample(absolute(0.5), 0.0, nan)));
    EXPECT_FALSE(within(sample(absolute(0.5), nan, 0.0)));
    EXPECT_FALSE(within(sample(relative(0.5), 0.0, 0.0))) << "relative to nothing";
    Check empty = sample(absolute(1.0), 0.0, 0.0), throws = empty;
    empty.compare = [] { return std::vector<CheckedValue>{}; };
    EXPECT_FALSE(within(empty)) << "it compares nothing";
    throws.compare = []() -> std::vector<CheckedValue> { throw std::runtime_error("no"); };
    EXPECT_FALSE(within(throws));
    EXPECT_EQ(run_check(throws, "sample").failure, "no");
}

TEST(Judging, AnyCheckFailsIfItsExpectedValueWereAnother) {
    for (const auto& [check, topic] : all_checks()) {
        if (check->name.rfind("laws.", 0) != 0 && check->name.rfind("statistics.", 0) != 0) continue;  // the quick ones
        std::vector<CheckedValue> moved = check->compare();
        for (CheckedValue& c : moved)
            c.expected += 2.1 * check->bound.size * (check->bound.relative ? std::abs(c.expected) : 1.0);
        for (const Judged& j : judge(*check, topic, moved).judged)
            EXPECT_FALSE(j.within) << check->name << " " << j.comparison.what;
    }
}

TEST(Running, KeepsTheOrderOfTheListForAnyNumberOfThreads) {
    std::vector<Topic> topics{{"one", {}}, {"two", {}}};
    for (int i = 0; i < 20; ++i) {
        Check check = sample(absolute(1.0), i, i);
        check.name = "check." + std::to_string(i);
        if (i % 5 < 2) check.run = "shared";
        topics[i / 10].checks.push_back(check);
    }
    int told = 0;
    const auto results = run_checks(
        topics, [](const Check& c) { return c.name != "check.3"; }, 4, [&](const CheckResult&) { ++told; });
    ASSERT_EQ(results.size(), 19U);
    EXPECT_EQ(told, 19);
    for (std::size_t i = 0; i < results.size(); ++i)
        EXPECT_EQ(results[i].check->name, "check." + std::to_string(i < 3 ? i : i + 1));
    EXPECT_STREQ(results.back().topic, "two");
    EXPECT_EQ(tally(results), "19 of 19 within their bounds");
}

TEST(Writing, LeavesAPageJsonAndMarkdown) {
    const std::vector<Topic> topics{{"Samples", {sample(relative(0.01), 200.0, 201.0), sample(absolute(0.5), 0.0, 0.7)}}};
    const auto results = run_checks(topics, {}, 1);
    const TemporaryFolder folder;
    const RunDirectory directory = RunDirectory::create(folder.path() / "verify", "verify");
    const Provenance provenance = collect_provenance("feldspar verify", 1);
    write_checks(directory, results, provenance);
    const auto json = nlohmann::json::parse(read_text(directory.path() / "verify.json"));
    EXPECT_EQ(json["tally"], "1 of 2 within their bounds");
    EXPECT_EQ(json["within_bounds"], false);
    EXPECT_EQ(json["topics"][0]["checks"][0]["values"][0]["expected"], 200.0);
    EXPECT_EQ(json["topics"][0]["checks"][1]["within"], false);
    const std::string markdown = read_text(directory.path() / "verify.md"), html = read_text(directory.path() / "verify.html");
    EXPECT_NE(markdown.find("| Two \\| three \\<b>. `a \\| b`; nobody (`sample.check`) | case | 200 MPa | 201 MPa | 0.5 % | 1 %: "
                            "none | within |"),
              std::string::npos)
        << markdown;
    EXPECT_NE(markdown.find("OUTSIDE"), std::string::npos);
    EXPECT_EQ(html.find("<b>"), std::string::npos);
    const std::string text = checks_text(results, provenance, 100);
    EXPECT_NE(text.find("1 of 2 within their bounds\n"), std::string::npos);
    EXPECT_NE(text.find("OUTSIDE"), std::string::npos);
    EXPECT_EQ(checks_list(topics, {}), "Samples\n  sample.check: Two | three <b>.\n  sample.check: Two | three <b>.\n");
}

}  // namespace
}  // namespace feldspar
