#include "feldspar/specimen/cut_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/join_pieces.hpp"

namespace feldspar {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Nearer than this share of a mean grain two points are one.
constexpr double no_length = 1e-9;
/// How far the centroid must lie to the left of every edge / root of the area: a cell beside a notch or hole that falls short is
/// divided, and no piece is taken in by a cell that would. Regular cells have 0.4 to 0.5.
constexpr double sound_margin = 0.1;
/// New cells are labelled by whom they border on at the end only.
constexpr int some_neighbour = 0;

/// What a new edge along a cutout borders on, by the side from which it is seen.
struct Sides {
    int left = 0, right = 0;  ///< outline edges
};

/// A part of a cutout's edge between two vertices of the graph.
struct Part {
    int from = 0, to = 0;
    Sides sides;
};

/// A directed edge while a cell is being taken apart.
struct Dart {
    int from, to, label;
    bool inside;  ///< of the cutout: what lies to its left goes
};

Box box_of(const std::vector<Vec2>& points) { return bounding_box(std::span<const Vec2>(points)); }
bool overlap(const Box& a, const Box& b) {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y;
}
Box widened(Box box, double by) { return {box.lower - Vec2{by, by}, box.upper + Vec2{by, by}}; }

/// The least distance (m) of the centroid from the lines of the edges, over the root of the area; negative where it lies behind
/// one.
double margin_of(const std::vector<Vec2>& corners) {
    const double area = signed_area(corners);
    if (area <= 0.0) return -infinity;
    const Vec2 middle = centroid(corners);
    double least = infinity;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec2 a = corners[k], b = corners[(k + 1) % corners.size()];
        least = std::min(least, cross(a - middle, b - middle) / norm(b - a));
    }
    return least / std::sqrt(area);
}

double thickness_of(const std::vector<Vec2>& corners) {
    double perimeter = 0.0;
    for (std::size_t k = 0; k < corners.size(); ++k) perimeter += norm(corners[(k + 1) % corners.size()] - corners[k]);
    return 4.0 * signed_area(corners) / perimeter;
}

class CellCutter {
public:
    CellCutter(CellGraph& graph, const Outline& outline, double mean_diameter, double merge_length)
        : graph_(graph),
          outline_(outline),
          mean_diameter_(mean_diameter),
          snap_(std::max(merge_length, 1e-3 * mean_diameter)),
          eps_(no_length * mean_diameter),
          old_vertices_(static_cast<int>(graph.vertices.size())) {
        faces_at_.resize(graph.vertices.size());
        for (int f = 0; f < std::ssize(graph_.faces); ++f) {
            boxes_.push_back(box_of(corners(f)));
            enter(f);
        }
        touched_.assign(graph_.faces.size(), 0);
        reshaped_.assign(graph_.faces.size(), 0);
    }

    CutCells run() {
        const double mean_area = mean_cell_area();
        std::vector<char> done(outline_.cutouts.size(), 0);  // a cut that ends on another comes after it
        for (std::size_t left = done.size(); left > 0;)
            for (std::size_t n = 0; n < done.size(); ++n) {
                const Cutout& cutout = outline_.cutouts[n];
                if (done[n] || std::any_of(cutout.ends_on.begin(), cutout.ends_on.end(),
                                           [&](int other) { return other >= 0 && !done[static_cast<std::size_t>(other)]; }))
                    continue;
                cut(cutout);
                done[n] = 1;
                --left;
            }
        divide_bent();
        return in_whole_pieces(mean_area);
    }

    CutCells join_pieces_of(std::vector<char> reshaped, double mean_area) {
        touched_ = reshaped;
        reshaped_ = std::move(reshaped);
        return in_whole_pieces(mean_area);
    }

private:
    // What was cut, without pieces that are too small for a grain. @param mean_area  of the cells before
    CutCells in_whole_pieces(double mean_area) {
        const int joined = join_small(mean_area);
        remove_straight();
        CutCells result = in_order();
        result.joined = joined;
        require_one_piece();
        return result;
    }

    // faces and vertices

    std::vector<Vec2> corners(const Face& face) const {
        std::vector<Vec2> result;
        for (const int v : face.vertices) result.push_back(graph_.vertices[v]);
        return result;
    }
    std::vector<Vec2> corners(int f) const { return corners(graph_.faces[f]); }
    bool alive(int f) const { return !graph_.faces[f].vertices.empty(); }

