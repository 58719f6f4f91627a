// Which job files this program reads.
#pragma once

namespace feldspar {

/// The version of the format of job files (docs/formats.md) that this program writes; it reads this one and those before.
inline constexpr int job_format = 1;

}  // namespace feldspar
