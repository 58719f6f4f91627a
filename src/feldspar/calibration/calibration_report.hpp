// The page of a calibration: what was wanted and what is shown, how well the unknowns are known, and the way there.
#pragma once

#include <filesystem>

#include "feldspar/calibration/calibrate.hpp"

namespace feldspar {

/// Where the page stands: `results`/<name>.html.
inline std::filesystem::path calibration_page(const Calibration& calibration) {
    return calibration.results / (calibration.name + ".html");
}

/// Writes the page of a complete result. It is self-contained, asks the network for nothing, and links to calibrated.toml beside
/// it.
/// @throws OutputError when the file cannot be written
void write_calibration_report(const Calibration& calibration, const CalibrationResult& result, const Provenance& provenance,
                              const std::filesystem::path& file);

}  // namespace feldspar
