// The live view of commands that make many runs, asked by real HTTP while the program runs.
#include <httplib.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <regex>
#include <stop_token>

#include "studies.hpp"

namespace feldspar::testing_program {
namespace {

using Json = nlohmann::json;

// A page that looks at a running program: it listens until the program ends, as a browser does.
class Page {
public:
    explicit Page(Program& program) {
        std::smatch found;
        std::string said;
        const std::regex address("live view: http://127\\.0\\.0\\.1:(\\d+)(/[0-9a-f]{48}/)");
        if (!program.wait_until([&] { return std::regex_search(said = program.err_so_far(), found, address); }))
            throw std::runtime_error("the program prints no address: " + said);
        port_ = std::stoi(found[1]);
        path_ = found[2];
        listener_ = std::jthread([this](const std::stop_token& over) {
            std::string text;
            client().Get(path_ + "events", [&](const char* data, std::size_t size) {
                text.append(data, size);
                for (std::size_t end; (end = text.find("\n\n")) != std::string::npos; text.erase(0, end + 2))
                    if (text.starts_with("data: ")) take(Json::parse(text.substr(6, end - 6)));
                return !over.stop_requested();
            });
        });
    }

    httplib::Result get(const std::string& what = "") const { return client().Get(path_ + what); }
    int post_stop(const std::string& body) const {
        const auto answer = client().Post(path_ + "stop", body, "text/plain");
        return answer ? answer->status : -1;
    }
    int port() const { return port_; }

    /// Until what was told meets the condition; false if it does not within a minute.
    bool wait_until(const std::function<bool(const Json& run, const std::map<int, Json>& tests)>& condition) {
        std::unique_lock lock(mutex_);
        return told_.wait_for(lock, std::chrono::minutes(1), [&] { return !run_.is_null() && condition(run_, tests_); });
    }
    /// What was told last of all.
    Json run() {
        const std::lock_guard lock(mutex_);
        return run_;
    }

private:
    void take(const Json& news) {
        const std::lock_guard lock(mutex_);
        run_ = news.at("run");
        for (const Json& test : news.at("tests")) tests_[test.at("n")] = test;
        told_.notify_all();
    }
    httplib::Client client() const {
        httplib::Client client("127.0.0.1", port_);
        client.set_read_timeout(20);
        return client;
    }
    int port_ = 0;
    std::string path_;
    std::mutex mutex_;
    std::condition_variable told_;
    Json run_;
    std::map<int, Json> tests_;  // by number, as last told
    std::jthread listener_;      // last: it ends before the rest goes away
};

bool is_running(const std::pair<const int, Json>& test) { return test.second.at("state") == "running"; }

// 48 runs of a tenth of a second each: time to end one of them, and then all.
const std::string three_frictions =
    "job = \"job.toml\"\nseeds = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]\n[[axis]]\nname = \"mu\"\nkey = "
    "\"material.contact.mu\"\n"
    "values = [0.2, 0.3, 0.4]\n";

TEST(LiveStudy, ShowsItsRunsEndsOneAndThenAllAndGoesOnToTheSameBits) {
    const TemporaryFolder seen, unseen;
    for (const TemporaryFolder* place : {&seen, &unseen}) {
        write_text(*place / "job.toml", small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[1]",
                                                  "kind = \"adaptive\"\naccuracy = \"0.5 %\"\n"));
        write_text(*place / "study.toml", three_frictions);
    }
    const std::vector<std::string> command{"study", "study.toml", "--threads", "2"};
    std::vector<std::string> live = command;
    live.push_back("--live");
    Program program(seen.path(), live);
    Page page(program);
    const auto html = page.get();
    ASSERT_TRUE(html);
    EXPECT_EQ(html->status, 200);
    EXPECT_NE(html->body.find("\"whole\":\"study\",\"one\":\"run\""), std::string::npos);
    EXPECT_EQ(httplib::Client("127.0.0.1", page.port()).Get("/")->status, 403) << "without the key nothing is told";

