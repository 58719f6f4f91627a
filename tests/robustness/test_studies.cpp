// Studies run by the program: killed, interrupted, and two at once on one ledger.
#include <pty.h>
#include <sys/ioctl.h>

#include <regex>

#include "studies.hpp"

namespace feldspar::testing_program {
namespace {

const std::string two_axes = R"(job = "job.toml"
seeds = [1, 2, 3, 4]
[[axis]]
name = "mu"
key = "material.contact.mu"
values = [0.2, 0.3, 0.4]
[[axis]]
name = "sigma_nt"
key = "material.contact.sigma_nt"
values = ["8 MPa", "9 MPa"]
)";
constexpr int runs_of_two_axes = 24;

void write_study(const TemporaryFolder& place) {
    write_text(place / "job.toml", small_job());
    write_text(place / "study.toml", two_axes);
}

/// What the program counted: "N runs done now".
int done_now(const Outcome& outcome) {
    std::smatch match;
    return std::regex_search(outcome.out, match, std::regex("(\\d+) runs done now")) ? std::stoi(match[1]) : -1;
}

TEST(Studies, KilledInTheMiddleOneFinishesWithExactlyTheMissingRuns) {
    const TemporaryFolder killed, whole;
    write_study(killed);
    write_study(whole);
    Program program(killed.path(), {"study", "study.toml", "--threads", "2"});
    ASSERT_TRUE(program.wait_until([&] { return finished(killed).size() >= 5; })) << program.err_so_far();
    program.send(SIGKILL);
    (void)program.finish();
    const std::size_t before = finished(killed).size();
    ASSERT_LT(before, static_cast<std::size_t>(runs_of_two_axes));

    const Outcome again = run_program(killed.path(), {"study", "study.toml", "--threads", "2"});
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(done_now(again), runs_of_two_axes - static_cast<int>(before)) << again.out;
    EXPECT_EQ(run_program(whole.path(), {"study", "study.toml", "--threads", "1"}).code, 0);
    EXPECT_EQ(finished(killed), finished(whole));  // to the last bit
    EXPECT_EQ(finished(whole).size(), static_cast<std::size_t>(runs_of_two_axes));
    expect_no_half_files(killed / "results");
}

TEST(Studies, TwoAtOnceShareALedger) {
    const TemporaryFolder place;
    write_study(place);
    Program first(place.path(), {"study", "study.toml", "--threads", "1"}),
        second(place.path(), {"study", "study.toml", "--threads", "1"});
    const Outcome one = first.finish(), other = second.finish();
    EXPECT_EQ(one.code, 0) << one.err;
    EXPECT_EQ(other.code, 0) << other.err;
    EXPECT_EQ(done_now(one) + done_now(other), runs_of_two_axes) << one.out << other.out;  // none twice
    const Outcome status = run_program(place.path(), {"study", "status", "study.toml"});
    EXPECT_NE(status.out.find("24 runs: 24 done, 0 running, 0 failed, 0 to do"), std::string::npos) << status.out;
}

TEST(Studies, CtrlCLeavesTheRestToTheNextTime) {
    const TemporaryFolder place;
    write_study(place);
    Program program(place.path(), {"study", "study.toml", "--threads", "1"});
    ASSERT_TRUE(program.wait_until([&] { return !finished(place).empty(); })) << program.err_so_far();
    program.send(SIGINT);
    const Outcome outcome = program.finish();
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_NE(outcome.err.find("the same command goes on"), std::string::npos) << outcome.err;
    const Outcome status = run_program(place.path(), {"study", "status", "study.toml"});
    EXPECT_NE(status.out.find(" 0 running, 0 failed"), std::string::npos) << status.out;
}

TEST(Studies, RunsThatFailForGoodAreNotRepeatedUnlessAskedFor) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    write_text(place / "study.toml",
               "job = \"job.toml\"\n[[axis]]\nname = \"mass\"\nkey = \"numerics.mass_factor\"\nvalues = [0.001, 2]\n");
    const auto study = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"study", "study.toml", "--threads", "1"});
        return run_program(place.path(), more);
    };
    const Outcome first = study({});
    EXPECT_EQ(first.code, 3) << first.err;
    EXPECT_NE(first.out.find("1 runs done now, 0 before, 1 failed;"), std::string::npos) << first.out;
    const Outcome second = study({});
    EXPECT_EQ(second.code, 3) << second.err;
    EXPECT_NE(second.err.find("1 done already, 1 failed before and not repeated"), std::string::npos) << second.err;
    EXPECT_NE(second.out.find("0 runs done now, 1 before, 0 failed;"), std::string::npos) << second.out;
    EXPECT_NE(second.out.find("1 failed before and were not repeated; --retry-failed runs them again"), std::string::npos)
        << second.out;
    EXPECT_NE(read_text(place / "results/study/study.html").find("mass_factor"), std::string::npos);  // its reason is shown still
    const Outcome status = run_program(place.path(), {"study", "status", "study.toml"});
    EXPECT_NE(status.out.find("1 done, 0 running, 1 failed, 0 to do"), std::string::npos) << status.out;
    EXPECT_NE(status.out.find("1 of the failed runs will not be repeated"), std::string::npos) << status.out;
    const Outcome third = study({"--retry-failed"});
    EXPECT_EQ(third.code, 3) << third.err;
    EXPECT_NE(third.out.find("0 runs done now, 1 before, 1 failed;"), std::string::npos) << third.out;
}

