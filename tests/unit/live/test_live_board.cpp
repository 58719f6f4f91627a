// What a run leaves on the board, and what of it a page is sent. Tests that run are played by records made here; a real one is
// looked at in tests/unit/study/test_run_job.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "feldspar/live/live_board.hpp"
#include "feldspar/live/live_page.hpp"
#include "feldspar/live/live_stream.hpp"

namespace feldspar {
namespace {

using Json = nlohmann::json;
using std::chrono::milliseconds;

// A record of so many rows and cracks whose numbers tell the row.
TestResult record(int rows, int cracks = 0) {
    TestResult result;
    for (int i = 0; i < rows; ++i) {
        HistoryRow row;
        row.axial_strain = 1e-3 * i;
        row.axial_stress_Pa = 1e6 * i;
        row.cracks_tensile = i / 10;
        result.history.push_back(row);
    }
    for (int i = 0; i < cracks; ++i) {
        Crack crack;
        crack.from = {0.001 * i, 0.002};
        crack.grain_b = i;
        crack.mode = CrackMode::shear;
        result.cracks.push_back(crack);
    }
    return result;
}

class Record final : public TestSight {
public:
    explicit Record(const TestResult& result) : result_(result) {}
    const TestResult& so_far() const override { return result_; }
    std::vector<Vec2> displacements() const override {
        return std::vector<Vec2>(result_.specimen->mesh.nodes.size(), Vec2{1e-3, -2e-3});
    }

private:
    const TestResult& result_;
};

class LiveBoardTest : public ::testing::Test {
protected:
    LiveBoardTest() {
        board_.planned({{"uniaxial-compression, seed 1", "uniaxial-compression", "Axial stress", "Axial strain"},
                        {"uniaxial-compression, seed 2", "uniaxial-compression", "Axial stress", "Axial strain"}});
    }
    void see(TestWatch& watch, const TestResult& so_far) { watch.see(Record(so_far)); }
    // A test's result is one object that grows: another one would be another test.
    void see(TestWatch& watch, TestResult&& so_far) {
        growing_ = std::move(so_far);
        watch.see(Record(growing_));
    }
    Json news(LiveStream& stream) {
        const std::string text = stream.next(milliseconds(0));
        return text.empty() ? Json() : Json::parse(text);
    }

