#include "feldspar/specimen/weld_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/cell_grid.hpp"
#include "feldspar/geometry/overlap.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/geometry/triangulate.hpp"
#include "feldspar/specimen/cell_graph.hpp"
#include "feldspar/specimen/mesh_grains.hpp"

namespace feldspar {
namespace {

/// What two polygons have in common: area and its first moment.
struct Common {
    double area = 0.0;
    Vec2 moment;
};

/// @param convex  counter-clockwise
Common common_part(const std::vector<Vec2>& polygon, const std::vector<Vec2>& convex) {
    const std::vector<Vec2> part = clipped(polygon, convex);
    const double area = part.size() < 3 ? 0.0 : signed_area(part);
    if (!(area > 0.0)) return {};
    return {area, area * centroid(part)};
}

std::vector<std::vector<Vec2>> convex_parts(const std::vector<Vec2>& corners) {
    if (!is_simple_polygon(corners)) return {};  // bent by what was put into its edges: other cells tell where
    if (is_convex_polygon(corners)) return {corners};
    std::vector<std::vector<Vec2>> parts;
    for (const std::vector<int>& part : convex_partition(corners)) {
        parts.emplace_back();
        for (const int v : part) parts.back().push_back(corners[v]);
    }
    return parts;
}

/// Works in the file's unit.
class Welder {
public:
    Welder(const CellsOfFile& read, double tolerance, const std::filesystem::path& file)
        : read_(read), file_(file.string()), vertices_(read.vertices) {
        check_each();
        mean_ = mean_diameter();
        reach_ = tolerance * mean_;
    }

    GivenCells weld(double unit_m) {
        weld_vertices();
        for (int round = 0; round < 4 && insert_on_edges(); ++round) {
        }
        name_neighbours();
        check_whole();
        check_seen();
        return result(unit_m);
    }

private:
    [[noreturn]] void fail(int cell, const std::string& problem, const std::string& allowed,
                           const std::string& suggestion = {}) const {
        const int line = cell >= 0 ? read_.cells[cell].line : 0;
        throw InputError({file_, line, line > 0 ? 1 : 0, {}}, problem, allowed, suggestion);
    }
    const std::string& name(int cell) const { return read_.cells[cell].name; }
    static std::string place(Vec2 at) { return fmt::format("({:.6g}, {:.6g})", at.x, at.y); }

    std::vector<Vec2> corners(int cell) const {
        std::vector<Vec2> result;
        for (const int v : cells_[cell]) result.push_back(vertices_[v]);
        return result;
    }

    /// Cells by themselves: three corners or more, an area, no crossing; turned counter-clockwise.
    void check_each() {
        for (int c = 0; c < std::ssize(read_.cells); ++c) {
            std::vector<int> around;
            for (const int v : read_.cells[c].corners)
                if (around.empty() || vertices_[static_cast<std::size_t>(around.back())] != vertices_[v]) around.push_back(v);
            while (around.size() > 1 &&
                   vertices_[static_cast<std::size_t>(around.front())] == vertices_[static_cast<std::size_t>(around.back())])
                around.pop_back();
            repeated_ += static_cast<int>(read_.cells[c].corners.size() - around.size());
            if (around.size() < 3)
                fail(c, fmt::format("cell {} has {} different corners", name(c), around.size()), "three or more");
            cells_.push_back(std::move(around));
            std::vector<Vec2> polygon = corners(c);
            const double area = signed_area(polygon);
            const Box box = bounding_box(std::span<const Vec2>(polygon));
            const double size = norm(box.upper - box.lower);
            if (!std::isfinite(size * size))
                fail(c, fmt::format("cell {} is too large to be computed with", name(c)), "lengths that are not beyond reason");
            if (!(std::abs(area) > 1e-9 * size * size))
                fail(c, fmt::format("cell {} has no area: its corners lie on a line", name(c)), "cells with an area");
            if (!is_simple_polygon(polygon))
                fail(c,
                     fmt::format("the boundary of cell {} crosses or touches itself, near {}", name(c), place(centroid(polygon))),
                     "corners in the order around the cell");
            if (area < 0.0) std::reverse(cells_.back().begin(), cells_.back().end());
        }
    }

    double mean_diameter() const {
        double sum = 0.0;
        for (int c = 0; c < std::ssize(cells_); ++c) sum += 2.0 * std::sqrt(signed_area(corners(c)) / std::numbers::pi);
        return sum / static_cast<double>(cells_.size());
    }

