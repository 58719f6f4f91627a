#include "feldspar/study/run_record.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "feldspar/base/error.hpp"
#include "feldspar/lab/failure_pattern.hpp"

namespace feldspar {
namespace {

using Json = nlohmann::ordered_json;

// A number of a record, and where it stands in a result. What summarise() does not read is not put back.
struct Number {
    const char* name;
    double (*of)(const TestResult&);
    void (*put)(TestResult&, double) = [](TestResult&, double) {};
};

template <double TestProperties::* member>
Number property(const char* name) {
    return {name, [](const TestResult& r) { return r.properties.*member; }, [](TestResult& r, double value) { r.properties.*member = value; }};
}

template <double QuasiStaticEvidence::* member>
Number evidence(const char* name) {
    return {name, [](const TestResult& r) { return r.evidence.*member; }, [](TestResult& r, double value) { r.evidence.*member = value; }};
}

double count(const TestResult& result, CrackMode mode) {
    return static_cast<double>(std::count_if(result.cracks.begin(), result.cracks.end(), [mode](const Crack& c) { return c.mode == mode; }));
}

template <double FailurePattern::* member>
Number pattern(const char* name) {
    return {name, [](const TestResult& r) { return failure_pattern(r).*member; }};
}

template <double BrazilianFailure::* member>
Number brazilian(const char* name) {
    return {name, [](const TestResult& r) { return r.test.kind == TestKind::brazilian ? r.properties.brazilian.*member : BrazilianFailure::none; },
            [](TestResult& r, double value) { r.properties.brazilian.*member = value; }};
}

template <bool BrazilianFailure::* member>
Number brazilian_is(const char* name) {
    return {name, [](const TestResult& r) { return r.test.kind == TestKind::brazilian ? (r.properties.brazilian.*member ? 1.0 : 0.0) : BrazilianFailure::none; },
            [](TestResult& r, double value) { r.properties.brazilian.*member = value == 1.0; }};
}

template <double PostPeak::* member>
Number post_peak(const char* name) {
    return {name, [](const TestResult& r) { return r.properties.post_peak.*member; },
            [](TestResult& r, double value) { r.properties.post_peak.*member = value; }};
}

const std::vector<Number>& numbers() {
    static const std::vector<Number> all{
        property<&TestProperties::peak_stress_Pa>("strength_Pa"),
        {"peak_reached", [](const TestResult& r) { return r.properties.peak_reached ? 1.0 : 0.0; },
         [](TestResult& r, double value) { r.properties.peak_reached = value == 1.0; }},
        property<&TestProperties::E_secant_Pa>("E_Pa"),
        property<&TestProperties::E_tangent_Pa>("E_tangent_Pa"),
        property<&TestProperties::E_average_Pa>("E_average_Pa"),
        property<&TestProperties::E_gauge_Pa>("E_gauge_Pa"),
        property<&TestProperties::nu>("nu"),
        property<&TestProperties::nu_tangent>("nu_tangent"),
        property<&TestProperties::E_initial_Pa>("E_initial_Pa"),
        property<&TestProperties::nu_initial>("nu_initial"),
        property<&TestProperties::first_crack_Pa>("first_crack_Pa"),
        property<&TestProperties::sigma_ci_crack_count_Pa>("sigma_ci_crack_count_Pa"),
        property<&TestProperties::sigma_ci_crack_volume_Pa>("sigma_ci_crack_volume_Pa"),
        property<&TestProperties::sigma_ci_lateral_strain_Pa>("sigma_ci_lateral_strain_Pa"),
        property<&TestProperties::sigma_cd_Pa>("sigma_cd_Pa"),
        post_peak<&PostPeak::modulus_Pa>("post_peak_modulus_Pa"),
        post_peak<&PostPeak::brittleness>("brittleness_k1"),
        post_peak<&PostPeak::fracture_share>("post_peak_fracture_share"),
        post_peak<&PostPeak::friction_share>("post_peak_friction_share"),
        post_peak<&PostPeak::damping_share>("post_peak_damping_share"),
        brazilian_is<&BrazilianFailure::split>("BTS_split"),
        brazilian_is<&BrazilianFailure::valid>("BTS_valid"),
        brazilian<&BrazilianFailure::first_dip_Pa>("BTS_first_dip_Pa"),
        brazilian<&BrazilianFailure::largest_Pa>("BTS_largest_Pa"),
        brazilian<&BrazilianFailure::crack_span>("BTS_crack_span"),
        brazilian<&BrazilianFailure::first_crack_radius>("BTS_first_crack_radius"),
        brazilian<&BrazilianFailure::first_crack_angle_deg>("BTS_first_crack_angle_deg"),
        brazilian<&BrazilianFailure::first_crack_share>("BTS_first_crack_share"),
        brazilian<&BrazilianFailure::splitting_radius>("BTS_splitting_radius"),
        brazilian<&BrazilianFailure::splitting_angle_deg>("BTS_splitting_angle_deg"),
        brazilian<&BrazilianFailure::splitting_share>("BTS_splitting_share"),
        brazilian<&BrazilianFailure::contact_arc_top_deg>("BTS_contact_arc_top_deg"),
        brazilian<&BrazilianFailure::contact_arc_bottom_deg>("BTS_contact_arc_bottom_deg"),
        brazilian<&BrazilianFailure::flat_coefficient>("BTS_flat_coefficient"),
        {"cracks_tensile", [](const TestResult& r) { return count(r, CrackMode::tensile); }},
        {"cracks_shear", [](const TestResult& r) { return count(r, CrackMode::shear); }},
        pattern<&FailurePattern::tensile_share>("tensile_share"),
        pattern<&FailurePattern::crack_angle_deg>("crack_angle_deg"),
        pattern<&FailurePattern::crack_alignment>("crack_alignment"),
        pattern<&FailurePattern::crack_localisation>("crack_localisation"),
        pattern<&FailurePattern::post_peak_strain>("post_peak_strain"),
        evidence<&QuasiStaticEvidence::error_estimate>("error_estimate"),
        evidence<&QuasiStaticEvidence::residual_median>("residual_median"),
        evidence<&QuasiStaticEvidence::load_per_travel_time>("load_per_travel_time"),
        evidence<&QuasiStaticEvidence::imbalance_mean>("imbalance_mean"),
        evidence<&QuasiStaticEvidence::residual_mean>("residual_mean"),
        evidence<&QuasiStaticEvidence::residual_at_peak>("residual_at_peak"),
        evidence<&QuasiStaticEvidence::imbalance_max>("imbalance_max"),
        evidence<&QuasiStaticEvidence::kinetic_over_strain>("kinetic_over_strain"),
        evidence<&QuasiStaticEvidence::damping_over_fracture>("damping_over_fracture"),
        {"peak_change_at_third",
         [](const TestResult& r) { return r.evidence.confirmed ? r.evidence.peak_change_at_third : std::numeric_limits<double>::quiet_NaN(); },
         [](TestResult& r, double value) {
             r.evidence.confirmed = !std::isnan(value);
             if (r.evidence.confirmed) r.evidence.peak_change_at_third = value;
         }},
        {"energy_residual", [](const TestResult& r) { return r.energy_residual; }},
        {"energy_fracture_J", [](const TestResult& r) { return r.energy_at_end.fracture; }},
        {"energy_friction_J", [](const TestResult& r) { return r.energy_at_end.friction; }},
        {"energy_damping_J", [](const TestResult& r) { return r.energy_at_end.damping; }},
        {"steps", [](const TestResult& r) { return static_cast<double>(r.steps); },
         [](TestResult& r, double value) { r.steps = static_cast<long long>(value); }},
        {"steps_to_peak", [](const TestResult& r) { return static_cast<double>(r.steps_to_peak); },
         [](TestResult& r, double value) { r.steps_to_peak = static_cast<long long>(value); }},
        {"preparation_steps", [](const TestResult& r) { return static_cast<double>(r.preparation_steps); },
         [](TestResult& r, double value) { r.preparation_steps = static_cast<long long>(value); }},
        {"new_contacts", [](const TestResult& r) { return static_cast<double>(r.new_contacts); }},
        {"grain_count", [](const TestResult& r) { return r.specimen ? static_cast<double>(r.specimen->quality.grains) : 0.0; }},
        {"wall_s", [](const TestResult& r) { return r.wall_s; }, [](TestResult& r, double value) { r.wall_s = value; }},
        {"ms_per_step", [](const TestResult& r) { return r.ms_per_step; }, [](TestResult& r, double value) { r.ms_per_step = value; }},
        {"threads", [](const TestResult& r) { return static_cast<double>(r.threads); }},
    };
    return all;
}

// What is known of a run before it starts.
RunRecord record_for(const Run& run, const Provenance& provenance) {
    RunRecord record;
    record.id = run.id;
    record.test = name(run.test().kind);
    record.sigma3_Pa = run.test().sigma3_Pa;
    record.seed = run.seed();
    record.job = resolved_toml(run.job);
    const Variant& variant = run.job.variants.front();
    record.texts = {{"grains", name(variant.model.kind)},       {"law", name(variant.contact.law)},
                    {"version", provenance.version},            {"commit_id", provenance.commit},
                    {"machine", provenance.machine},            {"compiler", provenance.compiler},
                    {"started", provenance.started},            {"command_line", provenance.command_line}};
    return record;
}

Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

double number_in(const Json& json) { return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>(); }

}  // namespace

const char* name(RunState state) {
    switch (state) {
        case RunState::running: return "running";
        case RunState::done: return "done";
        case RunState::failed: return "failed";
    }
    return "?";
}

const char* name(Failure failure) {
    switch (failure) {
        case Failure::input: return "input";
        case Failure::numerical: return "numerical";
        case Failure::other: return "other";
    }
    return "?";
}

const std::vector<std::string>& number_columns() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const Number& number : numbers()) all.emplace_back(number.name);
        return all;
    }();
    return names;
}

