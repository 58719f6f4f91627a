#include "feldspar/output/report_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "feldspar/base/angle.hpp"
#include "feldspar/base/counted.hpp"
#include "feldspar/lab/acoustic_emission.hpp"
#include "feldspar/lab/brazilian_failure.hpp"
#include "feldspar/lab/failure_pattern.hpp"
#include "feldspar/lab/quantities.hpp"
#include "feldspar/lab/rock_properties.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/history_columns.hpp"
#include "feldspar/output/provenance_json.hpp"
#include "feldspar/output/texture_json.hpp"
#include "feldspar/output/user_units.hpp"
#include "feldspar/output/variant_summary.hpp"

namespace feldspar {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t largest_row_count = 600;   ///< of a history in the report; the CSV has them all
constexpr std::size_t smallest_row_count = 150;  ///< ... however many tests there are
constexpr std::size_t most_rows_of_all = 24000;

/// Row numbers that stay: evenly spread, with the first, the last, the strength, the first dip and the largest stress.
std::vector<std::size_t> kept_rows(const TestResult& result, std::size_t tests) {
    const std::vector<HistoryRow>& history = result.history;
    std::vector<std::size_t> kept;
    if (history.empty()) return kept;
    const std::size_t most_rows = std::clamp(most_rows_of_all / tests, smallest_row_count, largest_row_count);
    const std::size_t stride = (history.size() + most_rows - 1) / most_rows;
    const auto higher = [](const HistoryRow& a, const HistoryRow& b) {
        return std::abs(a.axial_stress_Pa) < std::abs(b.axial_stress_Pa);
    };
    const auto peak = static_cast<std::size_t>(std::ranges::max_element(history, higher) - history.begin());
    const std::size_t strength = strength_row(result);
    const auto dip = method_of(result.test).reading == Reading::disc ? first_dip(result) : std::nullopt;
    std::vector<std::size_t> turns;  // where stages begin and end
    for (const StageRecord& stage : result.stages) turns.push_back(stage.last_row);
    for (std::size_t r = 0; r < history.size(); ++r) {
        if (std::ranges::binary_search(turns, r) || r % stride == 0 || r == peak || r == strength || (dip && r == dip->row) ||
            r + 1 == history.size())
            kept.push_back(r);
    }
    return kept;
}

Json history_json(const TestResult& result, std::size_t tests) {
    const std::vector<HistoryRow>& history = result.history;
    const std::vector<std::size_t> kept = kept_rows(result, tests);
    Json json = Json::object();
    const auto column = [&](const char* name, auto value) {
        Json list = Json::array();
        for (const std::size_t r : kept) list.push_back(rounded(value(history[r])));
        json[name] = list;
    };
    using Row = const HistoryRow&;
    column("strain", [](Row r) { return r.axial_strain * 1e3; });  // strains in 10^-3
    const bool strained_evenly = method_of(result.test).start.strained_evenly;
    column("gauge", [&](Row r) { return strained_evenly ? r.axial_strain_gauge * 1e3 : std::nan(""); });
    column("lateral", [&](Row r) { return strained_evenly ? r.lateral_strain_gauge * 1e3 : std::nan(""); });
    column("stress", [](Row r) { return r.axial_stress_Pa * MPa; });
    column("tensile", [](Row r) { return r.cracks_tensile; });
    column("shear", [](Row r) { return r.cracks_shear; });
    column("speed", [](Row r) { return r.platen_speed; });
    // Without the loading motion: its kinetic energy is put in and taken out again where the rate changes, joules at once that do
    // no work on the rock.
    const auto of_loading_motion = [](Row r) { return r.energy.kinetic - r.kinetic_deviation; };
    column("supplied", [&](Row r) { return r.energy.supplied() - of_loading_motion(r); });
    column("grains", [](Row r) { return r.energy.elastic_grains; });
    column("contacts", [](Row r) { return r.energy.elastic_contacts; });
    column("fracture", [](Row r) { return r.energy.fracture; });
    column("friction", [](Row r) { return r.energy.friction; });
    column("damping", [](Row r) { return r.energy.damping; });
    column("kinetic", [](Row r) { return r.kinetic_deviation; });
    column("residual", [](Row r) { return r.energy.residual(); });
    column("loading_motion", of_loading_motion);
    if (result.variant.empty()) return json;
    const std::vector<double> share = broken_share(result);
    column("displacement", [](Row r) { return r.platen_displacement_m * 1e3; });
    column("broken", [&](Row r) {  // % of the contact area between grains
        return 100.0 * share[std::min(static_cast<std::size_t>(r.cracks_tensile + r.cracks_shear), share.size() - 1)];
    });
    return json;
}

/// Adds the test's numbers of a group.
void add(Json& json, const TestResult& result, QuantityGroup group) {
    for (const TestQuantity& quantity : test_quantities()) {
        if (quantity.group != group || quantity.report == TestQuantity::absent) continue;
        const double value = quantity.value(result);
        Json& entry = json[quantity.report_name()];
        if (quantity.place.form == QuantityForm::yes_no)
            entry = value == 1.0;
        else
            entry = rounded(value * quantity.unit.factor);
    }
}

Json brazilian_json(const TestResult& result) {
    Json json;
    add(json, result, QuantityGroup::brazilian);
    json["why"] = validity_in_words(result.properties.brazilian);
    add(json, result, QuantityGroup::flattened);
    json["marks"] = Json::array();
    for (const BrazilianMark& mark : brazilian_marks(result))
        json["marks"].push_back({{"name", mark.name},
                                 {"strain", rounded(mark.axial_strain * 1e3)},
                                 {"stress", rounded(mark.stress_Pa * MPa)},
                                 {"crack", mark.crack}});
    return json;
}

/// The cycles of a test, as the report's table has them.
Json cycles_json(const TestResult& result) {
    Json list = Json::array();
    for (const CycleProperties& c : result.properties.cycles)
        list.push_back({{"peak", rounded(c.peak_stress_Pa * MPa)},
                        {"sigma3", rounded(c.sigma3_Pa * MPa)},
                        {"reloading", rounded(c.reloading_modulus_Pa * GPa)},
                        {"unloading", rounded(c.unloading_modulus_Pa * GPa)},
                        {"axial", rounded(c.permanent_axial_strain * 1e3)},
                        {"lateral", rounded(c.permanent_lateral_strain * 1e3)},
                        {"volumetric", rounded(c.permanent_volumetric_strain * 1e3)},
                        {"omega", rounded(c.damage * 1e3)},
                        {"first_crack", rounded(c.first_crack_Pa * MPa)},
                        {"sigma_ci", rounded(c.sigma_ci_Pa * MPa)},
                        {"sigma_cd", rounded(c.sigma_cd_Pa * MPa)},
                        {"work", rounded(c.work_J)},
                        {"dissipated", rounded(c.dissipated_J)},
                        {"cracks", c.cracks}});
    return list;
}

Json multi_stage_json(const TestResult& result) {
    const MultiStageProperties& p = result.properties.multi_stage;
    Json json, points = Json::array();
    for (std::size_t i = 0; i < p.sigma3_Pa.size(); ++i)
        points.push_back({rounded(p.sigma3_Pa[i] * MPa), rounded(p.reversal_Pa[i] * MPa), rounded(p.strength_Pa[i] * MPa)});
    json["points"] = points;
    add(json, result, QuantityGroup::multi_stage);
    return json;
}

/// What users read for a test: the method, or the name of a test of their own.
std::string title_of(const TestSpec& test) { return test.custom.name.empty() ? method_of(test).words.title : test.custom.name; }

/// What stands at the axes of a test's charts, without units.
Json axes_json(const TestResult& result) {
    const MethodWords& words = method_of(result.test).words;
    const bool flattened =
        method_of(result.test).reading == Reading::disc && std::isfinite(result.properties.brazilian.flat_coefficient);
    if (flattened)
        return {{"stress", std::string("k ") + words.stress}, {"strain", "Approach of the plates / distance of the flats"}};
    return {{"stress", words.stress}, {"strain", words.strain}};
}

/// The readings of gauges over the rows of the history that the report keeps, with the load (kN) that belongs to them.
Json gauges_json(const TestResult& result, std::size_t tests) {
    Json list = Json::array();
    const std::vector<std::size_t> kept = kept_rows(result, tests);
    for (std::size_t g = 0; g < result.gauges.size(); ++g) {
        const GaugeUnit unit = unit_of(result.gauges[g]);
        Json values = Json::array(), load = Json::array();
        for (const std::size_t r : kept) {
            const HistoryRow& row = result.history[r];
            values.push_back(g < row.gauges.size() ? rounded(row.gauges[g] * unit.factor) : Json(nullptr));
            load.push_back(rounded(row.axial_stress_Pa * result.section_m2 * 1e-3));
        }
        list.push_back({{"name", result.gauges[g].name},
                        {"unit", unit.name},
                        {"meaning", result.gauges[g].meaning},
                        {"values", values},
                        {"load", load}});
    }
    return list;
}

/// The numbers that the method adds, in words.
Json properties_json(const TestResult& result) {
    Json list = Json::array();
    for (const MethodProperty& property : method_of(result.test).properties)
        if (const double value = test_quantity(property.name).value(result); std::isfinite(value))
            list.push_back(
                {{"label", property.label}, {"value", rounded(value * property.unit.factor)}, {"unit", property.unit.user}});
    return list;
}

/// Acoustic emission with what its charts show: events over the axial strain, before the strength and behind it, and how many
/// have a magnitude of at least M.
Json emission_json(const TestResult& result) {
    Json json = acoustic_emission_json(result);
    if (json.is_null()) return json;
    json["fewest_events"] = fewest_events;
    constexpr std::size_t bins = 40;
    const std::vector<AcousticEvent>& events = result.emission.events;
    const auto [least, most] = std::ranges::minmax_element(result.history, {}, &HistoryRow::axial_strain);
    const double from = least->axial_strain, width = (most->axial_strain - from) / bins;
    const long long strength = result.history[strength_row(result)].step;
    std::vector<int> before(bins), behind(bins);
    std::vector<double> magnitudes;
    for (const AcousticEvent& event : events) {
        const double bin = width > 0.0 ? (event.axial_strain - from) / width : 0.0;
        ++(event.first_step <= strength ? before : behind)[std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, bin)))];
        if (std::isfinite(event.magnitude)) magnitudes.push_back(event.magnitude);
    }
    json["rate"] = {{"from", rounded(1e3 * from)}, {"width", rounded(1e3 * width)}, {"before", before}, {"behind", behind}};
    std::ranges::sort(magnitudes);
    json["magnitudes"] = Json::array();
    if (magnitudes.empty()) return json;
    constexpr double step = 0.1;
    for (auto m = static_cast<long long>(std::floor(magnitudes.front() / step));
         step * static_cast<double>(m) <= magnitudes.back(); ++m) {
        const double magnitude = step * static_cast<double>(m);
        json["magnitudes"].push_back(
            {rounded(magnitude), magnitudes.end() - std::ranges::lower_bound(magnitudes, magnitude - 1e-9)});
    }
    return json;
}