    /// Vertices of different cells that are nearer than the tolerance become one, the nearest pair first; the one with the lower
    /// number stays.
    void weld_vertices() {
        const std::size_t n = vertices_.size();
        std::vector<std::vector<int>> cells_at(n);
        for (int c = 0; c < std::ssize(cells_); ++c)
            for (const int v : cells_[c]) cells_at[v].push_back(c);  // ascending
        std::vector<Vec2> used;
        for (std::size_t v = 0; v < n; ++v)
            if (!cells_at[v].empty()) used.push_back(vertices_[v]);
        CellGrid grid(bounding_box(std::span<const Vec2>(used)), std::max(2.0 * reach_, 0.1 * mean_), used.size());
        struct Pair {
            double distance;
            int a, b;
        };
        std::vector<Pair> pairs;
        for (int v = 0; v < static_cast<int>(n); ++v) {
            if (cells_at[v].empty()) continue;
            const Vec2 at = vertices_[v];
            grid.for_each_near(at, reach_, [&](int other) {
                const double distance = norm(vertices_[other] - at);
                if (distance <= reach_) pairs.push_back({distance, other, v});
            });
            grid.insert(v, at);
        }
        std::sort(pairs.begin(), pairs.end(), [](const Pair& l, const Pair& r) {
            return l.distance != r.distance ? l.distance < r.distance : l.a != r.a ? l.a < r.a : l.b < r.b;
        });
        std::vector<int> leader(n);
        std::iota(leader.begin(), leader.end(), 0);
        const auto find = [&](int v) {
            while (leader[v] != v) v = leader[v];
            return v;
        };
        for (const Pair& pair : pairs) {
            const int a = find(pair.a), b = find(pair.b), low = std::min(a, b), high = std::max(a, b);
            if (low == high) continue;
            std::vector<int>& of_low = cells_at[low];
            const std::vector<int>& of_high = cells_at[high];
            std::vector<int> both, all;
            std::set_intersection(of_low.begin(), of_low.end(), of_high.begin(), of_high.end(), std::back_inserter(both));
            if (!both.empty()) continue;
            std::set_union(of_low.begin(), of_low.end(), of_high.begin(), of_high.end(), std::back_inserter(all));
            of_low = std::move(all);
            leader[high] = low;
            ++welded_;
        }
        std::vector<int> number(n, -1);
        int count = 0;
        for (int v = 0; v < static_cast<int>(n); ++v) {
            if (find(v) != v || cells_at[v].empty()) continue;
            vertices_[count] = vertices_[v];
            number[v] = count++;
        }
        for (std::vector<int>& cell : cells_)
            for (int& v : cell) v = number[static_cast<std::size_t>(find(v))];
        vertices_.resize(static_cast<std::size_t>(count));
    }

    /// Edges that have no other side.
    struct Open {
        int cell, corner, from, to;
    };
    std::vector<Open> open_edges() const {
        std::unordered_map<std::uint64_t, int> cell_of;
        for (int c = 0; c < std::ssize(cells_); ++c) {
            const std::vector<int>& cell = cells_[c];
            for (std::size_t k = 0; k < cell.size(); ++k) cell_of.emplace(dart(cell[k], cell[(k + 1) % cell.size()]), c);
        }
        std::vector<Open> open;
        for (int c = 0; c < std::ssize(cells_); ++c) {
            const std::vector<int>& cell = cells_[c];
            for (int k = 0; k < std::ssize(cell); ++k) {
                const int from = cell[k], to = cell[static_cast<std::size_t>(k + 1) % cell.size()];
                if (!cell_of.contains(dart(to, from))) open.push_back({c, k, from, to});
            }
        }
        return open;
    }

