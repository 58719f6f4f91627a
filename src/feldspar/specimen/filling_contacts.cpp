#include "feldspar/specimen/filling_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "feldspar/geometry/triangulate.hpp"

namespace feldspar {
namespace {

/// The least share of an edge that a contact may have.
constexpr double smallest_share = 1e-3;

/// The contacts of one grain, and the part of it that is known to be rigid. Each contact is a pin: three discs in a ring of
/// three contacts are rigid; so is a rigid part with one more disc that has two contacts with it, or with two more discs that
/// touch each other and have one contact each with it.
class RigidPart {
public:
    RigidPart(std::span<const Vec2> centres, std::span<const double> radii_m, std::span<const InsideContact> pairs)
        : centres_(centres),
          radii_(radii_m),
          count_(static_cast<int>(centres.size())),
          touching_(centres.size() * centres.size(), 0),
          rigid_(centres.size(), 0) {
        for (const InsideContact& pair : pairs) touch(pair.a, pair.b);
    }
    void make_whole();
    std::vector<InsideContact> contacts() const;

private:
    double gap(int i, int j) const { return norm(centres_[j] - centres_[i]) - radii_[i] - radii_[j]; }
    std::size_t pair(int i, int j) const { return static_cast<std::size_t>(i) * centres_.size() + static_cast<std::size_t>(j); }
    bool touches(int i, int j) const { return touching_[pair(i, j)] != 0; }
    void touch(int i, int j) { touching_[pair(i, j)] = touching_[pair(j, i)] = 1; }
    int holds_on(int i) const;
    void start();
    bool grow();
    void add_nearest();

    std::span<const Vec2> centres_;
    std::span<const double> radii_;
    int count_;
    std::vector<char> touching_, rigid_;
};

/// Number of contacts of disc i with the rigid part.
int RigidPart::holds_on(int i) const {
    int count = 0;
    for (int j = 0; j < count_; ++j) count += rigid_[j] && touches(i, j) ? 1 : 0;
    return count;
}

/// The three discs that are nearest to each other; their missing contacts, if any, are added.
void RigidPart::start() {
    double least = std::numeric_limits<double>::infinity();
    int a = 0, b = 1, c = 2;
    for (int i = 0; i < count_; ++i) {
        for (int j = i + 1; j < count_; ++j) {
            if (gap(i, j) >= least) continue;
            for (int k = j + 1; k < count_; ++k) {
                const double longest = std::max({gap(i, j), gap(j, k), gap(k, i)});
                if (longest >= least) continue;
                least = longest;
                a = i, b = j, c = k;
            }
        }
    }
    for (const int i : {a, b, c}) rigid_[i] = 1;
    touch(a, b), touch(b, c), touch(c, a);
}

/// Takes in all discs that are held; false if there was none.
bool RigidPart::grow() {
    bool grew = false;
    std::vector<int> holds(centres_.size());
    for (int i = 0; i < count_; ++i) {
        if (rigid_[i]) continue;
        holds[i] = holds_on(i);
        if (holds[i] < 2) continue;
        rigid_[i] = 1;
        grew = true;
    }
    if (grew) return true;
    for (int i = 0; i < count_; ++i) {
        for (int j = i + 1; j < count_; ++j) {
            if (rigid_[i] || rigid_[j] || holds[i] == 0 || holds[j] == 0 || !touches(i, j)) continue;
            rigid_[i] = rigid_[j] = 1;
            return true;
        }
    }
    return false;
}

/// Adds the shortest missing contact between the rigid part and the rest.
void RigidPart::add_nearest() {
    double least = std::numeric_limits<double>::infinity();
    int a = -1, b = -1;
    for (int i = 0; i < count_; ++i) {
        for (int j = 0; j < count_; ++j) {
            if (!rigid_[i] || rigid_[j] || touches(i, j) || gap(i, j) >= least) continue;
            least = gap(i, j);
            a = i, b = j;
        }
    }
    touch(a, b);
}

void RigidPart::make_whole() {
    start();
    while (std::count(rigid_.begin(), rigid_.end(), 0) > 0) {
        if (!grow()) add_nearest();
    }
}

std::vector<InsideContact> RigidPart::contacts() const {
    std::vector<InsideContact> result;
    for (int i = 0; i < count_; ++i) {
        for (int j = i + 1; j < count_; ++j) {
            if (touches(i, j)) result.push_back({i, j});
        }
    }
    return result;
}

/// Pairs of discs whose Laguerre cells share an edge and whose gap is at most `largest_gap`.
std::vector<InsideContact> near_neighbours(std::span<const Vec2> centres, std::span<const double> radii_m, double largest_gap) {
    std::vector<double> weights;
    for (const double R : radii_m) weights.push_back(R * R);
    std::vector<InsideContact> pairs;
    for (const std::array<int, 3>& t : regular_triangulation(centres, weights).triangles) {
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            if (norm(centres[b] - centres[a]) - radii_m[a] - radii_m[b] <= largest_gap) pairs.push_back({a, b});
        }
    }
    return pairs;
}

/// An edge as a line on which places are measured from its first vertex.
struct EdgeLine {
    Vec2 start, end, along;
    double length = 0.0;

