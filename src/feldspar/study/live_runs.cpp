#include "feldspar/study/live_runs.hpp"

#include <fmt/format.h>

#include <utility>

#include "feldspar/methods/method.hpp"
#include "feldspar/study/planned_runs.hpp"

namespace feldspar {

void LiveRuns::plan(std::span<const Run* const> runs) {
    for (const Run* run : runs) {
        if (numbers_.contains(run->id)) continue;
        const MethodWords& words = method_of(run->test()).words;
        const std::string kind = fmt::format("{} {}", run->point, title(run->test()));  // a point's runs take about equally long
        numbers_[run->id] = board_.adds({label_(*run), kind, words.stress, words.strain});
    }
}

void LiveRuns::settled(const RunRecord& record) {
    const auto took = record.numbers.find("wall_s");
    const bool done = record.state == RunState::done;
    board_.ended(number_of(record.id), {done ? LiveState::ended : LiveState::failed, words_(record),
                                        done && took != record.numbers.end() ? took->second : 0.0});
    if (page_ == nullptr) return;
    page_->more();
    page_->renew_if_due();
}

void LiveRuns::begins(const Run& run) { board_.begins(number_of(run.id)); }

TestWatch& LiveRuns::watch(const Run& run, std::shared_ptr<const Specimen> specimen) {
    return board_.begins(number_of(run.id), std::move(specimen));
}

void LiveRuns::progress(const Run& run, const TestProgress& state) {
    board_.progress(number_of(run.id), state);
    if (page_ != nullptr) page_->renew_if_due();
}

void LiveRuns::written(const Run& run) { board_.written(number_of(run.id)); }

void LiveRuns::waits(const Run& run) { board_.waits(number_of(run.id)); }

}  // namespace feldspar
