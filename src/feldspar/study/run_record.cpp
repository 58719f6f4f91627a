#include "feldspar/study/run_record.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "feldspar/base/error.hpp"
#include "feldspar/lab/quantities.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/study/text_hash.hpp"

namespace feldspar {
namespace {

using Json = nlohmann::ordered_json;

// What is known of a run before it starts.
RunRecord record_for(const Run& run, const Provenance& provenance) {
    RunRecord record;
    record.id = run.id;
    record.test = name(run.test().kind);
    record.sigma3_Pa = run.test().sigma3_Pa;
    record.seed = run.seed();
    record.job = resolved_toml(run.job);
    const Variant& variant = run.job.variants.front();
    record.texts = {{"grains", name(variant.model.kind)}, {"law", name(variant.contact.law)},
                    {"version", provenance.version},      {"commit_id", provenance.commit},
                    {"machine", provenance.machine},      {"compiler", provenance.compiler},
                    {"started", provenance.started},      {"command_line", provenance.command_line}};
    if (!provenance.device.empty()) record.texts["machine"] += "; steps on " + provenance.device;
    return record;
}

constexpr const char* record_format = "feldspar run 1";

Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// Of all that stands before it.
std::string checksum_of(const Json& json) { return hash_of_text(json.dump(-1, ' ', false, Json::error_handler_t::replace)); }

double number_in(const Json& json) { return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>(); }

}  // namespace

const char* name(RunState state) {
    switch (state) {
        case RunState::running:
            return "running";
        case RunState::done:
            return "done";
        case RunState::failed:
            return "failed";
    }
    return "?";
}

const char* name(Failure failure) {
    switch (failure) {
        case Failure::input:
            return "input";
        case Failure::numerical:
            return "numerical";
        case Failure::other:
            return "other";
    }
    return "?";
}

const std::vector<std::string>& number_columns() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const TestQuantity& quantity : test_quantities())
            if (quantity.ledger != TestQuantity::absent) all.push_back(quantity.kept_name());
        return all;
    }();
    return names;
}

const std::vector<std::string>& text_columns() {
    static const std::vector<std::string> names{"grains",  "law",       "grade",   "verdict",  "stop_reason", "failure",
                                                "version", "commit_id", "machine", "compiler", "started",     "command_line"};
    return names;
}

RunRecord record_of(const Run& run, const TestResult& result, const Provenance& provenance) {
    RunRecord record = record_for(run, provenance);
    record.state = RunState::done;
    for (const TestQuantity& quantity : test_quantities())
        if (quantity.ledger != TestQuantity::absent) record.numbers[quantity.kept_name()] = quantity.value(result);
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
        if (record.state == RunState::done)
            settled.done.insert(record.id);
        else if (program != nullptr && failed_for_good(record, *program))
            settled.failed.insert(record.id);
    }
    return settled;
}

TestResult result_of(const RunRecord& record) {
    TestResult result;
    if (const auto method = find_method(record.test)) result.test.kind = *method;
    result.test.sigma3_Pa = record.sigma3_Pa;
    result.seed = record.seed;
    for (const TestQuantity& quantity : test_quantities()) {
        if (quantity.ledger == TestQuantity::absent) continue;
        const auto found = record.numbers.find(quantity.kept_name());
        quantity.put(result, found == record.numbers.end() ? std::numeric_limits<double>::quiet_NaN() : found->second);
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
    Json json{{"id", record.id},
              {"state", name(record.state)},
              {"reason", record.reason},
              {"test", record.test},
              {"sigma3_Pa", number_json(record.sigma3_Pa)},
              {"seed", record.seed}};
    json["numbers"] = Json::object();
    for (const std::string& column : number_columns())
        if (const auto found = record.numbers.find(column); found != record.numbers.end())
            json["numbers"][column] = number_json(found->second);
    json["texts"] = record.texts;
    json["job"] = record.job;
    json["format"] = record_format;
    json["checksum"] = checksum_of(json);
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

RunRecord read_record(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError({file.string(), 0, 0, {}}, "cannot be read");
    try {
        Json json = Json::parse(stream);
        if (const auto checksum = json.find("checksum"); checksum != json.end()) {  // records of earlier versions have none
            const Json expected = *checksum;
            json.erase("checksum");
            if (expected != checksum_of(json))
                throw InputError({file.string(), 0, 0, {}}, "is damaged: it is not what was written");
        }
        if (json.value("format", record_format) != record_format)
            throw InputError({file.string(), 0, 0, "format"},
                             "'" + json.at("format").get<std::string>() + "' was written by a later version of this program",
                             record_format);
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