    EdgeLine(Vec2 from, Vec2 to) : start(from), end(to), length(norm(to - from)) { along = (1.0 / length) * (to - from); }
    double place_of(Vec2 p) const { return dot(p - start, along); }
    double height_of(Vec2 p) const { return cross(along, p - start); }
    /// (S10): where the line from a to b crosses the edge's line; a and b lie on its two sides.
    double crossing(Vec2 a, Vec2 b) const {
        const double above = height_of(a), below = -height_of(b);
        return (place_of(a) * below + place_of(b) * above) / (above + below);
    }
};

/// (S11): bounds of the shares of successive places: the edge's two ends and, between, the midpoints, none nearer than the
/// smallest share. Neighbouring shares get the same point, so no part of the edge is left out or counted twice.
std::vector<Vec2> share_bounds(const EdgeLine& edge, std::vector<double> places) {
    const int count = static_cast<int>(places.size());
    const double least = edge.length * std::min(smallest_share, 0.1 / count);
    for (double& p : places) p = std::clamp(p, 0.0, edge.length);
    std::vector<double> bounds = {0.0};
    for (int i = 1; i < count; ++i) bounds.push_back(std::max(0.5 * (places[i - 1] + places[i]), bounds.back() + least));
    bounds.push_back(edge.length);
    for (int i = count - 1; i > 0; --i) bounds[i] = std::min(bounds[i], bounds[i + 1] - least);
    std::vector<Vec2> points = {edge.start};
    for (int i = 1; i < count; ++i) points.push_back(edge.start + bounds[i] * edge.along);
    points.push_back(edge.end);
    return points;
}

/// Pairs of two facing rows, in the edge's direction: the rows' first discs, then one step along the row that gives the shorter
/// pair, to the rows' last discs.
std::vector<std::pair<int, int>> strip(const std::vector<Vec2>& centres, const std::vector<int>& a, const std::vector<int>& b) {
    std::vector<std::pair<int, int>> pairs = {{a.front(), b.front()}};
    std::size_t i = 0, j = 0;
    while (i + 1 < a.size() || j + 1 < b.size()) {
        const double by_a = i + 1 < a.size() ? norm(centres[a[i + 1]] - centres[b[j]]) : std::numeric_limits<double>::infinity();
        const double by_b = j + 1 < b.size() ? norm(centres[a[i]] - centres[b[j + 1]]) : std::numeric_limits<double>::infinity();
        if (by_a < by_b) {
            ++i;
        } else {
            ++j;
        }
        pairs.emplace_back(a[i], b[j]);
    }
    return pairs;
}

/// The neighbour's number of the edge from vertex `to` to vertex `from`.
int facing_edge(const Cell& neighbour, int from, int to) {
    const int n = static_cast<int>(neighbour.vertices.size());
    int k = 0;
    while (neighbour.vertices[k] != to || neighbour.vertices[(k + 1) % n] != from) ++k;
    return k;
}

}  // namespace

std::vector<InsideContact> contacts_inside(std::span<const Vec2> centres, std::span<const double> radii_m, double diameter_m) {
    RigidPart part(centres, radii_m, near_neighbours(centres, radii_m, contact_gap * diameter_m));
    part.make_whole();
    return part.contacts();
}

void join_grains(const Tessellation& cells, const std::vector<std::vector<std::vector<int>>>& rows, Filling& filling) {
    for (int g = 0; g < std::ssize(cells.cells); ++g) {
        const Cell& cell = cells.cells[g];
        for (int k = 0; k < std::ssize(cell.vertices); ++k) {
            const int from = cell.vertices[k], to = cell.vertices[(k + 1) % cell.vertices.size()], other = cell.neighbours[k];
            if (other >= 0 && other < g) continue;
            const EdgeLine edge(cells.vertices[from], cells.vertices[to]);
            const std::vector<int>& row = rows[g][k];
            std::vector<double> places;
            if (other < 0) {
                for (const int p : row) places.push_back(edge.place_of(filling.centres[p]));
                const std::vector<Vec2> bounds = share_bounds(edge, places);
                for (std::size_t i = 0; i < row.size(); ++i) filling.outline.push_back({row[i], g, k, bounds[i], bounds[i + 1]});
                continue;
            }
            const int facing = facing_edge(cells.cells[other], from, to);
            const std::vector<int> facing_row(rows[other][facing].rbegin(), rows[other][facing].rend());
            const auto pairs = strip(filling.centres, row, facing_row);
            for (const auto& [a, b] : pairs) places.push_back(edge.crossing(filling.centres[a], filling.centres[b]));
            const std::vector<Vec2> bounds = share_bounds(edge, places);
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                filling.across.push_back({pairs[i].first, pairs[i].second, g, k, other, facing, bounds[i], bounds[i + 1]});
            }
        }
    }
}

}  // namespace feldspar
