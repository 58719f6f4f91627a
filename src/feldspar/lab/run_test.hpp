// One laboratory test on one specimen, from bonding to the last step.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "feldspar/base/state_archive.hpp"
#include "feldspar/methods/result.hpp"
#include "feldspar/model/heterogeneity_spec.hpp"

namespace feldspar {

/// What a running test tells about itself, at most a few times a second.
struct TestProgress {
    std::string stage;  ///< "elastic start", "consolidation", "loading"
    long long step = 0;
    double axial_strain = 0.0;
    double axial_stress_Pa = 0.0;  ///< compression positive
    double peak_stress_Pa = 0.0;   ///< magnitude so far
    int cracks = 0;
    double steps_per_second = 0.0;
    double seconds_left = -1.0;  ///< an estimate; < 0 when there is none
};

/// Where a running test keeps its state, so that it goes on where it was after the program was ended.
class StateKeeper {
public:
    virtual ~StateKeeper() = default;

    /// Whether the state is to be kept now; asked at every record. @param stopped  the test ends here
    virtual bool due(bool stopped) = 0;

    /// Keeps what `write` puts. What was kept before stays until this is whole. A state that cannot be kept is no reason to end
    /// the test.
    virtual void keep(const std::function<void(const StatePut&)>& write) = 0;

    /// What was kept last; empty if nothing was.
    virtual std::vector<char> kept() = 0;

    /// What kept() gave is not a state of this test: it is not to be given again.
    virtual void refuse(const std::string& reason) = 0;
};

class StepDevice;
class TestObserver;
class TestWatch;

/// What the caller decides about the running itself; none of it changes a result, but an observer that gives orders, and a
/// device, whose breaking specimens take another, equally valid, course.
struct RunControl {
    int threads = 1;
    const std::atomic<int>* more_threads = nullptr;     ///< may grow while the test runs: so many threads from then on
    std::function<void(const TestProgress&)> progress;  ///< may be empty
    const std::atomic<bool>* stop = nullptr;        ///< becomes true when the user interrupts: the test ends at the next record
    std::function<void(const TestResult&)> failed;  ///< told the record of a test whose motion has become unstable, before its
                                                    ///< error; without properties; may be empty
    StateKeeper* keeper = nullptr;                  ///< if it has the state of this test, the test goes on from there
    std::function<std::unique_ptr<StepDevice>()>
        device;  ///< opens what makes the steps (step/step.hpp); may be empty: the processor
    TestObserver* observer =
        nullptr;                 ///< sees the test while it loads, and may lead it (lab/observer.hpp); there is then no keeper
    TestWatch* watch = nullptr;  ///< looks at the test while it runs, and may end it (test_watch.hpp)
    std::function<bool(bool)> agree;  ///< of several ranks that make the test together: what the first one is given, for all; so
                                      ///< they end at the same record; may be empty: alone
};

/// Everything that defines a test.
struct TestSetup {
    std::shared_ptr<const Specimen> specimen;
    ModelSpec model;
    GrainMaterial grain;
    ContactMaterial contact;
    NumericsSpec numerics;
    TestSpec test;
    Heterogeneity rock{};  ///< what of grains and contacts differs from these
};

/// Runs the test, or the rest of it; the result has its properties and evidence filled in. With NumericsSpec::confirm the test is
/// run again at a third of the target. @throws InputError for an unstable setting, NumericalError when a force is not a number.
TestResult run_test(const TestSetup& setup, const RunControl& control);

/// What a finished test leaves, so that it need not be run again.
void keep_result(const TestResult& result, const StatePut& put);

/// The result that keep_result() has put. @param setup  of the same test  @throws StateError
TestResult kept_result(const TestSetup& setup, std::span<const char> kept);

/// What is known of a test before it is run: what half of its like stayed below, and the bounds of nine in ten.
struct Foreseen {
    double low = 0.0, usual = 0.0, high = 0.0;
};

/// What `feldspar check` prints: built, judged and timed for a moment, but not run.
struct TestPreview {
    int grains = 0, contacts = 0, contact_points = 0, nodes = 0, triangles = 0;
    int bodies = 0;                   ///< that move by themselves: grains, or their inner particles
    Foreseen memory_bytes;            ///< at the peak of the run (lab/memory.hpp)
    double omega2 = 0.0;              ///< largest omega^2 dt^2 of the initial state
    double omega2_limit = 0.0;        ///< 4, or 4 / (1 + alpha) with local damping
    double stable_time_step_s = 0.0;  ///< largest stable time step with real masses
    Foreseen steps;                   ///< of loading (lab/foresee.hpp)
    double step_seconds = 0.0;        ///< that a step takes now, with the threads that are given
};

/// @throws InputError for an unstable setting.
TestPreview preview_test(const TestSetup& setup, const RunControl& control);

}  // namespace feldspar
