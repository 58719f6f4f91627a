// Places that cannot be written: found before the run (exit code 2, no file), or met during it (exit code 4, and the files
// that were finished stay whole).
#include <sys/mount.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace feldspar::testing_program {
namespace {

const std::string many_seeds =
    "[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30]";

TEST(LostOutput, ADirectoryThatCannotBeMadeIsFoundBeforeTheRun) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    write_text(place / "file", "a file\n");
    for (const char* out : {"file/results", "/proc/feldspar-results", "/dev/null/results"}) {
        SCOPED_TRACE(out);
        const Outcome outcome = run_program(place.path(), {"run", "job.toml", "--out", out});
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_NE(outcome.err.find("feldspar: --out: "), std::string::npos) << outcome.err;
        EXPECT_EQ(place.entries(), (std::set<std::string>{"job.toml", "file"}));
    }
    if (geteuid() == 0) return;  // root may write anywhere
    fs::create_directory(place / "locked");
    fs::permissions(place / "locked", fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_EQ(run_program(place.path(), {"run", "job.toml", "--out", "locked/results"}).code, 2);
    fs::permissions(place / "locked", fs::perms::owner_all);
}

// What must hold after results were lost: the program said so, and everything that is there can be read.
void expect_whole_results(const fs::path& results) {
    expect_no_half_files(results);
    for (const auto& entry : fs::directory_iterator(results)) {
        SCOPED_TRACE(entry.path().string());
        const std::string text = entry.is_regular_file() ? read_text(entry.path()) : "\n";
        const std::string kind = entry.path().extension().string();
        EXPECT_TRUE(kind != ".json" || nlohmann::json::accept(text));
        EXPECT_TRUE(kind != ".csv" || text.ends_with('\n'));
        EXPECT_TRUE(kind != ".html" || text.find("</html>") != std::string::npos);
    }
}

TEST(LostOutput, AFileThatMayNotGrowEndsTheRunWithFour) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    const Outcome outcome = run_program(place.path(), {"run", "job.toml", "--out", "results"}, [] {
        const rlimit limit{20000, 20000};  // bytes: the job fits, the histories and fields do not
        setrlimit(RLIMIT_FSIZE, &limit);
    });
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    EXPECT_NE(outcome.err.find("feldspar: "), std::string::npos) << outcome.err;
    EXPECT_TRUE(fs::exists(place / "results/job.toml"));
    EXPECT_TRUE(fs::exists(place / "results/packing-s1.txt"));
    expect_whole_results(place / "results");
}

TEST(LostOutput, ADirectoryThatVanishesEndsTheRunWithFour) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job("[[test]]\nkind = \"uniaxial-compression\"\n", many_seeds));
    Program program(place.path(), {"run", "job.toml", "--out", "results"});
    ASSERT_TRUE(program.wait_until([&] { return fs::exists(place / "results/summary.json"); })) << program.err_so_far();
    fs::rename(place / "results", place / "elsewhere");
    const Outcome outcome = program.finish();
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    expect_whole_results(place / "elsewhere");
}

class SmallDisk {
public:
    explicit SmallDisk(const fs::path& place) : place_(place) {
        fs::create_directory(place);
        mounted_ = mount("tmpfs", place.c_str(), "tmpfs", 0, "size=64m") == 0;
        error_ = errno;
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;
    ~SmallDisk() {
        if (mounted_) umount2(place_.c_str(), MNT_DETACH);
    }
    bool mounted() const { return mounted_; }
    std::string reason() const { return std::strerror(error_); }

    /// Writes until nothing more fits.
    void fill() const {
        const int file = open((place_ / "filler").c_str(), O_WRONLY | O_CREAT, 0600);
        const std::vector<char> block(1 << 16, 'x');
        for (std::size_t size = block.size(); size > 0; size /= 2)
            while (write(file, block.data(), size) > 0) {
            }
        close(file);
    }

private:
    fs::path place_;
    bool mounted_ = false;
    int error_ = 0;
};

TEST(LostOutput, AFullDiskEndsTheRunWithFourAndKeepsWhatWasFinished) {
    const TemporaryFolder place;
    const SmallDisk disk(place / "disk");
    if (!disk.mounted()) GTEST_SKIP() << "cannot mount a small disk: " << disk.reason();
    write_text(place / "job.toml", small_job("[[test]]\nkind = \"uniaxial-compression\"\n", many_seeds));
    Program program(place.path(), {"run", "job.toml", "--out", "disk/results"});
    ASSERT_TRUE(program.wait_until([&] { return fs::exists(place / "disk/results/report.html"); })) << program.err_so_far();
    disk.fill();
    const Outcome outcome = program.finish();
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    EXPECT_NE(outcome.err.find("No space left"), std::string::npos) << outcome.err;
    EXPECT_TRUE(fs::exists(place / "disk/results/history-uniaxial-compression-s1.csv"));
    expect_whole_results(place / "disk/results");
}

TEST(LostOutput, ADiskTooSmallForTheJobIsFoundBeforeTheRun) {
    const TemporaryFolder place;
    const SmallDisk disk(place / "disk");
    if (!disk.mounted()) GTEST_SKIP() << "cannot mount a small disk: " << disk.reason();
    disk.fill();
    write_text(place / "job.toml", small_job());
    const Outcome outcome = run_program(place.path(), {"run", "job.toml", "--out", "disk/results"});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find("space"), std::string::npos) << outcome.err;
    EXPECT_EQ(place.entries(), (std::set<std::string>{"job.toml", "disk", "disk/filler"}));
}

}  // namespace
}  // namespace feldspar::testing_program
