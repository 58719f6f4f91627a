// Edits of a kept state behind its checksum: what a finished test left, and the state of one under way, read over those of a
// small specimen. A StateError refuses it.
#include "../verification/fixtures.hpp"
#include "feldspar/lab/keep_test.hpp"
#include "fuzz.hpp"

namespace feldspar::fuzz {
namespace {

struct Kept final : StateKeeper {
    std::vector<char> bytes;
    bool due(bool) override { return false; }
    void keep(const std::function<void(const StatePut&)>& write) override {
        bytes.clear();
        write([&](const void* data, std::size_t count) {
            bytes.insert(bytes.end(), static_cast<const char*>(data), static_cast<const char*>(data) + count);
        });
    }
    std::vector<char> kept() override { return bytes; }
    void refuse(const std::string&) override {}
};

}  // namespace

void checkpoint(std::string_view input) {
    static const TestSetup setup = [] {
        SpecimenSpec spec = fixtures::rectangle(0.02, 0.04);
        spec.grain_sizes.minimum_m = 0.006;
        spec.grain_sizes.maximum_m = 0.010;
        return fixtures::setup(fixtures::make(spec, 3), methods::uniaxial_compression);
    }();
    static const RunControl control = fixtures::threads(1);
    static const ExperimentState base = [] {
        Experiment experiment(setup, control);
        choose_step(experiment);
        return experiment.state();
    }();
    static const std::string whole = [] {  // one test has ended, the next is under way
        Kept kept;
        TestKeeping keeping(&kept);
        Experiment experiment(setup, control);
        choose_step(experiment);
        keeping.begin(experiment.state());
        TestResult result;
        result.history.resize(3);
        result.cracks.resize(2);
        result.stop_reason = "the end";
        keeping.add_finished(result);
        experiment.run(5);
        keeping.keep(TestPart::loading, [&](StateWriter& writer) { writer.write(experiment.state()); });
        return std::string(kept.bytes.begin(), kept.bytes.end());
    }();
    const std::string bytes = edited(whole, input);
    Kept kept;
    kept.bytes.assign(bytes.begin(), bytes.end());
    try {
        TestKeeping keeping(&kept);
        TestResult result;
        while (keeping.take_finished(result)) result = {};
        keeping.begin(base);
        ExperimentState state = base;
        for (const TestPart part : {TestPart::preparation, TestPart::loading})
            if (keeping.goes_on(part)) keeping.go_on([&](StateReader& reader) { reader.read(state); });
    } catch (const StateError&) {
    }
}

}  // namespace feldspar::fuzz
