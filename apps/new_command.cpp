#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "commands.hpp"
#include "feldspar/job/job_template.hpp"
#include "feldspar/job/presets.hpp"

namespace feldspar {

namespace {

ExitCode print_whole(const std::string& text) {
    const bool whole = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (!whole) throw OutputError("the text could not be printed");
    return ExitCode::success;
}

}  // namespace

ExitCode presets_command() { return print_whole(preset_overview()); }

ExitCode new_command(const std::string& kind, const std::optional<std::string>& out) {
    const std::string text = job_template(kind);
    if (!out) return print_whole(text);
    errno = 0;
    std::FILE* file = std::fopen(out->c_str(), "wx");  // x: never an existing file
    if (file == nullptr) {
        const bool exists = errno == EEXIST;
        throw InputError({{}, 0, 0, "--out"},
                         fmt::format("'{}' {}", *out,
                                     exists ? "exists already and is not overwritten"
                                            : fmt::format("cannot be made: {}", std::strerror(errno))),
                         "the name of a new file in a directory that exists");
    }
    bool whole = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    whole = std::fclose(file) == 0 && whole;
    if (!whole) {
        std::remove(out->c_str());
        throw OutputError(fmt::format("'{}' could not be written to its end", *out));
    }
    fmt::print(stderr, "wrote {}; next: feldspar check {}\n", *out, *out);
    return ExitCode::success;
}

}  // namespace feldspar
