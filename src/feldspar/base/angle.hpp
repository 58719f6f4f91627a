// Degrees, in which users think, and radians, in which everything is computed.
#pragma once

#include <numbers>

namespace feldspar {

constexpr double in_degrees(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }

constexpr double in_radians(double angle_deg) { return angle_deg * std::numbers::pi / 180.0; }

}  // namespace feldspar
