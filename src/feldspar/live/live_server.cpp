#include "feldspar/live/live_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <httplib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <thread>

#include "feldspar/base/error.hpp"
#include "feldspar/live/live_page.hpp"
#include "feldspar/live/live_stream.hpp"

namespace feldspar {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr int kMostPages = 8;  // that look at once
constexpr auto kBetweenLooks =
    milliseconds(100);  // of the thread that asks tests; each test is asked less often (live_board.cpp)
constexpr auto kBetweenEvents = milliseconds(350);  // to a page
constexpr auto kStillThere = milliseconds(2000);    // without news, a page is told so
constexpr auto kTimeForLastPage = std::chrono::seconds(5);

std::string random_token() {
    std::array<unsigned char, 24> bytes{};
    if (getentropy(bytes.data(), bytes.size()) != 0)
        throw OutputError("the system gives no random numbers for the address of the live view");
    std::string token;
    for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
    return token;
}

bool is_loopback(const std::string& address) { return address == "localhost" || address == "::1" || address.starts_with("127."); }

bool is_in_digits(const std::string& address) {
    std::array<unsigned char, 16> bytes{};
    return inet_pton(AF_INET, address.c_str(), bytes.data()) == 1 || inet_pton(AF_INET6, address.c_str(), bytes.data()) == 1;
}

std::string machine_name() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) : std::string();
}

std::string in_url(const std::string& address) { return address.find(':') != std::string::npos ? "[" + address + "]" : address; }

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void refuse(httplib::Response& response, int status, const char* why) {
    response.status = status;
    response.set_content(std::string(why) + "\n", "text/plain");
}

}  // namespace

