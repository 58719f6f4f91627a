#include "feldspar/lab/quantities.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "feldspar/base/angle.hpp"
#include "feldspar/lab/failure_pattern.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using R = TestResult;
using P = TestProperties;
using B = BrazilianFailure;
using E = QuasiStaticEvidence;
using G = QuantityGroup;

// A member, or a member of a member, that can be put back.
template <auto... path>
QuantityPlace at() {
    using Value = std::remove_reference_t<decltype((std::declval<R&>().*....*path))>;
    QuantityPlace place{QuantityForm::real, [](const R& r) { return static_cast<double>((r.*....*path)); },
                        [](R& r, double value) {
                            Value& there = (r.*....*path);
                            if constexpr (std::is_same_v<Value, bool>)
                                there = value == 1.0;
                            else if constexpr (std::is_integral_v<Value>)
                                there = std::isfinite(value) ? static_cast<Value>(value) : there;
                            else
                                there = value;
                        }};
    if constexpr (std::is_same_v<Value, bool>)
        place.form = QuantityForm::yes_no;
    else if constexpr (std::is_integral_v<Value>)
        place.form = QuantityForm::whole;
    return place;
}

template <auto member>
QuantityPlace property() {
    return at<&R::properties, member>();
}

template <auto member>
QuantityPlace post_peak() {
    return at<&R::properties, &P::post_peak, member>();
}

template <auto member>
QuantityPlace brazilian_failure() {
    return at<&R::properties, &P::brazilian, member>();
}

template <auto member>
QuantityPlace stages_of_one() {
    return at<&R::properties, &P::multi_stage, member>();
}

template <auto member>
QuantityPlace hole() {
    return at<&R::properties, &P::hole, member>();
}

template <auto member>
QuantityPlace evidence() {
    return at<&R::evidence, member>();
}

template <auto member>
QuantityPlace at_end() {
    return at<&R::energy_at_end, member>();
}

template <auto member>
QuantityPlace pattern() {
    return {QuantityForm::real, [](const R& r) { return failure_pattern(r).*member; }};
}

template <CrackMode mode>
QuantityPlace count() {
    return {QuantityForm::whole,
            [](const R& r) { return static_cast<double>(std::ranges::count(r.cracks, mode, &Crack::mode)); }};
}

// A number that methods add: each keeps its own in their order.
QuantityPlace of_method(std::string_view name) {
    const auto place = [name](const R& r) {
        const std::span<const MethodProperty> own = method_of(r.test).properties;
        return static_cast<std::size_t>(std::ranges::find(own, name, &MethodProperty::name) - own.begin());
    };
    return {QuantityForm::real,
            [place](const R& r) {
                const std::size_t i = place(r);
                return i < r.properties.of_method.size() ? r.properties.of_method[i] : nan;
            },
            [place](R& r, double value) {
                const std::size_t i = place(r), count = method_of(r.test).properties.size();
                if (i == count) return;  // not of this method
                r.properties.of_method.resize(count, nan);
                r.properties.of_method[i] = value;
            }};
}

QuantityPlace formed(double (*of)(const R&)) { return {QuantityForm::real, of}; }

double flat_angle_deg(const R& r) { return r.specimen ? in_degrees(r.specimen->spec.outline.flat_angle_rad) : nan; }

double peak_load_N(const R& r) { return r.properties.peak_stress_Pa * r.section_m2; }

double grain_count(const R& r) { return r.specimen ? static_cast<double>(r.specimen->quality.grains) : 0.0; }

double change_at_third(const R& r) { return r.evidence.confirmed ? r.evidence.peak_change_at_third : nan; }

void put_change_at_third(R& r, double value) {
    r.evidence.confirmed = !std::isnan(value);
    if (r.evidence.confirmed) r.evidence.peak_change_at_third = value;
}

double other_damping(const R& r) { return r.evidence.other_damping > 0.0 ? r.evidence.other_damping : nan; }

