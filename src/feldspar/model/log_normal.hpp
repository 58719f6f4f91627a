// Log-normal factors of mean 1, (H3).
#pragma once

#include <cmath>

namespace feldspar {

/// Standard deviation of the logarithm of a factor with this coefficient of variation.
inline double log_deviation(double variation) { return std::sqrt(std::log1p(variation * variation)); }

/// The factor at a standard normal z. @param variation  its coefficient of variation
inline double log_normal_factor(double variation, double z) {
    const double s = log_deviation(variation);
    return std::exp(s * z - 0.5 * s * s);
}

}  // namespace feldspar
