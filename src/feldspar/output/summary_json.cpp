// summary.json: every number of a run in user units, compression positive; null where a value is not defined.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>

#include "feldspar/lab/odd_strength.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/lab/quantities.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/history_columns.hpp"
#include "feldspar/output/provenance_json.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/output/texture_json.hpp"
#include "feldspar/output/user_units.hpp"
#include "feldspar/output/variant_summary.hpp"

namespace feldspar {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json in_MPa(double value_Pa) { return number(value_Pa * MPa); }

/// Adds the test's numbers of a group.
void add(Json& json, const TestResult& result, QuantityGroup group) {
    for (const TestQuantity& quantity : test_quantities()) {
        if (quantity.group != group || quantity.summary == TestQuantity::absent) continue;
        if (group == QuantityGroup::of_method && !quantity.tests.contains(result.test.kind)) continue;  // another method's
        const double value = quantity.value(result);
        Json& entry = json[quantity.summary_name()];
        switch (quantity.place.form) {
            case QuantityForm::real:
                entry = number(value * quantity.unit.factor);
                break;
            case QuantityForm::whole:
                entry = static_cast<long long>(value);
                break;
            case QuantityForm::yes_no:
                entry = value == 1.0;
                break;
        }
    }
}

/// The files of a test that are in the directory already.
Json files_json(const RunDirectory& directory, const std::string& stem) {
    Json files = Json::object();
    const auto add = [&](const char* what, const std::string& file) {
        std::error_code error;
        if (std::filesystem::exists(directory.path() / file, error)) files[what] = file;
    };
    add("history", "history-" + stem + ".csv");
    add("archive", stem + ".h5");
    add("paraview", "paraview/" + stem + ".pvd");
    add("events", "events-" + stem + ".csv");
    return files;
}

std::string control_of(const TestSpec& test) {
    return test.control == LoadControl::gauge ? test.control_gauge : name(test.control);
}

/// What each stage was, and why it ended.
Json stages_json(const TestResult& result) {
    Json list = Json::array();
    for (const StageRecord& stage : result.stages) {
        if (stage.last_row >= result.history.size()) continue;
        const HistoryRow &from = result.history[stage.first_row], &to = result.history[stage.last_row];
        list.push_back({{"kind", name(stage.kind)},
                        {"group", stage.group + 1},
                        {"pass", stage.pass + 1},
                        {"from_stress_MPa", in_MPa(from.axial_stress_Pa)},
                        {"to_stress_MPa", in_MPa(to.axial_stress_Pa)},
                        {"sigma3_MPa", in_MPa(to.sigma3_Pa)},
                        {"from_strain", number(from.axial_strain)},
                        {"to_strain", number(to.axial_strain)},
                        {"steps", to.step - from.step},
                        {"work_J", number(to.energy.supplied() - from.energy.supplied())},
                        {"cracks", to.cracks_tensile + to.cracks_shear - from.cracks_tensile - from.cracks_shear},
                        {"ended", stage.ended.empty() ? Json(nullptr) : Json(stage.ended)}});
    }
    return list;
}

Json cycles_json(const TestResult& result) {
    Json list = Json::array();
    for (const CycleProperties& c : result.properties.cycles)
        list.push_back({{"first_stage", c.first_stage},
                        {"last_stage", c.last_stage},
                        {"sigma3_MPa", in_MPa(c.sigma3_Pa)},
                        {"peak_stress_MPa", in_MPa(c.peak_stress_Pa)},
                        {"strain_at_peak", number(c.peak_strain)},
                        {"reloading_modulus_GPa", number(c.reloading_modulus_Pa * GPa)},
                        {"unloading_modulus_GPa", number(c.unloading_modulus_Pa * GPa)},
                        {"permanent_axial_strain", number(c.permanent_axial_strain)},
                        {"permanent_lateral_strain", number(c.permanent_lateral_strain)},
                        {"permanent_volumetric_strain", number(c.permanent_volumetric_strain)},
                        {"damage_omega", number(c.damage)},
                        {"first_crack_MPa", in_MPa(c.first_crack_Pa)},
                        {"sigma_ci_crack_volume_MPa", in_MPa(c.sigma_ci_Pa)},
                        {"sigma_cd_MPa", in_MPa(c.sigma_cd_Pa)},
                        {"work_J", number(c.work_J)},
                        {"dissipated_J", number(c.dissipated_J)},
                        {"cracks", c.cracks}});
    return list;
}

Json multi_stage_json(const TestResult& result) {
    const MultiStageProperties& p = result.properties.multi_stage;
    Json json, points = Json::array();
    for (std::size_t i = 0; i < p.sigma3_Pa.size(); ++i)
        points.push_back({{"sigma3_MPa", in_MPa(p.sigma3_Pa[i])},
                          {"reversal_MPa", in_MPa(p.reversal_Pa[i])},
                          {"strength_MPa", in_MPa(p.strength_Pa[i])},
                          {"measured", i + 1 == p.sigma3_Pa.size()}});
    json["pressures"] = points;
    add(json, result, QuantityGroup::multi_stage);
    return json;
}

/// What the gauges read at the largest stress and at the end.
Json gauges_json(const TestResult& result) {
    Json json = Json::object();
    const auto peak = std::ranges::max_element(
        result.history, {}, [&](const HistoryRow& row) { return method_of(result.test).loading.sign * row.axial_stress_Pa; });
    for (std::size_t g = 0; g < result.gauges.size(); ++g) {
        const GaugeUnit unit = unit_of(result.gauges[g]);
        const auto at = [&](const HistoryRow& row) {
            return g < row.gauges.size() ? number(row.gauges[g] * unit.factor) : Json(nullptr);
        };
        json[result.gauges[g].name] = {{"unit", unit.name},
                                       {"at_peak", peak == result.history.end() ? Json(nullptr) : at(*peak)},
                                       {"at_end", result.history.empty() ? Json(nullptr) : at(result.history.back())}};
    }
    return json;
}

// Why nothing broke, or too early: the numbers behind the sentences, which stand among the remarks. Empty for an ordinary test.
Json odd_json(const TestResult& result) {
    Json json = Json::object();
    const std::vector<std::string> why = why_odd(result, result.properties);
    if (why.empty()) return json;
    const NearestToFailure& n = result.nearest;
    json["why"] = why;
    json["nearest_to_failure"] = {{"share_of_strength", number(n.share)},
                                  {"mode", n.in_tension ? "tension" : "shear"},
                                  {"damage", n.damage},
                                  {"place_mm", {n.place.x * 1e3, n.place.y * 1e3}}};
    json["softening_length_over_grain"] = number(softening_over_grain(result));
    return json;
}

Json test_json(const RunDirectory& directory, const TestResult& result) {
    Json test;
    if (!result.variant.empty()) test["variant"] = result.variant;
    test["kind"] = name(result.test.kind);
    if (!result.test.custom.name.empty()) test["name"] = result.test.custom.name;
    test["model"] = name(result.model.kind);
    test["contact"] = name(result.model.contact);
    test["law"] = name(result.contact.law);
    test["numerics"] = name(result.numerics.kind);
    test["plane"] = name(result.model.plane);
    test["seed"] = result.seed;
    test[pressure_key(method_of(result.test)) + std::string("_MPa")] = in_MPa(result.test.sigma3_Pa);
    add(test, result, QuantityGroup::strength);
    if (method_of(result.test).build.gauges != nullptr) add(test, result, QuantityGroup::load);
    test["remarks"] = result.properties.remarks;
    if (Json odd = odd_json(result); !odd.empty()) test["odd"] = std::move(odd);
    add(test, result, QuantityGroup::peak);
    add(test, result, QuantityGroup::first_crack);
    const Reading reading = method_of(result.test).reading;
    if (reading == Reading::disc) {
        Json& disc = test["brazilian"] = {{"plates", name(result.test.plates)}};
        add(disc, result, QuantityGroup::brazilian);
        if (result.specimen && result.specimen->outline.flattened()) add(disc, result, QuantityGroup::flattened);
    } else if (!method_of(result.test).properties.empty()) {
        Json& own = test[method_of(result.test).properties_table] = {{"control", control_of(result.test)}};
        add(own, result, QuantityGroup::of_method);
    } else if (reading == Reading::hole) {
        Json& hole = test["hole"] = {{"control", control_of(result.test)}};
        add(hole, result, QuantityGroup::hole);
    } else if (reading == Reading::curve || reading == Reading::stages) {
        test["control"] = control_of(result.test);
    } else {
        Json& branch = test["post_peak"] = {{"control", name(result.test.control)}};
        add(branch, result, QuantityGroup::post_peak);
    }
    if (!result.stages.empty()) test["stages"] = stages_json(result);
    if (!result.properties.cycles.empty()) test["each_cycle"] = cycles_json(result);
    if (reading == Reading::column && method_of(result.test).build.stages != nullptr) add(test, result, QuantityGroup::cycles);
    if (reading == Reading::stages) test["multi_stage"] = multi_stage_json(result);
    if (!result.gauges.empty()) test["gauges"] = gauges_json(result);
    if (method_of(result.test).start.strained_evenly &&
        reading != Reading::hole)  // else there is no such modulus, and no threshold
        for (const QuantityGroup group : {QuantityGroup::elastic, QuantityGroup::initiation, QuantityGroup::damage})
            add(test, result, group);
    for (const QuantityGroup group :
         {QuantityGroup::steps, QuantityGroup::cost, QuantityGroup::evidence, QuantityGroup::cracks, QuantityGroup::balance})
        add(test, result, group);
    test["quasi_static"] = std::string(1, result.evidence.grade);
    test["verdict"] = result.evidence.verdict;
    add(test, result, QuantityGroup::repeats);
    if (has_texture(result)) test["rock"] = texture_json(result);
    test["acoustic_emission"] = acoustic_emission_json(result);
    test["stop_reason"] = result.stop_reason;
    test["interrupted"] = result.interrupted;
    add(test["energy_at_end"], result, QuantityGroup::energies);
    add(test, result, QuantityGroup::bookkeeping);
    test["files"] = files_json(directory, test_stem(result));
    return test;
}

Json failed_json(const FailedTest& failed) {
    Json test;
    if (!failed.variant.empty()) test["variant"] = failed.variant;
    test["name"] = test_stem(failed.variant, failed.test, failed.seed);
    test["kind"] = name(failed.test.kind);
    test["seed"] = failed.seed;
    if (const TestMethod& method = method_of(failed.test); *pressure_symbol(method) != 0)
        test[pressure_key(method) + std::string("_MPa")] = in_MPa(failed.test.sigma3_Pa);
    test["reason"] = failed.reason;
    return test;
}

Json sizes_json(const SizeSummary& sizes) {
    return {{"mean", number(sizes.mean_m * 1e3)},
            {"minimum", number(sizes.minimum_m * 1e3)},
            {"maximum", number(sizes.maximum_m * 1e3)},
            {"D50", number(sizes.D50_m * 1e3)}};
}

Json specimen_json(const Specimen& specimen) {
    const SpecimenQuality& q = specimen.quality;
    Json json = {{"grains", q.grains},
                 {"contacts", q.contacts},
                 {"nodes", q.nodes},
                 {"triangles", q.triangles},
                 {"merged_edges", q.merged_edges},
                 {"vertices_per_grain", number(q.vertices_per_grain)},
                 {"seed", specimen.seed},
                 {"overlap_mean", number(q.overlap_mean)},
                 {"overlap_max", number(q.overlap_max)},
                 {"smallest_edge_mm", number(q.smallest_edge_m * 1e3)},
                 {"smallest_triangle_height_mm", number(q.smallest_triangle_height_m * 1e3)},
                 {"mean_diameter_mm", number(q.mean_diameter_m * 1e3)},
                 {"grain_sizes_mm", sizes_json(q.cell_sizes)},
                 {"asked_sizes_mm", sizes_json(q.disc_sizes)},
                 {"size_spread", number(q.size_spread)},
                 {"hexatic_order", number(q.hexatic_order)},
                 {"width_over_largest_grain", number(q.width_over_largest_grain)},
                 {"area_error", number(q.area_error)},
                 {"warnings", q.warnings}};
    if (specimen.spec.given_cells.given())
        json["given_cells"] = {{"file", specimen.spec.given_cells.file.filename().string()},
                               {"welded", q.welded},
                               {"inserted", q.inserted},
                               {"moved", q.moved},
                               {"concave", q.concave},
                               {"joined_pieces", q.joined_pieces}};
    if (q.crossings > 0) json["crossing_cuts"] = {{"crossings", q.crossings}, {"joined_pieces", q.joined_pieces}};
    return json;
}

/// Adds `key` for the first specimen of the tests that `wanted` picks, and `keys` for all of them, one a seed.
template <class Wanted>
void add_specimens(Json& summary, const std::string& key, std::span<const TestResult> results, Wanted wanted) {
    Json all = Json::array();
    std::vector<std::uint64_t> seen;
    for (const TestResult& result : results) {
        if (!wanted(result) || !result.specimen || std::ranges::find(seen, result.specimen->seed) != seen.end()) continue;
        seen.push_back(result.specimen->seed);
        all.push_back(specimen_json(*result.specimen));
    }
    if (all.empty()) return;
    summary[key] = all.front();
    summary[key + "s"] = all;
}

Json properties_json(const PropertySummary& properties) {
    std::vector<std::pair<UserQuantity, PropertyStatistics>> ordered;
    for (const auto& [key, statistics] : properties.values) ordered.emplace_back(user_quantity(key), statistics);
    std::ranges::stable_sort(ordered, {}, [](const auto& entry) { return entry.first.rank; });
    Json json = Json::object();
    for (const auto& [quantity, statistics] : ordered) {
        json[quantity.name] = {{"median", number(statistics.median * quantity.factor)},
                               {"minimum", number(statistics.minimum * quantity.factor)},
                               {"maximum", number(statistics.maximum * quantity.factor)},
                               {"seeds", statistics.seeds}};
    }
    return json;
}

Json laboratory_json(const Job& job) {
    Json json = Json::object();
    for (const auto& [key, value] : job.laboratory) {
        json[user_quantity(property_of_laboratory(key)).name] = number(laboratory_in_user_units(key, value));
    }
    return json;
}

Json list_in_MPa(const std::vector<double>& values_Pa) {
    Json list = Json::array();
    for (const double value : values_Pa) list.push_back(in_MPa(value));
    return list;
}

Json shear_envelope_json(const PropertySummary& properties) {
    Json fits = Json::array();
    for (const ShearFit& fit : properties.shear_fits)
        fits.push_back({{"seed", fit.seed},
                        {"cohesion_MPa", in_MPa(fit.cohesion_Pa)},
                        {"friction_angle_deg", number(fit.friction_angle_deg)},
                        {"residual_cohesion_MPa", in_MPa(fit.residual_cohesion_Pa)},
                        {"residual_friction_angle_deg", number(fit.residual_friction_angle_deg)},
                        {"normal_stress_MPa", list_in_MPa(fit.normal_Pa)},
                        {"shear_strength_MPa", list_in_MPa(fit.peak_Pa)},
                        {"shear_strength_residual_MPa", list_in_MPa(fit.residual_Pa)}});
    return fits;
}

Json envelope_json(const PropertySummary& properties) {
    Json fits = Json::array();
    for (const EnvelopeFit& fit : properties.fits) {
        fits.push_back({{"seed", fit.seed},
                        {"cohesion_MPa", in_MPa(fit.cohesion_Pa)},
                        {"friction_angle_deg", number(fit.friction_angle_deg)},
                        {"UCS_measured_MPa", in_MPa(fit.UCS_measured_Pa)},
                        {"UCS_fitted_MPa", in_MPa(fit.UCS_fitted_Pa)},
                        {"hoek_brown_mi", number(fit.hoek_brown_mi)},
                        {"hoek_brown_UCS_MPa", in_MPa(fit.hoek_brown_UCS_Pa)},
                        {"sigma3_MPa", list_in_MPa(fit.sigma3_Pa)},
                        {"sigma1_MPa", list_in_MPa(fit.sigma1_Pa)}});
    }
    return {{"method", properties.envelope_method}, {"fits", fits}};
}

Json variants_json(const Job& job, std::span<const TestResult> results) {
    Json list = Json::array();
    for (const VariantSummary& summary : summarise_variants(job, results)) {
        const Variant& variant = *summary.variant;
        Json costs = Json::object();
        for (const auto& [kind, cost] : summary.ms_per_step) costs[name(kind)] = number(cost);
        list.push_back({{"name", variant.name},
                        {"model", name(variant.model.kind)},
                        {"contact", name(variant.model.contact)},
                        {"normal", name(variant.model.normal)},
                        {"law", name(variant.contact.law)},
                        {"properties", properties_json(summary.properties)},
                        {"envelope", envelope_json(summary.properties)},
                        {"ms_per_step", costs}});
        if (!summary.properties.shear_fits.empty()) list.back()["shear_envelope"] = shear_envelope_json(summary.properties);
    }
    return list;
}

}  // namespace

