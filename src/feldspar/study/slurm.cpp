#include "feldspar/study/slurm.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <set>
#include <sstream>

#include "feldspar/base/error.hpp"
#include "feldspar/study/call_program.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

enum class Place { waiting, running };

constexpr std::size_t most_elements = 10'000'000;  // above Slurm's own limit: whatever answers with more is not Slurm

// Elements in Slurm's queue, by the array's number and theirs; a job that is no array has the element 0.
using Queue = std::map<std::pair<std::string, std::size_t>, Place>;

std::string trimmed(const std::string& text) {
    const auto begin = text.find_first_not_of(" \t\r\n");
    const auto end = text.find_last_not_of(" \t\r\n");
    return begin == std::string::npos ? std::string{} : text.substr(begin, end - begin + 1);
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::stringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
    return parts;
}

[[noreturn]] void no_slurm(const std::string& program) {
    throw InputError({{}, 0, 0, "--on slurm"},
                     fmt::format("there is no program '{}' on the PATH: Slurm is not installed here", program),
                     "a machine from which jobs are submitted to the cluster");
}

std::optional<std::size_t> whole_number(const std::string& text) {
    std::size_t number = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool whole = problem == std::errc() && end == text.data() + text.size();
    return whole ? std::optional(number) : std::nullopt;
}

// The queue of this user.
Queue ask_queue() {
    const auto result =
        call_program({"squeue", "--noheader", "--array", "--user=" + std::to_string(::getuid()), "--format=%F %K %T"});
    if (!result) no_slurm("squeue");
    if (result->code != 0)
        throw InputError({{}, 0, 0, "--on slurm"},
                         fmt::format("squeue does not say which runs are in the queue: {}", trimmed(result->err)));
    Queue queue;
    for (const std::string& line : split(result->out, '\n')) {
        std::stringstream words(line);
        std::string job, element, state;
        if (!(words >> job >> element >> state)) continue;
        const std::vector<std::size_t> elements = elements_in(element);
        const Place place = state == "PENDING" || state == "CONFIGURING" || state == "REQUEUED" ? Place::waiting : Place::running;
        for (const std::size_t one : elements.empty() ? std::vector<std::size_t>{0} : elements) queue[{job, one}] = place;
    }
    return queue;
}

bool submitted(const SlurmPlan& plan) { return !plan.array_job.empty(); }

bool in_queue(const Queue& queue, const SlurmPlan& plan, std::size_t element) {
    return submitted(plan) && queue.contains({plan.array_job, element});
}

// The queue, as far as any plan can be in it.
Queue queue_of(const std::vector<SlurmPlan>& plans) {
    return std::any_of(plans.begin(), plans.end(), submitted) ? ask_queue() : Queue{};
}

// Submits a script of the plan. @return the job's number
std::string sbatch(const SlurmPlan& plan, const std::string& script, const std::vector<std::string>& options) {
    std::vector<std::string> command{"sbatch", "--parsable"};
    command.insert(command.end(), options.begin(), options.end());
    command.push_back(script);
    const auto result = call_program(command, plan.directory);
    if (!result) no_slurm("sbatch");
    std::string number = split(trimmed(result->out) + ";", ';').front();  // "12" or "12;cluster"
    if (result->code != 0 || elements_in(number).empty())
        throw InputError({(plan.directory / script).string(), 0, 0, {}},
                         fmt::format("sbatch did not take this script: {}", trimmed(result->err + result->out)));
    return number;
}

// The job that follows the array. @throws InputError that says that the array is on its way all the same
std::string submit_gathering(const SlurmPlan& plan) {
    try {
        return sbatch(plan, "gather.sh", {"--dependency=afterany:" + plan.array_job});
    } catch (const InputError& refusal) {
        throw InputError(refusal.place(), refusal.problem(), {},
                         fmt::format("the runs are in the queue as job {}; when it is over: feldspar study gather {}",
                                     plan.array_job, plan.results().string()));
    }
}

