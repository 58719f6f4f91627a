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
constexpr int patience = 5;  // steps downhill before the time step grows

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

void Fire::move(std::span<Vec2> points, std::span<const Vec2> forces, double turn, IndexRange range) {
    const double farthest = limits_.farthest_move_m;
    for (int i = range.begin; i < range.end; ++i) {
        velocity_[i] = (1.0 - mixing_) * velocity_[i] + turn * forces[i];
        Vec2 move = time_step_ * velocity_[i];
        const double length2 = dot(move, move);
        if (length2 > farthest * farthest) {
            move *= farthest / std::sqrt(length2);
            if (limits_.forget_speed) velocity_[i] = (1.0 / time_step_) * move;
        }
        points[i] += move;
    }
}

void Fire::advance(std::span<Vec2> points, std::span<const Vec2> forces, Team* team) {
    assert(points.size() == velocity_.size() && forces.size() == velocity_.size());
    const int count = static_cast<int>(points.size());
    // The sums stay with one thread, so that their order is that of the points; they are a small part of a step.
    double power = 0.0, speed2 = 0.0, force2 = 0.0;
    for (int i = 0; i < count; ++i) {
        power += dot(forces[i], velocity_[i]);
        force2 += dot(forces[i], forces[i]);
    }
    if (power > 0.0) {
        if (++steps_downhill_ > patience) {
            time_step_ = std::min(1.1 * time_step_, longest_step);
            mixing_ *= 0.99;
        }
    } else {
        slow_down(points);
    }
    in_shares(team, count, [&](IndexRange range, int) {
        for (int i = range.begin; i < range.end; ++i) velocity_[i] += time_step_ * forces[i];
    });
    for (const Vec2 v : velocity_) speed2 += dot(v, v);
    const double turn = force2 > 0.0 ? mixing_ * std::sqrt(speed2 / force2) : 0.0;
    in_shares(team, count, [&](IndexRange range, int) { move(points, forces, turn, range); });
}

}  // namespace feldspar
