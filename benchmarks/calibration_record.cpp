#include "benchmarks/calibration_record.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

namespace feldspar::benchmarks {
namespace {

using nlohmann::json;

// {"<processor>": {"<threads>": GFLOP/s a core}}; empty if there is nothing of that form.
std::map<std::string, std::map<std::string, double>> read(const std::filesystem::path& file) {
    try {
        std::ifstream stream(file, std::ios::binary);
        return json::parse(stream).get<std::map<std::string, std::map<std::string, double>>>();
    } catch (const json::exception&) {
        return {};
    }
}

}  // namespace

BestCalibrations record_calibrations(const std::filesystem::path& file, const std::string& processor,
                                     const BestCalibrations& best) {
    auto all = read(file);
    BestCalibrations ever;
    for (const auto& [threads, rate] : best) {
        double& recorded = all[processor][std::to_string(threads)];
        recorded = ever[threads] = std::max(recorded, rate);
    }
    std::error_code failed;
    std::filesystem::create_directories(file.parent_path(), failed);
    const std::filesystem::path aside = file.string() + ".part";
    std::ofstream stream(aside, std::ios::binary);
    stream << json(all).dump(1) << '\n';
    stream.close();
    if (stream) std::filesystem::rename(aside, file, failed);
    return ever;
}

}  // namespace feldspar::benchmarks