const std::vector<std::string>& text_columns() {
    static const std::vector<std::string> names{"grains",  "law",       "grade",   "verdict",  "stop_reason", "failure", "version",
                                                "commit_id", "machine", "compiler", "started", "command_line"};
    return names;
}

RunRecord record_of(const Run& run, const TestResult& result, const Provenance& provenance) {
    RunRecord record = record_for(run, provenance);
    record.state = RunState::done;
    for (const Number& number : numbers()) record.numbers[number.name] = number.of(result);
    record.texts["grade"] = std::string(1, result.evidence.grade);
    record.texts["verdict"] = result.evidence.verdict;
    record.texts["stop_reason"] = result.stop_reason;
    return record;
}

RunRecord failed_record(const Run& run, const std::string& reason, Failure failure, const Provenance& provenance) {
    RunRecord record = record_for(run, provenance);
    record.state = RunState::failed;
    record.reason = reason;
    record.texts["failure"] = name(failure);
    return record;
}

bool failed_for_good(const RunRecord& record, const Provenance& program) {
    const auto is = [&](const char* column, const std::string& text) {
        const auto found = record.texts.find(column);
        return found != record.texts.end() && found->second == text;
    };
    return record.state == RunState::failed && (is("failure", name(Failure::input)) || is("failure", name(Failure::numerical))) &&
           is("version", program.version) && is("commit_id", program.commit);
}