// How Slurm says that elements of an array ended.
struct Ending {
    std::string state;      // "TIMEOUT", "CANCELLED by 0", ...
    std::string exit_code;  // "1:0": code and signal
};
using Endings = std::map<std::size_t, Ending>;

// From Slurm's accounting; empty if there is none.
Endings accounted(const std::string& job) {
    const auto result =
        call_program({"sacct", "--noheader", "--allocations", "--parsable2", "--jobs=" + job, "--format=JobID,State,ExitCode"});
    Endings endings;
    if (!result || result->code != 0) return endings;
    for (const std::string& line : split(result->out, '\n')) {
        const std::vector<std::string> fields = split(line, '|');
        const auto underscore = line.find('_');
        if (fields.size() != 3 || underscore == std::string::npos) continue;
        std::string elements = fields[0].substr(underscore + 1);
        std::erase_if(elements, [](char letter) { return letter == '[' || letter == ']'; });
        for (const std::size_t element : elements_in(elements)) endings[element] = {fields[1], fields[2]};
    }
    return endings;
}

// From the controller, which remembers jobs for some minutes.
Endings remembered(const std::string& job) {
    const auto result = call_program({"scontrol", "show", "job", "--oneliner", job});
    Endings endings;
    if (!result || result->code != 0) return endings;
    for (const std::string& line : split(result->out, '\n')) {
        std::map<std::string, std::string> fields;
        for (const std::string& word : split(line, ' '))
            if (const auto equals = word.find('='); equals != std::string::npos)
                fields.emplace(word.substr(0, equals), word.substr(equals + 1));
        for (const std::size_t element : elements_in(fields["ArrayTaskId"]))
            endings[element] = {fields["JobState"], fields["ExitCode"]};
    }
    return endings;
}

std::string last_line(const fs::path& file) {
    std::ifstream in(file);
    std::string last;
    for (std::string line; std::getline(in, line);)
        if (!trimmed(line).empty()) last = trimmed(line);
    return last;
}

std::string reason_of(const Endings& endings, std::size_t element, const fs::path& output) {
    const auto found = endings.find(element);
    const std::string said = last_line(output);
    const std::string words = said.empty() ? std::string{} : fmt::format("; it said last: {}", said);
    if (found == endings.end()) return "Slurm no longer knows how it ended" + words;
    const std::string& state = found->second.state;
    if (state.starts_with("CANCELLED")) return "it was cancelled";
    if (state == "TIMEOUT") return "it reached its time limit: ask for more with --time, or for less with --group-minutes";
    if (found->second.exit_code.starts_with("130:"))  // ExitCode::interrupted
        return "it was asked to stop, near its time limit or for another job: ask for more with --time, or for less with "
               "--group-minutes";
    if (state == "OUT_OF_MEMORY") return "it needed more memory than it was given: ask for more with --sbatch \"--mem=...\"";
    if (state == "NODE_FAIL") return "its machine failed";
    return fmt::format("Slurm says {}, exit code {}{}", state, found->second.exit_code, words);
}

// Says of each lost element why; one question an array.
void add_reasons(std::vector<LostElement>& lost, const std::vector<std::pair<std::string, std::size_t>>& elements) {
    std::map<std::string, Endings> endings;
    for (std::size_t i = 0; i < lost.size(); ++i) {
        const auto& [job, element] = elements[i];
        if (!endings.contains(job)) {
            endings[job] = accounted(job);
            if (endings[job].empty()) endings[job] = remembered(job);
        }
        lost[i].reason = reason_of(endings[job], element, lost[i].output);
    }
}

// The record that a run has left, if any.
std::optional<RunRecord> left_record(const Ledger& ledger, const std::string& id) {
    const fs::path file = ledger.run_directory(id) / "run.json";
    std::error_code error;
    if (!fs::exists(file, error)) return std::nullopt;
    return read_record(file);
}

std::map<std::string, RunState> states_in(const Ledger& ledger, const std::vector<std::string>& ids) {
    std::map<std::string, RunState> states;
    for (const RunRecord& record : ledger.find(ids)) states[record.id] = record.state;
    return states;
}