TEST(Studies, ThoseThatCommandsMakeOfAJobKeepFailuresToo) {
    const TemporaryFolder place;
    write_text(place / "job.toml",
               small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[1]", "kind = \"paper\"\nmass_factor = 0.001\n"));
    for (const std::string command : {"envelope", "converge"}) {
        SCOPED_TRACE(command);
        const auto call = [&](std::vector<std::string> more) {
            more.insert(more.begin(), {command, "job.toml", "--seeds", "2", "--threads", "2"});
            return run_program(place.path(), more);
        };
        const Outcome first = call({});
        EXPECT_EQ(first.code, 3) << first.err;
        EXPECT_EQ(first.out.find("not repeated"), std::string::npos) << first.out;
        const Outcome second = call({});
        EXPECT_EQ(second.code, 3) << second.err;
        EXPECT_NE(second.out.find("0 runs done now, 0 before, 0 failed;"), std::string::npos) << second.out;
        EXPECT_NE(second.out.find("failed before and were not repeated"), std::string::npos) << second.out;
        EXPECT_EQ(call({"--retry-failed"}).out.find("not repeated"), std::string::npos);
    }
}

TEST(Studies, AKilledRunIsNoFailureForGood) {
    const TemporaryFolder place;
    write_study(place);
    Program program(place.path(), {"study", "study.toml", "--threads", "1"});
    ASSERT_TRUE(program.wait_until([&] { return !finished(place).empty(); })) << program.err_so_far();
    program.send(SIGKILL);
    (void)program.finish();
    const Outcome again = run_program(place.path(), {"study", "study.toml", "--threads", "2"});
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(again.err.find("not repeated"), std::string::npos) << again.err;
    EXPECT_EQ(finished(place).size(), static_cast<std::size_t>(runs_of_two_axes));
}

TEST(Studies, TablesAndStatusWithoutALedger) {
    const TemporaryFolder place;
    write_study(place);
    const Outcome status = run_program(place.path(), {"study", "status", "study.toml"});
    EXPECT_EQ(status.code, 0);
    EXPECT_NE(status.out.find("24 to do"), std::string::npos) << status.out;
    const Outcome table = run_program(place.path(), {"study", "table", "study.toml"});
    EXPECT_EQ(table.code, 2);
    EXPECT_NE(table.err.find("nothing of the study has been run"), std::string::npos) << table.err;
    EXPECT_FALSE(fs::exists(place / "results"));
}

