#include "feldspar/lab/rock_properties.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <vector>

#include "feldspar/methods/method.hpp"

namespace feldspar {

namespace {

using Source = RockProperty::Source;

constexpr std::string_view confined_stem = "sigma1_at_sigma3", confined_start = "sigma1_at_sigma3_", confined_end = "MPa_Pa";

/// A number of one kind of test, as each packing has it.
RockProperty read(std::string_view quantity, MethodId kind, const char* label, const char* symbol,
                  std::string_view laboratory = {}) {
    const TestQuantity& read_from = test_quantity(quantity);
    RockProperty p{read_from.name, read_from.unit, label, symbol, read_from.definition, Source::test, {kind}, &read_from};
    p.laboratory = laboratory;
    return p;
}

RockProperty in_compression(std::string_view quantity, const char* label, const char* symbol, std::string_view laboratory = {}) {
    return read(quantity, method_of_strength("UCS"), label, symbol, laboratory);
}

/// The first method of which this is read.
MethodId method_that_reads(Reading reading) {
    const std::span<const MethodId> all = test_methods();
    return *std::ranges::find_if(all, [&](MethodId id) { return method_of(id).reading == reading; });
}

RockProperty strength(MethodId kind) {
    const MethodStrength& measured = method_of(kind).strength;
    RockProperty p =
        read("strength", kind, measured.label, "", measured.laboratory.empty() ? measured.name : measured.laboratory);
    p.name = measured.name;
    p.symbol = measured.symbol.empty() ? measured.name : measured.symbol;
    p.of_broken_only = true;
    return p;
}

RockProperty in_splitting(std::string_view quantity, const char* label, const char* symbol, std::string_view laboratory = {}) {
    return read(quantity, method_of_strength("BTS"), label, symbol, laboratory);
}

/// 1 or 0 of each packing: its mean over them is a share.
RockProperty share(std::string_view name, RockProperty p) {
    p.name = name;
    return p;
}

RockProperty ratio(std::string_view name, std::string_view above, std::string_view below) {
    RockProperty p{name,
                   units::pure,
                   fmt::format("Ratio {} / {}", above, below),
                   fmt::format("{}/{}", above, below),
                   "(P11)",
                   Source::ratio,
                   {method_of_strength(above), method_of_strength(below)}};
    p.above = above;
    p.below = below;
    return p;
}

RockProperty over_UCS(std::string_view name, std::string_view above, const char* label, const char* symbol) {
    RockProperty p{name, units::pure, label, symbol, "(P11)", Source::ratio, {method_of_strength("UCS")}};
    p.above = above;
    p.below = "UCS";
    return p;
}

RockProperty fitted(std::string_view name, QuantityUnit unit, const char* label, const char* symbol, std::string_view definition,
                    double EnvelopeFit::*fit, std::string_view laboratory = {}) {
    RockProperty p{
        name, unit, label, symbol, definition, Source::envelope, {method_of_strength("UCS"), method_of_confined_strength()}};
    p.fit = fit;
    p.laboratory = laboratory;
    return p;
}

RockProperty sheared(std::string_view name, QuantityUnit unit, const char* label, const char* symbol, double ShearFit::*fit,
                     std::string_view laboratory) {
    RockProperty p{name, unit, label, symbol, "(P63)", Source::shear_envelope, {}};
    for (const MethodId method : test_methods())
        if (method_of(method).specimen.sheared) p.tests.insert(method);
    p.shear_fit = fit;
    p.laboratory = laboratory;
    return p;
}

std::vector<RockProperty> table() {
    using namespace units;
    std::vector<RockProperty> all{
        in_compression("E", "Young's modulus, secant at 50 % of the peak", "E", "E"),
        in_compression("nu", "Poisson's ratio, secant at 50 % of the peak", "\u03bd", "nu"),
    };
    for (const MethodId method : test_methods())
        if (!method_of(method).strength.name.empty()) all.push_back(strength(method));
    for (const MethodId method : test_methods())
        for (const MethodProperty& p : method_of(method).properties)
            if (*p.symbol != 0) {
                all.push_back(read(p.name, method, p.label, p.symbol, p.laboratory));
                if (!p.of_rock.empty()) all.back().name = p.of_rock;
            }
    const RockProperty further[]{
        in_splitting("BTS_first_dip", "Brazilian test, stress at the first fall of 5 %", "BTS dip", "BTS"),
        in_splitting("BTS_largest", "Brazilian test, largest stress of the record", "BTS largest", "BTS"),
        fitted("cohesion", stress, "Cohesion, Mohr-Coulomb", "c", "(P12)", &EnvelopeFit::cohesion_Pa, "cohesion"),
        fitted("friction_angle", angle, "Friction angle, Mohr-Coulomb", "\u03c6", "(P12)", &EnvelopeFit::friction_angle_deg,
               "friction_angle"),
        fitted("hoek_brown_mi", pure, "Hoek-Brown constant, intact rock", "mi", "(P13)", &EnvelopeFit::hoek_brown_mi,
               "hoek_brown_mi"),
        read("multi_stage_cohesion", method_that_reads(Reading::stages), "Cohesion, one specimen under rising pressures",
             "c multi-stage", "cohesion"),
        read("multi_stage_friction_angle", method_that_reads(Reading::stages),
             "Friction angle, one specimen under rising pressures", "\u03c6 multi-stage", "friction_angle"),
        sheared("shear_cohesion", stress, "Cohesion, direct shear", "c shear", &ShearFit::cohesion_Pa, "cohesion"),
        sheared("shear_friction_angle", angle, "Friction angle, direct shear", "\u03c6 shear", &ShearFit::friction_angle_deg,
                "friction_angle"),
        sheared("residual_cohesion", stress, "Residual cohesion, direct shear", "c residual", &ShearFit::residual_cohesion_Pa,
                "residual_cohesion"),
        sheared("residual_friction_angle", angle, "Residual friction angle, direct shear", "\u03c6 residual",
                &ShearFit::residual_friction_angle_deg, "residual_friction_angle"),
        ratio("UCS_over_BTS", "UCS", "BTS"),
        ratio("UCS_over_DTS", "UCS", "DTS"),
        ratio("BTS_over_DTS", "BTS", "DTS"),
        {confined_stem,
         stress,
         "Strength at \u03c3\u2083",
         "\u03c3\u2081",
         "(P1)",
         Source::confined_strength,
         {method_of_confined_strength()}},
        fitted("UCS_fitted", stress, "UCS from the Mohr-Coulomb line", "UCS fit", "(P12)", &EnvelopeFit::UCS_fitted_Pa),
        {"mohr_coulomb_N", pure, "Slope of the Mohr-Coulomb line", "N", "(P12)"},
        {"mohr_coulomb_tension", stress, "Tensile strength, Mohr-Coulomb line", "\u03c3t M-C", "(P19)"},
        fitted("hoek_brown_UCS", stress, "UCS from the Hoek-Brown fit", "\u03c3ci fit", "(P13)", &EnvelopeFit::hoek_brown_UCS_Pa),
        {"hoek_brown_tension", stress, "Tensile strength, Hoek-Brown parabola", "\u03c3t H-B", "(P19)"},
        read("hole_side_factor", method_that_reads(Reading::hole), "Stress at the sides of a hole over the axial stress, elastic",
             "k side"),
        read("hole_pole_factor", method_that_reads(Reading::hole), "Stress at the poles of a hole over the axial stress, elastic",
             "k pole"),
        read("hole_pole_crack", method_that_reads(Reading::hole), "Axial stress at the first tensile crack at a pole of a hole",
             "\u03c3 pole"),
        read("hole_side_crack", method_that_reads(Reading::hole), "Axial stress at the first crack at a side of a hole",
             "\u03c3 side"),
        read("hole_breakout", method_that_reads(Reading::hole), "Axial stress at which a breakout begins", "\u03c3 breakout"),
        read("hole_breakout_side_stress", method_that_reads(Reading::hole),
             "Stress at the sides of a hole when a breakout begins", "\u03c3\u03b8 breakout"),
        in_compression("first_crack", "Stress at the first crack", "\u03c31st"),
        in_compression("sigma_ci_crack_volume", "Crack initiation stress, crack volumetric strain", "\u03c3ci",
                       "sigma_ci_crack_volume"),
        in_compression("sigma_ci_crack_count", "Crack initiation stress, crack count", "\u03c3ci"),
        in_compression("sigma_ci_lateral_strain", "Crack initiation stress, lateral strain response", "\u03c3ci"),
        in_compression("sigma_cd", "Crack damage stress, reversal of the volumetric strain", "\u03c3cd", "sigma_cd"),
        over_UCS("sigma_ci_over_UCS", "sigma_ci_crack_volume", "Ratio crack initiation / UCS", "\u03c3ci/UCS"),
        over_UCS("sigma_cd_over_UCS", "sigma_cd", "Ratio crack damage / UCS", "\u03c3cd/UCS"),
        // Not the post-peak modulus: it jumps from minus to plus infinity where the branch is upright, and has no median there.
        in_compression("brittleness_k1", "Brittleness k1: above 1 class I, below 1 class II", "k1"),
        in_compression("E_tangent", "Young's modulus, tangent at 50 % of the peak", "Et50", "E"),
        in_compression("nu_tangent", "Poisson's ratio, tangent at 50 % of the peak", "\u03bd tangent", "nu"),
        in_compression("E_average", "Young's modulus, average 30 to 70 % of the peak", "Eavg", "E"),
        in_compression("E_gauge", "Young's modulus, tangent, from the gauge", "E gauge", "E"),
        in_compression("E_initial", "Young's modulus before damage, to 10 % of the peak, from the gauge", "E initial", "E"),
        in_compression("nu_initial", "Poisson's ratio before damage, to 10 % of the peak", "\u03bd initial", "nu"),
        share("BTS_valid_share", in_splitting("BTS_valid", "Brazilian test valid by ISRM: 1 yes, 0 no", "valid")),
    };
    all.insert(all.end(), std::begin(further), std::end(further));
    return all;
}

}  // namespace

std::span<const RockProperty> rock_properties() {
    static const std::vector<RockProperty> all = table();
    return all;
}

const RockProperty* rock_property(std::string_view name) {
    const std::span<const RockProperty> all = rock_properties();
    const auto found = std::ranges::find(all, name, &RockProperty::name);
    return found == all.end() ? nullptr : &*found;
}

const RockProperty* kept_rock_property(std::string_view kept_name) {
    if (pressure_of_confined_strength_MPa(kept_name)) return rock_property(confined_stem);
    const std::span<const RockProperty> all = rock_properties();
    const auto found = std::ranges::find_if(
        all, [&](const RockProperty& p) { return p.source != Source::confined_strength && p.kept_name() == kept_name; });
    return found == all.end() ? nullptr : &*found;
}

std::string confined_strength(double sigma3_Pa) { return fmt::format("{}{:g}{}", confined_start, sigma3_Pa / 1e6, confined_end); }

std::optional<double> pressure_of_confined_strength_MPa(std::string_view kept_name) {
    if (!kept_name.starts_with(confined_start) || !kept_name.ends_with(confined_end)) return std::nullopt;
    return std::strtod(std::string(kept_name.substr(confined_start.size())).c_str(), nullptr);
}

}  // namespace feldspar
