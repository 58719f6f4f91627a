// Runs and their identity.
#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/job/toml_reader.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/study/study.hpp"
#include "feldspar/study/text_hash.hpp"

namespace feldspar {
namespace {

// Raised when the same job would give other results by design; then nothing counts as done any more.
constexpr const char* kind_of_run = "feldspar run 1\n";

// Everything that can change the result, and nothing else: neither names, threads and laboratory values, nor what is kept of the fields.
std::string identity(Job job) {
    job.name = "run";
    job.threads = job.at_once = 0;
    job.laboratory.clear();
    job.laboratory_confined.clear();
    job.tests.front().snapshots = 0;
    if (method_of(job.tests.front()).specimen.own_disc) job.specimen = job.brazilian_specimen;   // the rectangle is not used
    std::string text = kind_of_run;
    if (!job.specimen.packing_file.empty()) text += read_toml_file(job.specimen.packing_file, "packing");
    job.specimen.packing_file.clear();
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
    if (!method_of(test).specimen.own_disc) run.job.brazilian_specimen = {};
    if (variant.model.kind != GrainKind::inner_particles) run.job.specimen.particles_per_grain = run.job.brazilian_specimen.particles_per_grain = 0.0;
    run.id = hash_of_text(identity(run.job));
    return run;
}

void index_runs(Study& study) {
    study.runs.clear();
    std::vector<std::uint64_t> seeds;
    const auto add = [&](std::uint64_t seed) {
        if (std::find(seeds.begin(), seeds.end(), seed) == seeds.end()) seeds.push_back(seed);
    };
    for (const Point& point : study.points) {
        for (const std::uint64_t seed : point.job.seeds) add(seed);
        for (const TestSpec& test : point.job.tests)
            for (const std::uint64_t seed : test.seeds) add(seed);
    }
    for (const std::uint64_t seed : seeds)
        for (std::size_t p = 0; p < study.points.size(); ++p) {
            const Job& job = study.points[p].job;
            for (const TestSpec& test : job.tests) {
                const std::vector<std::uint64_t> own(test.seeds.begin(), test.seeds.end());
                const std::vector<std::uint64_t>& wanted = own.empty() ? job.seeds : own;
                const bool runs = std::find(wanted.begin(), wanted.end(), seed) != wanted.end() && job.variants.front().runs(test, seed);
                if (!runs) continue;
                study.runs.push_back(make_run(job, job.variants.front(), test, seed));
                study.runs.back().point = p;
            }
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