    TestResult growing_;
    std::atomic<bool> stop_{false};
    LiveBoard board_{"granite", stop_};
};

TEST_F(LiveBoardTest, TheFirstNewsHoldEverythingAndTheNextOnlyWhatIsNew) {
    TestWatch& watch = board_.begins(0, nullptr);
    see(watch, record(50, 3));
    LiveStream page(board_);
    const Json first = news(page);
    EXPECT_EQ(first["run"]["name"], "granite");
    EXPECT_EQ(first["run"]["tests"], 2);
    EXPECT_EQ(first["run"]["running"], 1);
    EXPECT_TRUE(first["run"]["over"].is_null());
    ASSERT_EQ(first["tests"].size(), 1u);
    const Json& test = first["tests"][0];
    EXPECT_EQ(test["n"], 0);
    EXPECT_EQ(test["state"], "running");
    EXPECT_EQ(test["axes"]["stress"], "Axial stress");
    EXPECT_EQ(test["curve"]["from"], 0);
    EXPECT_EQ(test["curve"]["stress"].size(), 50u);
    EXPECT_EQ(test["curve"]["stress"][49], 49);  // MPa
    EXPECT_EQ(test["curve"]["strain"][49], 49);  // 10^-3
    EXPECT_EQ(test["curve"]["tensile"][49], 4);
    EXPECT_EQ(test["cracks"]["x0"], Json({0, 1, 2}));  // mm
    EXPECT_EQ(test["cracks"]["mode"], Json({1, 1, 1}));
    EXPECT_EQ(test["cracks"]["b"], Json({0, 1, 2}));
    EXPECT_TRUE(news(page).is_null());

    see(watch, record(52, 4));
    const Json next = news(page);
    EXPECT_EQ(next["tests"][0]["curve"]["from"], 50);
    EXPECT_EQ(next["tests"][0]["curve"]["stress"], Json({50, 51}));
    EXPECT_EQ(next["tests"][0]["cracks"]["from"], 3);
    EXPECT_EQ(next["tests"][0]["cracks"]["x0"], Json({3}));
    EXPECT_FALSE(next["tests"][0].contains("axes"));

    LiveStream another(board_);
    EXPECT_EQ(news(another)["tests"][0]["curve"]["stress"].size(), 52u);
}

TEST_F(LiveBoardTest, APassageThatIsTakenBackIsForgottenByThePageToo) {
    TestWatch& watch = board_.begins(0, nullptr);
    LiveStream page(board_);
    see(watch, record(50, 5));
    (void)news(page);
    TestResult again = record(60, 2);  // longer by now, but of another passage
    again.passages = 2;
    see(watch, again);
    const Json test = news(page)["tests"][0];
    EXPECT_EQ(test["curve"]["from"], 0);
    EXPECT_EQ(test["curve"]["stress"].size(), 60u);
    EXPECT_EQ(test["cracks"]["from"], 0);
    EXPECT_EQ(test["cracks"]["x0"].size(), 2u);
}

TEST_F(LiveBoardTest, GrainsAreSentOnceAndTheirDisplacementsAgainAndAgain) {
    auto specimen = std::make_shared<Specimen>();
    specimen->mesh.nodes = {{0, 0}, {0.01, 0}, {0, 0.02}, {0.003, 0.003}};  // a grain of three corners with a node inside
    specimen->mesh.node_begin = {0, 4};
    specimen->mesh.vertex_count = {3};
    TestWatch& watch = board_.begins(0, specimen);
    LiveStream page(board_);
    TestResult result = record(3);
    result.specimen = specimen;
    see(watch, result);
    const Json test = news(page)["tests"][0];
    EXPECT_EQ(test["outline"]["height"], 20.0);                            // mm
    EXPECT_EQ(test["outline"]["begin"], "AAAAAAMAAAA=");                   // 0, 3
    EXPECT_NEAR(test["frame"]["scale"].get<double>() * 32767, 2.0, 1e-9);  // mm
    EXPECT_EQ(test["frame"]["steps"].get<std::string>().size(), 16u);      // three corners of two int16
    LiveStream another(board_);
    EXPECT_TRUE(news(another)["tests"][0].contains("outline"));
    see(watch, result);
    EXPECT_FALSE(news(page)["tests"][0].contains("outline"));
}

TEST_F(LiveBoardTest, ALongRecordIsThinnedAndKeepsItsEnds) {
    TestWatch& watch = board_.begins(0, nullptr);
    LiveStream page(board_);
    std::size_t most = 0;
    for (int rows = 20'000; rows <= 200'000; rows += 20'000) {
        TestResult result;
        result.history.resize(static_cast<std::size_t>(rows));
        result.history.back().axial_stress_Pa = 1e6 * rows;
        for (int looks = 0; looks < 20; ++looks) see(watch, result);
        const Json curve = news(page)["tests"][0]["curve"];
        EXPECT_EQ(curve["stress"].back(), rows);
        most = std::max(most, curve["from"].get<std::size_t>() + curve["stress"].size());
    }
    EXPECT_LT(most, 3000u);
}

TEST_F(LiveBoardTest, TestsAreAskedOnlyWhileTheyRunAndNotTooOften) {
    board_.ask_tests();
    TestWatch& watch = board_.begins(0, nullptr);
    EXPECT_FALSE(watch.due());
    board_.ask_tests();
    EXPECT_TRUE(watch.due());
    see(watch, record(10));
    EXPECT_FALSE(watch.due());
    board_.ask_tests();
    EXPECT_FALSE(watch.due()) << "a look a moment ago is enough";
    EXPECT_FALSE(board_.is_looked_at());
    {
        const LiveStream page(board_);
        EXPECT_TRUE(board_.is_looked_at());
    }
    EXPECT_FALSE(board_.is_looked_at());
}

TEST_F(LiveBoardTest, TheUserEndsATestThatRunsOrTheWholeRun) {
    EXPECT_FALSE(board_.end_test(0)) << "it does not run yet";
    EXPECT_FALSE(board_.end_test(7));
    TestWatch& watch = board_.begins(0, nullptr);
    EXPECT_FALSE(watch.ended());
    EXPECT_TRUE(board_.end_test(0));
    EXPECT_TRUE(watch.ended());
    EXPECT_FALSE(stop_);
    board_.ended(0, {LiveState::ended, "49 MPa, ended by the user"});
    EXPECT_FALSE(board_.end_test(0));
    board_.end_run();
    EXPECT_TRUE(stop_);
    LiveStream page(board_);
    const Json all = news(page);
    EXPECT_EQ(all["run"]["ending"], true);
    EXPECT_EQ(all["run"]["ended"], 1);
    EXPECT_EQ(all["tests"][0]["words"], "49 MPa, ended by the user");
    EXPECT_FALSE(page.at_end());
    board_.over("all tests have ended");
    EXPECT_EQ(news(page)["run"]["over"], "all tests have ended");
    EXPECT_TRUE(page.at_end());
}

TEST_F(LiveBoardTest, WhatWaitsIsExpectedToTakeAsLongAsItsLike) {
    LiveStream page(board_);
    EXPECT_TRUE(news(page)["run"]["seconds_left"].is_null()) << "nothing is known yet";
    (void)board_.begins(0, nullptr);
    TestProgress progress;
    progress.seconds_left = 30.0;
    board_.progress(0, progress);
    const double left = news(page)["run"]["seconds_left"];
    EXPECT_NEAR(left, 60.0, 1.0) << "one runs and one like it waits";  // the seconds that this test has taken so far
}

TEST_F(LiveBoardTest, NobodyWaitsForNewsThatAreThere) {
    LiveStream page(board_);
    EXPECT_FALSE(page.next(milliseconds(0)).empty());
    EXPECT_TRUE(page.next(milliseconds(1)).empty());
    board_.busy("making packings");
    EXPECT_EQ(Json::parse(page.next(std::chrono::hours(1)))["run"]["busy"], "making packings");
}

TEST(LivePage, IsTheReportWithWhatGoesOnAndMayAskOnlyItsOwnServer) {
    const std::string report =
        "<head><meta content=\"default-src 'none'; img-src data:\"></head><body><main id=\"page\"></main></body></html>";
    const std::string page = live_page(report, "a <name>", "");
    EXPECT_NE(page.find("default-src 'none'; connect-src 'self'; img-src data:"), std::string::npos);
    EXPECT_NE(page.find("<main id=\"page\"></main>"), std::string::npos);
    EXPECT_NE(page.find("\"name\":\"a \\u003cname>\""), std::string::npos) << "no name ends the script";
    EXPECT_NE(page.find("EventSource"), std::string::npos);
    const std::string empty = live_page("", "granite", "");
    EXPECT_NE(empty.find("<title>granite</title>"), std::string::npos);
    EXPECT_NE(empty.find("connect-src 'self'"), std::string::npos);
    EXPECT_THROW((void)live_page("<p>another page</p>", "granite", ""), std::exception);
}

TEST(LiveBoardOfAStudy, LearnsOfItsRunsOnTheWay) {
    std::atomic<bool> stop{false};
    LiveBoard board("targets", stop, {.whole = "calibration", .one = "run", .keeps_ended = false});
    board.expects(40);
    LiveStream page(board);
    Json run = Json::parse(page.next(milliseconds(0)))["run"];
    EXPECT_EQ(run["tests"], 40);
    EXPECT_EQ(run["at_most"], true);
    const std::size_t first = board.adds({"UCS, seed 1", "UCS", "Axial stress", "Axial strain"});
    const std::size_t second = board.adds({"UCS, seed 2", "UCS", "Axial stress", "Axial strain"});
    EXPECT_EQ(first, 0u);
    EXPECT_EQ(second, 1u);
    board.ended(first, {LiveState::ended, "114 MPa, grade B", 3.0});  // of an earlier call
    const Json news = Json::parse(page.next(milliseconds(0)));
    EXPECT_EQ(news["run"]["ended"], 1);
    EXPECT_EQ(news["run"]["tests"], 40);
    EXPECT_NEAR(news["run"]["seconds_left"].get<double>(), 39 * 3.0, 1e-6) << "39 like the one that is known";
    EXPECT_EQ(news["tests"][0]["words"], "114 MPa, grade B");
    const std::string text = live_page("", "targets", "", board.words());
    EXPECT_NE(text.find("\"whole\":\"calibration\",\"one\":\"run\",\"keeps_ended\":false"), std::string::npos);
}

TEST_F(LiveBoardTest, AnInterruptedTestWaitsAgain) {
    TestWatch& watch = board_.begins(0, nullptr);
    LiveStream page(board_);
    see(watch, record(50, 3));
    (void)news(page);
    board_.waits(0);
    const Json all = news(page);
    EXPECT_EQ(all["run"]["running"], 0);
    EXPECT_EQ(all["tests"][0]["state"], "waiting");
    EXPECT_FALSE(board_.end_test(0)) << "it does not run";
    TestWatch& again = board_.begins(0, nullptr);
    see(again, record(5));
    EXPECT_EQ(news(page)["tests"][0]["curve"]["stress"].size(), 5u);
}

}  // namespace
}  // namespace feldspar