TEST(Studies, AMistakeLeavesNoFile) {
    const TemporaryFolder place;
    write_study(place);
    write_text(place / "study.toml", replaced(two_axes, "sigma_nt\"\nvalues", "sigma_tn\"\nvalues"));
    const Outcome outcome = run_program(place.path(), {"study", "study.toml"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find("study.toml:10"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("did you mean"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(place / "results"));
}

// What a terminal would obey in a name is shown by it: in the lines that are rewritten, in those that stay, and in what is
// printed.
TEST(Studies, NamesDoNotCommandTheTerminal) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    write_text(place / "study.toml",
               "job = \"job.toml\"\nseeds = [1]\n[[axis]]\nname = \"mu\"\n[[axis.value]]\nlabel = \"re\\u001b[31md\\nline\"\n");
    int master = -1, slave = -1;
    const winsize size{50, 400, 0, 0};
    ASSERT_EQ(openpty(&master, &slave, nullptr, nullptr, &size), 0);
    fcntl(master, F_SETFL, O_NONBLOCK);
    std::string shown;
    const auto read_terminal = [&] {
        char bytes[4096];
        for (ssize_t count = 0; (count = read(master, bytes, sizeof bytes)) > 0;)
            shown.append(bytes, static_cast<std::size_t>(count));
        return false;
    };
    Program program(place.path(), {"study", "study.toml"}, [&] { dup2(slave, STDERR_FILENO); });
    program.wait_until(read_terminal);
    const Outcome outcome = program.finish();
    read_terminal();
    close(master);
    close(slave);
    EXPECT_EQ(outcome.code, 0) << shown;
    EXPECT_NE(shown.find("[re\\x1b[31md\\x0aline: uniaxial-compression, seed 1]"), std::string::npos) << shown;  // rewritten
    EXPECT_NE(shown.find("1/1 re\\x1b[31md"), std::string::npos) << shown;                                       // stays
    EXPECT_NE(outcome.out.find("re\\x1b[31md\\x0aline"), std::string::npos) << outcome.out;
    EXPECT_EQ(shown.find("\x1b[31m"), std::string::npos) << shown;
    EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos) << outcome.out;
    const Outcome status = run_program(place.path(), {"study", "status", "study.toml"});
    EXPECT_EQ(status.out.find('\x1b'), std::string::npos) << status.out;
    const Outcome mistyped = run_program(place.path(), {"study", "study.toml", "\x1b[31m"});
    EXPECT_EQ(mistyped.code, 2);
    EXPECT_NE(mistyped.err.find("\\x1b[31m"), std::string::npos) << mistyped.err;
    EXPECT_EQ(mistyped.err.find('\x1b'), std::string::npos) << mistyped.err;
}

TEST(Studies, AreSetFromTheCommandLineAndPrintedForPrograms) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    write_text(place / "study.toml",
               "job = \"job.toml\"\n[[axis]]\nname = \"mu\"\nkey = \"material.contact.mu\"\nvalues = [0.2, 0.4]\n");
    const std::vector<std::string> command{"study", "study.toml", "--set", "material.contact.tau=20MPa"};
    std::vector<std::string> for_programs = command;
    for_programs.push_back("--json");
    const Outcome first = run_program(place.path(), for_programs);
    ASSERT_EQ(first.code, 0) << first.err;
    const auto object = nlohmann::json::parse(first.out);
    EXPECT_EQ(object.at("directory"), "results/study");
    EXPECT_EQ(object.at("executed").at("done"), 2);
    ASSERT_EQ(object.at("points").size(), 2u);
    EXPECT_EQ(object.at("points").at(1).at("labels").at("mu"), "0.4");
    EXPECT_GT(object.at("points").at(1).at("properties").at("UCS_MPa").at("mean").get<double>(), 0.0);
    EXPECT_NE(first.err.find("Page: results/study/study.html"), std::string::npos) << first.err;
    EXPECT_NE(read_text(place / "results/study/study.html").find("--set material.contact.tau=20MPa"), std::string::npos);

    std::vector<std::string> quiet = command;
    quiet.push_back("--quiet");
    const Outcome second = run_program(place.path(), quiet);
    EXPECT_EQ(second.out, "results/study\n");
    EXPECT_EQ(second.err, "");
    const Outcome status = run_program(place.path(), {"study", "status", "study.toml", "--set", "material.contact.tau=20MPa"});
    EXPECT_NE(status.out.find("2 done"), std::string::npos) << status.out;
    const Outcome plain = run_program(place.path(), {"study", "status", "study.toml"});
    EXPECT_NE(plain.out.find("0 done"), std::string::npos) << "the runs of the file are others: " << plain.out;

    const Outcome wrong = run_program(place.path(), {"study", "study.toml", "--json", "--set", "material.contact.mu=0.3"});
    EXPECT_EQ(wrong.code, 2);
    const auto error = nlohmann::json::parse(wrong.out).at("error");
    EXPECT_EQ(error.at("kind"), "input");
    EXPECT_NE(error.at("message").get<std::string>().find("the axis 'mu' varies this key"), std::string::npos) << wrong.out;
}

}  // namespace
}  // namespace feldspar::testing_program
