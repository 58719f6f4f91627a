// Three-point bending of a plain or notched beam: flexural strength and modulus, or toughness and work of fracture (ASTM C880, E399; RILEM TC50-FMC).
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "feldspar/methods/beam.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/platens.hpp"

namespace feldspar::methods {
namespace {

constexpr double kRoller = 0.1;         // radius of the rollers over the beam's height
constexpr double kHolds = 0.4;          // friction of the loading roller, which keeps the beam from sliding away; the supports roll

Beam beam(const MethodInput& in) { return beam_of(in.specimen.outline, in.specimen.spec.thickness_m, in.test); }

FixtureSpec roller(const MethodInput& in, const Beam& b, const char* name, Vec2 at, bool loads) {
    FixtureSpec roller;
    roller.name = name;
    roller.kind = FixtureKind::plate;
    roller.normal = {0.0, loads ? 1.0 : -1.0};
    roller.motion = {0.0, loads ? -1.0 : 0.0};
    roller.radius_m = -in.test.own_value("roller_radius").value_or(kRoller * b.height_m);
    roller.axis = at;
    roller.touch = Touch::nearest_axis;
    roller.part.facing = roller.normal;
    roller.part.at = at;
    roller.part.reach_m = std::abs(roller.radius_m);
    roller.contact = plate_contact(in);
    if (!loads) roller.contact.mu = 0.0;
    return roller;
}

std::vector<FixtureSpec> rollers(const MethodInput& in) {
    const Beam b = beam(in);
    return {roller(in, b, "loading roller", {b.middle_m, b.top_m()}, true), roller(in, b, "left support", {b.middle_m - 0.5 * b.span_m, b.bottom_m}, false),
            roller(in, b, "right support", {b.middle_m + 0.5 * b.span_m, b.bottom_m}, false)};
}

// Strain of the outermost fibre in the middle of a plain slender beam: 6 h deflection / S^2.
double length_m(const MethodInput& in) {
    const Beam b = beam(in);
    return b.span_m * b.span_m / (6.0 * b.height_m);
}

// Stress of the outermost fibre of the ligament (P36).
double section_m2(const MethodInput& in) {
    const Beam b = beam(in);
    const double factor = b.notched() ? 1.0 : flexural_factor(b.height_m / b.span_m);
    return 2.0 * b.thickness_m * b.ligament_m() * b.ligament_m() / (3.0 * b.span_m * factor);
}

void check(const Outline& outline, double thickness_m, const TestSpec& test) { beam_of(outline, thickness_m, test); }

std::vector<GaugeSpec> gauges(const MethodInput& in) {
    const Beam b = beam(in);
    // Beside the mouth by half a grain, so that a point lies in a grain of its side.
    const double beside = b.notched() ? 0.5 * b.notch_width_m + 0.25 * in.specimen.quality.mean_diameter_m : 0.0;
    const double axis = b.bottom_m + 0.5 * b.height_m, read = b.notched() ? b.bottom_m : axis;
    const Vec2 left = {b.middle_m - beside, read}, right = {b.middle_m + beside, read};
    GaugeSpec deflection;
    deflection.name = "deflection";
    deflection.meaning = b.notched() ? "of the lower side on both sides of the notch, downwards, against the axis above the supports"
                                     : "of the axis in the middle of the span, downwards, against the axis above the supports";
    deflection.points = {{left, {0.0, -0.5}}, {right, {0.0, -0.5}}, {{b.middle_m - 0.5 * b.span_m, axis}, {0.0, 0.5}}, {{b.middle_m + 0.5 * b.span_m, axis}, {0.0, 0.5}}};
    if (!b.notched()) return {deflection};
    GaugeSpec opening;
    opening.name = "CMOD";
    opening.meaning = "opening of the notch at its mouth";
    opening.points = {{left, {-1.0, 0.0}}, {right, {1.0, 0.0}}};
    return {deflection, opening};
}

// What is read of the record.

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double kHalf = 0.5;            // of the largest load: where the modulus is read
constexpr double kWholeCurve = 0.11;     // share of the largest load below which a record has the whole work of fracture (it ends at 0.1)

// The beam of a record that the closed forms hold for.
std::optional<Beam> beam_of_record(const MethodReading& r) {
    if (!r.result.specimen) return std::nullopt;
    const Beam b = beam_of(r.result.specimen->outline, r.result.specimen->spec.thickness_m, r.result.test);
    return b.otherwise_cut ? std::nullopt : std::optional(b);
}

double load_N(const MethodReading& r, const HistoryRow& row) { return row.axial_stress_Pa * r.result.section_m2; }

// Load over reading when the load first reaches half of the largest; not-a-number without the gauge.
double secant_N_m(const MethodReading& r, std::string_view gauge) {
    const int g = gauge_number(r.result.gauges, gauge);
    if (g < 0) return nan;
    for (std::size_t i = 0; i <= r.peak_row; ++i) {
        const HistoryRow& row = r.result.history[i];
        if (row.axial_stress_Pa < kHalf * r.peak_Pa || !(row.gauges[g] > 0.0)) continue;
        return load_N(r, row) / row.gauges[g];
    }
    return nan;
}

// E' of the closed forms is E in plane stress, where nu enters the deflection only.
double nu_of(const TestResult& result) { return result.model.kind == GrainKind::flexible ? result.grain.nu : 0.2; }

double flexural_strength_Pa(const MethodReading& r) {
    const auto b = beam_of_record(r);
    return b && !b->notched() ? r.peak_Pa : nan;
}

double E_Pa(const MethodReading& r) {
    const auto b = beam_of_record(r);
    if (!b) return nan;
    if (!b->notched()) return secant_N_m(r, "deflection") * deflection_factor(*b, nu_of(r.result)) / b->thickness_m;
    const bool known = std::abs(b->span_m / b->height_m - mouth_span) <= mouth_span_tolerance * mouth_span;
    return known ? secant_N_m(r, "CMOD") * mouth_factor(b->notch_m / b->height_m) / b->thickness_m : nan;
}

double K_Ic_Pa_sqrt_m(const MethodReading& r) {
    const auto b = beam_of_record(r);
    if (!b || !b->notched()) return nan;
    const double largest_N = load_N(r, r.result.history[r.peak_row]);
    return largest_N * b->span_m / (b->thickness_m * std::pow(b->height_m, 1.5)) * notch_factor(b->notch_m / b->height_m, b->height_m / b->span_m);
}

double work_of_fracture_J_m2(const MethodReading& r) {
    const auto b = beam_of_record(r);
    const HistoryRow& last = r.result.history.back();
    if (!b || !b->notched() || last.axial_stress_Pa > kWholeCurve * r.peak_Pa) return nan;
    return last.energy.supplied() / (b->ligament_m() * b->thickness_m);   // what the loading has put in, its elastic start too
}

double softening_length_m(const MethodReading& r) {
    const auto b = beam_of_record(r);
    const ContactMaterial& contact = r.result.contact;
    if (!b || !b->notched() || contact.law == ContactLaw::brittle) return nan;
    const double measured_Pa = E_Pa(r), modulus_Pa = std::isfinite(measured_Pa) ? measured_Pa : r.result.grain.E_Pa;
    return modulus_Pa > 0.0 ? modulus_Pa * contact.Gfn_J_m2 / (contact.sigma_nt_Pa * contact.sigma_nt_Pa) : nan;
}

double crack_path(const MethodReading& r) {
    const auto b = beam_of_record(r);
    if (!b || !b->notched()) return nan;
    double length = 0.0;
    for (const Crack& crack : r.result.cracks) length += norm(crack.to - crack.from);
    return length / b->ligament_m();
}

double notch_m(const MethodReading& r) {
    if (!r.result.specimen) return nan;
    return beam_of(r.result.specimen->outline, r.result.specimen->spec.thickness_m, r.result.test).notch_m;
}

constexpr MethodProperty kProperties[]{
    {"flexural_strength", units::stress, "(P36)", flexural_strength_Pa, "Flexural strength, three-point bending", "\u03c3f", "flexural_strength"},
    {"E_bending", units::modulus, "(P37), (P39)", E_Pa, "Young's modulus, three-point bending", "E bending", "E"},
    {"K_Ic", units::toughness, "(P38)", K_Ic_Pa_sqrt_m, "Fracture toughness, notched three-point bending", "KIc", "K_Ic"},
    {"work_of_fracture", units::fracture_work, "(P40)", work_of_fracture_J_m2, "Work of fracture, notched three-point bending", "GF", "work_of_fracture"},
    {"softening_length", units::length, "(P40)", softening_length_m, "Softening length of the contacts"},
    {"crack_path", units::pure, "(P40)", crack_path, "Length of all cracks over the ligament"},
    {"notch", units::length, "", notch_m, "Depth of the notch"},
};

constexpr MethodKey kKeys[]{
    {.name = "span", .dimension = Dimension::length, .usual = "4 times the beam's height, at most 0.9 of its length", .meaning = "distance of the two supports"},
    {.name = "roller_radius", .dimension = Dimension::length, .usual = "a tenth of the beam's height", .meaning = "radius of the three rollers"},
};

constexpr const char* kGauges[]{"deflection", "CMOD"};

}  // namespace

const TestMethod three_point_bend{
    .name = "three-point-bend",
    .purpose = "a beam on two rollers, pressed down by a third in the middle; with a notch from below, a test of toughness",
    .words = {"Three-point bending", "Outermost fibre stress", "6 h w / S\u00b2, w the way of the loading roller"},
    .build = {rollers, length_m, section_m2, gauges, kGauges, check},
    .start = {.strained_evenly = false, .stays_in_touch = false, .time_of_mode = true},
    .reading = Reading::curve,
    .specimen = {.plate_mu = kHolds, .plates = true},
    .loading = {.control = LoadControl::dissipation, .stop_fraction = 0.1, .tensile = true},
    .rate = {.residual_target = 3.0, .residual_share = 1.0 / 3.0, .travel_times = 150.0, .seconds = 60.0, .fixed_speed_strain = 2e-3},
    .verdict = {.error_a = 1e-2, .imbalance_a = 2e-2, .imbalance_b = 4e-2},
    .properties_table = "bending",
    .properties = kProperties,
    .keys = kKeys,
    .job = {.title = "Three-point bending of a beam on the packing of each seed.",
            .gives = "a beam that lies along x: flexural strength and modulus; with a notch K_Ic and work of fracture",
            .keys = R"(# span = "200 mm"                   # distance of the two supports; 4 times the height unless given, at most 0.9 of the length
# roller_radius = "5 mm"            # of the three rollers; a tenth of the height unless given
# control = "dissipation"           # behind the peak; also "displacement", or a gauge: "CMOD" of a notched beam, "deflection"
# until = { gauge = "CMOD", at = "0.3 mm" }   # ends the test there
)",
            .width = beam_width_line,
            .height = beam_height_line},
};

}  // namespace feldspar::methods
