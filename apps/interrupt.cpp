#include "interrupt.hpp"

#include <array>
#include <csignal>

namespace feldspar {
namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

extern "C" void on_signal(int) { stop.store(true); }

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
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

std::atomic<bool>& stop_requested() { return stop; }

}  // namespace feldspar
