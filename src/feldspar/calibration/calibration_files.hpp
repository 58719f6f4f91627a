// What a calibration prints and leaves behind.
#pragma once

#include <string>

#include "feldspar/calibration/calibrate.hpp"
#include "feldspar/output/user_units.hpp"

namespace feldspar {

/// The answer for a terminal: unknowns with their ranges, targets with predicted and confirmed values, findings.
std::string calibration_text(const CalibrationResult& result, std::size_t columns = 0);

/// calibration.json: the same and the sensitivities, SI units and degrees.
std::string calibration_json(const Calibration& calibration, const CalibrationResult& result, const Provenance& provenance);

/// The base job with the best set, ready for `feldspar run`: the resolved job with a head that says where it came from.
std::string calibrated_job(const Calibration& calibration, const CalibrationResult& result);

/// "25.8 GPa" of a target, with the unit that a user reads.
std::string target_text(const Target& target, double value);

/// What a target is called and measured in.
UserQuantity user_quantity(const Target& target);

/// "8.8 MPa" of an unknown, given in its own unit; "-" for not-a-number.
std::string unknown_text(const Unknown& unknown, double value);

/// The unit of an unknown without the blank that may precede it.
std::string unit_word(const Unknown& unknown);

}  // namespace feldspar
