// The topics of the checks: a function each, in the file of its name. Internal to this room.
#pragma once

#include "feldspar/verify/check.hpp"

namespace feldspar {

std::vector<Check> contact_law_checks();
std::vector<Check> dilation_checks();
std::vector<Check> triangle_checks();
std::vector<Check> contact_checks();
std::vector<Check> two_grain_checks();
std::vector<Check> specimen_checks();
std::vector<Check> disc_checks();
std::vector<Check> bending_checks();
std::vector<Check> hole_checks();
std::vector<Check> toughness_checks();
std::vector<Check> mixture_checks();
std::vector<Check> joint_checks();
std::vector<Check> wave_checks();
std::vector<Check> energy_checks();
std::vector<Check> statistics_checks();

}  // namespace feldspar