    void enter(int f) {
        for (const int v : graph_.faces[f].vertices) {
            if (std::find(faces_at_[v].begin(), faces_at_[v].end(), f) == faces_at_[v].end()) faces_at_[v].push_back(f);
        }
    }
    void leave(int f) {
        for (const int v : graph_.faces[f].vertices) std::erase(faces_at_[v], f);
    }
    void remove(int f) {
        leave(f);
        graph_.faces[f] = Face{graph_.faces[f].cell, {}, {}};
    }
    /// Puts `faces`, pieces of face f, in its place: the first there, the others at the end.
    std::vector<int> replace(int f, std::vector<Face> faces) {
        leave(f);
        std::vector<int> numbers;
        for (std::size_t k = 0; k < faces.size(); ++k) {
            const int number = k == 0 ? f : static_cast<int>(graph_.faces.size());
            if (k > 0) {
                graph_.faces.emplace_back();
                boxes_.push_back({});
                touched_.push_back(1);
                reshaped_.push_back(reshaped_[f]);
            }
            graph_.faces[number] = std::move(faces[k]);
            boxes_[number] = box_of(corners(number));
            touched_[number] = 1;
            enter(number);
            numbers.push_back(number);
        }
        return numbers;
    }

    int add_vertex(Vec2 at, int place) {
        graph_.vertices.push_back(at);
        graph_.place.push_back(place);
        faces_at_.emplace_back();
        return static_cast<int>(graph_.vertices.size()) - 1;
    }

    /// Position of the edge from a to b in the face, or nothing.
    static std::optional<std::size_t> edge_in(const Face& face, int a, int b) {
        const std::size_t n = face.vertices.size();
        for (std::size_t k = 0; k < n; ++k) {
            if (face.vertices[k] == a && face.vertices[(k + 1) % n] == b) return k;
        }
        return std::nullopt;
    }

    /// Puts vertex x into the edge a-b of every face that has it, in either direction.
    void put_into_edge(int a, int b, int x) {
        const std::vector<int> faces = faces_at_[a];
        for (const int f : faces) {
            Face& face = graph_.faces[f];
            auto k = edge_in(face, a, b);
            if (!k) k = edge_in(face, b, a);
            if (!k) continue;
            face.vertices.insert(face.vertices.begin() + static_cast<std::ptrdiff_t>(*k) + 1, x);
            face.labels.insert(face.labels.begin() + static_cast<std::ptrdiff_t>(*k) + 1, face.labels[*k]);
            touched_[f] = 1;
            if (std::find(faces_at_[x].begin(), faces_at_[x].end(), f) == faces_at_[x].end()) faces_at_[x].push_back(f);
        }
    }

    double mean_cell_area() const {
        double sum = 0.0;
        for (int f = 0; f < std::ssize(graph_.faces); ++f) sum += signed_area(corners(f));
        return sum / static_cast<double>(graph_.faces.size());
    }

    // cutting

    void cut(const Cutout& cutout) {
        const std::size_t count = cutout.vertices.size();
        const Box box = widened(box_of(cutout.vertices), eps_);
        near_.clear();
        for (int f = 0; f < std::ssize(graph_.faces); ++f) {
            if (alive(f) && overlap(boxes_[f], box)) near_.push_back(f);
        }
        inside_of_.clear();
        std::vector<int> ends;
        for (std::size_t e = 0; e < count; ++e) {
            const bool on_another = cutout.is_cut() && cutout.ends_on[e] >= 0;
            ends.push_back(on_another ? vertex_on_face(cutout.vertices[e], cutout.vertices[1 - e])
                                      : corner_vertex(cutout.vertices[e]));
        }
        std::vector<Part> parts;
        for (std::size_t k = 0; k < (cutout.is_cut() ? 1 : count); ++k) {
            const int edge = cutout.first_edge + static_cast<int>(k);
            const Sides sides = cutout.is_cut() ? Sides{cutout.first_edge, cutout.first_edge + 1} : Sides{-1, edge};
            const auto chain = chain_along(ends[k], ends[(k + 1) % count], edge);
            for (std::size_t i = 0; i + 1 < chain.size(); ++i) parts.push_back(part_between(chain[i], chain[i + 1], sides));
        }
        split_faces(parts, cutout);
        if (cutout.is_cut()) {
            for (int e = 0; e < 2; ++e) {
                if (cutout.tips[e]) divide_at_tip(ends[e], rot90(cutout.vertices[1] - cutout.vertices[0]));
            }
            double_vertices(parts, cutout, ends);
            return;
        }
        remove_covered(cutout);
        if (!cutout.slit) return;
        const std::vector<Vec2>& v = cutout.vertices;
        if (cutout.tips[1]) divide_at_end(ends[1], ends[2], v[1] - v[2]);
        if (cutout.tips[0]) divide_at_end(ends[0], ends[3], v[0] - v[3]);
    }

    /// The vertex for a corner of a cutout: one that is there, one put into an edge on which it lies, or one inside a cell, which
    /// is noted.
    int corner_vertex(Vec2 p) {
        for (const int f : near_) {
            for (const int v : graph_.faces[f].vertices) {
                if (norm(graph_.vertices[v] - p) > eps_) continue;
                if (graph_.place[v] != place_corner) graph_.vertices[v] = p;
                graph_.place[v] = place_corner;
                return v;
            }
        }
        const int x = add_vertex(p, place_corner);
        for (const int f : near_) {
            const Face& face = graph_.faces[f];
            for (std::size_t k = 0; k < face.vertices.size(); ++k) {
                const int a = face.vertices[k], b = face.vertices[(k + 1) % face.vertices.size()];
                if (distance_to_segment(p, graph_.vertices[a], graph_.vertices[b]) > eps_) continue;
                put_into_edge(a, b, x);
                return x;
            }
        }
        for (const int f : near_) {
            if (contains(corners(f), p)) inside_of_[x] = f;
        }
        return x;
    }

