// A whole run: where it was measured, every reading with every block; as JSON, to be kept and compared with.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/reading.hpp"

namespace feldspar::benchmarks {

/// Where and how the program was built and run.
struct Machine {
    std::string processor;
    int vector_bits = 0;  ///< widest vectors of the processor; the program need not use them
    int cores = 0;        ///< that this process may use
    std::string system;
    std::string compiler;
    std::string build_type;
    std::string version;
    std::string commit;
    std::string started;  ///< ISO 8601, UTC
    bool operator==(const Machine&) const = default;
};

struct Report {
    Machine machine;
    QuietRule quiet;
    BestCalibrations best;       ///< of this run: what its blocks are judged by
    BestCalibrations on_record;  ///< of all runs on this machine so far; may be empty
    std::vector<Reading> readings;
};

/// The name of the processor and the number of cores; the rest is left empty.
Machine this_machine();

/// The report as JSON text. Beside what is needed to read it back it has the summaries, for people and other programs.
std::string to_json(const Report& report);

/// @param origin  what to call the text in an error. @throws InputError if the text is no report
Report from_json(const std::string& text, const std::string& origin);

/// Writes the file aside and renames it. @throws OutputError
void write_report(const Report& report, const std::filesystem::path& file);

/// @throws InputError if the file cannot be read or is no report
Report read_report(const std::filesystem::path& file);

}  // namespace feldspar::benchmarks
