// The program's commands. Each prints its results to stdout and everything else to stderr, throws what the library throws,
// and returns the exit code.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/job/first_job.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/study/slurm_plan.hpp"
#include "printing.hpp"

namespace feldspar {

/// What stands on the command line beside the job file; it takes precedence over the job.
struct JobOptions {
    std::string job;                    ///< the file; "-": standard input
    std::vector<std::string> settings;  ///< "key=value", laid over the file
    std::vector<std::uint64_t> seeds;   ///< for every test; empty = as the job says
    std::vector<std::string> variants;  ///< names or file stems of the variants to run; empty = all
    std::vector<std::string> tests;     ///< kinds of the tests to run, or short names such as UCS; empty = all
    std::optional<int> threads;
    std::optional<int> at_once;  ///< tests side by side
    std::string device = "cpu";  ///< "cpu", "gpu", "auto": where the steps are made
};

/// Whether a run is shown in a browser while it goes on, and where the page is.
struct LiveOptions {
    bool on = false;
    std::optional<std::string> address;  ///< to listen at; none: this machine alone
    std::optional<int> port;             ///< none: any that is free
};

struct RunOptions : JobOptions {
    std::optional<std::string> out;
    bool fresh = false;        ///< never goes on with an unfinished run
    bool go_on = false;        ///< only goes on with one
    Keep keep = Keep::all;     ///< what stays of the tests
    PrintOptions print;        ///< the object is the summary
    std::string command_line;  ///< for provenance
    LiveOptions live;
};

/// Runs all tests of a job and leaves a directory of results.
ExitCode run_command(const RunOptions& options);

/// What stands on the command line of `export`.
struct ExportOptions {
    std::string run;  ///< directory of a run, or one archive
    bool vtu = false;
    std::vector<std::string> tests;  ///< stems or kinds; empty = all
    std::optional<std::string> out;
    std::optional<int> threads;
};

/// Writes the fields of a run's archives for other programs.
ExitCode export_command(const ExportOptions& options);

/// What stands on the command line of `view`.
struct ViewOptions {
    std::optional<std::string> run;  ///< a directory or a page; none: the newest in results/
    bool print = false;              ///< opens nothing
};

/// Opens a page in the browser.
ExitCode view_command(const ViewOptions& options);

/// Prints a manual page or a completion.
ExitCode pages_command(const std::string& text);

/// What stands on the command line beside the study file.
struct StudyOptions {
    std::string study;
    std::vector<std::string> settings;   ///< "key=value", over the study's job in all its points
    std::optional<std::string> results;  ///< directory of ledger and runs, instead of the study's own
    std::optional<int> threads;
    std::optional<int> at_once;  ///< runs side by side
    std::string device = "cpu";  ///< "cpu", "gpu", "auto": where the steps are made
    bool runs = false;           ///< table: a row a run instead of a row a point
    std::string command_line;    ///< for provenance
    std::string on;              ///< "slurm": on that cluster; empty: on this machine
    SlurmOptions slurm;
    bool retry_failed = false;  ///< also runs that failed for good
    bool wait = false;          ///< on Slurm: until the results are there
    PrintOptions print;         ///< the object has the points with their properties
    LiveOptions live;
};

/// What an element of a job array is called with.
struct ElementOptions {
    std::string plan;  ///< <results>/slurm/<n>
    std::size_t group = 0;
    std::string command_line;
};

/// Reads the study and applies the command line to it.
Study study_with_options(const StudyOptions& options);

/// Submits what is not done of a study to Slurm; with `wait` waits for it and prints the study's points.
ExitCode study_on_slurm(const Study& study, const StudyOptions& options);

/// Takes what elements have left into the ledger, and says what failed or is missing. `study` may be a directory of results.
ExitCode study_gather_command(const StudyOptions& options);

/// Runs an element's group: what Slurm calls on a machine of the cluster.
ExitCode study_element_command(const ElementOptions& options);

/// A line for each job array of these results that is in Slurm's queue.
void print_slurm_status(const std::filesystem::path& results);

/// Runs what is not done yet of a study, and prints its points.
ExitCode study_command(const StudyOptions& options);

/// Prints how many of the study's runs are done, running, failed, or still to do.
ExitCode study_status_command(const StudyOptions& options);

/// Prints the study's points, or its runs, as CSV.
ExitCode study_table_command(const StudyOptions& options);

/// What stands on the command line beside the calibration file.
struct CalibrateOptions {
    std::string calibration;
    std::vector<std::string> settings;   ///< "key=value", over the calibration's job
    std::optional<std::string> results;  ///< directory of ledger and runs, instead of the file's own
    std::optional<int> budget;           ///< runs, instead of the file's own
    std::optional<int> threads;
    std::optional<int> at_once;  ///< runs side by side
    std::string device = "cpu";  ///< "cpu", "gpu", "auto": where the steps are made
    bool insist = false;         ///< run even if the targets contradict each other
    bool retry_failed = false;   ///< also runs that failed for good
    std::string command_line;    ///< for provenance
    PrintOptions print;          ///< the object is calibration.json
    LiveOptions live;
};

/// Finds the values of a job's keys with which the model shows a laboratory's numbers, and confirms them.
ExitCode calibrate_command(const CalibrateOptions& options);

/// What stands on the command line of `claims`.
struct ClaimsOptions {
    std::string folder;                        ///< holds claims.toml and the study files that it names
    std::optional<std::string> results;        ///< directory of the ledger, instead of the studies' own
    std::vector<std::string> claims;           ///< ids; empty = all
    std::optional<std::string> csv, markdown;  ///< files to write, too
};

/// Holds the claims of a folder against what its studies' ledgers have, and prints the verdicts. Runs nothing.
ExitCode claims_command(const ClaimsOptions& options);

/// What stands on the command line of `verify`.
struct VerifyOptions {
    std::optional<std::string> only;  ///< regular expression for the names of checks
    bool list = false;
    std::optional<std::string> out;  ///< a new directory
    int threads = 0;                 ///< 0: one for each core
    std::string command_line;        ///< for provenance
};

/// Runs the closed forms, prints a table, and leaves a page. Exit code 3 if one lies outside of its bound.
ExitCode verify_command(const VerifyOptions& options);

/// What stands on the command line of `envelope` beside the job file.
struct EnvelopeCommandOptions : JobOptions {
    std::optional<int> packings;      ///< how many
    std::vector<std::string> sigma3;  ///< "2 MPa"; empty = the job's, else a default series
    bool with_tension = false;
    bool retry_failed = false;           ///< also runs that failed for good
    std::optional<std::string> results;  ///< directory of ledger, runs and files
    std::string command_line;            ///< for provenance
    PrintOptions print;                  ///< the object is envelope.json
    LiveOptions live;
};

/// UCS, biaxial series, DTS and BTS on several packings; Mohr-Coulomb and Hoek-Brown through them.
ExitCode envelope_command(const EnvelopeCommandOptions& options);

/// What stands on the command line of `converge` beside the job file.
struct ConvergeCommandOptions : JobOptions {
    std::optional<int> packings;         ///< how many
    std::string within = "5 %";          ///< a change that does not matter
    bool retry_failed = false;           ///< also runs that failed for good
    std::optional<std::string> results;  ///< directory of ledger, runs and files
    std::string command_line;            ///< for provenance
    PrintOptions print;                  ///< the object is converge.json
    LiveOptions live;
};

/// Varies grain size, specimen size, triangles and loading rate one at a time, and says whether the answer depends on them.
ExitCode converge_command(const ConvergeCommandOptions& options);

struct CheckOptions : JobOptions {
    PrintOptions print;  ///< the object has counts, memory, steps and time of each kind of test
};

/// Builds everything, prints counts, memory, stable step, expected steps and time, and stops.
ExitCode check_command(const CheckOptions& options);

/// What stands on the command line of `export-cells` beside the job file.
struct ExportCellsOptions : JobOptions {
    std::string out;  ///< a new file, .tess, .msh or .csv
};

/// Writes the cells of one specimen for other programs.
ExitCode export_cells_command(const ExportCellsOptions& options);

/// Prints a commented job, or writes it to a new file; with first parameters for a rock if one is given.
ExitCode new_command(const std::string& kind, const GivenRock& rock, const std::optional<std::string>& out);

/// Prints the materials that jobs may name.
ExitCode presets_command();

/// Prints the keys of jobs as a JSON Schema, or as tables in Markdown, or writes them to a new file.
ExitCode schema_command(bool markdown, const std::optional<std::string>& out);

/// Reads the job and applies the command line to it.
Job job_with_options(const JobOptions& options);

/// Kinds of tests by their names, where short names may have been given. What is neither stays as it is.
std::vector<std::string> full_kinds(std::vector<std::string> words);

/// The number of threads to use: as wanted, or, with 0, one for each core that the program may use. Warns on stderr when there
/// are fewer cores.
int thread_count(int wanted);

}  // namespace feldspar