    /// The vertex for an end of a cut on the face of another, on the side from which it comes.
    int vertex_on_face(Vec2 p, Vec2 from) {
        const Vec2 beside = p + (1e-3 * mean_diameter_ / norm(from - p)) * (from - p);
        for (const int f : near_) {
            if (!alive(f) || !contains(corners(f), beside)) continue;
            const Face& face = graph_.faces[f];
            for (const int v : face.vertices)
                if (norm(graph_.vertices[v] - p) <= eps_) {
                    graph_.place[v] = place_corner;
                    return v;
                }
            for (std::size_t k = 0; k < face.vertices.size(); ++k) {
                const int a = face.vertices[k], b = face.vertices[(k + 1) % face.vertices.size()];
                if (distance_to_segment(p, graph_.vertices[a], graph_.vertices[b]) > eps_) continue;
                const int x = add_vertex(p, place_corner);
                put_into_edge(a, b, x);
                return x;
            }
        }
        throw NumericalError(
            fmt::format("no cell lies at the end of a cut on another, at ({:.6g}, {:.6g}) mm", 1e3 * p.x, 1e3 * p.y));
    }

    /// Between vertices on the way; where the faces of another cut are crossed each has its own there, and one of either is of
    /// the cell between.
    Part part_between(const std::vector<int>& from, const std::vector<int>& to, const Sides& sides) const {
        if (from.size() > 1 || to.size() > 1)
            for (const int u : from)
                for (const int v : to) {
                    const bool edge = std::any_of(faces_at_[u].begin(), faces_at_[u].end(), [&](int f) {
                        return edge_in(graph_.faces[f], u, v) || edge_in(graph_.faces[f], v, u);
                    });
                    if (edge || crossed_face({u, v, sides})) return {u, v, sides};
                }
        return {from.front(), to.front(), sides};
    }

    /// The vertices from `from` to `to`, in order: those of the graph on the way, and one where an edge of a cell is crossed;
    /// together those at one place.
    std::vector<std::vector<int>> chain_along(int from, int to, int edge) {
        const Vec2 a = graph_.vertices[from];
        const double length = norm(graph_.vertices[to] - a);
        const Vec2 along = (1.0 / length) * (graph_.vertices[to] - a);
        const Box box = widened(box_of({a, graph_.vertices[to]}), eps_);
        struct Crossing {
            int a, b;
            Vec2 at;
            bool boundary;
        };
        std::map<std::pair<int, int>, Crossing> crossings;
        std::map<int, double> on_way = {{from, 0.0}, {to, length}};
        for (const int f : near_) {
            if (!overlap(boxes_[f], box)) continue;
            const Face& face = graph_.faces[f];
            for (std::size_t k = 0; k < face.vertices.size(); ++k) {
                const int u = face.vertices[k], v = face.vertices[(k + 1) % face.vertices.size()];
                const Vec2 xu = graph_.vertices[u] - a, xv = graph_.vertices[v] - a;
                const double du = cross(along, xu), dv = cross(along, xv);
                if (std::abs(du) <= eps_ && dot(xu, along) > 0.0 && dot(xu, along) < length) on_way.emplace(u, dot(xu, along));
                if (std::abs(du) <= eps_ || std::abs(dv) <= eps_ || (du > 0.0) == (dv > 0.0)) continue;
                const auto [low, high] = std::minmax(u, v);  // the same bits from both cells
                const double dl = low == u ? du : dv, dh = low == u ? dv : du;
                const Vec2 at = graph_.vertices[low] + (dl / (dl - dh)) * (graph_.vertices[high] - graph_.vertices[low]);
                const double s = dot(at - a, along);
                if (s > eps_ && s < length - eps_) crossings.try_emplace({low, high}, Crossing{u, v, at, face.labels[k] < 0});
            }
        }
        for (const auto& [v, s] : on_way) {
            if (v != from && v != to) graph_.place[v] = graph_.place[v] == place_inside ? edge : place_corner;
        }
        for (const auto& [key, crossing] : crossings) {
            const int x = add_vertex(crossing.at, crossing.boundary ? place_corner : edge);
            put_into_edge(crossing.a, crossing.b, x);
            on_way[x] = dot(crossing.at - a, along);
        }
        std::vector<std::pair<double, int>> order;
        for (const auto& [v, s] : on_way) order.push_back({s, v});
        std::sort(order.begin(), order.end());
        std::vector<std::vector<int>> chain;
        for (std::size_t i = 0; i < order.size(); ++i) {
            if (i == 0 || order[i].first - order[i - 1].first > 4.0 * eps_) chain.emplace_back();
            chain.back().push_back(order[i].second);
        }
        return chain;
    }