Gathering gather(Ledger& ledger, const std::vector<SlurmPlan>& plans, const Queue& queue) {
    std::vector<std::string> ids;
    for (const SlurmPlan& plan : plans)
        for (const auto& group : plan.groups) ids.insert(ids.end(), group.begin(), group.end());
    const std::map<std::string, RunState> before = states_in(ledger, ids);

    Gathering found;
    std::set<std::string> seen;  // a run belongs to the last plan that has it
    std::vector<std::pair<std::string, std::size_t>> lost_elements;
    for (auto plan = plans.rbegin(); plan != plans.rend(); ++plan) {
        if (!submitted(*plan)) continue;
        for (std::size_t element = 0; element < plan->groups.size(); ++element) {
            LostElement lost{fmt::format("{}_{}", plan->array_job, element), plan->element_output(element), {}, {}};
            for (const std::string& id : plan->groups[element]) {
                const auto known = before.find(id);
                if (!seen.insert(id).second || (known != before.end() && known->second == RunState::done)) continue;
                const std::optional<RunRecord> record = left_record(ledger, id);
                if (record && record->state == RunState::done) {
                    ledger.record(*record);
                    ++found.taken;
                } else if (in_queue(queue, *plan, element)) {
                    ++found.queued;
                } else if (record) {
                    ledger.record(*record);
                    found.failed.push_back(*record);
                } else {
                    lost.runs.push_back(id);
                }
            }
            if (lost.runs.empty()) continue;
            lost_elements.emplace_back(plan->array_job, element);
            found.lost.push_back(std::move(lost));
        }
    }
    add_reasons(found.lost, lost_elements);
    return found;
}

std::set<std::string> queued_runs(const std::vector<SlurmPlan>& plans, const Queue& queue) {
    std::set<std::string> ids;
    for (const SlurmPlan& plan : plans)
        for (std::size_t element = 0; element < plan.groups.size(); ++element)
            if (in_queue(queue, plan, element)) ids.insert(plan.groups[element].begin(), plan.groups[element].end());
    return ids;
}

// Whether a live process of this machine is at the run.
bool taken_elsewhere(Ledger& ledger, const Run& run) {
    const Ledger::Claim claim = ledger.claim(run);
    if (claim == Ledger::Claim::ours) ledger.release(run.id);
    return claim == Ledger::Claim::others;
}

// The runs that nobody has done, waits for or is at.
std::vector<const Run*> open_runs(const Study& study, Ledger& ledger, const std::set<std::string>& queued, bool retry_failed,
                                  Submission& submission) {
    std::vector<std::string> ids;
    for (const Run& run : study.runs) ids.push_back(run.id);
    const Provenance here = collect_provenance({}, 1);
    const std::vector<RunRecord> records = ledger.find(ids);
    const SettledRuns settled = settled_runs(records, retry_failed ? nullptr : &here);
    std::set<std::string> running;
    for (const RunRecord& record : records)
        if (record.state == RunState::running) running.insert(record.id);
    std::vector<const Run*> open;
    std::set<std::string> seen;
    for (const Run& run : study.runs) {
        if (!seen.insert(run.id).second) continue;
        if (settled.done.contains(run.id))
            ++submission.done;
        else if (queued.contains(run.id))
            ++submission.queued;
        else if (settled.failed.contains(run.id))
            ++submission.failed;
        else if (running.contains(run.id) && taken_elsewhere(ledger, run))
            ++submission.elsewhere;
        else
            open.push_back(&run);
    }
    return open;
}

// What an earlier attempt said of its failure stands in the ledger; from here on a record is the new attempt's.
void forget_failures(const Ledger& ledger, const std::vector<const Run*>& runs) {
    std::error_code error;
    for (const Run* run : runs) fs::remove(ledger.run_directory(run->id) / "run.json", error);
}

Run run_from(const SlurmPlan& plan, const std::string& id) {
    const fs::path file = plan.job_file(id);
    const Job job = read_job(file);
    Run run = make_run(job, job.variants.front(), job.tests.front(), job.seeds.front());
    if (run.id != id)
        throw InputError({file.string(), 0, 0, {}},
                         "this is no longer the run that was planned: the program or a packing's file has changed",
                         "the program that made the plan, or the study submitted anew");
    return run;
}

