#include "live_view.hpp"

#include <utility>

#include "interrupt.hpp"
#include "say.hpp"

namespace feldspar {

LiveView::LiveView(const LiveOptions& options, const std::string& name, LiveWords words) {
    if (!options.on) return;
    board_.emplace(name, stop_requested(), std::move(words));
    LiveSettings settings;
    if (options.address) settings.address = *options.address;
    if (options.port) settings.port = *options.port;
    server_.emplace(*board_, settings);
    say(stderr, "live view: {}\n", server_->url());
}

void LiveView::busy(const std::string& what) {
    if (board_) board_->busy(what);
}

void LiveView::over(const std::string& words) {
    if (!board_) return;
    board_->over(words);
    server_.reset();  // when the pages have it
}

}  // namespace feldspar