    /// Vertices on an edge without another side go into it. @return whether there was one
    bool insert_on_edges() {
        const std::vector<Open> open = open_edges();
        if (open.empty()) return false;
        std::vector<int> ends;
        for (const Open& edge : open) ends.insert(ends.end(), {edge.from, edge.to});
        std::sort(ends.begin(), ends.end());
        ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
        CellGrid grid(bounding_box(std::span<const Vec2>(vertices_)), mean_, ends.size());
        for (const int v : ends) grid.insert(v, vertices_[v]);
        std::map<std::pair<int, int>, std::vector<std::pair<double, int>>>
            additions;  // cell and corner -> share of the edge and vertex
        for (const Open& edge : open) {
            const Vec2 a = vertices_[edge.from], b = vertices_[edge.to], along = b - a;
            const double length2 = dot(along, along);
            const std::vector<int>& cell = cells_[edge.cell];
            const Vec2 margin{reach_, reach_};
            const Box box{Vec2{std::min(a.x, b.x), std::min(a.y, b.y)} - margin,
                          Vec2{std::max(a.x, b.x), std::max(a.y, b.y)} + margin};
            std::vector<std::pair<double, int>> found;
            grid.for_each_in(box, [&](int v) {
                const double share = dot(vertices_[v] - a, along) / length2;
                if (!(share > 0.0 && share < 1.0) || v == edge.from || v == edge.to) return;
                if (std::abs(cross(along, vertices_[v] - a)) > reach_ * std::sqrt(length2)) return;
                if (std::find(cell.begin(), cell.end(), v) == cell.end()) found.push_back({share, v});
            });
            if (!found.empty()) additions[{edge.cell, edge.corner}] = std::move(found);
        }
        // from the last corner of a cell to its first, so that the numbers of the corners before stay
        for (auto it = additions.rbegin(); it != additions.rend(); ++it) {
            auto& [where, found] = *it;
            std::sort(found.begin(), found.end());
            std::vector<int>& cell = cells_[where.first];
            std::vector<int> numbers;
            for (const auto& [share, v] : found)
                if (std::find(cell.begin(), cell.end(), v) == cell.end()) numbers.push_back(v);
            inserted_ += static_cast<int>(numbers.size());
            cell.insert(cell.begin() + where.second + 1, numbers.begin(), numbers.end());
        }
        return !additions.empty();
    }

    void name_neighbours() {
        std::unordered_map<std::uint64_t, int> cell_of;
        for (int c = 0; c < std::ssize(cells_); ++c) {
            const std::vector<int>& cell = cells_[c];
            for (std::size_t k = 0; k < cell.size(); ++k)
                if (!cell_of.emplace(dart(cell[k], cell[(k + 1) % cell.size()]), c).second) explain(c);
        }
        for (const std::vector<int>& cell : cells_) {
            std::vector<int>& around = neighbours_.emplace_back();
            for (std::size_t k = 0; k < cell.size(); ++k) {
                const auto other = cell_of.find(dart(cell[(k + 1) % cell.size()], cell[k]));
                around.push_back(other == cell_of.end() ? -1 : other->second);
            }
        }
    }

    /// The closed lines of edges without another side, each as the cells' corners.
    std::vector<std::vector<int>> boundaries() const {
        std::multimap<int, int> after;
        for (const Open& edge : open_edges()) after.emplace(edge.from, edge.to);
        std::vector<std::vector<int>> lines;
        while (!after.empty()) {
            std::vector<int>& line = lines.emplace_back();
            auto next = after.begin();
            const int first = next->first;
            for (;;) {
                line.push_back(next->first);
                const int to = next->second;
                after.erase(next);
                if (to == first) break;
                next = after.find(to);
                if (next == after.end()) break;
            }
        }
        return lines;
    }

    std::vector<Vec2> points(const std::vector<int>& line) const {
        std::vector<Vec2> result;
        for (const int v : line) result.push_back(vertices_[v]);
        return result;
    }

    void check_whole() {
        std::vector<std::vector<int>> lines = boundaries();
        if (lines.size() != 1 || signed_area(points(lines.front())) <= 0.0) explain(-1);
        std::vector<int> once = lines.front();
        std::sort(once.begin(), once.end());
        if (const auto twice = std::adjacent_find(once.begin(), once.end()); twice != once.end()) pinched_ = *twice, explain(-1);
        std::vector<double> turn(vertices_.size(), 0.0);
        for (int c = 0; c < std::ssize(cells_); ++c) {
            const std::vector<int>& cell = cells_[c];
            const std::size_t n = cell.size();
            for (std::size_t k = 0; k < n; ++k) {
                const Vec2 at = vertices_[cell[k]];
                const Vec2 in = at - vertices_[static_cast<std::size_t>(cell[(k + n - 1) % n])],
                           out = vertices_[static_cast<std::size_t>(cell[(k + 1) % n])] - at;
                turn[cell[k]] += std::numbers::pi - std::atan2(cross(in, out), dot(in, out));
            }
        }
        std::vector<char> outside(vertices_.size(), 0);
        for (const int v : lines.front()) outside[v] = 1;
        for (std::size_t v = 0; v < turn.size(); ++v)
            if (turn[v] > 2.0 * std::numbers::pi + 1e-6 || (outside[v] == 0 && turn[v] < 2.0 * std::numbers::pi - 1e-6))
                explain(-1);
        if (!is_simple_polygon(points(lines.front()))) explain(-1);
        boundary_ = std::move(lines.front());
    }

