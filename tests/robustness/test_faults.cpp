// What else can go wrong around a program that runs: impatient users, readers that go away, disks that may not be written,
// results that vanish, ledgers that are damaged or locked, and too little memory. It never crashes, says what is wrong, and goes
// on afterwards.
#include <fmt/format.h>
#include <sys/mount.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "program.hpp"

namespace feldspar::testing_program {
namespace {

const std::string two_values =
    "job = \"job.toml\"\n[[axis]]\nname = \"mu\"\nkey = \"material.contact.mu\"\nvalues = [0.3, 0.4]\n";
const std::vector<std::string> study_command{"study", "study.toml", "--results", "results", "--threads", "1"};

// Lines of the study's table but those that say when.
std::string table_of(const TemporaryFolder& place) {
    std::string kept;
    std::istringstream text(run_program(place.path(), {"study", "table", "study.toml", "--results", "results"}).out);
    for (std::string line; std::getline(text, line);)
        if (!line.starts_with("#")) kept += line + "\n";
    return kept;
}

TEST(Faults, CtrlCTwiceEndsAtOnceAndTheRunGoesOn) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[1, 2, 3, 4]",
                                             "kind = \"adaptive\"\naccuracy = \"2 %\"\n"));
    const std::vector<std::string> command{"run", "job.toml", "--out", "results", "--checkpoint-every", "20 ms"};
    for (int milliseconds : {0, 1, 5, 20}) {  // between the two
        Program program(place.path(), command);
        ASSERT_TRUE(program.wait_until([&] { return fs::exists(place / "results/checkpoints/job"); })) << program.err_so_far();
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        program.send(SIGINT);
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        program.send(SIGINT);
        const int code = program.finish().code;  // 130 either way: by itself, or by the signal
        EXPECT_TRUE(code == 130 || code == 0) << code;
        if (code == 0) break;
    }
    if (fs::exists(place / "results/checkpoints/job")) {
        const Outcome outcome = run_program(place.path(), command);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
    }
    EXPECT_TRUE(nlohmann::json::parse(read_text(place / "results/summary.json")).at("complete").get<bool>());
    expect_no_half_files(place / "results");
}

// Nobody reads what is printed: `feldspar run job.toml | true`.
TEST(Faults, AReaderThatGoesAwayCostsNoResult) {
    for (const int lost : {STDOUT_FILENO, STDERR_FILENO}) {
        SCOPED_TRACE(lost);
        const TemporaryFolder place;
        write_text(place / "job.toml", small_job());
        write_text(place / "study.toml", two_values);
        const auto close_reader = [lost] {
            int ends[2];
            if (pipe(ends) != 0) _exit(125);
            dup2(ends[1], lost);
            close(ends[0]);
            close(ends[1]);
        };
        const Outcome run = run_program(place.path(), {"run", "job.toml", "--out", "run"}, close_reader);
        EXPECT_EQ(run.code, lost == STDOUT_FILENO ? 4 : 0) << run.err;
        ASSERT_TRUE(fs::exists(place / "run/summary.json"));
        EXPECT_TRUE(nlohmann::json::parse(read_text(place / "run/summary.json")).at("complete").get<bool>());
        EXPECT_FALSE(fs::exists(place / "run/checkpoints"));
        const Outcome study = run_program(place.path(), study_command, close_reader);
        EXPECT_EQ(study.code, lost == STDOUT_FILENO ? 4 : 0) << study.err;
        const Outcome status = run_program(place.path(), {"study", "status", "study.toml", "--results", "results"});
        EXPECT_NE(status.out.find("2 runs: 2 done"), std::string::npos) << status.out;
        expect_no_half_files(place.path());
        if (lost == STDOUT_FILENO) {
            EXPECT_NE(run.err.find("could not be printed"), std::string::npos) << run.err;
        }
    }
}

