// Where the results came from: program, machine, time.
#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>
#include <string>
#include <utility>

#include "feldspar/output/provenance_json.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar_commit.hpp"  // made at build time

namespace feldspar {

namespace {

/// The value behind `key`, or an empty string. For lines such as "model name : x" and NAME="x".
std::string value_in_file(const char* file, const std::string& key) {
    std::ifstream input(file);
    for (std::string line; std::getline(input, line);) {
        if (!line.starts_with(key)) continue;
        const auto begin = line.find_first_not_of(" \t:=\"", key.size());
        const auto end = line.find_last_not_of(" \t\"");
        if (begin != std::string::npos && end >= begin) return line.substr(begin, end - begin + 1);
    }
    return {};
}

std::string processor_and_system() {
    std::string processor = value_in_file("/proc/cpuinfo", "model name");
    utsname system{};
    const bool known = uname(&system) == 0;
    if (processor.empty()) processor = known ? system.machine : "unknown processor";
    std::string distribution = value_in_file("/etc/os-release", "PRETTY_NAME");
    if (distribution.empty()) distribution = "unknown distribution";
    return known ? fmt::format("{}; {} ({} {}, {})", processor, distribution, system.sysname, system.release, system.machine)
                 : fmt::format("{}; {}", processor, distribution);
}

std::string compiler_name() {
#if defined(__clang__)
    return fmt::format("Clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#elif defined(__GNUC__)
    return fmt::format("GCC {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#else
    return "unknown compiler";
#endif
}

std::string now_utc() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&now, &parts);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday,
                       parts.tm_hour, parts.tm_min, parts.tm_sec);
}

}  // namespace

Provenance collect_provenance(std::string command_line, int threads) {
    Provenance provenance;
    provenance.version = FELDSPAR_VERSION;
    provenance.commit = FELDSPAR_COMMIT;
    provenance.machine = processor_and_system();
    provenance.compiler = compiler_name();
    provenance.started = now_utc();
    provenance.command_line = std::move(command_line);
    provenance.threads = threads;
    return provenance;
}

nlohmann::ordered_json provenance_json(const Provenance& provenance) {
    nlohmann::ordered_json json{{"version", provenance.version},          {"commit", provenance.commit},
                                {"machine", provenance.machine},          {"compiler", provenance.compiler},
                                {"started", provenance.started},          {"threads", provenance.threads},
                                {"command_line", provenance.command_line}};
    if (!provenance.device.empty()) json["device"] = provenance.device;
    if (provenance.ranks > 1) json["ranks"] = provenance.ranks;
    return json;
}

}  // namespace feldspar
