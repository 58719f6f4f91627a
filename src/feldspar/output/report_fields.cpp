// The fields that the report's viewer draws, made small: bytes and 16-bit steps instead of doubles, then zlib and base64.
//
// Layout of a block, little-endian, every part starting at a multiple of 8 (its offset and type are in the meta data):
//   nodes            float32  x, y of each node (mm)
//   node_begin       int32    grains + 1
//   triangle_begin   int32    grains + 1
//   vertex_count     int32    grains: the first so many nodes of a grain are its outline
//   corners          uint16   three a triangle, counted from the grain's first node
//   phase            uint8    grains: the mineral; only of a rock with minerals
//   crystal          int32    grains: the crystal; only where crystals have several grains
//   joint_ends       float32  x, y of both ends of the grain edges of joints (mm); only with joints
//   crack_ends       float32  x, y of both ends (mm)
//   crack_nodes      int32    two on face a, two on face b; -1 unknown
//   crack_strain     float32  axial strain at the break, 10^-3
//   crack_mode       uint8    0 tensile, 1 shear
//   crack_square     int32    the square in which it lies; -1 none; only of a specimen drawn in squares
// and for each snapshot n:
//   u<n>             int16    all x, then all y, each as the difference from the node before; times `scale` (mm)
//   damage<n>        uint8    0 ... 255 for 0 ... 1
//   sigma1_<n>, sigma3_<n>  uint8  principal stresses: 0 ... 255 between the test's limits
//   fragment<n>      int32    grains: the piece that it belongs to, from 0 on by falling area
//
// A large specimen is drawn in squares (squares.hpp), which stand in the place of grains; "squares" in the meta data says how
// large they are. Of its cracks every "crack_every"-th is there.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "feldspar/base/error.hpp"
#include "feldspar/output/crack_geometry.hpp"
#include "feldspar/output/fragments.hpp"
#include "feldspar/output/report_block.hpp"
#include "feldspar/output/report_data.hpp"
#include "feldspar/output/squares.hpp"
#include "feldspar/output/user_units.hpp"