bool is_own_host(const std::string& host, const std::string& address, int port, const std::string& machine) {
    const std::string end = fmt::format(":{}", port);
    if (!host.ends_with(end)) return false;
    std::string name = host.substr(0, host.size() - end.size());
    if (name.starts_with('[') && name.ends_with(']')) name = name.substr(1, name.size() - 2);
    std::ranges::transform(name, name.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (name == address || name == "localhost" || name == "127.0.0.1" || name == "::1") return true;
    return !is_loopback(address) && (is_in_digits(name) || (!machine.empty() && name == machine));
}

bool equal_in_constant_time(const std::string& given, const std::string& secret) {
    unsigned differ = given.size() == secret.size() ? 0U : 1U;
    for (std::size_t i = 0; i < secret.size(); ++i) {
        const unsigned char other = i < given.size() ? static_cast<unsigned char>(given[i]) : 0U;
        differ |= static_cast<unsigned>(other ^ static_cast<unsigned char>(secret[i]));
    }
    return differ == 0U;
}

struct LiveServer::Inside {
    LiveBoard& board;
    LiveSettings settings;
    std::string token = random_token(), machine = machine_name();
    int port = 0;
    httplib::Server server;
    std::atomic<int> pages{0};       // that look
    std::atomic<int> last_pages{0};  // taken since the run is over
    std::atomic<bool> ends{false}, gave_up{false};
    std::jthread asking, listening;

    explicit Inside(LiveBoard& b, LiveSettings s) : board(b), settings(std::move(s)) {}

    // What every request must have. @return whether it goes on to a handler
    bool may_ask(const httplib::Request& request, httplib::Response& response) const {
        const std::string host = request.get_header_value("Host"), origin = request.get_header_value("Origin");
        if (request.get_header_value_count("Host") != 1 || !is_own_host(host, settings.address, port, machine))
            return refuse(response, 421, "not a name of this server"), false;
        const std::size_t end = request.path.find('/', 1);
        const std::string given =
            request.path.substr(std::min<std::size_t>(1, request.path.size()), end == std::string::npos ? end : end - 1);
        if (!equal_in_constant_time(given, token) || end == std::string::npos)
            return refuse(response, 403, "the address lacks the key that the program has printed"), false;
        if (!origin.empty() && origin != "http://" + host) return refuse(response, 403, "a page of another origin asks"), false;
        if (request.method != "GET" && request.method != "POST") return refuse(response, 405, "only GET and POST"), false;
        return true;
    }

    void send_events(httplib::Response& response) {
        if (++pages > kMostPages) {
            --pages;
            return refuse(response, 503, "too many pages look at this run");
        }
        const auto stream = std::make_shared<LiveStream>(board);
        const auto last = std::make_shared<Clock::time_point>();
        response.set_chunked_content_provider(
            "text/event-stream",
            [this, stream, last](std::size_t, httplib::DataSink& sink) {
                if (ends || stream->at_end()) return sink.done(), true;
                std::this_thread::sleep_until(*last + kBetweenEvents);
                const std::string news = stream->next(kStillThere);
                *last = Clock::now();
                const std::string event = news.empty() ? ": still there\n\n" : "data: " + news + "\n\n";
                return sink.write(event.data(), event.size());
            },
            [this, stream](bool) { --pages; });
    }

    void send_page(httplib::Response& response) {
        const std::filesystem::path file = board.report_file();
        const bool over = board.is_over();
        response.set_content(
            live_page(file.empty() ? "" : text_of(file), board.name(), over ? board.over_words() : "", board.words()),
            "text/html; charset=utf-8");
        if (over) ++last_pages;
    }

    void stop(const httplib::Request& request, httplib::Response& response) {
        if (request.body == "run") {
            board.end_run();
            return response.set_content("the " + board.words().whole + " ends\n", "text/plain");
        }
        std::size_t test = 0;
        const char* const last = request.body.data() + request.body.size();
        const auto [end, error] = std::from_chars(request.body.data(), last, test);
        if (error != std::errc{} || end != last)
            return refuse(response, 400, "the body is neither \"run\" nor the number of a test");
        if (!board.end_test(test)) return refuse(response, 409, "no such test runs");
        response.set_content("the " + board.words().one + " ends\n", "text/plain");
    }

    void listen() {
        server.new_task_queue = [] { return new httplib::ThreadPool(kMostPages + 4); };
        server.set_keep_alive_max_count(1);  // its end waits for no page that could still ask
        server.set_payload_max_length(1024);
        server.set_tcp_nodelay(true);
        server.set_socket_options([](socket_t socket) {  // the library's own let another program listen at the same port
            const int yes = 1;
            setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        server.set_default_headers({{"Cache-Control", "no-store"},
                                    {"Referrer-Policy", "no-referrer"},
                                    {"X-Content-Type-Options", "nosniff"},
                                    {"X-Frame-Options", "DENY"},
                                    {"Cross-Origin-Resource-Policy", "same-origin"},
                                    {"Cross-Origin-Opener-Policy", "same-origin"}});
        server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
            return may_ask(request, response) ? httplib::Server::HandlerResponse::Unhandled
                                              : httplib::Server::HandlerResponse::Handled;
        });
        const std::string at = "/" + token;
        server.Get(at + "/", [this](const httplib::Request&, httplib::Response& response) { send_page(response); });
        server.Get(at + "/events", [this](const httplib::Request&, httplib::Response& response) { send_events(response); });
        server.Get(at + "/report\\.html", [this](const httplib::Request&, httplib::Response& response) {
            const std::filesystem::path file = board.report_file();
            if (file.empty()) return refuse(response, 404, "there is no report yet");
            response.set_content(text_of(file), "text/html; charset=utf-8");
        });
        server.Post(at + "/stop",
                    [this](const httplib::Request& request, httplib::Response& response) { stop(request, response); });
        port = settings.port == 0                                     ? server.bind_to_any_port(settings.address)
               : server.bind_to_port(settings.address, settings.port) ? settings.port
                                                                      : -1;
        if (port <= 0)
            throw InputError(
                {{}, 0, 0, settings.port == 0 ? "--live-address" : "--live-port"},
                settings.port == 0 ? fmt::format("the live view cannot listen at '{}'", settings.address)
                                   : fmt::format("the live view cannot listen at '{}', port {}: another program may have it",
                                                 settings.address, settings.port),
                settings.port == 0 ? "an address of this machine, such as 127.0.0.1" : "another port, or 0 for any that is free");
        listening = std::jthread([this] {
            server.listen_after_bind();
            gave_up = true;
        });
        while (!server.is_running() && !gave_up) std::this_thread::sleep_for(milliseconds(1));
        asking = std::jthread([this] {
            while (!ends) {
                if (board.is_looked_at()) board.ask_tests();
                std::this_thread::sleep_for(kBetweenLooks);
            }
        });
    }

    void end() {
        const int waiting = pages;
        const Clock::time_point latest = Clock::now() + kTimeForLastPage;
        if (board.is_over())
            while (last_pages < waiting && Clock::now() < latest) std::this_thread::sleep_for(milliseconds(20));
        ends = true;
        server.stop();
    }
};

LiveServer::LiveServer(LiveBoard& board, const LiveSettings& settings) : inside_(std::make_unique<Inside>(board, settings)) {
    inside_->listen();
}

LiveServer::~LiveServer() { inside_->end(); }

std::string LiveServer::url() const {
    const std::string& address = inside_->settings.address;
    const bool any = address == "0.0.0.0" || address == "::";
    return fmt::format("http://{}:{}/{}/", in_url(any && !inside_->machine.empty() ? inside_->machine : address), inside_->port,
                       inside_->token);
}

}  // namespace feldspar