Json test_json(const TestResult& result, std::size_t tests) {
    Json test;
    if (!result.variant.empty()) test["variant"] = result.variant;
    test["stem"] = test_stem(result);
    test["kind"] = name(result.test.kind);
    test["title"] = title_of(result.test);
    test["pressure"] = method_of(result.test).reading != Reading::stages ? pressure_symbol(method_of(result.test)) : "";
    test["axes"] = axes_json(result);
    test["seed"] = result.seed;
    test["sigma3"] = rounded(result.test.sigma3_Pa * MPa);
    test["numerics"] = name(result.numerics.kind);
    add(test, result, QuantityGroup::strength);
    add(test, result, QuantityGroup::load);
    test["remarks"] = result.properties.remarks;
    add(test, result, QuantityGroup::peak);
    add(test, result, QuantityGroup::first_crack);
    const Reading reading = method_of(result.test).reading;
    if (reading == Reading::disc) test["brazilian"] = brazilian_json(result);
    test["properties"] = properties_json(result);
    if (!result.properties.cycles.empty()) test["cycles"] = cycles_json(result);
    if (reading == Reading::stages) test["multi_stage"] = multi_stage_json(result);
    if (reading == Reading::hole) add(test["hole"], result, QuantityGroup::hole);
    test["gauges"] = gauges_json(result, tests);
    add(test["post_peak"], result, QuantityGroup::post_peak);
    add(test, result, QuantityGroup::elastic);
    add(test["sigma_ci"], result, QuantityGroup::initiation);
    if (has_texture(result)) test["rock"] = texture_json(result);
    test["emission"] = emission_json(result);
    test["crack_initiation"] = rounded(result.properties.sigma_ci_crack_volume_Pa * MPa);
    for (const QuantityGroup group : {QuantityGroup::damage, QuantityGroup::cracks, QuantityGroup::steps, QuantityGroup::cost,
                                      QuantityGroup::evidence, QuantityGroup::balance})
        add(test, result, group);
    test["grade"] = std::string(1, result.evidence.grade);
    test["verdict"] = result.evidence.verdict;
    add(test, result, QuantityGroup::repeats);
    if (const FailureMode mode = failure_mode(result); !mode.name.empty())
        test["failure"] = {{"name", mode.name}, {"words", mode.words}};
    test["stop_reason"] = result.stop_reason;
    test["interrupted"] = result.interrupted;
    test["history"] = history_json(result, tests);
    return test;
}

