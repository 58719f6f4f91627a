// The program `feldspar`: reads the command line, calls a command, and turns what it throws into a message and an exit code.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <limits>
#include <new>

#include "commands.hpp"
#include "feldspar/output/results.hpp"

namespace feldspar {
namespace {

constexpr const char* examples = R"(Examples:
  feldspar new uniaxial-compression --out granite.toml   a commented job to start from
  feldspar check granite.toml                            is it sound, how long will it take?
  feldspar run granite.toml                              results in results/granite-1
  feldspar run granite.toml --out trial --seed 7         another packing, another place
  feldspar run granite.toml --threads 2                  the results do not depend on the threads
  feldspar run granite.toml --at-once 1                  one test after the other, each on all threads
  feldspar run granite.toml --test brazilian             only a part of the job
  feldspar envelope granite.toml                         strength envelope over five packings
  feldspar converge granite.toml                         does the answer depend on grains, size, mesh, rate, packings?

Exit codes: 0 done, 2 mistake in the input (no file is left), 3 numerical failure, 4 results could not be written,
130 interrupted (the results so far are kept).)";

int complain(ExitCode code, const std::string& message) {
    fmt::print(stderr, "feldspar: {}\n", message);
    return static_cast<int>(code);
}

int guarded(const std::function<ExitCode()>& command) {
    try {
        const ExitCode code = command();
        if (std::fflush(stdout) != 0) return complain(ExitCode::output, "the results could not be printed");
        return static_cast<int>(code);
    } catch (const InputError& error) {
        return complain(ExitCode::input, error.what());
    } catch (const NumericalError& error) {
        return complain(ExitCode::numerical, error.what());
    } catch (const OutputError& error) {
        return complain(ExitCode::output, error.what());
    } catch (const Interrupted& error) {
        return complain(ExitCode::interrupted, error.what());
    } catch (const std::bad_alloc&) {
        return complain(ExitCode::numerical, "there is not enough memory for this job");
    } catch (const std::exception& error) {
        return complain(ExitCode::numerical, fmt::format("internal error: {}", error.what()));
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

void add_job_options(CLI::App& command, JobOptions& options) {
    command.add_option("job", options.job, "the job file")->required()->type_name("JOB.toml");
    command.add_option("--threads", options.threads, "number of threads of the whole program (default: as the job says, else one for each core)")
        ->type_name("N")
        ->check(CLI::Range(1, 256));
    command.add_option("--at-once", options.at_once,
                       "at most so many tests side by side (default: as the job says, else one for each thread, but large specimens one "
                       "after the other)")
        ->type_name("K")
        ->check(CLI::Range(1, 256));
    command.add_option("--seed", options.seeds, "run all tests on this packing instead of the job's seeds; may be repeated")
        ->type_name("S")
        ->allow_extra_args(false)
        ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
    command.add_option("--variant", options.variants, "only this variant of the job, by its name; may be repeated")
        ->type_name("NAME")
        ->allow_extra_args(false);
    command.add_option("--test", options.tests, "only the job's tests of this kind; may be repeated")->type_name("KIND")->allow_extra_args(false);
}

void add_study_options(CLI::App& command, StudyOptions& options) {
    command.add_option("study", options.study, "the study file")->type_name("STUDY.toml");
    command.add_option("--results", options.results, "directory of the ledger and the runs (default: as the study says)")->type_name("DIR");
}

void add_slurm_options(CLI::App& command, StudyOptions& options) {
    CLI::Option* on = command.add_option("--on", options.on, "slurm: the runs that are not done go to a Slurm cluster as a job array (docs/study.md)")
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
    command.add_option("--array-limit", options.slurm.array_limit, "on Slurm: at most so many elements at once (default: as many as there is room for)")
        ->type_name("N")
        ->check(CLI::Range(1, 1'000'000))
        ->needs(on);
    command.add_option("--group-minutes", options.slurm.group_minutes, "on Slurm: runs are grouped to elements of about so long")
        ->type_name("MIN")
        ->capture_default_str()
        ->check(CLI::PositiveNumber)
        ->needs(on);
    command.add_flag("--wait", options.wait, "on Slurm: wait for the results and print them")->needs(on);
}

// What commands that make a study of a job share.
template <class Options>
void add_made_study_options(CLI::App& command, Options& options, const char* packings) {
    command.add_option("job", options.job, "the job file")->required()->type_name("JOB.toml");
    command.add_option("--seeds", options.packings, packings)->type_name("N")->check(CLI::Range(1, 1000));
    command.add_option("--variant", options.variants, "only this variant of the job, by its name; may be repeated")->type_name("NAME")->allow_extra_args(false);
    command.add_option("--threads", options.threads, "number of threads of the whole program (default: as the job says, else one for each core)")
        ->type_name("N")
        ->check(CLI::Range(1, 256));
    command.add_option("--at-once", options.at_once, "at most so many runs side by side (default: as suits their size)")->type_name("K")->check(CLI::Range(1, 256));
}

int run_program(int argc, char** argv) {
    CLI::App app("A laboratory for rock fracture with the flexible particle model.", "feldspar");
    app.footer(examples);
    app.require_subcommand(1);
    app.set_version_flag("--version", version_text);
    app.failure_message([](const CLI::App*, const CLI::Error& error) {
        return fmt::format("feldspar: {}\n  'feldspar --help' shows the commands with examples\n", error.what());
    });

    RunOptions run;
    run.command_line = joined(argc, argv);
    CLI::App* run_app = app.add_subcommand("run", "run all tests of a job");
    add_job_options(*run_app, run);
    run_app->add_option("--out", run.out, "a new directory for the results (default: results/<job>-<n>)")->type_name("DIR");

    JobOptions check;
    CLI::App* check_app = app.add_subcommand("check", "build everything, print counts, memory and expected time, and stop");
    add_job_options(*check_app, check);

    StudyOptions study;
    study.command_line = run.command_line;
    CLI::App* study_app = app.add_subcommand("study", "run a study: one job varied along axes, on several packings; goes on where it was interrupted");
    CLI::App* status_app = study_app->add_subcommand("status", "how much of the study is done");
    CLI::App* table_app = study_app->add_subcommand("table", "print the study's points, or its runs, as CSV");
    CLI::App* gather_app = study_app->add_subcommand("gather", "take what the elements of a job array have left into the ledger; STUDY.toml or its results' directory");
    for (CLI::App* command : {study_app, status_app, table_app, gather_app}) add_study_options(*command, study);
    add_slurm_options(*study_app, study);
    ElementOptions element;
    element.command_line = run.command_line;
    CLI::App* element_app = study_app->add_subcommand("element", "what an element of a job array runs")->group("");   // not the user's to call
    element_app->add_option("plan", element.plan)->required();
    element_app->add_option("group", element.group)->required();
    study_app->require_subcommand(0, 1);
    study_app->add_option("--threads", study.threads, "number of threads of the whole program (default: one for each core)")
        ->type_name("N")
        ->check(CLI::Range(1, 256));
    study_app->add_option("--at-once", study.at_once, "at most so many runs side by side (default: as suits their size)")
        ->type_name("K")
        ->check(CLI::Range(1, 256));
    table_app->add_flag("--runs", study.runs, "a row a run, in SI units, instead of a row a point");

    CalibrateOptions calibrate;
    calibrate.command_line = run.command_line;
    CLI::App* calibrate_app = app.add_subcommand("calibrate", "laboratory numbers in, contact parameters out; goes on where it was interrupted");
    calibrate_app->add_option("calibration", calibrate.calibration, "the file with targets and unknowns")->required()->type_name("TARGETS.toml");
    calibrate_app->add_option("--results", calibrate.results, "directory of the ledger and the runs (default: as the file says)")->type_name("DIR");
    calibrate_app->add_option("--budget", calibrate.budget, "at most so many runs (default: as the file says)")->type_name("N")->check(CLI::Range(20, 100'000));
    calibrate_app->add_option("--threads", calibrate.threads, "number of threads of the whole program (default: one for each core)")
        ->type_name("N")
        ->check(CLI::Range(1, 256));
    calibrate_app->add_option("--at-once", calibrate.at_once, "at most so many runs side by side (default: as suits their size)")
        ->type_name("K")
        ->check(CLI::Range(1, 256));
    calibrate_app->add_flag("--insist", calibrate.insist, "run even if the targets contradict each other");

    EnvelopeCommandOptions envelope;
    envelope.command_line = run.command_line;
    CLI::App* envelope_app = app.add_subcommand("envelope", "strength envelope: UCS, biaxial series, DTS and BTS on several packings, with Mohr-Coulomb and Hoek-Brown");
    add_made_study_options(*envelope_app, envelope, "number of packings (default: the job's seeds if there are several, else 5)");
    envelope_app->add_option("--sigma3", envelope.sigma3, "confining stresses, such as \"2 MPa\" \"5 MPa\" (default: the job's biaxial tests, else 2.5, 5, 10 and 15 % of the expected strength)")
        ->type_name("STRESS");
    envelope_app->add_flag("--with-tension", envelope.with_tension, "the Hoek-Brown parabola goes through the direct tensile strengths too");
    envelope_app->add_option("--results", envelope.results, "directory of the results (default: results/<job>-envelope); goes on with what is there")->type_name("DIR");

    ConvergeCommandOptions converge;
    converge.command_line = run.command_line;
    CLI::App* converge_app = app.add_subcommand("converge", "does the answer depend on grain size, specimen size, mesh, loading rate or the number of packings?");
    add_made_study_options(*converge_app, converge, "number of packings (default: the job's seeds if there are several, else 3)");
    converge_app->add_option("--test", converge.tests, "only the job's tests of this kind (default: uniaxial, direct tension and Brazilian); may be repeated")
        ->type_name("KIND")
        ->allow_extra_args(false);
    converge_app->add_option("--within", converge.within, "a change that does not matter (default: 5 %)")->type_name("SHARE");
    converge_app->add_option("--results", converge.results, "directory of the results (default: results/<job>-converge); goes on with what is there")->type_name("DIR");

    std::string kind;
    std::optional<std::string> file;
    CLI::App* new_app = app.add_subcommand("new", "print a commented job to start from");
    CLI::Option* kind_option =
        new_app->add_option("kind", kind, "uniaxial-compression, direct-tension, biaxial, brazilian or laboratory (all of them)")
            ->type_name("KIND");
    CLI::Option* file_option = new_app->add_option("--out", file, "write it to this new file instead")->type_name("FILE");
    bool presets = false;
    new_app->add_flag("--presets", presets, "print the materials that a job may name instead")
        ->excludes(kind_option)
        ->excludes(file_option);

    ClaimsOptions claims;
    CLI::App* claims_app = app.add_subcommand("claims", "hold claims about a model against what studies have found; runs nothing");
    claims_app->add_option("folder", claims.folder, "the folder with claims.toml and the study files")->required()->type_name("FOLDER");
    claims_app->add_option("--results", claims.results, "directory of the ledger (default: as the studies say)")->type_name("DIR");
    claims_app->add_option("--claim", claims.claims, "only this claim, by its id; may be repeated")->type_name("ID")->allow_extra_args(false);
    claims_app->add_option("--csv", claims.csv, "write every comparison to this file, too")->type_name("FILE");
    claims_app->add_option("--markdown", claims.markdown, "write the verdicts and their numbers to this file, too")->type_name("FILE");

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? static_cast<int>(ExitCode::success) : static_cast<int>(ExitCode::input);
    }
    return guarded([&] {
        if (*run_app) return run_command(run);
        if (*check_app) return check_command(check);
        if (*claims_app) return claims_command(claims);
        if (*element_app) return study_element_command(element);
        if (*study_app && study.study.empty()) throw InputError({}, "study: a study file is required", "feldspar study STUDY.toml");
        if (*status_app) return study_status_command(study);
        if (*table_app) return study_table_command(study);
        if (*gather_app) return study_gather_command(study);
        if (*study_app) return study_command(study);
        if (*calibrate_app) return calibrate_command(calibrate);
        if (*envelope_app) return envelope_command(envelope);
        if (*converge_app) return converge_command(converge);
        if (presets) return presets_command();
        if (kind.empty())
            throw InputError({}, "new: kind is required", "uniaxial-compression, direct-tension, biaxial, brazilian, laboratory");
        return new_command(kind, file);
    });
}

}  // namespace
}  // namespace feldspar

int main(int argc, char** argv) { return feldspar::run_program(argc, argv); }
