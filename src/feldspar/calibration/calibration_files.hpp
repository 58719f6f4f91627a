// What a calibration prints and leaves behind.
#pragma once

#include <string>

#include "feldspar/calibration/calibrate.hpp"

namespace feldspar {

/// The answer for a terminal: unknowns with their ranges, targets with predicted and confirmed values, findings.
std::string calibration_text(const CalibrationResult& result);

/// calibration.json: the same and the sensitivities, SI units and degrees.
std::string calibration_json(const Calibration& calibration, const CalibrationResult& result, const Provenance& provenance);

/// The base job with the best set, ready for `feldspar run`: the resolved job with a head that says where it came from.
std::string calibrated_job(const Calibration& calibration, const CalibrationResult& result);

/// "25.8 GPa" of a target, with the unit that a user reads.
std::string target_text(const Target& target, double value);

}  // namespace feldspar
