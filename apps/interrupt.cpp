#include "interrupt.hpp"

#include <array>
#include <csignal>

namespace feldspar {
namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

std::atomic<unsigned> states_wanted{0};
static_assert(std::atomic<unsigned>::is_always_lock_free);

extern "C" void on_signal(int) { stop.store(true); }
extern "C" void on_request(int) { states_wanted.fetch_add(1); }

}  // namespace

void install_signal_handlers() {
    for (int signal_number : std::array{SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction before {};
        sigaction(signal_number, nullptr, &before);
        if (before.sa_handler == SIG_IGN && signal_number == SIGHUP) continue;
        struct sigaction action {};
        action.sa_handler = on_signal;
        sigemptyset(&action.sa_mask);
        action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);  // the second time: the system's way
        sigaction(signal_number, &action, nullptr);
    }
    struct sigaction request {};
    request.sa_handler = on_request;
    sigemptyset(&request.sa_mask);
    request.sa_flags = SA_RESTART;
    sigaction(SIGUSR1, &request, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

std::atomic<bool>& stop_requested() { return stop; }

CheckpointSettings& checkpoint_settings() {
    static CheckpointSettings settings{.wanted = &states_wanted};
    return settings;
}

}  // namespace feldspar