/// The laboratory's numbers in user units, with the ratios that follow from them.
std::vector<std::pair<std::string, double>> laboratory(const Job& job) {
    std::vector<std::pair<std::string, double>> values;
    const auto find = [&](const char* key) {
        const auto place = job.laboratory.find(key);
        return place == job.laboratory.end() ? std::nan("") : place->second;
    };
    for (const auto& [key, value] : job.laboratory)
        values.emplace_back(property_of_laboratory(key), laboratory_in_user_units(key, value));
    const auto ratio = [&](const char* property, double over, double under) {
        if (std::isfinite(over) && under > 0.0) values.emplace_back(property, over / under);
    };
    ratio("UCS_over_BTS", find("UCS"), find("BTS"));
    ratio("UCS_over_DTS", find("UCS"), find("DTS"));
    ratio("BTS_over_DTS", find("BTS"), find("DTS"));
    return values;
}

/// How many of the tests that a property is read from have each grade. @param variant  whose tests; empty if the job has none
Json grades_json(std::string_view kept_name, const RockProperty& property, std::span<const TestResult> results,
                 const std::string& variant) {
    const std::optional<double> pressure_MPa = pressure_of_confined_strength_MPa(kept_name);
    int grades[3] = {};
    for (const TestResult& result : results) {
        const bool other_pressure = pressure_MPa && std::abs(result.test.sigma3_Pa * MPa - *pressure_MPa) > 1e-6 * *pressure_MPa;
        if (result.variant == variant && property.tests.contains(result.test.kind) && !other_pressure)
            ++grades[std::clamp(result.evidence.grade - 'A', 0, 2)];
    }
    return {{"A", grades[0]}, {"B", grades[1]}, {"C", grades[2]}};
}

