#include "progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

namespace feldspar {
namespace {

constexpr std::chrono::seconds plain_line_interval{10};

std::size_t terminal_columns() {
    struct winsize size {};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80;
}

std::string line_of(const std::string& label, const TestProgress& p) {
    std::string line = fmt::format("{}: {}, stress {:.2f} MPa, strain {:.4f} %, {} cracks", label, p.stage, p.axial_stress_Pa / 1e6,
                                   100.0 * p.axial_strain, p.cracks);
    if (p.steps_per_second > 0.0) line += fmt::format(", {} steps at {:.0f}/s", p.step, p.steps_per_second);
    if (p.step > 0 && p.seconds_left >= 0.0 && std::isfinite(p.seconds_left)) line += fmt::format(", about {} left", duration_text(p.seconds_left));
    return line;
}

}  // namespace

std::string duration_text(double seconds) {
    if (!std::isfinite(seconds) || seconds < 0.0) return "unknown time";
    if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<long long>(std::llround(std::min(seconds, 1e15)));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

Progress::Progress() : terminal_(isatty(STDERR_FILENO) == 1) {}

void Progress::clear() {
    if (!line_shown_) return;
    std::fputs("\r\x1b[K", stderr);
    line_shown_ = false;
}

void Progress::rewrite(const std::string& line) {
    fmt::print(stderr, "\r\x1b[K{}", line.substr(0, terminal_columns() - 1));
    std::fflush(stderr);
    line_shown_ = true;
}

void Progress::note(const std::string& line) {
    clear();
    fmt::print(stderr, "{}\n", line);
    std::fflush(stderr);
}

void Progress::busy(const std::string& what) {
    if (terminal_) rewrite(what);
    else note(what);
    last_line_ = std::chrono::steady_clock::now();
}

void Progress::report(const std::string& label, const TestProgress& progress) {
    const std::string line = line_of(label, progress);
    if (terminal_) {
        rewrite(line);
        return;
    }
    const auto now = std::chrono::steady_clock::now();
    const bool news = label != last_label_ || progress.stage != last_stage_;
    if (!news && now - last_line_ < plain_line_interval) return;
    note(line);
    last_label_ = label;
    last_stage_ = progress.stage;
    last_line_ = now;
}

}  // namespace feldspar
