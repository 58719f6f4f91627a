// The server of the live view: who gets an answer, what the answers say, and how it ends. Every request goes through a real
// socket on this machine.
#include <gtest/gtest.h>
#include <httplib.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "../../temporary_folder.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/live/live_server.hpp"

namespace feldspar {
namespace {

class LiveServerTest : public ::testing::Test {
protected:
    LiveServerTest() {
        board_.planned({{"brazilian, seed 1", "brazilian", "Tensile stress", "Approach"}});
        server_.emplace(board_, LiveSettings{});
        const std::string url = server_->url();
        const std::size_t port_at = url.find(':', 7) + 1, path_at = url.find('/', port_at);
        port_ = std::stoi(url.substr(port_at, path_at - port_at));
        path_ = url.substr(path_at);
    }
    httplib::Client client() const {
        httplib::Client client("127.0.0.1", port_);
        client.set_read_timeout(10);
        return client;
    }
    int status(const std::string& path, const httplib::Headers& headers = {}) const {
        const auto answer = client().Get(path, headers);
        return answer ? answer->status : -1;
    }
    // The first event of a page's stream, as JSON.
    nlohmann::json first_event() const {
        std::string text;
        client().Get(path_ + "events", [&](const char* data, std::size_t size) {
            text.append(data, size);
            return text.find("\n\n") == std::string::npos;
        });
        return nlohmann::json::parse(text.substr(6));
    }

