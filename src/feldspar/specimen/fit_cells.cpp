#include "feldspar/specimen/fit_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/cut_cells.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

/// Nearer than this share of a mean grain to where it should be, a vertex stays where it is.
constexpr double no_length = 1e-9;
/// Of what has not become an edge of the outline yet.
constexpr int not_cut = -2'000'000'000;

std::string in_mm(Vec2 at) { return fmt::format("({:.6g}, {:.6g}) mm", 1e3 * at.x, 1e3 * at.y); }

struct Circle {
    Vec2 centre;
    double radius = 0.0, furthest = 0.0;  // how far a point is from it at most
};

/// Least squares: x^2 + y^2 = 2 a x + 2 b y + c.
Circle circle_through(const std::vector<Vec2>& points) {
    Vec2 middle;
    for (const Vec2 p : points) middle += (1.0 / static_cast<double>(points.size())) * p;
    double xx = 0, xy = 0, yy = 0, xs = 0, ys = 0, s = 0;
    for (const Vec2 p : points) {
        const Vec2 q = p - middle;
        const double square = dot(q, q);
        xx += q.x * q.x, xy += q.x * q.y, yy += q.y * q.y;
        xs += q.x * square, ys += q.y * square, s += square;
    }
    const double det = 2.0 * (xx * yy - xy * xy);
    Circle circle;
    const Vec2 offset{(xs * yy - ys * xy) / det, (ys * xx - xs * xy) / det};
    circle.centre = middle + offset;
    circle.radius = std::sqrt(s / static_cast<double>(points.size()) + dot(offset, offset));
    for (const Vec2 p : points) circle.furthest = std::max(circle.furthest, std::abs(norm(p - circle.centre) - circle.radius));
    return circle;
}

/// The corners of a closed line: without vertices that lie on the straight line between those that stay.
std::vector<Vec2> corners_of(const std::vector<Vec2>& line, double reach) {
    const std::size_t n = line.size();
    std::size_t first = 0;  // the vertex farthest from the middle is a corner
    Vec2 middle;
    for (const Vec2 p : line) middle += (1.0 / static_cast<double>(n)) * p;
    for (std::size_t k = 1; k < n; ++k)
        if (norm(line[k] - middle) > norm(line[first] - middle)) first = k;
    // Between two corners: the vertex that is farthest from their line, if that is far enough, is one too.
    std::set<std::size_t> kept{0};
    const auto at = [&](std::size_t k) { return line[(first + k) % n]; };
    std::size_t opposite = 1;
    for (std::size_t k = 1; k < n; ++k)
        if (norm(at(k) - at(0)) > norm(at(opposite) - at(0))) opposite = k;
    kept.insert(opposite);
    std::vector<std::pair<std::size_t, std::size_t>> waiting{{0, opposite}, {opposite, n}};
    while (!waiting.empty()) {
        const auto [from, to] = waiting.back();
        waiting.pop_back();
        double farthest = reach;
        std::size_t corner = to;
        for (std::size_t k = from + 1; k < to; ++k) {
            const double distance = distance_to_segment(at(k), at(from), at(to));
            if (distance > farthest) farthest = distance, corner = k;
        }
        if (corner == to) continue;
        kept.insert(corner);
        waiting.push_back({from, corner});
        waiting.push_back({corner, to});
    }
    std::vector<Vec2> corners;
    for (const std::size_t k : kept) corners.push_back(at(k));
    return corners;
}

std::vector<Vec2> boundary_points(const GivenCells& cells) {
    std::vector<Vec2> points;
    for (const int v : cells.boundary) points.push_back(cells.vertices[v]);
    return points;
}

/// To 12 digits, so that a diameter that was computed is the one that was meant.
double rounded(double value) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 11.0);
    const double digits = std::round(value / unit);
    return unit < 1.0 ? digits / std::round(1.0 / unit) : digits * unit;
}

