// The automatic loading rate: accuracy in, speed out (docs/theory/loading.md).
#pragma once

#include <vector>

#include "feldspar/model/assembly.hpp"
#include "feldspar/model/spec.hpp"

namespace feldspar {

/// Target of R* for a wanted relative accuracy of the strength: 5e-3 for 0.5 % and 1e-2 for 2 % (Brazilian of deformable grains
/// 1e-2 and 3e-2), and powers of the accuracy in between and beyond.
double residual_target(const NumericsSpec& numerics, TestKind kind, GrainKind grains);

/// A first estimate of the strength from the contacts alone, Pa: tension sigma_nt; compression the Mohr-Coulomb strength of
/// a material with the contacts' cohesion and friction, 2 tau (mu + sqrt(1 + mu^2)) + N sigma_3. Only the rate control uses it.
double expected_strength(const ContactMaterial& contact, const TestSpec& test);

/// Adjusts the platen speed every few steps so that the unbalanced force stays at its target.
class RateControl {
public:
    /// @param target       wanted R*
    /// @param height_m     of the specimen
    /// @param travel_time  of a wave over the height, in steps
    /// @param expected_N   about what the specimen will carry, so that the first weak points at a tenth of the strength do not
    ///                     slow the test down as if it were failing
    /// @param relative_target  target over that of an accuracy of 0.5 %: the slowest speed goes with it
    RateControl(double target, double relative_target, double height_m, double travel_time, double expected_N)
        : target_(target), relative_target_(relative_target), height_m_(height_m), travel_time_(travel_time), largest_force_N_(expected_N) {}

    double start() const { return 6e-8 * height_m_; }

    /// @param speed              now, m a step
    /// @param unbalanced_N       sum of |F| over the free degrees of freedom
    /// @param platen_force_N     mean of both platens, magnitude
    /// @param platen_travel_m    so far
    /// @param past_peak          the stress has fallen below the peak
    /// @return the speed for the next steps
    double next(double speed, double unbalanced_N, double platen_force_N, double platen_travel_m, bool past_peak);

    /// R* as the control sees it: over the larger of the platen force and half of the largest, or expected, force.
    double residual(double unbalanced_N, double platen_force_N) const;

private:
    double target_;
    double relative_target_;
    double height_m_;
    double travel_time_;
    double largest_force_N_;
};

/// Lets the loading mode B follow the damaged body. While the body moves quietly, its mean motion over about one travel time
/// of a wave is, per unit of platen travel, what B should be; blending it in leaves every velocity as it is and only
/// changes what the damping calls a deviation.
class LoadingModeUpdate {
public:
    /// @param travel_time  of a wave over the height, in steps: the window
    /// @param target       wanted R*; a window in which R* passed three times this is not quiet and is not learned from
    LoadingModeUpdate(double travel_time, double target) : window_(travel_time), quiet_(3.0 * target) {}

    /// To be called after every block of steps. @param residual  R* now
    void observe(Assembly& assembly, long long step, double platen_travel_m, double residual);

private:
    void begin(const Assembly& assembly, long long step, double platen_travel_m);

    double window_;
    double quiet_;
    long long start_step_ = -1;
    double start_travel_m_ = 0.0;
    double largest_residual_ = 0.0;
    Array<Vec2> start_displacement_m_;
};

}  // namespace feldspar