    std::string ended;                                           // by the user
    for (int tries = 0; tries < 20 && ended.empty(); ++tries) {  // a run may end by itself meanwhile
        int one = -1;
        ASSERT_TRUE(page.wait_until([&](const Json&, const std::map<int, Json>& tests) {
            const auto found = std::ranges::find_if(tests, is_running);
            if (found != tests.end()) one = found->first;
            return found != tests.end();
        }));
        if (page.post_stop(std::to_string(one)) != 200) continue;
        ASSERT_TRUE(page.wait_until([&](const Json&, const std::map<int, Json>& tests) {
            const Json& test = tests.at(one);
            if (test.at("state") == "failed") ended = test.at("words");
            return test.at("state") == "failed" || test.at("state") == "ended";
        }));
    }
    EXPECT_EQ(ended, "failed: ended by the user");
    EXPECT_EQ(page.run().at("tests"), 48);
    EXPECT_EQ(page.run().at("at_most"), false);
    EXPECT_GE(page.run().at("failed"), 1);
    EXPECT_EQ(page.post_stop("run"), 200);
    const Outcome outcome = program.finish();
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_NE(outcome.err.find("the same command goes on"), std::string::npos) << outcome.err;
    EXPECT_LT(finished(seen).size(), 48u);

    EXPECT_EQ(run_program(seen.path(), command).code, 0);  // the one that was ended is made, too
    EXPECT_EQ(run_program(unseen.path(), command).code, 0);
    EXPECT_EQ(finished(seen).size(), 48u);
    EXPECT_EQ(finished(seen), finished(unseen));
}

TEST(LiveStudy, ThePageOfAnEnvelopeBecomesItsResult) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    Program program(place.path(), {"envelope", "job.toml", "--seeds", "2", "--sigma3", "3 MPa", "--live", "--quiet"});
    Page page(program);
    EXPECT_TRUE(page.wait_until([](const Json& run, const auto&) { return run.at("tests") == 8; }))
        << "uniaxial, biaxial, tension, Brazilian on two packings";
    EXPECT_TRUE(page.wait_until([](const Json& run, const auto&) { return !run.at("over").is_null(); }));
    const auto html = page.get();  // as a page does that is told so
    ASSERT_TRUE(html);
    EXPECT_NE(html->body.find("Strength envelope of job"), std::string::npos);
    EXPECT_NE(html->body.find("8 runs have ended"), std::string::npos);
    const Outcome outcome = program.finish();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "results/job-envelope\n");
}

TEST(LiveCalibration, SaysHowManyRunsThereMayBe) {
    const TemporaryFolder place;
    write_text(place / "job.toml",
               small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[1]", "kind = \"adaptive\"\naccuracy = \"0.3 %\"\n"));
    write_text(place / "targets.toml",
               "job = \"job.toml\"\nbudget = 60\n[targets]\nUCS = \"100 MPa\"\n[[unknown]]\nkey = \"material.contact.tau\"\n");
    Program program(place.path(), {"calibrate", "targets.toml", "--live"});
    Page page(program);
    ASSERT_TRUE(page.wait_until([](const Json&, const auto& tests) { return std::ranges::any_of(tests, is_running); }))
        << program.err_so_far();
    EXPECT_EQ(page.run().at("tests"), 60);
    EXPECT_EQ(page.run().at("at_most"), true);
    EXPECT_EQ(page.post_stop("run"), 200);
    EXPECT_EQ(program.finish().code, 130);
}

TEST(LiveStudy, IsNotForRunsThatAreMadeElsewhere) {
    const TemporaryFolder place;
    write_text(place / "study.toml", three_frictions);
    const Outcome outcome = run_program(place.path(), {"study", "study.toml", "--on", "slurm", "--live"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find("--live"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace feldspar::testing_program