SettledRuns settled_runs(std::span<const RunRecord> records, const Provenance* program) {
    SettledRuns settled;
    for (const RunRecord& record : records) {
        if (record.state == RunState::done) settled.done.insert(record.id);
        else if (program != nullptr && failed_for_good(record, *program)) settled.failed.insert(record.id);
    }
    return settled;
}

TestResult result_of(const RunRecord& record) {
    TestResult result;
    for (const TestKind kind : {TestKind::uniaxial_compression, TestKind::direct_tension, TestKind::biaxial, TestKind::brazilian})
        if (record.test == name(kind)) result.test.kind = kind;
    result.test.sigma3_Pa = record.sigma3_Pa;
    result.seed = record.seed;
    for (const Number& number : numbers()) {
        const auto found = record.numbers.find(number.name);
        number.put(result, found == record.numbers.end() ? std::numeric_limits<double>::quiet_NaN() : found->second);
    }
    const auto text = [&](const char* key) {
        const auto found = record.texts.find(key);
        return found == record.texts.end() ? std::string{} : found->second;
    };
    const std::string grade = text("grade");
    result.evidence.grade = grade.empty() ? 'C' : grade.front();
    result.evidence.verdict = text("verdict");
    result.stop_reason = text("stop_reason");
    return result;
}

std::string to_json(const RunRecord& record) {
    Json json{{"id", record.id},          {"state", name(record.state)}, {"reason", record.reason},
              {"test", record.test},      {"sigma3_Pa", number_json(record.sigma3_Pa)}, {"seed", record.seed}};
    json["numbers"] = Json::object();
    for (const std::string& column : number_columns())
        if (const auto found = record.numbers.find(column); found != record.numbers.end()) json["numbers"][column] = number_json(found->second);
    json["texts"] = record.texts;
    json["job"] = record.job;
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

RunRecord read_record(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError({file.string(), 0, 0, {}}, "cannot be read");
    try {
        const Json json = Json::parse(stream);
        RunRecord record;
        record.id = json.at("id");
        const std::string state = json.at("state");
        record.state = state == "done" ? RunState::done : state == "failed" ? RunState::failed : RunState::running;
        record.reason = json.at("reason");
        record.test = json.at("test");
        record.sigma3_Pa = number_in(json.at("sigma3_Pa"));
        record.seed = json.at("seed");
        for (const auto& [key, value] : json.at("numbers").items()) record.numbers[key] = number_in(value);
        record.texts = json.at("texts");
        record.job = json.at("job");
        return record;
    } catch (const nlohmann::json::exception& problem) {
        throw InputError({file.string(), 0, 0, {}}, std::string("is not the record of a run: ") + problem.what());
    }
}

}  // namespace feldspar
