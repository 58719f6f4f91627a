// How the state of a running test is kept, and what a finished one leaves (base/state_archive.hpp).
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "feldspar/lab/experiment.hpp"
#include "feldspar/lab/run_test.hpp"
#include "feldspar/methods/result.hpp"
#include "feldspar/model/keep_assembly.hpp"

namespace feldspar {

/// The kernels, and the device, are those that this program has chosen: whoever keeps a state says which they were.
template <class Archive>
void keep(Archive& archive, StepSettings& settings) {
    auto& [dt, damping, alpha, viscous, strength, speed, kernels, sweep_steps, device] = settings;
    archive(dt, damping, alpha, viscous, strength, speed, sweep_steps);
}

/// A result without what the setup of its test gives.
template <class Archive>
void keep_course(Archive& archive, TestResult& result) {
    auto& [variant, test, model, contact, grain, rock, texture, numerics, seed, specimen,  // of the setup
           history, cracks, snapshots, grain_contacts, stages, gauges, length, section, energy_at_end, energy_residual, evidence,
           properties, emission, nearest, stop_reason, interrupted, steps, steps_to_peak, passages, preparation_steps, wall,
           ms_per_step, threads, shape_fallbacks, angular_momentum_loss, vanished_compressions, new_contacts, travel_steps,
           travel_time, stable_omega2, stable_limit] = result;
    archive(history, cracks, snapshots, grain_contacts, stages, gauges, length, section, energy_at_end, energy_residual, evidence,
            properties, emission, nearest, stop_reason, interrupted, steps, steps_to_peak, passages, preparation_steps, wall,
            ms_per_step, threads, shape_fallbacks, angular_momentum_loss, vanished_compressions, new_contacts, travel_steps,
            travel_time, stable_omega2, stable_limit);
}

/// The parts of a run in which states are kept.
enum class TestPart { none, preparation, loading };

/// Keeps the state of a test under way by a StateKeeper, and brings it back. A test may be several runs: the repeats that confirm
/// it.
class TestKeeping {
public:
    /// @param keeper  may be null: nothing is kept then, and nothing brought back
    explicit TestKeeping(StateKeeper* keeper);

    /// What the next run left if it has ended before. @param result  with what its setup gives
    bool take_finished(TestResult& result);
    /// A run that has ended; those before have been added. Of the last one nothing has to be known.
    void add_finished(TestResult result);

    /// The state of the next run's experiment before its preparation, which is made anew whenever the test goes on.
    void begin(const ExperimentState& base);
    /// Whether a kept state of this run is waiting, and of which part of it.
    bool goes_on(TestPart part) const { return waiting_ == part; }
    template <class Read>
    void go_on(Read read) {
        waiting_ = TestPart::none;
        std::uint64_t fingerprint = 0;
        reader_->read(fingerprint, before_s_);
        if (fingerprint != base_.fingerprint())
            throw StateError("it is of another specimen or material, or of another version of the program");
        read(*reader_);
        if (!reader_->at_end()) throw StateError("more follows than belongs to it");
        reader_.reset();
        data_ = {};
    }

    bool due(bool stopped) const { return keeper_ != nullptr && keeper_->due(stopped); }
    template <class Write>
    void keep(TestPart part, Write write) const {
        keeper_->keep([&](const StatePut& put) {
            StateWriter writer(put, base_);
            writer.write(finished_.size());
            for (const TestResult& result : finished_) keep_course(writer, const_cast<TestResult&>(result));
            writer.write(part, base_.fingerprint(), seconds());
            write(writer);
        });
    }

    /// Wall time of this run, also before the program was ended.
    double seconds() const;

private:
    StateKeeper* keeper_;
    std::vector<char> data_;
    std::optional<StateReader> reader_;
    std::size_t finished_before_ = 0;
    TestPart waiting_ = TestPart::none;
    std::vector<TestResult> finished_;
    StateBase base_;
    double before_s_ = 0.0;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace feldspar