class Fitter {
public:
    Fitter(const GivenCellsSpec& spec, const Outline& outline, Shape shape)
        : spec_(spec), cells_(*spec.cells), outline_(outline), mean_(cells_.mean_diameter_m), reach_(spec.tolerance * mean_) {
        result_.shift = shift(shape);
        graph_.vertices = cells_.vertices;
        if (result_.shift != Vec2{})
            for (Vec2& v : graph_.vertices) v += result_.shift;
        graph_.place.assign(graph_.vertices.size(), place_inside);
        for (int c = 0; c < std::ssize(cells_.cells); ++c) {
            Face face{c, cells_.cells[c], {}};
            for (const int other : cells_.neighbours[c]) face.labels.push_back(other >= 0 ? other : not_cut);
            // Read from its last edge, so that a cell whose last edge is as short as another keeps its first corner.
            std::rotate(face.vertices.begin(), face.vertices.end() - 1, face.vertices.end());
            std::rotate(face.labels.begin(), face.labels.end() - 1, face.labels.end());
            graph_.faces.push_back(std::move(face));
        }
    }

    FittedCells fit() {
        if (outline_.is_disc)
            fit_disc();
        else
            fit_polygon();
        check_area();
        return finished();
    }

    FittedCells cut() {
        const double mean_area = total_area() / static_cast<double>(graph_.faces.size());
        touched_.assign(graph_.faces.size(), 0);
        if (outline_.is_disc) {
            cut_by_circle();
            if (outline_.flattened()) {
                const auto corners = flat_corners(outline_);
                cut_by_line(corners[1], corners[0], top_flat);
                cut_by_line(corners[2], corners[3], bottom_flat);
            }
        } else {
            const std::size_t n = outline_.vertices.size();
            for (std::size_t k = 0; k < n; ++k)
                cut_by_line(outline_.vertices[k], outline_.vertices[(k + 1) % n], static_cast<int>(k));
        }
        if (graph_.faces.empty()) fail("the outline lies outside the cells", "an outline within the cells");
        label_remaining();
        name_places();
        CutCells cut = join_small_pieces(graph_, outline_without_cutouts(), mean_, mean_area, 0.0, touched_);
        result_.origin = std::move(cut.disc);
        result_.reshaped = std::move(cut.reshaped);
        result_.joined = cut.joined;
        return finished();
    }

private:
    [[noreturn]] void fail(const std::string& problem, const std::string& allowed, const std::string& suggestion = {}) const {
        throw InputError({spec_.file.string(), 0, 0, {}}, problem, allowed, suggestion);
    }

    Outline outline_without_cutouts() const {
        Outline outline = outline_;
        outline.cutouts.clear();
        return outline;
    }

    double total_area() const {
        double sum = 0.0;
        for (const Face& face : graph_.faces) sum += signed_area(corners(face));
        return sum;
    }
    std::vector<Vec2> corners(const Face& face) const {
        std::vector<Vec2> points;
        for (const int v : face.vertices) points.push_back(graph_.vertices[v]);
        return points;
    }

    Vec2 shift(Shape shape) const {
        const std::vector<Vec2> line = boundary_points(cells_);
        const Box box = bounding_box(std::span<const Vec2>(line));
        Vec2 by;
        if (spec_.cut) {
            const Box target = bounding_box(outline_);
            by = 0.5 * (target.lower + target.upper) - 0.5 * (box.lower + box.upper);
        } else if (shape == Shape::rectangle) {
            by = -box.lower;
        } else if (outline_.is_disc) {
            by = outline_.centre - circle_through(line).centre;
        }
        return norm(by) > reach_ ? by : Vec2{};  // within the tolerance vertices are moved one by one
    }

    std::string off(double distance) const {
        return fmt::format("{:.4g} mm ({:.3g} mean grain diameters)", 1e3 * distance, distance / mean_);
    }
    std::string of_file(Vec2 at) const {
        const Vec2 there = (1.0 / spec_.unit_m) * (at - result_.shift);
        return fmt::format("({:.6g}, {:.6g}) of the file", there.x, there.y);
    }
    static constexpr const char* filled = "cells that fill the outline to the key tolerance, in mean grain diameters";
    static constexpr const char* other_ways =
        "shape = \"from-file\" takes the outline from the cells; is unit the length of one unit of the file?";

