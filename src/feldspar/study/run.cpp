// Runs and their identity.
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "feldspar/job/toml_reader.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/study/planned_runs.hpp"
#include "feldspar/study/study.hpp"
#include "feldspar/study/text_hash.hpp"

namespace feldspar {
namespace {

// Raised when the same job would give other results by design; then nothing counts as done any more.
constexpr const char* kind_of_run = "feldspar run 1\n";

// Everything that can change the result, and nothing else: neither names, threads and laboratory values, nor what is kept of the
// fields.
std::string identity(Job job) {
    job.name = "run";
    job.threads = job.at_once = 0;
    job.laboratory.clear();
    job.laboratory_confined.clear();
    job.tests.front().snapshots = 0;
    job.specimen = specimen_of(job, job.tests.front());  // the job's own is not used
    std::string text = kind_of_run;
    if (!job.specimen.packing_file.empty()) text += read_toml_file(job.specimen.packing_file, "packing");
    job.specimen.packing_file.clear();
    text += job.specimen.given_cells.hash;
    job.specimen.given_cells.file.clear();
    for (Variant& variant : job.variants) {
        text += variant.rock.files;  // files count by what is in them, not by their places
        variant.rock.minerals.map_file.clear();
        variant.rock.minerals.list_file.clear();
        for (JointSpec& joint : variant.rock.joints) joint.file = joint.file.empty() ? "" : "read";
    }
    return text + resolved_toml(job);
}

}  // namespace

Run make_run(const Job& job, const Variant& variant, const TestSpec& test, std::uint64_t seed) {
    Run run;
    run.job = job;
    run.job.variants = {variant};
    Variant& own = run.job.variants.front();
    own.name.clear();
    own.stem.clear();
    own.seeds.clear();
    own.tests.clear();
    run.job.tests = {test};
    run.job.tests.front().seeds.clear();
    run.job.seeds = {seed};
    if (test.specimen && !method_of(test).specimen.own_disc) {  // the same run as one of a job whose specimen it is
        run.job.specimen = *test.specimen;
        run.job.tests.front().specimen.reset();
    }
    if (variant.model.kind != GrainKind::inner_particles)
        for_each_specimen(run.job, [](SpecimenSpec& specimen) { specimen.particles_per_grain = 0.0; });
    run.id = hash_of_text(identity(run.job));
    return run;
}

void index_runs(Study& study) {
    study.runs.clear();
    std::vector<const Job*> jobs;
    for (const Point& point : study.points) jobs.push_back(&point.job);
    for (const PlannedRun& run : planned_runs(jobs)) {
        study.runs.push_back(make_run(*run.job, *run.variant, *run.test, run.seed));
        study.runs.back().point = run.job_number;
    }
}

Study study_of(const Job& job, const std::string& name, const std::filesystem::path& results) {
    Study study;
    study.file = job.file;
    study.text = job.text;
    study.name = study.title = name;
    study.results = results;
    if (job.has_variants()) study.axes.push_back("variant");
    for (const Variant& variant : job.variants) {
        Point point;
        if (job.has_variants()) point.values.push_back({variant.name, std::numeric_limits<double>::quiet_NaN()});
        point.job = job;
        point.job.variants = {variant};
        point.job.variants.front().name.clear();
        point.job.variants.front().stem.clear();
        study.points.push_back(std::move(point));
    }
    index_runs(study);
    return study;
}

}  // namespace feldspar
