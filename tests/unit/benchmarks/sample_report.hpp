// A report written by formula, for the tests of what is done with reports.
#pragma once

#include <string>

#include "benchmarks/report.hpp"

namespace feldspar::benchmarks {

/// A block of 10 steps of so many milliseconds, computed without a pause, between two calibrations of the given rate.
inline Block sample_block(double ms_per_step, double calibration = 100.0) {
    return {.steps = 10,
            .wall_s = 1e-2 * ms_per_step,
            .cpu_s = 1e-2 * ms_per_step,
            .waited_s = 0.0,
            .before = {calibration, 20.0},
            .after = {calibration, 20.0}};
}

/// A reading of three blocks: the given time, and 1.1 and 1.3 times it.
inline Reading sample_reading(const std::string& name, double ms_per_step, double calibration = 100.0) {
    Reading reading;
    reading.name = name;
    reading.stage = "step";
    reading.threads = 1;
    reading.counts = {
        .grains = 100, .bodies = 102, .nodes = 900, .triangles = 1500, .contacts = 280, .points = 840, .memory_bytes = 7.5e5};
    for (const double factor : {1.3, 1.0, 1.1}) reading.blocks.push_back(sample_block(factor * ms_per_step, calibration));
    return reading;
}

inline Report sample_report() {
    Report report;
    report.machine = {.processor = "a processor",
                      .vector_bits = 256,
                      .cores = 2,
                      .system = "a system",
                      .compiler = "a compiler",
                      .build_type = "Release",
                      .version = "1.2.3",
                      .commit = "abc",
                      .started = "2026-11-22T06:00:00Z"};
    report.quiet = {.share = 0.9, .blocks = 3};
    report.best = {{1, 100.0}, {2, 95.0}};
    report.on_record = {{1, 100.0}, {2, 110.0}};
    report.readings = {sample_reading("flexible/uniaxial/paper/elastic/step/1t", 0.5),
                       sample_reading("rigid/uniaxial/paper/elastic/step/1t", 0.2)};
    return report;
}

}  // namespace feldspar::benchmarks
