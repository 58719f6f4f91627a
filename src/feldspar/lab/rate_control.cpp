#include "feldspar/lab/rate_control.hpp"

#include <algorithm>
#include <cmath>

namespace feldspar {

double residual_target(const NumericsSpec& numerics, TestKind kind) {
    if (numerics.residual_target) return *numerics.residual_target;
    // Two measured pairs (accuracy, R*) each; ln 2 / ln 4 and ln 3 / ln 4 are the powers through them.
    const double relative = numerics.accuracy / 0.005;
    return kind == TestKind::brazilian ? 1e-2 * std::pow(relative, 0.7925) : 5e-3 * std::sqrt(relative);
}

double RateControl::next(double speed, double unbalanced_N, double platen_force_N, double platen_travel_m) {
    largest_force_N_ = std::max(largest_force_N_, platen_force_N);
    const double force = std::max(platen_force_N, 0.5 * largest_force_N_);
    const double residual = unbalanced_N / force;
    const double factor = residual > 0.0 ? std::clamp(std::sqrt(target_ / residual), 0.7, 1.06) : 1.06;
    const double slowest = 6e-9 * height_m_, fastest = std::max(slowest, 0.4 * platen_travel_m / travel_time_);
    return std::clamp(speed * factor, slowest, fastest);
}

}  // namespace feldspar
