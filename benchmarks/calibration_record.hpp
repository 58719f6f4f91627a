// The best calibrations that earlier runs saw on this machine. A run knows undisturbed from disturbed only by its own best; when
// the whole run was disturbed, the record tells.
#pragma once

#include <filesystem>
#include <string>

#include "benchmarks/reading.hpp"

namespace feldspar::benchmarks {

/// Merges the best calibrations of a run into the file and returns what it then holds for this processor. A file that is missing
/// or cannot be read counts as empty; one that cannot be written stays as it is. Nothing of a run depends on the record.
BestCalibrations record_calibrations(const std::filesystem::path& file, const std::string& processor,
                                     const BestCalibrations& best);

}  // namespace feldspar::benchmarks