void write_failure(const fs::path& directory, const RunRecord& record) {
    std::error_code error;
    fs::create_directories(directory, error);
    RunDirectory::open(directory).write_text("run.json", to_json(record));
}

}  // namespace

std::vector<std::size_t> elements_in(const std::string& text) {
    std::vector<std::size_t> elements;
    for (const std::string& part : split(text.substr(0, text.find('%')), ',')) {
        const auto dash = part.find('-');
        const auto first = whole_number(part.substr(0, dash));
        const auto last = dash == std::string::npos ? first : whole_number(part.substr(dash + 1));
        if (!first || !last || *last >= most_elements) return {};
        for (std::size_t element = *first; element <= *last; ++element) elements.push_back(element);
    }
    return elements;
}

void require_slurm() {
    for (const char* program : {"sbatch", "squeue"})
        if (!call_program({program, "--version"})) no_slurm(program);
}

Submission submit(const Study& study, Ledger& ledger, const SlurmOptions& options, const fs::path& program, bool retry_failed) {
    ledger.enrol(study);
    const std::vector<SlurmPlan> plans = read_plans(ledger.directory());
    const Queue queue = queue_of(plans);
    (void)gather(ledger, plans, queue);

    Submission submission;
    const std::vector<const Run*> open = open_runs(study, ledger, queued_runs(plans, queue), retry_failed, submission);
    if (open.empty()) return submission;
    std::vector<std::string> ids;
    for (const Run& run : study.runs) ids.push_back(run.id);
    const TimeEstimate estimate(study.runs, ledger.find(ids));
    for (const Run* run : open) submission.expected_s += estimate.seconds(*run);
    submission.submitted = static_cast<int>(open.size());

    SlurmPlan plan = write_plan(ledger.directory(), study, open, estimate, options, program);
    forget_failures(ledger, open);
    plan.array_job = sbatch(plan, "array.sh", {});
    write_plan_file(plan);
    plan.gather_job = submit_gathering(plan);
    write_plan_file(plan);
    submission.plan = std::move(plan);
    return submission;
}

Execution run_element(const SlurmPlan& plan, std::size_t element, ExecuteControl control) {
    if (element >= plan.groups.size())
        throw InputError({plan.directory.string(), 0, 0, {}}, fmt::format("this plan has no group {}", element),
                         fmt::format("0 to {}", plan.groups.size() - 1));
    std::vector<Run> runs;
    for (const std::string& id : plan.groups[element]) runs.push_back(run_from(plan, id));
    Ledger ledger(plan.results(), Ledger::Access::memory);
    control.keep = plan.keep;
    const auto ended = std::move(control.ended);
    control.ended = [&](const Run& run, const RunRecord& record) {
        if (record.state == RunState::failed) write_failure(ledger.run_directory(run.id), record);
        if (ended) ended(run, record);
    };
    return execute(runs, ledger, control);
}

Gathering gather(Ledger& ledger) {
    const std::vector<SlurmPlan> plans = read_plans(ledger.directory());
    return gather(ledger, plans, queue_of(plans));
}

std::vector<ArrayState> array_states(std::span<const SlurmPlan> plans) {
    const Queue queue = ask_queue();
    std::vector<ArrayState> states;
    for (const SlurmPlan& plan : plans) {
        ArrayState& state = states.emplace_back();
        for (std::size_t element = 0; element < plan.groups.size(); ++element) {
            if (const auto found = queue.find({plan.array_job, element}); found != queue.end())
                ++(found->second == Place::waiting ? state.waiting : state.running);
            std::error_code error;
            for (const std::string& id : plan.groups[element])
                if (fs::exists(plan.results() / "runs" / id / "run.json", error)) ++state.recorded;
            state.runs += static_cast<int>(plan.groups[element].size());
        }
        state.over = state.waiting + state.running == 0 && !queue.contains({plan.gather_job, 0});
    }
    return states;
}

}  // namespace feldspar
