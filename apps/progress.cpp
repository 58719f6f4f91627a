#include "progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "feldspar/base/error.hpp"
#include "interrupt.hpp"

namespace feldspar {
namespace {

constexpr std::chrono::seconds plain_line_interval{10};

std::size_t terminal_columns() {
    struct winsize size {};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80;
}

std::string rate_and_rest(const TestProgress& p) {
    std::string text;
    if (p.steps_per_second > 0.0) text += fmt::format(", {:.0f} steps/s", p.steps_per_second);
    if (p.step > 0 && p.seconds_left >= 0.0 && std::isfinite(p.seconds_left))
        text += fmt::format(", about {} left", duration_text(p.seconds_left));
    return text;
}

// The rewritten line is cut at the terminal's width, so what changes comes first and the test's name last.
std::string short_line(int number, int count, const std::string& label, const TestProgress& p) {
    return fmt::format("{}/{} {}: {:.1f} MPa, {} cracks{}  [{}]", number, count, p.stage, p.axial_stress_Pa / 1e6, p.cracks,
                       rate_and_rest(p), label);
}

std::string long_line(int number, int count, const std::string& label, const TestProgress& p) {
    return fmt::format("{}/{} {}: {}, stress {:.2f} MPa, strain {:.4f} %, {} cracks, step {}{}", number, count, label, p.stage,
                       p.axial_stress_Pa / 1e6, 100.0 * p.axial_strain, p.cracks, p.step, rate_and_rest(p));
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
    if (terminal_)
        rewrite(what);
    else
        note(what);
    last_line_ = std::chrono::steady_clock::now();
}

void Progress::report_making(const std::string& what, const SpecimenProgress& progress) {
    if (stop_requested()) throw Interrupted();
    const std::string line =
        fmt::format("making {} of {} grains: {}, {:.0f} %", what, progress.grains, progress.stage, 100.0 * progress.share);
    const auto now = std::chrono::steady_clock::now();
    if (terminal_) {
        rewrite(line);
        return;
    }
    if (what == last_label_ && now - last_line_ < plain_line_interval) return;
    note(what == last_label_ ? line : fmt::format("making {}", what));   // most are made before the next line is due
    last_label_ = what;
    last_line_ = now;
}

SpecimenControl Progress::making(const std::string& what, int threads) {
    return {threads, [this, what](const SpecimenProgress& progress) { report_making(what, progress); }};
}

void Progress::report(int number, int count, const std::string& label, const TestProgress& progress) {
    if (terminal_) {
        rewrite(short_line(number, count, label, progress));
        return;
    }
    const auto now = std::chrono::steady_clock::now();
    const bool news = label != last_label_ || progress.stage != last_stage_;
    if (!news && now - last_line_ < plain_line_interval) return;
    note(long_line(number, count, label, progress));
    last_label_ = label;
    last_stage_ = progress.stage;
    last_line_ = now;
}

}  // namespace feldspar
