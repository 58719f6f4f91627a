// Three-point bending of a plain or notched beam: flexural strength and modulus, or toughness and work of fracture (ASTM C880,
// E399; RILEM TC50-FMC).
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "feldspar/methods/beam.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/notched.hpp"
#include "feldspar/methods/rollers.hpp"

namespace feldspar::methods {
namespace {

constexpr double kRoller = 0.1;  // radius of the rollers over the beam's height

Beam beam(const MethodInput& in) { return beam_of(in.specimen.outline, in.specimen.spec.thickness_m, in.test); }

std::vector<FixtureSpec> rollers(const MethodInput& in) {
    const Beam b = beam(in);
    return three_rollers(in, {{b.middle_m, b.top_m()},
                              {b.middle_m - 0.5 * b.span_m, b.bottom_m},
                              {b.middle_m + 0.5 * b.span_m, b.bottom_m},
                              in.test.own_value("roller_radius").value_or(kRoller * b.height_m)});
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
    deflection.meaning = b.notched()
                             ? "of the lower side on both sides of the notch, downwards, against the axis above the supports"
                             : "of the axis in the middle of the span, downwards, against the axis above the supports";
    deflection.points = {{left, {0.0, -0.5}},
                         {right, {0.0, -0.5}},
                         {{b.middle_m - 0.5 * b.span_m, axis}, {0.0, 0.5}},
                         {{b.middle_m + 0.5 * b.span_m, axis}, {0.0, 0.5}}};
    if (!b.notched()) return {deflection};
    GaugeSpec opening;
    opening.name = "CMOD";
    opening.meaning = "opening of the notch at its mouth";
    opening.points = {{left, {-1.0, 0.0}}, {right, {1.0, 0.0}}};
    return {deflection, opening};
}

// What is read of the record.

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// The beam of a record that the closed forms hold for.
std::optional<Beam> beam_of_record(const MethodReading& r) {
    if (!r.result.specimen) return std::nullopt;
    const Beam b = beam_of(r.result.specimen->outline, r.result.specimen->spec.thickness_m, r.result.test);
    return b.otherwise_cut ? std::nullopt : std::optional(b);
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
    return largest_N * b->span_m / (b->thickness_m * std::pow(b->height_m, 1.5)) *
           notch_factor(b->notch_m / b->height_m, b->height_m / b->span_m);
}

// The beam of a record, if it has a notch.
std::optional<Beam> notched_beam(const MethodReading& r) {
    const auto b = beam_of_record(r);
    return b && b->notched() ? b : std::nullopt;
}

double work_of_fracture(const MethodReading& r) {
    const auto b = notched_beam(r);
    return b ? work_of_fracture_J_m2(r, b->ligament_m(), b->thickness_m) : nan;
}

double softening_length(const MethodReading& r) { return notched_beam(r) ? softening_length_m(r, E_Pa(r)) : nan; }

double crack_path(const MethodReading& r) {
    const auto b = notched_beam(r);
    return b ? length_of_cracks_m(r) / b->ligament_m() : nan;
}

double main_crack(const MethodReading& r) {
    const auto b = notched_beam(r);
    return b ? main_crack_m(r, {b->middle_m, b->bottom_m + b->notch_m}) / b->ligament_m() : nan;
}

double notch_m(const MethodReading& r) {
    if (!r.result.specimen) return nan;
    return beam_of(r.result.specimen->outline, r.result.specimen->spec.thickness_m, r.result.test).notch_m;
}

constexpr MethodProperty kProperties[]{
    {"flexural_strength", units::stress, "(P36)", flexural_strength_Pa, "Flexural strength, three-point bending", "\u03c3f",
     "flexural_strength"},
    {"E_bending", units::modulus, "(P37), (P39)", E_Pa, "Young's modulus, three-point bending", "E bending", "E"},
    {"K_Ic", units::toughness, "(P38)", K_Ic_Pa_sqrt_m, "Fracture toughness, notched three-point bending", "KIc", "K_Ic"},
    {"work_of_fracture", units::fracture_work, "(P40)", work_of_fracture, "Work of fracture, notched three-point bending", "GF",
     "work_of_fracture"},
    {"softening_length", units::length, "(P40)", softening_length, "Softening length of the contacts"},
    {"crack_path", units::pure, "(P40)", crack_path, "Length of all cracks over the ligament"},
    {"main_crack", units::pure, "(P40)", main_crack, "Length of the crack from the notch over the ligament"},
    {"notch", units::length, "", notch_m, "Depth of the notch"},
};

constexpr MethodKey kKeys[]{
    {.name = "span",
     .dimension = Dimension::length,
     .usual = "4 times the beam's height, at most 0.9 of its length",
     .meaning = "distance of the two supports"},
    {.name = "roller_radius",
     .dimension = Dimension::length,
     .usual = "a tenth of the beam's height",
     .meaning = "radius of the three rollers"},
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
    .specimen = {.plate_mu = kRollerHolds, .plates = true},
    .loading = {.control = LoadControl::dissipation, .stop_fraction = 0.1, .tensile = true},
    .rate =
        {.residual_target = 3.0, .residual_share = 1.0 / 3.0, .travel_times = 150.0, .seconds = 60.0, .fixed_speed_strain = 2e-3},
    .verdict = {.error_a = 1e-2, .imbalance_a = 2e-2, .imbalance_b = 4e-2},
    .properties_table = "bending",
    .properties = kProperties,
    .keys = kKeys,
    .job =
        {.title = "Three-point bending of a beam on the packing of each seed.",
         .gives = "a beam that lies along x: flexural strength and modulus; with a notch K_Ic and work of fracture",
         .keys =
             R"(# span = "200 mm"                   # distance of the two supports; 4 times the height unless given, at most 0.9 of the length
# roller_radius = "5 mm"            # of the three rollers; a tenth of the height unless given
# control = "dissipation"           # behind the peak; also "displacement", or a gauge: "CMOD" of a notched beam, "deflection"
# until = { gauge = "CMOD", at = "0.3 mm" }   # ends the test there
)",
         .width = beam_width_line,
         .height = beam_height_line},
};

}  // namespace feldspar::methods
