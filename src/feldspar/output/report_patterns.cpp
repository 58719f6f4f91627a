// Failure patterns side by side: of each packing the grains once, and of every test on it the cracks.
//
// Parts of a block (report_block.hpp), all coordinates in steps of `scale` from (x0, y0), in mm and undeformed:
//   begin     int32   outlines + 1
//   points    uint16  x, y of the outline of each grain; of many grains each edge on the border of the specimen instead
// and for each test k on the packing, of many cracks every "crack_every"-th:
//   ends<k>   uint16  x, y of both ends of each crack, in the order in which they broke
//   mode<k>   uint8   0 tensile, 1 shear
#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/output/report_block.hpp"
#include "feldspar/output/report_data.hpp"
#include "feldspar/output/squares.hpp"

namespace feldspar {

namespace {

using Json = nlohmann::ordered_json;

/// Coordinates as 16-bit steps across the specimen.
struct Steps {
    Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    double scale = 1.0;  // m a step

    explicit Steps(const std::vector<Vec2>& nodes) {
        Vec2 high{-low.x, -low.y};
        for (const Vec2 node : nodes) {
            low = {std::min(low.x, node.x), std::min(low.y, node.y)};
            high = {std::max(high.x, node.x), std::max(high.y, node.y)};
        }
        if (!nodes.empty()) scale = std::max({high.x - low.x, high.y - low.y, 1e-12}) / 65535.0;
    }
    void add(std::vector<std::uint16_t>& list, Vec2 place) const {
        for (const double steps : {(place.x - low.x) / scale, (place.y - low.y) / scale})
            list.push_back(static_cast<std::uint16_t>(std::lround(std::clamp(steps, 0.0, 65535.0))));
    }
};

// Finer grains than these are finer than the lines of such a picture.
constexpr std::size_t kMostOutlines = 20'000;

void add_outlines(Block& block, const Specimen& specimen, const Steps& steps) {
    const GrainMesh& mesh = specimen.mesh;
    std::vector<int> begin{0};
    std::vector<std::uint16_t> points;
    const auto end_outline = [&] { begin.push_back(static_cast<int>(points.size() / 2)); };
    if (mesh.vertex_count.size() > kMostOutlines) {
        for (const Cell& cell : specimen.cells.cells)
            for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
                if (cell.neighbours[k] >= 0) continue;
                for (const std::size_t end : {k, (k + 1) % cell.vertices.size()})
                    steps.add(points, specimen.cells.vertices[static_cast<std::size_t>(cell.vertices[end])]);
                end_outline();
            }
    } else {
        for (std::size_t g = 0; g < mesh.vertex_count.size(); ++g) {
            for (int k = 0; k < mesh.vertex_count[g]; ++k)
                steps.add(points, mesh.nodes[static_cast<std::size_t>(mesh.node_begin[g] + k)]);
            end_outline();
        }
    }
    block.add("begin", "int32", begin);
    block.add("points", "uint16", points);
}

/// @return how many cracks each that is drawn stands for
std::size_t add_cracks(Block& block, const std::string& number, const TestResult& result, const Steps& steps) {
    const std::size_t every = cracks_for_one(result.cracks.size());
    std::vector<std::uint16_t> ends;
    std::vector<std::uint8_t> mode;
    for (std::size_t c = 0; c < result.cracks.size(); c += every) {
        const Crack& crack = result.cracks[c];
        steps.add(ends, crack.from);
        steps.add(ends, crack.to);
        mode.push_back(static_cast<std::uint8_t>(crack.mode));
    }
    block.add("ends" + number, "uint16", ends);
    block.add("mode" + number, "uint8", mode);
    return every;
}

int cracks_at_peak(const TestResult& result) {
    if (result.history.empty()) return 0;
    const HistoryRow& row = result.history[strength_row(result)];
    return row.cracks_tensile + row.cracks_shear;
}

}  // namespace

std::vector<ReportFields> report_patterns(std::span<const TestResult> results) {
    std::vector<ReportFields> list;
    std::vector<const Specimen*> seen;
    for (const TestResult& first : results) {
        const Specimen* specimen = first.specimen.get();
        if (specimen == nullptr || std::ranges::find(seen, specimen) != seen.end()) continue;
        seen.push_back(specimen);
        const Steps steps(specimen->mesh.nodes);
        Block block;
        add_outlines(block, *specimen, steps);
        Json tests = Json::array();
        for (std::size_t r = 0; r < results.size(); ++r) {
            if (results[r].specimen.get() != specimen) continue;
            const std::size_t every = add_cracks(block, std::to_string(tests.size()), results[r], steps);
            tests.push_back({{"test", r}, {"at_peak", cracks_at_peak(results[r])}, {"crack_every", every}});
        }
        ReportFields pattern;
        pattern.meta = {{"x0", rounded(steps.low.x * 1e3)},
                        {"y0", rounded(steps.low.y * 1e3)},
                        {"scale", rounded(steps.scale * 1e3)},
                        {"tests", tests},
                        {"parts", block.parts()}};
        pattern.block = block.packed();
        list.push_back(std::move(pattern));
    }
    return list;
}

}  // namespace feldspar
