#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "commands.hpp"
#include "say.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

constexpr std::array pages{"report.html", "envelope.html", "converge.html", "calibration.html"};

std::optional<fs::path> page_in(const fs::path& directory) {
    std::error_code error;
    for (const char* page : pages)
        if (fs::is_regular_file(directory / page, error)) return directory / page;
    return std::nullopt;
}

// The page of the directory in results/ that was written last.
fs::path newest_page() {
    std::optional<fs::path> newest;
    fs::file_time_type newest_time;
    std::error_code error;
    for (fs::directory_iterator entry("results", error), end; !error && entry != end; entry.increment(error)) {
        const std::optional<fs::path> page = page_in(entry->path());
        std::error_code unknown;
        const auto time = page ? fs::last_write_time(*page, unknown) : fs::file_time_type{};
        if (!page || unknown || (newest && time <= newest_time)) continue;
        newest = page;
        newest_time = time;
    }
    if (!newest)
        throw InputError({{}, 0, 0, "RUN"}, "there is no report in results/",
                         "the directory of a run, such as results/granite-1");
    return *newest;
}

fs::path page_of(const std::string& run) {
    std::error_code error;
    if (fs::is_regular_file(run, error)) {
        if (fs::path(run).extension() == ".html") return run;
        throw InputError({{}, 0, 0, "RUN"}, fmt::format("'{}' is not a page", run), "the directory of a run, or its report.html");
    }
    if (!fs::is_directory(run, error))
        throw InputError({{}, 0, 0, "RUN"}, fmt::format("there is no directory '{}'", run),
                         "the directory of a run, such as results/granite-1");
    if (const auto page = page_in(run)) return *page;
    throw InputError({{}, 0, 0, "RUN"}, fmt::format("there is no report in '{}'", run),
                     "the directory of a run, a study, an envelope or a calibration",
                     "a run writes its report when its first test has ended");
}

bool set(const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && value[0] != '\0';
}

// Whether a program was started that shows the page. It goes on when this one has ended.
bool opened(const fs::path& page) {
    const std::string file = page.string();
    const pid_t child = ::fork();
    if (child < 0) return false;
    if (child == 0) {
        (void)::setsid();
        const int nothing = ::open("/dev/null", O_RDWR);
        for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) (void)::dup2(nothing, descriptor);
        ::execlp("xdg-open", "xdg-open", file.c_str(), static_cast<char*>(nullptr));
        ::_exit(127);
    }
    for (int tenths = 0; tenths < 20; ++tenths) {  // xdg-open comes back at once, unless it is the browser itself
        int status = 0;
        if (::waitpid(child, &status, WNOHANG) == child) return WIFEXITED(status) && WEXITSTATUS(status) == 0;
        ::usleep(100'000);
    }
    return true;
}

}  // namespace

ExitCode view_command(const ViewOptions& options) {
    std::error_code error;
    const fs::path page = fs::absolute(options.run ? page_of(*options.run) : newest_page(), error);
    say("{}\n", page.string());
    std::fflush(stdout);
    if (options.print) return ExitCode::success;
    if (!set("DISPLAY") && !set("WAYLAND_DISPLAY"))
        say(stderr, "there is no display here: open the page in a browser\n");
    else if (!opened(page))
        say(stderr, "no browser could be started by xdg-open: open the page in one yourself\n");
    return ExitCode::success;
}

}  // namespace feldspar