    std::atomic<bool> stop_{false};
    LiveBoard board_{"disc", stop_};
    std::optional<LiveServer> server_;
    int port_ = 0;
    std::string path_;  // "/<token>/"
};

TEST_F(LiveServerTest, ShowsThePageAtItsAddressAlone) {
    const auto page = client().Get(path_);
    ASSERT_TRUE(page);
    EXPECT_EQ(page->status, 200);
    EXPECT_NE(page->body.find("disc"), std::string::npos);
    EXPECT_EQ(page->get_header_value("Cache-Control"), "no-store");
    EXPECT_EQ(page->get_header_value("Referrer-Policy"), "no-referrer");
    EXPECT_EQ(page->get_header_value("X-Frame-Options"), "DENY");
    EXPECT_FALSE(page->has_header("Access-Control-Allow-Origin"));
    std::string wrong = path_;
    wrong[wrong.size() - 2] = wrong[wrong.size() - 2] == '0' ? '1' : '0';
    for (const std::string& path :
         {std::string("/"), wrong, wrong + "events", path_.substr(0, path_.size() - 2) + "/", path_.substr(0, path_.size() - 1),
          std::string("//") + path_, std::string("/events"), path_ + "../x"})
        EXPECT_GE(status(path), 400) << path;
    EXPECT_EQ(status(wrong), 403);
    EXPECT_EQ(status(path_ + "nothing"), 404);
    EXPECT_EQ(status(path_ + "report.html"), 404) << "there is none yet";
}

TEST_F(LiveServerTest, RefusesOtherHostsAndOrigins) {
    EXPECT_EQ(status(path_, {{"Host", "rebound.example:" + std::to_string(port_)}}), 421);
    EXPECT_EQ(status(path_, {{"Host", "127.0.0.1"}}), 421) << "another port";
    EXPECT_EQ(status(path_, {{"Host", "localhost:" + std::to_string(port_)}}), 200);
    EXPECT_EQ(status(path_, {{"Origin", "http://elsewhere.example"}}), 403);
    EXPECT_EQ(status(path_, {{"Origin", "http://127.0.0.1:" + std::to_string(port_)}}), 200);
    auto asker = client();
    EXPECT_EQ(asker.Options(path_)->status, 405) << "no page of another origin is told that it may ask";
    EXPECT_EQ(asker.Post("/stop", "run", "text/plain")->status, 403);
    EXPECT_EQ(asker.Post(path_ + "stop", {{"Origin", "http://elsewhere.example"}}, "run", "text/plain")->status, 403);
    EXPECT_EQ(status(path_ + "stop"), 404) << "a link ends nothing";
    EXPECT_FALSE(stop_);
}

TEST(LiveHost, IsAnAddressOrANameOfThisMachine) {
    EXPECT_TRUE(is_own_host("127.0.0.1:80", "127.0.0.1", 80, "rock"));
    EXPECT_TRUE(is_own_host("LOCALHOST:80", "127.0.0.1", 80, "rock"));
    EXPECT_TRUE(is_own_host("[::1]:80", "::1", 80, "rock"));
    EXPECT_FALSE(is_own_host("127.0.0.1:81", "127.0.0.1", 80, "rock"));
    EXPECT_FALSE(is_own_host("rock:80", "127.0.0.1", 80, "rock")) << "it listens to this machine alone";
    EXPECT_FALSE(is_own_host("10.0.0.7:80", "127.0.0.1", 80, "rock"));
    EXPECT_FALSE(is_own_host("", "127.0.0.1", 80, ""));
    EXPECT_FALSE(is_own_host(":80", "0.0.0.0", 80, ""));
    EXPECT_TRUE(is_own_host("10.0.0.7:80", "0.0.0.0", 80, "rock"));
    EXPECT_TRUE(is_own_host("rock:80", "0.0.0.0", 80, "rock"));
    EXPECT_FALSE(is_own_host("rebound.example:80", "0.0.0.0", 80, "rock"));
}

TEST(LiveToken, IsComparedAsAWhole) {
    EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
    for (const char* other : {"", "ab", "abd", "abcd", "xbc"}) EXPECT_FALSE(equal_in_constant_time(other, "abc")) << other;
}

TEST_F(LiveServerTest, EveryServerHasATokenOfItsOwn) {
    const LiveServer another(board_, LiveSettings{});
    EXPECT_EQ(path_.size(), 50u);  // 24 random bytes
    EXPECT_EQ(another.url().find(path_), std::string::npos);
}

TEST_F(LiveServerTest, SendsEventsAndEndsWhatThePageAsksFor) {
    EXPECT_EQ(first_event()["run"]["tests"], 1);
    auto asker = client();
    EXPECT_EQ(asker.Post(path_ + "stop", "0", "text/plain")->status, 409) << "it does not run yet";
    const TestWatch& watch = board_.begins(0, nullptr);
    for (const char* body : {"", "-1", "0x", "1e0", "everything"})
        EXPECT_EQ(asker.Post(path_ + "stop", body, "text/plain")->status, 400) << body;
    EXPECT_EQ(asker.Post(path_ + "stop", std::string(5000, '0'), "text/plain")->status, 413);
    EXPECT_FALSE(watch.ended());
    EXPECT_EQ(asker.Post(path_ + "stop", "0", "text/plain")->status, 200);
    EXPECT_TRUE(watch.ended());
    EXPECT_FALSE(stop_);
    EXPECT_EQ(asker.Post(path_ + "stop", "run", "text/plain")->status, 200);
    EXPECT_TRUE(stop_);
}

TEST_F(LiveServerTest, ThePageBecomesTheReportWhenTheRunIsOver) {
    const TemporaryFolder folder;
    std::ofstream(folder / "report.html") << "<html><meta content=\"default-src 'none';\"><body>the whole report</body></html>";
    std::string heard;
    std::future<void> page = std::async(std::launch::async, [&] {
        client().Get(path_ + "events", [&](const char* data, std::size_t size) { return heard.append(data, size), true; });
        EXPECT_NE(client().Get(path_)->body.find("the whole report"), std::string::npos);
    });
    while (!board_.is_looked_at()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    board_.report(folder / "report.html");
    EXPECT_EQ(client().Get(path_ + "report.html")->body,
              "<html><meta content=\"default-src 'none';\"><body>the whole report</body></html>");
    board_.over("all tests have ended");
    server_.reset();  // waits until the page has it
    page.get();
    EXPECT_NE(heard.find("all tests have ended"), std::string::npos);
}

TEST_F(LiveServerTest, APortThatIsTakenIsAMistakeOfTheInput) {
    try {
        const LiveServer second(board_, {"127.0.0.1", port_});
        FAIL() << "two servers at one port";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(std::to_string(port_)), std::string::npos);
    }
    EXPECT_THROW(LiveServer(board_, {"203.0.113.7", 0}), InputError) << "not an address of this machine";
}

}  // namespace
}  // namespace feldspar
