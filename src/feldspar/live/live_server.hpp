// Serves the live view of a run to browsers on this machine, or on others if that is asked for.
#pragma once

#include <memory>
#include <string>

#include "feldspar/live/live_board.hpp"

namespace feldspar {

struct LiveSettings {
    std::string address = "127.0.0.1";  ///< to listen at; another than a loopback address lets other machines ask, too
    int port = 0;                       ///< 0: any that is free
};

/// Listens from its construction to its end, on threads of its own. Its address holds a random token, without which nothing is
/// told; a request for another host than this one, as from a page that has changed where its name leads, is refused. Nothing is
/// shared with pages of other origins.
///
/// Beneath the address: GET the page; GET events (server-sent events, one LiveStream a page); GET report.html, as it is on the
/// disk; POST stop with the body "run" or the number of a test.
class LiveServer {
public:
    /// @param board  outlives it  @throws InputError if it cannot listen there
    LiveServer(LiveBoard& board, const LiveSettings& settings);
    /// Lets open pages take the report of a run that is over, for a few seconds at most, and ends.
    ~LiveServer();
    LiveServer(const LiveServer&) = delete;
    LiveServer& operator=(const LiveServer&) = delete;

    /// "http://127.0.0.1:40123/<token>/".
    std::string url() const;

private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
};

/// Whether a Host header names this server, which listens at `address` and `port`: its address, localhost, or, if others may ask,
/// any address in digits and the name of this machine. Another name may be that of a page that leads its own name here.
bool is_own_host(const std::string& host, const std::string& address, int port, const std::string& machine);

/// Whether both are equal, in a time that does not tell where they differ.
bool equal_in_constant_time(const std::string& given, const std::string& secret);

}  // namespace feldspar
