// Servo control of the platens behind the strength: by how fast the specimen fails, as stiff testing machines do it
// (docs/theory/loading.md).
#pragma once

#include "feldspar/methods/result.hpp"
#include "feldspar/methods/test_spec.hpp"

namespace feldspar {

/// At a growing platen displacement a brittle specimen falls by itself, dynamically, at any platen speed. The servo gives the
/// speed that lets it fail slowly instead: it goes back as fast as the failing body asks for. What it keeps constant is the
/// growth of one quantity relative to a scale, in a travel time of a wave: the work of fracture and friction relative to the
/// elastic energy, or the lateral strain or the reading of a gauge relative to itself.
class Servo {
public:
    /// @param control      dissipation, lateral strain or a gauge; with displacement the servo is off
    /// @param share        growth that is kept, in a travel time of a wave; > 0
    /// @param travel_time  of a wave over the height, steps
    /// @param gauge        which of the row's gauges controls, if one does
    Servo(LoadControl control, double share, double travel_time, std::size_t gauge = 0)
        : control_(control), share_(share), travel_time_(travel_time), gauge_(gauge) {}

    bool on() const { return control_ != LoadControl::displacement; }

    /// To be told of every row of loading. @param steps  since the row before
    void observe(const HistoryRow& row, int steps);

    /// What it lets the platen do, m a step; negative: back. @param platen_travel_m  so far
    double speed(double platen_travel_m) const;

    /// How fast the platen must go back so that the specimen stops to fail, m a step; 0 or more. Its speed() lets it fail slowly
    /// instead.
    double arrest(double platen_travel_m) const;

    /// Whether the specimen fails so slowly that a low stress is that of an unloaded body, not of a failed one.
    bool unloading() const;

    template <class Archive>
    void keep(Archive& archive) {
        auto& [control, share, travel_time, gauge, observed, lateral_origin, before, growth] = *this;
        archive(control, share, travel_time, gauge, observed, lateral_origin, before, growth);
    }

private:
    LoadControl control_;
    double share_, travel_time_;
    std::size_t gauge_;
    bool observed_ = false;
    double lateral_origin_ = 0.0;  // lateral strain where loading began
    double before_ = 0.0;          // the quantity in the row before
    double growth_ = 0.0;          // relative to its scale, in a travel time, over the share: smoothed; 1 = at the limit
};

}  // namespace feldspar