    /// Says what keeps the cells from being one partition: an overlap, a gap, parts. @param cell  if nothing is found
    [[noreturn]] void explain(int cell) const {
        explain_overlap();
        const std::vector<std::vector<int>> lines = boundaries();
        const double mean_area = 0.25 * std::numbers::pi * mean_ * mean_;
        double largest = 0.0;
        std::optional<std::size_t> gap;
        int gaps = 0, parts = 0;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const double area = lines[i].size() < 3 ? 0.0 : signed_area(points(lines[i]));
            if (area > 0.0) ++parts;
            if (area >= 0.0) continue;
            ++gaps;
            if (-area > largest) {
                largest = -area;
                gap = i;
            }
        }
        if (gap) {
            std::vector<Vec2> around = points(lines[*gap]);
            std::reverse(around.begin(), around.end());
            int beside = -1;
            for (const Open& edge : open_edges())
                if (beside < 0 && edge.from == lines[*gap].front()) beside = edge.cell;
            fail(beside,
                 fmt::format("the cells leave {} of {:.4g} (file's unit squared, {:.3g} mean cells) around {}, beside cell {}",
                             gaps == 1 ? "a gap" : fmt::format("{} gaps, the largest", gaps), largest, largest / mean_area,
                             place(centroid(around)), beside < 0 ? "?" : name(beside)),
                 "cells without gaps: corners of neighbours that agree to the key tolerance, in mean grain diameters; holes are "
                 "cut out by [[specimen.holes]]");
        }
        if (pinched_ >= 0)
            fail(cell, fmt::format("the cells hang together by a point only, at {}", place(vertices_[pinched_])),
                 "cells in one piece");
        if (parts > 1) {
            const Vec2 a = centroid(points(lines.front())), b = centroid(points(lines.back()));
            fail(cell,
                 fmt::format("the cells lie in {} parts that touch in a point at most, one around {} and one around {}", parts,
                             place(a), place(b)),
                 "cells in one piece: corners of neighbours that agree to the key tolerance, in mean grain diameters");
        }
        fail(cell, "the cells do not fit together: their edges are not those of one partition",
             "cells without gaps and overlaps");
    }

    void explain_overlap() const {
        const int n = static_cast<int>(cells_.size());
        std::vector<Box> boxes;
        std::vector<int> order(static_cast<std::size_t>(n));
        std::iota(order.begin(), order.end(), 0);
        for (int c = 0; c < n; ++c) {
            const std::vector<Vec2> polygon = corners(c);
            boxes.push_back(bounding_box(std::span<const Vec2>(polygon)));
        }
        std::sort(order.begin(), order.end(), [&](int l, int r) {
            return boxes[l].lower.x != boxes[r].lower.x ? boxes[l].lower.x < boxes[r].lower.x : l < r;
        });
        Common worst;
        int first = -1, second = -1, pairs = 0;
        for (int i = 0; i < n; ++i) {
            const int a = order[i];
            const Box& box = boxes[a];
            for (int j = i + 1; j < n; ++j) {
                const int b = order[j];
                const Box& other = boxes[b];
                if (other.lower.x > box.upper.x) break;
                if (other.lower.y > box.upper.y || box.lower.y > other.upper.y) continue;
                Common common;
                for (const std::vector<Vec2>& of_a : convex_parts(corners(a)))
                    for (const std::vector<Vec2>& of_b : convex_parts(corners(b))) {
                        const Common part = common_part(of_a, of_b);
                        common.area += part.area;
                        common.moment += part.moment;
                    }
                if (common.area <= 1e-2 * reach_ * mean_) continue;  // slivers along borders that nearly agree
                ++pairs;
                if (common.area <= worst.area) continue;
                worst = common;
                first = std::min(a, b);
                second = std::max(a, b);
            }
        }
        if (pairs == 0) return;
        fail(second,
             fmt::format("cells {} and {} overlap by {:.4g} (file's unit squared, {:.3g} mean cells) around {}{}", name(first),
                         name(second), worst.area, worst.area / (0.25 * std::numbers::pi * mean_ * mean_),
                         place((1.0 / worst.area) * worst.moment),
                         pairs > 1 ? fmt::format(", and {} more pairs of cells do", pairs - 1) : ""),
             "cells side by side: corners of neighbours that agree to the key tolerance, in mean grain diameters");
    }

