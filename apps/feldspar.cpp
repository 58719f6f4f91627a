// The program `feldspar`: reads the command line, calls a command, and turns what it throws into a message and an exit code.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "command_line.hpp"
#include "command_pages.hpp"
#include "commands.hpp"
#include "feldspar/base/lacking_memory.hpp"
#include "feldspar/base/printable.hpp"
#include "feldspar/base/units.hpp"
#include "feldspar/job/job_template.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/ranks/communicator.hpp"
#include "interrupt.hpp"
#include "say.hpp"

namespace feldspar {
namespace {

constexpr const char* examples = R"(Examples:
  feldspar new uniaxial-compression --out granite.toml   a commented job to start from
  feldspar check granite.toml                            is it sound, how long will it take?
  feldspar run granite.toml                              results in results/granite-1
  feldspar view results/granite-1                        opens the report
  feldspar export results/granite-1 --vtu                files for ParaView
  feldspar run granite.toml --set material.contact.tau=30MPa --seed 7
  feldspar envelope granite.toml                         strength envelope over five packings
  feldspar converge granite.toml                         does the answer depend on grains, size, mesh, rate, packings?
'feldspar COMMAND --help' has more for each command.

Exit codes: 0 done, 2 mistake in the input (no file is left), 3 numerical failure, 4 results could not be written,
130 interrupted (the results so far are kept).)";

constexpr const char* run_examples = R"(  feldspar run granite.toml                              results in results/granite-1
  feldspar run granite.toml --out trial --seed 7         another packing, another place
  feldspar run granite.toml --test UCS --test BTS        only a part of the job
  feldspar run granite.toml --set numerics.accuracy=0.5% --set test.BTS.plate_mu=0.2
  feldspar run granite.toml --keep numbers --quiet       prints only where the results are
  feldspar run granite.toml --json > summary.json        the numbers, to be read by a program
  feldspar run - < granite.toml                          the job from standard input
  feldspar run granite.toml --threads 2                  the results do not depend on the threads
  feldspar run granite.toml --at-once 1                  one test after the other, each on all threads
  feldspar run granite.toml --continue                   only if there is an unfinished run to go on with
)";

constexpr const char* check_examples = R"(  feldspar check granite.toml
  feldspar check granite.toml --set specimen.grains.diameter.minimum=1mm --test UCS
  feldspar check granite.toml --json > foreseen.json     to be read by a program
)";

constexpr const char* export_examples =
    R"(  feldspar export results/granite-1 --vtu                                files in results/granite-1/paraview
  feldspar export results/granite-1 --vtu --test brazilian-s1 --out /tmp/fields
  paraview --script=results/granite-1/paraview/brazilian-s1.py           opens them coloured
)";

constexpr const char* view_examples = R"(  feldspar view                      the report of the newest run in results/
  feldspar view results/granite-1
  feldspar view results/granite-1 --print    only its path
)";

constexpr const char* export_cells_examples =
    R"(  feldspar export-cells granite.toml --out cells.msh     for gmsh; .tess for Neper, .csv for anything
  feldspar export-cells granite.toml --test BTS --seed 3 --out disc.tess
)";

constexpr const char* schema_examples = R"(  feldspar schema --out job.schema.json
  feldspar schema --markdown
)";

constexpr const char* study_examples = R"(  feldspar study sweep.toml                              runs what is not done yet
  feldspar study sweep.toml --set numerics.accuracy=5% --results trial     quickly, elsewhere
  feldspar study sweep.toml --json > points.json         the points, to be read by a program
  feldspar study status sweep.toml
  feldspar study table sweep.toml --runs > runs.csv
  feldspar study sweep.toml --on slurm --partition short --time 2:00:00
)";

constexpr const char* envelope_examples = R"(  feldspar envelope granite.toml
  feldspar envelope granite.toml --seeds 10 --sigma3 "2 MPa" "5 MPa" "10 MPa" --with-tension
)";

