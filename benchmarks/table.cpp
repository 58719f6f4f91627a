#include "benchmarks/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/goals.hpp"

namespace feldspar::benchmarks {
namespace {

std::string machine_text(const Report& report) {
    const Machine& m = report.machine;
    std::string text = fmt::format("{}, vectors of {} bits, {} core{}; {}\n", m.processor, m.vector_bits, m.cores,
                                   m.cores == 1 ? "" : "s", m.system);
    text += fmt::format("Feldspar {} ({}), {}, {} build, {}\n", m.version, m.commit, m.compiler, m.build_type, m.started);
    for (const auto& [threads, rate] : report.best) {
        text += fmt::format("Best calibration with {} thread{}: {:.1f} GFLOP/s a core", threads, threads == 1 ? "" : "s", rate);
        const auto record = report.on_record.find(threads);
        if (record != report.on_record.end() && rate < report.quiet.share * record->second) {
            text += fmt::format("; an earlier run saw {:.1f}: this whole run may have been disturbed", record->second);
        }
        text += '\n';
    }
    return text;
}

// A time a piece, ns; empty where there are no such pieces, or where the stage has nothing to do with them.
std::string per_piece(double seconds, long long pieces, bool applies) {
    return pieces > 0 && applies ? fmt::format("{:.2f}", 1e9 * seconds / static_cast<double>(pieces)) : "";
}

std::string row(const Reading& reading, const Summary& s, int vector_bits, std::size_t name_width) {
    const Counts& c = reading.counts;
    const bool contacts = reading.stage != "bodies", bodies = reading.stage != "contacts";
    const std::optional<double> goal = goal_milliseconds(reading.name, vector_bits);
    return fmt::format("{:<{}} {:>10.4f} {:>10.4f} {:>10} {:>9.0f} {:>8} {:>8} {:>8} {:>7.2f} {:>7} {:>6.1f} {:>4}{}\n",
                       reading.name, name_width, 1e3 * s.best_s, 1e3 * s.median_s,
                       reading.threads == 1 ? fmt::format("{:.4f}", 1e3 * s.cpu_s) : "", 1.0 / s.best_s,
                       per_piece(s.best_s, c.triangles, bodies), per_piece(s.best_s, c.points, contacts),
                       per_piece(s.best_s, c.nodes, bodies), 1e-3 * c.memory_bytes / static_cast<double>(std::max(c.grains, 1LL)),
                       goal ? fmt::format("{:g}", *goal) : "", s.memory_rate, s.quiet_blocks, s.disturbed ? "  disturbed" : "");
}

std::size_t longest_name(const std::vector<std::string>& names) {
    std::size_t longest = 4;
    for (const std::string& name : names) longest = std::max(longest, name.size());
    return longest;
}

std::string mark(const Change& change) {
    if (!change.same_specimen) return "another specimen";
    if (change.disturbed) return "disturbed";
    if (!change.same_memory()) {
        return fmt::format("memory {} by {:.0f} %", change.memory_ratio > 1.0 ? "faster" : "slower",
                           100.0 * std::abs(change.memory_ratio - 1.0));
    }
    return change.slower() ? "SLOWER" : change.faster() ? "faster" : "";
}

}  // namespace

std::string report_table(const Report& report) {
    std::vector<std::string> names;
    for (const Reading& reading : report.readings) names.push_back(reading.name);
    const std::size_t width = longest_name(names);

    std::string text = machine_text(report) + "\n";
    text += fmt::format("{:<{}} {:>10} {:>10} {:>10} {:>9} {:>8} {:>8} {:>8} {:>7} {:>7} {:>6} {:>4}\n", "", width, "ms/step",
                        "median", "cpu ms", "", "ns per", "ns per", "ns per", "kB per", "goal", "memory", "");
    text += fmt::format("{:<{}} {:>10} {:>10} {:>10} {:>9} {:>8} {:>8} {:>8} {:>7} {:>7} {:>6} {:>4}\n", "case", width, "(best)",
                        "", "(1 thr.)", "steps/s", "triangle", "point", "node", "grain", "ms", "GB/s", "ok");
    int disturbed = 0;
    for (const Reading& reading : report.readings) {
        const Summary summary = summarise(reading, report.best, report.quiet);
        disturbed += summary.disturbed;
        text += row(reading, summary, report.machine.vector_bits, width);
    }
    text += fmt::format(
        "\nmemory: rate at which a core could read the shared cache meanwhile. ok: undisturbed blocks, {} wanted.\nGoals: what "
        "the step is meant to cost one day; memory below {:g} kB a flexible grain.\n",
        report.quiet.blocks, 1e-3 * kGoalBytesPerGrain);
    if (disturbed > 0) {
        text += fmt::format("{} of {} readings stayed disturbed: somebody else used the cores. Their times are upper bounds.\n",
                            disturbed, report.readings.size());
    }
    if (report.machine.build_type != "Release")
        text += fmt::format("This is a {} build: the times say nothing about the release.\n", report.machine.build_type);
    return text;
}

std::string comparison_table(const Comparison& comparison) {
    std::vector<std::string> names;
    for (const Change& change : comparison.changes) names.push_back(change.name);
    const std::size_t width = longest_name(names);

    std::string text;
    for (const std::string& difference : comparison.differences) text += fmt::format("Not the same: {}\n", difference);
    text += fmt::format("{:<{}} {:>10} {:>10} {:>8}\n", "case", width, "old ms", "new ms", "new/old");
    for (const Change& change : comparison.changes) {
        text += fmt::format("{:<{}} {:>10.4f} {:>10.4f} {:>8.3f}  {}", change.name, width, 1e3 * change.old_s, 1e3 * change.new_s,
                            change.ratio, mark(change));
        while (text.back() == ' ') text.pop_back();
        text += '\n';
    }
    const auto count = [&](bool (Change::*what)() const) {
        return std::count_if(comparison.changes.begin(), comparison.changes.end(),
                             [&](const Change& change) { return (change.*what)(); });
    };
    text += fmt::format("{} slower and {} faster by more than {:g} %, of {} cases that can be compared", count(&Change::slower),
                        count(&Change::faster), 100.0 * kNotableChange, count(&Change::trusted));
    text += fmt::format(" ({} disturbed, of another specimen, or with another memory rate",
                        std::ssize(comparison.changes) - count(&Change::trusted));
    text += fmt::format(", {} only in the old report, {} only in the new one)\n", comparison.only_old.size(),
                        comparison.only_new.size());
    return text;
}

std::string time_text(double seconds) { return fmt::format("{:.4f} ms", 1e3 * seconds); }

}  // namespace feldspar::benchmarks
