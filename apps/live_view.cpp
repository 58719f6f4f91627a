#include "live_view.hpp"

#include <fmt/format.h>

#include "feldspar/base/counted.hpp"
#include "interrupt.hpp"
#include "say.hpp"

namespace feldspar {

LiveView::LiveView(const LiveOptions& options, const std::string& name) {
    if (!options.on) return;
    board_.emplace(name, stop_requested());
    LiveSettings settings;
    if (options.address) settings.address = *options.address;
    if (options.port) settings.port = *options.port;
    server_.emplace(*board_, settings);
    say(stderr, "live view: {}\n", server_->url());
}

void LiveView::busy(const std::string& what) {
    if (board_) board_->busy(what);
}

void LiveView::over(const JobOutcome& outcome) {
    if (!board_) return;
    std::string words =
        outcome.interrupted
            ? fmt::format("It was ended early, with results of {} of {}; the same command goes on there.", outcome.results.size(),
                          counted(outcome.tests, "test"))
            : fmt::format("{} have ended{}.", counted(outcome.tests, "test"),
                          outcome.failed.empty() ? "" : fmt::format(", {} without a result", outcome.failed.size()));
    words += fmt::format(" This page is the report of the run as it stands in {}.", (outcome.directory / "report.html").string());
    board_->over(words);
    server_.reset();  // when the pages have it
}

}  // namespace feldspar
