// A job run through: what is in its directory, what the listener is told, and what becomes of failures and interruptions. The program
// itself is held to the same by tests/robustness.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/study/run_job.hpp"
#include "../../small_study.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

class Listener : public JobListener {
public:
    void busy(const std::string& what) override { notes.push_back(what); }
    void making(const std::string& packing, const SpecimenProgress&) override { made = packing; }
    void note(const std::string& line) override { notes.push_back(line); }
    void progress(int, int count, const std::string&, const TestProgress&) override { EXPECT_EQ(count, expected_count); }
    void ended(int number) override { over.push_back(number); }
    void finished(const std::string& label, const TestResult&) override {
        results.push_back(label);
        if (stop_at_result != nullptr) *stop_at_result = true;
    }
    void clear() override {}
    void broken_off(std::size_t tests, const fs::path& directory) override { broken = std::to_string(tests) + " in " + directory.filename().string(); }

    bool told(const std::string& part) const {
        return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) { return note.find(part) != std::string::npos; });
    }

    std::vector<std::string> notes, results;
    std::vector<int> over;
    std::string made, broken;
    int expected_count = 4;
    std::atomic<bool>* stop_at_result = nullptr;
};

class RunJob : public ::testing::Test {
protected:
    JobOutcome run(const Job& job, int threads = 1) {
        JobControl control;
        control.threads = threads;
        control.out = (folder_ / "results").string();
        control.provenance = collect_provenance("test", threads);
        control.stop = &stop_;
        control.listener = &listener_;
        return run_job(job, control);
    }
    bool there(const std::string& file) const { return fs::exists(folder_ / "results" / file); }

    StudyFolder folder_;
    Job job_ = parse_job(small_job, "job.toml");
    std::atomic<bool> stop_{false};
    Listener listener_;
};

TEST_F(RunJob, LeavesEveryTestsFilesAndResultsInTheJobsOrder) {
    const JobOutcome outcome = run(job_, 2);
    EXPECT_EQ(outcome.tests, 4u);
    ASSERT_EQ(outcome.results.size(), 4u);
    EXPECT_TRUE(outcome.failed.empty());
    EXPECT_FALSE(outcome.interrupted);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(outcome.results[i].seed, 1 + i / 2);
        EXPECT_EQ(outcome.results[i].test.kind, job_.tests[i % 2].kind);
        const std::string stem = test_stem(outcome.results[i]);
        for (const std::string& file : {"history-" + stem + ".csv", stem + ".h5", stem + ".pvd"}) EXPECT_TRUE(there(file)) << file;
    }
    for (const char* file : {"job.toml", "job-resolved.toml", "packing-s1.txt", "packing-s2.txt", "summary.json", "report.html"}) EXPECT_TRUE(there(file)) << file;
    EXPECT_EQ(outcome.properties.values.at("UCS_Pa").seeds, (std::vector<std::uint64_t>{1, 2}));

    EXPECT_EQ(listener_.notes.front(), "making 2 packings");
    EXPECT_TRUE(listener_.told("results go to "));
    EXPECT_EQ(listener_.results.size(), 4u);
    EXPECT_EQ(listener_.over.size(), 4u);
    EXPECT_NE(std::find(listener_.results.begin(), listener_.results.end(), "4/4 direct-tension, seed 2"), listener_.results.end());
    EXPECT_TRUE(listener_.broken.empty());
}

TEST_F(RunJob, ASinglePackingTellsHowFarItIs) {
    job_.seeds = {7};
    job_.tests.resize(1);
    listener_.expected_count = 1;
    EXPECT_EQ(run(job_).results.size(), 1u);
    EXPECT_EQ(listener_.made, "packing-s7");
}

TEST_F(RunJob, AFailureIsListedAndTheOthersGoOn) {
    job_.tests[0].kind = methods::biaxial;   // crushed before it is sheared
    job_.tests[0].sigma3_Pa = 5e9;
    const JobOutcome outcome = run(job_);
    EXPECT_EQ(outcome.results.size(), 2u);
    ASSERT_EQ(outcome.failed.size(), 2u);
    EXPECT_EQ(outcome.failed[0].seed, 1u);
    EXPECT_EQ(outcome.failed[1].seed, 2u);
    EXPECT_FALSE(outcome.failed[0].reason.empty());
    EXPECT_FALSE(outcome.interrupted);
    EXPECT_TRUE(listener_.told("1/4 biaxial at 5000 MPa, seed 1: failed: " + outcome.failed[0].reason));
}

TEST_F(RunJob, AnInterruptionKeepsWhatHasEnded) {
    listener_.stop_at_result = &stop_;
    const JobOutcome outcome = run(job_);
    EXPECT_TRUE(outcome.interrupted);
    EXPECT_GE(outcome.results.size(), 1u);
    EXPECT_LE(outcome.results.size(), 2u);   // the second had begun
    EXPECT_TRUE(there("summary.json"));
}

TEST_F(RunJob, WhatIsWrongShowsBeforeThereIsADirectory) {
    job_.variants.front().numerics.mass_factor = 1e-3;   // unstable
    EXPECT_THROW((void)run(job_), InputError);
    EXPECT_FALSE(fs::exists(folder_ / "results"));
    stop_ = true;
    EXPECT_THROW((void)run(parse_job(small_job, "job.toml")), Interrupted);
    EXPECT_FALSE(fs::exists(folder_ / "results"));
    EXPECT_TRUE(listener_.broken.empty());
}

TEST_F(RunJob, ADirectoryThatVanishesEndsAll) {
    class Vanishing : public Listener {
    public:
        explicit Vanishing(fs::path place) : place_(std::move(place)) {}
        void finished(const std::string&, const TestResult&) override { fs::rename(place_, place_.string() + "-elsewhere"); }

    private:
        fs::path place_;
    } vanishing(folder_ / "results");
    JobControl control;
    control.out = (folder_ / "results").string();
    control.stop = &stop_;
    control.listener = &vanishing;
    EXPECT_THROW((void)run_job(job_, control), OutputError);
    EXPECT_EQ(vanishing.broken, "1 in results");
    EXPECT_TRUE(stop_);   // what ran was asked to end
}

}  // namespace
}  // namespace feldspar
