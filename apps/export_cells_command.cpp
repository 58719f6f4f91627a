#include <fmt/format.h>

#include <filesystem>

#include "commands.hpp"
#include "feldspar/base/units.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/specimen/write_cells.hpp"
#include "say.hpp"
#include "whole_text.hpp"

namespace feldspar {
namespace {

// The specimen that is written: the job's own, or, with --test, that of the first test of this kind.
SpecimenSpec wanted_specimen(const Job& job, const ExportCellsOptions& options) {
    if (options.tests.empty()) return job.specimen;
    return specimen_of(job, job.tests.front());
}

// The lines by which a job reads the file again.
std::string lines_for_a_job(const std::string& file, CellFormat format) {
    return fmt::format("[specimen]\nshape = \"from-file\"\n[specimen.grains]\nfile = \"{}\"\n{}merge_length = \"none\"\n", file,
                       format == CellFormat::csv ? "" : "unit = \"m\"\n");
}

}  // namespace

ExitCode export_cells_command(const ExportCellsOptions& options) {
    const CellFormat format = cell_format_of(options.out);
    if (std::filesystem::exists(options.out))
        throw InputError({{}, 0, 0, "--out"}, fmt::format("'{}' exists already and is not overwritten", options.out),
                         "the name of a new file in a directory that exists");
    const Job job = job_with_options(options);
    const std::uint64_t seed = options.seeds.empty() ? job.seeds.front() : options.seeds.front();
    SpecimenControl control;
    control.threads = thread_count(job.threads);
    const Specimen specimen = make_specimen(wanted_specimen(job, options), seed, control);
    write_whole(cells_as_text(specimen, format), options.out, "--out");
    for (const std::string& warning : specimen.quality.warnings) say(stderr, "warning: {}\n", warning);
    say("wrote {} grains of seed {} to {}, lengths in m\n", specimen.quality.grains, seed, options.out);
    if (specimen.spec.outline.is_cut())
        say("holes and notches are cut out of these cells; Feldspar reads cells that fill an outline, and cuts holes itself: to "
            "read them again, write those of the job without holes\n");
    else
        say("to read the same specimen again:\n{}",
            lines_for_a_job(std::filesystem::path(options.out).filename().string(), format));
    return ExitCode::success;
}

}  // namespace feldspar
