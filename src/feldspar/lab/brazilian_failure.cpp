#include "feldspar/lab/brazilian_failure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "feldspar/lab/disc_splitting.hpp"

namespace feldspar {
namespace {

double radius_of(Vec2 place, const LoadedDisc& disc) { return norm(place - disc.centre) / disc.radius_m; }

double angle_deg_of(Vec2 place, const LoadedDisc& disc) {
    const Vec2 from_centre = place - disc.centre;
    return std::atan2(from_centre.x, from_centre.y) * 180.0 / std::numbers::pi;
}

}  // namespace

BrazilianFailure brazilian_failure(const TestResult& result, const Peak& peak) {
    BrazilianFailure failure;
    failure.largest_Pa = largest_stress(result);
    if (const auto dip = first_dip(result)) failure.first_dip_Pa = dip->stress_Pa;
    failure.contact_arc_top_deg = result.history[peak.row].contact_arc_top_deg;
    failure.contact_arc_bottom_deg = result.history[peak.row].contact_arc_bottom_deg;
    const auto disc = loaded_disc(result);
    if (!disc) return failure;
    const auto first = std::min_element(result.cracks.begin(), result.cracks.end(), [](const Crack& a, const Crack& b) { return a.step < b.step; });
    if (first != result.cracks.end()) {
        failure.first_crack_radius = radius_of(first->place, *disc);
        failure.first_crack_angle_deg = angle_deg_of(first->place, *disc);
        failure.first_crack_share = first->axial_stress_Pa / peak.stress_Pa;
    }
    const auto splitting = splitting_crack(result);
    failure.split = splitting->split();
    failure.crack_span = splitting->span();
    if (const auto begin = splitting->begin()) {
        failure.splitting_radius = radius_of(begin->place, *disc);
        failure.splitting_angle_deg = angle_deg_of(begin->place, *disc);
        failure.splitting_share = begin->axial_stress_Pa / peak.stress_Pa;
        failure.valid = failure.split && failure.splitting_radius <= central_part;
    }
    return failure;
}

std::string start_remark(const TestResult& result, const Peak& peak) {
    if (result.test.kind != TestKind::brazilian || !loaded_disc(result)) return {};
    const BrazilianFailure failure = brazilian_failure(result, peak);
    if (!failure.split) return " The disc was not split: the strength is a lower bound.";
    if (failure.valid) return {};
    return fmt::format(" Not a centre start: the crack that split the disc began at r/R {:.2f}, at {:.0f} % of the strength, under arcs of contact of {:.1f} and {:.1f} degrees.",
                       failure.splitting_radius, 100.0 * failure.splitting_share, failure.contact_arc_top_deg, failure.contact_arc_bottom_deg);
}

}  // namespace feldspar