/// @param results  the tests that they are read from, among others
Json properties_json(const Job& job, const PropertySummary& properties, std::span<const TestResult> results,
                     const std::string& variant = "") {
    struct Row {
        UserQuantity quantity;
        std::string_view kept_name;
        const PropertyStatistics* statistics;
    };
    std::vector<Row> ordered;
    for (const auto& [key, statistics] : properties.values) ordered.push_back({user_quantity(key), key, &statistics});
    std::ranges::stable_sort(ordered, {}, [](const Row& row) { return row.quantity.rank; });
    const auto measured = laboratory(job);
    Json rows = Json::array();
    for (const auto& [quantity, kept_name, statistics] : ordered) {
        Json row = {{"name", quantity.name},
                    {"label", quantity.label},
                    {"symbol", quantity.symbol},
                    {"unit", quantity.unit},
                    {"median", rounded(statistics->median * quantity.factor)},
                    {"minimum", rounded(statistics->minimum * quantity.factor)},
                    {"maximum", rounded(statistics->maximum * quantity.factor)},
                    {"packings", statistics->seeds.size()},
                    {"laboratory", nullptr}};
        for (const auto& [property, value] : measured) {
            if (user_quantity(property).name == quantity.name) row["laboratory"] = rounded(value);
        }
        const RockProperty* property = kept_rock_property(kept_name);
        row["main"] = property != nullptr && property->reported();
        if (property != nullptr) row["grades"] = grades_json(kept_name, *property, results, variant);
        rows.push_back(row);
    }
    return rows;
}

