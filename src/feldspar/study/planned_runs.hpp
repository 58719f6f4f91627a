// The runs that jobs stand for: every test of every variant on every one of its packings, in the order in which they have their
// turns.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "feldspar/job/job.hpp"
#include "feldspar/lab/run_test.hpp"

namespace feldspar {

/// One test of one variant on one packing. Points into its job.
struct PlannedRun {
    std::size_t job_number = 0;  ///< among the jobs that were planned together
    const Job* job = nullptr;
    const Variant* variant = nullptr;
    const TestSpec* test = nullptr;
    std::uint64_t seed = 0;
};

/// All runs of these jobs, packing by packing, then job by job, variant by variant, test by test: what is interrupted leaves
/// whole packings behind.
std::vector<PlannedRun> planned_runs(std::span<const Job* const> jobs);
std::vector<PlannedRun> planned_runs(const Job& job);

/// The specimen on which it runs.
const SpecimenSpec& specimen_of(const PlannedRun& run);

/// "packing-s3" or "packing-disc-s3": the stem of the file of the run's packing.
std::string packing_stem(const PlannedRun& run);

/// "biaxial at 4 MPa".
std::string title(const TestSpec& test);

/// The same with the variant's name before it, if it has one: "Rigid, brittle: biaxial at 4 MPa".
std::string title(const std::string& variant, const TestSpec& test);

/// "Rigid, brittle: biaxial at 4 MPa, seed 3".
std::string label_of(const PlannedRun& run);

/// Bodies that move by themselves in such a test: grains or their inner particles.
int body_count(const PlannedRun& run, const Specimen& specimen);

/// What run_test() and preview_test() ask for.
TestSetup setup_of(const PlannedRun& run, std::shared_ptr<const Specimen> specimen);

}  // namespace feldspar
