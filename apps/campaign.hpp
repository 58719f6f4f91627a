// The runs that a job stands for: every test on every one of its packings.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "feldspar/lab/run_test.hpp"
#include "feldspar/study/job.hpp"

namespace feldspar {

/// One test of one variant on one packing.
struct PlannedRun {
    const Variant* variant = nullptr;  ///< points into the job
    const TestSpec* test = nullptr;    ///< points into the job
    std::uint64_t seed = 0;
};

/// All runs of the job, packing by packing, then variant by variant: an interrupted job leaves whole packings behind.
std::vector<PlannedRun> planned_runs(const Job& job);

/// "biaxial at 4 MPa".
std::string title(const TestSpec& test);

/// The same with the variant's name before it, if it has one: "Rigid, brittle: biaxial at 4 MPa".
std::string title(const std::string& variant, const TestSpec& test);

/// The packings of a job, each made once.
class Specimens {
public:
    explicit Specimens(const Job& job) : job_(&job) {}

    /// The specimen of the run, made on the first call, as `control` says.
    std::shared_ptr<const Specimen> get(const PlannedRun& run, const SpecimenControl& control = {});

    /// "packing-s3" or "packing-disc-s3": the stem of the file of the run's packing.
    static std::string packing_stem(const PlannedRun& run);

private:
    using Key = std::pair<bool, std::uint64_t>;  // (disc of the Brazilian test?, seed)
    static Key key_of(const PlannedRun& run) { return {run.test->kind == TestKind::brazilian, run.seed}; }

    const Job* job_;
    std::map<Key, std::shared_ptr<const Specimen>> made_;
};

/// What run_test() and preview_test() ask for.
TestSetup setup_of(const PlannedRun& run, std::shared_ptr<const Specimen> specimen);

}  // namespace feldspar