    void move(int v, Vec2 to) {
        Vec2& at = graph_.vertices[v];
        const double distance = norm(to - at);
        if (distance == 0.0) return;
        if (distance > no_length * mean_) {
            ++result_.moved;
            result_.furthest_m = std::max(result_.furthest_m, distance);
        }
        at = to;
    }

    void fit_disc() {
        std::set<int> on;
        for (Face& face : graph_.faces)
            for (std::size_t k = 0; k < face.labels.size(); ++k) {
                if (face.labels[k] != not_cut) continue;
                on.insert(face.vertices[k]);
                on.insert(face.vertices[(k + 1) % face.vertices.size()]);
                face.labels[k] = outline_label(circle_edge);
            }
        for (const int v : on) {
            const Vec2 out = graph_.vertices[v] - outline_.centre;
            const double distance = norm(out) - outline_.radius_m;
            if (std::abs(distance) > reach_)
                fail(fmt::format("the cells do not fill the disc: their boundary at {} lies {} {} its circle",
                                 in_mm(out + outline_.centre), off(std::abs(distance)), distance > 0.0 ? "outside" : "inside"),
                     filled, std::string(other_ways) + " A polygon around a disc needs a larger tolerance");
            if (std::abs(distance) > no_length * mean_) move(v, outline_.centre + (outline_.radius_m / norm(out)) * out);
            graph_.place[v] = circle_edge;
        }
    }

    void fit_polygon() {
        const std::vector<Vec2>& outline = outline_.vertices;
        const std::size_t n = outline.size();
        // each corner of the outline: the vertex that is there, or one that is put into the edge there
        std::vector<int> line = cells_.boundary;
        for (std::size_t k = 0; k < n; ++k) {
            int nearest = line.front();
            for (const int v : line)
                if (norm(graph_.vertices[v] - outline[k]) < norm(graph_.vertices[nearest] - outline[k])) nearest = v;
            if (norm(graph_.vertices[nearest] - outline[k]) > reach_) {
                insert_corner(line, outline[k]);
                continue;
            }
            move(nearest, outline[k]);
            graph_.place[nearest] = place_corner;
        }
        for (const int v : line) {
            if (graph_.place[v] == place_corner) continue;
            const Vec2 at = graph_.vertices[v];
            double nearest = std::numeric_limits<double>::infinity();
            std::size_t edge = 0;
            for (std::size_t k = 0; k < n; ++k) {
                const double distance = distance_to_segment(at, outline[k], outline[(k + 1) % n]);
                if (distance < nearest) nearest = distance, edge = k;
            }
            if (nearest > reach_)
                fail(fmt::format("the cells do not fill the outline: their boundary at {}, {}, lies {} {} it", in_mm(at),
                                 of_file(at), off(nearest), contains(std::span<const Vec2>(outline), at) ? "inside" : "outside"),
                     filled, other_ways);
            graph_.place[v] = static_cast<int>(edge);
            const Vec2 a = outline[edge], b = outline[(edge + 1) % n];
            Vec2 to = at;
            if (nearest > no_length * mean_) to = closest_on_segment(at, a, b);
            if (a.x == b.x) to.x = a.x;
            if (a.y == b.y) to.y = a.y;
            move(v, to);
        }
        for (Face& face : graph_.faces)
            for (std::size_t k = 0; k < face.labels.size(); ++k)
                if (face.labels[k] == not_cut)
                    face.labels[k] = outline_label(edge_between(face.vertices[k], face.vertices[(k + 1) % face.vertices.size()]));
    }

