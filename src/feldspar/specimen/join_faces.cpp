#include "feldspar/specimen/join_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "feldspar/base/error.hpp"

namespace feldspar {
namespace {

class FaceJoiner {
public:
    /// @param crossings  vertices where cuts meet, which stay where they are
    FaceJoiner(Tessellation& cells, const Cutout& cut, double snap_m, const std::set<int>& crossings)
        : cells_(cells),
          cut_(cut),
          snap_(snap_m),
          crossings_(crossings),
          along_((1.0 / norm(cut.vertices[1] - cut.vertices[0])) * (cut.vertices[1] - cut.vertices[0])) {}

    void run() {
        share_vertices();
        put_missing_vertices();
        name_neighbours();
    }

private:
    double place(int vertex) const { return dot(cells_.vertices[vertex] - cut_.vertices[0], along_); }

    // Visits the edges on a face: 0 left, 1 right.
    template <class Visit>
    void for_each_edge(int face, Visit visit) {
        for (int c = 0; c < std::ssize(cells_.cells); ++c)
            for (int k = 0; k < std::ssize(cells_.cells[c].vertices); ++k)
                if (cells_.cells[c].outline_edges[k] == cut_.first_edge + face) visit(c, k);
    }

    int vertex(int c, int k) const { return cells_.cells[c].vertices[k % cells_.cells[c].vertices.size()]; }

    std::map<double, int> vertices_of(int face) {
        std::map<double, int> found;
        for_each_edge(face, [&](int c, int k) {
            for (const int v : {vertex(c, k), vertex(c, k + 1)}) found.emplace(place(v), v);
        });
        return found;
    }

    // Of two vertices that lie at the same place the right one goes, unless cuts meet there.
    void share_vertices() {
        const std::map<double, int> left = vertices_of(0), right = vertices_of(1);
        std::map<int, int> instead;
        for (const auto& [s, v] : right) {
            int nearest = -1;
            double distance = snap_;
            for (auto it = left.lower_bound(s - snap_); it != left.end() && it->first <= s + snap_; ++it)
                if (std::abs(it->first - s) < distance) {
                    distance = std::abs(it->first - s);
                    nearest = it->second;
                }
            if (nearest < 0 || nearest == v) continue;
            if (crossings_.contains(v))
                instead[nearest] = v;
            else
                instead.emplace(v, nearest);
        }
        for (auto& [v, other] : instead)
            if (const auto further = instead.find(other); further != instead.end()) other = further->second;
        for (Cell& cell : cells_.cells)
            for (int& v : cell.vertices)
                if (const auto found = instead.find(v); found != instead.end()) v = found->second;
        // An edge both ends of which have become one is none.
        for (Cell& cell : cells_.cells)
            for (std::size_t k = 0; k < cell.vertices.size();)
                if (cell.vertices.size() > 3 && cell.vertices[k] == cell.vertices[(k + 1) % cell.vertices.size()])
                    erase(cell, k);
                else
                    ++k;
    }

    static void erase(Cell& cell, std::size_t k) {
        const auto at = static_cast<std::ptrdiff_t>(k);
        cell.vertices.erase(cell.vertices.begin() + at);
        cell.neighbours.erase(cell.neighbours.begin() + at);
        cell.outline_edges.erase(cell.outline_edges.begin() + at);
    }

    void put_missing_vertices() {
        for (const int face : {0, 1}) {
            const std::map<double, int> other = vertices_of(1 - face);
            for (int c = 0; c < std::ssize(cells_.cells); ++c)
                for (int k = 0; k < std::ssize(cells_.cells[c].vertices); ++k) {
                    Cell& cell = cells_.cells[c];
                    if (cell.outline_edges[k] != cut_.first_edge + face) continue;
                    const int a = vertex(c, k), b = vertex(c, k + 1);
                    const double from = std::min(place(a), place(b)), to = std::max(place(a), place(b));
                    // the missing vertex that comes first on the way from a
                    int missing = -1;
                    for (const auto& [s, v] : other)
                        if (v != a && v != b && s > from && s < to &&
                            (missing < 0 || std::abs(s - place(a)) < std::abs(place(missing) - place(a))))
                            missing = v;
                    if (missing < 0) continue;
                    const auto at = k + 1;
                    cell.vertices.insert(cell.vertices.begin() + at, missing);
                    cell.neighbours.insert(cell.neighbours.begin() + at, cell.neighbours[k]);
                    cell.outline_edges.insert(cell.outline_edges.begin() + at, cell.outline_edges[k]);
                }
        }
    }