    /// The cell that the part crosses, if it crosses one.
    std::optional<int> crossed_face(const Part& part) const {
        const auto faces_of = [&](int v) {
            std::vector<int> faces = faces_at_[v];
            const auto inside = inside_of_.find(v);
            if (inside != inside_of_.end()) faces.push_back(inside->second);
            return faces;
        };
        const Vec2 middle = 0.5 * (graph_.vertices[part.from] + graph_.vertices[part.to]);
        const std::vector<int> there = faces_of(part.to);
        for (const int f : faces_of(part.from)) {
            if (std::find(there.begin(), there.end(), f) != there.end() && contains(corners(f), middle)) return f;
        }
        return std::nullopt;
    }

    void split_faces(const std::vector<Part>& parts, const Cutout& cutout) {
        std::map<int, std::vector<Part>> crossing;  // by face
        for (const Part& part : parts) {
            bool edge = false;  // of a cell already
            for (const int f : faces_at_[part.from]) {
                Face& face = graph_.faces[f];
                const auto left = edge_in(face, part.from, part.to), right = edge_in(face, part.to, part.from);
                if (left && cutout.is_cut()) face.labels[*left] = outline_label(part.sides.left);
                if (right) face.labels[*right] = outline_label(part.sides.right);
                if (left || right) touched_[f] = 1;
                edge = edge || left || right;
            }
            if (edge) continue;
            if (const auto f = crossed_face(part)) crossing[*f].push_back(part);
        }
        for (const auto& [f, inside] : crossing) {
            std::vector<Dart> darts;
            const Face& face = graph_.faces[f];
            for (std::size_t k = 0; k < face.vertices.size(); ++k)
                darts.push_back({face.vertices[k], face.vertices[(k + 1) % face.vertices.size()], face.labels[k], false});
            for (const Part& part : inside) {
                darts.push_back({part.from, part.to, outline_label(std::max(0, part.sides.left)), !cutout.is_cut()});
                darts.push_back({part.to, part.from, outline_label(part.sides.right), false});
            }
            if (!cutout.packed_around) reshaped_[f] = 1;
            const int cell = face.cell;
            std::vector<Face> kept = loops(darts, cell, cutout);
            if (kept.empty())
                remove(f);
            else {
                if (kept.size() > 1) reshaped_[f] = 1;
                replace(f, std::move(kept));
            }
        }
    }

    /// The faces that the darts enclose, without those inside the cutout.
    std::vector<Face> loops(const std::vector<Dart>& darts, int cell, const Cutout& cutout) const {
        std::vector<char> used(darts.size(), 0);
        std::vector<Face> faces;
        for (std::size_t start = 0; start < darts.size(); ++start) {
            if (used[start]) continue;
            Face face;
            face.cell = cell;
            bool inside = false;
            std::size_t dart = start;
            do {
                used[dart] = 1;
                face.vertices.push_back(darts[dart].from);
                face.labels.push_back(darts[dart].label);
                inside = inside || darts[dart].inside;
                dart = leftmost(darts, used, darts[dart], start);
            } while (dart != start && dart != darts.size());
            if (dart == darts.size()) throw NumericalError(fmt::format("{} does not close in cell {}", cutout.name, cell));
            if (inside) continue;
            if (signed_area(corners(face)) <= 0.0) {
                const Vec2 at = cutout.vertices.front();
                throw InputError(
                    {"", 0, 0, cutout.slit || cutout.is_cut() ? "specimen.notches" : "specimen.holes"},
                    fmt::format("{} at ({:.6g}, {:.6g}) mm lies within one grain", cutout.name, 1e3 * at.x, 1e3 * at.y),
                    "holes and notches larger than the grains around them", "make it larger, or take smaller grains");
            }
            faces.push_back(std::move(face));
        }
        return faces;
    }

    /// Of the darts that leave where `arriving` ends, the one that turns most to the left, back along itself last; `start` closes
    /// the loop.
    std::size_t leftmost(const std::vector<Dart>& darts, const std::vector<char>& used, const Dart& arriving,
                         std::size_t start) const {
        std::size_t best = darts.size();
        double best_turn = -infinity;
        const Vec2 in = graph_.vertices[arriving.to] - graph_.vertices[arriving.from];
        for (std::size_t d = 0; d < darts.size(); ++d) {
            if ((used[d] && d != start) || darts[d].from != arriving.to) continue;
            const Vec2 out = graph_.vertices[darts[d].to] - graph_.vertices[darts[d].from];
            const double turn = darts[d].to == arriving.from ? -10.0 : std::atan2(cross(in, out), dot(in, out));
            if (turn > best_turn) {
                best = d;
                best_turn = turn;
            }
        }
        return best;
    }