    /// A corner of the outline in the middle of an edge of a cell.
    void insert_corner(std::vector<int>& line, Vec2 corner) {
        const std::size_t n = line.size();
        for (std::size_t k = 0; k < n; ++k) {
            const int a = line[k], b = line[(k + 1) % n];
            if (distance_to_segment(corner, graph_.vertices[a], graph_.vertices[b]) > reach_) continue;
            const int v = static_cast<int>(graph_.vertices.size());
            graph_.vertices.push_back(corner);
            graph_.place.push_back(place_corner);
            line.insert(line.begin() + static_cast<std::ptrdiff_t>(k) + 1, v);
            for (Face& face : graph_.faces)
                for (std::size_t j = 0; j < face.vertices.size(); ++j) {
                    if (face.vertices[j] != a || face.vertices[(j + 1) % face.vertices.size()] != b || face.labels[j] != not_cut)
                        continue;
                    face.vertices.insert(face.vertices.begin() + static_cast<std::ptrdiff_t>(j) + 1, v);
                    face.labels.insert(face.labels.begin() + static_cast<std::ptrdiff_t>(j) + 1, not_cut);
                    return;
                }
        }
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < n; ++k)
            nearest = std::min(nearest, distance_to_segment(corner, graph_.vertices[line[k]],
                                                            graph_.vertices[static_cast<std::size_t>(line[(k + 1) % n])]));
        fail(fmt::format("the cells do not fill the outline: its corner at {} lies {} from their boundary", in_mm(corner),
                         off(nearest)),
             filled, other_ways);
    }

    /// The edge of the outline on which both vertices lie.
    int edge_between(int a, int b) const {
        const std::vector<Vec2>& outline = outline_.vertices;
        const Vec2 p = graph_.vertices[a], q = graph_.vertices[b];
        double nearest = std::numeric_limits<double>::infinity();
        int edge = -1;
        for (int k = 0; k < std::ssize(outline); ++k) {
            const Vec2 from = outline[k], to = outline[static_cast<std::size_t>(k + 1) % outline.size()];
            const double farthest = std::max(distance_to_segment(p, from, to), distance_to_segment(q, from, to));
            if (farthest < nearest && dot(q - p, to - from) > 0.0) nearest = farthest, edge = k;
        }
        if (edge < 0 || nearest > reach_)
            fail(fmt::format("the cells do not fill the outline: an edge of a cell from {} to {} cuts a corner of it", in_mm(p),
                             in_mm(q)),
                 filled, other_ways);
        return edge;
    }

    void check_area() const {
        for (const Face& face : graph_.faces)
            if (signed_area(corners(face)) <= 0.0)
                fail(fmt::format("cell {} has no area left where it was moved onto the outline", cells_.names[face.cell]),
                     "a smaller tolerance");
        if (outline_.is_disc) return;
        const double whole = signed_area(outline_.vertices), area = total_area();
        if (std::abs(area - whole) > 1e-6 * whole)
            fail(fmt::format("the cells have an area of {:.6g} mm2, the outline {:.6g} mm2", 1e6 * area, 1e6 * whole), filled,
                 other_ways);
    }

    FittedCells finished() {
        result_.graph = std::move(graph_);
        return std::move(result_);
    }

    // cutting the outline out of the cells

    enum class Side { inside, on, outside };

    /// The outline's edge of the label, and what lies between two vertices: the part of the edge that stays.
    template <class SideOf, class Crossings>
    void cut_by(int edge, const SideOf& side_of, const Crossings& crossings) {
        std::vector<Side> side;
        for (const Vec2 at : graph_.vertices) side.push_back(side_of(at));
        std::map<std::pair<int, int>, std::vector<int>> cuts;  // of an edge, from its lower vertex on
        const auto cuts_between = [&](int a, int b) {
            const std::pair<int, int> key = std::minmax(a, b);
            auto found = cuts.find(key);
            if (found == cuts.end()) {
                std::vector<int> numbers;
                for (const Vec2 at :
                     crossings(graph_.vertices[key.first], graph_.vertices[key.second], side[key.first], side[key.second])) {
                    numbers.push_back(static_cast<int>(graph_.vertices.size()));
                    graph_.vertices.push_back(at);
                    graph_.place.push_back(place_inside);
                }
                found = cuts.emplace(key, std::move(numbers)).first;
            }
            std::vector<int> numbers = found->second;
            if (a > b) std::reverse(numbers.begin(), numbers.end());
            return numbers;
        };
        std::vector<Face> faces;
        std::vector<char> touched;
        for (std::size_t f = 0; f < graph_.faces.size(); ++f) {
            const Face& face = graph_.faces[f];
            const std::size_t n = face.vertices.size();
            if (std::all_of(face.vertices.begin(), face.vertices.end(), [&](int v) { return side[v] == Side::inside; })) {
                faces.push_back(face);
                touched.push_back(touched_[f]);
                continue;
            }
            struct Part {
                int from, to, label;
            };
            std::vector<Part> parts;  // of the edges, what stays; a vertex on the line alone is one without length
            for (std::size_t k = 0; k < n; ++k) {
                const int a = face.vertices[k], b = face.vertices[(k + 1) % n];
                const Side at_a = side[a], at_b = side[b];
                const std::vector<int> between =
                    at_a != Side::outside && at_b != Side::outside ? std::vector<int>{} : cuts_between(a, b);
                std::vector<int> stops;
                if (at_a != Side::outside) stops.push_back(a);
                stops.insert(stops.end(), between.begin(), between.end());
                if (at_b != Side::outside) stops.push_back(b);
                if (stops.size() == 1) parts.push_back({stops.front(), stops.front(), face.labels[k]});
                for (std::size_t i = 0; i + 1 < stops.size(); i += 2) parts.push_back({stops[i], stops[i + 1], face.labels[k]});
            }
            Face left{face.cell, {}, {}};
            for (std::size_t i = 0; i < parts.size(); ++i) {
                const Part& part = parts[i];
                const Part& next = parts[(i + 1) % parts.size()];
                if (part.from != part.to) left.vertices.push_back(part.from), left.labels.push_back(part.label);
                if (part.to != next.from) left.vertices.push_back(part.to), left.labels.push_back(outline_label(edge));
            }
            if (left.vertices.size() < 3 || signed_area(corners(left)) <= 1e-12 * mean_ * mean_) continue;
            std::vector<int> once = left.vertices;
            std::sort(once.begin(), once.end());
            if (std::adjacent_find(once.begin(), once.end()) != once.end() || !is_simple_polygon(corners(left)))
                fail(fmt::format("the outline cuts cell {}, which is not convex, into several pieces", cells_.names[face.cell]),
                     "convex cells where the outline runs through them");
            touched.push_back(left.vertices != face.vertices || touched_[f] ? 1 : 0);
            faces.push_back(std::move(left));
        }
        graph_.faces = std::move(faces);
        touched_ = std::move(touched);
        // an edge inside that runs along the cut has no other side any more
        std::set<std::pair<int, int>> darts;
        for (const Face& face : graph_.faces)
            for (std::size_t k = 0; k < face.vertices.size(); ++k)
                darts.insert({face.vertices[k], face.vertices[(k + 1) % face.vertices.size()]});
        for (Face& face : graph_.faces)
            for (std::size_t k = 0; k < face.vertices.size(); ++k)
                if (face.labels[k] >= 0 && !darts.contains({face.vertices[(k + 1) % face.vertices.size()], face.vertices[k]}))
                    face.labels[k] = outline_label(edge);
    }

    void cut_by_line(Vec2 a, Vec2 b, int edge) {
        const Vec2 along = (1.0 / norm(b - a)) * (b - a);
        const auto height = [&](Vec2 at) { return cross(along, at - a); };
        const auto onto = [&](Vec2 at) {
            Vec2 there = a + dot(at - a, along) * along;
            if (a.x == b.x) there.x = a.x;
            if (a.y == b.y) there.y = a.y;
            return there;
        };
        for (Vec2& at : graph_.vertices)
            if (std::abs(height(at)) <= reach_) at = onto(at);
        cut_by(
            edge,
            [&](Vec2 at) { return std::abs(height(at)) <= reach_ ? Side::on
                                  : height(at) > 0.0             ? Side::inside
                                                                 : Side::outside; },
            [&](Vec2 p, Vec2 q, Side at_p, Side at_q) {
                std::vector<Vec2> found;
                if ((at_p == Side::inside && at_q == Side::outside) || (at_p == Side::outside && at_q == Side::inside))
                    found.push_back(onto(p + height(p) / (height(p) - height(q)) * (q - p)));
                return found;
            });
    }

    void cut_by_circle() {
        const Vec2 c = outline_.centre;
        const double R = outline_.radius_m;
        const auto onto = [&](Vec2 at) { return c + (R / norm(at - c)) * (at - c); };
        for (Vec2& at : graph_.vertices)
            if (std::abs(norm(at - c) - R) <= reach_) at = onto(at);
        cut_by(
            circle_edge,
            [&](Vec2 at) {
                return std::abs(norm(at - c) - R) <= reach_ ? Side::on : norm(at - c) < R ? Side::inside : Side::outside;
            },
            [&](Vec2 p, Vec2 q, Side at_p, Side at_q) {
                std::vector<Vec2> found;
                if (at_p != Side::outside && at_q != Side::outside) return found;
                const double length = norm(q - p);
                const Vec2 along = (1.0 / length) * (q - p);
                const double foot = dot(c - p, along), half2 = R * R - dot(p + foot * along - c, p + foot * along - c);
                if (!(half2 > 0.0)) return found;
                const double half = std::sqrt(half2);
                const auto take = [&](double share) { found.push_back(onto(p + share * along)); };
                if (at_p == Side::inside)
                    take(foot + half);
                else if (at_q == Side::inside)
                    take(foot - half);
                else if (at_p == Side::on) {
                    if (foot + half > reach_ && foot > reach_) take(std::min(foot + half, length));
                } else if (at_q == Side::on) {
                    if (length - foot > reach_) take(std::max(foot - half, 0.0));
                } else if (foot - half > 0.0 && foot + half < length && R - std::sqrt(std::max(0.0, R * R - half2)) > reach_)
                    take(foot - half), take(foot + half);
                return found;
            });
    }

    /// Edges of the cells' own boundary that are left must lie on the outline.
    void label_remaining() {
        for (Face& face : graph_.faces)
            for (std::size_t k = 0; k < face.vertices.size(); ++k) {
                if (face.labels[k] != not_cut) continue;
                const Vec2 p = graph_.vertices[face.vertices[k]],
                           q = graph_.vertices[static_cast<std::size_t>(face.vertices[(k + 1) % face.vertices.size()])];
                if (!outline_.is_disc) {
                    face.labels[k] = outline_label(edge_of_cut(p, q));
                    continue;
                }
                // chords of the circle, and sides of the cells that touch it
                const double gap =
                    outline_.radius_m -
                    std::sqrt(std::max(0.0, dot(0.5 * (p + q) - outline_.centre, 0.5 * (p + q) - outline_.centre)));
                const bool ends_on = std::max(std::abs(norm(p - outline_.centre) - outline_.radius_m),
                                              std::abs(norm(q - outline_.centre) - outline_.radius_m)) <= 1.01 * reach_;
                if (!ends_on || gap > mean_) not_covered(0.5 * (p + q));
                face.labels[k] = outline_label(circle_edge);
            }
    }
    int edge_of_cut(Vec2 p, Vec2 q) const {
        const std::vector<Vec2>& outline = outline_.vertices;
        for (std::size_t k = 0; k < outline.size(); ++k) {
            const Vec2 from = outline[k], to = outline[(k + 1) % outline.size()];
            if (dot(q - p, to - from) > 0.0 &&
                std::max(distance_to_segment(p, from, to), distance_to_segment(q, from, to)) <= 1.01 * reach_)
                return static_cast<int>(k);
        }
        not_covered(0.5 * (p + q));
    }
    [[noreturn]] void not_covered(Vec2 at) const {
        const auto line = boundary_points(cells_);
        const Box box = bounding_box(std::span<const Vec2>(line)), wanted = bounding_box(outline_);
        fail(fmt::format("the cells do not cover the outline: they end inside it at {}. They reach over {:.6g} x {:.6g} mm, the "
                         "outline over {:.6g} x {:.6g} mm",
                         in_mm(at), 1e3 * (box.upper.x - box.lower.x), 1e3 * (box.upper.y - box.lower.y),
                         1e3 * (wanted.upper.x - wanted.lower.x), 1e3 * (wanted.upper.y - wanted.lower.y)),
             "an outline within the cells; it is cut out of their middle",
             "make the specimen of the test smaller, or take more cells");
    }

    /// Where vertices may go, from the edges of the outline that meet there.
    void name_places() {
        std::map<int, std::set<int>> edges;
        for (const Face& face : graph_.faces)
            for (std::size_t k = 0; k < face.vertices.size(); ++k) {
                if (face.labels[k] >= 0) continue;
                for (const int v : {face.vertices[k], face.vertices[(k + 1) % face.vertices.size()]})
                    edges[v].insert(-1 - face.labels[k]);
            }
        // A flat meets the chord of a cell somewhat inside of the circle.
        std::vector<Vec2> exact = outline_.vertices;
        if (outline_.flattened())
            for (const Vec2 corner : flat_corners(outline_)) exact.push_back(corner);
        const double near = outline_.flattened() ? 0.5 * mean_ : 4.0 * reach_;
        for (const auto& [v, at] : edges) {
            graph_.place[v] = at.size() > 1 ? static_cast<int>(place_corner) : *at.begin();
            if (at.size() < 2) continue;
            for (const Vec2 corner : exact)
                if (norm(corner - graph_.vertices[v]) <= near) graph_.vertices[v] = corner;
        }
    }

    const GivenCellsSpec& spec_;
    const GivenCells& cells_;
    const Outline& outline_;
    double mean_, reach_;
    CellGraph graph_;
    std::vector<char> touched_;
    FittedCells result_;
};

}  // namespace

