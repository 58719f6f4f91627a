#include "feldspar/lab/bending.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "feldspar/lab/gauges.hpp"
#include "feldspar/methods/beam.hpp"
#include "feldspar/methods/half_disc.hpp"

namespace feldspar {
namespace {

constexpr double kHalf = 0.5;            // of the largest load: where the modulus is read
constexpr double kWholeCurve = 0.11;     // share of the largest load below which a record has the whole work of fracture (it ends at 0.1)

double load_N(const TestResult& result, const HistoryRow& row) { return row.axial_stress_Pa * result.section_m2; }

// Load over reading when the load first reaches half of the largest; not-a-number without the gauge.
double secant_N_m(const TestResult& result, const Peak& peak, std::string_view gauge) {
    const int g = gauge_number(result.gauges, gauge);
    if (g < 0) return BendingProperties::none;
    for (std::size_t i = 0; i <= peak.row; ++i) {
        const HistoryRow& row = result.history[i];
        if (row.axial_stress_Pa < kHalf * peak.stress_Pa || !(row.gauges[g] > 0.0)) continue;
        return load_N(result, row) / row.gauges[g];
    }
    return BendingProperties::none;
}

// Work that the loading has done until the end of the record: its elastic start, then the fixtures.
double work_J(const TestResult& result) { return result.history.back().energy.supplied(); }

// Length of all cracks (their shares of grain edges), over the ligament's.
double crack_path(const TestResult& result, double ligament_m) {
    double length = 0.0;
    for (const Crack& crack : result.cracks) length += norm(crack.to - crack.from);
    return length / ligament_m;
}

// The notch's tip may lie inside a grain, which the crack goes around.
constexpr double kTipReach = 1.0;   // mean grains

// (P40): what goes with the work of fracture of a notched specimen.
void add_fracture(const TestResult& result, const Peak& peak, Vec2 tip, double ligament_m, double thickness_m, BendingProperties& p) {
    const ContactMaterial& contact = result.contact;
    if (const double E_Pa = std::isfinite(p.E_Pa) ? p.E_Pa : result.grain.E_Pa; contact.law != ContactLaw::brittle && E_Pa > 0.0)
        p.softening_length_m = E_Pa * contact.Gfn_J_m2 / (contact.sigma_nt_Pa * contact.sigma_nt_Pa);
    p.crack_path_over_ligament = crack_path(result, ligament_m);
    const double grain_m = result.specimen->quality.mean_diameter_m;
    p.main_crack_over_ligament = chain_of_cracks_m(result.cracks, tip, grain_m, kTipReach * grain_m) / ligament_m;
    if (result.history.back().axial_stress_Pa <= kWholeCurve * peak.stress_Pa) p.work_of_fracture_J_m2 = work_J(result) / (ligament_m * thickness_m);
}

// Where a beam's E is that of a plate in plane stress, which E' of the closed forms is too.
double nu_of(const TestResult& result) { return result.model.kind == GrainKind::flexible ? result.grain.nu : 0.2; }

}  // namespace

BendingProperties bending(const TestResult& result, const Peak& peak) {
    BendingProperties p;
    if (!result.specimen) return p;
    const Beam beam = beam_of(result.specimen->outline, result.specimen->spec.thickness_m, result.test);
    const double largest_N = load_N(result, result.history[peak.row]), x = beam.notch_m / beam.height_m;
    p.notch_m = beam.notch_m;
    if (beam.otherwise_cut) return p;
    if (!beam.notched()) {
        p.flexural_strength_Pa = peak.stress_Pa;
        p.E_Pa = secant_N_m(result, peak, "deflection") * deflection_factor(beam, nu_of(result)) / beam.thickness_m;
        return p;
    }
    if (std::abs(beam.span_m / beam.height_m - mouth_span) <= mouth_span_tolerance * mouth_span)
        p.E_Pa = secant_N_m(result, peak, "CMOD") * mouth_factor(x) / beam.thickness_m;
    p.K_Ic_Pa_sqrt_m = largest_N * beam.span_m / (beam.thickness_m * std::pow(beam.height_m, 1.5)) * notch_factor(x, beam.height_m / beam.span_m);
    add_fracture(result, peak, {beam.middle_m, beam.bottom_m + beam.notch_m}, beam.ligament_m(), beam.thickness_m, p);
    return p;
}

// Dijkstra over the ends of the cracks: from one end of a crack to its other, and from an end to those within a quarter of a grain.
double chain_of_cracks_m(std::span<const Crack> cracks, Vec2 tip, double grain_m, double reach_m) {
    constexpr double kBridged = 0.25;   // as in the crack that splits a disc (P26)
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

BendingProperties half_disc_bending(const TestResult& result, const Peak& peak) {
    BendingProperties p;
    if (!result.specimen) return p;
    const HalfDisc disc = half_disc_of(result.specimen->outline, result.specimen->spec.thickness_m, result.test);
    const double largest_N = load_N(result, result.history[peak.row]);
    p.notch_m = disc.notch_m;
    p.K_Ic_Pa_sqrt_m = half_disc_factor(disc.beta(), disc.q()) * largest_N * std::sqrt(M_PI * disc.notch_m) / (2.0 * disc.radius_m * disc.thickness_m);
    add_fracture(result, peak, disc.middle + Vec2{0.0, disc.notch_m}, disc.ligament_m(), disc.thickness_m, p);
    return p;
}

std::vector<std::string> half_disc_remarks(const TestResult& result, const BendingProperties& p) {
    std::vector<std::string> remarks;
    if (!result.specimen) return remarks;
    const HalfDisc disc = half_disc_of(result.specimen->outline, result.specimen->spec.thickness_m, result.test);
    constexpr double kRounding = 1e-9;
    const auto outside = [](double x, double least, double most) { return x < least - kRounding || x > most + kRounding; };
    if (outside(disc.beta(), least_beta, most_beta) || outside(disc.q(), least_q, most_q))
        remarks.push_back(fmt::format("K_Ic is outside of ISRM's ranges: a/R = {:.3g} ({:g} to {:g}), s/(2R) = {:.3g} ({:g} to {:g}).", disc.beta(), least_beta, most_beta, disc.q(), least_q, most_q));
    const double least = std::max(least_half_disc_m, least_grains_across * result.specimen->quality.mean_diameter_m);
    if (2.0 * disc.radius_m < (1.0 - kRounding) * least)
        remarks.push_back(fmt::format("The half disc of {:.4g} mm is smaller than ISRM's {:.4g} mm (76 mm or ten grains).", 2e3 * disc.radius_m, 1e3 * least));
    constexpr double kSmall = 0.5;   // of notch and ligament
    const double shortest = std::min(disc.notch_m, disc.ligament_m());
    if (p.softening_length_m > kSmall * shortest)
        remarks.push_back(fmt::format("The softening length of {:.3g} mm is not small beside notch and ligament ({:.3g} mm the shorter): K_Ic grows with the half disc.", 1e3 * p.softening_length_m, 1e3 * shortest));
    return remarks;
}

}  // namespace feldspar
