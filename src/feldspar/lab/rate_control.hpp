// The automatic loading rate: accuracy in, speed out (docs/theory/loading.md).
#pragma once

#include "feldspar/model/spec.hpp"

namespace feldspar {

/// Target of R* for a wanted relative accuracy of the strength: 5e-3 for 0.5 % and 1e-2 for 2 % (Brazilian 1e-2 and 3e-2), and
/// powers of the accuracy in between and beyond.
double residual_target(const NumericsSpec& numerics, TestKind kind);

/// Adjusts the platen speed every few steps so that the unbalanced force stays at its target.
class RateControl {
public:
    /// @param target       wanted R*
    /// @param height_m     of the specimen
    /// @param travel_time  of a wave over the height, in steps
    RateControl(double target, double height_m, double travel_time)
        : target_(target), height_m_(height_m), travel_time_(travel_time) {}

    double start() const { return 6e-8 * height_m_; }

    /// @param speed              now, m a step
    /// @param unbalanced_N       sum of |F| over the free degrees of freedom
    /// @param platen_force_N     mean of both platens, magnitude
    /// @param platen_travel_m    so far
    /// @return the speed for the next steps
    double next(double speed, double unbalanced_N, double platen_force_N, double platen_travel_m);

private:
    double target_;
    double height_m_;
    double travel_time_;
    double largest_force_N_ = 0.0;
};

}  // namespace feldspar
