#include "feldspar/lab/brazilian_failure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "feldspar/base/angle.hpp"
#include "feldspar/lab/disc_splitting.hpp"
#include "feldspar/methods/flattened_disc.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

double radius_of(Vec2 place, const LoadedDisc& disc) { return norm(place - disc.centre) / disc.radius_m; }

double angle_deg_of(Vec2 place, const LoadedDisc& disc) {
    const Vec2 from_centre = place - disc.centre;
    return in_degrees(std::atan2(from_centre.x, from_centre.y));
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
    if (disc->flat_height_m > 0.0)
        failure.flat_coefficient = flat_coefficient(*result.specimen, result.model, result.grain, result.contact, result.test);
    if (const Crack* first = first_crack(result)) {
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

std::vector<BrazilianMark> brazilian_marks(const TestResult& result) {
    std::vector<std::pair<long long, BrazilianMark>> found;  // with the step
    const auto at_row = [&](const char* name, std::size_t row) {
        const HistoryRow& r = result.history[row];
        found.push_back({r.step, {name, r.axial_strain, r.axial_stress_Pa, -1}});
    };
    const auto at_crack = [&](const char* name, std::size_t c) {
        const Crack& crack = result.cracks[c];
        found.push_back({crack.step, {name, crack.axial_strain, crack.axial_stress_Pa, static_cast<int>(c)}});
    };
    const auto peak = find_peak(result);
    if (!peak || method_of(result.test).reading != Reading::disc) return {};
    if (const Crack* first = first_crack(result)) at_crack("first crack", static_cast<std::size_t>(first - result.cracks.data()));
    if (const auto dip = first_dip(result)) at_row("first dip", dip->row);
    const auto splitting = splitting_crack(result);
    if (const auto begin = splitting ? splitting->begin() : std::nullopt) {
        const auto same = [&](const Crack& c) {
            return c.step == begin->step && c.contact == begin->contact && c.point == begin->point;
        };
        at_crack(
            splitting->split() ? "start of the splitting crack" : "start of the longest crack",
            static_cast<std::size_t>(std::find_if(result.cracks.begin(), result.cracks.end(), same) - result.cracks.begin()));
    }
    at_row("strength", peak->row);
    const double largest = largest_stress(result);
    const auto is_largest = [&](const HistoryRow& r) { return r.phase != Phase::consolidation && r.axial_stress_Pa == largest; };
    const auto row = std::find_if(result.history.begin(), result.history.end(), is_largest);
    if (largest > peak->stress_Pa && row != result.history.end())
        at_row("largest stress", static_cast<std::size_t>(row - result.history.begin()));
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<BrazilianMark> marks;
    for (auto& [step, mark] : found) marks.push_back(std::move(mark));
    return marks;
}

double tension_under_arcs(double arc_deg) {
    const double arc = in_radians(arc_deg);
    return arc > 0.0 ? 2.0 * std::sin(arc) / arc - 1.0 : 1.0;
}

std::string validity_in_words(const BrazilianFailure& failure) {
    if (failure.valid) return "yes";
    if (!failure.split) return "no: not split";
    return fmt::format("no: split from r/R {:.2f}", failure.splitting_radius);
}

std::string start_remark(const TestResult& result, const Peak& peak) {
    if (method_of(result.test).reading != Reading::disc || !loaded_disc(result)) return {};
    const BrazilianFailure failure = brazilian_failure(result, peak);
    if (!failure.split) return " The disc was not split: the strength is a lower bound.";
    if (failure.valid) return {};
    return fmt::format(
        " Not a centre start: the crack that split the disc began at r/R {:.2f}, at {:.0f} % of the strength, under arcs of "
        "contact of {:.1f} and {:.1f} degrees.",
        failure.splitting_radius, 100.0 * failure.splitting_share, failure.contact_arc_top_deg, failure.contact_arc_bottom_deg);
}

}  // namespace feldspar
