// A run that is killed, interrupted or damaged goes on where it was, and leaves the results of one that was never disturbed.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "program.hpp"

namespace feldspar::testing_program {
namespace {

using Json = nlohmann::json;

// Two tests on two packings, some seconds of work.
std::string some_job() {
    return replaced(small_job("[[test]]\nkind = \"uniaxial-compression\"\n[[test]]\nkind = \"biaxial\"\nsigma3 = \"5 MPa\"\n",
                              "[1, 2]", "accuracy = \"2 %\"\n"),
                    "minimum = \"7 mm\", maximum = \"11 mm\"", "minimum = \"5 mm\", maximum = \"9 mm\"");
}

// All lines of the histories but those that say when and where, by file.
std::map<std::string, std::string> histories(const fs::path& results) {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::directory_iterator(results)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with("history-") && !name.starts_with("events-")) continue;
        std::istringstream text(read_text(entry.path()));
        for (std::string line; std::getline(text, line);)
            if (!line.starts_with("#")) found[name] += line + "\n";
    }
    return found;
}

// The numbers of the tests without what the clock says.
Json numbers(const fs::path& results) {
    Json tests = Json::parse(read_text(results / "summary.json")).at("tests");
    for (Json& test : tests)
        for (const char* key : {"wall_s", "ms_per_step", "threads"}) test.erase(key);
    return tests;
}

