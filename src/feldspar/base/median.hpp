// The middle of some numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace feldspar {

/// The middle one of an odd number of values, the mean of the two middle ones of an even number. @param values  at least one
inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// The middle one of an odd number of values, the upper of the two middle ones of an even number. One of the values in any case,
/// and found without sorting them all. @param values  at least one; their order is changed
inline double upper_median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace feldspar