namespace feldspar {

namespace {

using Json = nlohmann::ordered_json;

/// A stress field's range without its extremes: single triangles at crack tips would wash out the rest.
struct Limits {
    double low = 0.0, high = 0.0;
    std::uint8_t level(double value) const {
        const double share = high > low ? (value - low) / (high - low) : 0.0;
        return static_cast<std::uint8_t>(
            5 * std::lround(51.0 * std::clamp(std::isfinite(share) ? share : 0.0, 0.0,
                                              1.0)));  // in steps of 5: finer ones are not seen, and take half of the room
    }
};

Limits limits_of(std::vector<double> values) {
    std::erase_if(values, [](double v) { return !std::isfinite(v); });
    if (values.empty()) return {};
    const auto quantile = [&](double q) {
        const auto place = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
        std::ranges::nth_element(values, place);
        return *place;
    };
    return {quantile(0.005), quantile(0.995)};
}

struct Principal {
    std::vector<double> sigma1_MPa, sigma3_MPa;
};

Principal principal(const Snapshot& snapshot) {
    Principal p;
    for (std::size_t t = 0; t < snapshot.stress_xx_Pa.size(); ++t) {
        const double mean = 0.5 * (snapshot.stress_xx_Pa[t] + snapshot.stress_yy_Pa[t]) * MPa;
        const double radius =
            std::hypot(0.5 * (snapshot.stress_xx_Pa[t] - snapshot.stress_yy_Pa[t]), snapshot.stress_xy_Pa[t]) * MPa;
        p.sigma1_MPa.push_back(mean + radius);
        p.sigma3_MPa.push_back(mean - radius);
    }
    return p;
}

void add_mesh(Block& block, const GrainMesh& mesh) {
    std::vector<float> nodes;
    for (const Vec2 node : mesh.nodes)
        nodes.insert(nodes.end(), {static_cast<float>(node.x * 1e3), static_cast<float>(node.y * 1e3)});
    std::vector<std::uint16_t> corners;
    for (std::size_t g = 0; g + 1 < mesh.triangle_begin.size(); ++g) {
        for (int t = mesh.triangle_begin[g]; t < mesh.triangle_begin[g + 1]; ++t) {
            for (const int node : mesh.triangles[static_cast<std::size_t>(t)])
                corners.push_back(static_cast<std::uint16_t>(node - mesh.node_begin[g]));
        }
    }
    block.add("nodes", "float32", nodes);
    block.add("node_begin", "int32", mesh.node_begin);
    block.add("triangle_begin", "int32", mesh.triangle_begin);
    block.add("vertex_count", "int32", mesh.vertex_count);
    block.add("corners", "uint16", corners);
}

void add_texture(Block& block, Json& meta, const TestResult& result) {
    const TextureSummary& texture = result.texture;
    if (!texture.phase_of_grain.empty()) {
        block.add("phase", "uint8", std::vector<std::uint8_t>(texture.phase_of_grain.begin(), texture.phase_of_grain.end()));
        for (const Mineral& mineral : result.rock.minerals.phases)
            meta["minerals"].push_back({{"name", mineral.name}, {"colour", fmt::format("#{:06x}", mineral.colour)}});
    }
    if (!result.specimen->crystal_of_cell.empty()) block.add("crystal", "int32", result.specimen->crystal_of_cell);
    if (texture.joint_edges.empty()) return;
    std::vector<float> ends;
    for (const auto& [from, to] : texture.joint_edges)
        for (const double x : {from.x, from.y, to.x, to.y}) ends.push_back(static_cast<float>(x * 1e3));
    block.add("joint_ends", "float32", ends);
}

void add_cracks(Block& block, const TestResult& result) {
    std::vector<float> ends, strain;
    std::vector<int> nodes;
    std::vector<std::uint8_t> mode;
    const auto faces = find_crack_faces(*result.specimen, result.cracks);
    for (std::size_t c = 0; c < result.cracks.size(); ++c) {
        const Crack& crack = result.cracks[c];
        for (const double x : {crack.from.x, crack.from.y, crack.to.x, crack.to.y}) ends.push_back(static_cast<float>(x * 1e3));
        nodes.insert(nodes.end(), {faces[c].a.node_0, faces[c].a.node_1, faces[c].b.node_0, faces[c].b.node_1});
        strain.push_back(static_cast<float>(crack.axial_strain * 1e3));
        mode.push_back(static_cast<std::uint8_t>(crack.mode));
    }
    block.add("crack_ends", "float32", ends);
    block.add("crack_nodes", "int32", nodes);
    block.add("crack_strain", "float32", strain);
    block.add("crack_mode", "uint8", mode);
}

/// Adds the displacement as 16-bit differences; gives the step in mm.
double add_displacement(Block& block, const std::string& part, const std::vector<Vec2>& displacement_m) {
    double largest = 0.0;
    for (const Vec2 u : displacement_m) largest = std::max({largest, std::abs(u.x), std::abs(u.y)});
    const double scale =
        largest > 0.0 && std::isfinite(largest) ? largest / 8191.0 : 1.0;  // finer steps would fill the page with noise
    std::vector<std::int16_t> steps;
    steps.reserve(2 * displacement_m.size());
    for (const bool y : {false, true}) {
        std::int16_t before = 0;
        for (const Vec2 u : displacement_m) {
            const double value = (y ? u.y : u.x) / scale;
            const auto now = static_cast<std::int16_t>(std::lround(std::isfinite(value) ? value : 0.0));
            steps.push_back(static_cast<std::int16_t>(static_cast<std::uint16_t>(now) -
                                                      static_cast<std::uint16_t>(before)));  // wraps, and so does the viewer
            before = now;
        }
    }
    block.add(part, "int16", steps);
    return scale * 1e3;
}

int tensile_ones(std::span<const Crack> cracks) {
    return static_cast<int>(std::ranges::count(cracks, CrackMode::tensile, &Crack::mode));
}

/// @param squares  in which the result is drawn; null: grain by grain
ReportFields fields_of(const TestResult& whole, std::size_t test, const std::vector<std::size_t>& chosen,
                       const Squares* squares) {
    const TestResult& result = squares != nullptr ? squares->result : whole;
    Block block;
    ReportFields fields;
    add_mesh(block, result.specimen->mesh);
    add_texture(block, fields.meta, result);
    add_cracks(block, result);
    if (squares != nullptr) {
        block.add("crack_square", "int32", squares->square_of_crack);
        fields.meta["squares"] = {{"side", rounded(squares->side_m * 1e3)}, {"grains", rounded(squares->grains_in_one)}};
        fields.meta["crack_every"] = squares->crack_every;
    }
    std::vector<Principal> stresses;
    std::vector<double> all_1, all_3;
    for (const std::size_t n : chosen) {
        stresses.push_back(principal(result.snapshots[n]));
        all_1.insert(all_1.end(), stresses.back().sigma1_MPa.begin(), stresses.back().sigma1_MPa.end());
        all_3.insert(all_3.end(), stresses.back().sigma3_MPa.begin(), stresses.back().sigma3_MPa.end());
    }
    const Limits limits_1 = limits_of(std::move(all_1));
    const Limits limits_3 = limits_of(std::move(all_3));
    const auto levels = [](const std::vector<double>& values, const Limits& limits) {
        std::vector<std::uint8_t> list;
        list.reserve(values.size());
        for (const double value : values) list.push_back(limits.level(value));
        return list;
    };
    Json snapshots = Json::array();
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const Snapshot& snapshot = result.snapshots[chosen[i]];
        const std::string n = std::to_string(i);
        const double scale = add_displacement(block, "u" + n, snapshot.displacement_m);
        std::vector<std::uint8_t> damage;
        for (const float d : snapshot.damage)
            damage.push_back(static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(d, 0.0F, 1.0F))));
        block.add("damage" + n, "uint8", damage);
        block.add("sigma1_" + n, "uint8", levels(stresses[i].sigma1_MPa, limits_1));
        block.add("sigma3_" + n, "uint8", levels(stresses[i].sigma3_MPa, limits_3));
        if (!result.specimen->cells.cells.empty())
            block.add("fragment" + n, "int32", fragments(*result.specimen, result.cracks, snapshot.cracks));
        const int cracks = std::clamp(snapshot.cracks, 0, static_cast<int>(whole.cracks.size()));
        snapshots.push_back({{"label", snapshot.label},
                             {"strain", rounded(snapshot.axial_strain * 1e3)},
                             {"stress", rounded(snapshot.axial_stress_Pa * MPa)},
                             {"cracks", cracks},
                             {"tensile", tensile_ones(std::span(whole.cracks).first(static_cast<std::size_t>(cracks)))},
                             {"scale", scale}});
    }
    fields.meta.update(Json{{"test", test},
                            {"sigma1", {rounded(limits_1.low), rounded(limits_1.high)}},
                            {"sigma3", {rounded(limits_3.low), rounded(limits_3.high)}},
                            {"snapshots", snapshots},
                            {"parts", block.parts()}});
    fields.block = block.packed();
    return fields;
}

