#include "feldspar/lab/servo.hpp"

#include <algorithm>
#include <cmath>

namespace feldspar {
namespace {

constexpr double kSmoothing = 0.1;    // travel times over which the growth is averaged: a burst of cracks is shorter than that
constexpr double kFastestBack = 4.0;  // times the speed with which the platen would go forward if nothing failed
constexpr double kArrest =
    8.0;  // times the failure under way, relative to the limit: at half of the limit it goes back as fast as it may
constexpr double kFails = 0.25;  // of the limit: with less the low stress is that of an unloaded body

}  // namespace

void Servo::observe(const HistoryRow& row, int steps) {
    if (!on()) return;
    if (!observed_) lateral_origin_ = row.lateral_strain_gauge;
    double quantity = row.energy.fracture + row.energy.friction, scale = row.energy.elastic_grains + row.energy.elastic_contacts;
    if (control_ == LoadControl::lateral_strain) quantity = scale = lateral_origin_ - row.lateral_strain_gauge;
    if (control_ == LoadControl::gauge) quantity = scale = std::abs(row.gauges[gauge_]);
    if (observed_ && scale > 0.0) {
        const double now = (quantity - before_) / scale * travel_time_ / (share_ * steps);
        growth_ += std::min(1.0, steps / (kSmoothing * travel_time_)) * (now - growth_);
    }
    observed_ = true;
    before_ = quantity;
}

double Servo::speed(double platen_travel_m) const {
    return share_ * platen_travel_m / travel_time_ * std::clamp(1.0 - growth_, -kFastestBack, 1.0);
}

double Servo::arrest(double platen_travel_m) const {
    return share_ * platen_travel_m / travel_time_ * std::clamp(kArrest * growth_, 0.0, kFastestBack);
}

bool Servo::unloading() const { return on() && growth_ < kFails; }

}  // namespace feldspar
