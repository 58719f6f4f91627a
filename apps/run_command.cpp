#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <thread>

#include "campaign.hpp"
#include "commands.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/study/toml_reader.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "tables.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

// From here on the time between the making of the specimen and a test's first report is worth a line.
constexpr int many_grains = 20000;

// Bytes that the job will leave, roughly: fields at the snapshots in two formats, histories and the report.
double expected_bytes(const Job& job, const std::vector<PlannedRun>& runs) {
    double bytes = 1e6;
    for (const PlannedRun& run : runs) {
        const SpecimenSpec& specimen = run.test->kind == TestKind::brazilian ? job.brazilian_specimen : job.specimen;
        const double grains = grain_count(specimen);
        bytes += 1e6 + 500.0 * grains * (run.test->snapshots + 4);
    }
    return bytes;
}

void check_space(const std::optional<std::string>& out, const Job& job, const std::vector<PlannedRun>& runs) {
    std::error_code error;
    fs::path place = fs::absolute(out ? fs::path(*out) : fs::path("results"), error);
    while (!fs::exists(place, error) && place.has_relative_path()) place = place.parent_path();
    const fs::space_info space = fs::space(place, error);
    if (error || space.capacity == 0) return;  // a file system that does not tell is not full
    const double wanted = expected_bytes(job, runs);
    if (static_cast<double>(space.available) < wanted)
        throw InputError({{}, 0, 0, "--out"},
                         fmt::format("the results need about {:.0f} MB, but the disk of '{}' has only {:.0f} MB free",
                                     wanted / 1e6, place.string(), static_cast<double>(space.available) / 1e6),
                         "a directory on a disk with more space, or fewer snapshots");
}

// One campaign: makes everything, runs test after test, and writes each test's files as soon as it has ended.
class Campaign {
public:
    Campaign(const Job& job, const RunOptions& options) : job_(job), runs_(planned_runs(job)), specimens_(job) {
        RunDirectory::check(options.out, job.name);
        check_space(options.out, job, runs_);
        control_.threads = thread_count(job);
        control_.stop = &stop_requested();
        provenance_ = collect_provenance(options.command_line, control_.threads);
    }

    /// Makes every specimen and judges every setting of the user's, so that a mistake shows before there is a directory.
    void prepare() {
        for (const PlannedRun& run : runs_) {
            if (stop_requested()) throw Interrupted();
            const std::shared_ptr<const Specimen> specimen =
                specimens_.get(run, progress_.making(Specimens::packing_stem(run), control_.threads));
            const NumericsSpec& numerics = run.variant->numerics;
            const bool own_setting = numerics.kind != NumericsKind::adaptive || numerics.mass_factor;
            if (own_setting) (void)preview_test(setup_of(run, specimen), control_);
        }
        progress_.clear();
        for (const PlannedRun& run : runs_)
            for (const std::string& warning : specimens_.get(run)->quality.warnings) warn(warning);
    }

    void create_directory(const std::optional<std::string>& out) {
        directory_ = RunDirectory::create(out, job_.name);
        progress_.note(fmt::format("results go to {}", directory_->path().string()));
        directory_->write_text("job.toml", job_.text);
        directory_->write_text("job-resolved.toml", resolved_toml(job_));
    }

    /// Runs everything. @throws what a test or a write throws, after the results so far have been written.
    void run() {
        for (std::size_t i = 0; i < runs_.size() && !stop_requested(); ++i) {
            try {
                run_one(i);
            } catch (const Interrupted&) {
                break;  // before there was anything to keep of this test
            } catch (const NumericalError& error) {
                progress_.clear();
                write_overview(false);
                throw NumericalError(fmt::format("{}: {}", label_of(runs_[i]), error.what()));
            }
        }
        progress_.clear();
        interrupted_ = results_.size() < runs_.size() || (!results_.empty() && results_.back().interrupted);
        write_overview(!interrupted_);
    }

    bool interrupted() const { return interrupted_; }

    void print_results() const {
        const std::string properties = job_.has_variants() ? variant_table(job_, results_) : property_table(job_, properties_);
        fmt::print("\n{}\n{}\n", properties, test_table(results_));
        fmt::print("Report: {}\n", (directory_->path() / "report.html").string());
    }

    /// Where the results are, once there is a place.
    std::optional<fs::path> place() const { return directory_ ? std::optional<fs::path>(directory_->path()) : std::nullopt; }
    std::size_t finished() const { return results_.size(); }

private:
    static std::string label_of(const PlannedRun& run) {
        return fmt::format("{}, seed {}", title(run.variant->name, *run.test), run.seed);
    }

    void run_one(std::size_t i) {
        const PlannedRun& run = runs_[i];
        const std::string label = label_of(run);
        const int number = static_cast<int>(i) + 1, count = static_cast<int>(runs_.size());
        const std::shared_ptr<const Specimen> specimen = specimens_.get(run);
        const std::string packing = Specimens::packing_stem(run) + ".txt";
        if (std::find(packings_.begin(), packings_.end(), packing) == packings_.end()) {
            directory_->write(packing, [&](const fs::path& file) { save_packing(*specimen, file); });
            packings_.push_back(packing);
        }
        control_.progress = [&](const TestProgress& state) { progress_.report(number, count, label, state); };
        const int grains = specimen->quality.grains;
        if (grains >= many_grains) progress_.busy(fmt::format("{}/{} {}: bonding {} grains", number, count, label, grains));
        TestResult result = run_test(setup_of(run, specimen), control_);
        result.variant = run.variant->name;
        progress_.note(fmt::format("{}/{} {}: {}", number, count, label, test_line(result)));
        if (result.history.empty()) return;  // interrupted before the first row
        results_.push_back(std::move(result));
        write_history_csv(*directory_, results_.back(), provenance_);
        write_hdf5(*directory_, results_.back(), job_, provenance_);
        write_vtu(*directory_, results_.back());
        if (i + 1 < runs_.size()) write_overview(false);
    }

