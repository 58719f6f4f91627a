// Another program, called and listened to.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace feldspar {

/// What a program left when it ended.
struct CallResult {
    int code = 0;  ///< exit code; 128 + signal when a signal ended it
    std::string out;
    std::string err;
};

/// Runs `command` (the program is looked for on PATH) in `directory` and waits for its end. Nothing if there is no such program.
/// @throws OutputError when it cannot be started for another reason
std::optional<CallResult> call_program(const std::vector<std::string>& command, const std::filesystem::path& directory = ".");

}  // namespace feldspar