/// Fields of another size than the mesh would be drawn wrongly.
bool can_be_drawn(const TestResult& result) {
    if (!result.specimen || result.snapshots.empty()) return false;
    const GrainMesh& mesh = result.specimen->mesh;
    return std::ranges::all_of(result.snapshots, [&](const Snapshot& s) {
        return s.displacement_m.size() == mesh.nodes.size() && s.stress_xx_Pa.size() == mesh.triangles.size() &&
               s.damage.size() == mesh.triangles.size();
    });
}

/// Snapshots to keep: all; or every other one beside those with a name of their own; or first crack, peak and end; or the end
/// alone.
std::array<std::vector<std::size_t>, 4> moments_of(const TestResult& result) {
    std::vector<std::size_t> all, some, few;
    int loads = 0;
    for (std::size_t n = 0; n < result.snapshots.size(); ++n) {
        all.push_back(n);
        const std::string& label = result.snapshots[n].label;
        const bool named = label == "first-crack" || label == "peak" || label == "end";
        if (named) few.push_back(n);
        if (named || (label.starts_with("load") && loads++ % 2 == 1)) some.push_back(n);
    }
    return {all, some, few, {result.snapshots.size() - 1}};
}

// How many triangles browsers turn and colour without a wait, on a machine without a graphics card.
constexpr std::size_t kSmooth = 100'000;
// Squares of a specimen with more: as many triangles as a usual specimen has.
constexpr std::size_t kMostSquares = 16'000, kFewestSquares = 1'000;

