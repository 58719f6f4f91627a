#include "feldspar/study/execute.hpp"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/base/stopwatch.hpp"
#include "feldspar/lab/test_watch.hpp"
#include "feldspar/study/notes.hpp"
#include "feldspar/study/packings.hpp"
#include "feldspar/study/run_files.hpp"
#include "feldspar/study/schedule.hpp"

namespace feldspar {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto between_heartbeats = std::chrono::seconds(20);
constexpr auto between_looks_at_others = std::chrono::milliseconds(500);

// Bodies that move by themselves in the run, before its specimen is there.
int expected_bodies(const Run& run) {
    const SpecimenSpec& specimen = specimen_of(run.job, run.test());
    const bool filled = run.job.variants.front().model.kind == GrainKind::inner_particles;
    return static_cast<int>(grain_count(specimen) * (filled ? specimen.particles_per_grain : 1.0));
}

// Takes runs from a ledger, and what becomes of them back to it.
class LedgerSink final : public RunSink {
public:
    LedgerSink(std::span<const Run> runs, Ledger& ledger, const ExecuteControl& control)
        : ledger_(ledger), control_(control), packings_(static_cast<std::size_t>(2 * control.threads + 2), control.stop) {
        std::set<std::string> seen;
        for (const Run& run : runs)  // points may share runs
            if (seen.insert(run.id).second) runs_.push_back(&run);
        const std::vector<RunRecord> records = ledger_.find(std::vector<std::string>(seen.begin(), seen.end()));
        const SettledRuns settled = settled_runs(records, whose_failures_count());
        if (control_.live != nullptr) {
            control_.live->plan(runs_);
            for (const RunRecord& record : records)
                if (settled.done.contains(record.id) || settled.failed.contains(record.id)) control_.live->settled(record);
        }
        execution_.found_done = static_cast<int>(settled.done.size());
        execution_.found_failed = static_cast<int>(settled.failed.size());
        std::erase_if(runs_, [&](const Run* run) { return settled.done.contains(run->id) || settled.failed.contains(run->id); });
    }

    std::size_t count() const { return runs_.size(); }

    /// @param without_turn  so many runs had none  @throws OutputError if results could not be written
    Execution execution(std::size_t without_turn) {
        execution_.left = static_cast<int>(without_turn + others_.size()) + interrupted_;
        tell_notes();
        if (lost_) std::rethrow_exception(lost_);
        return execution_;
    }

    int bodies(std::size_t i) override { return expected_bodies(*runs_[i]); }

    RunningTests::Work begin(std::size_t i) override {
        const Run& run = *runs_[i];
        switch (ledger_.claim(run, whose_failures_count())) {  // another process may have ended it by now
            case Ledger::Claim::done:
                ++execution_.found_done;
                show(ledger_.find(run.id));
                return {};
            case Ledger::Claim::failed:
                ++execution_.found_failed;
                show(ledger_.find(run.id));
                return {};
            case Ledger::Claim::others:
                others_.push_back(i);
                return {};
            case Ledger::Claim::ours:
                break;
        }
        if (const std::string damage = set_damaged_record_aside(ledger_.run_directory(run.id), run); !damage.empty())
            notes_.add(damage);
        if (const auto record = finished_record(ledger_.run_directory(run.id),
                                                run)) {  // it ended, but the program did before its row was written
            ledger_.record(*record);
            forget_state(ledger_.run_directory(run.id));
            show(record);
            ++execution_.found_done;
            return {};
        }
        if (const auto record = failure_left(ledger_.run_directory(run.id), run);
            record && !settled_runs(std::span(&*record, 1), whose_failures_count()).failed.empty()) {
            ledger_.record(*record);
            show(record);
            ++execution_.found_failed;
            return {};
        }
        if (control_.live != nullptr) control_.live->begins(run);
        return [this, &run](const RunControl& run_control) { return run_one(run, run_control); };
    }

    void progress(std::size_t i, const TestProgress& state) override {
        if (control_.progress) control_.progress(*runs_[i], state);
        if (control_.live != nullptr) control_.live->progress(*runs_[i], state);
    }

    void ended(std::size_t i) override {
        if (control_.live != nullptr) control_.live->written(*runs_[i]);
    }

