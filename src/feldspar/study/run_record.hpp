// What is kept of a run: one row of the ledger, and the file run.json in its directory, which holds the same.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>

#include "feldspar/methods/result.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {

enum class RunState { running, done, failed };

const char* name(RunState state);

/// What a run failed of. The first two would fail again: the same program finds the same mistake, or takes the same wrong turn.
enum class Failure { input, numerical, other };

const char* name(Failure failure);

/// Numbers are SI, angles degrees, compression positive; not-a-number where a test does not define one.
struct RunRecord {
    std::string id;
    RunState state = RunState::running;
    std::string reason;  ///< of a failure, in words
    std::string test;    ///< "uniaxial-compression", ...
    double sigma3_Pa = 0.0;
    std::uint64_t seed = 0;
    std::map<std::string, double> numbers;     ///< by the names of number_columns()
    std::map<std::string, std::string> texts;  ///< by the names of text_columns()
    std::string job;                           ///< resolved: it can be run again
};

/// Names of the numbers of a record, in the ledger's order: properties, evidence, steps and times.
const std::vector<std::string>& number_columns();

/// grade, verdict, stop_reason, failure, version, commit, machine, started, ...
const std::vector<std::string>& text_columns();

RunRecord record_of(const Run& run, const TestResult& result, const Provenance& provenance);
RunRecord failed_record(const Run& run, const std::string& reason, Failure failure, const Provenance& provenance);

/// The run failed for good: of its input or numerically, with this very version and commit of the program.
bool failed_for_good(const RunRecord& record, const Provenance& program);

/// The runs that are not run again, by their ids.
struct SettledRuns {
    std::set<std::string> done;
    std::set<std::string> failed;  ///< for good
};

/// Picks them from what a ledger knows of the runs. @param program  whose failures count; none if failed runs are repeated
SettledRuns settled_runs(std::span<const RunRecord> records, const Provenance* program);

/// What the numbers and texts of a record say of a result; the rest as in a result of no test. Enough for summarise().
TestResult result_of(const RunRecord& record);

/// run.json: every digit, so that reading gives the same bits.
std::string to_json(const RunRecord& record);
/// @throws InputError for a file that is not a record
RunRecord read_record(const std::filesystem::path& file);

}  // namespace feldspar
