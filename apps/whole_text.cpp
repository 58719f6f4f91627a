#include "whole_text.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace feldspar {

ExitCode print_whole(const std::string& text) {
    const bool whole = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (!whole) throw OutputError("the text could not be printed");
    return ExitCode::success;
}

void write_whole(const std::string& text, const std::string& path, const std::string& option) {
    errno = 0;
    std::FILE* file = std::fopen(path.c_str(), "wx");  // x: never an existing file
    if (file == nullptr) {
        const bool exists = errno == EEXIST;
        throw InputError(
            {{}, 0, 0, option},
            fmt::format("'{}' {}", path, exists ? "exists already and is not overwritten" : fmt::format("cannot be made: {}", std::strerror(errno))),
            "the name of a new file in a directory that exists");
    }
    bool whole = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    whole = std::fclose(file) == 0 && whole;
    if (!whole) {
        std::remove(path.c_str());
        throw OutputError(fmt::format("'{}' could not be written to its end", path));
    }
}

}  // namespace feldspar