OutlineSpec outline_of_cells(const GivenCells& cells, double tolerance) {
    const double reach = tolerance * cells.mean_diameter_m;
    const std::vector<Vec2> line = boundary_points(cells);
    const std::vector<Vec2> corners = corners_of(line, reach);
    OutlineSpec outline;
    const Box box = bounding_box(std::span<const Vec2>(line));
    const auto near = [&](double a, double b) { return std::abs(a - b) <= reach; };
    const bool box_corners =
        corners.size() == 4 && std::all_of(corners.begin(), corners.end(), [&](Vec2 p) {
            return (near(p.x, box.lower.x) || near(p.x, box.upper.x)) && (near(p.y, box.lower.y) || near(p.y, box.upper.y));
        });
    if (box_corners) {
        outline.shape = Shape::rectangle;
        const bool at_origin = std::abs(box.lower.x) <= reach && std::abs(box.lower.y) <= reach;  // then its cells are not moved
        outline.width_m = at_origin ? box.upper.x : box.upper.x - box.lower.x;
        outline.height_m = at_origin ? box.upper.y : box.upper.y - box.lower.y;
        return outline;
    }
    if (line.size() >= 16) {
        const Circle circle = circle_through(line);
        if (circle.furthest <= reach) {
            outline.shape = Shape::disc;
            outline.diameter_m = rounded(2.0 * circle.radius);
            return outline;
        }
    }
    outline.shape = Shape::polygon;
    outline.vertices_m = corners;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec2 a = corners[k], b = corners[(k + 1) % corners.size()];
        std::string label = fmt::format("edge-{}", k);
        if (near(a.y, box.lower.y) && near(b.y, box.lower.y)) label = "bottom";
        if (near(a.y, box.upper.y) && near(b.y, box.upper.y)) label = "top";
        if (near(a.x, box.lower.x) && near(b.x, box.lower.x)) label = "left";
        if (near(a.x, box.upper.x) && near(b.x, box.upper.x)) label = "right";
        outline.edge_labels.push_back(std::move(label));
    }
    return outline;
}

FittedCells fit_cells(const GivenCellsSpec& spec, const Outline& outline, Shape shape) {
    Fitter fitter(spec, outline, shape);
    return spec.cut ? fitter.cut() : fitter.fit();
}

}  // namespace feldspar
