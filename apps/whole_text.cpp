#include "whole_text.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "commands.hpp"

namespace feldspar {

ExitCode pages_command(const std::string& text) { return print_whole(text); }

ExitCode print_whole(const std::string& text) {
    const bool whole = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (!whole) throw OutputError("the text could not be printed");
    return ExitCode::success;
}

void write_whole(const std::string& text, const std::string& path, const std::string& option) {
    namespace fs = std::filesystem;
    const auto refuse = [&](int error) {
        throw InputError({{}, 0, 0, option},
                         fmt::format("'{}' {}", path,
                                     error == EEXIST ? "exists already and is not overwritten"
                                                     : fmt::format("cannot be made: {}", std::strerror(error))),
                         "the name of a new file in a directory that exists");
    };
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(path, ignored))) refuse(EEXIST);
    std::string aside;
    std::FILE* file = nullptr;
    for (int attempt = 0; file == nullptr && attempt < 100;
         ++attempt) {  // never one that is there: in a directory that others may write to it may be a link to anywhere
        aside = (fs::path(path).parent_path() / fmt::format(".feldspar-{}-{}.part", ::getpid(), attempt)).string();
        file = std::fopen(aside.c_str(), "wx");
        if (file == nullptr && errno != EEXIST) break;
    }
    if (file == nullptr) refuse(errno);
    errno = 0;
    bool whole =
        std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0 && ::fsync(::fileno(file)) == 0;
    int error = errno;
    if (std::fclose(file) != 0 && whole) {
        whole = false;
        error = errno;
    }
    // a link is never made over a file that is there; where the file system has none, a file that came in the meantime is lost
    if (whole && ::link(aside.c_str(), path.c_str()) != 0 && (errno == EEXIST || ::rename(aside.c_str(), path.c_str()) != 0)) {
        whole = false;
        error = errno;
    }
    ::unlink(aside.c_str());
    if (error == EEXIST && !whole) refuse(error);
    if (!whole) throw OutputError(fmt::format("cannot write '{}': {}", path, std::strerror(error)));
}

}  // namespace feldspar
