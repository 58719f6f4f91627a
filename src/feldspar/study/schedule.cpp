#include "feldspar/study/schedule.hpp"

#include <deque>
#include <numeric>
#include <utility>

#include "feldspar/base/error.hpp"

namespace feldspar {
namespace {

bool cannot_write(const std::exception_ptr& error) {
    try {
        std::rethrow_exception(error);
    } catch (const OutputError&) {
        return true;
    } catch (...) {
        return false;
    }
}

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
            if (running_.count() == 0 && ended_.empty()) {
                if (stop_ || !another_turn()) return waiting_.size();
                continue;
            }
            // what a run left is taken only when every thread has something to do
            const bool idle = ended_.empty();
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
        if (RunningTests::Work work = sink_.begin(run))
            running_.start(run, sink_.bodies(run), waiting_.size() + 1, std::move(work));
    }

    void take_next() {
        RunningTests::Ended run = std::move(ended_.front());
        ended_.pop_front();
        if (run.error)
            sink_.failed(run.number, run.error);
        else
            sink_.finished(run.number, std::move(*run.result));
    }

    void listen(RunningTests::Events events) {
        for (const auto& [run, state] : events.news) sink_.progress(run, state);
        for (RunningTests::Ended& run : events.ended) {
            sink_.ended(run.number);
            if (run.error && cannot_write(run.error))
                sink_.failed(run.number, run.error);  // at once, before more runs begin in vain
            else
                ended_.push_back(std::move(run));
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
    std::deque<RunningTests::Ended> ended_;  // not taken yet
};

}  // namespace

std::size_t run_in_order(std::size_t count, const Sharing& sharing, std::atomic<bool>& stop, RunSink& sink) {
    return Schedule(count, sharing, stop, sink)();
}

}  // namespace feldspar
