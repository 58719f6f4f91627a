#include "benchmarks/report.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "feldspar/base/error.hpp"

namespace feldspar::benchmarks {

// A key a member, both ways.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Machine, processor, vector_bits, cores, system, compiler, build_type, version, commit, started)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Counts, grains, bodies, nodes, triangles, contacts, points, memory_bytes)

namespace {

using nlohmann::json;

constexpr const char* kFormat = "feldspar benchmark 1";

json rates_json(const Rates& r) { return {{"multiply_add_GFLOPs", r.multiply_add}, {"memory_GB_s", r.memory}}; }

Rates rates_from(const json& j) { return {.multiply_add = j.at("multiply_add_GFLOPs"), .memory = j.at("memory_GB_s")}; }

json block_json(const Block& b) {
    return {{"steps", b.steps},
            {"wall_s", b.wall_s},
            {"cpu_s", b.cpu_s},
            {"waited_s", b.waited_s},
            {"before", rates_json(b.before)},
            {"after", rates_json(b.after)}};
}

Block block_from(const json& j) {
    Block b;
    j.at("steps").get_to(b.steps);
    j.at("wall_s").get_to(b.wall_s);
    j.at("cpu_s").get_to(b.cpu_s);
    j.at("waited_s").get_to(b.waited_s);
    b.before = rates_from(j.at("before"));
    b.after = rates_from(j.at("after"));
    return b;
}

json calibrations_json(const BestCalibrations& best) {
    json list = json::array();
    for (const auto& [threads, rate] : best) list.push_back({{"threads", threads}, {"GFLOPs_a_core", rate}});
    return list;
}

BestCalibrations calibrations_from(const json& list) {
    BestCalibrations best;
    for (const json& one : list) best[one.at("threads")] = one.at("GFLOPs_a_core");
    return best;
}

json reading_json(const Reading& reading, const Report& report) {
    const Summary s = summarise(reading, report.best, report.quiet);
    json blocks = json::array();
    for (const Block& block : reading.blocks) blocks.push_back(block_json(block));
    return {{"name", reading.name},
            {"stage", reading.stage},
            {"threads", reading.threads},
            {"counts", reading.counts},
            {"best_ms", 1e3 * s.best_s},
            {"median_ms", 1e3 * s.median_s},
            {"cpu_ms", 1e3 * s.cpu_s},
            {"memory_GB_s", s.memory_rate},
            {"quiet_blocks", s.quiet_blocks},
            {"disturbed", s.disturbed},
            {"blocks", blocks}};
}

Reading reading_from(const json& j) {
    Reading reading;
    j.at("name").get_to(reading.name);
    j.at("stage").get_to(reading.stage);
    j.at("threads").get_to(reading.threads);
    j.at("counts").get_to(reading.counts);
    for (const json& block : j.at("blocks")) reading.blocks.push_back(block_from(block));
    return reading;
}

}  // namespace

std::string to_json(const Report& report) {
    json readings = json::array();
    for (const Reading& reading : report.readings) readings.push_back(reading_json(reading, report));
    const json all = {{"format", kFormat},
                      {"machine", report.machine},
                      {"quiet", {{"share", report.quiet.share}, {"blocks", report.quiet.blocks}}},
                      {"best_calibrations", calibrations_json(report.best)},
                      {"best_calibrations_on_record", calibrations_json(report.on_record)},
                      {"readings", readings}};
    return all.dump(1) + "\n";
}

Report from_json(const std::string& text, const std::string& origin) {
    const InputPlace place{origin, 0, 0, ""};
    try {
        const json all = json::parse(text);
        if (all.at("format") != kFormat) throw InputError(place, "this is not a report of this benchmark", kFormat);
        Report report;
        all.at("machine").get_to(report.machine);
        all.at("quiet").at("share").get_to(report.quiet.share);
        all.at("quiet").at("blocks").get_to(report.quiet.blocks);
        report.best = calibrations_from(all.at("best_calibrations"));
        report.on_record = calibrations_from(all.at("best_calibrations_on_record"));
        for (const json& reading : all.at("readings")) report.readings.push_back(reading_from(reading));
        return report;
    } catch (const json::exception& error) {
        throw InputError(place, fmt::format("this is not a report of this benchmark ({})", error.what()),
                         "a file written with --out");
    }
}

void write_report(const Report& report, const std::filesystem::path& file) {
    const std::filesystem::path aside = file.string() + ".part";
    std::ofstream stream(aside, std::ios::binary);
    stream << to_json(report);
    stream.close();
    std::error_code failed;
    if (stream) std::filesystem::rename(aside, file, failed);
    if (!stream || failed) throw OutputError(fmt::format("the report could not be written to {}", file.string()));
}

Report read_report(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError({file.string(), 0, 0, ""}, "the report cannot be opened", "a file written with --out");
    std::ostringstream text;
    text << stream.rdbuf();
    return from_json(text.str(), file.string());
}

}  // namespace feldspar::benchmarks