void write_summary(const RunDirectory& directory, const Job& job, std::span<const TestResult> results,
                   const PropertySummary& properties, const Provenance& provenance, bool complete,
                   std::span<const FailedTest> failed) {
    Json summary;
    summary["format"] = "feldspar summary";
    summary["format_version"] = 1;
    summary["version"] = provenance.version;
    summary["commit"] = provenance.commit;
    summary["complete"] = complete;
    summary["signs"] = sign_convention;
    summary["seeds"] = job.seeds;
    add_specimens(summary, "specimen", results,
                  [](const TestResult& r) { return !method_of(r.test).specimen.own_disc && !r.test.specimen; });
    add_specimens(summary, "brazilian_specimen", results,
                  [](const TestResult& r) { return method_of(r.test).specimen.own_disc; });
    for (const TestResult& result : results)  // what tests have brought themselves, by their names
        if (result.test.specimen && !method_of(result.test).specimen.own_disc) {
            const std::string name = test_name(result.test);
            add_specimens(summary["test_specimens"], name, results,
                          [&](const TestResult& r) { return test_name(r.test) == name; });
        }
    if (!summary.contains("specimen") && summary.contains("test_specimens"))
        summary["specimen"] = summary["test_specimens"].front();
    // a run of Brazilian tests only has one kind of specimen
    if (!summary.contains("specimen") && summary.contains("brazilian_specimen"))
        summary["specimen"] = summary["brazilian_specimen"];
    summary["tests"] = Json::array();
    for (const TestResult& result : results) summary["tests"].push_back(test_json(directory, result));
    for (const FailedTest& test : failed) summary["failed"].push_back(failed_json(test));
    if (job.has_variants()) summary["variants"] = variants_json(job, results);
    // properties of several variants are not those of one rock
    const PropertySummary whole = job.has_variants() ? PropertySummary{} : properties;
    summary["properties"] = properties_json(whole);
    summary["laboratory"] = laboratory_json(job);
    summary["envelope"] = envelope_json(whole);
    if (!whole.shear_fits.empty()) summary["shear_envelope"] = shear_envelope_json(whole);
    summary["job"] = {{"name", job.name}, {"file", job.file.string()}, {"resolved", resolved_toml(job)}};
    summary["provenance"] = provenance_json(provenance);
    // a name that is not valid UTF-8 must not lose the run's numbers
    directory.write_text("summary.json", summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace feldspar
