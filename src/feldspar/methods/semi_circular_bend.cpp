// Semi-circular bending of a notched half disc: mode I fracture toughness (ISRM 2014).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "feldspar/methods/half_disc.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/notched.hpp"
#include "feldspar/methods/rollers.hpp"

namespace feldspar::methods {
namespace {

constexpr double kRoller = 0.1;  // radius of the rollers over that of the disc

HalfDisc half_disc(const MethodInput& in) { return half_disc_of(in.specimen.outline, in.specimen.spec.thickness_m, in.test); }

std::vector<FixtureSpec> rollers(const MethodInput& in) {
    const HalfDisc d = half_disc(in);
    const Vec2 aside = {0.5 * d.span_m, 0.0};
    return three_rollers(in, {{d.middle.x, d.top_m},
                              d.middle - aside,
                              d.middle + aside,
                              in.test.own_value("roller_radius").value_or(kRoller * d.radius_m)});
}

double length_m(const MethodInput& in) { return half_disc(in).radius_m; }

double section_m2(const MethodInput& in) {
    const HalfDisc d = half_disc(in);
    return 2.0 * d.radius_m * d.thickness_m;
}

void check(const Outline& outline, double thickness_m, const TestSpec& test) { half_disc_of(outline, thickness_m, test); }

std::vector<GaugeSpec> gauges(const MethodInput& in) {
    const HalfDisc d = half_disc(in);
    const Vec2 beside = {0.5 * d.notch_width_m + 0.25 * in.specimen.quality.mean_diameter_m,
                         0.0};  // half a grain, in a grain of its side
    GaugeSpec opening;
    opening.name = "CMOD";
    opening.meaning = "opening of the notch at its mouth";
    opening.points = {{d.middle - beside, {-1.0, 0.0}}, {d.middle + beside, {1.0, 0.0}}};
    return {opening};
}

// What is read of the record.

HalfDisc half_disc(const MethodReading& r) {
    return half_disc_of(r.result.specimen->outline, r.result.specimen->spec.thickness_m, r.result.test);
}

// (P47), from the largest load.
double K_Ic_Pa_sqrt_m(const MethodReading& r) {
    const HalfDisc d = half_disc(r);
    return half_disc_factor(d.beta(), d.q()) * load_N(r, r.result.history[r.peak_row]) * std::sqrt(std::numbers::pi * d.notch_m) /
           (2.0 * d.radius_m * d.thickness_m);
}

double work_of_fracture(const MethodReading& r) {
    const HalfDisc d = half_disc(r);
    return work_of_fracture_J_m2(r, d.ligament_m(), d.thickness_m);
}

double softening_length(const MethodReading& r) { return softening_length_m(r, r.result.grain.E_Pa); }

double crack_path(const MethodReading& r) { return length_of_cracks_m(r) / half_disc(r).ligament_m(); }

double main_crack(const MethodReading& r) {
    const HalfDisc d = half_disc(r);
    return main_crack_m(r, d.middle + Vec2{0.0, d.notch_m}) / d.ligament_m();
}

double notch_m(const MethodReading& r) { return half_disc(r).notch_m; }

// A half disc that is none of ISRM's, or too small for its softening zone (P48).
std::vector<std::string> remarks(const MethodReading& r) {
    std::vector<std::string> sentences;
    const HalfDisc d = half_disc(r);
    constexpr double kRounding = 1e-9;
    const auto outside = [](double x, double least, double most) { return x < least - kRounding || x > most + kRounding; };
    if (outside(d.beta(), least_beta, most_beta) || outside(d.q(), least_q, most_q))
        sentences.push_back(
            fmt::format("K_Ic is outside of ISRM's ranges: a/R = {:.3g} ({:g} to {:g}), s/(2R) = {:.3g} ({:g} to {:g}).",
                        d.beta(), least_beta, most_beta, d.q(), least_q, most_q));
    const double least = std::max(least_half_disc_m, least_grains_across * r.result.specimen->quality.mean_diameter_m);
    if (2.0 * d.radius_m < (1.0 - kRounding) * least)
        sentences.push_back(fmt::format("The half disc of {:.4g} mm is smaller than ISRM's {:.4g} mm (76 mm or ten grains).",
                                        2e3 * d.radius_m, 1e3 * least));
    constexpr double kSmall = 0.5;  // of notch and ligament
    const double shortest = std::min(d.notch_m, d.ligament_m()), softening = softening_length(r);
    if (softening > kSmall * shortest)
        sentences.push_back(
            fmt::format("The softening length of {:.3g} mm is not small beside notch and ligament ({:.3g} mm the shorter): K_Ic "
                        "grows with the half disc.",
                        1e3 * softening, 1e3 * shortest));
    return sentences;
}

constexpr MethodProperty kProperties[]{
    {"K_Ic", units::toughness, "(P38), (P47)", K_Ic_Pa_sqrt_m, "Fracture toughness, semi-circular bending", "KIc SCB", "K_Ic",
     "K_Ic_half_disc"},
    {"work_of_fracture", units::fracture_work, "(P40)", work_of_fracture, "Work of fracture"},
    {"softening_length", units::length, "(P40)", softening_length, "Softening length of the contacts"},
    {"crack_path", units::pure, "(P40)", crack_path, "Length of all cracks over the ligament"},
    {"main_crack", units::pure, "(P40)", main_crack, "Length of the crack from the notch over the ligament"},
    {"notch", units::length, "", notch_m, "Depth of the notch"},
};

constexpr MethodKey kKeys[]{
    {.name = "span",
     .dimension = Dimension::length,
     .usual = "1.2 radii of the half disc",
     .meaning = "distance of the two supports"},
    {.name = "roller_radius",
     .dimension = Dimension::length,
     .usual = "a tenth of the half disc's radius",
     .meaning = "radius of the three rollers"},
};

constexpr const char* kGauges[]{"CMOD"};

}  // namespace

const TestMethod semi_circular_bend{
    .name = "semi-circular-bend",
    .purpose = "a notched half disc on two rollers, pressed down by a third on the top of its arc: a test of toughness",
    .words = {"Semi-circular bending", "P / (2 R t)", "Way of the loading roller / R"},
    .build = {rollers, length_m, section_m2, gauges, kGauges, check},
    .start = {.strained_evenly = false, .stays_in_touch = false, .time_of_mode = true},
    .reading = Reading::curve,
    .specimen = {.plate_mu = kRollerHolds, .plates = true},
    .loading = {.control = LoadControl::dissipation, .stop_fraction = 0.1, .tensile = true},
    .rate =
        {.residual_target = 3.0, .residual_share = 1.0 / 3.0, .travel_times = 150.0, .seconds = 60.0, .fixed_speed_strain = 5e-3},
    .verdict = {.error_a = 1e-2, .imbalance_a = 2e-2, .imbalance_b = 4e-2},
    .properties_table = "bending",
    .properties = kProperties,
    .remarks = remarks,
    .keys = kKeys,
    .job =
        {.title = "Semi-circular bending of a notched half disc on the packing of each seed.",
         .gives = "a notched half disc on two rollers: K_Ic and work of fracture",
         .keys =
             R"(# span = "48 mm"                    # distance of the two supports; 1.2 radii unless given (ISRM: 0.5 to 0.8 diameters)
# roller_radius = "4 mm"            # of the three rollers; a tenth of the radius unless given
# control = "dissipation"           # behind the peak; also "displacement", or the gauge "CMOD", the opening of the notch's mouth
# until = { gauge = "CMOD", at = "0.2 mm" }   # ends the test there
)",
         .shape = R"(shape = "half-disc"                 # stands on its flat, whose middle is (0, 0))",
         .width = R"(diameter = "80 mm"                  # ISRM: at least 76 mm, or ten grains)",
         .height =
             R"(notches = [{ from = ["0 mm", "0 mm"], to = ["0 mm", "20 mm"], width = "1 mm" }]   # 0.4 to 0.6 of the radius)"},
};

}  // namespace feldspar::methods
