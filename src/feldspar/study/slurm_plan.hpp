// What goes to a Slurm cluster: runs in groups of some minutes, one element of a job array each, written to files beside the runs
// before anything is submitted.
//
//   <results>/slurm/<n>/plan.json       the groups by the runs' numbers, and Slurm's numbers of the jobs once they are submitted
//                       jobs/<id>.toml  each run as a job with every default: an element needs no other file
//                       array.sh        the batch script of the array; gather.sh that of the job which takes its results in
//                       element-<k>.out, gather.out   what these printed
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "feldspar/study/run_record.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {

/// What the user asks of Slurm. Texts go to sbatch as they are; empty = the cluster's default.
struct SlurmOptions {
    std::string partition;
    std::string account;
    std::string time;             ///< limit of an element ("30", "2:00:00"), as sbatch reads it
    int cpus = 1;                 ///< threads of an element
    int array_limit = 0;          ///< at most so many elements at once; 0 = no limit
    double group_minutes = 10.0;  ///< about so long is an element
    std::string sbatch;           ///< further options, as they would stand behind `sbatch`
};

/// How long runs take, from those that are done.
class TimeEstimate {
public:
    TimeEstimate() = default;

    /// Learns from the study's runs that have a record.
    TimeEstimate(std::span<const Run> runs, std::span<const RunRecord> records);

    /// Seconds on one thread: the median of like runs (kind of test, of grains and of numerics, accuracy), or a default by kind,
    /// scaled with the number of grains (and a constant share for the small ones). Right within a factor of a few, which is what
    /// groups need.
    double seconds(const Run& run) const;

private:
    using Like = std::tuple<MethodId, GrainKind, NumericsKind, double>;
    static Like like(const Run& run);

    std::map<Like, double> per_thousand_;  // s for 1000 grains
};

/// Neighbours together until a group would take longer than `target_s`; the order stays, because neighbours share their packing.
/// At most `most_groups`, which makes them longer. @return positions in `seconds`
std::vector<std::vector<std::size_t>> grouped(std::span<const double> seconds, double target_s, std::size_t most_groups);

/// A plan as it is on disk.
struct SlurmPlan {
    std::filesystem::path directory;  ///< <results>/slurm/<n>
    std::string study;                ///< its name
    Keep keep = Keep::histories;
    int cpus = 1;
    std::vector<std::vector<std::string>> groups;  ///< ids of the runs
    std::string array_job, gather_job;             ///< Slurm's numbers; empty until submitted

    std::filesystem::path results() const { return directory.parent_path().parent_path(); }
    std::filesystem::path job_file(const std::string& id) const { return directory / "jobs" / (id + ".toml"); }
    std::filesystem::path element_output(std::size_t element) const;
};

/// Writes a plan of these runs with its jobs and scripts to a new directory below `results`.
/// @param program  path of the program `feldspar`, which the cluster's machines see under the same name
/// @throws OutputError when it cannot be written
SlurmPlan write_plan(const std::filesystem::path& results, const Study& study, std::span<const Run* const> runs,
                     const TimeEstimate& estimate, const SlurmOptions& options, const std::filesystem::path& program);

/// Writes plan.json anew: after Slurm has given a number.
void write_plan_file(const SlurmPlan& plan);

/// @throws InputError for a directory without a plan, or with one of a later version
SlurmPlan read_plan(const std::filesystem::path& directory);

/// All plans below `results`, the oldest first.
std::vector<SlurmPlan> read_plans(const std::filesystem::path& results);

}  // namespace feldspar
