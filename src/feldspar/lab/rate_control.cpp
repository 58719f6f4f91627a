#include "feldspar/lab/rate_control.hpp"

#include <algorithm>
#include <cmath>

namespace feldspar {
namespace {

// How much a block of steps may change the speed. An event's waves take a hundred steps to be damped whatever the speed does, so
// falling faster than this only throws away what has to be climbed again.
constexpr double kMostSlowing = 0.85;
constexpr double kMostHastening = 1.06;
// A local crack rings for a travel time whatever the speed is. If the load changes by no more than this share meanwhile, going
// slower does not change what the crack does. At an accuracy of 0.5 %; it grows with the target, and no further than this: at three
// times the limit a Brazilian test with the brittle law ran through its strength.
constexpr double kLoadWhileCracking = 0.0025, kMostLoadWhileCracking = 0.01;
// Where nothing is out of balance the record still has to resolve the load: by a hundredth from row to row.
constexpr double kLoadPerStep = 1e-3;
constexpr double kSpeedAfterPeak = 1e-7;   // heights a step: neither crawling beside a dynamic failure nor racing down a soft branch
constexpr double kFailing = 0.02;   // R* of a body that fails dynamically whatever the speed
constexpr double kBlend = 0.5;   // of the newly observed loading mode

}  // namespace


double residual_target(const NumericsSpec& numerics, TestKind kind, GrainKind grains) {
    if (numerics.residual_target) return *numerics.residual_target;
    // Two measured pairs (accuracy, R*) each; ln 2 / ln 4 and ln 3 / ln 4 are the powers through them.
    const double relative = numerics.accuracy / 0.005;
    return kind == TestKind::brazilian && grains != GrainKind::rigid ? 1e-2 * std::pow(relative, 0.7925) : 5e-3 * std::sqrt(relative);
}

double expected_strength(const ContactMaterial& contact, const TestSpec& test) {
    if (test.kind == TestKind::direct_tension || test.kind == TestKind::brazilian) return contact.sigma_nt_Pa;
    const double root_N = contact.mu + std::sqrt(1.0 + contact.mu * contact.mu);
    return 2.0 * contact.tau_Pa * root_N + root_N * root_N * test.sigma3_Pa;
}

double RateControl::next(double speed, double unbalanced_N, double platen_force_N, double platen_travel_m, bool past_peak) {
    largest_force_N_ = std::max(largest_force_N_, platen_force_N);
    const double now = residual(unbalanced_N, platen_force_N);
    const double factor = now > 0.0 ? std::clamp(std::sqrt(target_ / now), kMostSlowing, kMostHastening) : kMostHastening;
    // Once the specimen fails by itself, crawling does not help; a branch that softens quietly stays under control.
    const bool failing = past_peak && now > kFailing;
    const double per_travel_time = platen_travel_m / travel_time_;
    const double share = std::min(relative_target_ * kLoadWhileCracking, kMostLoadWhileCracking);
    const double crawling = std::max(relative_target_ * 6e-9 * height_m_, share * per_travel_time);
    const double after_peak = kSpeedAfterPeak * height_m_;
    const double slowest = failing ? std::max(crawling, after_peak) : crawling;
    const double resolved = std::min(0.4 * per_travel_time, relative_target_ * kLoadPerStep * platen_travel_m);
    const double fastest = std::max(slowest, past_peak ? std::min(after_peak, resolved) : resolved);
    return std::clamp(speed * factor, slowest, fastest);
}

double RateControl::residual(double unbalanced_N, double platen_force_N) const {
    return unbalanced_N / std::max(platen_force_N, 0.5 * largest_force_N_);
}

void LoadingModeUpdate::begin(const Assembly& assembly, long long step, double platen_travel_m) {
    start_step_ = step;
    start_travel_m_ = platen_travel_m;
    largest_residual_ = 0.0;
    start_displacement_m_ = assembly.nodes.displacement;
}

void LoadingModeUpdate::observe(Assembly& assembly, long long step, double platen_travel_m, double residual) {
    if (start_step_ < 0) return begin(assembly, step, platen_travel_m);
    largest_residual_ = std::max(largest_residual_, residual);
    if (static_cast<double>(step - start_step_) < window_) return;
    if (largest_residual_ <= quiet_ && platen_travel_m > start_travel_m_) {
        const double per_travel = 1.0 / (platen_travel_m - start_travel_m_);
        Nodes& nodes = assembly.nodes;
        for (int n = 0; n < nodes.count(); ++n) {
            const Vec2 mean = per_travel * (nodes.displacement[n] - start_displacement_m_[n]);
            if (nodes.inverse_mass[n].x != 0.0) nodes.loading_mode[n].x += kBlend * (mean.x - nodes.loading_mode[n].x);
            if (nodes.inverse_mass[n].y != 0.0) nodes.loading_mode[n].y += kBlend * (mean.y - nodes.loading_mode[n].y);
        }
    }
    begin(assembly, step, platen_travel_m);
}

}  // namespace feldspar