    void name_neighbours() {
        std::map<std::pair<int, int>, std::pair<int, int>> right;  // by its directed vertices
        for_each_edge(1, [&](int c, int k) { right[{vertex(c, k), vertex(c, k + 1)}] = {c, k}; });
        std::vector<std::array<int, 4>> pairs;
        for_each_edge(0, [&](int c, int k) {
            const auto found = right.find({vertex(c, k + 1), vertex(c, k)});
            if (found != right.end()) pairs.push_back({c, k, found->second.first, found->second.second});
        });
        if (pairs.empty()) throw NumericalError(cut_.name + " has no faces in contact");
        for (const auto& [c, k, d, j] : pairs) {
            for (const auto& [cell, edge, neighbour] : {std::array{c, k, d}, std::array{d, j, c}}) {
                cells_.cells[cell].neighbours[edge] = neighbour;
                cells_.cells[cell].outline_edges[edge] = -1;
            }
            seams_.push_back({c, k});
            seams_.push_back({d, j});
        }
    }

public:
    const std::vector<std::pair<int, int>>& seams() const { return seams_; }

private:
    Tessellation& cells_;
    const Cutout& cut_;
    double snap_;
    const std::set<int>& crossings_;
    Vec2 along_;
    std::vector<std::pair<int, int>> seams_;  // cell and edge
};

}  // namespace

namespace {

// Where cuts meet each has made vertices of its own: they become one. @return these, one a place
std::set<int> share_crossings(Tessellation& cells, const Outline& outline, double snap_m) {
    std::map<int, std::set<int>> cuts_at;  // of vertices on joined cuts: which
    for (const Cell& cell : cells.cells)
        for (std::size_t k = 0; k < cell.vertices.size(); ++k)
            for (int n = 0; n < std::ssize(outline.cutouts); ++n) {
                const Cutout& cut = outline.cutouts[n];
                if (!cut.joined || cell.outline_edges[k] < cut.first_edge || cell.outline_edges[k] > cut.first_edge + 1) continue;
                cuts_at[cell.vertices[k]].insert(n);
                cuts_at[cell.vertices[(k + 1) % cell.vertices.size()]].insert(n);
            }
    std::vector<std::pair<int, std::set<int>>> several;  // a place by its first vertex
    std::map<int, int> instead;
    for (const auto& [v, cuts] : cuts_at)
        if (cuts.size() > 1) {
            const auto known = std::find_if(several.begin(), several.end(), [&, place = cells.vertices[v]](const auto& one) {
                return norm(cells.vertices[one.first] - place) < 1e-6 * snap_m;
            });
            if (known == several.end()) several.push_back({v, cuts});
        }
    for (const auto& [v, cuts] : cuts_at)
        for (const auto& [first, all] : several)
            if (v != first && norm(cells.vertices[first] - cells.vertices[v]) < 1e-6 * snap_m) instead[v] = first;
    for (Cell& cell : cells.cells)
        for (int& v : cell.vertices)
            if (const auto found = instead.find(v); found != instead.end()) v = found->second;
    std::set<int> crossings;
    for (const auto& [first, all] : several) crossings.insert(first);
    return crossings;
}

}  // namespace

int join_faces(Tessellation& cells, const Outline& outline, double snap_m) {
    std::set<int> crossings;
    if (std::count_if(outline.cutouts.begin(), outline.cutouts.end(), [](const Cutout& cut) { return cut.joined; }) > 1)
        crossings = share_crossings(cells, outline, snap_m);
    std::map<std::pair<int, int>, int>
        seam_of_pair;  // of two cells; those of one joint may meet on several edges, of which all lie on it or none
    for (int n = 0; n < std::ssize(outline.cutouts); ++n) {
        if (!outline.cutouts[n].joined) continue;
        FaceJoiner joiner(cells, outline.cutouts[n], snap_m, crossings);
        joiner.run();
        for (const auto& [c, k] : joiner.seams())
            seam_of_pair[{std::min(c, cells.cells[c].neighbours[k]), std::max(c, cells.cells[c].neighbours[k])}] = n;
    }
    if (seam_of_pair.empty()) return 0;
    for (int c = 0; c < std::ssize(cells.cells); ++c) {
        Cell& cell = cells.cells[c];
        cell.seams.assign(cell.vertices.size(), -1);
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            if (cell.neighbours[k] < 0) continue;
            const auto found = seam_of_pair.find({std::min(c, cell.neighbours[k]), std::max(c, cell.neighbours[k])});
            if (found != seam_of_pair.end()) cell.seams[k] = found->second;
        }
    }
    // vertices that nobody names any more
    std::vector<int> number(cells.vertices.size(), -1);
    for (const Cell& cell : cells.cells)
        for (const int v : cell.vertices) number[v] = 0;
    int next = 0;
    std::vector<Vec2> kept;
    for (std::size_t v = 0; v < number.size(); ++v)
        if (number[v] == 0) {
            number[v] = next++;
            kept.push_back(cells.vertices[v]);
        }
    cells.vertices = std::move(kept);
    for (Cell& cell : cells.cells)
        for (int& v : cell.vertices) v = number[v];
    return static_cast<int>(crossings.size());
}

}  // namespace feldspar
