// A job run through: what is in its directory, what the listener is told, and what becomes of failures and interruptions. The
// program itself is held to the same by tests/robustness.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "../../small_study.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/live/live_stream.hpp"
#include "feldspar/specimen/write_cells.hpp"
#include "feldspar/study/run_job.hpp"
#include "feldspar/study/study.hpp"

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
    void broken_off(std::size_t tests, const fs::path& directory) override {
        broken = std::to_string(tests) + " in " + directory.filename().string();
    }

    bool told(const std::string& part) const {
        return std::any_of(notes.begin(), notes.end(),
                           [&](const std::string& note) { return note.find(part) != std::string::npos; });
    }

    std::vector<std::string> notes, results;
    std::vector<int> over;
    std::string made, broken;
    int expected_count = 4;
    std::atomic<bool>* stop_at_result = nullptr;
};

class RunJob : public ::testing::Test {
protected:
    JobOutcome run(const Job& job, int threads = 1, Keep keep = Keep::all, bool go_on = false) {
        JobControl control;
        control.keep = keep;
        control.go_on = go_on;
        control.threads = threads;
        control.out = (folder_ / "results").string();
        control.provenance = collect_provenance("test", threads);
        control.stop = &stop_;
        control.listener = &listener_;
        control.live = live_;
        return run_job(job, control);
    }
    bool there(const std::string& file) const { return fs::exists(folder_ / "results" / file); }

    StudyFolder folder_;
    Job job_ = parse_job(small_job, "job.toml");
    std::atomic<bool> stop_{false};
    Listener listener_;
    LiveBoard* live_ = nullptr;
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
        for (const std::string& file : {"history-" + stem + ".csv", stem + ".h5"}) EXPECT_TRUE(there(file)) << file;
    }
    for (const char* file : {"job.toml", "job-resolved.toml", "packing-s1.txt", "packing-s2.txt", "summary.json", "report.html"})
        EXPECT_TRUE(there(file)) << file;
    EXPECT_EQ(outcome.properties.values.at("UCS_Pa").seeds, (std::vector<std::uint64_t>{1, 2}));

    EXPECT_EQ(listener_.notes.front(), "making 2 packings");
    EXPECT_TRUE(listener_.told("results go to "));
    EXPECT_EQ(listener_.results.size(), 4u);
    EXPECT_EQ(listener_.over.size(), 4u);
    EXPECT_NE(std::find(listener_.results.begin(), listener_.results.end(), "4/4 direct-tension, seed 2"),
              listener_.results.end());
    EXPECT_TRUE(listener_.broken.empty());
}

TEST_F(RunJob, KeepsWhatIsAskedFor) {
    job_.seeds = {1};
    job_.tests.resize(1);
    listener_.expected_count = 1;
    const std::string stem = test_stem(run(job_, 1, Keep::numbers).results.front());
    for (const char* file : {"job.toml", "job-resolved.toml", "summary.json", "report.html"}) EXPECT_TRUE(there(file)) << file;
    for (const std::string& file :
         {"history-" + stem + ".csv", "events-" + stem + ".csv", stem + ".h5", std::string("packing-s1.txt")})
        EXPECT_FALSE(there(file)) << file;
    fs::remove_all(folder_ / "results");
    (void)run(job_, 1, Keep::histories);
    EXPECT_TRUE(there("history-" + stem + ".csv"));
    for (const std::string& file : {stem + ".h5", std::string("packing-s1.txt")}) EXPECT_FALSE(there(file)) << file;
}

TEST_F(RunJob, GoesOnOnlyWithWhatIsThere) {
    try {
        (void)run(job_, 1, Keep::all, true);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.place().key, "--continue");
    }
    EXPECT_FALSE(fs::exists(folder_ / "results"));
}

TEST_F(RunJob, ASinglePackingTellsHowFarItIs) {
    job_.seeds = {7};
    job_.tests.resize(1);
    listener_.expected_count = 1;
    EXPECT_EQ(run(job_).results.size(), 1u);
    EXPECT_EQ(listener_.made, "packing-s7");
}

