// Three-point bending of a plain or notched beam: flexural strength and modulus, or toughness and work of fracture (ASTM C880, E399; RILEM TC50-FMC).
#include "feldspar/methods/beam.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/rollers.hpp"

namespace feldspar::methods {
namespace {

constexpr double kRoller = 0.1;         // radius of the rollers over the beam's height

Beam beam(const MethodInput& in) { return beam_of(in.specimen.outline, in.specimen.spec.thickness_m, in.test); }

std::vector<FixtureSpec> rollers(const MethodInput& in) {
    const Beam b = beam(in);
    return three_rollers(in, {{b.middle_m, b.top_m()}, {b.middle_m - 0.5 * b.span_m, b.bottom_m}, {b.middle_m + 0.5 * b.span_m, b.bottom_m},
                              in.test.roller_radius_m.value_or(kRoller * b.height_m)});
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

}  // namespace

const TestMethod three_point_bend{
    .kind = TestKind::three_point_bend,
    .purpose = "a beam on two rollers, pressed down by a third in the middle; with a notch from below, a test of toughness",
    .words = {"Three-point bending", "Outermost fibre stress", "6 h w / S\u00b2, w the way of the loading roller"},
    .build = {rollers, length_m, section_m2, gauges, {"deflection", "CMOD"}, check},
    .start = {.strained_evenly = false, .stays_in_touch = false, .time_of_mode = true},
    .reading = Reading::beam,
    .specimen = {.plate_mu = kRollerHolds, .plates = true},
    .loading = {.control = LoadControl::dissipation, .stop_fraction = 0.1, .tensile = true},
    .rate = {.residual_target = 3.0, .residual_share = 1.0 / 3.0, .travel_times = 150.0, .seconds = 60.0, .fixed_speed_strain = 2e-3},
    .verdict = {.error_a = 1e-2, .imbalance_a = 2e-2, .imbalance_b = 4e-2},
};

}  // namespace feldspar::methods
