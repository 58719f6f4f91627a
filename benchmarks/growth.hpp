// The way of a specimen from its grain sizes to a record of its test, stage by stage, for whoever measures or counts what each of
// them takes at one size and another: ./bench --growth, and tests/growth.
#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "feldspar/lab/experiment.hpp"
#include "feldspar/lab/recorder.hpp"

namespace feldspar::benchmarks {

/// Runs the work of a stage once, and looks at what it takes. The work returns how often it has done the same: the steps of a
/// relaxation, else 1.
using StageWatch = std::function<void(std::string_view stage, const std::function<double()>& work)>;

/// A rectangle of the Augig granite, twice as high as wide, of flexible grains, under uniaxial compression.
class GrowingTest {
public:
    /// Packs, tessellates and meshes: "places of the discs", "relaxation, a step", "clipping", "merging, cells", "meshing".
    /// @param grains  about so many, at least 100
    GrowingTest(int grains, int threads, const StageWatch& watch);
    GrowingTest(const GrowingTest&) = delete;
    GrowingTest& operator=(const GrowingTest&) = delete;

    /// "assembly", "masses, largest eigenvalue".
    void set_up(const StageWatch& watch);

    /// A few steps, records and looks at the contacts, with cracks in a fiftieth of the contact points: "elastic start, a step",
    /// "a step", "first record", "search for contacts", "a look at contacts", "contacts sorted anew", "a record with cracks",
    /// "acoustic events", "state kept", "fields made ready".
    void test(const StageWatch& watch);

    int grains() const { return static_cast<int>(specimen_->cells.cells.size()); }
    /// What test() has left.
    const TestResult& result() const { return result_; }
    /// The memory of specimen and body, bytes: what `feldspar check` counts of them.
    double specimen_bytes() const;
    double assembly_bytes() const { return experiment_ ? experiment_->assembly.memory_bytes() : 0.0; }

private:
    void look_at_contacts(const StageWatch& watch);

    RunControl control_;
    std::shared_ptr<Specimen> specimen_ = std::make_shared<Specimen>();
    TestSetup setup_;
    TestResult result_;
    std::unique_ptr<Experiment> experiment_;
    std::unique_ptr<Recorder> recorder_;
};

}  // namespace feldspar::benchmarks