TEST(Faults, AReadOnlyDiskIsToldAndTheRunGoesOnWhenItIsNotAnyMore) {
    const TemporaryFolder place;
    const fs::path disk = place / "disk";
    fs::create_directory(disk);
    if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=64m") != 0)
        GTEST_SKIP() << "cannot mount a small disk: " << std::strerror(errno);
    const auto remount = [&](unsigned long how) {
        ASSERT_EQ(mount("tmpfs", disk.c_str(), "tmpfs", MS_REMOUNT | how, "size=64m"), 0);
    };
    write_text(place / "job.toml",
               small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[1, 2]", "kind = \"adaptive\"\naccuracy = \"2 %\"\n"));
    write_text(place / "study.toml", two_values);
    const std::vector<std::string> command{"run", "job.toml", "--out", "disk/results", "--checkpoint-every", "20 ms"},
        study{"study", "study.toml", "--results", "disk/study", "--threads", "1"};
    remount(MS_RDONLY);
    const Outcome refused = run_program(place.path(), command);
    EXPECT_EQ(refused.code, 2) << refused.err;
    EXPECT_NE(refused.err.find("Read-only file system"), std::string::npos) << refused.err;
    const Outcome no_study = run_program(place.path(), study);
    EXPECT_EQ(no_study.code, 4) << no_study.err;
    EXPECT_NE(no_study.err.find("Read-only file system"), std::string::npos) << no_study.err;
    remount(0);
    {
        Program program(place.path(), command);
        ASSERT_TRUE(program.wait_until([&] { return fs::exists(disk / "results/checkpoints/uniaxial-compression-s1.state"); }))
            << program.err_so_far();
        program.send(SIGKILL);
        (void)program.finish();
    }
    remount(MS_RDONLY);
    const Outcome stopped = run_program(place.path(), command);
    EXPECT_EQ(stopped.code, 4) << stopped.err;
    EXPECT_NE(stopped.err.find("Read-only file system"), std::string::npos) << stopped.err;
    remount(0);
    const Outcome again = run_program(place.path(), command);
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(run_program(place.path(), study).code, 0);
    expect_no_half_files(disk);
    umount2(disk.c_str(), MNT_DETACH);
}

TEST(Faults, ResultsThatAreRemovedUnderTheProgramEndItWithFour) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[1, 2, 3, 4, 5, 6, 7, 8, 9, 10]"));
    write_text(place / "study.toml", replaced(two_values, "values = [0.3, 0.4]", "values = [0.2, 0.25, 0.3, 0.35, 0.4, 0.45]"));
    for (const auto& [command, there] :
         {std::pair{std::vector<std::string>{"run", "job.toml", "--out", "results"}, "results/summary.json"},
          std::pair{study_command, "results/ledger.sqlite-wal"}}) {
        SCOPED_TRACE(command.front());
        Program program(place.path(), command);
        ASSERT_TRUE(program.wait_until([&, file = there] { return fs::exists(place / file); })) << program.err_so_far();
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        for (int attempt = 0; attempt < 20 && fs::exists(place / "results"); ++attempt) {  // files come while they go
            std::error_code ignored;
            fs::remove_all(place / "results", ignored);
        }
        const Outcome outcome = program.finish();
        EXPECT_TRUE(outcome.code == 4) << outcome.code << outcome.err;
        EXPECT_NE(outcome.err.find("results"), std::string::npos) << outcome.err;
        std::error_code ignored;
        fs::remove_all(place / "results", ignored);
        const Outcome again = run_program(place.path(), command);
        EXPECT_EQ(again.code, 0) << again.err;
        fs::remove_all(place / "results", ignored);
    }
}

class DamagedLedger : public testing::Test {
protected:
    DamagedLedger() {
        write_text(place_ / "job.toml", small_job());
        write_text(place_ / "study.toml", replaced(two_values, "values = [0.3, 0.4]", "values = [0.3, 0.4, 0.5]"));
        EXPECT_EQ(run_program(place_.path(), study_command).code, 0);
        table_ = table_of(place_);
        whole_ = read_text(place_ / "results/ledger.sqlite");
        EXPECT_GT(table_.size(), 100U);
    }

    // The study with the damaged ledger: its results, or what to do and then its results.
    void judge(const std::string& ledger) {
        write_text(place_ / "results/ledger.sqlite", ledger);
        const Outcome outcome = run_program(place_.path(), study_command);
        if (outcome.code == 0) {
            EXPECT_EQ(table_of(place_), table_);
        } else {
            ++told_;
            EXPECT_TRUE(outcome.code == 4 || outcome.code == 2) << outcome.code << outcome.err;
            EXPECT_NE(outcome.err.find("results/ledger.sqlite"), std::string::npos) << outcome.err;
            EXPECT_NE(outcome.err.find("move the file away, and the same command makes it again"), std::string::npos)
                << outcome.err;
            for (const char* ending : {"", "-wal", "-shm"}) fs::remove(place_ / (std::string("results/ledger.sqlite") + ending));
            const Outcome again = run_program(place_.path(), study_command);
            EXPECT_EQ(again.code, 0) << again.err;
            EXPECT_NE(again.out.find("0 runs done now, 3 before"), std::string::npos) << again.out;  // nothing is computed twice
            EXPECT_EQ(table_of(place_), table_);
        }
    }

    TemporaryFolder place_;
    std::string table_, whole_;
    int told_ = 0;
};

TEST_F(DamagedLedger, BytesThatChanged) {
    std::mt19937 random(3);
    for (int i = 0; i < 40; ++i) {
        std::string bytes = whole_;
        const std::size_t at = i < 20 ? static_cast<std::size_t>(i * 5) : random() % bytes.size();  // the head, then anywhere
        for (std::size_t j = at; j < std::min(at + 1 + random() % 8, bytes.size()); ++j)
            bytes[j] = static_cast<char>(bytes[j] ^ static_cast<char>(1 + random() % 255));
        SCOPED_TRACE(fmt::format("from byte {}", at));
        judge(bytes);
    }
    EXPECT_GT(told_, 3);
}

