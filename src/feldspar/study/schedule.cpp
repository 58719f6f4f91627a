#include "feldspar/study/schedule.hpp"

#include <deque>
#include <numeric>
#include <utility>

namespace feldspar {
namespace {

class Schedule {
public:
    Schedule(std::size_t count, const Sharing& sharing, std::atomic<bool>& stop, RunSink& sink)
        : stop_(stop), sink_(sink), running_(sharing, stop), waiting_(count) {
        std::iota(waiting_.begin(), waiting_.end(), std::size_t{0});
    }

    std::size_t operator()() {
        while (true) {
            while (may_start()) start_next();
            running_.share_out_free_threads();
            if (running_.count() == 0 && results_.empty()) {
                if (stop_ || !another_turn()) return waiting_.size();
                continue;
            }
            // a result is taken only when every thread has something to do
            const bool idle = results_.empty();
            if (!idle) take_next();
            listen(running_.events(idle));
            sink_.beat();
        }
    }

private:
    bool may_start() { return !stop_ && !waiting_.empty() && running_.has_room_for(sink_.bodies(waiting_.front())); }

    void start_next() {
        const std::size_t run = waiting_.front();
        waiting_.pop_front();
        if (RunningTests::Work work = sink_.begin(run)) running_.start(run, sink_.bodies(run), waiting_.size() + 1, std::move(work));
    }

    void take_next() {
        RunningTests::Ended run = std::move(results_.front());
        results_.pop_front();
        sink_.finished(run.number, std::move(*run.result));
    }

    void listen(RunningTests::Events events) {
        for (const auto& [run, state] : events.news) sink_.progress(run, state);
        for (RunningTests::Ended& run : events.ended) {
            sink_.ended(run.number);
            if (run.error) sink_.failed(run.number, run.error);
            else results_.push_back(std::move(run));
        }
    }

    bool another_turn() {
        const std::vector<std::size_t> again = sink_.another_turn();
        waiting_.assign(again.begin(), again.end());
        return !waiting_.empty();
    }

    std::atomic<bool>& stop_;
    RunSink& sink_;
    RunningTests running_;
    std::deque<std::size_t> waiting_;
    std::deque<RunningTests::Ended> results_;   // not taken yet
};

}  // namespace

std::size_t run_in_order(std::size_t count, const Sharing& sharing, std::atomic<bool>& stop, RunSink& sink) {
    return Schedule(count, sharing, stop, sink)();
}

}  // namespace feldspar