/// The fields of a test in no more than `share` characters, of as many moments as there is room for; nothing where there is room
/// for none.
std::optional<ReportFields> fields_within(const TestResult& result, std::size_t test, std::size_t share) {
    const std::size_t triangles = result.specimen->mesh.triangles.size();
    const auto tried = [&](const std::vector<std::size_t>& chosen, const Squares* squares) -> std::optional<ReportFields> {
        if (chosen.empty()) return std::nullopt;
        ReportFields fields = fields_of(result, test, chosen, squares);
        if (fields.block.size() > share) return std::nullopt;
        return fields;
    };
    const auto moments = moments_of(result);
    if (triangles <= kSmooth)
        for (const auto& chosen : moments)
            if (auto fields = tried(chosen, nullptr)) return fields;
    // Squares that hold less than two grains each would only be worse than the grains.
    for (std::size_t count = std::min(kMostSquares, result.specimen->mesh.vertex_count.size() / 2); count >= kFewestSquares;
         count /= 2) {
        const Squares squares = in_squares(result, count);
        for (const auto& chosen : moments)
            if (auto fields = tried(chosen, &squares)) return fields;
    }
    return std::nullopt;
}

/// A test whose fields are to be kept.
struct Candidate {
    std::size_t group = 0, result = 0;
    const char* role = "";  ///< among the packings of its group
    double weight = 1.0;    ///< of what it may take
};

/// The tests that say most: of each variant, kind and pressure the packing of the median strength, the weakest and the strongest.
/// Variants are there to be compared: each has its first packing.
std::vector<Candidate> candidates(std::span<const TestResult> results) {
    using Group = std::tuple<std::string, MethodId, double>;  // variant, kind, sigma_3
    std::vector<std::pair<Group, std::vector<std::size_t>>> groups;
    std::set<std::string> variants;
    for (std::size_t r = 0; r < results.size(); ++r) {
        if (!can_be_drawn(results[r])) continue;
        variants.insert(results[r].variant);
        const Group group(results[r].variant, results[r].test.kind, results[r].test.sigma3_Pa);
        auto found = std::ranges::find(groups, group, &std::pair<Group, std::vector<std::size_t>>::first);
        if (found == groups.end()) found = groups.insert(groups.end(), {group, {}});
        found->second.push_back(r);
    }
    constexpr double of_the_median = 3.0;
    std::vector<Candidate> list;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        std::vector<std::size_t> tests = groups[g].second;
        if (variants.size() > 1 || tests.size() == 1) {
            list.push_back({g, tests.front(), "", of_the_median});
            continue;
        }
        const auto strength = [&](std::size_t r) {
            const double peak = results[r].properties.peak_stress_Pa;
            return std::isfinite(peak) ? peak : 0.0;
        };
        std::ranges::stable_sort(tests, {}, strength);
        const std::size_t middle = (tests.size() - 1) / 2;
        if (tests.size() == 2)
            list.push_back({g, tests[0], "weakest", of_the_median});
        else
            list.push_back({g, tests[middle], "median", of_the_median});
        if (tests.size() > 2) list.push_back({g, tests.front(), "weakest"});
        list.push_back({g, tests.back(), "strongest"});
    }
    return list;
}

}  // namespace

std::string Block::packed() const {
    uLongf size = compressBound(bytes_.size());
    std::vector<std::uint8_t> packed(size);
    if (compress2(packed.data(), &size, bytes_.data(), bytes_.size(), 6) != Z_OK)
        throw OutputError("zlib could not compress the report's fields");
    return base64({packed.data(), size});
}

std::string base64(std::span<const std::uint8_t> bytes) {
    constexpr const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? letters[group >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

std::vector<ReportFields> report_fields(std::span<const TestResult> results, std::size_t budget_B) {
    std::vector<Candidate> tests = candidates(results);
    std::ranges::stable_sort(tests, std::greater<>(), &Candidate::weight);
    double weights = 0.0;
    for (const Candidate& test : tests) weights += test.weight;
    std::vector<std::pair<std::size_t, ReportFields>> list;  // with the group
    for (const Candidate& test : tests) {                    // each passes on what it does not need
        const auto share = static_cast<std::size_t>(static_cast<double>(budget_B) * std::min(1.0, test.weight / weights));
        weights -= test.weight;
        std::optional<ReportFields> fields = fields_within(results[test.result], test.result, share);
        if (!fields) continue;
        budget_B -= fields->block.size();
        fields->meta["role"] = test.role;
        list.emplace_back(test.group, std::move(*fields));
    }
    std::ranges::stable_sort(list, {}, [](const auto& one) { return one.first; });
    std::vector<ReportFields> fields;
    for (auto& [group, one] : list) fields.push_back(std::move(one));
    return fields;
}

}  // namespace feldspar