    /// Takes away the cells that lie in the cutout without touching its edges.
    void remove_covered(const Cutout& cutout) {
        const std::span<const Vec2> hole = cutout.vertices;
        for (const int f : near_) {
            if (!alive(f)) continue;
            const std::vector<Vec2> all = corners(f);
            const auto off =
                std::find_if(all.begin(), all.end(), [&](Vec2 p) { return distance_to_boundary(hole, p) > 10.0 * eps_; });
            if (contains(hole, off == all.end() ? centroid(all) : *off)) remove(f);
        }
    }

    /// Gives the right face of a cut vertices of its own, but for the tips.
    void double_vertices(const std::vector<Part>& parts, const Cutout& cutout, const std::vector<int>& ends) {
        std::set<int> along;
        for (const Part& part : parts) {
            along.insert(part.from);
            along.insert(part.to);
        }
        for (int e = 0; e < 2; ++e) {
            if (cutout.tips[e]) along.erase(ends[e]);
        }
        const Vec2 a = cutout.vertices[0], ab = cutout.vertices[1] - a;
        for (const int v : along) {
            std::vector<int> right;
            for (const int f : faces_at_[v]) {
                if (cross(ab, centroid(corners(f)) - a) < 0.0) right.push_back(f);
            }
            if (right.empty() || right.size() == faces_at_[v].size()) continue;
            const int copy =
                add_vertex(graph_.vertices[v], graph_.place[v] == cutout.first_edge ? cutout.first_edge + 1 : graph_.place[v]);
            for (const int f : right) {
                std::replace(graph_.faces[f].vertices.begin(), graph_.faces[f].vertices.end(), v, copy);
                std::erase(faces_at_[v], f);
                faces_at_[copy].push_back(f);
            }
        }
    }

    // dividing cells

    /// Where a division from corner `from` of the cell in direction `towards` ends.
    struct Target {
        std::size_t edge = 0;  ///< of the cell
        Vec2 at;
        int vertex = -1;  ///< of the cell, if it ends in one
    };

    std::optional<Target> target_of(const Face& face, std::size_t from, Vec2 towards) const {
        const std::size_t n = face.vertices.size();
        const Vec2 start = graph_.vertices[face.vertices[from]], direction = (1.0 / norm(towards)) * towards;
        const Vec2 out = graph_.vertices[face.vertices[(from + 1) % n]] - start,
                   back = graph_.vertices[face.vertices[(from + n - 1) % n]] - start;
        const auto turn_from_out = [&](Vec2 d) {
            const double turn = std::atan2(cross(out, d), dot(out, d));
            return turn <= 0.0 ? turn + 2.0 * std::numbers::pi : turn;
        };
        constexpr double least_angle = 0.05;  // to either edge
        if (turn_from_out(direction) < least_angle || turn_from_out(direction) > turn_from_out(back) - least_angle)
            return std::nullopt;
        double nearest = infinity;
        Target target;
        for (std::size_t k = 0; k < n; ++k) {
            const int u = face.vertices[k], v = face.vertices[(k + 1) % n];
            if (u == face.vertices[from] || v == face.vertices[from]) continue;
            const Vec2 xu = graph_.vertices[u], uv = graph_.vertices[v] - xu;
            const double slope = cross(direction, uv);
            if (slope == 0.0) continue;
            const double t = cross(xu - start, uv) / slope, s = cross(xu - start, direction) / slope;
            if (t <= eps_ || t >= nearest || s < 0.0 || s > 1.0) continue;
            nearest = t;
            target = {k, start + t * direction, -1};
        }
        if (nearest == infinity) return std::nullopt;
        const std::size_t a = target.edge, b = (target.edge + 1) % n;
        const auto far = [&](std::size_t k) { return norm(graph_.vertices[face.vertices[k]] - target.at); };
        for (const std::size_t k : far(a) < far(b) ? std::array{a, b} : std::array{b, a}) {
            const bool beside = (k + 1) % n == from || (from + 1) % n == k;
            if (target.vertex < 0 && far(k) < (beside ? eps_ : snap_)) target.vertex = face.vertices[k];
            if (beside && far(k) < eps_) return std::nullopt;
        }
        return target;
    }

    /// The two faces that a division would leave; `x` stands for its end.
    std::array<Face, 2> halves(const Face& face, std::size_t from, const Target& target, int x) const {
        const std::size_t n = face.vertices.size();
        std::array<Face, 2> result;
        result[0].cell = result[1].cell = face.cell;
        // from the corner on to the target's edge, and from there back to the corner
        std::size_t k = from;
        for (;; k = (k + 1) % n) {
            if (face.vertices[k] == x && k != from) break;
            result[0].vertices.push_back(face.vertices[k]);
            result[0].labels.push_back(face.labels[k]);
            if (target.vertex < 0 && k == target.edge) break;
        }
        result[0].vertices.push_back(x);
        result[0].labels.push_back(some_neighbour);
        result[1].vertices.push_back(x);
        result[1].labels.push_back(face.labels[target.vertex < 0 ? target.edge : k]);
        for (k = (k + 1) % n; k != from; k = (k + 1) % n) {
            result[1].vertices.push_back(face.vertices[k]);
            result[1].labels.push_back(face.labels[k]);
        }
        result[1].vertices.push_back(face.vertices[from]);
        result[1].labels.push_back(some_neighbour);
        return result;
    }