double change_at_other_damping(const R& r) {
    return r.evidence.other_damping > 0.0 ? r.evidence.peak_change_at_other_damping : nan;
}

std::vector<TestQuantity> table() {
    using namespace units;
    constexpr auto same = TestQuantity::same, absent = TestQuantity::absent;
    const auto those = [](bool (*fits)(const TestMethod&)) {
        std::set<MethodId> kinds;
        for (const MethodId kind : test_methods())
            if (fits(method_of(kind))) kinds.insert(kind);
        return kinds;
    };
    const std::set<MethodId> any(test_methods().begin(), test_methods().end());
    const std::set<MethodId> discs = those([](const TestMethod& m) { return m.reading == Reading::disc; });
    const std::set<MethodId> loaded = those([](const TestMethod& m) { return m.reading == Reading::column; });  // between platens
    const std::set<MethodId> forces = those([](const TestMethod& m) { return m.reading == Reading::curve; });
    const std::set<MethodId> compressed =
        those([](const TestMethod& m) { return m.reading == Reading::column && m.loading.widens; });
    const std::set<MethodId> cyclic =
        those([](const TestMethod& m) { return m.reading == Reading::column && m.build.stages != nullptr; });
    const std::set<MethodId> multi_stage = those([](const TestMethod& m) { return m.reading == Reading::stages; });
    const std::set<MethodId> holed = those([](const TestMethod& m) { return m.reading == Reading::hole; });
    std::vector<TestQuantity> all;
    const auto add = [&](QuantityGroup group, const std::set<MethodId>& tests, std::vector<TestQuantity> rows) {
        for (TestQuantity& row : rows) {
            row.group = group;
            row.tests = tests;
            all.push_back(std::move(row));
        }
    };
    // name, unit, definition, place; then what the ledger, summary.json and the report call it
    add(G::strength, any,
        {
            {"strength", stress, "(P1)", property<&P::peak_stress_Pa>(), same, "peak_stress", "peak"},
        });
    add(G::load, forces,
        {
            {"peak_load", force, "", formed(peak_load_N), absent},
        });
    add(G::strength, loaded,
        {
            {"section_width", length, "", property<&P::section_width_m>(), absent},
        });
    add(G::peak, any,
        {
            {"peak_reached", pure, "(P2)", property<&P::peak_reached>()},
        });
    add(G::elastic, loaded,
        {
            {"E", modulus, "(P3)", property<&P::E_secant_Pa>()},
            {"E_tangent", modulus, "(P4)", property<&P::E_tangent_Pa>(), same, same, absent},
            {"E_average", modulus, "(P4)", property<&P::E_average_Pa>(), same, same, absent},
            {"E_gauge", modulus, "(P4)", property<&P::E_gauge_Pa>(), same, same, absent},
            {"nu", pure, "(P5)", property<&P::nu>()},
            {"nu_tangent", pure, "(P5)", property<&P::nu_tangent>(), same, same, absent},
            {"E_initial", modulus, "(P14)", property<&P::E_initial_Pa>(), same, same, absent},
            {"nu_initial", pure, "(P14)", property<&P::nu_initial>(), same, same, absent},
        });
    add(G::first_crack, any,
        {
            {"first_crack", stress, "", property<&P::first_crack_Pa>()},
        });
    add(G::initiation, loaded,
        {
            {"sigma_ci_crack_count", stress, "(P7)", property<&P::sigma_ci_crack_count_Pa>(), same, same, "crack count"},
        });
    add(G::initiation, compressed,
        {
            {"sigma_ci_crack_volume", stress, "(P9)", property<&P::sigma_ci_crack_volume_Pa>(), same, same,
             "crack volumetric strain"},
            {"sigma_ci_lateral_strain", stress, "(P10)", property<&P::sigma_ci_lateral_strain_Pa>(), same, same,
             "lateral strain"},
        });
    add(G::damage, compressed,
        {
            {"sigma_cd", stress, "(P8)", property<&P::sigma_cd_Pa>()},
        });
    add(G::post_peak, loaded,
        {
            {"post_peak_modulus", modulus, "(P32)", post_peak<&PostPeak::modulus_Pa>(), same, "modulus", "modulus"},
            {"brittleness_k1", pure, "(P33)", post_peak<&PostPeak::brittleness>(), same, same, "brittleness"},
            {"post_peak_fracture_share", pure, "(P34)", post_peak<&PostPeak::fracture_share>(), same, "fracture_share",
             "fracture"},
            {"post_peak_friction_share", pure, "(P34)", post_peak<&PostPeak::friction_share>(), same, "friction_share",
             "friction"},
            {"post_peak_damping_share", pure, "(P34)", post_peak<&PostPeak::damping_share>(), same, "damping_share", "damping"},
        });
    add(G::brazilian, discs,
        {
            {"BTS_split", pure, "(P26)", brazilian_failure<&B::split>(), same, "split", "split"},
            {"BTS_valid", pure, "(P28)", brazilian_failure<&B::valid>(), same, "valid", "valid"},
            {"BTS_first_dip", stress, "(P27)", brazilian_failure<&B::first_dip_Pa>(), same, same, "first_dip"},
            {"BTS_largest", stress, "(P27)", brazilian_failure<&B::largest_Pa>(), same, same, "largest"},
            {"BTS_crack_span", pure, "(P26)", brazilian_failure<&B::crack_span>(), same, "crack_span", absent},
            {"BTS_first_crack_radius", pure, "", brazilian_failure<&B::first_crack_radius>(), same, "first_crack_radius",
             "first_crack_radius"},
            {"BTS_first_crack_angle", angle, "", brazilian_failure<&B::first_crack_angle_deg>(), same, "first_crack_angle",
             "first_crack_angle"},
            {"BTS_first_crack_share", pure, "", brazilian_failure<&B::first_crack_share>(), same, "first_crack_share", absent},
            {"BTS_splitting_radius", pure, "(P28)", brazilian_failure<&B::splitting_radius>(), same, "splitting_radius",
             "splitting_radius"},
            {"BTS_splitting_angle", angle, "(P28)", brazilian_failure<&B::splitting_angle_deg>(), same, "splitting_angle",
             "splitting_angle"},
            {"BTS_splitting_share", pure, "(P28)", brazilian_failure<&B::splitting_share>(), same, "splitting_share",
             "splitting_share"},
            {"BTS_contact_arc_top", angle, "(P29)", brazilian_failure<&B::contact_arc_top_deg>(), same, "contact_arc_top",
             "arc_top"},
            {"BTS_contact_arc_bottom", angle, "(P29)", brazilian_failure<&B::contact_arc_bottom_deg>(), same,
             "contact_arc_bottom", "arc_bottom"},
        });
    add(G::flattened, discs,
        {
            {"BTS_flat_angle", angle, "(P31)", formed(flat_angle_deg), absent, "flat_angle", absent},
            {"BTS_flat_coefficient", pure, "(P31)", brazilian_failure<&B::flat_coefficient>(), same, "flat_coefficient",
             "flat_coefficient"},
        });
    for (const MethodId method : test_methods()) {
        for (const MethodProperty& p : method_of(method).properties) {
            const auto known = std::ranges::find(all, p.name, &TestQuantity::name);
            if (known != all.end())
                known->tests.insert(method);
            else
                add(G::of_method, {method}, {{p.name, p.unit, p.definition, of_method(p.name)}});
        }
    }
    add(G::cycles, cyclic,
        {
            {"cycles",
             pure,
             "",
             {QuantityForm::whole, [](const R& r) { return static_cast<double>(r.properties.cycles.size()); }},
             absent,
             same,
             absent},
            {"damage_omega", pure, "(P54)", property<&P::damage_omega>()},
        });
    add(G::multi_stage, multi_stage,
        {
            {"peak_over_reversal", pure, "(P55)", stages_of_one<&MultiStageProperties::peak_over_reversal>()},
            {"multi_stage_cohesion", stress, "(P56)", stages_of_one<&MultiStageProperties::cohesion_Pa>(), same, "cohesion",
             "cohesion"},
            {"multi_stage_friction_angle", angle, "(P56)", stages_of_one<&MultiStageProperties::friction_angle_deg>(), same,
             "friction_angle", "friction_angle"},
        });
    add(G::hole, holed,
        {
            {"hole_radius", length, "", hole<&HoleProperties::radius_m>()},
            {"hole_radius_over_grain", pure, "", hole<&HoleProperties::radius_over_grain>()},
            {"hole_side_factor", pure, "(P49)", hole<&HoleProperties::side_factor>()},
            {"hole_pole_factor", pure, "(P49)", hole<&HoleProperties::pole_factor>()},
            {"hole_pole_crack", stress, "(P50)", hole<&HoleProperties::pole_crack_Pa>()},
            {"hole_side_crack", stress, "(P50)", hole<&HoleProperties::side_crack_Pa>()},
            {"hole_breakout", stress, "(P51)", hole<&HoleProperties::breakout_Pa>()},
            {"hole_breakout_side_stress", stress, "(P51)", hole<&HoleProperties::breakout_side_stress_Pa>()},
            {"hole_depth_at_peak", length, "(P51)", hole<&HoleProperties::depth_at_peak_m>()},
            {"hole_depth_at_end", length, "(P51)", hole<&HoleProperties::depth_at_end_m>()},
        });
    add(G::cracks, any,
        {
            {"cracks_tensile", pure, "", count<CrackMode::tensile>(), same, same, "tensile"},
            {"cracks_shear", pure, "", count<CrackMode::shear>(), same, same, "shear"},
        });
    add(G::pattern, any,
        {
            {"tensile_share", pure, "(P15)", pattern<&FailurePattern::tensile_share>(), same, absent, absent},
            {"crack_angle", angle, "(P15)", pattern<&FailurePattern::crack_angle_deg>(), same, absent, absent},
            {"crack_alignment", pure, "(P15)", pattern<&FailurePattern::crack_alignment>(), same, absent, absent},
            {"crack_localisation", pure, "(P16)", pattern<&FailurePattern::crack_localisation>(), same, absent, absent},
            {"post_peak_strain", pure, "(P17)", pattern<&FailurePattern::post_peak_strain>(), same, absent, absent},
        });
    add(G::evidence, any,
        {
            {"error_estimate", pure, "(L8)", evidence<&E::error_estimate>()},
            {"error_bound", pure, "(L8)", formed([](const R& r) { return error_bound(r.evidence.error_estimate); }), absent},
            {"residual_median", pure, "(L8)", evidence<&E::residual_median>()},
            {"load_per_travel_time", pure, "(L8)", evidence<&E::load_per_travel_time>()},
            {"imbalance_mean", pure, "(L15)", evidence<&E::imbalance_mean>()},
            {"travel_time", pure, "(M4)", at<&R::travel_time>(), absent, same, absent},
            {"residual_mean", pure, "(L15)", evidence<&E::residual_mean>()},
            {"residual_at_peak", pure, "(L15)", evidence<&E::residual_at_peak>()},
            {"imbalance_max", pure, "(L15)", evidence<&E::imbalance_max>()},
            {"kinetic_over_strain", pure, "(L15)", evidence<&E::kinetic_over_strain>()},
            {"damping_over_fracture", pure, "(L10)", evidence<&E::damping_over_fracture>()},
        });
    add(G::repeats, any,
        {
            {"peak_change_at_third",
             pure,
             "(L11)",
             {QuantityForm::real, change_at_third, put_change_at_third},
             same,
             same,
             "change_at_third"},
            {"balanced_stress", stress, "", evidence<&E::balanced_stress_Pa>(), absent, same, absent},
            {"other_damping", pure, "", formed(other_damping), absent, same, absent},
            {"peak_change_at_other_damping", pure, "", formed(change_at_other_damping), absent, same, absent},
        });
    add(G::balance, any,
        {
            {"energy_residual", pure, "(L6)", at<&R::energy_residual>()},
        });
    add(G::energies, any,
        {
            {"energy_external", energy, "(L6)", at_end<&EnergyLedger::external>(), absent, "external", absent},
            {"energy_elastic_start", energy, "(L6)", at_end<&EnergyLedger::elastic_start>(), absent, "elastic_start", absent},
            {"energy_rate_control", energy, "(L7)", at_end<&EnergyLedger::rate_control>(), absent, "rate_control", absent},
            {"energy_elastic_grains", energy, "(L6)", at_end<&EnergyLedger::elastic_grains>(), absent, "elastic_grains", absent},
            {"energy_elastic_contacts", energy, "(L6)", at_end<&EnergyLedger::elastic_contacts>(), absent, "elastic_contacts",
             absent},
            {"energy_fracture", energy, "(L6)", at_end<&EnergyLedger::fracture>(), same, "fracture", absent},
            {"energy_friction", energy, "(L6)", at_end<&EnergyLedger::friction>(), same, "friction", absent},
            {"energy_damping", energy, "(L6)", at_end<&EnergyLedger::damping>(), same, "damping", absent},
            {"energy_kinetic", energy, "(L13)", at_end<&EnergyLedger::kinetic>(), absent, "kinetic", absent},
            {"energy_residual_at_end", energy, "(L6)", formed([](const R& r) { return r.energy_at_end.residual(); }), absent,
             "residual", absent},
        });
    add(G::steps, any,
        {
            {"steps", pure, "", at<&R::steps>()},
            {"steps_to_peak", pure, "", at<&R::steps_to_peak>(), same, same, absent},
            {"passages", pure, "", at<&R::passages>(), absent, same, absent},
            {"preparation_steps", pure, "", at<&R::preparation_steps>(), same, same, absent},
        });
    add(G::bookkeeping, any,
        {
            {"new_contacts", pure, "", at<&R::new_contacts>(), same, same, absent},
            {"shape_fallbacks", pure, "", at<&R::shape_fallbacks>(), absent, same, absent},
            {"angular_momentum_loss", pure, "", at<&R::angular_momentum_loss>(), absent, same, absent},
            {"vanished_compressions", pure, "", at<&R::vanished_compressions>(), absent, same, absent},
            {"stable_omega2", pure, "", at<&R::stable_omega2>(), absent, same, absent},
            {"stable_limit", pure, "", at<&R::stable_limit>(), absent, same, absent},
            {"grain_count", pure, "", {QuantityForm::whole, grain_count}, same, absent, absent},
        });
    add(G::cost, any,
        {
            {"wall", duration, "", at<&R::wall_s>(), same, same, "wall_s"},
            {"ms_per_step", pure, "", at<&R::ms_per_step>(), same, same, absent},
            {"threads", pure, "", at<&R::threads>(), same, same, absent},
        });
    return all;
}

}  // namespace

double TestQuantity::value(const TestResult& result) const { return tests.contains(result.test.kind) ? place.of(result) : nan; }

void TestQuantity::put(TestResult& result, double value) const {
    if (place.put) place.put(result, value);
}

std::span<const TestQuantity> test_quantities() {
    static const std::vector<TestQuantity> all = table();
    return all;
}

const TestQuantity& test_quantity(std::string_view name) {
    const std::span<const TestQuantity> all = test_quantities();
    const auto found = std::ranges::find(all, name, &TestQuantity::name);
    if (found == all.end()) throw std::logic_error("no number of a test is called '" + std::string(name) + "'");
    return *found;
}

}  // namespace feldspar
