#include "progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "feldspar/base/printable.hpp"
#include "feldspar/base/utf8.hpp"
#include "say.hpp"

namespace feldspar {
namespace {

constexpr std::chrono::seconds plain_line_interval{10};
constexpr std::chrono::milliseconds rewrite_interval{100};

struct Screen {
    std::size_t columns = 80, rows = 24;
};

Screen screen() {
    struct winsize size {};
    Screen known;
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0) return known;
    if (size.ws_col > 20) known.columns = size.ws_col;
    if (size.ws_row > 3) known.rows = size.ws_row;
    return known;
}

std::string rate_and_rest(const TestProgress& p) {
    std::string text;
    if (p.steps_per_second > 0.0) text += fmt::format(", {:.0f} steps/s", p.steps_per_second);
    if (p.step > 0 && p.seconds_left >= 0.0 && std::isfinite(p.seconds_left))
        text += fmt::format(", about {} left", duration_text(p.seconds_left));
    return text;
}

// A rewritten line is cut at the terminal's width, so what changes comes first and the test's name last.
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
    if (lines_shown_ == 0) return;
    std::string back = "\r";
    for (std::size_t line = 1; line < lines_shown_; ++line) back += "\x1b[A";
    put(stderr, back + "\x1b[J");
    lines_shown_ = 0;
}

void Progress::rewrite(const std::vector<std::string>& lines) {
    clear();
    const auto [columns, rows] = screen();
    const std::size_t shown = lines.size() < rows ? lines.size() : rows - 2;  // lines that scroll away could not be taken back
    std::string text;
    for (std::size_t i = 0; i < shown; ++i)
        text += (i > 0 ? "\n" : "") + std::string(first_columns(printable(lines[i], LineEnds::escaped), columns - 1));
    if (shown < lines.size()) text += fmt::format("\nand {} more", lines.size() - shown);
    put(stderr, text);
    std::fflush(stderr);
    lines_shown_ = shown + (shown < lines.size() ? 1 : 0);
}

void Progress::note(const std::string& line) {
    clear();
    put(stderr, printable(line) + "\n");
    std::fflush(stderr);
    last_rewrite_ = {};
}

void Progress::busy(const std::string& what) {
    if (terminal_)
        rewrite({what});
    else
        note(what);
}

void Progress::making(const std::string& what, const SpecimenProgress& progress) {
    const std::string line =
        fmt::format("making {} of {} grains: {}, {:.0f} %", what, progress.grains, progress.stage, 100.0 * progress.share);
    if (terminal_) {
        rewrite({line});
        return;
    }
    const auto now = Clock::now();
    if (what == making_ && now - last_making_ < plain_line_interval) return;
    if (what == making_) note(line);  // most are made before the first line is due
    making_ = what;
    last_making_ = now;
}

void Progress::report(int number, int count, const std::string& label, const TestProgress& progress) {
    const auto now = Clock::now();
    const auto [found, fresh] = running_.try_emplace(number);
    Running& test = found->second;
    if (fresh && !log_stages_) test.last_plain_line = now;
    const bool news = log_stages_ && test.stage != progress.stage;
    test.stage = progress.stage;
    if (terminal_) {
        test.line = short_line(number, count, label, progress);
        if (now - last_rewrite_ < rewrite_interval) return;
        std::vector<std::string> lines;
        for (const auto& [other, running] : running_) lines.push_back(running.line);
        rewrite(lines);
        last_rewrite_ = now;
        return;
    }
    // a log grows by a line every ten seconds, however many tests run
    if (!news && now - test.last_plain_line < plain_line_interval * static_cast<int>(running_.size())) return;
    test.last_plain_line = now;
    note(long_line(number, count, label, progress));
}

void Progress::ended(int number) { running_.erase(number); }

}  // namespace feldspar
