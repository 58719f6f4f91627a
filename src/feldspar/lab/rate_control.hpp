// The automatic loading rate: accuracy in, speed out (docs/theory/loading.md).
#pragma once

#include <array>
#include <vector>

#include "feldspar/methods/test_spec.hpp"
#include "feldspar/model/assembly.hpp"

namespace feldspar {

/// Target of R* with which a strength is first looked for, from the wanted relative accuracy; or what the user gives in its
/// place.
double residual_target(const NumericsSpec& numerics, MethodId kind);

/// The accuracy that has this target: the inverse of residual_target().
double accuracy_of(double residual_target, MethodId kind);

/// How fast the load may pass: both limits fall together when a passage was too fast.
struct PassageLimits {
    double residual = 0.0;  ///< target of R*
    double growth = 0.0;    ///< of the platen travel in a travel time of a wave, relative to the travel so far
};

/// Of the first passage: wide, so that it is quick.
PassageLimits first_passage(const NumericsSpec& numerics, MethodId kind);

/// What the free degrees of freedom leave unbalanced, sums of |F|.
struct Unbalanced {
    double total_N = 0.0;
    double typical_N = 0.0;  ///< of the median body (plates apart), times the number of bodies: what the total would be without
                             ///< the few bodies beside a running crack, or that rattle in crushed rock whatever the speed is
};

Unbalanced unbalanced(const Assembly& assembly);

/// Adjusts the platen speed every few steps so that the unbalanced force stays at its target: down to rest while the typical body
/// is out of balance, so that an unstable crack runs out at a platen that stands still. It knows no strength and no length: only
/// the travel so far, the time in which a wave crosses the specimen, and its limits.
class RateControl {
public:
    /// @param travel_time  of a wave over the height, in steps
    RateControl(PassageLimits limits, double travel_time) : limits_(limits), travel_time_(travel_time) {}

    /// @param platen_travel_m  where loading begins
    double start(double platen_travel_m) const;

    /// @param speed              now, m a step
    /// @param platen_force_N     mean of both platens, magnitude
    /// @param platen_travel_m    so far
    /// @param slowest_growth     at least so much of the travel in a travel time of a wave, whatever is out of balance
    /// @return the speed for the next steps
    double next(double speed, const Unbalanced& unbalanced, double platen_force_N, double platen_travel_m,
                double slowest_growth = 0.0);

    /// Whether the typical body was within the target when next() was asked last.
    bool balanced() const { return residual_ <= limits_.residual; }

    /// R* of the typical body then, relative to the load.
    double residual() const { return residual_; }

    void set_limits(PassageLimits limits) { limits_ = limits; }

    template <class Archive>
    void keep(Archive& archive) {
        auto& [limits, travel_time, largest_force, residual, recent] = *this;
        archive(limits, travel_time, largest_force, residual, recent);
    }

private:
    double fastest(double platen_travel_m) const;

    PassageLimits limits_;
    double travel_time_;
    double largest_force_N_ = 0.0;
    double residual_ = 0.0;
    std::array<double, 3> recent_{};  ///< total R* of the last blocks, the oldest first
};

/// Lets the loading mode B follow the damaged body. The body's mean motion over about one travel time of a wave is, per unit of
/// platen travel, what B should be; blending it in leaves every velocity as it is and only changes what the damping calls a
/// deviation. Windows with a crack in them count too: a B that nobody corrects drags on the body for good, and holds the
/// unbalanced force where no window would ever be quiet again. What a crack moved is no motion of the loading, so a mode is
/// bounded.
class LoadingModeUpdate {
public:
    /// @param travel_time  of a wave over the height, in steps: the window
    explicit LoadingModeUpdate(double travel_time) : window_(travel_time) {}

    /// To be called after every block of steps.
    /// @param both_ways  a window in which the platen went back teaches too
    void observe(Assembly& assembly, long long step, double platen_travel_m, bool both_ways = false);

    /// The window under way does not count: the loading turns.
    void forget() { start_step_ = -1; }

    template <class Archive>
    void keep(Archive& archive) {
        auto& [window, start_step, start_travel, start_displacement] = *this;
        archive(window, start_step, start_travel, start_displacement);
    }

private:
    void begin(const Assembly& assembly, long long step, double platen_travel_m);

    double window_;
    long long start_step_ = -1;
    double start_travel_m_ = 0.0;
    Array<Vec2> start_displacement_m_;
};

}  // namespace feldspar