Json envelope_json(const PropertySummary& properties) {
    Json fits = Json::array();
    for (const EnvelopeFit& fit : properties.fits) {
        Json points = Json::array();
        for (std::size_t i = 0; i < std::min(fit.sigma1_Pa.size(), fit.sigma3_Pa.size()); ++i) {
            points.push_back({rounded(fit.sigma3_Pa[i] * MPa), rounded(fit.sigma1_Pa[i] * MPa)});
        }
        fits.push_back({{"seed", fit.seed},
                        {"cohesion", rounded(fit.cohesion_Pa * MPa)},
                        {"friction_angle", rounded(fit.friction_angle_deg)},
                        {"UCS_fitted", rounded(fit.UCS_fitted_Pa * MPa)},
                        {"UCS_measured", rounded(fit.UCS_measured_Pa * MPa)},
                        {"mi", rounded(fit.hoek_brown_mi)},
                        {"hoek_brown_UCS", rounded(fit.hoek_brown_UCS_Pa * MPa)},
                        {"points", points}});
    }
    return {{"method", properties.envelope_method}, {"fits", fits}};
}

Json shear_envelope_json(const PropertySummary& properties) {
    Json fits = Json::array();
    for (const ShearFit& fit : properties.shear_fits) {
        Json points = Json::array();
        for (std::size_t i = 0; i < fit.normal_Pa.size(); ++i)
            points.push_back({rounded(fit.normal_Pa[i] * MPa), rounded(fit.peak_Pa[i] * MPa), rounded(fit.residual_Pa[i] * MPa)});
        fits.push_back({{"seed", fit.seed},
                        {"cohesion", rounded(fit.cohesion_Pa * MPa)},
                        {"friction_angle", rounded(fit.friction_angle_deg)},
                        {"residual_cohesion", rounded(fit.residual_cohesion_Pa * MPa)},
                        {"residual_friction_angle", rounded(fit.residual_friction_angle_deg)},
                        {"points", points}});
    }
    return fits;
}

Json specimens_json(std::span<const TestResult> results) {
    // whose specimens they are: the job's first, then discs that tests cut, then what tests bring
    const auto owner = [](const TestResult& r) {
        return method_of(r.test).specimen.own_disc ? title_of(r.test) : r.test.specimen ? title_of(r.test) : "";
    };
    std::vector<std::pair<std::string, const TestResult*>> found;
    for (const TestResult& r : results)
        if (r.specimen && std::ranges::none_of(found, [&](const auto& one) { return one.first == owner(r); }))
            found.emplace_back(owner(r), &r);
    std::ranges::stable_sort(found, {}, [](const auto& one) { return one.first.empty() ? 0 : 1; });
    Json list = Json::array();
    for (const auto& [of, result] : found) {
        const Specimen& specimen = *result->specimen;
        const OutlineSpec& outline = specimen.spec.outline;
        std::string shape = fmt::format("polygon with {} corners", outline.vertices_m.size());
        if (outline.shape == Shape::rectangle)
            shape = fmt::format("rectangle, {:.6g} x {:.6g} mm", outline.width_m * 1e3, outline.height_m * 1e3);
        if (outline.shape == Shape::disc) shape = fmt::format("disc, diameter {:.6g} mm", outline.diameter_m * 1e3);
        if (outline.shape == Shape::half_disc) shape = fmt::format("half disc, diameter {:.6g} mm", outline.diameter_m * 1e3);
        if (outline.shape == Shape::ring)
            shape = fmt::format("ring, diameters {:.6g} and {:.6g} mm", outline.diameter_m * 1e3, outline.hole_diameter_m * 1e3);
        if (!outline.holes.empty()) shape += ", " + counted(outline.holes.size(), "hole");
        if (!outline.notches.empty())
            shape += fmt::format(", {} {}", outline.notches.size(), outline.notches.size() == 1 ? "notch" : "notches");
        if (specimen.outline.flattened())
            shape += fmt::format(", two flats of {:.4g} degrees", in_degrees(outline.flat_angle_rad));
        list.push_back({{"for", !of.empty()        ? of
                                : found.size() > 1 ? "all other tests"
                                                   : "all tests"},
                        {"shape", shape},
                        {"thickness", rounded(specimen.spec.thickness_m * 1e3)},
                        {"grains", specimen.quality.grains},
                        {"contacts", specimen.quality.contacts},
                        {"nodes", specimen.quality.nodes},
                        {"triangles", specimen.quality.triangles},
                        {"merged_edges", specimen.quality.merged_edges},
                        {"grain_mean", rounded(specimen.quality.cell_sizes.mean_m * 1e3)},
                        {"grain_minimum", rounded(specimen.quality.cell_sizes.minimum_m * 1e3)},
                        {"grain_maximum", rounded(specimen.quality.cell_sizes.maximum_m * 1e3)},
                        {"grain_D50", rounded(specimen.quality.cell_sizes.D50_m * 1e3)},
                        {"disc_mean", rounded(specimen.quality.disc_sizes.mean_m * 1e3)},
                        {"width_over_largest_grain", rounded(specimen.quality.width_over_largest_grain)},
                        {"warnings", specimen.quality.warnings}});
    }
    return list;
}