TEST_F(DamagedLedger, CutOff) {
    for (const double part : {0.0, 0.0005, 0.01, 0.2, 0.5, 0.8, 0.97}) {
        SCOPED_TRACE(part);
        judge(whole_.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole_.size()))));
    }
    EXPECT_GT(told_, 2);
}

TEST_F(DamagedLedger, ARecordThatIsDamagedTooIsMadeAgain) {
    const auto runs = [&] { return fs::directory_iterator(place_ / "results/runs"); };
    for (int kind = 0; kind < 2; ++kind) {
        for (const auto& entry : runs()) {
            std::string record = read_text(entry.path() / "run.json");
            if (kind == 0)
                record.resize(record.size() / 2);
            else
                record[record.find("strength_Pa") + 15] ^= 1;  // another digit
            write_text(entry.path() / "run.json", record);
        }
        for (const char* ending : {"", "-wal", "-shm"}) fs::remove(place_ / (std::string("results/ledger.sqlite") + ending));
        const Outcome outcome = run_program(place_.path(), study_command);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_NE(outcome.err.find("its run is made again"), std::string::npos) << outcome.err;
        EXPECT_NE(outcome.out.find("3 runs done now"), std::string::npos) << outcome.out;
        EXPECT_EQ(table_of(place_), table_);
    }
}

// The program was ended when run.json was written, and neither its row nor the state was settled.
TEST_F(DamagedLedger, AStateOfARunThatIsDoneIsRemoved) {
    for (const auto& entry : fs::directory_iterator(place_ / "results/runs"))
        for (const char* ending : {"", ".before"}) write_text(entry.path() / (std::string("test.state") + ending), "left behind");
    fs::remove(place_ / "results/ledger.sqlite");
    const Outcome outcome = run_program(place_.path(), study_command);
    EXPECT_NE(outcome.out.find("0 runs done now, 3 before"), std::string::npos) << outcome.out << outcome.err;
    for (const auto& entry : fs::recursive_directory_iterator(place_ / "results"))
        EXPECT_FALSE(entry.path().filename().string().starts_with("test.state")) << entry.path();
}

// Another program writes; the study waits for it.
TEST_F(DamagedLedger, LockedForAWhile) {
    write_text(place_ / "results/ledger.sqlite", whole_);
    const int file = open((place_ / "results/ledger.sqlite").c_str(), O_RDWR | O_CLOEXEC);
    struct flock lock {};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    lock.l_start = 0x40000000;  // where SQLite locks
    lock.l_len = 512;
    ASSERT_EQ(fcntl(file, F_SETLK, &lock), 0);
    Program program(place_.path(), study_command);
    EXPECT_FALSE(program.wait_until([until = std::chrono::steady_clock::now() + std::chrono::milliseconds(700)] {
        return std::chrono::steady_clock::now() > until;
    }) == false)
        << program.err_so_far();
    close(file);
    const Outcome outcome = program.finish();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(table_of(place_), table_);
}

TEST(Faults, TooLittleMemoryIsSaid) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job("[[test]]\nkind = \"uniaxial-compression\"\nsnapshots = 2\n", "[1, 2]"));
    int refused = 0;
    for (const rlim_t MB : {58, 60, 62, 64, 68, 80, 92, 100}) {
        for (const auto kind : {RLIMIT_AS, RLIMIT_DATA}) {
            const rlim_t bytes = (kind == RLIMIT_DATA ? MB / 4 : MB) << 20;
            SCOPED_TRACE(fmt::format("{} of {} MB", kind == RLIMIT_AS ? "address space" : "data", bytes >> 20));
            const auto limited = [=] {
                const rlimit limit{bytes, bytes};
                setrlimit(kind, &limit);
            };
            if (run_program(place.path(), {"--version"}, limited).code != 0) continue;  // the system cannot even load the program
            std::error_code ignored;
            fs::remove_all(place / "results", ignored);
            const Outcome outcome = run_program(place.path(), {"run", "job.toml", "--out", "results", "--threads", "2"}, limited);
            if (outcome.code == 0) continue;
            ++refused;
            EXPECT_EQ(outcome.code, 3) << outcome.code << outcome.err;
            EXPECT_NE(outcome.err.find("memory"), std::string::npos) << outcome.err;
            if (fs::exists(place / "results")) expect_no_half_files(place / "results");
            if (!fs::exists(place / "results/checkpoints/job")) fs::remove_all(place / "results", ignored);
            const Outcome again = run_program(place.path(), {"run", "job.toml", "--out", "results"});
            EXPECT_EQ(again.code, 0) << again.err;
        }
    }
    EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace feldspar::testing_program
