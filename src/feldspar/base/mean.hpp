// The mean of some numbers.
#pragma once

#include <numeric>
#include <span>

namespace feldspar {

/// Summed in the order of the values; not-a-number if there are none.
inline double mean_of(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace feldspar
