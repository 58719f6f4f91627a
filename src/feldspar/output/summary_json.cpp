// summary.json: every number of a run in user units, compression positive; null where a value is not defined.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <system_error>

#include "feldspar/lab/properties.hpp"
#include "feldspar/output/history_columns.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/output/user_units.hpp"
#include "feldspar/output/variant_summary.hpp"

namespace feldspar {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json in_MPa(double value_Pa) { return number(value_Pa * MPa); }
Json in_GPa(double value_Pa) { return number(value_Pa * GPa); }

Json energy_json(const EnergyLedger& energy) {
    return {{"external_J", number(energy.external)},
            {"elastic_start_J", number(energy.elastic_start)},
            {"rate_control_J", number(energy.rate_control)},
            {"elastic_grains_J", number(energy.elastic_grains)},
            {"elastic_contacts_J", number(energy.elastic_contacts)},
            {"fracture_J", number(energy.fracture)},
            {"friction_J", number(energy.friction)},
            {"damping_J", number(energy.damping)},
            {"kinetic_J", number(energy.kinetic)},
            {"residual_J", number(energy.residual())}};
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
    add("paraview", stem + ".pvd");
    return files;
}

Json test_json(const RunDirectory& directory, const TestResult& result) {
    const TestProperties& p = result.properties;
    const QuasiStaticEvidence& e = result.evidence;
    int tensile = 0;
    for (const Crack& crack : result.cracks) tensile += crack.mode == CrackMode::tensile ? 1 : 0;
    Json test;
    if (!result.variant.empty()) test["variant"] = result.variant;
    test["kind"] = name(result.test.kind);
    test["model"] = name(result.model.kind);
    test["contact"] = name(result.model.contact);
    test["law"] = name(result.contact.law);
    test["numerics"] = name(result.numerics.kind);
    test["plane"] = name(result.model.plane);
    test["seed"] = result.seed;
    test["sigma3_MPa"] = in_MPa(result.test.sigma3_Pa);
    test["peak_stress_MPa"] = in_MPa(p.peak_stress_Pa);
    test["section_width_mm"] = number(p.section_width_m * 1e3);
    test["remarks"] = p.remarks;
    test["peak_reached"] = p.peak_reached;
    test["first_crack_MPa"] = in_MPa(p.first_crack_Pa);
    if (result.test.kind == TestKind::brazilian) {
        const BrazilianFailure& b = p.brazilian;
        test["brazilian"] = {{"plates", name(result.test.plates)},
                             {"split", b.split},
                             {"valid", b.valid},
                             {"BTS_first_dip_MPa", in_MPa(b.first_dip_Pa)},
                             {"BTS_largest_MPa", in_MPa(b.largest_Pa)},
                             {"crack_span", number(b.crack_span)},
                             {"first_crack_radius", number(b.first_crack_radius)},
                             {"first_crack_angle_deg", number(b.first_crack_angle_deg)},
                             {"first_crack_share", number(b.first_crack_share)},
                             {"splitting_radius", number(b.splitting_radius)},
                             {"splitting_angle_deg", number(b.splitting_angle_deg)},
                             {"splitting_share", number(b.splitting_share)},
                             {"contact_arc_top_deg", number(b.contact_arc_top_deg)},
                             {"contact_arc_bottom_deg", number(b.contact_arc_bottom_deg)}};
        if (result.specimen && result.specimen->outline.flattened()) {
            test["brazilian"]["flat_angle_deg"] = number(result.specimen->spec.outline.flat_angle_rad * 180.0 / std::numbers::pi);
            test["brazilian"]["flat_coefficient"] = number(b.flat_coefficient);
        }
    }
    if (result.test.kind != TestKind::brazilian) {
        const PostPeak& b = p.post_peak;
        test["post_peak"] = {{"control", name(result.test.control)},
                             {"modulus_GPa", in_GPa(b.modulus_Pa)},
                             {"brittleness_k1", number(b.brittleness)},
                             {"fracture_share", number(b.fracture_share)},
                             {"friction_share", number(b.friction_share)},
                             {"damping_share", number(b.damping_share)}};
    }
    test["E_GPa"] = in_GPa(p.E_secant_Pa);
    test["E_tangent_GPa"] = in_GPa(p.E_tangent_Pa);
    test["E_average_GPa"] = in_GPa(p.E_average_Pa);
    test["E_gauge_GPa"] = in_GPa(p.E_gauge_Pa);
    test["nu"] = number(p.nu);
    test["nu_tangent"] = number(p.nu_tangent);
    test["E_initial_GPa"] = in_GPa(p.E_initial_Pa);
    test["nu_initial"] = number(p.nu_initial);
    test["sigma_ci_crack_count_MPa"] = in_MPa(p.sigma_ci_crack_count_Pa);
    test["sigma_ci_crack_volume_MPa"] = in_MPa(p.sigma_ci_crack_volume_Pa);
    test["sigma_ci_lateral_strain_MPa"] = in_MPa(p.sigma_ci_lateral_strain_Pa);
    test["sigma_cd_MPa"] = in_MPa(p.sigma_cd_Pa);
    test["steps"] = result.steps;
    test["steps_to_peak"] = result.steps_to_peak;
    test["passages"] = result.passages;
    test["preparation_steps"] = result.preparation_steps;
    test["wall_s"] = number(result.wall_s);
    test["ms_per_step"] = number(result.ms_per_step);
    test["threads"] = result.threads;
    test["error_estimate"] = number(e.error_estimate);
    test["error_bound"] = number(error_bound(e.error_estimate));
    test["residual_median"] = number(e.residual_median);
    test["load_per_travel_time"] = number(e.load_per_travel_time);
    test["imbalance_mean"] = number(e.imbalance_mean);
    test["travel_time"] = number(result.travel_time);
    test["residual_mean"] = number(e.residual_mean);
    test["residual_at_peak"] = number(e.residual_at_peak);
    test["imbalance_max"] = number(e.imbalance_max);
    test["kinetic_over_strain"] = number(e.kinetic_over_strain);
    test["damping_over_fracture"] = number(e.damping_over_fracture);
    test["cracks_tensile"] = tensile;
    test["cracks_shear"] = static_cast<int>(result.cracks.size()) - tensile;
    test["energy_residual"] = number(result.energy_residual);
    test["quasi_static"] = std::string(1, e.grade);
    test["verdict"] = e.verdict;
    test["peak_change_at_third"] = e.confirmed ? number(e.peak_change_at_third) : Json(nullptr);
    test["balanced_stress_MPa"] = in_MPa(e.balanced_stress_Pa);
    test["other_damping"] = e.other_damping > 0.0 ? number(e.other_damping) : Json(nullptr);
    test["peak_change_at_other_damping"] = e.other_damping > 0.0 ? number(e.peak_change_at_other_damping) : Json(nullptr);
    test["stop_reason"] = result.stop_reason;
    test["interrupted"] = result.interrupted;
    test["energy_at_end"] = energy_json(result.energy_at_end);
    test["new_contacts"] = result.new_contacts;
    test["shape_fallbacks"] = result.shape_fallbacks;
    test["angular_momentum_loss"] = number(result.angular_momentum_loss);
    test["vanished_compressions"] = result.vanished_compressions;
    test["stable_omega2"] = number(result.stable_omega2);
    test["stable_limit"] = number(result.stable_limit);
    test["files"] = files_json(directory, test_stem(result));
    return test;
}

Json failed_json(const FailedTest& failed) {
    Json test;
    if (!failed.variant.empty()) test["variant"] = failed.variant;
    test["name"] = test_stem(failed.variant, failed.test, failed.seed);
    test["kind"] = name(failed.test.kind);
    test["seed"] = failed.seed;
    if (failed.test.kind == TestKind::biaxial) test["sigma3_MPa"] = in_MPa(failed.test.sigma3_Pa);
    test["reason"] = failed.reason;
    return test;
}

Json sizes_json(const SizeSummary& sizes) {
    return {{"mean", number(sizes.mean_m * 1e3)}, {"minimum", number(sizes.minimum_m * 1e3)}, {"maximum", number(sizes.maximum_m * 1e3)},
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
    }
    return list;
}

}  // namespace

void write_summary(const RunDirectory& directory, const Job& job, std::span<const TestResult> results, const PropertySummary& properties,
                   const Provenance& provenance, bool complete, std::span<const FailedTest> failed) {
    Json summary;
    summary["version"] = provenance.version;
    summary["commit"] = provenance.commit;
    summary["complete"] = complete;
    summary["signs"] = sign_convention;
    summary["seeds"] = job.seeds;
    add_specimens(summary, "specimen", results, [](const TestResult& r) { return r.test.kind != TestKind::brazilian; });
    add_specimens(summary, "brazilian_specimen", results, [](const TestResult& r) { return r.test.kind == TestKind::brazilian; });
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
    summary["job"] = {{"name", job.name}, {"file", job.file.string()}, {"resolved", resolved_toml(job)}};
    summary["provenance"] = {{"version", provenance.version},          {"commit", provenance.commit},
                             {"machine", provenance.machine},          {"compiler", provenance.compiler},
                             {"started", provenance.started},          {"threads", provenance.threads},
                             {"command_line", provenance.command_line}};
    // a name that is not valid UTF-8 must not lose the run's numbers
    directory.write_text("summary.json", summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace feldspar
