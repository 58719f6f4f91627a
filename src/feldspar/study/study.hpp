// A study file, read and checked: one job, the axes along which it is varied, and the runs that this makes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "feldspar/job/job.hpp"

namespace feldspar {

/// One test on one packing: the unit of work of a study, and one row of its ledger.
struct Run {
    std::string id;  ///< 32 hexadecimal digits that follow from everything that can change its result, and from nothing else
    Job job;         ///< of this run alone: one variant without a name, one test, one seed
    std::size_t point = 0;  ///< of the study

    const TestSpec& test() const { return job.tests.front(); }
    std::uint64_t seed() const { return job.seeds.front(); }
};

/// The run of one test of one variant of a job on one packing.
Run make_run(const Job& job, const Variant& variant, const TestSpec& test, std::uint64_t seed);

/// What an axis says of a point, in the user's words ("rigid", "33.1 N/m", 2).
struct AxisValue {
    std::string label;
    double number = 0.0;  ///< as written, without its unit; not-a-number for a word
};

/// One combination of the axes' values: a rock and how it is modelled.
struct Point {
    std::vector<AxisValue> values;  ///< one for each axis
    Job job;                        ///< with a single variant, all its tests, and the seeds of this point
};

/// What a run leaves in its directory besides run.json and job.toml.
enum class Keep { numbers, histories, all };

struct Study {
    std::filesystem::path file;  ///< as given
    std::string text;            ///< the file as it was read
    std::string name;            ///< from the key `name`, else the file's stem
    std::string title;
    std::filesystem::path results;  ///< directory of ledger and runs: from the key `results`, else results/<name>
    Keep keep = Keep::histories;
    std::vector<std::string> axes;  ///< their names
    std::vector<Point> points;      ///< all combinations in the file's order, the last axis first; without axes a single one
    std::vector<Run> runs;          ///< packing by packing, then point by point: an interrupted study leaves whole packings
};

/// Reads and checks a study file and everything that it stands for (docs/study.md).
/// @throws InputError naming file, line, key, value and what is allowed; for a value that only the combination makes impossible
/// also the point
/// @param settings  "key=value" (job/set_keys.hpp), over the job, `[set]` and the axes' pieces: the points have other runs then.
/// A key that an axis varies is refused, and so are other tables than specimen, model, material, numerics, test, variant,
/// laboratory
Study read_study(const std::filesystem::path& file, std::span<const std::string> settings = {});

/// The same from text; `name` stands in for the file in messages and for finding the job.
Study parse_study(const std::string& text, const std::filesystem::path& name, std::span<const std::string> settings = {});

/// A commented study to start from, which reads as it stands beside a job "rock.toml" with a uniaxial test.
std::string study_template();

/// A study of a job as it is: a point for each variant (axis "variant"), all tests, all seeds.
Study study_of(const Job& job, const std::string& name, const std::filesystem::path& results);

/// Enumerates the runs of all points anew, after points were changed.
void index_runs(Study& study);

}  // namespace feldspar
