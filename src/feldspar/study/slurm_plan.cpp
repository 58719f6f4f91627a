#include "feldspar/study/slurm_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>

#include "feldspar/base/error.hpp"
#include "feldspar/base/median.hpp"
#include "feldspar/base/printable.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int format_version = 1;

// MaxArraySize of Slurm is 1001 unless the cluster's owner has set it.
constexpr std::size_t most_elements = 1000;

double default_factor(GrainKind kind) {
    switch (kind) {
        case GrainKind::flexible:
            return 1.0;
        case GrainKind::rigid:
            return 0.5;
        case GrainKind::inner_particles:
            return 20.0;  // some tens of particles a grain
    }
    return 1.0;
}

double default_factor(NumericsKind kind) { return kind == NumericsKind::adaptive ? 1.0 : 10.0; }  // slow enough for the paper

// Time of a run of so many grains as a multiple of that of 1000; the share that does not shrink is that of the least number of
// steps.
double size_factor(const Run& run) {
    const SpecimenSpec& specimen = specimen_of(run.job, run.test());
    return 0.1 + grain_count(specimen) / 1000.0;
}

double number_in(const RunRecord& record, const std::string& column) {
    const auto found = record.numbers.find(column);
    return found == record.numbers.end() ? 0.0 : found->second;
}

const char* name(Keep keep) {
    switch (keep) {
        case Keep::numbers:
            return "numbers";
        case Keep::histories:
            return "histories";
        case Keep::all:
            return "all";
    }
    return "histories";
}

Keep keep_of(const std::string& word, const fs::path& file) {
    for (const Keep keep : {Keep::numbers, Keep::histories, Keep::all})
        if (word == name(keep)) return keep;
    throw InputError({.file = file.string()},
                     fmt::format("'{}' is nothing that a run can keep", printable(word, LineEnds::escaped)),
                     "numbers, histories or all");
}

void write_text(const fs::path& file, const std::string& text) {
    RunDirectory::open(file.parent_path()).write_text(file.filename().string(), text);
}

// The next free number below `parent`; mkdir claims it, so that two submissions at once never share a directory.
fs::path new_directory(const fs::path& parent) {
    std::error_code error;
    fs::create_directories(parent, error);
    for (int number = 1; !error; ++number) {
        fs::path directory = parent / std::to_string(number);
        if (fs::create_directory(directory, error)) return directory;
    }
    throw OutputError(fmt::format("cannot make a directory in '{}': {}", parent.string(), error.message()));
}

// A word as the shell reads it back.
std::string quoted(const std::string& word) {
    std::string text = "'";
    for (const char letter : word) text += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    return text + "'";
}

// As part of a job's name: no blanks, nothing that Slurm or a shell would read.
std::string job_name(const std::string& study) {
    std::string text = "feldspar-" + study;
    for (char& letter : text)
        if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '-' && letter != '_' && letter != '.')
            letter = '-';
    return text;
}

// Lines that both scripts have. A job starts in the directory in which it was submitted, which is the plan's, so that no path
// needs quoting.
std::string common_head(const std::string& name, const SlurmOptions& options) {
    std::string text = "#!/bin/sh\n";
    text += fmt::format("#SBATCH --job-name={}\n#SBATCH --nodes=1\n#SBATCH --ntasks=1\n", name);
    if (!options.partition.empty()) text += fmt::format("#SBATCH --partition={}\n", options.partition);
    if (!options.account.empty()) text += fmt::format("#SBATCH --account={}\n", options.account);
    if (!options.time.empty()) text += fmt::format("#SBATCH --time={}\n", options.time);
    if (!options.sbatch.empty()) text += fmt::format("#SBATCH {}\n", options.sbatch);
    return text;
}