constexpr const char* converge_examples = R"(  feldspar converge granite.toml
  feldspar converge granite.toml --test UCS --seeds 5 --within "3 %"
)";

constexpr const char* claims_examples = R"(  feldspar claims studies/paper
  feldspar claims studies/paper --claim T3 --csv comparisons.csv
)";

constexpr const char* verify_examples = R"(  feldspar verify                        results/verify-1/verify.html has the table
  feldspar verify --list
  feldspar verify --only "two-grains|beams"
)";

constexpr const char* calibrate_examples = R"(  feldspar new calibration --UCS 120MPa --E 30GPa --BTS 9MPa --out targets.toml
  feldspar calibrate targets.toml
  feldspar calibrate targets.toml --budget 400 --threads 8
)";

int complain(ExitCode code, const std::string& message) {
    // Ranks are told the same, and mpirun ends all when it sees that one has failed, perhaps before the first has said why.
    if (built_with_mpi() && started_rank() > 0) return static_cast<int>(ExitCode::success);
    put(stderr, "feldspar: " + printable(message) + "\n");
    return static_cast<int>(code);
}

int guarded(const std::function<ExitCode()>& command) {
    try {
        const ExitCode code = command();
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
            return complain(ExitCode::output, "the results could not be printed");
        return static_cast<int>(code);
    } catch (const InputError& error) {
        return complain(ExitCode::input, error.what());
    } catch (const NumericalError& error) {
        return complain(ExitCode::numerical, error.what());
    } catch (const OutputError& error) {
        return complain(ExitCode::output, error.what());
    } catch (const Interrupted& error) {
        return complain(ExitCode::interrupted, error.what());
    } catch (const std::exception& error) {
        const std::string lack = lack_of_memory(error, "this job");
        return complain(ExitCode::numerical, lack.empty() ? fmt::format("internal error: {}", error.what()) : lack);
    }
}

std::string joined(int argc, char** argv) {
    std::string text = "feldspar";
    for (int i = 1; i < argc; ++i) text += std::string(" ") + argv[i];
    return text;
}

std::string version_text() {
    const Provenance provenance = collect_provenance("", 1);
    return fmt::format("feldspar {} ({}, {})", provenance.version, provenance.commit, provenance.compiler);
}

template <class Options>
void add_thread_options(CLI::App& command, Options& options, const std::string& threads, const std::string& at_once) {
    const auto add = [&](const char* flag, std::optional<int>& value, const std::string& what, const char* type) {
        command.add_option(flag, value, what)->type_name(type)->check(CLI::Range(1, 256));
    };
    add("--threads", options.threads, "number of threads of the whole program (default: " + threads + ")", "N");
    command
        .add_option("--device", options.device,
                    "where the steps are made: cpu (default), gpu, or auto, a graphics card if one can be used")
        ->type_name("D")
        ->check(CLI::IsMember({"cpu", "gpu", "auto"}));
    add("--at-once", options.at_once, "at most so many side by side (default: " + at_once + ")", "K");
}

double checkpoint_interval_s(const std::string& text) {
    if (text == "never") return std::numeric_limits<double>::infinity();
    try {
        if (const double seconds = parse_quantity(text, Dimension::time); seconds > 0.0) return seconds;
    } catch (const InputError&) {  // said below, with what is allowed here
    }
    throw CLI::ValidationError(
        "--checkpoint-every",
        fmt::format("'{}' is not a time greater than zero; allowed: such as \"5 min\" or \"30 s\", or never", text));
}

template <class Options>
void add_retry_option(CLI::App& command, Options& options) {
    command.add_flag("--retry-failed", options.retry_failed,
                     "run again what failed for good: of its input or numerically, with this version of the program");
}

// How often running tests keep their states.
void add_checkpoint_option(CLI::App& command) {
    command
        .add_option_function<std::string>(
            "--checkpoint-every", [](const std::string& text) { checkpoint_settings().every_s = checkpoint_interval_s(text); },
            "running tests keep their states so often, so that the same command goes on where it was ended (default: \"5 min\"; "
            "\"never\": only when it is asked to end)")
        ->type_name("TIME");
}