    /// Each cell can be meshed: a point sees all its corners.
    void check_seen() {
        for (int c = 0; c < std::ssize(cells_); ++c) {
            const std::vector<Vec2> polygon = corners(c);
            if (signed_area(polygon) <= 0.0)
                fail(c, fmt::format("cell {} has no area left where its corners were welded to those of neighbours", name(c)),
                     "a smaller tolerance, or cells that are wider than it");
            if (!is_simple_polygon(polygon))
                fail(c,
                     fmt::format(
                         "the boundary of cell {} crosses itself where its corners were welded to those of neighbours, near {}",
                         name(c), place(centroid(polygon))),
                     "a smaller tolerance, or cells that are wider than it");
            if (is_convex_polygon(polygon)) continue;
            std::size_t worst = 0;
            double sharpest = 0.0;
            const std::size_t n = polygon.size();
            for (std::size_t k = 0; k < n; ++k) {
                const Vec2 in = polygon[k] - polygon[(k + n - 1) % n], out = polygon[(k + 1) % n] - polygon[k];
                const double angle = std::atan2(cross(in, out), dot(in, out));
                if (angle < sharpest) sharpest = angle, worst = k;
            }
            if (sharpest < -1e-3) ++concave_;  // else it is straight there, to the digits of a file
            if (!centre_of_grain(polygon))
                fail(c,
                     fmt::format(
                         "cell {} bends so much that no point of it sees all its corners; it turns in by {:.0f} degrees at {}",
                         name(c), -sharpest * 180.0 / std::numbers::pi, place(polygon[worst])),
                     "convex cells, or cells that can be meshed by triangles from one middle point", "divide the cell there");
        }
    }

    GivenCells result(double unit_m) {
        GivenCells given;
        given.vertices = std::move(vertices_);
        if (unit_m != 1.0)
            for (Vec2& v : given.vertices) v *= unit_m;
        given.cells = std::move(cells_);
        given.neighbours = std::move(neighbours_);
        for (const CellsOfFile::Cell& cell : read_.cells) given.names.push_back(cell.name);
        given.boundary = std::move(boundary_);
        given.smallest_diameter_m = std::numeric_limits<double>::infinity();
        for (const std::vector<int>& cell : given.cells) {
            std::vector<Vec2> polygon;
            for (const int v : cell) polygon.push_back(given.vertices[v]);
            const double diameter = 2.0 * std::sqrt(signed_area(polygon) / std::numbers::pi);
            given.mean_diameter_m += diameter / static_cast<double>(given.cells.size());
            given.largest_diameter_m = std::max(given.largest_diameter_m, diameter);
            given.smallest_diameter_m = std::min(given.smallest_diameter_m, diameter);
        }
        given.welded = welded_;
        given.inserted = inserted_;
        given.concave = concave_;
        given.remarks = read_.remarks;
        if (repeated_ > 0)
            given.remarks.push_back(fmt::format("corners that repeat the one before were left out: {}", repeated_));
        return given;
    }

    const CellsOfFile& read_;
    std::string file_;
    std::vector<Vec2> vertices_;
    std::vector<std::vector<int>> cells_, neighbours_;
    std::vector<int> boundary_;
    double mean_ = 0.0, reach_ = 0.0;
    int repeated_ = 0, welded_ = 0, inserted_ = 0, concave_ = 0, pinched_ = -1;
};

}  // namespace

GivenCells weld_cells(const CellsOfFile& read, double unit_m, double tolerance, const std::filesystem::path& file) {
    if (read.cells.empty()) throw InputError({file.string(), 0, 0, {}}, "has no cells", "one cell or more");
    return Welder(read, tolerance, file).weld(unit_m);
}

}  // namespace feldspar
