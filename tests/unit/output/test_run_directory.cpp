// A run's directory: numbering, refusals, and what is left when a write fails.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <set>

#include "../../temporary_folder.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/output/results.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

/// The message of the InputError that `action` throws; empty if none.
template <class Action>
std::string refusal(Action action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

/// Runs `action` in a process of its own, so that limits and rights can be changed; gives its exit code.
template <class Action>
int in_child(Action action) {
    const pid_t child = fork();
    if (child == 0) _exit(action());
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(RunDirectory, MakesTheWantedDirectoryWithItsParents) {
    const TemporaryFolder scratch;
    const auto directory = RunDirectory::create(scratch.path() / "a" / "b", "job");
    EXPECT_TRUE(fs::is_directory(scratch.path() / "a" / "b"));
    EXPECT_EQ(directory.path(), scratch.path() / "a" / "b");
}

TEST(RunDirectory, RefusesWhatExists) {
    const TemporaryFolder scratch;
    fs::create_directory(scratch.path() / "old");
    std::ofstream(scratch.path() / "file") << "x";
    fs::create_symlink("nowhere", scratch.path() / "link");
    for (const char* name : {"old", "file", "link"}) {
        EXPECT_NE(refusal([&] { RunDirectory::create(scratch.path() / name, "job"); }).find("exists already"), std::string::npos)
            << name;
        EXPECT_NE(refusal([&] { RunDirectory::check(scratch.path() / name, "job"); }).find("exists already"), std::string::npos)
            << name;
    }
    EXPECT_EQ(count_entries(scratch.path()), 3);
}

TEST(RunDirectory, CheckMakesNothing) {
    const TemporaryFolder scratch;
    EXPECT_EQ(refusal([&] { RunDirectory::check(scratch.path() / "a" / "b", "job"); }), "");
    EXPECT_EQ(count_entries(scratch.path()), 0);
}

TEST(RunDirectory, RefusesAPlaceThatIsNoDirectory) {
    const TemporaryFolder scratch;
    std::ofstream(scratch.path() / "file") << "x";
    EXPECT_NE(refusal([&] { RunDirectory::check(scratch.path() / "file" / "run", "job"); }).find("is not a directory"),
              std::string::npos);
    EXPECT_NE(refusal([&] { RunDirectory::check("/dev/full/run", "job"); }).find("is not a directory"), std::string::npos);
}

TEST(RunDirectory, RefusesAPlaceThatMayNotBeWritten) {
    const TemporaryFolder scratch;
    fs::create_directory(scratch.path() / "locked");
    fs::permissions(scratch.path(), fs::perms::owner_all | fs::perms::others_read | fs::perms::others_exec);
    fs::permissions(scratch.path() / "locked",
                    fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec);
    const int code = in_child([&] {
        if (geteuid() == 0 && seteuid(65534) != 0) return 9;  // root may write everywhere
        const std::string message = refusal([&] { RunDirectory::check(scratch.path() / "locked" / "run", "job"); });
        return message.find("Permission denied") != std::string::npos ? 0 : 1;
    });
    fs::permissions(scratch.path() / "locked", fs::perms::owner_all);
    EXPECT_EQ(code, 0);
}

TEST(RunDirectory, CountsUpWithoutAWantedDirectory) {
    const TemporaryFolder scratch;
    const fs::path before = fs::current_path();
    fs::current_path(scratch.path());
    EXPECT_EQ(RunDirectory::create({}, "augig").path(), fs::path("results/augig-1"));
    EXPECT_EQ(RunDirectory::create({}, "augig").path(), fs::path("results/augig-2"));
    EXPECT_EQ(RunDirectory::create({}, "a/b c").path(), fs::path("results/a-b-c-1"));
    fs::current_path(before);
    EXPECT_EQ(count_entries(scratch.path() / "results"), 3);
}

TEST(RunDirectory, ReplacesAFileAsAWhole) {
    const TemporaryFolder scratch;
    const auto directory = RunDirectory::create(scratch.path() / "run", "job");
    directory.write_text("summary.json", "one");
    directory.write_text("summary.json", "two");
    directory.write_text("folder/part.vtu", "three");
    EXPECT_EQ(read_text(directory.path() / "summary.json"), "two");
    EXPECT_EQ(read_text(directory.path() / "folder/part.vtu"), "three");
    EXPECT_EQ(count_entries(directory.path()), 2);
}

TEST(RunDirectory, AFailedWriteKeepsTheEarlierFileAndLeavesNothingAside) {
    const TemporaryFolder scratch;
    const auto directory = RunDirectory::create(scratch.path() / "run", "job");
    directory.write_text("summary.json", "whole");
    EXPECT_THROW(directory.write("summary.json",
                                 [](const fs::path& aside) {
                                     std::ofstream(aside) << "ha";
                                     throw OutputError("no more");
                                 }),
                 OutputError);
    EXPECT_THROW(directory.write("other.json", [](const fs::path&) {}), OutputError);  // nothing was written at all
    EXPECT_EQ(read_text(directory.path() / "summary.json"), "whole");
    EXPECT_EQ(count_entries(directory.path()), 1);
}

// Two programs on one study write its page at the same time.
TEST(RunDirectory, TwoProgramsMayWriteTheSameFileAtOnce) {
    const TemporaryFolder scratch;
    const auto directory = RunDirectory::create(scratch.path() / "run", "job");
    directory.write("page.html", [&](const fs::path& aside) {
        std::ofstream file(aside);
        file << "first " << std::flush;
        const int other = in_child([&] {
            try {
                RunDirectory::open(directory.path()).write_text("page.html", "other, whole");
            } catch (const std::exception&) {
                return 1;
            }
            return 0;
        });
        EXPECT_EQ(other, 0);
        EXPECT_EQ(read_text(directory.path() / "page.html"), "other, whole");
        file << "whole";
    });
    EXPECT_EQ(read_text(directory.path() / "page.html"), "first whole");
    EXPECT_EQ(count_entries(directory.path()), 1);
}

TEST(RunDirectory, WhatAKilledProgramLeftAsideGoesWhenTheDirectoryIsOpened) {
    const TemporaryFolder scratch;
    const auto directory = RunDirectory::create(scratch.path() / "run", "job");
    directory.write_text("page.html", "whole");
    const int code = in_child([&] {
        directory.write("page.html", [](const fs::path& aside) {
            std::ofstream(aside) << "ha";
            raise(SIGKILL);
        });
        return 0;
    });
    EXPECT_EQ(code, 128 + SIGKILL);
    EXPECT_EQ(count_entries(directory.path()), 2);
    EXPECT_EQ(read_text(directory.path() / "page.html"), "whole");
    (void)RunDirectory::open(directory.path());
    EXPECT_EQ(count_entries(directory.path()), 1);
}

TEST(RunDirectory, WhatOthersStillWriteStays) {
    const TemporaryFolder scratch;
    const auto directory = RunDirectory::create(scratch.path() / "run", "job");
    const fs::path elsewhere = directory.path() / ".page.html.1-1-another_machine.part";
    std::ofstream(elsewhere) << "ha";
    std::ofstream(directory.path() / ".notes.part") << "a file of the user's";
    directory.write("page.html", [&](const fs::path& aside) {
        std::ofstream(aside) << "whole";
        (void)RunDirectory::open(directory.path());
    });
    EXPECT_EQ(read_text(directory.path() / "page.html"), "whole");
    EXPECT_TRUE(fs::exists(elsewhere));
    fs::last_write_time(elsewhere, fs::file_time_type::clock::now() - std::chrono::hours(25));
    (void)RunDirectory::open(directory.path());
    EXPECT_FALSE(fs::exists(elsewhere));
    EXPECT_TRUE(fs::exists(directory.path() / ".notes.part"));
}

TEST(RunDirectory, AFullDiskLeavesNoTruncatedFile) {
    const TemporaryFolder scratch;
    const auto directory = RunDirectory::create(scratch.path() / "run", "job");
    directory.write_text("history.csv", "whole");
    // a file-size limit acts like a disk that fills in the middle of a write; its signal would end the program
    const int code = in_child([&] {
        const rlimit limit{4096, 4096};
        setrlimit(RLIMIT_FSIZE, &limit);
        try {
            directory.write_text("history.csv", std::string(10000, 'x'));
        } catch (const OutputError& error) {
            return std::string(error.what()).find("/history.csv': File too large") != std::string::npos ? 0 : 2;
        }
        return 1;
    });
    EXPECT_EQ(code, 0);
    EXPECT_EQ(read_text(directory.path() / "history.csv"), "whole");
    EXPECT_EQ(count_entries(directory.path()), 1);
}

TEST(RunDirectory, WritesThroughNoLink) {
    const TemporaryFolder scratch;
    const auto directory = RunDirectory::create(scratch.path() / "run", "job");
    scratch.write("victim", "precious");
    fs::create_symlink(scratch.path() / "victim", directory.path() / "summary.json");
    std::set<std::string> names;
    for (int i = 0; i < 2; ++i)
        directory.write("summary.json", [&](const fs::path& aside) {
            EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(aside))) << "made before anybody writes to it";
            EXPECT_TRUE(names.insert(aside.string()).second);
            write_text(aside, "{}");
        });
    EXPECT_EQ(read_text(scratch / "victim"), "precious");
    EXPECT_FALSE(fs::is_symlink(directory.path() / "summary.json"));
    EXPECT_EQ(read_text(directory.path() / "summary.json"), "{}");
}

TEST(RunDirectory, SaysThatTheDirectoryIsGone) {
    const TemporaryFolder scratch;
    const auto directory = RunDirectory::create(scratch.path() / "run", "job");
    fs::remove_all(directory.path());
    for (const char* name : {"summary.json", "folder/part.vtu"}) {
        try {
            directory.write_text(name, "text");
            FAIL() << name;
        } catch (const OutputError& error) {
            EXPECT_NE(std::string(error.what()).find("No such file or directory"), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find((scratch.path() / "run").string()), std::string::npos) << error.what();
        }
    }
    EXPECT_FALSE(fs::exists(directory.path()));
}

}  // namespace
}  // namespace feldspar