    /// Divides the cell from its corner towards a direction. @returns the two, or nothing if that is not possible
    std::vector<int> divide(int f, std::size_t from, Vec2 towards) {
        const auto target = target_of(graph_.faces[f], from, towards);
        if (!target) return {};
        int x = target->vertex;
        if (x < 0) {
            const Face& face = graph_.faces[f];
            const int a = face.vertices[target->edge], b = face.vertices[(target->edge + 1) % face.vertices.size()],
                      label = face.labels[target->edge];
            x = add_vertex(target->at, label < 0 ? -1 - label : place_inside);
            const int corner = face.vertices[from];
            const std::size_t before = static_cast<std::size_t>(
                std::count(face.vertices.begin(), face.vertices.begin() + static_cast<std::ptrdiff_t>(from), corner));
            put_into_edge(a, b, x);
            from = position(graph_.faces[f], corner, before);
        }
        Target there = *target;
        there.vertex = x;
        auto two = halves(graph_.faces[f], from, there, x);
        reshaped_[f] = 1;
        return replace(f, {std::move(two[0]), std::move(two[1])});
    }

    /// Place in the face of the vertex, of its occurrences the one with so many before it.
    static std::size_t position(const Face& face, int vertex, std::size_t before) {
        for (std::size_t k = 0; k < face.vertices.size(); ++k) {
            if (face.vertices[k] == vertex && before-- == 0) return k;
        }
        return face.vertices.size();
    }

    /// The cell into which a cut without width ends is divided to both sides of the tip.
    void divide_at_tip(int tip, Vec2 left) {
        for (const Vec2 towards : {left, -left}) {
            const std::vector<int> faces = faces_at_[tip];
            for (const int f : faces) {
                const std::size_t k = position(graph_.faces[f], tip, 0);
                if (faces.size() > 2 || (faces.size() == 2 && !bends_at(f, k))) continue;
                if (!divide(f, k, towards).empty()) break;
            }
        }
        for (const int f : faces_at_[tip]) {
            const Face& face = graph_.faces[f];
            const std::size_t n = face.vertices.size(), k = position(face, tip, 0);
            if (face.vertices[(k + 1) % n] == face.vertices[(k + n - 1) % n])
                throw NumericalError("the cell at the tip of a notch could not be divided");
        }
    }

    bool bends_at(int f, std::size_t k) const {
        const Face& face = graph_.faces[f];
        const std::size_t n = face.vertices.size();
        const Vec2 at = graph_.vertices[face.vertices[k]];
        const Vec2 in = at - graph_.vertices[face.vertices[(k + n - 1) % n]],
                   out = graph_.vertices[face.vertices[(k + 1) % n]] - at;
        return cross(in, out) < -1e-6 * norm(in) * norm(out) || face.vertices[(k + 1) % n] == face.vertices[(k + n - 1) % n];
    }

    /// Cells at the end of a slit are divided along the line of its end, where they would bend around its corners: from vertex a
    /// away from b, and from b.
    void divide_at_end(int a, int b, Vec2 from_b_to_a) {
        for (const auto& [v, towards] : {std::pair{a, from_b_to_a}, std::pair{b, -from_b_to_a}}) {
            for (const int f : std::vector<int>(faces_at_[v])) {
                const std::size_t k = position(graph_.faces[f], v, 0);
                if (bends_at(f, k) && margin_of(corners(f)) < sound_margin) divide(f, k, towards);
            }
        }
    }

    /// Cells that bend around a corner are divided, so that each part sees most of itself from its middle.
    void divide_bent() {
        for (int f = 0; f < std::ssize(graph_.faces); ++f) {  // the parts come at the end
            if (!alive(f) || !touched_[f] || margin_of(corners(f)) >= sound_margin) continue;
            const Face face = graph_.faces[f];
            const std::size_t n = face.vertices.size();
            double best = std::max(0.0, margin_of(corners(f))) + 0.02;
            std::size_t corner = n;
            Vec2 direction;
            for (std::size_t k = 0; k < n; ++k) {
                if (!bends_at(f, k)) continue;
                const Vec2 at = graph_.vertices[face.vertices[k]];
                for (const Vec2 towards :
                     {at - graph_.vertices[face.vertices[(k + n - 1) % n]], at - graph_.vertices[face.vertices[(k + 1) % n]]}) {
                    const auto target = target_of(face, k, towards);
                    if (!target) continue;
                    const int x = target->vertex < 0 ? static_cast<int>(graph_.vertices.size()) : target->vertex;
                    if (target->vertex < 0) graph_.vertices.push_back(target->at);  // for a moment
                    const auto two = halves(face, k, *target, x);
                    const double worst = std::min(margin_of(corners(two[0])), margin_of(corners(two[1])));
                    if (target->vertex < 0) graph_.vertices.pop_back();
                    if (worst <= best) continue;
                    best = worst;
                    corner = k;
                    direction = towards;
                }
            }
            if (corner < n && !divide(f, corner, direction).empty()) --f;  // look at the first part again
        }
    }