TEST_F(RunJob, AFailureIsListedAndTheOthersGoOn) {
    job_.tests[0].kind = methods::biaxial;  // crushed before it is sheared
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

TEST_F(RunJob, ABoardHearsOfEveryTestAndReport) {
    LiveBoard board("granite", stop_);
    live_ = &board;
    job_.tests[1].kind = methods::biaxial;  // crushed before it is sheared
    job_.tests[1].sigma3_Pa = 5e9;
    (void)run(job_, 2);
    LiveStream page(board);
    const auto news = nlohmann::json::parse(page.next(std::chrono::milliseconds(0)));
    EXPECT_EQ(news["run"]["tests"], 4);
    EXPECT_EQ(news["run"]["ended"], 2);
    EXPECT_EQ(news["run"]["failed"], 2);
    EXPECT_EQ(news["run"]["running"], 0);
    EXPECT_GE(news["run"]["reports"], 1);
    EXPECT_EQ(board.report_file(), folder_ / "results" / "report.html");
    ASSERT_EQ(news["tests"].size(), 4u);
    EXPECT_EQ(news["tests"][0]["label"], "uniaxial-compression, seed 1");
    EXPECT_NE(news["tests"][0]["words"].get<std::string>().find(" MPa, grade "), std::string::npos);
    EXPECT_EQ(news["tests"][1]["words"].get<std::string>().rfind("failed: ", 0), 0u);
}

TEST_F(RunJob, AnInterruptionKeepsWhatHasEnded) {
    listener_.stop_at_result = &stop_;
    const JobOutcome outcome = run(job_);
    EXPECT_TRUE(outcome.interrupted);
    EXPECT_GE(outcome.results.size(), 1u);
    EXPECT_LE(outcome.results.size(), 2u);  // the second had begun
    EXPECT_TRUE(there("summary.json"));
}

TEST_F(RunJob, WhatIsWrongShowsBeforeThereIsADirectory) {
    job_.variants.front().numerics.mass_factor = 1e-3;  // unstable
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
    EXPECT_TRUE(stop_);  // what ran was asked to end
}

/// small_job on cells of a file, one test.
std::string job_on(const std::string& file, const std::string& more) {
    std::string text = small_job;
    const auto replace = [&](const std::string& from, const std::string& to) {
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
    };
    replace("shape = \"rectangle\"\nwidth = \"12 mm\"\nheight = \"24 mm\"", "shape = \"from-file\"");
    replace("diameter = { distribution = \"uniform\", minimum = \"2 mm\", maximum = \"4 mm\" }",
            "file = \"" + file + "\"\n" + more);
    replace("[[test]]\nkind = \"direct-tension\"\n", "");
    replace("seeds = [1, 2]", "seeds = [1]");
    return text;
}

TEST_F(RunJob, OnCellsOfAFileBreaksThemByTheSameBitsInEveryFormat) {
    listener_.expected_count = 1;
    SpecimenSpec packed = job_.specimen;
    const Specimen made = make_specimen(packed, 1);
    std::string first;
    std::set<std::string> ids;
    for (const auto& [format, file] :
         {std::pair{CellFormat::tess, "cells.tess"}, {CellFormat::msh, "cells.msh"}, {CellFormat::csv, "cells.csv"}}) {
        folder_.write(file, cells_as_text(made, format));
        folder_.write("on-cells.toml",
                      job_on(file, std::string(format == CellFormat::csv ? "" : "unit = \"m\"\n") + "merge_length = \"none\""));
        const Job job = read_job(folder_ / "on-cells.toml");
        ids.insert(study_of(job, "study", "results").runs.front().id);
        run(job);
        const std::string history = read_text(folder_ / "results/history-uniaxial-compression-s1.csv");
        EXPECT_GT(history.size(), 1000u);
        if (first.empty()) first = history;
        EXPECT_TRUE(history == first) << file;
        EXPECT_TRUE(there("cells-s1.tess"));
        EXPECT_FALSE(there("packing-s1.txt"));
        fs::remove_all(folder_ / "results");
    }
    EXPECT_EQ(ids.size(), 3u) << "another file is another run";
    // a run is known by what is in the file, not by its place
    folder_.write("elsewhere.tess", read_text(folder_ / "cells.tess"));
    folder_.write("on-cells.toml", job_on("elsewhere.tess", "unit = \"m\"\nmerge_length = \"none\""));
    EXPECT_TRUE(ids.contains(study_of(read_job(folder_ / "on-cells.toml"), "study", "results").runs.front().id));
    std::string changed = read_text(folder_ / "cells.tess");
    changed.insert(changed.find("***end"), "\n");
    folder_.write("elsewhere.tess", changed);
    EXPECT_FALSE(ids.contains(study_of(read_job(folder_ / "on-cells.toml"), "study", "results").runs.front().id));
}

// A file written to the format's documentation, by no program of ours.
TEST_F(RunJob, OnAHandWrittenTessellationBreaks) {
    listener_.expected_count = 1;
    std::vector<std::string> files;
    for (const char* file : {"honeycomb.tess", "honeycomb.csv", "honeycomb.msh"}) {
        folder_.write(file, read_text(fs::path(FELDSPAR_SOURCE_DIR) / "tests/unit/specimen/data" / file));
        folder_.write("on-cells.toml", job_on(file, "unit = \"2 mm\""));
        run(read_job(folder_ / "on-cells.toml"));
        const std::string summary = read_text(folder_ / "results/summary.json");
        const std::size_t at = summary.find("\"UCS_MPa\"");
        ASSERT_NE(at, std::string::npos);
        files.push_back(summary.substr(at, 400));
        fs::remove_all(folder_ / "results");
    }
    const auto median = [](const std::string& text) { return std::stod(text.substr(text.find("\"median\"") + 9)); };
    EXPECT_GT(median(files[0]), 20.0);
    EXPECT_LT(
        median(files[0]),
        600.0);  // a regular honeycomb, pressed along a third of its edges, is much stronger than a rock of the same contacts
    EXPECT_NEAR(median(files[1]), median(files[0]),
                0.05 * median(files[0]));  // corners begin elsewhere where edges are equally long: other bits, the same rock to
                                           // the accuracy of 5 %
    EXPECT_NEAR(median(files[2]), median(files[0]), 0.05 * median(files[0]));
}

}  // namespace
}  // namespace feldspar
