// Several tests side by side: the same results as one after the other, whichever ends first; stopped together; and none that is
// finished is lost when another fails.
#include <nlohmann/json.hpp>
#include <regex>

#include "program.hpp"

namespace feldspar::testing_program {
namespace {

using Json = nlohmann::ordered_json;

const std::string three_tests =
    "[[test]]\nkind = \"uniaxial-compression\"\n[[test]]\nkind = \"direct-tension\"\n[[test]]\nkind = \"brazilian\"\n";

Json summary_of(const fs::path& results) { return Json::parse(read_text(results / "summary.json")); }

// The summary without what says when, on how many threads and how fast.
std::string numbers_of(const fs::path& results) {
    Json summary = summary_of(results);
    summary.erase("provenance");
    summary["job"].erase("resolved");  // says threads and tests at once
    for (Json& test : summary["tests"])
        for (const char* key : {"wall_s", "ms_per_step", "threads"}) test.erase(key);
    return summary.dump(2);
}

TEST(SeveralAtOnce, GiveTheBytesOfOneAfterTheOther) {
    const TemporaryFolder place;
    write_text(place / "job.toml",
               small_job(three_tests, "[1, 2]"));  // tests of very different length: they end in another order
    ASSERT_EQ(run_program(place.path(), {"run", "job.toml", "--out", "one", "--threads", "1"}).code, 0);
    ASSERT_EQ(run_program(place.path(), {"export", "one", "--vtu", "--threads", "1"}).code, 0);
    const std::vector<std::pair<const char*, const char*>> others{{"2", "1"}, {"2", "2"}};
    for (const auto& [threads, at_once] : others) {
        SCOPED_TRACE(std::string(threads) + " threads, at once " + at_once);
        const Outcome outcome =
            run_program(place.path(), {"run", "job.toml", "--out", "many", "--threads", threads, "--at-once", at_once});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(summary_of(place / "many").at("tests").size(), 6u);
        EXPECT_EQ(numbers_of(place / "many"), numbers_of(place / "one"));
        ASSERT_EQ(run_program(place.path(), {"export", "many", "--vtu", "--threads", threads}).code, 0);
        int compared = 0;
        for (const auto& entry : fs::recursive_directory_iterator(place / "one")) {
            const fs::path other = place / "many" / fs::relative(entry.path(), place / "one");
            ASSERT_TRUE(fs::exists(other)) << other;
            const std::string kind = entry.path().extension().string();
            if (kind != ".csv" && kind != ".vtu" && kind != ".vtm" && kind != ".pvd" && kind != ".txt")
                continue;  // the others say when they were made
            EXPECT_EQ(read_text(entry.path()), read_text(other)) << other;
            ++compared;
        }
        EXPECT_GT(compared, 6 + 4 + 6);
        fs::remove_all(place / "many");
    }
}

TEST(SeveralAtOnce, StopTogetherAndKeepWhatTheyHave) {
    const TemporaryFolder place;
    write_text(place / "job.toml",
               small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[1, 2, 3]", "kind = \"paper\"\nspeed = \"1e-12 m\"\n"));
    Program program(place.path(), {"run", "job.toml", "--out", "results", "--threads", "2", "--at-once", "2"});
    const auto loads = [&](const char* test) {
        return program.err_so_far().find(std::string(test) + ": loading") != std::string::npos;
    };
    ASSERT_TRUE(program.wait_until([&] {
        return loads("1/3 uniaxial-compression, seed 1") && loads("2/3 uniaxial-compression, seed 2");
    })) << program.err_so_far();
    program.send(SIGINT);
    const Outcome outcome = program.finish();
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    const Json summary = summary_of(place / "results");
    EXPECT_EQ(summary.at("complete"), false);
    ASSERT_EQ(summary.at("tests").size(), 2u);
    for (const int seed : {1, 2}) {
        const Json& test = summary.at("tests").at(static_cast<std::size_t>(seed - 1));
        EXPECT_EQ(test.at("seed"), seed);
        EXPECT_EQ(test.at("interrupted"), true);
        for (const char* file : {"history", "archive"})
            EXPECT_TRUE(fs::exists(place / "results" / test.at("files").at(file).get<std::string>())) << file;
    }
    EXPECT_TRUE(fs::exists(place / "results/report.html"));
    expect_no_half_files(place / "results");
}

// A specimen that is crushed before it is sheared, between two that are well.
TEST(SeveralAtOnce, AFailureKeepsWhatTheOthersFind) {
    const TemporaryFolder place;
    write_text(place / "job.toml",
               small_job("[[test]]\nkind = \"uniaxial-compression\"\n[[test]]\nkind = \"biaxial\"\nsigma3 = \"5000 "
                         "MPa\"\n[[test]]\nkind = \"direct-tension\"\n",
                         "[1, 2]"));
    for (const char* at_once : {"1", "2"}) {
        SCOPED_TRACE(at_once);
        const Outcome outcome =
            run_program(place.path(), {"run", "job.toml", "--out", "results", "--threads", at_once, "--at-once", at_once});
        EXPECT_EQ(outcome.code, 3) << outcome.err;
        // of the two that fail the first in the job's order is named, whichever failed first
        EXPECT_NE(outcome.err.find("feldspar: biaxial at 5000 MPa, seed 1: "), std::string::npos) << outcome.err;
        const Json summary = summary_of(place / "results");
        EXPECT_EQ(summary.at("complete"), false);
        EXPECT_NE(outcome.err.find("2 of 6 tests failed"), std::string::npos) << outcome.err;
        ASSERT_EQ(summary.at("tests").size(), 4u);  // the others go on
        EXPECT_EQ(summary.at("tests").at(0).at("kind"), "uniaxial-compression");
        for (const Json& test : summary.at("tests")) {
            EXPECT_NE(test.at("kind"), "biaxial");
            EXPECT_EQ(test.at("interrupted"), false);
            EXPECT_TRUE(fs::exists(place / "results" / test.at("files").at("history").get<std::string>()));
        }
        ASSERT_EQ(summary.at("failed").size(), 2u);
        for (const int seed : {1, 2}) {
            const Json& test = summary.at("failed").at(static_cast<std::size_t>(seed - 1));
            EXPECT_EQ(test.at("name"), "biaxial-s" + std::to_string(seed) + "-p5000");
            EXPECT_EQ(test.at("kind"), "biaxial");
            EXPECT_EQ(test.at("seed"), seed);
            EXPECT_EQ(test.at("sigma3_MPa"), 5000);
            const std::string reason = test.at("reason");
            EXPECT_FALSE(reason.empty());
            EXPECT_NE(read_text(place / "results/report.html")
                          .find("\"seed\":" + std::to_string(seed) + ",\"sigma3\":5000,\"reason\":"),
                      std::string::npos);
            // a row of the table, and the reason below it
            EXPECT_TRUE(
                std::regex_search(outcome.out, std::regex("\nbiaxial at 5000 MPa +" + std::to_string(seed) + " +failed ")))
                << outcome.out;
            EXPECT_NE(outcome.out.find("biaxial at 5000 MPa, seed " + std::to_string(seed) + ": failed: " + reason.substr(0, 20)),
                      std::string::npos)
                << outcome.out;
        }
        EXPECT_NE(outcome.out.find("Uniaxial compressive strength"), std::string::npos)
            << outcome.out;  // of those that did not fail
        expect_no_half_files(place / "results");
        fs::remove_all(place / "results");
    }
}

// A mistake of the input that only the packing shows: more plates at a side than there are grains.
TEST(SeveralAtOnce, ATestThatFailsOfItsInputIsListedToo) {
    const TemporaryFolder place;
    write_text(place / "job.toml",
               replaced(small_job("[[test]]\nkind = \"uniaxial-compression\"\n[[test]]\nkind = \"biaxial\"\nsigma3 = \"4 MPa\"\n"
                                  "membrane_plates = 400\n"),
                        "[material.grain]\nE = \"25.8 GPa\"\nnu = 0.23\n", "[model]\nkind = \"rigid\"\n"));
    const Outcome outcome = run_program(place.path(), {"run", "job.toml", "--out", "results"});
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_NE(outcome.err.find("1 of 2 tests failed"), std::string::npos) << outcome.err;
    const Json summary = summary_of(place / "results");
    EXPECT_EQ(summary.at("tests").size(), 1u);
    ASSERT_EQ(summary.at("failed").size(), 1u);
    EXPECT_EQ(summary.at("failed").at(0).at("name"), "biaxial-s1-p4");
    EXPECT_NE(summary.at("failed").at(0).at("reason").get<std::string>().find("plates a side are too many"), std::string::npos);
    EXPECT_TRUE(
        std::regex_search(outcome.out, std::regex("biaxial at 4 MPa, seed 1: failed: membrane_plates: [^;]+;\\s+allowed: ")))
        << outcome.out;
}

}  // namespace
}  // namespace feldspar::testing_program