    // pieces

    bool small(const std::vector<Vec2>& piece, double mean_area) const {
        return signed_area(piece) < least_piece * mean_area || thickness_of(piece) < thinnest_piece * mean_diameter_;
    }

    /// Gives small pieces to neighbours, smallest first. @returns how many
    int join_small(double mean_area) {
        int joined = 0;
        for (bool changed = true; changed;) {
            changed = false;
            std::vector<std::pair<double, int>> pieces;
            for (int f = 0; f < std::ssize(graph_.faces); ++f) {
                if (!alive(f) || !reshaped_[f]) continue;
                const std::vector<Vec2> all = corners(f);
                if (small(all, mean_area)) pieces.push_back({signed_area(all), f});
            }
            std::sort(pieces.begin(), pieces.end());
            for (const auto& [area, f] : pieces) {
                if (!alive(f) || !small(corners(f), mean_area) || !give_away(f)) continue;
                ++joined;
                changed = true;
            }
        }
        return joined;
    }

    /// What would become of the faces if a piece went to a neighbour.
    struct Gift {
        int to = 0;
        double shared = 0.0;          ///< length of their boundary (m)
        double margin = -infinity;    ///< the least of the changed faces
        std::map<int, Face> changed;  ///< the neighbour with the piece, and others that lose a vertex
    };

    static Face without(Face face, int vertex) {
        const auto at = static_cast<std::ptrdiff_t>(position(face, vertex, 0));
        face.vertices.erase(face.vertices.begin() + at);
        face.labels.erase(face.labels.begin() + at);
        return face;
    }

    /// The piece joined to face `to`. Where a third cell met both, the border to it is drawn straight if that makes sounder
    /// cells.
    std::optional<Gift> gift(int f, int to, double shared) const {
        const Face& piece = graph_.faces[f];
        std::vector<Face> both = united({graph_.faces[to], piece}, graph_.faces[to].cell, graph_.vertices);
        if (both.size() != 1) return std::nullopt;
        std::vector<int> once = both.front().vertices;
        std::sort(once.begin(), once.end());
        if (std::adjacent_find(once.begin(), once.end()) != once.end()) return std::nullopt;
        Gift gift{to, shared, margin_of(corners(both.front())), {{to, both.front()}}};
        for (const int v : piece.vertices) {
            const std::vector<int>& faces = faces_at_[v];
            if (graph_.place[v] != place_inside || faces.size() != 3 || std::find(faces.begin(), faces.end(), to) == faces.end())
                continue;
            const int third = *std::find_if(faces.begin(), faces.end(), [&](int other) { return other != f && other != to; });
            const Face& before = gift.changed.contains(third) ? gift.changed[third] : graph_.faces[third];
            if (before.vertices.size() < 4 || gift.changed[to].vertices.size() < 4) continue;
            Face straight = without(gift.changed[to], v), beside = without(before, v);
            if (margin_of(corners(beside)) < std::min(sound_margin, margin_of(corners(before))) ||
                margin_of(corners(straight)) <= margin_of(corners(gift.changed[to])))
                continue;
            gift.changed[to] = std::move(straight);
            gift.changed[third] = std::move(beside);
        }
        gift.margin = margin_of(corners(gift.changed[to]));
        return gift;
    }

    /// Gives the piece to the neighbour with which it shares the longest boundary, of those with which it makes a sound cell.
    bool give_away(int f) {
        std::map<int, double> shared;
        const Face& piece = graph_.faces[f];
        for (std::size_t k = 0; k < piece.vertices.size(); ++k) {
            const int a = piece.vertices[k], b = piece.vertices[(k + 1) % piece.vertices.size()];
            for (const int other : faces_at_[a]) {
                if (other != f && edge_in(graph_.faces[other], b, a))
                    shared[other] += norm(graph_.vertices[b] - graph_.vertices[a]);
            }
        }
        std::optional<Gift> best;
        for (const auto& [other, length] : shared) {
            if (best && length <= best->shared) continue;
            auto found = gift(f, other, length);
            if (!found) continue;
            if (found->margin >= std::min(sound_margin, margin_of(corners(other)))) best = std::move(found);
        }
        if (!best) return false;
        remove(f);
        reshaped_[best->to] = 1;
        for (auto& [other, face] : best->changed) replace(other, {std::move(face)});
        return true;
    }