std::string array_script(const SlurmPlan& plan, const SlurmOptions& options, const fs::path& program) {
    std::string text = common_head(job_name(plan.study), options);
    text += fmt::format("#SBATCH --array=0-{}", plan.groups.size() - 1);
    if (options.array_limit > 0) text += fmt::format("%{}", options.array_limit);
    text += fmt::format(
        "\n#SBATCH --cpus-per-task={}\n#SBATCH --output=element-%a.out\n#SBATCH --open-mode=append\n#SBATCH --requeue\n"
        "#SBATCH --signal=B:TERM@30\n\n"
        "# exec: what Slurm signals is the program itself, which then ends cleanly\n"
        "exec {} study element . \"$SLURM_ARRAY_TASK_ID\"\n",
        plan.cpus, quoted(program.string()));
    return text;
}

std::string gather_script(const SlurmPlan& plan, const SlurmOptions& options, const fs::path& program) {
    return common_head(job_name(plan.study) + "-gather", options) +
           fmt::format(
               "#SBATCH --cpus-per-task=1\n#SBATCH --output=gather.out\n#SBATCH --open-mode=append\n\nexec {} study gather "
               "../..\n",
               quoted(program.string()));
}

json json_of(const SlurmPlan& plan) {
    return {
        {"feldspar_slurm_plan", format_version}, {"study", plan.study},           {"keep", name(plan.keep)}, {"cpus", plan.cpus},
        {"array_job", plan.array_job},           {"gather_job", plan.gather_job}, {"groups", plan.groups}};
}

// The number that the name of a plan's directory is, or 0.
int number_of(const fs::path& directory) {
    const std::string text = directory.filename().string();
    int number = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    return problem == std::errc() && end == text.data() + text.size() ? number : 0;
}

}  // namespace

TimeEstimate::TimeEstimate(std::span<const Run> runs, std::span<const RunRecord> records) {
    std::map<std::string, const Run*> by_id;
    for (const Run& run : runs) by_id[run.id] = &run;
    std::map<Like, std::vector<double>> samples;
    for (const RunRecord& record : records) {
        const auto found = by_id.find(record.id);
        if (found == by_id.end() || record.state != RunState::done) continue;
        const double wall_s = number_in(record, "wall_s"), threads = number_in(record, "threads");
        if (wall_s > 0.0) samples[like(*found->second)].push_back(wall_s * std::max(1.0, threads) / size_factor(*found->second));
    }
    for (auto& [kind, seconds] : samples) per_thousand_[kind] = median(seconds);
}

TimeEstimate::Like TimeEstimate::like(const Run& run) {
    const Variant& variant = run.job.variants.front();
    return {run.test().kind, variant.model.kind, variant.numerics.kind, variant.numerics.accuracy};
}

double TimeEstimate::seconds(const Run& run) const {
    const auto known = per_thousand_.find(like(run));
    const Variant& variant = run.job.variants.front();
    const double thousand =
        known != per_thousand_.end()
            ? known->second
            : method_of(run.test()).rate.seconds * default_factor(variant.model.kind) * default_factor(variant.numerics.kind);
    return thousand * size_factor(run);
}

std::vector<std::vector<std::size_t>> grouped(std::span<const double> seconds, double target_s, std::size_t most_groups) {
    while (true) {
        std::vector<std::vector<std::size_t>> groups;
        double filled = 0.0;
        for (std::size_t i = 0; i < seconds.size(); ++i) {
            if (groups.empty() || filled + seconds[i] > target_s) {
                groups.emplace_back();
                filled = 0.0;
            }
            groups.back().push_back(i);
            filled += seconds[i];
        }
        if (groups.size() <= most_groups) return groups;
        target_s *= 1.1 * static_cast<double>(groups.size()) / static_cast<double>(most_groups);
    }
}

fs::path SlurmPlan::element_output(std::size_t element) const { return directory / fmt::format("element-{}.out", element); }

namespace {

// An option stands in its line of the script: what follows a line end would be a command.
void require_one_line(const SlurmOptions& options) {
    for (const auto& [option, text] : {std::pair{"--partition", &options.partition},
                                       {"--account", &options.account},
                                       {"--time", &options.time},
                                       {"--sbatch", &options.sbatch}})
        if (std::any_of(text->begin(), text->end(), [](unsigned char c) { return std::iscntrl(c) != 0; }))
            throw InputError({.file = {}, .line = 0, .column = 0, .key = option},
                             fmt::format("'{}' has a control character in it", printable(*text, LineEnds::escaped)),
                             "text in one line");
}

}  // namespace