// The page in a browser.
CLI::Option* add_live_options(CLI::App& command, LiveOptions& live,
                              const char* meaning =
                                  "show the runs in a browser while they are made: which of them are done, curves and cracks of "
                                  "those under way, time left, and buttons that end one of them (without a result: the same "
                                  "command makes it again) or all, as Ctrl-C does; prints the page's address") {
    CLI::Option* on = command.add_flag("--live", live.on, meaning);
    command.add_option("--live-port", live.port, "the port of that page (default: any that is free)")
        ->type_name("PORT")
        ->check(CLI::Range(0, 65535))
        ->needs(on);
    command
        .add_option(
            "--live-address", live.address,
            "the address of this machine to listen at; another than 127.0.0.1 lets other machines see the page, unencrypted")
        ->type_name("ADDRESS")
        ->needs(on);
    return on;
}

constexpr const char* all_cores = "one for each core";
constexpr const char* job_or_all_cores = "as the job says, else one for each core";
constexpr const char* by_size = "as suits their size";

// Kinds of tests as people type them.
std::vector<std::string> test_words() {
    std::vector<std::string> words;
    for (const MethodId method : test_methods()) words.emplace_back(name(method));
    for (const std::string_view word : short_method_names()) words.emplace_back(word);
    return words;
}

constexpr const char* set_meaning =
    "a key of the job and its value, over what the file says, such as material.contact.tau=30MPa; of all tests as "
    "test.plate_mu=0.2, of one kind as test.BTS.plate_mu=0.2; may be repeated";

template <class Options>
void add_set_option(CLI::App& command, Options& options, const std::string& meaning = set_meaning) {
    command.add_option("--set", options.settings, meaning)->type_name("KEY=VALUE")->allow_extra_args(false);
}

// What is printed where. @param object  what --json prints
std::vector<CLI::Option*> add_print_options(CLI::App& command, PrintOptions& print, const std::string& object) {
    return {command.add_flag("--json", print.json,
                             "print " + object +
                                 " as JSON on standard output at the end, and all else on standard error; a "
                                 "mistake as {\"error\": ...}"),
            command.add_flag("--quiet", print.quiet,
                             "print only warnings, mistakes and failures, and at the end the directory of the results")};
}

void add_job_options(CommandLine& line, CLI::App& command, JobOptions& options) {
    command.add_option("job", options.job, "the job file; - reads it from standard input")->required()->type_name("JOB.toml");
    add_set_option(command, options);
    add_thread_options(command, options, job_or_all_cores,
                       "as the job says, else one for each thread, but large specimens one after the other");
    command.add_option("--seed", options.seeds, "run all tests on this packing instead of the job's seeds; may be repeated")
        ->type_name("S")
        ->allow_extra_args(false)
        ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
    command.add_option("--variant", options.variants, "only this variant of the job, by its name; may be repeated")
        ->type_name("NAME")
        ->allow_extra_args(false);
    CLI::Option* test = command
                            .add_option("--test", options.tests,
                                        "only the job's tests of this kind, by its name or as UCS, DTS, BTS; may be repeated")
                            ->type_name("KIND")
                            ->allow_extra_args(false);
    line.choices(test, test_words());
}

void add_study_options(CLI::App& command, StudyOptions& options) {
    command.add_option("study", options.study, "the study file")->type_name("STUDY.toml");
    command.add_option("--results", options.results, "directory of the ledger and the runs (default: as the study says)")
        ->type_name("DIR");
    add_set_option(command, options,
                   "a key of the study's job and its value, over the job, the study's [set] and its axes, such as "
                   "numerics.accuracy=2%; its runs are others than those without it; a key that an axis varies is refused; may "
                   "be repeated");
}

