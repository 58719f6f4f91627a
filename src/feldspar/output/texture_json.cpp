#include "feldspar/output/texture_json.hpp"

#include <fmt/format.h>

#include "feldspar/output/report_data.hpp"

namespace feldspar {

nlohmann::ordered_json texture_json(const TestResult& result) {
    using Json = nlohmann::ordered_json;
    Json json = Json::object();
    const TextureSummary& texture = result.texture;
    const std::vector<Mineral>& minerals = result.rock.minerals.phases;
    for (std::size_t p = 0; p < minerals.size() && p < texture.grains.size(); ++p)
        json["minerals"].push_back({{"name", minerals[p].name}, {"colour", fmt::format("#{:06x}", minerals[p].colour)}, {"grains", texture.grains[p]},
                                    {"area_share", rounded(texture.area_shares[p])}, {"wanted_share", rounded(minerals[p].share)}});
    for (const auto& [pair, count] : texture.contacts)
        json["pairs"].push_back({{"minerals", {minerals[static_cast<std::size_t>(pair.first)].name, minerals[static_cast<std::size_t>(pair.second)].name}}, {"contacts", count}});
    for (const DrawSummary& draw : texture.draws)
        json["draws"].push_back({{"quantity", name(draw.quantity)}, {"count", draw.count}, {"mean", rounded(draw.mean)}, {"variation", rounded(draw.variation)},
                                 {"lowest", rounded(draw.lowest)}, {"highest", rounded(draw.highest)}});
    if (result.rock.initial_cracks.any())
        json["initial_cracks"] = {{"contacts", texture.contacts_in_all}, {"broken", texture.broken}, {"weakened", texture.weakened}};
    for (std::size_t j = 0; j < result.rock.joints.size() && j < texture.joint_contacts.size(); ++j)
        json["joints"].push_back({{"name", result.rock.joints[j].name}, {"contacts", texture.joint_contacts[j]}, {"length_mm", rounded(1e3 * texture.joint_lengths_m[j])}});
    return json;
}

}  // namespace feldspar
