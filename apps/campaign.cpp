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
        for (const TestSpec& test : job.tests) {
            const bool wanted = test.seeds.empty() ? std::find(job.seeds.begin(), job.seeds.end(), seed) != job.seeds.end()
                                                   : std::find(test.seeds.begin(), test.seeds.end(), seed) != test.seeds.end();
            if (wanted) runs.push_back({&test, seed});
        }
    }
    return runs;
}

std::string title(const TestSpec& test) {
    std::string text = name(test.kind);
    if (test.kind == TestKind::biaxial) text += fmt::format(" at {:.6g} MPa", test.sigma3_Pa / 1e6);
    return text;
}

std::shared_ptr<const Specimen> Specimens::get(const PlannedRun& run) {
    std::shared_ptr<const Specimen>& specimen = made_[key_of(run)];
    if (!specimen) {
        const bool disc = run.test->kind == TestKind::brazilian;
        specimen = std::make_shared<const Specimen>(make_specimen(disc ? job_->brazilian_specimen : job_->specimen, run.seed));
    }
    return specimen;
}

bool Specimens::made(const PlannedRun& run) const { return made_.contains(key_of(run)); }

std::string Specimens::packing_stem(const PlannedRun& run) {
    return fmt::format("packing-{}s{}", run.test->kind == TestKind::brazilian ? "disc-" : "", run.seed);
}

TestSetup setup_of(const Job& job, const PlannedRun& run, std::shared_ptr<const Specimen> specimen) {
    return {std::move(specimen), job.model, job.grain, job.contact, job.numerics, *run.test};
}

}  // namespace feldspar