CLI::Option* add_slurm_options(CLI::App& command, StudyOptions& options) {
    CLI::Option* on = command
                          .add_option("--on", options.on,
                                      "slurm: the runs that are not done go to a Slurm cluster as a job array (docs/study.md)")
                          ->type_name("WHERE")
                          ->check(CLI::IsMember({"slurm"}));
    const auto text = [&](const char* flag, std::string& value, const char* what, const char* type) {
        command.add_option(flag, value, std::string("on Slurm: ") + what)->type_name(type)->needs(on);
    };
    text("--partition", options.slurm.partition, "the partition to run in", "NAME");
    text("--account", options.slurm.account, "the account to charge", "NAME");
    text("--time", options.slurm.time, "time limit of an element, as sbatch reads it", "TIME");
    text("--sbatch", options.slurm.sbatch, "further options for sbatch, for example \"--mem=2G --qos=long\"", "OPTIONS");
    command.add_option("--cpus", options.slurm.cpus, "on Slurm: threads of an element")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(1, 256))
        ->needs(on);
    command
        .add_option("--array-limit", options.slurm.array_limit,
                    "on Slurm: at most so many elements at once (default: as many as there is room for)")
        ->type_name("N")
        ->check(CLI::Range(1, 1'000'000))
        ->needs(on);
    command.add_option("--group-minutes", options.slurm.group_minutes, "on Slurm: runs are grouped to elements of about so long")
        ->type_name("MIN")
        ->capture_default_str()
        ->check(CLI::PositiveNumber)
        ->needs(on);
    command.add_flag("--wait", options.wait, "on Slurm: wait for the results and print them")->needs(on);
    return on;
}

// What commands that make a study of a job share.
template <class Options>
void add_made_study_options(CLI::App& command, Options& options, const char* packings, const char* object) {
    command.add_option("job", options.job, "the job file; - reads it from standard input")->required()->type_name("JOB.toml");
    add_set_option(command, options);
    add_print_options(command, options.print, object);
    command.add_option("--seeds", options.packings, packings)->type_name("N")->check(CLI::Range(1, 1000));
    command.add_option("--variant", options.variants, "only this variant of the job, by its name; may be repeated")
        ->type_name("NAME")
        ->allow_extra_args(false);
    add_thread_options(command, options, job_or_all_cores, by_size);
    add_retry_option(command, options);
    add_checkpoint_option(command);
    add_live_options(command, options.live);
}

void add_run(CommandLine& line) {
    const auto options = line.options<RunOptions>();
    CLI::App& command = line.add("run", "run all tests of a job", run_examples);
    add_job_options(line, command, *options);
    command
        .add_option("--out", options->out,
                    "a new directory for the results (default: results/<job>-<n>); one with an unfinished run of this job is "
                    "gone on with")
        ->type_name("DIR");
    CLI::Option* fresh =
        command.add_flag("--fresh", options->fresh, "begin in a new directory, even if there is an unfinished run of this job");
    command
        .add_flag("--continue", options->go_on, "only go on with an unfinished run of this job; it is a mistake if there is none")
        ->excludes(fresh);
    CLI::Option* keep = command
                            .add_option("--keep", options->keep,
                                        "what stays of the tests: numbers (summary and report), histories (also curves and "
                                        "events as CSV), all (also packings and fields; default)")
                            ->type_name("WHAT");
    keep->transform(CLI::CheckedTransformer(std::map<std::string, Keep>{
                                                {"numbers", Keep::numbers}, {"histories", Keep::histories}, {"all", Keep::all}})
                        .description(""));
    line.choices(keep, {"numbers", "histories", "all"});
    add_print_options(command, options->print, "the summary");
    add_checkpoint_option(command);
    add_live_options(command, options->live,
                     "show the run in a browser while it goes on: curves, cracks, time left, and buttons that end a test or the "
                     "run; prints the page's address");
    line.does(command, [options] { return run_command(*options); });
}

