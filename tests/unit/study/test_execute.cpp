// Running a study: every run once, failures recorded, interruptions taken up again.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "../../small_study.hpp"
#include "feldspar/live/live_stream.hpp"
#include "feldspar/study/execute.hpp"
#include "feldspar/study/point_results.hpp"
#include "feldspar/study/study_report.hpp"
#include "feldspar/study/study_table.hpp"

namespace feldspar {
namespace {

class ExecuteStudy : public ::testing::Test {
protected:
    Study read(const std::string& text) const {
        return parse_study("job = \"job.toml\"\ntests = [\"direct-tension\"]\n" + text, folder_ / "study.toml");
    }

    Execution run(const Study& study, Ledger& ledger, int threads = 1) {
        ExecuteControl control;
        control.threads = threads;
        control.keep = study.keep;
        control.stop = &stop_;
        control.retry_failed = retry_failed_;
        control.provenance = collect_provenance("test", threads);
        control.ended = [this](const feldspar::Run& run, const RunRecord&) { ended_.push_back(run.id); };
        control.live = live_;
        return execute(study.runs, ledger, control);
    }

    StudyFolder folder_;
    std::filesystem::path place_ = folder_ / "results";
    std::atomic<bool> stop_{false};
    std::vector<std::string> ended_;
    bool retry_failed_ = false;
    LiveRuns* live_ = nullptr;
};

constexpr const char* two_frictions = "[[axis]]\nname = \"mu\"\nkey = \"material.contact.mu\"\nvalues = [0.2, 0.5]\n";

TEST_F(ExecuteStudy, DoesEveryRunOnceAndLeavesItsFiles) {
    const Study study = read(two_frictions);
    Ledger ledger(place_, Ledger::Access::write);
    const Execution first = run(study, ledger);
    EXPECT_EQ(first.done, 4);
    EXPECT_EQ(first.failed + first.left + first.found_done, 0);
    for (const auto& one : study.runs) {
        EXPECT_TRUE(std::filesystem::exists(ledger.run_directory(one.id) / "run.json"));
        EXPECT_TRUE(std::filesystem::exists(ledger.run_directory(one.id) / "job.toml"));
        EXPECT_TRUE(std::filesystem::exists(ledger.run_directory(one.id) /
                                            ("history-direct-tension-s" + std::to_string(one.seed()) + ".csv")));
    }
    const Execution second = run(study, ledger);
    EXPECT_EQ(second.done, 0);
    EXPECT_EQ(second.found_done, 4);

    const auto points = point_results(study, ledger);
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(points[0].missing, 0);
    EXPECT_EQ(points[0].results.size(), 2u);
    EXPECT_EQ(points[1].results.size(), 2u);
    EXPECT_EQ(points[0].properties.values.at("DTS_Pa").seeds, (std::vector<std::uint64_t>{1, 2}));
    EXPECT_NE(points_csv(study, points).find("DTS_MPa,DTS_MPa_low"), std::string::npos);
    EXPECT_NE(runs_csv(study, ledger).find(study.runs[0].id), std::string::npos);
}

TEST_F(ExecuteStudy, TablesShowControlCharactersEscaped) {
    Study study = read(
        "title = \"two\\nlines\"\nseeds = [1]\n[[axis]]\nname = \"m\\u001bu\"\n[[axis.value]]\nlabel = \"a\\u001b[31m, "
        "\\\"b\\\"\"\n");
    Ledger ledger(place_, Ledger::Access::write);
    ledger.record(failed_record(study.runs[0], "a\rforce\nis not a number", Failure::numerical, collect_provenance("test", 1)));
    const auto points = point_results(study, ledger);
    const std::string of_points = points_csv(study, points), of_runs = runs_csv(study, ledger);
    for (const std::string& text : {of_points, of_runs}) {
        EXPECT_TRUE(text.starts_with("# two\\x0alines: ")) << text;
        EXPECT_NE(text.find("\nm\\x1bu,"), std::string::npos) << text;
        EXPECT_NE(text.find("\n\"a\\x1b[31m, \"\"b\"\"\","), std::string::npos) << text;
        EXPECT_EQ(text.find_first_of("\x1b\r"), std::string::npos) << text;
    }
    EXPECT_NE(of_runs.find(",\"a\\x0dforce\nis not a number\","), std::string::npos)
        << of_runs;  // a line end may stand between quotes
    EXPECT_NE(study_text(study, points).find("a\\x1b[31m"), std::string::npos);
    EXPECT_EQ(study_text(study, points).find('\x1b'), std::string::npos);
}

TEST(CsvCell, IsQuotedWhereItMustBe) {
    EXPECT_EQ(csv_cell("12.3 GPa"), "12.3 GPa");
    EXPECT_EQ(csv_cell("a, b"), "\"a, b\"");
    EXPECT_EQ(csv_cell("\"a\""), "\"\"\"a\"\"\"");
    EXPECT_EQ(csv_cell("a\nb"), "\"a\nb\"");
    EXPECT_EQ(csv_cell("a\x1b\a"), "a\\x1b\\x07");
    for (const std::string formula :
         {"=1+1", "=cmd|' /C calc'!A0", "+A1", "-A1", "-1+2", "-1/A1", "@SUM(A1)", "\t=1", "+", "-5 MPa+A1", "=HYPERLINK(1)"})
        EXPECT_EQ(csv_cell(formula), "'" + formula);  // a spreadsheet takes none of them for a formula
    for (const std::string plain : {"-5", "+10 %", "-5 MPa", "-1e-3 m/s", "-0.5 µm", "-5MPa", "a = b", "1-2"})
        EXPECT_EQ(csv_cell(plain), plain);
    EXPECT_EQ(csv_cell("=\"a\",b"), "\"'=\"\"a\"\",b\"");
}

TEST_F(ExecuteStudy, GivesTheSameBitsSideBySide) {
    const Study study = read(two_frictions);
    Ledger alone(folder_ / "alone", Ledger::Access::write), together(folder_ / "together", Ledger::Access::write);
    (void)run(study, alone, 1);
    (void)run(study, together, 3);
    for (const auto& one : study.runs)
        EXPECT_EQ(alone.find(one.id)->numbers.at("strength_Pa"), together.find(one.id)->numbers.at("strength_Pa"));
}

TEST_F(ExecuteStudy, PointsThatAreTheSameShareTheirRuns) {
    const Study study = read(
        "[[axis]]\nname = \"mu\"\n[[axis.value]]\nlabel = \"a\"\n[[axis.value]]\nlabel = \"b\"\nset = { material.contact.mu = "
        "0.40 }\n");
    Ledger ledger(place_, Ledger::Access::write);
    EXPECT_EQ(run(study, ledger).done, 2);  // Table 7 has mu = 0.4
    EXPECT_EQ(point_results(study, ledger)[1].missing, 0);
}

TEST_F(ExecuteStudy, AFailureIsRecordedAndDoesNotStopTheOthers) {
    const Study study = read("seeds = [1]\n[[axis]]\nname = \"mass\"\nkey = \"numerics.mass_factor\"\nvalues = [0.001, 2]\n");
    Ledger ledger(place_, Ledger::Access::write);
    const Execution execution = run(study, ledger);
    EXPECT_EQ(execution.failed, 1);
    EXPECT_EQ(execution.done, 1);
    const auto record = ledger.find(study.runs[0].id);
    ASSERT_TRUE(record);
    EXPECT_EQ(record->state, RunState::failed);
    EXPECT_NE(record->reason.find("mass_factor"), std::string::npos) << record->reason;
    EXPECT_EQ(point_results(study, ledger)[0].failed.size(), 1u);

    Ledger later(place_, Ledger::Access::write);
    ended_.clear();
    const Execution again = run(study, later);  // it would fail again
    EXPECT_EQ(again.found_failed, 1);
    EXPECT_EQ(again.found_done, 1);
    EXPECT_EQ(again.failed + again.done, 0);
    EXPECT_TRUE(ended_.empty());
    EXPECT_EQ(later.find(study.runs[0].id)->reason, record->reason);
    retry_failed_ = true;
    EXPECT_EQ(run(study, later).failed, 1);
    EXPECT_EQ(run(study, later).found_failed, 1);  // but not twice on one ledger
}

TEST_F(ExecuteStudy, WhatIsSettledIsCountedOnceForEveryRun) {
    const Study study = read(two_frictions);
    const Provenance here = collect_provenance("test", 1);
    Provenance other = here;
    other.commit += "-other";
    std::vector<RunRecord> records{failed_record(study.runs[0], "a force is not a number", Failure::numerical, here),
                                   failed_record(study.runs[1], "no memory", Failure::other, here),
                                   failed_record(study.runs[2], "a force is not a number", Failure::numerical, other),
                                   failed_record(study.runs[3], "", Failure::input, here)};
    records[3].state = RunState::done;
    const std::set<std::string> first{study.runs[0].id}, last{study.runs[3].id};
    EXPECT_EQ(settled_runs(records, &here).failed, first);
    EXPECT_EQ(settled_runs(records, &here).done, last);
    EXPECT_TRUE(settled_runs(records, nullptr).failed.empty());
    EXPECT_EQ(settled_runs(records, nullptr).done, last);

    {
        Ledger ledger(place_, Ledger::Access::write);
        for (const RunRecord& record : records) ledger.record(record);
    }
    Ledger ledger(place_, Ledger::Access::write);
    const Execution execution = run(study, ledger);
    EXPECT_EQ(execution.found_failed, 1);
    EXPECT_EQ(execution.found_done, 1);
    EXPECT_EQ(execution.done, 2);
}

TEST_F(ExecuteStudy, AFailureThatAnElementHasLeftIsTakenForWhatItIs) {
    const Study study = read("seeds = [1]\n");
    Ledger ledger(place_, Ledger::Access::write);
    const RunRecord left =
        failed_record(study.runs[0], "a force is not a number", Failure::numerical, collect_provenance("test", 1));
    std::filesystem::create_directories(ledger.run_directory(study.runs[0].id));
    folder_.write("results/runs/" + study.runs[0].id + "/run.json", to_json(left));
    EXPECT_EQ(run(study, ledger).found_failed, 1);
    EXPECT_EQ(ledger.find(study.runs[0].id)->reason, left.reason);
    Ledger later(place_, Ledger::Access::write);
    retry_failed_ = true;
    EXPECT_EQ(run(study, later).done, 1);
}

TEST_F(ExecuteStudy, AnInterruptedStudyGoesOn) {
    const Study study = read(two_frictions);
    Ledger ledger(place_, Ledger::Access::write);
    ExecuteControl control;
    control.stop = &stop_;
    control.keep = Keep::numbers;
    control.ended = [&](const feldspar::Run&, const RunRecord&) { stop_ = true; };
    const Execution first = execute(study.runs, ledger, control);
    EXPECT_GE(first.done, 1);
    EXPECT_GE(first.left, 2);  // the second run had begun
    EXPECT_EQ(first.done + first.left, 4);
    stop_ = false;
    const Execution second = run(study, ledger);
    EXPECT_EQ(second.found_done, first.done);
    EXPECT_EQ(second.done, first.left);
    EXPECT_EQ(second.left, 0);
}

TEST_F(ExecuteStudy, ARunThatEndedUnrecordedIsFoundAndHalfOfOneIsDoneAgain) {
    const Study study = read("seeds = [1]\n" + std::string(two_frictions));
    Ledger made(place_, Ledger::Access::write);
    (void)run(study, made);
    std::filesystem::remove(place_ / "ledger.sqlite");
    std::filesystem::remove(place_ / "ledger.sqlite-wal");
    std::filesystem::remove(place_ / "ledger.sqlite-shm");
    std::filesystem::remove(made.run_directory(study.runs[1].id) / "run.json");
    Ledger ledger(place_, Ledger::Access::write);
    const Execution again = run(study, ledger);
    EXPECT_EQ(again.found_done, 1);
    EXPECT_EQ(again.done, 1);
    EXPECT_EQ(ledger.find(study.runs[0].id)->state, RunState::done);
}

// A board that shows the runs of a study.
struct ShownRuns {
    std::atomic<bool> stop{false};
    LiveBoard board{"study", stop, {.whole = "study", .one = "run", .keeps_ended = false}};
    LiveRuns runs{board, [](const Run& run) { return "seed " + std::to_string(run.seed()); },
                  [](const RunRecord& record) { return record.state == RunState::failed ? record.reason : "is done"; }};
};

TEST_F(ExecuteStudy, IsShownWhileItRunsAndChangesNoBit) {
    const Study study = read("keep = \"numbers\"\n");
    std::map<std::string, double> strengths;
    {
        Ledger ledger(folder_ / "unseen", Ledger::Access::write);
        (void)run(study, ledger);
        for (const auto& one : study.runs) strengths[one.id] = ledger.find(one.id)->numbers.at("strength_Pa");
    }
    ShownRuns shown;
    live_ = &shown.runs;
    LiveStream page(shown.board);
    Ledger ledger(place_, Ledger::Access::write);
    std::atomic<bool> over{false};
    std::jthread asker([&] {
        while (!over) shown.board.ask_tests();
    });
    EXPECT_EQ(run(study, ledger).done, 2);
    over = true;
    for (const auto& one : study.runs) EXPECT_EQ(ledger.find(one.id)->numbers.at("strength_Pa"), strengths.at(one.id));
    const auto news = nlohmann::json::parse(page.next(std::chrono::milliseconds(0)));
    EXPECT_EQ(news["run"]["tests"], 2);
    EXPECT_EQ(news["run"]["ended"], 2);
    EXPECT_EQ(news["tests"][1]["words"], "is done");
    EXPECT_EQ(news["tests"][1]["label"], "seed 2");
    EXPECT_GT(shown.board.cost(), 0.0) << "nobody has looked";

    ShownRuns again;  // a later call shows what was done before
    live_ = &again.runs;
    LiveStream later(again.board);
    EXPECT_EQ(run(study, ledger).found_done, 2);
    EXPECT_EQ(nlohmann::json::parse(later.next(std::chrono::milliseconds(0)))["run"]["ended"], 2);
}

// What the page of a study holds of its points.
nlohmann::json points_of(const std::filesystem::path& page) {
    std::ifstream in(page, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}}, mark = "id=\"data\">";
    const std::size_t begin = text.find(mark) + mark.size();
    return nlohmann::json::parse(text.substr(begin, text.find("</script>", begin) - begin)).at("points");
}

TEST_F(ExecuteStudy, ItsPageGrowsWhileItRuns) {
    Study study = read(std::string("keep = \"numbers\"\n") + two_frictions);
    study.results = place_;
    Ledger ledger(place_, Ledger::Access::write);
    std::atomic<bool> stop{false};
    LiveBoard board("study", stop);
    GrowingPage page(study, ledger, board, std::chrono::milliseconds(0));
    EXPECT_EQ(board.report_file(), study_page(study));
    const nlohmann::json before = points_of(study_page(study));
    ASSERT_EQ(before.size(), 2u) << "all points are there before the first run";
    EXPECT_EQ(before[1]["missing"], 2);

    LiveRuns runs(
        board, [](const feldspar::Run&) { return "run"; }, [](const RunRecord&) { return "is done"; }, &page);
    live_ = &runs;
    EXPECT_EQ(run(study, ledger).done, 4);
    // pages are written at most in a fiftieth of the time, so the last runs may not be on it yet
    nlohmann::json after = points_of(study_page(study));
    const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (after[1]["done"] != 2 && std::chrono::steady_clock::now() < latest) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        page.renew_if_due();
        after = points_of(study_page(study));
    }
    EXPECT_EQ(after[0]["done"], 2);
    EXPECT_EQ(after[1]["done"], 2);
    EXPECT_EQ(after[1]["missing"], 0);
    EXPECT_TRUE(after[1]["cells"][0]["mean"].is_number());
    LiveStream looks(board);
    EXPECT_GE(nlohmann::json::parse(looks.next(std::chrono::milliseconds(0)))["run"]["reports"], 2);
}

