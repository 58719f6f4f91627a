#include "feldspar/output/texture_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/output/report_data.hpp"
#include "feldspar/specimen/grain_sizes.hpp"

namespace feldspar {

bool has_texture(const TestResult& result) {
    return result.rock.any() || (result.specimen && result.specimen->quality.crystals > 0);
}

namespace {

nlohmann::ordered_json sizes_json(const SizeSummary& sizes) {
    return {{"mean", rounded(1e3 * sizes.mean_m)},
            {"minimum", rounded(1e3 * sizes.minimum_m)},
            {"maximum", rounded(1e3 * sizes.maximum_m)},
            {"D50", rounded(1e3 * sizes.D50_m)}};
}

}  // namespace

nlohmann::ordered_json texture_json(const TestResult& result) {
    using Json = nlohmann::ordered_json;
    Json json = Json::object();
    const TextureSummary& texture = result.texture;
    const std::vector<Mineral>& minerals = result.rock.minerals.phases;
    for (std::size_t p = 0; p < minerals.size() && p < texture.grains.size(); ++p)
        json["minerals"].push_back({{"name", minerals[p].name},
                                    {"colour", fmt::format("#{:06x}", minerals[p].colour)},
                                    {"grains", texture.grains[p]},
                                    {"area_share", rounded(texture.area_shares[p])},
                                    {"wanted_share", rounded(minerals[p].share)}});
    if (result.specimen)
        for (std::size_t p = 0; p < result.specimen->spec.phase_sizes.size() && p < texture.disc_sizes.size(); ++p) {
            const PhaseSizes& wanted = result.specimen->spec.phase_sizes[p];
            json["minerals"][p]["sizes_mm"] = {{"wanted",
                                                {{"mean", rounded(1e3 * diameter_moments(wanted.sizes).mean_m)},
                                                 {"minimum", rounded(1e3 * smallest_of(wanted.sizes))},
                                                 {"maximum", rounded(1e3 * largest_of(wanted.sizes))}}},
                                               {"discs", sizes_json(texture.disc_sizes[p])},
                                               {"cells", sizes_json(texture.sizes[p])}};
        }
    if (result.specimen && result.specimen->quality.crystals > 0) {
        const std::vector<int>& crystal = result.specimen->crystal_of_cell;
        const auto inside = std::ranges::count_if(result.cracks, [&](const Crack& crack) {
            return crystal[static_cast<std::size_t>(crack.grain_a)] == crystal[static_cast<std::size_t>(crack.grain_b)];
        });
        json["crystals"] = {
            {"crystals", result.specimen->quality.crystals},
            {"grains_per_crystal", rounded(static_cast<double>(crystal.size()) / result.specimen->quality.crystals)},
            {"inside_contacts", texture.inside},
            {"contacts", texture.contacts_in_all},
            {"inside_cracks", inside},
            {"cracks", result.cracks.size()}};
    }
    for (const auto& [pair, count] : texture.contacts)
        json["pairs"].push_back(
            {{"minerals",
              {minerals[static_cast<std::size_t>(pair.first)].name, minerals[static_cast<std::size_t>(pair.second)].name}},
             {"contacts", count}});
    for (const DrawSummary& draw : texture.draws)
        json["draws"].push_back({{"quantity", name(draw.quantity)},
                                 {"count", draw.count},
                                 {"mean", rounded(draw.mean)},
                                 {"variation", rounded(draw.variation)},
                                 {"lowest", rounded(draw.lowest)},
                                 {"highest", rounded(draw.highest)}});
    if (result.rock.initial_cracks.any())
        json["initial_cracks"] = {
            {"contacts", texture.contacts_in_all}, {"broken", texture.broken}, {"weakened", texture.weakened}};
    for (std::size_t j = 0; j < result.rock.joints.size() && j < texture.joint_contacts.size(); ++j)
        json["joints"].push_back({{"name", result.rock.joints[j].name},
                                  {"contacts", texture.joint_contacts[j]},
                                  {"length_mm", rounded(1e3 * texture.joint_lengths_m[j])}});
    return json;
}

nlohmann::ordered_json acoustic_emission_json(const TestResult& result) {
    using Json = nlohmann::ordered_json;
    const AcousticEmission& emission = result.emission;
    if (emission.events.empty()) return nullptr;
    double energy_J = 0.0, largest = std::numeric_limits<double>::quiet_NaN();
    int shear = 0, tensile = 0, largest_cracks = 0;
    for (const AcousticEvent& event : emission.events) {
        energy_J += event.energy_J;
        if (std::isfinite(event.magnitude) && !(event.magnitude <= largest)) largest = event.magnitude;
        largest_cracks = std::max(largest_cracks, event.cracks);
        shear += std::abs(event.isotropy) <= 30.0;
        tensile += event.isotropy > 30.0;
    }
    Json counts = Json::array();
    for (const AcousticCount& count : emission.counts)
        counts.push_back(
            {{"radius_grains", count.radius_grains}, {"events", count.events}, {"b_value", rounded(count.b_value.b)}});
    const double count = static_cast<double>(emission.events.size());
    return {{"radius_mm", rounded(1e3 * emission.radius_m)},
            {"window_steps", rounded(emission.window_steps)},
            {"events", emission.events.size()},
            {"energy_J", rounded(energy_J)},
            {"largest_magnitude", rounded(largest)},
            {"most_cracks", largest_cracks},
            {"tensile_share", rounded(tensile / count)},
            {"shear_share", rounded(shear / count)},
            {"b_value", rounded(emission.b_value.b)},
            {"b_error", rounded(emission.b_value.error)},
            {"completeness_magnitude", rounded(emission.b_value.completeness)},
            {"events_above_it", emission.b_value.events},
            {"fractal_dimension", rounded(emission.fractal_dimension)},
            {"other_radii", counts}};
}

}  // namespace feldspar