void add_check(CommandLine& line) {
    const auto options = std::make_shared<CheckOptions>();
    CLI::App& command = line.add("check", "build everything, print counts, memory and expected time, and stop", check_examples);
    add_job_options(line, command, *options);
    command.add_flag(
        "--json", options->print.json,
        "print counts, memory, steps and time of each kind of test as JSON on standard output at the end, and all else "
        "on standard error; a mistake as {\"error\": ...}");
    command.add_flag("--quiet", options->print.quiet, "print only warnings and mistakes");
    line.does(command, [options] { return check_command(*options); });
}

void add_export(CommandLine& line) {
    const auto options = std::make_shared<ExportOptions>();
    CLI::App& command =
        line.add("export", "write the fields of a run for other programs, from the .h5 files in its directory", export_examples);
    command.add_option("run", options->run, "the directory of a run, or one .h5 file")->required()->type_name("RUN");
    command.add_flag("--vtu", options->vtu,
                     "for ParaView and other programs that read VTK: a .pvd for each test, with a script that opens it coloured");
    command
        .add_option("--test", options->tests,
                    "only this test, as its files are named (brazilian-s1), or all of a kind; may be repeated")
        ->type_name("TEST")
        ->allow_extra_args(false);
    command.add_option("--out", options->out, "directory of the files (default: RUN/paraview)")->type_name("DIR");
    command.add_option("--threads", options->threads, "number of threads (default: one for each core)")
        ->type_name("N")
        ->check(CLI::Range(1, 256));
    line.does(command, [options] { return export_command(*options); });
}

void add_view(CommandLine& line) {
    const auto options = std::make_shared<ViewOptions>();
    CLI::App& command =
        line.add("view", "open the report of a run in the browser, or print its path where there is no display", view_examples);
    command
        .add_option("run", options->run,
                    "the directory of a run, study, envelope or calibration, or a page (default: the newest in results/)")
        ->type_name("RUN");
    command.add_flag("--print", options->print, "only print the path");
    line.does(command, [options] { return view_command(*options); });
}

void add_export_cells(CommandLine& line) {
    const auto options = std::make_shared<ExportCellsOptions>();
    CLI::App& command = line.add(
        "export-cells", "write the cells of a specimen for other programs: Neper (.tess), gmsh (.msh) or as polygons (.csv)",
        export_cells_examples);
    command.add_option("job", options->job, "the job file; - reads it from standard input")->required()->type_name("JOB.toml");
    add_set_option(command, *options);
    command.add_option("--seed", options->seeds, "the packing (default: the job's first)")->type_name("S")->expected(1);
    line.choices(command
                     .add_option("--test", options->tests,
                                 "the specimen of this kind of test, such as the disc of 'brazilian' (default: that of the job)")
                     ->type_name("KIND")
                     ->expected(1),
                 test_words());
    command.add_option("--threads", options->threads, "threads (default: as the job says)")
        ->type_name("N")
        ->check(CLI::Range(0, 256));
    command.add_option("--out", options->out, "a new file; its ending says the format")->required()->type_name("FILE");
    line.does(command, [options] { return export_cells_command(*options); });
}

