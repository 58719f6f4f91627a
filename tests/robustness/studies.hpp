// Studies that the program runs.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "program.hpp"

namespace feldspar::testing_program {

/// The numbers of every run that is done, but for those that tell of time.
inline std::map<std::string, std::string> finished(const TemporaryFolder& place) {
    std::map<std::string, std::string> runs;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(place / "results/study/runs", error)) {
        if (!fs::exists(entry.path() / "run.json")) continue;
        nlohmann::json record = nlohmann::json::parse(read_text(entry.path() / "run.json"));
        for (const char* time : {"wall_s", "ms_per_step", "threads"}) record["numbers"].erase(time);
        runs[entry.path().filename()] = record["numbers"].dump();
    }
    return runs;
}

}  // namespace feldspar::testing_program