TEST_F(ExecuteStudy, AStudyGoesOnWhereItsPageCannotBeWritten) {
    Study study = read("keep = \"numbers\"\nseeds = [1]\n");
    study.results = place_;
    std::filesystem::create_directories(study_page(study));  // a directory stands in its place
    Ledger ledger(place_, Ledger::Access::write);
    std::atomic<bool> stop{false};
    LiveBoard board("study", stop);
    GrowingPage page(study, ledger, board, std::chrono::milliseconds(0));
    EXPECT_TRUE(board.report_file().empty());
    LiveRuns runs(
        board, [](const feldspar::Run&) { return "run"; }, [](const RunRecord&) { return "is done"; }, &page);
    live_ = &runs;
    EXPECT_EQ(run(study, ledger).done, 1);
}

TEST_F(ExecuteStudy, ARunThatTheUserEndsHasNoResultAndIsMadeAgain) {
    // one that would take long: its end is the user's
    const Study study = read("keep = \"numbers\"\nseeds = [1]\n[set]\nnumerics.accuracy = \"0.1 %\"\n");
    ShownRuns shown;
    live_ = &shown.runs;
    Ledger ledger(place_, Ledger::Access::write);
    std::jthread user([&] {
        while (!shown.board.end_test(0)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
    const Execution first = run(study, ledger);
    EXPECT_EQ(first.failed, 1);
    const RunRecord record = *ledger.find(study.runs.front().id);
    EXPECT_EQ(record.state, RunState::failed);
    EXPECT_EQ(record.reason, "ended by the user");
    EXPECT_FALSE(std::filesystem::exists(ledger.run_directory(record.id) / "run.json"));
    live_ = nullptr;
    const Execution second = run(study, ledger);
    EXPECT_EQ(second.found_failed, 0) << "it did not fail for good";
    EXPECT_EQ(second.done, 1);
}

}  // namespace
}  // namespace feldspar
