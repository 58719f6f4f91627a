#include "feldspar/findings/choose_seeds.hpp"

#include <algorithm>

#include "feldspar/base/error.hpp"

namespace feldspar {

std::vector<std::uint64_t> choose_seeds(const Job& job, std::optional<int> wanted, int usual) {
    if (!job.specimen.packing_file.empty()) {
        if (wanted && *wanted > 1)
            throw InputError({{}, 0, 0, "--seeds"}, "several packings are asked for, but the job loads one",
                             "--seeds 1, or a job without a packing");
        return {job.seeds.front()};
    }
    if (job.specimen.given_cells.given() && !wanted && job.seeds.size() == 1)
        return job.seeds;  // other seeds have the same cells
    if (!wanted && job.seeds.size() > 1) return job.seeds;
    const auto count = static_cast<std::size_t>(wanted.value_or(usual));
    std::vector<std::uint64_t> seeds(job.seeds.begin(),
                                     job.seeds.begin() + static_cast<std::ptrdiff_t>(std::min(count, job.seeds.size())));
    for (std::uint64_t seed = 1; seeds.size() < count; ++seed)
        if (std::find(seeds.begin(), seeds.end(), seed) == seeds.end()) seeds.push_back(seed);
    return seeds;
}

std::optional<SpecimenSpec> usual_disc(const SpecimenSpec& specimen) {
    if (specimen.outline.shape == Shape::polygon) return std::nullopt;
    SpecimenSpec disc = specimen;
    const double diameter_m = specimen.outline.shape == Shape::rectangle ? specimen.outline.width_m : specimen.outline.diameter_m;
    if (specimen.outline.shape != Shape::disc || specimen.outline.is_cut()) disc.packing_file.clear();
    if (specimen.outline.shape != Shape::disc || specimen.outline.is_cut()) disc.given_cells.cut = true;
    disc.outline = OutlineSpec{};
    disc.outline.shape = Shape::disc;
    disc.outline.diameter_m = diameter_m;
    return disc;
}

}  // namespace feldspar
