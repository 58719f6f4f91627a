#include "feldspar/study/planned_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

bool contains(const auto& seeds, std::uint64_t seed) { return std::find(seeds.begin(), seeds.end(), seed) != seeds.end(); }

// Of all jobs and of their tests, each once.
std::vector<std::uint64_t> seeds_of(std::span<const Job* const> jobs) {
    std::vector<std::uint64_t> seeds;
    const auto add = [&](const auto& more) {
        for (const std::uint64_t seed : more)
            if (!contains(seeds, seed)) seeds.push_back(seed);
    };
    for (const Job* job : jobs) {
        add(job->seeds);
        for (const TestSpec& test : job->tests) add(test.seeds);
    }
    return seeds;
}

}  // namespace

std::vector<PlannedRun> planned_runs(std::span<const Job* const> jobs) {
    std::vector<PlannedRun> runs;
    const auto wanted = [](const PlannedRun& run) {
        const bool of_test = run.test->seeds.empty() ? contains(run.job->seeds, run.seed) : contains(run.test->seeds, run.seed);
        return of_test && run.variant->runs(*run.test, run.seed);
    };
    for (const std::uint64_t seed : seeds_of(jobs))
        for (std::size_t j = 0; j < jobs.size(); ++j)
            for (const Variant& variant : jobs[j]->variants)
                for (const TestSpec& test : jobs[j]->tests)
                    if (const PlannedRun run{j, jobs[j], &variant, &test, seed}; wanted(run)) runs.push_back(run);
    return runs;
}

std::vector<PlannedRun> planned_runs(const Job& job) {
    const Job* const one = &job;
    return planned_runs({&one, 1});
}

const SpecimenSpec& specimen_of(const PlannedRun& run) { return specimen_of(*run.job, *run.test); }

std::string packing_stem(const PlannedRun& run) {
    const TestSpec& test = *run.test;
    const std::string of = method_of(test).specimen.own_disc ? "disc-" : test.specimen ? test_name(test) + "-" : "";
    return fmt::format("packing-{}s{}", of, run.seed);
}

std::string title(const TestSpec& test) {
    std::string text = test_name(test);
    if (tells_pressure(test)) text += fmt::format(" at {:.6g} MPa", test.sigma3_Pa / 1e6);
    return text;
}

std::string title(const std::string& variant, const TestSpec& test) {
    return variant.empty() ? title(test) : variant + ": " + title(test);
}

std::string label_of(const PlannedRun& run) { return fmt::format("{}, seed {}", title(run.variant->name, *run.test), run.seed); }

int body_count(const PlannedRun& run, const Specimen& specimen) {
    const bool inner = run.variant->model.kind == GrainKind::inner_particles;
    return static_cast<int>(inner ? specimen.filling.centres.size() : specimen.cells.cells.size());
}

TestSetup setup_of(const PlannedRun& run, std::shared_ptr<const Specimen> specimen) {
    const Variant& variant = *run.variant;
    return {std::move(specimen), variant.model, variant.grain, variant.contact, variant.numerics, *run.test, run.variant->rock};
}

}  // namespace feldspar
