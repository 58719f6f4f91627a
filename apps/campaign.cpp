#include "campaign.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "feldspar/base/error.hpp"
#include "feldspar/base/parallel.hpp"
#include "feldspar/methods/method.hpp"
#include "interrupt.hpp"

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
    if (method_of(test).specimen.confined) text += fmt::format(" at {:.6g} MPa", test.sigma3_Pa / 1e6);
    return text;
}

std::string title(const std::string& variant, const TestSpec& test) {
    return variant.empty() ? title(test) : variant + ": " + title(test);
}

std::vector<Specimens::Key> Specimens::missing_keys(std::span<const PlannedRun> runs) const {
    std::vector<Key> keys;
    for (const PlannedRun& run : runs) {
        const Key key = key_of(run);
        if (!made_.contains(key) && std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    }
    return keys;
}

void Specimens::make(std::span<const PlannedRun> runs, int threads, const Tell& tell) {
    const std::vector<Key> keys = missing_keys(runs);
    if (keys.empty()) return;
    std::vector<std::shared_ptr<const Specimen>> made(keys.size());
    const int count = static_cast<int>(keys.size());
    side_by_side(count, threads, [&](int i) {
        const auto [disc, seed] = keys[static_cast<std::size_t>(i)];
        SpecimenControl control;
        control.threads = std::max(1, threads / count);
        control.progress = [&, stem = packing_stem(disc, seed)](const SpecimenProgress& progress) {
            if (stop_requested()) throw Interrupted();
            if (count == 1 && tell) tell(stem, progress);   // of several at once, none by itself
        };
        made[static_cast<std::size_t>(i)] =
            std::make_shared<const Specimen>(make_specimen(disc ? job_->brazilian_specimen : job_->specimen, seed, control));
    });
    for (std::size_t i = 0; i < keys.size(); ++i) made_[keys[i]] = std::move(made[i]);
}

std::shared_ptr<const Specimen> Specimens::get(const PlannedRun& run, int threads, const Tell& tell) {
    make({&run, 1}, threads, tell);
    return made_.at(key_of(run));
}

std::string Specimens::packing_stem(bool disc, std::uint64_t seed) { return fmt::format("packing-{}s{}", disc ? "disc-" : "", seed); }

std::string Specimens::packing_stem(const PlannedRun& run) { return packing_stem(method_of(*run.test).specimen.own_disc, run.seed); }

int body_count(const PlannedRun& run, const Specimen& specimen) {
    const bool inner = run.variant->model.kind == GrainKind::inner_particles;
    return static_cast<int>(inner ? specimen.filling.centres.size() : specimen.cells.cells.size());
}

TestSetup setup_of(const PlannedRun& run, std::shared_ptr<const Specimen> specimen) {
    const Variant& variant = *run.variant;
    return {std::move(specimen), variant.model, variant.grain, variant.contact, variant.numerics, *run.test};
}

}  // namespace feldspar
