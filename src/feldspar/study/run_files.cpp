#include "feldspar/study/run_files.hpp"

#include <system_error>

#include "feldspar/base/error.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

const fs::path record_file = "run.json";

const std::string state_file = "test.state", damaged_record = "run.json.damaged";

// An empty directory, but for the state of the test and a record that was set aside.
RunDirectory cleared(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error) throw OutputError("cannot make the directory '" + path.string() + "': " + error.message());
    std::vector<fs::path> left;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error))
        if (!entry->path().filename().string().starts_with(state_file) && entry->path().filename() != damaged_record)
            left.push_back(entry->path());
    for (const fs::path& one : left)
        if (!error) fs::remove_all(one, error);
    if (error) throw OutputError("cannot remove what an earlier attempt left in '" + path.string() + "': " + error.message());
    return RunDirectory::open(path);
}

}  // namespace

TestResult run_to_files(const Run& run, Packings& packings, const fs::path& path, Keep keep, const Provenance& provenance,
                        const RunControl& control, const DeviceUse& device, const CheckpointSettings& settings,
                        const std::function<void(const std::string&)>& note, LiveRuns* live) {
    const bool finished = finished_record(path, run).has_value();
    const RunDirectory directory = finished ? RunDirectory::open(path) : cleared(path);
    TestResult result;
    {
        const auto specimen = packings.get(specimen_of(run.job, run.test()), run.seed(), control.threads);
        const Variant& variant = run.job.variants.front();
        TestSpec test = run.test();
        if (keep != Keep::all) test.snapshots = 0;
        TestCheckpoints checkpoints(directory, state_file,
                                    CheckpointOwner::of(run.id + " " + std::to_string(test.snapshots), provenance), settings,
                                    note);
        RunControl own_control = control;
        own_control.keeper = &checkpoints;
        if (live != nullptr) own_control.watch = &live->watch(run, specimen);
        const TestSetup setup{specimen, variant.model, variant.grain, variant.contact, variant.numerics, test, variant.rock};
        own_control.device = opener_for(setup, device, note);
        result = run_test(setup, own_control);
    }
    if (result.interrupted) return result;
    directory.write_text("job.toml", resolved_toml(run.job));
    if (keep != Keep::numbers) write_history_csv(directory, result, provenance);
    if (keep == Keep::all) write_events_csv(directory, result);
    return result;
}

void finish_files(const Run& run, const TestResult& result, const fs::path& path, Keep keep, const Provenance& provenance) {
    const RunDirectory directory = RunDirectory::open(path);
    if (keep == Keep::all) {
        const std::span<const TestResult> one(&result, 1);
        const PropertySummary properties = summarise(one);
        write_hdf5(directory, result, run.job, provenance);
        write_summary(directory, run.job, one, properties, provenance, true);
        write_report(directory, run.job, one, properties, provenance, true);
    }
    directory.write_text(record_file.string(), to_json(record_of(run, result, provenance)));
    forget_state(path);
}

void forget_state(const fs::path& directory) { remove_checkpoint(directory, state_file); }

namespace {

std::optional<RunRecord> record_in(const fs::path& directory, const Run& run, RunState state) {
    std::error_code error;
    if (!fs::exists(directory / record_file, error)) return std::nullopt;
    RunRecord record = read_record(directory / record_file);
    if (record.id != run.id)
        throw InputError({(directory / record_file).string(), 0, 0, "id"}, "is not the record of run " + run.id);
    if (record.state != state) return std::nullopt;
    return record;
}

}  // namespace

std::string set_damaged_record_aside(const fs::path& directory, const Run& run) {
    try {
        (void)record_in(directory, run, RunState::done);
        return {};
    } catch (const InputError& problem) {
        std::error_code error;
        fs::rename(directory / record_file, directory / damaged_record, error);
        if (error) throw OutputError("cannot rename '" + (directory / record_file).string() + "': " + error.message());
        return std::string(problem.what()) + "; its run is made again, and the file stays as '" + damaged_record + "'";
    }
}

std::optional<RunRecord> finished_record(const fs::path& directory, const Run& run) {
    return record_in(directory, run, RunState::done);
}

std::optional<RunRecord> failure_left(const fs::path& directory, const Run& run) {
    return record_in(directory, run, RunState::failed);
}

}  // namespace feldspar