Json model_json(const Variant& variant) {
    return {{"grains", name(variant.model.kind)},
            {"contact", name(variant.model.contact)},
            {"plane", name(variant.model.plane)},
            {"law", name(variant.contact.law)},
            {"numerics", name(variant.numerics.kind)}};
}

Json variants_json(const Job& job, std::span<const TestResult> results) {
    Json list = Json::array();
    for (const VariantSummary& summary : summarise_variants(job, results)) {
        const Variant& variant = *summary.variant;
        Json json = {{"name", variant.name}};
        json.update(model_json(variant));
        json["normal"] = name(variant.model.normal);
        json["Kn"] = rounded(variant.contact.Kn_Pa_m * GPa);
        json["eta"] = rounded(variant.contact.eta);
        json["E"] = variant.model.kind == GrainKind::flexible ? rounded(variant.grain.E_Pa * GPa) : Json(nullptr);
        json["sigma_nt"] = rounded(variant.contact.sigma_nt_Pa * MPa);
        json["tau"] = rounded(variant.contact.tau_Pa * MPa);
        json["properties"] = properties_json(job, summary.properties, results, variant.name);
        json["envelope"] = envelope_json(summary.properties);
        json["ms_per_step"] = Json::object();
        for (const auto& [kind, cost] : summary.ms_per_step) json["ms_per_step"][name(kind)] = rounded(cost);
        list.push_back(json);
    }
    return list;
}

}  // namespace

std::size_t strength_row(const TestResult& result) {
    for (std::size_t r = 0; r < result.history.size(); ++r)
        if (std::abs(result.history[r].axial_stress_Pa) >= (1.0 - 1e-9) * result.properties.peak_stress_Pa) return r;
    return result.history.empty() ? 0 : result.history.size() - 1;
}

Json rounded(double value) {
    if (!std::isfinite(value)) return nullptr;
    if (value == std::trunc(value) && std::abs(value) < 1e9) return static_cast<long long>(value);
    return std::strtod(fmt::format("{:.5e}", value).c_str(), nullptr);
}

Json report_data(const Job& job, std::span<const TestResult> results, const PropertySummary& properties,
                 const Provenance& provenance, bool complete, std::span<const FailedTest> failed) {
    Json data;
    data["job"] = {{"name", job.name}, {"file", job.file.string()}, {"resolved", resolved_toml(job)}, {"seeds", job.seeds}};
    data["complete"] = complete;
    data["signs"] = sign_convention;
    data["model"] = model_json(job.variants.front());
    if (job.has_variants()) data["variants"] = variants_json(job, results);
    data["specimens"] = specimens_json(results);
    data["properties"] = properties_json(job, job.has_variants() ? PropertySummary{} : properties, results);
    data["laboratory"] = Json::object();
    for (const auto& [property, value] : laboratory(job)) data["laboratory"][user_quantity(property).name] = rounded(value);
    data["envelope"] = envelope_json(job.has_variants() ? PropertySummary{} : properties);
    data["shear_envelope"] = job.has_variants() ? Json::array() : shear_envelope_json(properties);
    data["tests"] = Json::array();
    for (const TestResult& result : results) data["tests"].push_back(test_json(result, results.size()));
    data["failed"] = Json::array();
    for (const FailedTest& test : failed)
        data["failed"].push_back({{"variant", test.variant},
                                  {"kind", name(test.test.kind)},
                                  {"title", title_of(test.test)},
                                  {"pressure", pressure_symbol(method_of(test.test))},
                                  {"seed", test.seed},
                                  {"sigma3", rounded(test.test.sigma3_Pa * MPa)},
                                  {"reason", test.reason}});
    data["provenance"] = provenance_json(provenance);
    return data;
}

}  // namespace feldspar
