// A run and what it leaves in its directory. run.json is written last: a directory without it is not finished.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "feldspar/lab/run_test.hpp"
#include "feldspar/output/checkpoints.hpp"
#include "feldspar/study/device_use.hpp"
#include "feldspar/study/live_runs.hpp"
#include "feldspar/study/packings.hpp"
#include "feldspar/study/run_record.hpp"

namespace feldspar {

/// Makes the specimen, runs the test and writes job.toml and what `keep` asks for, but for what finish_files() writes. May run on
/// any thread. Goes on from the last state that an earlier attempt has kept in the directory; all else that it left there is
/// replaced. An interrupted test leaves its state alone.
/// @param note  told what the user should read, on the same thread; may be empty
/// @param live  shows the test while it runs; may be null
TestResult run_to_files(const Run& run, Packings& packings, const std::filesystem::path& directory, Keep keep,
                        const Provenance& provenance, const RunControl& control, const DeviceUse& device = {},
                        const CheckpointSettings& checkpoints = {}, const std::function<void(const std::string&)>& note = {},
                        LiveRuns* live = nullptr);

/// Writes the rest, run.json at the end. On the main thread only: the HDF5 library is not made for several.
void finish_files(const Run& run, const TestResult& result, const std::filesystem::path& directory, Keep keep,
                  const Provenance& provenance);

/// A run.json that is damaged, or another run's, becomes run.json.damaged, so that the run is made again. @return what the user
/// should read; empty if there is none such
std::string set_damaged_record_aside(const std::filesystem::path& directory, const Run& run);

/// Removes the state of a test whose run is done: the program was ended, or the disk failed, between the two.
void forget_state(const std::filesystem::path& directory);

/// The record of a run that is done, from run.json; none if the directory is not that of a finished run.
std::optional<RunRecord> finished_record(const std::filesystem::path& directory, const Run& run);

/// The record of a run that failed, which elements of job arrays leave in its directory.
std::optional<RunRecord> failure_left(const std::filesystem::path& directory, const Run& run);

}  // namespace feldspar