    /// Vertices in the middle of a straight edge between the same two cells, or of an edge of the outline of one cell, are left
    /// over from pieces that were joined.
    void remove_straight() {
        for (int v = 0; v < std::ssize(graph_.vertices); ++v) {
            const std::vector<int>& faces = faces_at_[v];
            if (faces.empty() || faces.size() > 2 || graph_.place[v] == place_corner) continue;
            if (v < old_vertices_ && !std::all_of(faces.begin(), faces.end(), [&](int f) { return touched_[f]; })) continue;
            const Face& first = graph_.faces[faces.front()];
            const std::size_t n = first.vertices.size(), k = position(first, v, 0);
            const int before = first.vertices[(k + n - 1) % n], after = first.vertices[(k + 1) % n];
            const Vec2 a = graph_.vertices[before], b = graph_.vertices[after];
            if (distance_to_segment(graph_.vertices[v], a, b) > eps_) continue;
            bool fits = true;
            for (const int f : faces) {
                const Face& face = graph_.faces[f];
                fits = fits && face.vertices.size() > 3;
                if (f == faces.front()) continue;
                const std::size_t m = face.vertices.size(), j = position(face, v, 0);
                fits = fits && face.vertices[(j + 1) % m] == before && face.vertices[(j + m - 1) % m] == after;
            }
            const bool boundary = first.labels[k] < 0 || first.labels[(k + n - 1) % n] < 0;
            if (boundary)
                fits = fits && faces.size() == 1 && first.labels[k] == first.labels[(k + n - 1) % n];
            else
                fits = fits && faces.size() == 2;
            if (!fits) continue;
            for (const int f : std::vector<int>(faces)) {
                Face& face = graph_.faces[f];
                const auto at = static_cast<std::ptrdiff_t>(position(face, v, 0));
                face.vertices.erase(face.vertices.begin() + at);
                face.labels.erase(face.labels.begin() + at);
            }
            faces_at_[v].clear();
        }
    }

    /// One face a grain in the order of the cells; labels name the neighbours.
    CutCells in_order() {
        std::vector<int> order;
        for (int f = 0; f < std::ssize(graph_.faces); ++f) {
            if (alive(f)) order.push_back(f);
        }
        std::stable_sort(order.begin(), order.end(), [&](int l, int r) { return graph_.faces[l].cell < graph_.faces[r].cell; });
        CutCells result;
        std::vector<Face> faces;
        for (const int f : order) {
            result.disc.push_back(graph_.faces[f].cell);
            result.reshaped.push_back(reshaped_[f]);
            faces.push_back(std::move(graph_.faces[f]));
            faces.back().cell = static_cast<int>(faces.size()) - 1;
        }
        graph_.faces = std::move(faces);
        name_neighbours(graph_.faces);
        return result;
    }

    /// @throws InputError if the cells do not hang together
    void require_one_piece() const {
        if (std::any_of(outline_.cutouts.begin(), outline_.cutouts.end(), [](const Cutout& cutout) { return cutout.joined; }))
            return;  // what it divides stays in contact
        std::vector<int> part(graph_.faces.size(), -1);
        int parts = 0;
        std::vector<std::pair<int, int>> sizes;  // grains, and one of them
        for (int start = 0; start < std::ssize(part); ++start) {
            if (part[start] >= 0) continue;
            std::vector<int> waiting = {start};
            part[start] = parts;
            int count = 0;
            while (!waiting.empty()) {
                const int f = waiting.back();
                waiting.pop_back();
                ++count;
                for (const int label : graph_.faces[f].labels) {
                    if (label < 0 || part[label] >= 0) continue;
                    part[label] = parts;
                    waiting.push_back(label);
                }
            }
            sizes.push_back({count, start});
            ++parts;
        }
        if (parts == 1) return;
        const auto [count, grain] = *std::min_element(sizes.begin(), sizes.end());
        const Vec2 at = centroid(corners(grain));
        throw InputError(
            {"", 0, 0, "specimen.notches"},
            fmt::format("holes and notches cut the specimen into {} parts; one of {} grains lies around ({:.6g}, {:.6g}) mm",
                        parts, count, 1e3 * at.x, 1e3 * at.y),
            "holes and notches that leave the rock in one piece", "shorten a notch, or move it");
    }

    CellGraph& graph_;
    const Outline& outline_;
    double mean_diameter_, snap_, eps_;
    int old_vertices_;
    std::vector<std::vector<int>> faces_at_;  ///< a vertex: the faces that name it
    std::vector<Box> boxes_;                  ///< a face
    std::vector<char> touched_;               ///< a face: something was cut out of it, or it has got a vertex more
    std::vector<char> reshaped_;              ///< a face: see CutCells
    std::vector<int> near_;                   ///< the faces that the cutout may cut
    std::map<int, int> inside_of_;            ///< a corner of the cutout inside a cell: the face
};

}  // namespace

CutCells cut_cells(CellGraph& graph, const Outline& outline, double mean_diameter_m, double merge_length_m) {
    return CellCutter(graph, outline, mean_diameter_m, merge_length_m).run();
}

CutCells join_small_pieces(CellGraph& graph, const Outline& outline, double mean_diameter_m, double mean_area_m2,
                           double merge_length_m, std::vector<char> reshaped) {
    return CellCutter(graph, outline, mean_diameter_m, merge_length_m).join_pieces_of(std::move(reshaped), mean_area_m2);
}

}  // namespace feldspar