SlurmPlan write_plan(const fs::path& results, const Study& study, std::span<const Run* const> runs, const TimeEstimate& estimate,
                     const SlurmOptions& options, const fs::path& program) {
    require_one_line(options);
    std::vector<double> seconds;
    for (const Run* run : runs) seconds.push_back(estimate.seconds(*run));
    SlurmPlan plan;
    plan.study = study.name;
    plan.keep = study.keep;
    plan.cpus = options.cpus;
    for (const std::vector<std::size_t>& group : grouped(seconds, options.group_minutes * 60.0 * options.cpus, most_elements)) {
        plan.groups.emplace_back();
        for (const std::size_t i : group) plan.groups.back().push_back(runs[i]->id);
    }
    plan.directory = new_directory(fs::absolute(results) / "slurm");
    std::error_code error;
    fs::create_directory(plan.directory / "jobs", error);
    for (const Run* run : runs) write_text(plan.job_file(run->id), resolved_toml(run->job));
    write_text(plan.directory / "array.sh", array_script(plan, options, program));
    write_text(plan.directory / "gather.sh", gather_script(plan, options, program));
    write_plan_file(plan);
    return plan;
}

void write_plan_file(const SlurmPlan& plan) { write_text(plan.directory / "plan.json", json_of(plan).dump(1) + "\n"); }

SlurmPlan read_plan(const fs::path& directory) {
    const fs::path file = directory / "plan.json";
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw InputError({.file = file.string()}, "this plan of a study on Slurm cannot be read",
                         "a directory <results>/slurm/<n>");
    try {
        const json text = json::parse(in);
        if (text.at("feldspar_slurm_plan").get<int>() > format_version)
            throw InputError({.file = file.string()}, "this plan was written by a later version of the program");
        SlurmPlan plan;
        plan.directory = fs::absolute(directory).lexically_normal();
        if (!plan.directory.has_filename()) plan.directory = plan.directory.parent_path();
        plan.study = text.at("study").get<std::string>();
        plan.keep = keep_of(text.at("keep").get<std::string>(), file);
        plan.cpus = text.at("cpus").get<int>();
        plan.array_job = text.at("array_job").get<std::string>();
        plan.gather_job = text.at("gather_job").get<std::string>();
        for (const std::string& number : {plan.array_job, plan.gather_job})
            if (!std::all_of(number.begin(), number.end(),
                             [](unsigned char c) { return std::isdigit(c) != 0; }))  // it goes to Slurm's programs
                throw InputError({.file = file.string()},
                                 fmt::format("'{}' is not the number of a job", printable(number, LineEnds::escaped)), "digits");
        plan.groups = text.at("groups").get<std::vector<std::vector<std::string>>>();
        for (const auto& group : plan.groups)
            for (const std::string& id : group)
                if (id.empty() ||
                    !std::all_of(id.begin(), id.end(), [](unsigned char c) { return std::isxdigit(c) != 0; }))  // it names files
                    throw InputError({.file = file.string()},
                                     fmt::format("'{}' is not the name of a run", printable(id, LineEnds::escaped)),
                                     "hexadecimal digits");
        return plan;
    } catch (const json::exception& problem) {
        throw InputError({.file = file.string()}, fmt::format("this is not a plan of a study on Slurm ({})", problem.what()));
    }
}

std::vector<SlurmPlan> read_plans(const fs::path& results) {
    std::vector<fs::path> directories;
    std::error_code error;
    for (fs::directory_iterator entry(results / "slurm", error), end; !error && entry != end; entry.increment(error))
        if (number_of(entry->path()) > 0 && fs::exists(entry->path() / "plan.json")) directories.push_back(entry->path());
    std::sort(directories.begin(), directories.end(),
              [](const fs::path& a, const fs::path& b) { return number_of(a) < number_of(b); });
    std::vector<SlurmPlan> plans;
    for (const fs::path& directory : directories) plans.push_back(read_plan(directory));
    return plans;
}

}  // namespace feldspar
