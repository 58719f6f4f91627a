// Everything that a run leaves on disk. Every file is written aside and renamed when it is whole, so that a full disk or a
// crash never leaves half a file, and files that were finished stay.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "feldspar/job/job.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/methods/result.hpp"

namespace feldspar {

/// Where the results came from; the same block is in every file.
struct Provenance {
    std::string version;
    std::string commit;
    std::string machine;  ///< processor and operating system
    std::string compiler;
    std::string started;  ///< ISO 8601, UTC
    std::string command_line;
    int threads = 1;
    std::string device;  ///< the card that made the steps; empty: the processor did
    int ranks = 1;       ///< programs that made the steps together
};

Provenance collect_provenance(std::string command_line, int threads);

/// A run's directory.
class RunDirectory {
public:
    /// With `wanted`: that directory, which must not exist yet (@throws InputError otherwise, or if it cannot be made).
    /// Without: `results/<job name>-<n>` in the current directory, with the first free number n = 1, 2, ...
    static RunDirectory create(const std::optional<std::filesystem::path>& wanted, const std::string& job_name);

    /// Only checks what create() would do; makes nothing. @throws InputError as create().
    static void check(const std::optional<std::filesystem::path>& wanted, const std::string& job_name);

    /// The existing `results/<job name>-<n>` with the largest n.
    static std::optional<std::filesystem::path> newest(const std::string& job_name);

    /// A directory that is there. What programs that were killed have left of files that they wrote aside is removed.
    static RunDirectory open(std::filesystem::path path);

    const std::filesystem::path& path() const { return path_; }

    /// Writes `name` through `fill(temporary path)`, then renames it into place. @throws OutputError; on failure the
    /// temporary file is gone and an earlier version of `name` is untouched. Several programs may write the same file at once:
    /// each version is whole, and the last one stays.
    void write(const std::string& name, const std::function<void(const std::filesystem::path&)>& fill) const;

    /// The same for text that is already in memory.
    void write_text(const std::string& name, const std::string& text) const;

private:
    explicit RunDirectory(std::filesystem::path path) : path_(std::move(path)) {}
    std::filesystem::path path_;
};

/// "uniaxial-compression-s3", "biaxial-s1-p4": the stem of a test's files (seed; sigma_3 in MPa for biaxial tests), behind
/// the variant's own: "rigid-brittle-uniaxial-compression-s3".
std::string test_stem(const TestResult& result);

/// The same from its parts; `variant` is empty where the job has none.
std::string test_stem(const std::string& variant, const TestSpec& test, std::uint64_t seed);

/// A test that ended without a result.
struct FailedTest {
    std::string variant;  ///< its name; empty where the job has none
    TestSpec test;
    std::uint64_t seed = 0;
    std::string reason;  ///< in words
};

/// history-<stem>.csv: units and sign convention in the header.
void write_history_csv(const RunDirectory& directory, const TestResult& result, const Provenance& provenance);

/// events-<stem>.csv: the acoustic events of a test; no file without cracks.
void write_events_csv(const RunDirectory& directory, const TestResult& result);

/// <stem>.h5: history, cracks, acoustic events, mesh, contacts and fields at the snapshots, with provenance. May be called on any
/// thread, but one archive is made after the other.
void write_hdf5(const RunDirectory& directory, const TestResult& result, const Job& job, const Provenance& provenance);

/// summary.json: rewritten after each test, so that an interrupted run leaves what it had.
void write_summary(const RunDirectory& directory, const Job& job, std::span<const TestResult> results,
                   const PropertySummary& properties, const Provenance& provenance, bool complete,
                   std::span<const FailedTest> failed = {});

/// report.html: self-contained, opens from disk with no network.
void write_report(const RunDirectory& directory, const Job& job, std::span<const TestResult> results,
                  const PropertySummary& properties, const Provenance& provenance, bool complete,
                  std::span<const FailedTest> failed = {});

}  // namespace feldspar
