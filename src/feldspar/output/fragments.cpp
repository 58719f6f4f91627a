#include "feldspar/output/fragments.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace feldspar {

namespace {

constexpr double whole_share = 0.1;  ///< of an edge that holds two grains together

std::pair<int, int> both(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// A forest of grains that hang together.
class Pieces {
public:
    explicit Pieces(std::size_t grains) : above_(grains) { std::iota(above_.begin(), above_.end(), 0); }
    int root(int grain) {
        while (above_[static_cast<std::size_t>(grain)] != grain)
            grain = above_[static_cast<std::size_t>(grain)] =
                above_[static_cast<std::size_t>(above_[static_cast<std::size_t>(grain)])];
        return grain;
    }
    void join(int a, int b) { above_[static_cast<std::size_t>(root(a))] = root(b); }

private:
    std::vector<int> above_;
};

}  // namespace

std::vector<int> fragments(const Specimen& specimen, const std::vector<Crack>& cracks, int count) {
    const std::vector<Cell>& cells = specimen.cells.cells;
    const std::vector<Vec2>& corners = specimen.cells.vertices;
    std::map<std::pair<int, int>, double> whole;  // length of the edges between two grains that holds
    std::vector<double> area;
    for (std::size_t g = 0; g < cells.size(); ++g) {
        const std::vector<int>& vertices = cells[g].vertices;
        double twice = 0.0;
        for (std::size_t k = 0; k < vertices.size(); ++k) {
            const Vec2 from = corners[static_cast<std::size_t>(vertices[k])],
                       to = corners[static_cast<std::size_t>(vertices[(k + 1) % vertices.size()])];
            twice += from.x * to.y - to.x * from.y;
            const int other = cells[g].neighbours[k];
            if (other > static_cast<int>(g)) whole[both(static_cast<int>(g), other)] += norm(to - from);
        }
        area.push_back(0.5 * std::abs(twice));
    }
    std::map<std::pair<int, int>, double> left = whole;
    for (int c = 0; c < std::min(count, static_cast<int>(cracks.size())); ++c) {
        const Crack& crack = cracks[static_cast<std::size_t>(c)];
        if (const auto found = left.find(both(crack.grain_a, crack.grain_b)); found != left.end())
            found->second -= norm(crack.to - crack.from);
    }
    Pieces pieces(cells.size());
    for (const auto& [pair, length] : left)
        if (length >= whole_share * whole.at(pair)) pieces.join(pair.first, pair.second);
    std::map<int, double> area_of;  // a piece by its root
    for (std::size_t g = 0; g < cells.size(); ++g) area_of[pieces.root(static_cast<int>(g))] += area[g];
    std::vector<std::pair<double, int>> by_area;
    for (const auto& [root, sum] : area_of) by_area.emplace_back(-sum, root);
    std::ranges::sort(by_area);
    std::map<int, int> number;
    for (std::size_t n = 0; n < by_area.size(); ++n) number[by_area[n].second] = static_cast<int>(n);
    std::vector<int> list;
    for (std::size_t g = 0; g < cells.size(); ++g) list.push_back(number.at(pieces.root(static_cast<int>(g))));
    return list;
}

}  // namespace feldspar
