#include "feldspar/output/variant_summary.hpp"

#include <cmath>

#include "feldspar/base/median.hpp"

namespace feldspar {

namespace {

/// What summarise() reads, without the fields and the history.
TestResult numbers_of(const TestResult& result) {
    TestResult light;
    light.variant = result.variant;
    light.test = result.test;
    light.seed = result.seed;
    light.properties = result.properties;
    light.interrupted = result.interrupted;
    light.ms_per_step = result.ms_per_step;
    return light;
}

/// Contacts between grains; each of their edges belongs to two cells.
double contact_area_m2(const Specimen& specimen) {
    double length_m = 0.0;
    for (const Cell& cell : specimen.cells.cells) {
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            if (cell.neighbours[k] < 0) continue;
            const Vec2 from = specimen.cells.vertices[static_cast<std::size_t>(cell.vertices[k])];
            const Vec2 to = specimen.cells.vertices[static_cast<std::size_t>(cell.vertices[(k + 1) % cell.vertices.size()])];
            length_m += 0.5 * std::hypot(to.x - from.x, to.y - from.y);
        }
    }
    return length_m * specimen.spec.thickness_m;
}

}  // namespace

std::vector<VariantSummary> summarise_variants(const Job& job, std::span<const TestResult> results) {
    std::vector<VariantSummary> summaries;
    for (const Variant& variant : job.variants) {
        std::vector<TestResult> own;
        std::map<MethodId, std::vector<double>> costs;
        for (const TestResult& result : results) {
            if (result.variant != variant.name) continue;
            own.push_back(numbers_of(result));
            if (std::isfinite(result.ms_per_step) && result.ms_per_step > 0.0)
                costs[result.test.kind].push_back(result.ms_per_step);
        }
        VariantSummary summary{&variant, summarise(own), {}};
        for (auto& [kind, values] : costs) summary.ms_per_step[kind] = median(std::move(values));
        summaries.push_back(std::move(summary));
    }
    return summaries;
}

std::vector<double> broken_share(const TestResult& result) {
    const double total = result.specimen ? contact_area_m2(*result.specimen) : 0.0;
    std::vector<double> share{0.0};
    double broken = 0.0;
    for (const Crack& crack : result.cracks) {
        broken += crack.area_m2;
        share.push_back(total > 0.0 ? broken / total : std::nan(""));
    }
    return share;
}

}  // namespace feldspar
