#include "feldspar/base/regression.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace feldspar {

Line regression_line(std::span<const double> x, std::span<const double> y) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (x.size() != y.size() || x.size() < 2) return {nan, nan};
    double mean_x = 0.0, mean_y = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mean_x += x[i];
        mean_y += y[i];
    }
    mean_x /= static_cast<double>(x.size());
    mean_y /= static_cast<double>(x.size());
    double sxx = 0.0, sxy = 0.0, scale = 0.0;  // centred sums: no cancellation
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double dx = x[i] - mean_x;
        sxx += dx * dx;
        sxy += dx * (y[i] - mean_y);
        scale += x[i] * x[i];
    }
    if (!(sxx > 1e-24 * scale) || !std::isfinite(sxy)) return {nan, nan};
    const double slope = sxy / sxx;
    return {slope, mean_y - slope * mean_x};
}

}  // namespace feldspar
