// The runs that a job stands for: every test on every one of its packings.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "feldspar/lab/run_test.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/methods/method.hpp"

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

/// The packings of a job, each made once and shared by the tests on it.
class Specimens {
public:
    explicit Specimens(const Job& job) : job_(&job) {}

    /// Called on the caller's thread with the stem of a packing's file while that packing is made.
    using Tell = std::function<void(const std::string&, const SpecimenProgress&)>;

    /// Makes the specimens of all these runs that are not there yet, side by side; a single one tells how far it is.
    /// @throws what the first of them in order throws; Interrupted when the user stops it
    void make(std::span<const PlannedRun> runs, int threads, const Tell& tell = {});

    /// How many make() would have to make.
    int missing(std::span<const PlannedRun> runs) const { return static_cast<int>(missing_keys(runs).size()); }

    /// The specimen of the run, made on the first call.
    std::shared_ptr<const Specimen> get(const PlannedRun& run, int threads = 1, const Tell& tell = {});

    /// "packing-s3" or "packing-disc-s3": the stem of the file of the run's packing.
    static std::string packing_stem(const PlannedRun& run);
    static std::string packing_stem(bool disc, std::uint64_t seed);

private:
    using Key = std::pair<bool, std::uint64_t>;  // (disc of the Brazilian test?, seed)
    static Key key_of(const PlannedRun& run) { return {method_of(*run.test).specimen.own_disc, run.seed}; }
    std::vector<Key> missing_keys(std::span<const PlannedRun> runs) const;

    const Job* job_;
    std::map<Key, std::shared_ptr<const Specimen>> made_;
};

/// Bodies that move by themselves in such a test: grains or their inner particles.
int body_count(const PlannedRun& run, const Specimen& specimen);

/// What run_test() and preview_test() ask for.
TestSetup setup_of(const PlannedRun& run, std::shared_ptr<const Specimen> specimen);

}  // namespace feldspar
