// Why a target is missed, in one sentence: by how much, what it hangs on, what to change.
#pragma once

#include <string>

#include "feldspar/calibration/calibrate.hpp"

namespace feldspar {

/// Fills in `miss` and `missed` of every target that the confirming packings miss, from what else the result holds.
void say_what_is_missed(const Calibration& calibration, CalibrationResult& result);

}  // namespace feldspar
