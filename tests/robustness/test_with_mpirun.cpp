// The program as several ranks, started as a user starts them.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include "program.hpp"

namespace feldspar::testing_program {
namespace {

struct Shell {
    int code;
    std::string out, err;
};

Shell shell(const fs::path& directory, const std::string& command) {
    const int status = std::system(fmt::format("cd '{}' && {} > out.txt 2> err.txt", directory.string(), command).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(directory / "out.txt"), read_text(directory / "err.txt")};
}

// As root too, on as many ranks as there are cores or more.
std::string mpirun(int ranks, const std::string& arguments) {
    return fmt::format(
        "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 {} -n {} --oversubscribe --bind-to none '{}' {}",
        FELDSPAR_MPIRUN, ranks, FELDSPAR_PROGRAM, arguments);
}

bool is_here() { return std::string(FELDSPAR_MPIRUN) != "" && std::system(FELDSPAR_MPIRUN " --version > /dev/null 2>&1") == 0; }

#define NEEDS_MPIRUN() \
    if (!is_here())    \
    GTEST_SKIP() << "the program was built without MPI, or there is no mpirun: ranks are tested as threads of one program only"

// All but the lines that say when, where and by what command it was made.
std::string numbers_of(const fs::path& file) {
    std::istringstream lines(read_text(file));
    std::string numbers;
    for (std::string line; std::getline(lines, line);)
        if (!line.starts_with("#")) numbers += line + "\n";
    return numbers;
}

TEST(WithMpirun, HasTheResultsOfOneProgram) {
    NEEDS_MPIRUN();
    TemporaryFolder folder;
    folder.write("job.toml", small_job("[[test]]\nkind = \"uniaxial-compression\"\n[[test]]\nkind = \"direct-tension\"\n"));
    const Shell alone = shell(folder.path(), fmt::format("'{}' run job.toml --out alone --quiet", FELDSPAR_PROGRAM));
    ASSERT_EQ(alone.code, 0) << alone.err;
    for (const int ranks : {2, 3}) {
        const std::string place = fmt::format("by-{}", ranks);
        const Shell together = shell(folder.path(), mpirun(ranks, "run job.toml --out " + place));
        ASSERT_EQ(together.code, 0) << together.err;
        EXPECT_NE(together.err.find(fmt::format("{} ranks make the steps together", ranks)), std::string::npos) << together.err;
        EXPECT_EQ(together.out.find("Report:"), together.out.rfind("Report:")) << "several have printed:\n" << together.out;
        int compared = 0;
        for (const auto& entry : fs::directory_iterator(folder.path() / "alone")) {
            if (entry.path().extension() != ".csv") continue;
            EXPECT_EQ(numbers_of(folder.path() / place / entry.path().filename()), numbers_of(entry.path())) << entry.path();
            ++compared;
        }
        EXPECT_GE(compared, 4);  // a history and events of each test
        EXPECT_NE(read_text(folder.path() / place / "summary.json").find(fmt::format("\"ranks\": {}", ranks)), std::string::npos);
    }
}

TEST(WithMpirun, RefusesWhatRanksCannotDo) {
    NEEDS_MPIRUN();
    TemporaryFolder folder;
    folder.write("job.toml", small_job());
    const auto expect_refused = [&](int ranks, const std::string& arguments, const std::string& why) {
        const Shell refused = shell(folder.path(), mpirun(ranks, arguments));
        EXPECT_EQ(refused.code, 2) << arguments << "\n" << refused.err;
        EXPECT_NE(refused.err.find(why), std::string::npos) << arguments << "\n" << refused.err;
        EXPECT_EQ(refused.err.find("feldspar: "), refused.err.rfind("feldspar: ")) << "said more than once:\n" << refused.err;
        EXPECT_FALSE(fs::exists(folder.path() / "results"));
    };
    expect_refused(2, "run job.toml --live", "--live");
    expect_refused(2, "run job.toml --device auto", "--device");
    expect_refused(2, "run - < job.toml", "standard input");
    expect_refused(2, "check job.toml", "run this command without mpirun");
    expect_refused(2, "run nowhere.toml", "nowhere.toml");
    expect_refused(2, "run job.toml --set numerics.accuracy=nothing", "accuracy");
    expect_refused(40, "run job.toml", "packs of grains");
}

TEST(WithMpirun, AProgramWithoutMpiSaysThatItKnowsNothingOfOthers) {
    if (std::string(FELDSPAR_MPIRUN) != "") GTEST_SKIP() << "this program was built with MPI";
    TemporaryFolder folder;
    folder.write("job.toml", small_job());
    const Outcome outcome = run_program(folder.path(), {"run", "job.toml"}, [] { setenv("OMPI_COMM_WORLD_SIZE", "4", 1); });
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find("FELDSPAR_MPI"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(folder.path() / "results"));
}

}  // namespace
}  // namespace feldspar::testing_program
