#include "feldspar/methods/notched.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace feldspar {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double kHalf = 0.5;  // of the largest load: where the stiffness is read
constexpr double kWholeCurve =
    0.11;  // share of the largest load below which a record has the whole work of fracture (it ends at 0.1)
constexpr double kTipReach = 1.0;  // mean grains

}  // namespace

double load_N(const MethodReading& reading, const HistoryRow& row) { return row.axial_stress_Pa * reading.result.section_m2; }

double secant_N_m(const MethodReading& reading, std::string_view gauge) {
    const int g = gauge_number(reading.result.gauges, gauge);
    if (g < 0) return nan;
    for (std::size_t i = 0; i <= reading.peak_row; ++i) {
        const HistoryRow& row = reading.result.history[i];
        if (row.axial_stress_Pa < kHalf * reading.peak_Pa || !(row.gauges[g] > 0.0)) continue;
        return load_N(reading, row) / row.gauges[g];
    }
    return nan;
}

double work_of_fracture_J_m2(const MethodReading& reading, double ligament_m, double thickness_m) {
    const HistoryRow& last = reading.result.history.back();
    if (last.axial_stress_Pa > kWholeCurve * reading.peak_Pa) return nan;
    return last.energy.supplied() / (ligament_m * thickness_m);
}

double softening_length_m(const MethodReading& reading, double E_Pa) {
    const ContactMaterial& contact = reading.result.contact;
    const double modulus_Pa = std::isfinite(E_Pa) ? E_Pa : reading.result.grain.E_Pa;
    if (contact.law == ContactLaw::brittle || !(modulus_Pa > 0.0)) return nan;
    return modulus_Pa * contact.Gfn_J_m2 / (contact.sigma_nt_Pa * contact.sigma_nt_Pa);
}

double length_of_cracks_m(const MethodReading& reading) {
    double length = 0.0;
    for (const Crack& crack : reading.result.cracks) length += norm(crack.to - crack.from);
    return length;
}

double main_crack_m(const MethodReading& reading, Vec2 tip) {
    const double grain_m = reading.result.specimen->quality.mean_diameter_m;
    return chain_of_cracks_m(reading.result.cracks, tip, grain_m, kTipReach * grain_m);
}

// Dijkstra over the ends of the cracks: from one end of a crack to its other, and from an end to those within a quarter of a
// grain.
double chain_of_cracks_m(std::span<const Crack> cracks, Vec2 tip, double grain_m, double reach_m) {
    constexpr double kBridged = 0.25;  // as in the crack that splits a disc (P26)
    const std::size_t ends = 2 * cracks.size();
    const auto place = [&](std::size_t end) { return end % 2 == 0 ? cracks[end / 2].from : cracks[end / 2].to; };
    std::vector<double> way(ends, std::numeric_limits<double>::infinity());
    for (std::size_t end = 0; end < ends; ++end)
        if (const double apart = norm(place(end) - tip); apart <= reach_m) way[end] = apart;
    std::vector<char> done(ends, 0);
    double highest = tip.y, length = 0.0;
    for (;;) {
        std::size_t next = ends;
        for (std::size_t end = 0; end < ends; ++end)
            if (done[end] == 0 && std::isfinite(way[end]) && (next == ends || way[end] < way[next])) next = end;
        if (next == ends) return length;
        done[next] = 1;
        if (place(next).y > highest) {
            highest = place(next).y;
            length = way[next];
        }
        for (std::size_t end = 0; end < ends; ++end) {
            const double apart = norm(place(end) - place(next));
            if (end / 2 == next / 2 || apart <= kBridged * grain_m) way[end] = std::min(way[end], way[next] + apart);
        }
    }
}

}  // namespace feldspar
