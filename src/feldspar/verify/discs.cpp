// The Brazilian disc: stresses around its centre, arcs under its plates, the flattened disc.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "feldspar/methods/flattened_disc.hpp"
#include "feldspar/verify/bodies.hpp"
#include "feldspar/verify/topics.hpp"

namespace feldspar {
namespace {

using namespace bodies;

constexpr double kDiameter = 0.08, kRadius = 0.04, kAround = 0.008;

// Mean over the circle r < radius of the plane solution for a disc under a pair of point loads (Timoshenko & Goodier),
// in units of 2P / (pi D t) and -6P / (pi D t); compression downwards.
Vec2 closed_form_mean(double radius) {
    double sx = 0.0, sy = 0.0;
    int count = 0;
    constexpr int kGrid = 400;
    for (int i = 0; i < kGrid; ++i)
        for (int j = 0; j < kGrid; ++j) {
            const double x = radius * (2.0 * (i + 0.5) / kGrid - 1.0), y = radius * (2.0 * (j + 0.5) / kGrid - 1.0);
            if (x * x + y * y > radius * radius) continue;
            const double R = kRadius, up = R - y, down = R + y, r1 = x * x + up * up, r2 = x * x + down * down;
            sx += -(up * x * x / (r1 * r1) + down * x * x / (r2 * r2) - 0.5 / R);
            sy += -(up * up * up / (r1 * r1) + down * down * down / (r2 * r2) - 0.5 / R);
            ++count;
        }
    return {sx / count * 2.0 * kRadius, sy / count * 2.0 * kRadius / -3.0};
}

TestSpec brazilian(PlateShape plates, std::optional<double> plate_Kn_Pa_m) {
    TestSpec test;
    test.kind = methods::brazilian;
    test.plates = plates;
    test.plate_Kn_Pa_m = plate_Kn_Pa_m;
    return test;
}

// Mean stress of the triangles around the centre, over 2P / (pi D t) and -6P / (pi D t).
Vec2 stress_in_the_centre(const TestSetup& setup) {
    Started s(setup);
    const Assembly& a = s.e.assembly;
    const Reactions r = reactions(a);
    const double unit = (r.loading + r.rest) / (std::numbers::pi * kDiameter * a.thickness_m);
    double sxx = 0.0, syy = 0.0, volume = 0.0;
    for (const Triangle& t : a.triangles) {
        const Vec2 centre =
            (1.0 / 3.0) * (a.nodes.reference[t.node[0]] + a.nodes.reference[t.node[1]] + a.nodes.reference[t.node[2]]);
        if (norm(centre) > kAround) continue;
        const Mat2 stress = cauchy_stress(a.elasticity.front(), displacement_gradient(a.nodes.displacement, t));
        sxx += stress.xx * t.volume_m3;
        syy += stress.yy * t.volume_m3;
        volume += t.volume_m3;
    }
    return {sxx / volume / unit, syy / volume / (-3.0 * unit)};
}

std::vector<CheckedValue> point_loads() {
    const Vec2 expected = closed_form_mean(kAround),
               found = stress_in_the_centre(setup(make(disc(kDiameter)), methods::brazilian));
    return {{"tension across, over 2 P / (pi D t)", expected.x, found.x},
            {"compression along, over -6 P / (pi D t)", expected.y, found.y}};
}

// Row of the elastic start of a disc between plates.
HistoryRow start_of_disc(const TestSpec& test, double softer, std::uint64_t seed) {
    TestSetup s = setup(make(disc(kDiameter), seed), methods::brazilian);
    s.test = test;
    s.grain.E_Pa /= softer;
    s.contact.Kn_Pa_m /= softer;
    s.numerics.maximum_steps = 10;
    const TestResult r = run_test(s, {});
    return *std::ranges::find_if(r.history, [](const HistoryRow& row) { return row.phase == Phase::loading; });
}

// Where an arc ends on the edges of grains is even chance, an edge (4.3 degrees) inside or outside of it, so single arcs say
// little.
template <class HalfWidth>
CheckedValue mean_arc(const char* what, const TestSpec& test, double softer, int packings, const HalfWidth& half_width_m) {
    CheckedValue mean{what, 0.0, 0.0};
    for (int seed = 1; seed <= packings; ++seed) {
        const HistoryRow row = start_of_disc(test, softer, static_cast<std::uint64_t>(seed));
        const double P_per_t = 0.5 * std::numbers::pi * kDiameter * row.axial_stress_Pa;  // N/m
        mean.found += 0.5 * (row.contact_arc_top_deg + row.contact_arc_bottom_deg) / packings;
        mean.expected += 2.0 * std::asin(half_width_m(P_per_t) / kRadius) * 180.0 / std::numbers::pi / packings;
    }
    return mean;
}

// docs/validation/brazilian-plates.md: an elastic foundation k between a disc that is stiff beside it and a plate or jaw has
// P/t = 4/3 k delta a with a^2 = D delta / (1 - R/R_jaw). Here the disc gives a twentieth of what the strips give.
std::vector<CheckedValue> arcs_on_strips() {
    constexpr double k = 4e11;
    const auto of = [](double slenderness) {
        return [slenderness](double P_per_t) { return std::cbrt(0.75 * P_per_t / k * slenderness * kDiameter); };
    };
    return {mean_arc("flat plates", brazilian(PlateShape::flat, k), 1.0, 2, of(1.0)),
            mean_arc("curved jaws", brazilian(PlateShape::curved, k), 1.0, 2, of(3.0))};
}

std::vector<CheckedValue> arcs_of_hertz() {
    constexpr double softer = 50.0, E = 24.3e9 / softer;  // of the specimen, not of its grains
    const auto of = [](double slenderness) {
        return
            [slenderness](double P_per_t) { return std::sqrt(4.0 * P_per_t * slenderness * kRadius / (std::numbers::pi * E)); };
    };
    return {mean_arc("flat plates", brazilian(PlateShape::flat, {}), softer, 3, of(1.0)),
            mean_arc("curved jaws", brazilian(PlateShape::curved, {}), softer, 3, of(3.0))};
}

std::vector<CheckedValue> under_jaws() {
    TestSetup s = setup(make(disc(kDiameter)), methods::brazilian);
    s.test = brazilian(PlateShape::curved, 1.6e12);
    const HistoryRow row = start_of_disc(s.test, 1.0, 1);
    const double a = 0.25 * (row.contact_arc_top_deg + row.contact_arc_bottom_deg) * std::numbers::pi / 180.0;
    return {{"", closed_form_mean(kAround).x * (std::sin(2.0 * a) - a) / std::sin(a), stress_in_the_centre(s).x}};
}

// Finite elements of a flattened disc have 0.956 to 0.961 times k as the mean within 0.2 R.
std::vector<CheckedValue> flattened() {
    std::vector<CheckedValue> compared;
    for (const auto& [degrees, plate_Kn] : {std::pair{20.0, std::optional<double>{}}, std::pair{30.0, std::optional(1.6e12)}}) {
        SpecimenSpec spec = disc(kDiameter);
        spec.grain_sizes.minimum_m = 0.001;  // so that the flats have 9 and 14 edges
        spec.grain_sizes.maximum_m = 0.002;
        spec.outline.flat_angle_rad = degrees * std::numbers::pi / 180.0;
        TestSetup s = setup(make(spec), methods::brazilian);
        s.test = brazilian(PlateShape::flat, plate_Kn);
        compared.push_back({degrees == 20.0 ? "20 degrees, rigid plate" : "30 degrees, strip",
                            0.958 * flat_coefficient(*s.specimen, s.model, s.grain, s.contact, s.test),
                            stress_in_the_centre(s).x});
    }
    return compared;
}

double k(double degrees, FlatLoading loading) { return flat_coefficient(degrees * std::numbers::pi / 180.0, loading); }

std::vector<CheckedValue> section() {
    const RunControl control;
    const TestSetup on_disc = setup(make(disc(0.03)), methods::brazilian),
                    on_column = setup(make(rectangle(0.02, 0.04)), methods::uniaxial_compression);
    return {{"disc of 30 mm", 2.0 / (std::numbers::pi * 0.03 * 0.08), Experiment(on_disc, control).stress(1.0)},
            {"column of 20 mm", 1.0 / (0.02 * 0.08), Experiment(on_column, control).stress(1.0)}};
}

}  // namespace

std::vector<Check> disc_checks() {
    return {
        {.name = "discs.stress-definition",
         .sentence = "A load of 1 N on a disc and on a column is the stress of the handbooks.",
         .formula = "2 P / (pi D t), P / (b t)",
         .source = "(L2); ISRM 1978",
         .unit = "Pa",
         .bound = relative(1e-12),
         .reason = "rounding",
         .compare = section},
        {.name = "discs.point-loads",
         .sentence =
             "Around the centre of a Brazilian disc the stresses are those of a disc under two point loads; means within 0.2 R.",
         .formula = "sum of two radial stress fields and a uniform tension",
         .source = "Timoshenko and Goodier",
         .bound = absolute(2e-2),
         .reason = "grains of 3 mm in a circle of 16 mm",
         .compare = point_loads},
        {.name = "discs.curved-jaws",
         .sentence = "Under curved jaws the tension around the centre is that of a uniform pressure over the arc found; over 2 P "
                     "/ (pi D t).",
         .formula = "sigma_t = 2 P / (pi D t) (sin 2a - a) / sin a",
         .source = "Hondros 1959",
         .bound = absolute(3e-2),
         .reason = "whole grain edges make the arc uncertain by a grain, 3 % of the stress",
         .compare = under_jaws},
        {.name = "discs.arcs-on-strips",
         .sentence = "Plates with soft strips touch the arc of an elastic foundation; means over packings.",
         .formula = "P / t = 4/3 k delta a, a^2 = D delta / (1 - R / R_jaw)",
         .source = "docs/validation/brazilian-plates.md",
         .unit = "deg",
         .bound = absolute(2.7),
         .reason = "an arc ends on a grain edge of 4.3 degrees by even chance: three standard errors of two packings",
         .compare = arcs_on_strips},
        {.name = "discs.arcs-of-hertz",
         .sentence = "Hard plates touch the arc of Hertz; means over packings.",
         .formula = "a^2 = 4 P R' / (pi E t), R' = R / (1 - R / R_jaw)",
         .source = "Hertz",
         .unit = "deg",
         .bound = absolute(2.2),
         .reason = "an arc ends on a grain edge of 4.3 degrees by even chance: three standard errors of three packings",
         .compare = arcs_of_hertz},
        {.name = "discs.flattened-coefficient",
         .sentence = "Under a uniform pressure on its flats a flattened disc has the published coefficient.",
         .formula = "sigma_t = k 2 P / (pi D t)",
         .source = "(P31); Wang and others 2004",
         .bound = absolute(1e-3),
         .reason = "the digits that are published",
         .compare =
             [] {
                 return std::vector<CheckedValue>{
                     {"no flats", 1.0, k(0.0, {})}, {"20 degrees", 0.9644, k(20.0, {})}, {"30 degrees", 0.9208, k(30.0, {})}};
             }},
        {.name = "discs.flattened-rigid-plate",
         .sentence = "Under rigid frictionless plates the coefficient is that of finite elements.",
         .formula = "sigma_t = k 2 P / (pi D t)",
         .source = "(P31); quadratic finite elements of a quarter disc",
         .bound = absolute(2e-3),
         .reason = "what the fit leaves",
         .compare =
             [] {
                 std::vector<CheckedValue> compared;
                 for (const auto& [degrees, expected] :
                      {std::pair{10, 0.985}, {15, 0.966}, {20, 0.940}, {25, 0.908}, {30, 0.870}})
                     compared.push_back({std::to_string(degrees) + " degrees", expected, k(degrees, {1e4})});
                 return compared;
             }},
        {.name = "discs.flattened-tension",
         .sentence = "The tension around the centre of a flattened disc is the load's times its coefficient; means within 0.2 R.",
         .formula = "sigma_t = 0.958 k 2 P / (pi D t)",
         .source = "(P31); quadratic finite elements of a quarter disc",
         .bound = relative(1e-2),
         .reason = "9 and 14 grain edges on a flat",
         .compare = flattened},
    };
}

}  // namespace feldspar