void add_study(CommandLine& line) {
    const auto options = line.options<StudyOptions>();
    CLI::App& command = line.add(
        "study", "run a study: one job varied along axes, on several packings; goes on where it was interrupted", study_examples);
    command.require_subcommand(0, 1);
    add_thread_options(command, *options, all_cores, by_size);
    CLI::Option* slurm = add_slurm_options(command, *options);
    for (CLI::Option* own : add_print_options(command, options->print, "the points with their properties")) own->excludes(slurm);
    add_live_options(command, options->live)->excludes(slurm);
    add_retry_option(command, *options);
    add_checkpoint_option(command);
    add_study_options(command, *options);
    const auto inside = [&](const char* name, const char* what, ExitCode (*does)(const StudyOptions&),
                            const char* own_examples) -> CLI::App& {
        CLI::App& own = line.add(command, name, what, own_examples);
        add_study_options(own, *options);
        line.does(own, [options, does] {
            if (options->study.empty()) throw InputError({}, "study: a study file is required", "feldspar study STUDY.toml");
            return does(*options);
        });
        return own;
    };
    inside("status", "how much of the study is done", study_status_command, "  feldspar study status sweep.toml\n");
    inside("table", "print the study's points, or its runs, as CSV", study_table_command,
           "  feldspar study table sweep.toml > points.csv\n  feldspar study table sweep.toml --runs > runs.csv\n")
        .add_flag("--runs", options->runs, "a row a run, in SI units, instead of a row a point");
    inside("gather", "take what the elements of a job array have left into the ledger; STUDY.toml or its results' directory",
           study_gather_command, "  feldspar study gather sweep.toml\n");

    const auto element = line.options<ElementOptions>();
    CLI::App& element_command =
        *command.add_subcommand("element", "what an element of a job array runs")->group("");  // not the user's to call
    element_command.add_option("plan", element->plan)->required();
    element_command.add_option("group", element->group)->required();
    line.does(element_command, [element] { return study_element_command(*element); });
    line.does(command, [options] {
        if (options->study.empty()) throw InputError({}, "study: a study file is required", "feldspar study STUDY.toml");
        return study_command(*options);
    });
}

void add_envelope(CommandLine& line) {
    const auto options = line.options<EnvelopeCommandOptions>();
    CLI::App& command = line.add(
        "envelope", "strength envelope: UCS, biaxial series, DTS and BTS on several packings, with Mohr-Coulomb and Hoek-Brown",
        envelope_examples);
    add_made_study_options(command, *options, "number of packings (default: the job's seeds if there are several, else 5)",
                           "envelope.json");
    command
        .add_option("--sigma3", options->sigma3,
                    "confining stresses, such as \"2 MPa\" \"5 MPa\" (default: the job's biaxial tests, else 2.5, 5, 10 and 15 % "
                    "of the expected strength)")
        ->type_name("STRESS");
    command.add_flag("--with-tension", options->with_tension,
                     "the Hoek-Brown parabola goes through the direct tensile strengths too");
    command
        .add_option("--results", options->results,
                    "directory of the results (default: results/<job>-envelope); goes on with what is there")
        ->type_name("DIR");
    line.does(command, [options] { return envelope_command(*options); });
}

void add_converge(CommandLine& line) {
    const auto options = line.options<ConvergeCommandOptions>();
    CLI::App& command =
        line.add("converge", "does the answer depend on grain size, specimen size, mesh, loading rate or the number of packings?",
                 converge_examples);
    add_made_study_options(command, *options, "number of packings (default: the job's seeds if there are several, else 3)",
                           "converge.json");
    line.choices(
        command
            .add_option("--test", options->tests,
                        "only the job's tests of this kind (default: uniaxial, direct tension and Brazilian); may be repeated")
            ->type_name("KIND")
            ->allow_extra_args(false),
        test_words());
    command.add_option("--within", options->within, "a change that does not matter (default: 5 %)")->type_name("SHARE");
    command
        .add_option("--results", options->results,
                    "directory of the results (default: results/<job>-converge); goes on with what is there")
        ->type_name("DIR");
    line.does(command, [options] { return converge_command(*options); });
}

void add_claims(CommandLine& line) {
    const auto options = std::make_shared<ClaimsOptions>();
    CLI::App& command =
        line.add("claims", "hold claims about a model against what studies have found; runs nothing", claims_examples);
    command.add_option("folder", options->folder, "the folder with claims.toml and the study files")
        ->required()
        ->type_name("FOLDER");
    command.add_option("--results", options->results, "directory of the ledger (default: as the studies say)")->type_name("DIR");
    command.add_option("--claim", options->claims, "only this claim, by its id; may be repeated")
        ->type_name("ID")
        ->allow_extra_args(false);
    command.add_option("--csv", options->csv, "write every comparison to this file, too")->type_name("FILE");
    command.add_option("--markdown", options->markdown, "write the verdicts and their numbers to this file, too")
        ->type_name("FILE");
    line.does(command, [options] { return claims_command(*options); });
}