    void finished(std::size_t i, TestResult result) override {
        const Run& run = *runs_[i];
        settle(run, [&] {
            if (result.interrupted) throw Interrupted();
            if (!ledger_.holds(run.id)) {  // this process slept for so long that another took the run
                others_.push_back(i);
                if (control_.live != nullptr) control_.live->waits(run);
                return;
            }
            execution_.run_s += result.wall_s;
            if (result.stop_reason == kEndedByUser) {  // it has not come as far as one that is done
                record(run, failed_record(run, kEndedByUser, Failure::other, control_.provenance));
                ++execution_.failed;
                return;
            }
            finish_files(run, result, ledger_.run_directory(run.id), control_.keep, control_.provenance);
            record(run, *finished_record(ledger_.run_directory(run.id), run));
            ++execution_.done;
        });
    }

    void failed(std::size_t i, const std::exception_ptr& error) override {
        settle(*runs_[i], [&] { std::rethrow_exception(error); });
    }

    // Runs that another process had: done by now, still at it, or left behind.
    std::vector<std::size_t> another_turn() override {
        if (others_.empty()) return {};
        if (!told_ && control_.note) control_.note(fmt::format("waiting for {} runs that another process is at", others_.size()));
        told_ = true;
        std::this_thread::sleep_for(between_looks_at_others);
        return std::exchange(others_, {});
    }

    void beat() override {
        tell_notes();
        if (Clock::now() < next_beat_) return;
        ledger_.heartbeat();
        next_beat_ = Clock::now() + between_heartbeats;
    }

private:
    void tell_notes() {
        for (const std::string& line : notes_.take())
            if (control_.note) control_.note(line);
    }

    // None if failed runs are to be repeated.
    const Provenance* whose_failures_count() const { return control_.retry_failed ? nullptr : &control_.provenance; }

    // On the run's own thread.
    TestResult run_one(const Run& run, const RunControl& run_control) {
        const Clock::time_point start = Clock::now();
        TestResult result = run_to_files(
            run, packings_, ledger_.run_directory(run.id), control_.keep, control_.provenance, run_control, control_.device,
            control_.checkpoints, [this](const std::string& line) { notes_.add(line); }, control_.live);
        result.wall_s = seconds_since(start);
        return result;
    }

    // What `action` throws decides what is said of the run.
    template <class Action>
    void settle(const Run& run, Action&& action) {
        try {
            action();
        } catch (const Interrupted&) {
            ledger_.release(run.id);
            ++interrupted_;
            if (control_.live != nullptr) control_.live->waits(run);
        } catch (const OutputError&) {
            ledger_.release(run.id);
            ++interrupted_;
            if (!lost_) lost_ = std::current_exception();
            *control_.stop = true;  // what still runs could not be written either
        } catch (const InputError& problem) {
            fail(run, problem, Failure::input);
        } catch (const NumericalError& problem) {
            fail(run, problem, Failure::numerical);
        } catch (const std::exception& problem) {  // there may be more memory another time
            fail(run, problem, Failure::other);
        }
    }

    void fail(const Run& run, const std::exception& problem, Failure failure) {
        record(run, failed_record(run, problem.what(), failure, control_.provenance));
        ++execution_.failed;
    }

    void show(const std::optional<RunRecord>& record) const {
        if (control_.live != nullptr && record) control_.live->settled(*record);
    }

    void record(const Run& run, const RunRecord& record) {
        ledger_.record(record);
        show(record);
        if (control_.ended) control_.ended(run, record);
    }

    Ledger& ledger_;
    const ExecuteControl& control_;
    Packings packings_;
    Notes notes_;
    std::vector<const Run*> runs_;     // not settled at the beginning
    std::vector<std::size_t> others_;  // another process is at them
    int interrupted_ = 0;
    bool told_ = false;
    std::exception_ptr lost_;
    Clock::time_point next_beat_ = Clock::now() + between_heartbeats;
    Execution execution_;
};

}  // namespace

Execution execute(std::span<const Run> runs, Ledger& ledger, const ExecuteControl& control) {
    LedgerSink sink(runs, ledger, control);
    const Clock::time_point start = Clock::now();
    const std::size_t without_turn = run_in_order(sink.count(), Sharing(control.at_once, control.threads), *control.stop, sink);
    Execution execution = sink.execution(without_turn);
    execution.wall_s = seconds_since(start);
    return execution;
}

}  // namespace feldspar