    void write_overview(bool complete) {
        if (!job_.has_variants()) properties_ = summarise(results_);  // else each variant has its own
        write_summary(*directory_, job_, results_, properties_, provenance_, complete);
        write_report(*directory_, job_, results_, properties_, provenance_, complete);
    }

    void warn(const std::string& warning) {
        if (std::find(warned_.begin(), warned_.end(), warning) != warned_.end()) return;
        progress_.note("warning: " + warning);
        warned_.push_back(warning);
    }

    const Job& job_;
    std::vector<PlannedRun> runs_;
    Specimens specimens_;
    RunControl control_;
    Provenance provenance_;
    Progress progress_;
    std::optional<RunDirectory> directory_;
    std::vector<TestResult> results_;
    PropertySummary properties_;
    std::vector<std::string> packings_;  // written already
    std::vector<std::string> warned_;
    bool interrupted_ = false;
};

}  // namespace

// Leaves the variants that the command line names, in the job's order.
void keep_variants(Job& job, const std::vector<std::string>& wanted) {
    if (wanted.empty()) return;
    if (!job.has_variants()) throw InputError({{}, 0, 0, "--variant"}, "the job has no variants", "the job as it is, without --variant");
    std::vector<std::string_view> names;
    for (const Variant& variant : job.variants) names.push_back(variant.name);
    const auto is = [](const Variant& variant, const std::string& name) { return variant.name == name || variant.stem == name; };
    for (const std::string& name : wanted)
        if (std::none_of(job.variants.begin(), job.variants.end(), [&](const Variant& variant) { return is(variant, name); }))
            throw InputError({{}, 0, 0, "--variant"}, fmt::format("the job has no variant '{}'", name), fmt::format("{}", fmt::join(names, "; ")),
                             did_you_mean(name, names));
    std::erase_if(job.variants, [&](const Variant& variant) {
        return std::none_of(wanted.begin(), wanted.end(), [&](const std::string& name) { return is(variant, name); });
    });
}

// Leaves the tests of the kinds that the command line names.
void keep_tests(Job& job, const std::vector<std::string>& wanted) {
    if (wanted.empty()) return;
    std::vector<std::string_view> kinds;
    for (const TestSpec& test : job.tests)
        if (std::find(kinds.begin(), kinds.end(), name(test.kind)) == kinds.end()) kinds.emplace_back(name(test.kind));
    for (const std::string& kind : wanted)
        if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
            throw InputError({{}, 0, 0, "--test"}, fmt::format("the job has no test '{}'", kind), listed(kinds), did_you_mean(kind, kinds));
    std::erase_if(job.tests, [&](const TestSpec& test) { return std::find(wanted.begin(), wanted.end(), name(test.kind)) == wanted.end(); });
    for (const Variant& variant : job.variants)
        if (std::none_of(job.tests.begin(), job.tests.end(), [&](const TestSpec& test) { return variant.runs(test.kind); }))
            throw InputError({{}, 0, 0, "--test"}, fmt::format("nothing is left to run for the variant '{}'", variant.name), {}, "name the --variant too");
}

Job job_with_options(const JobOptions& options) {
    Job job = read_job(options.job);
    keep_variants(job, options.variants);
    keep_tests(job, options.tests);
    if (options.threads) job.threads = *options.threads;
    if (options.seeds.empty()) return job;
    for (std::uint64_t seed : options.seeds)
        if (std::count(options.seeds.begin(), options.seeds.end(), seed) > 1)
            throw InputError({{}, 0, 0, "--seed"}, fmt::format("the seed {} is given twice", seed), "each seed once");
    if (!job.specimen.packing_file.empty() && options.seeds.size() > 1)
        throw InputError({{}, 0, 0, "--seed"}, "several seeds are asked for, but the job loads one packing", "one seed");
    job.seeds = options.seeds;
    for (TestSpec& test : job.tests) test.seeds.clear();
    for (Variant& variant : job.variants) variant.seeds.clear();
    return job;
}

int thread_count(const Job& job) {
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    if (job.threads == 0) return cores;
    if (job.threads > cores)
        fmt::print(stderr, "warning: {} threads on {} core{} will wait for each other\n", job.threads, cores,
                   cores == 1 ? "" : "s");
    return job.threads;
}

ExitCode run_command(const RunOptions& options) {
    install_signal_handlers();
    const Job job = job_with_options(options);
    Campaign campaign(job, options);
    campaign.prepare();
    campaign.create_directory(options.out);
    try {
        campaign.run();
    } catch (const std::exception&) {
        fmt::print(stderr, "the files of {} finished test{} are in {}\n", campaign.finished(),
                   campaign.finished() == 1 ? "" : "s", campaign.place()->string());
        throw;
    }
    campaign.print_results();
    if (!campaign.interrupted()) return ExitCode::success;
    fmt::print(stderr, "interrupted; the results so far are in {}\n", campaign.place()->string());
    return ExitCode::interrupted;
}

}  // namespace feldspar