void add_calibrate(CommandLine& line) {
    const auto options = line.options<CalibrateOptions>();
    CLI::App& command = line.add("calibrate",
                                 "laboratory numbers in, contact parameters out, confirmed on fresh packings; tests that are not "
                                 "quasi-static (grade C) count as upper bounds or not at all; goes on where it was interrupted",
                                 calibrate_examples);
    command.add_option("calibration", options->calibration, "the file with targets and unknowns")
        ->required()
        ->type_name("TARGETS.toml");
    command.add_option("--results", options->results, "directory of the ledger and the runs (default: as the file says)")
        ->type_name("DIR");
    command.add_option("--budget", options->budget, "at most so many runs (default: as the file says)")
        ->type_name("N")
        ->check(CLI::Range(20, 100'000));
    add_set_option(command, *options,
                   "a key of the calibration's job and its value, over the job and the file's [set], such as "
                   "numerics.accuracy=2%; its runs are others than those without it; a key that is sought is refused; may be "
                   "repeated");
    add_print_options(command, options->print, "calibration.json");
    add_thread_options(command, *options, all_cores, by_size);
    add_retry_option(command, *options);
    add_checkpoint_option(command);
    add_live_options(command, options->live);
    command.add_flag("--insist", options->insist, "run even if the targets contradict each other");
    line.does(command, [options] { return calibrate_command(*options); });
}

void add_verify(CommandLine& line) {
    const auto options = line.options<VerifyOptions>();
    CLI::App& command = line.add(
        "verify", "hold the program against closed forms on this machine, and print what was expected and what was found",
        verify_examples);
    command.add_option("--only", options->only, "only checks whose name matches this regular expression")->type_name("REGEX");
    command.add_flag("--list", options->list, "print what there is to check, and run nothing");
    command
        .add_option("--out", options->out, "a new directory for the page, JSON and Markdown (default: results/verify-1, -2, ...)")
        ->type_name("DIR");
    command.add_option("--threads", options->threads, "checks side by side (default: one for each core)")
        ->type_name("N")
        ->check(CLI::Range(0, 256));
    line.does(command, [options] { return verify_command(*options); });
}

struct NewOptions {
    std::string kind;
    std::optional<std::string> file;
    bool presets = false;
    std::string rock;
    std::map<std::string, std::optional<std::string>> numbers;  // by GivenName::option

    GivenRock given() const {
        GivenRock given{.rock = rock, .values = {}};
        for (const auto& [name, value] : numbers)
            if (value) given.values[name] = *value;
        return given;
    }
};

constexpr const char* new_examples = R"(  feldspar new biaxial --out biaxial.toml
  feldspar new laboratory --UCS 120MPa --E 30GPa --BTS 9MPa --nu 0.25 --friction-angle "50 deg" --out granite.toml
      all tests of a rock of which these numbers are known, with first contact parameters (docs/validation/first-parameters.md)
  feldspar new uniaxial-compression --rock lac-du-bonnet-granite        a rock of the literature (feldspar new --presets lists them)
  feldspar new calibration --UCS 120MPa --E 30GPa --BTS 9MPa --out targets.toml
)";

void add_new(CommandLine& line) {
    const auto options = std::make_shared<NewOptions>();
    CLI::App& command = line.add("new", "print a commented job, study or calibration to start from", new_examples);
    CLI::Option* kind = command
                            .add_option("kind", options->kind,
                                        fmt::format("a job: {} (the tests of one rock); study; calibration",
                                                    fmt::join(job_template_kinds(), ", ")))
                            ->type_name("KIND");
    CLI::Option* file = command.add_option("--out", options->file, "write it to this new file instead")->type_name("FILE");
    command
        .add_option("--rock", options->rock,
                    "a rock of the literature (feldspar new --presets), or a kind such as granite, for what is not given")
        ->type_name("NAME");
    for (const GivenName& name : given_names())
        command
            .add_option("--" + std::string(name.option), options->numbers[std::string(name.option)], std::string(name.meaning))
            ->type_name("VALUE");
    std::vector<std::string> kinds = test_words();
    kinds.insert(kinds.end(), {"laboratory", "study", "calibration"});
    line.choices(kind, kinds);
    command
        .add_flag("--presets", options->presets,
                  "print the materials that a job may name, and the rocks of the literature, instead")
        ->excludes(kind)
        ->excludes(file);
    line.does(command, [options] {
        if (options->presets && options->given().any())
            throw InputError({}, "new --presets prints what there is and takes no numbers of a rock");
        if (options->presets) return presets_command();
        if (options->kind.empty())
            throw InputError({}, "new: kind is required",
                             fmt::format("{}, study, calibration", fmt::join(job_template_kinds(), ", ")));
        return new_command(options->kind, options->given(), options->file);
    });
}

struct SchemaOptions {
    std::optional<std::string> file;
    bool markdown = false;
};

void add_schema(CommandLine& line) {
    const auto options = std::make_shared<SchemaOptions>();
    CLI::App& command = line.add(
        "schema", "print every key of job files as a JSON Schema, by which editors complete and check them (docs/job.md)",
        schema_examples);
    command.add_flag("--markdown", options->markdown, "as tables to be read instead");
    command.add_option("--out", options->file, "write it to this new file instead")->type_name("FILE");
    line.does(command, [options] { return schema_command(options->markdown, options->file); });
}

// For packages: pages and completions are written when the program is installed.
void add_pages(CommandLine& line) {
    struct Options {
        std::string shell;
        std::vector<std::string> command;
        std::string page;
        bool list = false;
    };
    const auto options = std::make_shared<Options>();
    CLI::App& shells =
        line.add("completion", "print the completion of commands, options and values for a shell",
                 "  source <(feldspar completion bash)\n  feldspar completion fish > ~/.config/fish/completions/feldspar.fish\n");
    CLI::Option* shell = shells.add_option("shell", options->shell, "bash, zsh or fish")
                             ->required()
                             ->type_name("SHELL")
                             ->check(CLI::IsMember({"bash", "zsh", "fish"}).description(""));
    line.choices(shell, {"bash", "zsh", "fish"});
    line.does(shells, [options, &line] { return pages_command(completion(line, options->shell)); });

    CLI::App& pages = line.add("manual", "print a manual page", "  feldspar manual run | man -l -\n");
    pages.add_option("command", options->command, "the command (default: the whole program)")->type_name("COMMAND");
    pages.add_flag("--list", options->list, "print the names of all pages instead");
    pages.add_option("--page", options->page, "the command by the name of its page, such as feldspar-study-status")
        ->type_name("NAME");
    line.does(pages, [options, &line] {
        if (!options->page.empty()) return pages_command(manual_page_named(line, options->page));
        if (options->list) return pages_command(fmt::format("{}\n", fmt::join(manual_names(line), "\n")));
        return pages_command(manual_page(line, fmt::format("{}", fmt::join(options->command, " "))));
    });
}

}  // namespace
}  // namespace feldspar

int main(int argc, char** argv) {
    using namespace feldspar;
    CommandLine line(joined(argc, argv), examples, version_text);
    for (auto* add : {add_run, add_check, add_view, add_export, add_export_cells, add_new, add_schema, add_study, add_envelope,
                      add_converge, add_claims, add_calibrate, add_verify, add_pages})
        add(line);
    if (started_ranks() > 1 && (argc < 2 || std::string_view(argv[1]) != "run"))
        return complain(ExitCode::input, fmt::format("{} programs were started together, which share out the steps of 'feldspar "
                                                     "run' only; run this command without mpirun",
                                                     started_ranks()));
    return line.run(argc, argv, guarded);
}