class GoingOn : public testing::Test {
protected:
    static void SetUpTestSuite() {
        undisturbed_ = new TemporaryFolder;
        write_text(*undisturbed_ / "job.toml", some_job());
        const Outcome outcome = run_program(undisturbed_->path(), {"run", "job.toml", "--out", "results"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        ASSERT_FALSE(fs::exists(*undisturbed_ / "results/checkpoints"));
    }
    static void TearDownTestSuite() { delete undisturbed_; }

    GoingOn() { write_text(place_ / "job.toml", some_job()); }

    static void expect_like_undisturbed(const fs::path& results) {
        EXPECT_TRUE(histories(results) == histories(*undisturbed_ / "results"));
        EXPECT_EQ(numbers(results), numbers(*undisturbed_ / "results"));
        EXPECT_FALSE(fs::exists(results / "checkpoints"));
        expect_no_half_files(results);
        std::vector<std::string> files, expected;
        for (const auto& entry : fs::recursive_directory_iterator(results))
            files.push_back(fs::relative(entry.path(), results).string());
        for (const auto& entry : fs::recursive_directory_iterator(*undisturbed_ / "results"))
            expected.push_back(fs::relative(entry.path(), *undisturbed_ / "results").string());
        std::sort(files.begin(), files.end());
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(files, expected);
    }

    // @return the state files of tests that were under way
    std::vector<fs::path> states() const {
        std::vector<fs::path> found;
        std::error_code error;
        for (const auto& entry : fs::directory_iterator(place_ / "results/checkpoints", error))
            if (entry.path().extension() == ".state") found.push_back(entry.path());
        return found;
    }

    // Runs until a test has kept a state, and ends the program.
    void leave_a_state(int signal_number = SIGKILL, const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{"run", "job.toml", "--out", "results", "--checkpoint-every", "20 ms"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        Program program(place_.path(), arguments);
        ASSERT_TRUE(program.wait_until([&] { return !states().empty(); })) << program.err_so_far();
        program.send(signal_number);
        (void)program.finish();
        ASSERT_FALSE(states().empty());
    }

    Outcome go_on(const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{"run", "job.toml", "--out", "results"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_program(place_.path(), arguments);
    }

    static TemporaryFolder* undisturbed_;
    TemporaryFolder place_;
};
TemporaryFolder* GoingOn::undisturbed_ = nullptr;

TEST_F(GoingOn, AfterAnySignalAtAnyMoment) {
    std::mt19937 random(20);
    int attempts = 0, ended = 0;
    for (; attempts < 60; ++attempts) {
        Program program(place_.path(), {"run", "job.toml", "--out", "results", "--checkpoint-every", "30 ms", "--threads",
                                        attempts % 2 == 0 ? "1" : "2"});
        const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(20 + random() % 500);
        const bool reached = program.wait_until([&] { return std::chrono::steady_clock::now() > until; });
        if (reached) program.send(std::array{SIGKILL, SIGTERM, SIGINT, SIGHUP}[random() % 4]);
        const Outcome outcome = program.finish();
        if (outcome.code == 0) break;
        ++ended;
        ASSERT_TRUE(outcome.code == 128 + SIGKILL || outcome.code == 130 || outcome.code == 128 + SIGTERM ||
                    outcome.code == 128 + SIGINT || outcome.code == 128 + SIGHUP)
            << outcome.code << outcome.err;
    }
    EXPECT_GT(ended, 1);
    EXPECT_LT(attempts, 60);
    expect_like_undisturbed(place_ / "results");
}

TEST_F(GoingOn, WithoutOutInTheNewestDirectoryOfTheJob) {
    Program program(place_.path(), {"run", "job.toml", "--checkpoint-every", "20 ms"});
    ASSERT_TRUE(program.wait_until([&] {
        return fs::exists(place_ / "results/job-1/checkpoints/uniaxial-compression-s1.state");
    })) << program.err_so_far();
    program.send(SIGKILL);
    (void)program.finish();
    const Outcome outcome = run_program(place_.path(), {"run", "job.toml"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("going on with the unfinished run in results/job-1"), std::string::npos) << outcome.err;
    expect_like_undisturbed(place_ / "results/job-1");
    EXPECT_EQ(run_program(place_.path(), {"run", "job.toml", "--test", "biaxial"}).code,
              0);  // another job: a directory of its own
    EXPECT_TRUE(fs::exists(place_ / "results/job-2/summary.json"));
}

TEST_F(GoingOn, FreshBeginsAnew) {
    Program program(place_.path(), {"run", "job.toml", "--checkpoint-every", "20 ms"});
    ASSERT_TRUE(program.wait_until([&] {
        return fs::exists(place_ / "results/job-1/checkpoints/uniaxial-compression-s1.state");
    })) << program.err_so_far();
    program.send(SIGTERM);
    EXPECT_EQ(program.finish().code, 130);
    const Outcome outcome = run_program(place_.path(), {"run", "job.toml", "--fresh"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    expect_like_undisturbed(place_ / "results/job-2");
    EXPECT_TRUE(fs::exists(place_ / "results/job-1/checkpoints/job"));
}

TEST_F(GoingOn, OnRequestStatesAreKept) {
    Program program(place_.path(), {"run", "job.toml", "--out", "results", "--checkpoint-every", "never"});
    ASSERT_TRUE(program.wait_until([&] { return program.err_so_far().find("loading") != std::string::npos; }))
        << program.err_so_far();
    EXPECT_TRUE(states().empty());
    program.send(SIGUSR1);
    EXPECT_TRUE(program.wait_until([&] { return !states().empty(); })) << program.err_so_far();
    program.send(SIGKILL);
    (void)program.finish();
    EXPECT_EQ(go_on().code, 0);
    expect_like_undisturbed(place_ / "results");
}

TEST_F(GoingOn, AnotherJobIsRefused) {
    leave_a_state();
    const std::string kept = read_text(states().front());
    write_text(place_ / "job.toml", replaced(some_job(), "sigma_nt = \"8.5 MPa\"", "sigma_nt = \"8.6 MPa\""));
    const Outcome outcome = go_on();
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find("holds an unfinished run of another job"), std::string::npos) << outcome.err;
    EXPECT_TRUE(read_text(states().front()) == kept);
}

TEST_F(GoingOn, TwoProgramsDoNotShareADirectory) {
    Program first(place_.path(), {"run", "job.toml", "--out", "results", "--checkpoint-every", "20 ms"});
    ASSERT_TRUE(first.wait_until([&] { return !states().empty(); })) << first.err_so_far();
    const Outcome second = go_on();
    EXPECT_EQ(second.code, 2);
    EXPECT_NE(second.err.find("another program runs this job now"), std::string::npos) << second.err;
    EXPECT_EQ(first.finish().code, 0);
    expect_like_undisturbed(place_ / "results");
}

// The state before the newest one is there.
TEST_F(GoingOn, ADamagedStateCostsSomeTimeOnly) {
    leave_a_state();
    Program program(place_.path(), {"run", "job.toml", "--out", "results", "--checkpoint-every", "20 ms"});
    ASSERT_TRUE(program.wait_until([&] { return !states().empty() && fs::exists(states().front().string() + ".before"); }))
        << program.err_so_far();
    program.send(SIGKILL);
    (void)program.finish();
    for (const fs::path& state : states()) {
        std::string bytes = read_text(state);
        bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
        write_text(state, bytes);
    }
    const Outcome outcome = go_on();
    EXPECT_EQ(outcome.code, 0);
    expect_like_undisturbed(place_ / "results");
}

TEST_F(GoingOn, StatesThatAreAllDamagedAreSaidAndTheTestBeginsAnew) {
    leave_a_state();
    const std::string name = states().front().filename().string();
    for (const char* ending : {"", ".before"})
        write_text(place_ / ("results/checkpoints/" + name + ending), "feldspar checkpoint 1\nnonsense");
    const Outcome outcome = go_on();
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.err.find("is not used, and its test begins anew: it is damaged"), std::string::npos) << outcome.err;
    expect_like_undisturbed(place_ / "results");
}

TEST_F(GoingOn, StatesOfOtherInstructionsAreSaid) {
    setenv("FELDSPAR_KERNELS", "portable", 1);
    leave_a_state();
    setenv("FELDSPAR_KERNELS", "avx2", 1);
    const Outcome outcome = go_on();
    if (outcome.code != 2) {  // else this processor has no AVX2
        EXPECT_EQ(outcome.code, 0);
        EXPECT_NE(outcome.err.find("FELDSPAR_KERNELS=portable goes on with it"), std::string::npos) << outcome.err;
    }
    unsetenv("FELDSPAR_KERNELS");
}

TEST_F(GoingOn, WithoutSpaceForStatesTheTestsGoOn) {
    // states are the largest files on the way; a limit beyond the histories stops them first
    const Outcome outcome =
        run_program(place_.path(), {"run", "job.toml", "--out", "results", "--checkpoint-every", "10 ms"}, [] {
            const rlimit limit{300'000, 300'000};
            setrlimit(RLIMIT_FSIZE, &limit);
        });
    EXPECT_NE(outcome.err.find("the state of this test cannot be kept, and it goes on without"), std::string::npos)
        << outcome.err;
    expect_no_half_files(place_ / "results");
}

TEST_F(GoingOn, StudiesGoOnWithTheirTests) {
    write_text(place_ / "study.toml",
               "job = \"job.toml\"\n[[axis]]\nname = \"mu\"\nkey = \"material.contact.mu\"\nvalues = [0.3, 0.4]\n");
    std::mt19937 random(7);
    const auto run = [&](const std::string& results) {
        return std::vector<std::string>{"study", "study.toml", "--results", results, "--checkpoint-every", "30 ms"};
    };
    ASSERT_EQ(run_program(place_.path(), run("whole")).code, 0);
    int ended = 0;
    for (; ended < 60; ++ended) {
        Program program(place_.path(), run("pieces"));
        const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(200 + random() % 1500);
        if (program.wait_until([&] { return std::chrono::steady_clock::now() > until; }))
            program.send(ended % 2 == 0 ? SIGKILL : SIGTERM);
        if (program.finish().code == 0) break;
    }
    EXPECT_GT(ended, 0);
    const auto table = [&](const std::string& results) {  // all but times
        std::string kept;
        std::istringstream text(run_program(place_.path(), {"study", "table", "study.toml", "--results", results}).out);
        for (std::string line; std::getline(text, line);)
            if (!line.starts_with("#")) kept += line + "\n";
        return kept;
    };
    EXPECT_EQ(table("pieces"), table("whole"));
    EXPECT_GT(table("whole").size(), 100U);
    for (const auto& entry : fs::recursive_directory_iterator(place_ / "pieces"))
        EXPECT_FALSE(entry.path().filename().string().starts_with("test.state")) << entry.path();
}

}  // namespace
}  // namespace feldspar::testing_program
