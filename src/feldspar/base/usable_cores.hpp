// How many processor cores this program may use.
#pragma once

#include <optional>
#include <string>

namespace feldspar {

/// Cores that the scheduler may give to this process: those of its affinity mask (taskset, a batch system), and no more than its
/// control group's share of processor time (a container) in whole cores. At least 1.
int usable_cores();

/// The share of processor time that a control group's file grants, in cores: of "cpu.max" ("150000 100000"), or of version 1's
/// quota and period with a blank between. Nothing if there is no limit or the text says none.
std::optional<double> cores_of_quota(const std::string& text);

}  // namespace feldspar
