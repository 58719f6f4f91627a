// Four-point bending of a plain beam: flexural strength and modulus where the moment is constant (ASTM C880).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "feldspar/base/error.hpp"
#include "feldspar/methods/beam.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/notched.hpp"
#include "feldspar/methods/rollers.hpp"

namespace feldspar::methods {
namespace {

constexpr double kRoller = 0.1;  // radius of the rollers over the beam's height
constexpr double kInner = 0.5;   // span of the loading rollers over that of the supports (ASTM C880: quarter points)
constexpr double kLeastArm =
    0.5;  // from a support to the next loading roller, over the height: nearer by, the load goes straight into the support

struct FourPoints {
    Beam beam;
    double inner_m = 0.0;  // between the loading rollers

    double arm_m() const { return 0.5 * (beam.span_m - inner_m); }
};

FourPoints four_points(const Outline& outline, double thickness_m, const TestSpec& test) {
    FourPoints f{beam_of(outline, thickness_m, test), 0.0};
    if (f.beam.notched() || f.beam.otherwise_cut)
        throw InputError({.key = "test.kind"}, "a beam with a notch or hole is not bent between four points",
                         "kind = \"three-point-bend\", or a plain beam");
    f.inner_m = test.own_value("inner_span").value_or(kInner * f.beam.span_m);
    if (f.arm_m() < kLeastArm * f.beam.height_m)
        throw InputError({.key = "test.inner_span"},
                         fmt::format("loading rollers {:.4g} mm apart stand nearer to the supports than half the beam's height",
                                     1e3 * f.inner_m),
                         fmt::format("at most {:.4g} mm", 1e3 * (f.beam.span_m - 2.0 * kLeastArm * f.beam.height_m)));
    return f;
}

FourPoints four_points(const MethodInput& in) { return four_points(in.specimen.outline, in.specimen.spec.thickness_m, in.test); }

std::vector<FixtureSpec> rollers(const MethodInput& in) {
    const FourPoints f = four_points(in);
    const Beam& b = f.beam;
    const double radius_m = in.test.own_value("roller_radius").value_or(kRoller * b.height_m);
    const auto at = [&](const char* name, double x, double y, bool loads) { return roller(in, name, {x, y}, radius_m, loads); };
    FixtureSpec right_load = at("right load", b.middle_m + 0.5 * f.inner_m, b.top_m(), true);
    right_load.contact.mu = 0.0;  // one holds the beam, and the upper side may shorten between them
    return {at("left load", b.middle_m - 0.5 * f.inner_m, b.top_m(), true), right_load,
            at("left support", b.middle_m - 0.5 * b.span_m, b.bottom_m, false),
            at("right support", b.middle_m + 0.5 * b.span_m, b.bottom_m, false)};
}

// Strain of the outermost fibre between the loading rollers of a slender beam: 3 h w / (A (3 S - 4 A)), w their way and A the
// arm.
double length_m(const MethodInput& in) {
    const FourPoints f = four_points(in);
    return f.arm_m() * (3.0 * f.beam.span_m - 4.0 * f.arm_m()) / (3.0 * f.beam.height_m);
}

// (P57).
double section_m2(const MethodInput& in) {
    const FourPoints f = four_points(in);
    return 2.0 * f.beam.thickness_m * f.beam.height_m * f.beam.height_m / (3.0 * (f.beam.span_m - f.inner_m));
}

void check(const Outline& outline, double thickness_m, const TestSpec& test) { four_points(outline, thickness_m, test); }

std::vector<GaugeSpec> gauges(const MethodInput& in) {
    const Beam b = four_points(in).beam;
    const double axis = b.bottom_m + 0.5 * b.height_m;
    GaugeSpec deflection;
    deflection.name = "deflection";
    deflection.meaning = "of the axis in the middle of the span, downwards, against the axis above the supports";
    deflection.points = {{{b.middle_m, axis}, {0.0, -1.0}},
                         {{b.middle_m - 0.5 * b.span_m, axis}, {0.0, 0.5}},
                         {{b.middle_m + 0.5 * b.span_m, axis}, {0.0, 0.5}}};
    return {deflection};
}

double flexural_strength_Pa(const MethodReading& r) { return r.peak_Pa; }

// (P58): the second term is the shear between support and loading roller, with the shear coefficient 5/6.
double E_Pa(const MethodReading& r) {
    const FourPoints f = four_points(r.result.specimen->outline, r.result.specimen->spec.thickness_m, r.result.test);
    const double S = f.beam.span_m, A = f.arm_m(), h = f.beam.height_m,
                 nu = r.result.model.kind == GrainKind::flexible ? r.result.grain.nu : 0.2;
    return secant_N_m(r, "deflection") * (A * (3.0 * S * S - 4.0 * A * A) / (4.0 * h * h * h) + 1.2 * (1.0 + nu) * A / h) /
           f.beam.thickness_m;
}

constexpr MethodProperty kProperties[]{
    {"flexural_strength", units::stress, "(P36), (P57)", flexural_strength_Pa, "Flexural strength, four-point bending",
     "\u03c3f four-point", "flexural_strength", "flexural_strength_four_point"},
    {"E_bending", units::modulus, "(P37), (P58)", E_Pa, "Young's modulus, four-point bending", "E four-point", "E",
     "E_bending_four_point"},
};

constexpr MethodKey kKeys[]{
    {.name = "span",
     .dimension = Dimension::length,
     .usual = "4 times the beam's height, at most 0.9 of its length",
     .meaning = "distance of the two supports"},
    {.name = "inner_span",
     .dimension = Dimension::length,
     .usual = "half of `span`",
     .meaning = "distance of the two loading rollers"},
    {.name = "roller_radius",
     .dimension = Dimension::length,
     .usual = "a tenth of the beam's height",
     .meaning = "radius of the rollers"},
};

constexpr const char* kGauges[]{"deflection"};

}  // namespace

const TestMethod four_point_bend{
    .name = "four-point-bend",
    .purpose = "a plain beam on two rollers, pressed down by two others between which the moment is constant",
    .words = {"Four-point bending", "Outermost fibre stress", "3 h w / (A (3S \u2212 4A)), w the way of the loading rollers"},
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
        {.title = "Four-point bending of a beam on the packing of each seed.",
         .gives = "a plain beam that lies along x: flexural strength and modulus where the moment is constant",
         .keys =
             R"(# span = "200 mm"                   # distance of the two supports; 4 times the height unless given, at most 0.9 of the length
# inner_span = "100 mm"             # distance of the two loading rollers; half of the span unless given
# roller_radius = "5 mm"            # of the four rollers; a tenth of the height unless given
# control = "dissipation"           # behind the peak; also "displacement", or the gauge "deflection"
)",
         .width = beam_width_line,
         .height = R"(height = "50 mm"                    # the load acts downwards)"},
};

}  // namespace feldspar::methods
