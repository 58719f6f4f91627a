// Ctrl-C ends the run cleanly: exit code 130, and the results so far with a summary that says that it is not complete.
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace feldspar::testing_program {
namespace {

// So slow that it would take hours.
const std::string slow = "kind = \"paper\"\nspeed = \"1e-12 m\"\n";

void expect_interrupted(const Outcome& outcome, const fs::path& results) {
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    ASSERT_TRUE(fs::exists(results / "summary.json")) << outcome.err;
    const auto summary = nlohmann::json::parse(read_text(results / "summary.json"));
    EXPECT_EQ(summary.at("complete"), false);
    expect_no_half_files(results);
}

TEST(Interruption, CtrlCDuringTheLoading) {
    for (int signal_number : {SIGINT, SIGTERM}) {
        const TemporaryFolder place;
        write_text(place / "job.toml", small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[1, 2]", slow));
        Program program(place.path(), {"run", "job.toml", "--out", "results"});
        ASSERT_TRUE(program.wait_until([&] { return program.err_so_far().find("loading") != std::string::npos; }))
            << program.err_so_far();
        program.send(signal_number);
        expect_interrupted(program.finish(), place / "results");
        EXPECT_TRUE(fs::exists(place / "results/history-uniaxial-compression-s1.csv"));
    }
}

TEST(Interruption, FinishedTestsAreKept) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job("[[test]]\nkind = \"uniaxial-compression\"\n",
                                             "[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20]"));
    Program program(place.path(), {"run", "job.toml", "--out", "results"});
    ASSERT_TRUE(program.wait_until([&] { return fs::exists(place / "results/summary.json"); })) << program.err_so_far();
    program.send(SIGINT);
    const Outcome outcome = program.finish();
    expect_interrupted(outcome, place / "results");
    const auto summary = nlohmann::json::parse(read_text(place / "results/summary.json"));
    EXPECT_GE(summary.at("tests").size(), 1u);
    EXPECT_NE(outcome.out.find("Uniaxial compressive strength"), std::string::npos) << outcome.out;
}

TEST(Interruption, AtAnyMomentIsClean) {
    // also while specimens are made, or during the elastic start: then there may be no directory, but never half a one
    for (int delay_ms : {20, 60, 100, 150, 250}) {
        SCOPED_TRACE(delay_ms);
        const TemporaryFolder place;
        write_text(place / "job.toml", replaced(small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[1]", slow),
                                                "kind = \"paper\"\nspeed = \"1e-12 m\"", "accuracy = \"0.05 %\""));
        Program program(place.path(), {"run", "job.toml", "--out", "results"});
        std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
        program.send(SIGINT);
        const Outcome outcome = program.finish();
        if (fs::exists(place / "results"))
            expect_interrupted(outcome, place / "results");
        else
            EXPECT_EQ(outcome.code, 130) << outcome.err;
    }
}

TEST(Interruption, IgnoredHangUpsStayIgnored) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[1]", slow));
    Program program(place.path(), {"run", "job.toml", "--out", "results"}, [] { signal(SIGHUP, SIG_IGN); });
    ASSERT_TRUE(program.wait_until([&] { return program.err_so_far().find("loading") != std::string::npos; }))
        << program.err_so_far();
    program.send(SIGHUP);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    program.send(SIGINT);
    expect_interrupted(program.finish(), place / "results");
}

}  // namespace
}  // namespace feldspar::testing_program
