#include "feldspar/specimen/fire.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace feldspar {
namespace {

/// A disc held by six others has omega^2 of about 6, and the largest of an assembly stays below 12: a time step of 0.4 keeps
/// clear of the limit 2 / omega.
constexpr double longest_step = 0.4;
constexpr double first_mixing = 0.1;
constexpr int patience = 5;   // steps downhill before the time step grows

}  // namespace

/// The motion goes uphill: starts again from rest.
void Fire::slow_down(std::span<Vec2> points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (limits_.steps_back && steps_downhill_ > 0) points[i] -= (0.5 * time_step_) * velocity_[i];
        velocity_[i] = {};
    }
    steps_downhill_ = 0;
    time_step_ = std::max(0.5 * time_step_, limits_.shortest_step);
    mixing_ = first_mixing;
}

void Fire::advance(std::span<Vec2> points, std::span<const Vec2> forces) {
    assert(points.size() == velocity_.size() && forces.size() == velocity_.size());
    double power = 0.0, speed2 = 0.0, force2 = 0.0;
    for (std::size_t i = 0; i < forces.size(); ++i) power += dot(forces[i], velocity_[i]);
    if (power > 0.0) {
        if (++steps_downhill_ > patience) {
            time_step_ = std::min(1.1 * time_step_, longest_step);
            mixing_ *= 0.99;
        }
    } else {
        slow_down(points);
    }
    for (std::size_t i = 0; i < forces.size(); ++i) {
        velocity_[i] += time_step_ * forces[i];
        speed2 += dot(velocity_[i], velocity_[i]);
        force2 += dot(forces[i], forces[i]);
    }
    const double turn = force2 > 0.0 ? mixing_ * std::sqrt(speed2 / force2) : 0.0;
    const double farthest = limits_.farthest_move_m;
    for (std::size_t i = 0; i < forces.size(); ++i) {
        velocity_[i] = (1.0 - mixing_) * velocity_[i] + turn * forces[i];
        Vec2 move = time_step_ * velocity_[i];
        const double length2 = dot(move, move);
        if (length2 > farthest * farthest) move *= farthest / std::sqrt(length2);
        points[i] += move;
    }
}

}  // namespace feldspar
