#include "campaign.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace feldspar {

std::vector<PlannedRun> planned_runs(const Job& job) {
    std::vector<std::uint64_t> seeds = job.seeds;
    for (const TestSpec& test : job.tests)
        for (std::uint64_t seed : test.seeds)
            if (std::find(seeds.begin(), seeds.end(), seed) == seeds.end()) seeds.push_back(seed);

    std::vector<PlannedRun> runs;
    for (std::uint64_t seed : seeds) {
        for (const Variant& variant : job.variants) {
            for (const TestSpec& test : job.tests) {
                const bool wanted = test.seeds.empty()
                                        ? std::find(job.seeds.begin(), job.seeds.end(), seed) != job.seeds.end()
                                        : std::find(test.seeds.begin(), test.seeds.end(), seed) != test.seeds.end();
                if (wanted && variant.runs(test, seed)) runs.push_back({&variant, &test, seed});
            }
        }
    }
    return runs;
}

std::string title(const TestSpec& test) {
    std::string text = name(test.kind);
    if (test.kind == TestKind::biaxial) text += fmt::format(" at {:.6g} MPa", test.sigma3_Pa / 1e6);
    return text;
}

std::string title(const std::string& variant, const TestSpec& test) {
    return variant.empty() ? title(test) : variant + ": " + title(test);
}

std::shared_ptr<const Specimen> Specimens::get(const PlannedRun& run, const SpecimenControl& control) {
    std::shared_ptr<const Specimen>& specimen = made_[key_of(run)];
    if (!specimen) {
        const bool disc = run.test->kind == TestKind::brazilian;
        specimen = std::make_shared<const Specimen>(make_specimen(disc ? job_->brazilian_specimen : job_->specimen, run.seed, control));
    }
    return specimen;
}

std::string Specimens::packing_stem(const PlannedRun& run) {
    return fmt::format("packing-{}s{}", run.test->kind == TestKind::brazilian ? "disc-" : "", run.seed);
}

TestSetup setup_of(const PlannedRun& run, std::shared_ptr<const Specimen> specimen) {
    const Variant& variant = *run.variant;
    return {std::move(specimen), variant.model, variant.grain, variant.contact, variant.numerics, *run.test};
}

}  // namespace feldspar
