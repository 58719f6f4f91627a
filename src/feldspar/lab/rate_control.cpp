#include "feldspar/lab/rate_control.hpp"

#include <algorithm>
#include <cmath>

#include "feldspar/lab/body_energy.hpp"

namespace feldspar {
namespace {

// How much a block of steps may change the speed. The whole body takes the change along, so it may be quick: a crack that runs away
// is to find the platens nearly at rest, and when it has stopped the time at low speed is lost.
constexpr double kMostSlowing = 0.4;
constexpr double kMostHastening = 1.1;
// A crack that runs away shows by R* growing faster than the speed ever does; waiting for the target costs half a percent of strength.
constexpr double kRunningAway = 1.5, kSeen = 0.5;   // growth in three blocks; targets below which it is not looked at
// A local crack rings for a travel time whatever the speed is. If the load changes by no more than this share meanwhile, going
// slower does not change what the crack does. At an accuracy of 0.5 %; it grows with the target, and no further than the last: at three
// times that a Brazilian test with the brittle law ran through its strength.
constexpr double kLoadWhileCracking = 0.005, kMostLoadWhileCracking = 0.01;
// Where nothing is out of balance the record still has to resolve the load: by a fiftieth from row to row.
constexpr double kLoadPerStep = 2e-3;
// An unstable crack takes a part of a travel time to show. Where the first one may be the strength (shares of the expected one; discs
// split from a half to above one), the load must not rise by more than this share in a travel time before it is seen.
constexpr double kNearStrength = 0.9, kNearBrazilianStrength = 0.3, kLoadBeforeItShows = 0.05;
// Heights a step after the peak: neither crawling beside a dynamic failure nor racing down a soft branch. The lower one as long as
// the load may rise to a new peak.
constexpr double kSpeedAfterPeak = 1e-7, kSpeedFarAfterPeak = 3e-7;
constexpr double kPastPeak = 0.98, kFarPastPeak = 0.95;   // shares of the peak
constexpr double kFailing = 0.02;   // R* of a body that fails dynamically whatever the speed
// Targets that the total R* may reach while the typical body is in balance. Crushed grains under a Brazilian plate rattle for the rest of
// the test.
constexpr double kLocalEvents = 2.0, kBrazilianLocalEvents = 20.0;
constexpr double kBlend = 0.5;   // of the newly observed loading mode
constexpr double kMostMode = 1.5;   // platen travels that a node may move per platen travel, as the loading mode counts it

}  // namespace


namespace {

// Target at an accuracy of 0.5 %, and the power by which it follows the accuracy. Two measured pairs (accuracy, R*) each; ln 2 / ln 4
// and ln 3 / ln 4 are the powers through them.
struct TargetLaw {
    double target, power;
};

TargetLaw target_law(TestKind kind, GrainKind grains) {
    return kind == TestKind::brazilian && grains != GrainKind::rigid ? TargetLaw{1e-2, 0.7925} : TargetLaw{5e-3, 0.5};
}

}  // namespace

double residual_target(const NumericsSpec& numerics, TestKind kind, GrainKind grains) {
    if (numerics.residual_target) return *numerics.residual_target;
    const TargetLaw law = target_law(kind, grains);
    return law.target * std::pow(numerics.accuracy / 0.005, law.power);
}

double accuracy_of(double residual_target, TestKind kind, GrainKind grains) {
    const TargetLaw law = target_law(kind, grains);
    return 0.005 * std::pow(residual_target / law.target, 1.0 / law.power);
}

double expected_strength(const ContactMaterial& contact, const TestSpec& test) {
    if (test.kind == TestKind::direct_tension || test.kind == TestKind::brazilian) return contact.sigma_nt_Pa;
    const double root_N = contact.mu + std::sqrt(1.0 + contact.mu * contact.mu);
    return 2.0 * contact.tau_Pa * root_N + root_N * root_N * test.sigma3_Pa;
}

Unbalanced unbalanced(const Assembly& assembly) {
    std::vector<double> of_bodies = unbalanced_forces(assembly);
    Unbalanced sum;
    for (const double force : of_bodies) sum.total_N += force;
    while (!of_bodies.empty() && assembly.bodies[of_bodies.size() - 1].kind == BodyKind::plate) of_bodies.pop_back();   // plates stand at the end
    if (of_bodies.empty()) return sum;
    const auto middle = of_bodies.begin() + static_cast<std::ptrdiff_t>(of_bodies.size() / 2);
    std::nth_element(of_bodies.begin(), middle, of_bodies.end());
    sum.typical_N = *middle * static_cast<double>(of_bodies.size());
    return sum;
}

RateControl::RateControl(TestKind kind, double target, double relative_target, double height_m, double travel_time, double expected_N)
    : target_(target),
      relative_target_(relative_target),
      height_m_(height_m),
      travel_time_(travel_time),
      near_N_((kind == TestKind::brazilian ? kNearBrazilianStrength : kNearStrength) * expected_N),
      local_events_(kind == TestKind::brazilian ? kBrazilianLocalEvents : kLocalEvents),
      largest_force_N_(expected_N) {}

double RateControl::next(double speed, const Unbalanced& unbalanced, double platen_force_N, double platen_travel_m, double share_of_peak) {
    largest_force_N_ = std::max(largest_force_N_, platen_force_N);
    const double load_N = std::max(platen_force_N, 0.5 * largest_force_N_);
    const double now = std::max(unbalanced.typical_N, unbalanced.total_N / local_events_) / load_N;
    const double total = unbalanced.total_N / load_N;
    const bool running_away = recent_[0] > 0.0 && total > kRunningAway * recent_[0] && total > kSeen * target_;
    recent_ = {recent_[1], recent_[2], total};
    const double wanted = now > 0.0 ? std::clamp(std::sqrt(target_ / now), kMostSlowing, kMostHastening) : kMostHastening;
    const double factor = running_away ? kMostSlowing : wanted;
    // Once the specimen fails by itself, crawling does not help; a branch that softens quietly stays under control.
    const bool past_peak = share_of_peak < kPastPeak, failing = past_peak && total > kFailing;
    const double per_travel_time = platen_travel_m / travel_time_;
    const double share = std::min(relative_target_ * kLoadWhileCracking, kMostLoadWhileCracking);
    const double crawling = std::max(relative_target_ * 6e-9 * height_m_, share * per_travel_time);
    const double after_peak = (share_of_peak < kFarPastPeak ? kSpeedFarAfterPeak : kSpeedAfterPeak) * height_m_;
    const double slowest = failing ? std::max(crawling, after_peak) : crawling;
    double fastest = std::min(0.4 * per_travel_time, relative_target_ * kLoadPerStep * platen_travel_m);
    if (platen_force_N > near_N_) fastest = std::min(fastest, relative_target_ * kLoadBeforeItShows * per_travel_time);
    if (past_peak) fastest = std::min(fastest, after_peak);
    return std::clamp(speed * factor, slowest, std::max(slowest, fastest));
}

void LoadingModeUpdate::begin(const Assembly& assembly, long long step, double platen_travel_m) {
    start_step_ = step;
    start_travel_m_ = platen_travel_m;
    start_displacement_m_ = assembly.nodes.displacement;
}

void LoadingModeUpdate::observe(Assembly& assembly, long long step, double platen_travel_m) {
    if (start_step_ < 0) return begin(assembly, step, platen_travel_m);
    if (static_cast<double>(step - start_step_) < window_) return;
    if (platen_travel_m > start_travel_m_) {
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
