// FIRE, the fast inertial relaxation engine: finds the nearest minimum of an energy by damped motion.
#pragma once

#include <span>
#include <vector>

#include "feldspar/base/parallel.hpp"
#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// What one use of FIRE has of its own.
struct FireLimits {
    double shortest_step = 0.01;   ///< unit of time (that of unit mass and stiffness), from 0 to the longest step of 0.4
    bool steps_back = true;        ///< where the motion has turned uphill: go back by half a step before starting again
    double farthest_move_m = 0.0;  ///< of a point in one step (> 0)
    bool forget_speed = false;     ///< a point that would move farther keeps only the speed of the farthest move
};

/// Points of unit mass under forces whose stiffness is of the order of 1, so that a force is a length (m). They move by
/// themselves; as long as the motion goes downhill its velocity is turned towards the force and its time step grows, and when it
/// goes uphill it starts again from rest with a shorter step (Bitzek et al., Phys. Rev. Lett. 97, 170201, 2006, with the paper's
/// constants). The state is kept between calls, also where the caller has changed the forces' law in between.
/// Sums run over the points in their order: same input, same bits, for any number of threads.
class Fire {
public:
    Fire(std::size_t points, const FireLimits& limits) : limits_(limits), velocity_(points) {}

    /// Moves the points by one step under the forces that act at their present places. A force of zero keeps a point where it is
    /// as long as it has had none before.
    /// @param forces  m, as many as there are points
    /// @param team    to share the work with, if any
    void advance(std::span<Vec2> points, std::span<const Vec2> forces, Team* team = nullptr);

private:
    void slow_down(std::span<Vec2> points);
    void move(std::span<Vec2> points, std::span<const Vec2> forces, double turn, IndexRange range);

    FireLimits limits_;
    std::vector<Vec2> velocity_;  ///< m per unit of time
    double time_step_ = 0.1;
    double mixing_ = 0.1;  ///< share of the velocity that is turned into the direction of the force
    int steps_downhill_ = 0;
};

}  // namespace feldspar
