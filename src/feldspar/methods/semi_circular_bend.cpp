// Semi-circular bending of a notched half disc: mode I fracture toughness (ISRM 2014).
#include "feldspar/methods/half_disc.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/rollers.hpp"

namespace feldspar::methods {
namespace {

constexpr double kRoller = 0.1;   // radius of the rollers over that of the disc

HalfDisc half_disc(const MethodInput& in) { return half_disc_of(in.specimen.outline, in.specimen.spec.thickness_m, in.test); }

std::vector<FixtureSpec> rollers(const MethodInput& in) {
    const HalfDisc d = half_disc(in);
    const Vec2 aside = {0.5 * d.span_m, 0.0};
    return three_rollers(in, {{d.middle.x, d.top_m}, d.middle - aside, d.middle + aside, in.test.roller_radius_m.value_or(kRoller * d.radius_m)});
}

double length_m(const MethodInput& in) { return half_disc(in).radius_m; }

double section_m2(const MethodInput& in) {
    const HalfDisc d = half_disc(in);
    return 2.0 * d.radius_m * d.thickness_m;
}

void check(const Outline& outline, double thickness_m, const TestSpec& test) { half_disc_of(outline, thickness_m, test); }

std::vector<GaugeSpec> gauges(const MethodInput& in) {
    const HalfDisc d = half_disc(in);
    const Vec2 beside = {0.5 * d.notch_width_m + 0.25 * in.specimen.quality.mean_diameter_m, 0.0};   // half a grain, in a grain of its side
    GaugeSpec opening;
    opening.name = "CMOD";
    opening.meaning = "opening of the notch at its mouth";
    opening.points = {{d.middle - beside, {-1.0, 0.0}}, {d.middle + beside, {1.0, 0.0}}};
    return {opening};
}

}  // namespace

const TestMethod semi_circular_bend{
    .kind = TestKind::semi_circular_bend,
    .purpose = "a notched half disc on two rollers, pressed down by a third on the top of its arc: a test of toughness",
    .words = {"Semi-circular bending", "P / (2 R t)", "Way of the loading roller / R"},
    .build = {rollers, length_m, section_m2, gauges, {"CMOD"}, check},
    .start = {.strained_evenly = false, .stays_in_touch = false, .time_of_mode = true},
    .reading = Reading::half_disc,
    .specimen = {.plate_mu = kRollerHolds, .plates = true},
    .loading = {.control = LoadControl::dissipation, .stop_fraction = 0.1, .tensile = true},
    .rate = {.residual_target = 3.0, .residual_share = 1.0 / 3.0, .travel_times = 150.0, .seconds = 60.0, .fixed_speed_strain = 5e-3},
    .verdict = {.error_a = 1e-2, .imbalance_a = 2e-2, .imbalance_b = 4e-2},
};

}  // namespace feldspar::methods
