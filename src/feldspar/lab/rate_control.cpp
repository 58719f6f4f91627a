#include "feldspar/lab/rate_control.hpp"

#include <algorithm>
#include <cmath>

#include "feldspar/base/median.hpp"
#include "feldspar/lab/body_energy.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

// How much a block of steps may change the speed. The whole body takes part in the change, so it may be fast: while an unstable
// crack grows the platens should be nearly at rest, and afterwards every step at low speed is lost time.
constexpr double kMostSlowing = 0.4;
constexpr double kMostHastening = 1.1;
// A crack that runs away shows by R* growing faster than the speed ever does; waiting for the target costs half a percent of
// strength.
constexpr double kRunningAway = 1.5, kSeen = 0.5;  // growth in three blocks; targets below which it is not looked at
// Shares of the fastest speed: below the first a platen counts as at rest, and from there it sets out again.
constexpr double kRest = 0.01;
constexpr double kStart = 0.1;
// Where nothing is out of balance the record still has to resolve the load: by a fiftieth from row to row.
constexpr double kLoadPerStep = 2e-3;
// Targets that the total R* may reach while the typical body is in balance: a few bodies beside a crack ring whatever the speed
// is.
constexpr double kLocalEvents = 10.0;
constexpr double kTeaches = 1e-4;  // growth of the travel in a window that shows how the body moves with the platens
constexpr double kBlend = 0.5;     // of the newly observed loading mode
constexpr double kMostMode = 1.5;  // platen travels that a node may move per platen travel, as the loading mode counts it

// The load's growth in a travel time with which the strength is first looked for, over the wanted accuracy. What that misses is
// found by the passages after the first (load.cpp), which cost a tenth of the load; so the first one is quick.
constexpr double kGrowth = 60.0, kMostGrowth = 0.6;

}  // namespace

double residual_target(const NumericsSpec& numerics, MethodId kind) {
    return numerics.residual_target.value_or(method_of(kind).rate.residual_target * numerics.accuracy);
}

double accuracy_of(double residual_target, MethodId kind) { return residual_target / method_of(kind).rate.residual_target; }

PassageLimits first_passage(const NumericsSpec& numerics, MethodId kind) {
    const double target = residual_target(numerics, kind);
    return {target, std::min(kMostGrowth, kGrowth * accuracy_of(target, kind))};
}

Unbalanced unbalanced(const Assembly& assembly) {
    std::vector<double> of_bodies = unbalanced_forces(assembly);
    Unbalanced sum;
    for (const double force : of_bodies) sum.total_N += force;
    while (!of_bodies.empty() && assembly.bodies[of_bodies.size() - 1].kind == BodyKind::plate)
        of_bodies.pop_back();  // plates stand at the end
    if (of_bodies.empty()) return sum;
    sum.typical_N = upper_median(of_bodies) * static_cast<double>(of_bodies.size());
    return sum;
}

double RateControl::fastest(double platen_travel_m) const {
    return platen_travel_m * std::min(limits_.growth / travel_time_, kLoadPerStep);
}

double RateControl::start(double platen_travel_m) const { return kStart * fastest(platen_travel_m); }

double RateControl::next(double speed, const Unbalanced& unbalanced, double platen_force_N, double platen_travel_m,
                         double slowest_growth) {
    largest_force_N_ = std::max(largest_force_N_, platen_force_N);
    const double load_N = std::max(platen_force_N, 0.5 * largest_force_N_);
    const double now = std::max(unbalanced.typical_N, unbalanced.total_N / kLocalEvents) / load_N;
    const double total = unbalanced.total_N / load_N;
    const bool running_away = recent_[0] > 0.0 && total > kRunningAway * recent_[0] && total > kSeen * limits_.residual;
    recent_ = {recent_[1], recent_[2], total};
    residual_ = now;
    const double most = fastest(platen_travel_m), rest = kRest * most,
                 least = std::min(most, slowest_growth * platen_travel_m / travel_time_);
    const double wanted =
        now > 0.0 ? std::clamp(std::sqrt(limits_.residual / now), kMostSlowing, kMostHastening) : kMostHastening;
    const double factor = running_away ? kMostSlowing : wanted;
    const double next = factor < 1.0 ? (speed * factor < rest ? 0.0 : speed * factor) : std::max(speed, rest) * factor;
    return std::clamp(next, least, most);
}

void LoadingModeUpdate::begin(const Assembly& assembly, long long step, double platen_travel_m) {
    start_step_ = step;
    start_travel_m_ = platen_travel_m;
    start_displacement_m_ = assembly.nodes.displacement;
}

void LoadingModeUpdate::observe(Assembly& assembly, long long step, double platen_travel_m, bool both_ways) {
    if (start_step_ < 0) return begin(assembly, step, platen_travel_m);
    if (static_cast<double>(step - start_step_) < window_) return;
    if (platen_travel_m > start_travel_m_ + kTeaches * platen_travel_m ||
        (both_ways && platen_travel_m < start_travel_m_ - kTeaches * start_travel_m_)) {
        const double per_travel = 1.0 / (platen_travel_m - start_travel_m_);
        const auto bounded = [](double mode) { return std::clamp(mode, -kMostMode, kMostMode); };
        Nodes& nodes = assembly.nodes;
        for (int n = 0; n < nodes.count(); ++n) {
            const Vec2 mean = per_travel * (nodes.displacement[n] - start_displacement_m_[n]);
            if (nodes.inverse_mass[n].x != 0.0) nodes.loading_mode[n].x += kBlend * (bounded(mean.x) - nodes.loading_mode[n].x);
            if (nodes.inverse_mass[n].y != 0.0) nodes.loading_mode[n].y += kBlend * (bounded(mean.y) - nodes.loading_mode[n].y);
        }
    }
    begin(assembly, step, platen_travel_m);
}

}  // namespace feldspar
