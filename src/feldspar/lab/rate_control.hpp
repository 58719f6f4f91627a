// The automatic loading rate: accuracy in, speed out (docs/theory/loading.md).
#pragma once

#include <array>
#include <vector>

#include "feldspar/model/assembly.hpp"
#include "feldspar/model/spec.hpp"

namespace feldspar {

/// Target of R* for a wanted relative accuracy of the strength: 5e-3 for 0.5 % and 1e-2 for 2 % (Brazilian of deformable grains
/// 1e-2 and 3e-2), and powers of the accuracy in between and beyond.
double residual_target(const NumericsSpec& numerics, TestKind kind, GrainKind grains);

/// The accuracy that has this target: the inverse of residual_target().
double accuracy_of(double residual_target, TestKind kind, GrainKind grains);

/// A first estimate of the strength from the contacts alone, Pa: tension sigma_nt; compression the Mohr-Coulomb strength of
/// a material with the contacts' cohesion and friction, 2 tau (mu + sqrt(1 + mu^2)) + N sigma_3. Only the rate control uses it.
double expected_strength(const ContactMaterial& contact, const TestSpec& test);

/// What the free degrees of freedom leave unbalanced, sums of |F|.
struct Unbalanced {
    double total_N = 0.0;
    double typical_N = 0.0;   ///< of the median body (plates apart), times the number of bodies: what the total would be without
                              ///< the few bodies beside a running crack, or that rattle in crushed rock whatever the speed is
};

Unbalanced unbalanced(const Assembly& assembly);

/// Adjusts the platen speed every few steps so that the unbalanced force stays at its target.
class RateControl {
public:
    /// @param target       wanted R*
    /// @param relative_target  target over that of an accuracy of 0.5 %: the slowest and the fastest speed go with it
    /// @param height_m     of the specimen
    /// @param travel_time  of a wave over the height, in steps
    /// @param expected_N   about what the specimen will carry, so that the first weak points at a tenth of the strength do not
    ///                     slow the test down as if it were failing, and the strength is not approached too fast
    RateControl(TestKind kind, double target, double relative_target, double height_m, double travel_time, double expected_N);

    double start() const { return 6e-8 * height_m_; }

    /// @param speed              now, m a step
    /// @param platen_force_N     mean of both platens, magnitude
    /// @param platen_travel_m    so far
    /// @param share_of_peak      the present stress over the largest so far
    /// @return the speed for the next steps
    double next(double speed, const Unbalanced& unbalanced, double platen_force_N, double platen_travel_m, double share_of_peak);

private:
    double target_;
    double relative_target_;
    double height_m_;
    double travel_time_;
    double near_N_;         ///< load from which an unstable crack may be the strength
    double local_events_;   ///< targets that the total R* may reach while the typical body is in balance
    double largest_force_N_;
    std::array<double, 3> recent_{};   ///< total R* of the last blocks, the oldest first
};

/// Lets the loading mode B follow the damaged body. The body's mean motion over about one travel time of a wave is, per unit of
/// platen travel, what B should be; blending it in leaves every velocity as it is and only changes what the damping calls a
/// deviation. Windows with a crack in them count too: a B that nobody corrects drags on the body for good, and holds the unbalanced
/// force where no window would ever be quiet again. What a crack moved is no motion of the loading, so a mode is bounded.
class LoadingModeUpdate {
public:
    /// @param travel_time  of a wave over the height, in steps: the window
    explicit LoadingModeUpdate(double travel_time) : window_(travel_time) {}

    /// To be called after every block of steps.
    void observe(Assembly& assembly, long long step, double platen_travel_m);

private:
    void begin(const Assembly& assembly, long long step, double platen_travel_m);

    double window_;
    long long start_step_ = -1;
    double start_travel_m_ = 0.0;
    Array<Vec2> start_displacement_m_;
};

}  // namespace feldspar
