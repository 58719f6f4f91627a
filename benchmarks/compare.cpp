#include "benchmarks/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace feldspar::benchmarks {
namespace {

const Reading* find(const Report& report, const std::string& name) {
    const auto found =
        std::find_if(report.readings.begin(), report.readings.end(), [&](const Reading& r) { return r.name == name; });
    return found == report.readings.end() ? nullptr : &*found;
}

// Nodes and memory may change with the layout of the arrays, and the work be the same.
bool same_work(const Counts& a, const Counts& b) {
    return a.grains == b.grains && a.bodies == b.bodies && a.triangles == b.triangles && a.points == b.points;
}

Change change_between(const Reading& before, const Report& old_report, const Reading& after, const Report& new_report) {
    const Summary old_one = summarise(before, old_report.best, old_report.quiet),
                  new_one = summarise(after, new_report.best, new_report.quiet);
    Change change;
    change.name = after.name;
    change.old_s = old_one.best_s;
    change.new_s = new_one.best_s;
    change.ratio = new_one.best_s / old_one.best_s;
    change.disturbed = old_one.disturbed || new_one.disturbed;
    change.memory_ratio = new_one.memory_rate / old_one.memory_rate;
    change.same_specimen = same_work(before.counts, after.counts);
    return change;
}

}  // namespace

Comparison compare(const Report& before, const Report& after) {
    Comparison comparison;
    for (const Reading& reading : after.readings) {
        if (const Reading* old_one = find(before, reading.name)) {
            comparison.changes.push_back(change_between(*old_one, before, reading, after));
        } else {
            comparison.only_new.push_back(reading.name);
        }
    }
    for (const Reading& reading : before.readings)
        if (find(after, reading.name) == nullptr) comparison.only_old.push_back(reading.name);

    const auto differ = [&](const char* what, const std::string& a, const std::string& b) {
        if (a != b) comparison.differences.push_back(fmt::format("{}: {} before, {} now", what, a, b));
    };
    const Machine &a = before.machine, &b = after.machine;
    differ("processor", a.processor, b.processor);
    differ("vectors", fmt::format("{} bits", a.vector_bits), fmt::format("{} bits", b.vector_bits));
    differ("compiler", a.compiler, b.compiler);
    differ("build type", a.build_type, b.build_type);
    for (const auto& [threads, rate] : before.best) {
        const auto now = after.best.find(threads);
        if (now == after.best.end()) continue;
        // The best calibrations of two undisturbed runs on one machine agree to a few percent.
        if (std::abs(std::log(now->second / rate)) > std::log(1.1)) {
            comparison.differences.push_back(
                fmt::format("best calibration of {} thread{}: {:.1f} GFLOP/s a core before, {:.1f} now", threads,
                            threads == 1 ? "" : "s", rate, now->second));
        }
    }
    return comparison;
}

std::optional<double> worst_slowdown_percent(const Comparison& comparison) {
    std::optional<double> worst;
    for (const Change& change : comparison.changes)
        if (change.trusted()) worst = std::max(worst.value_or(-100.0), 100.0 * (change.ratio - 1.0));
    return worst;
}

}  // namespace feldspar::benchmarks
