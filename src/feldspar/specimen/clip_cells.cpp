#include "feldspar/specimen/clip_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <functional>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "feldspar/base/error.hpp"
#include "feldspar/base/sort_in_buckets.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/geometry/triangulate.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

/// What meets at a vertex: {i, j, l} three cells ascending; {i, j, -1 - s} two cells and segment s; {-1, -1, v} outline vertex v.
using VertexKey = std::array<int, 3>;

/// A corner of a cell that is being clipped. Edges are labelled by the neighbour (>= 0) or by -1 - side of the region.
struct Corner {
    Vec2 at;
    int before;  ///< label of the edge that arrives
    int after;   ///< label of the edge that leaves
};

/// A vertex of a finished face and the label of the edge that leaves it.
struct KeyedVertex {
    VertexKey key;
    Vec2 at;
    int label;
};

VertexKey cell_key(int i, int j, int l) {
    VertexKey key = {i, j, l};
    std::sort(key.begin(), key.end());
    return key;
}
VertexKey crossing_key(int i, int j, int segment) { return {std::min(i, j), std::max(i, j), -1 - segment}; }
VertexKey corner_key(int outline_vertex) { return {-1, -1, outline_vertex}; }

bool before_in_plane(Vec2 a, Vec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

/// The point of equal power to three discs, relative to the first for accuracy.
Vec2 power_centre(std::span<const Vec2> sites, std::span<const double> weights, const std::array<int, 3>& t) {
    const Vec2 a = sites[t[1]] - sites[t[0]];
    const Vec2 b = sites[t[2]] - sites[t[0]];
    const double ra = 0.5 * (dot(a, a) + weights[t[0]] - weights[t[1]]);
    const double rb = 0.5 * (dot(b, b) + weights[t[0]] - weights[t[2]]);
    const double inverse = 1.0 / cross(a, b);
    return sites[t[0]] + inverse * Vec2{ra * b.y - rb * a.y, a.x * rb - b.x * ra};
}

/// The whole cells, before clipping, each made when it is asked for. Far away around the sites stand auxiliary sites, so that
/// every cell is bounded; their own cells do not reach the outline.
class WholeCells {
public:
    WholeCells(std::span<const Vec2> centres, std::span<const double> weights, const Box& box)
        : sites_(centres.begin(), centres.end()), weights_(weights.begin(), weights.end()) {
        constexpr int auxiliary = 16;
        const int n = static_cast<int>(centres.size());
        const Vec2 middle = 0.5 * (box.lower + box.upper);
        const double far = 10.0 * norm(box.upper - box.lower);
        for (int k = 0; k < auxiliary; ++k) {
            const double angle = 2.0 * std::numbers::pi * (k + 0.37) / auxiliary;
            sites_.push_back(middle + far * Vec2{std::cos(angle), std::sin(angle)});
            weights_.push_back(0.0);
        }
        const RegularTriangulation triangulation = regular_triangulation(sites_, weights_);
        if (!triangulation.hidden.empty()) {
            const int i = triangulation.hidden.front();
            throw InputError({},
                             fmt::format("disc {} at ({:.6g}, {:.6g}) m is hidden by its neighbours: it has no Laguerre cell", i,
                                         sites_[i].x, sites_[i].y),
                             "discs that overlap less");
        }
        const auto for_each_spoke = [&](auto visit) {
            for (const auto& corners : triangulation.triangles)
                for (int k = 0; k < 3; ++k)
                    if (corners[k] < n) visit(corners[k], Spoke{corners[(k + 1) % 3], corners[(k + 2) % 3]});
        };
        begin_.assign(static_cast<std::size_t>(n) + 1, 0);
        for_each_spoke([&](int site, const Spoke&) { ++begin_[site + 1]; });
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        spokes_.resize(static_cast<std::size_t>(begin_.back()));
        std::vector<int> next(begin_.begin(), begin_.end() - 1);
        for_each_spoke([&](int site, const Spoke& spoke) { spokes_[next[site]++] = spoke; });
    }

    std::vector<Corner> operator()(int i) const {
        const auto first = spokes_.begin() + begin_[i], end = spokes_.begin() + begin_[i + 1];
        std::vector<Corner> cell;
        cell.reserve(static_cast<std::size_t>(end - first));
        Spoke spoke = *first;
        for (auto count = first; count != end; ++count) {
            std::array<int, 3> t = {i, spoke.from, spoke.to};
            std::sort(t.begin(), t.end());
            cell.push_back({power_centre(sites_, weights_, t), spoke.from, spoke.to});
            spoke = *std::find_if(first, end, [&](const Spoke& s) { return s.from == spoke.to; });
        }
        return cell;
    }

private:
    /// Around site a the triangle (a, b, c) leads from neighbour b to neighbour c.
    struct Spoke {
        int from, to;
    };
    std::vector<Vec2> sites_;
    std::vector<double> weights_;
    std::vector<int> begin_;  ///< sites + 1 offsets into the spokes
    std::vector<Spoke> spokes_;
};

/// Where the edge p-q crosses the line through a and b; the same bits from either direction of the edge.
Vec2 crossing_with_line(Vec2 p, Vec2 q, Vec2 a, Vec2 b) {
    if (before_in_plane(q, p)) std::swap(p, q);
    const double dp = cross(b - a, p - a), dq = cross(b - a, q - a);
    Vec2 at = p + (dp / (dp - dq)) * (q - p);
    if (a.x == b.x) at.x = a.x;
    if (a.y == b.y) at.y = a.y;
    return at;
}

/// Keeps what lies to the left of the side (its line included).
std::vector<Corner> clip_by_side(const std::vector<Corner>& cell, int side, Vec2 a, Vec2 b) {
    std::vector<char> inside;
    for (const Corner& c : cell) inside.push_back(cross(b - a, c.at - a) >= 0.0);
    const auto kept = std::count(inside.begin(), inside.end(), 1);
    if (kept == std::ssize(cell)) return cell;
    std::vector<Corner> result;
    if (kept == 0) return result;
    for (std::size_t k = 0; k < cell.size(); ++k) {
        const std::size_t next = (k + 1) % cell.size();
        const Corner& c = cell[k];
        if (inside[k]) result.push_back(c);
        if (inside[k] == inside[next]) continue;
        const Vec2 at = crossing_with_line(c.at, cell[next].at, a, b);
        result.push_back(inside[k] ? Corner{at, c.after, -1 - side} : Corner{at, -1 - side, c.after});
    }
    return result;
}

/// The index of the piece of `side` on which `at` lies.
std::size_t piece_of(const ClipSide& side, const std::vector<Vec2>& corners, Vec2 at) {
    const Vec2 along = corners[side.stops.back()] - corners[side.stops.front()];
    std::size_t piece = 0;
    while (piece + 1 < side.segments.size() && dot(at - corners[side.stops[piece + 1]], along) >= 0.0) ++piece;
    return piece;
}

/// From corners with side numbers to vertices with keys and segment labels; outline vertices inside a side are put in.
std::vector<KeyedVertex> with_keys(const std::vector<Corner>& cell, int i, const ConvexRegion& region,
                                   const std::vector<Vec2>& corners) {
    const int sides = static_cast<int>(region.size());
    std::vector<KeyedVertex> result;
    for (std::size_t k = 0; k < cell.size(); ++k) {
        const Corner& c = cell[k];
        KeyedVertex vertex{{}, c.at, c.after};
        if (c.before >= 0 && c.after >= 0) {
            vertex.key = cell_key(i, c.before, c.after);
        } else if (c.before < 0 && c.after < 0) {
            if ((-1 - c.before + 1) % sides != -1 - c.after) {
                throw NumericalError(fmt::format("cell {}: two sides of the outline meet that are not neighbours", i));
            }
            const int v = region[-1 - c.after].stops.front();
            vertex.key = corner_key(v);
            vertex.at = corners[v];
        } else {
            const ClipSide& side = region[-1 - std::min(c.before, c.after)];
            vertex.key = crossing_key(i, std::max(c.before, c.after), side.segments[piece_of(side, corners, c.at)]);
        }
        if (c.after >= 0) {
            result.push_back(vertex);
            continue;
        }
        const ClipSide& side = region[-1 - c.after];
        const Corner& next = cell[(k + 1) % cell.size()];
        const std::size_t first = c.before < 0 ? 0 : piece_of(side, corners, c.at);
        const std::size_t last = next.after < 0 ? side.segments.size() - 1 : piece_of(side, corners, next.at);
        vertex.label = outline_label(side.segments[first]);
        result.push_back(vertex);
        for (std::size_t piece = first + 1; piece <= last; ++piece) {
            const int v = side.stops[piece];
            result.push_back({corner_key(v), corners[v], outline_label(side.segments[piece])});
        }
    }
    return result;
}

/// Where the edge p-q enters and leaves the circle, in the order of the plane (smaller x first), each if it does.
std::array<std::optional<Vec2>, 2> crossings_with_circle(Vec2 p, Vec2 q, bool p_inside, bool q_inside, Vec2 centre,
                                                         double radius) {
    const bool swapped = before_in_plane(q, p);
    if (swapped) {
        std::swap(p, q);
        std::swap(p_inside, q_inside);
    }
    std::array<std::optional<Vec2>, 2> result;
    if (p_inside && q_inside) return result;
    const double length = norm(q - p);
    if (length == 0.0) return result;
    const Vec2 along = (1.0 / length) * (q - p);
    const double foot_at = dot(centre - p, along);
    const Vec2 foot = p + foot_at * along;
    const double half2 = radius * radius - dot(foot - centre, foot - centre);
    if (!p_inside && !q_inside && (foot_at <= 0.0 || foot_at >= length || half2 <= 0.0)) return result;
    const double half = std::sqrt(std::max(0.0, half2));
    const auto on_circle = [&](double offset) {
        const Vec2 out = foot + offset * along - centre;
        return centre + (radius / norm(out)) * out;
    };
    if (!p_inside) result[0] = on_circle(-half);
    if (!q_inside) result[1] = on_circle(half);
    return result;
}

// Segments in the keys of a disc's vertices: a cell's edge crosses the circle once or twice, and a flat once.
constexpr int first_crossing = 0, flat_crossing = 2;
int disc_edge_of(const VertexKey& crossing) {
    return -1 - crossing[2] < flat_crossing ? circle_edge : -1 - crossing[2] - flat_crossing + top_flat;
}

/// Keeps what lies between the flats; edges along them are labelled as the outline's.
std::vector<Corner> clip_by_flats(const std::vector<Corner>& cell, const Outline& outline) {
    const auto corners =
        flat_corners(outline);  // inside lies to the left of the top from right to left, and of the bottom from left to right
    return clip_by_side(clip_by_side(cell, top_flat, corners[1], corners[0]), bottom_flat, corners[2], corners[3]);
}

/// Clips a cell by the circle: inner vertices, and a chord from each point where the cell leaves to the next where it returns.
/// The cell of a flattened disc has been clipped by the flats before.
std::vector<KeyedVertex> clip_by_circle(const std::vector<Corner>& cell, int i, const Outline& outline) {
    std::vector<KeyedVertex> result;
    const auto own_key = [&](const Corner& c) {
        const int label = std::min(c.before, c.after);
        return label >= 0 ? cell_key(i, c.before, c.after)
                          : crossing_key(i, std::max(c.before, c.after), flat_crossing + (-1 - label) - top_flat);
    };
    const auto inside = [&](Vec2 p) {
        return dot(p - outline.centre, p - outline.centre) <= outline.radius_m * outline.radius_m;
    };
    for (std::size_t k = 0; k < cell.size(); ++k) {
        const Corner& c = cell[k];
        const Vec2 next = cell[(k + 1) % cell.size()].at;
        const bool here = inside(c.at), there = inside(next);
        if (here) result.push_back({own_key(c), c.at, c.after});
        const auto crossings = crossings_with_circle(c.at, next, here, there, outline.centre, outline.radius_m);
        const bool reversed = before_in_plane(next, c.at);
        for (int step = 0; step < 2; ++step) {
            const int which = reversed ? 1 - step : step;
            if (!crossings[which]) continue;
            // The first crossing met from outside is an entry, the one met from inside an exit to the chord.
            const bool exit = step == 1;
            const int label = exit ? outline_label(circle_edge) : c.after;
            if (c.after >= 0) {
                result.push_back({crossing_key(i, c.after, first_crossing + which), *crossings[which], label});
            } else {  // where a flat meets the circle
                const int corner = 2 * (-1 - c.after - top_flat) + which;
                result.push_back({corner_key(corner), flat_corners(outline)[static_cast<std::size_t>(corner)], label});
            }
        }
    }
    return result;
}

/// What one share of the cells has become.
struct ClippedPart {
    std::vector<std::vector<KeyedVertex>> faces;
    std::vector<int> owner;       ///< a face: its cell
    std::vector<VertexKey> keys;  ///< of its vertices, in order, each once
    std::vector<Face> numbered;
    std::exception_ptr problem;  ///< of the first cell that cannot be clipped; those behind it are left out
};

void sort_keys(ClippedPart& part) {
    for (const auto& face : part.faces) {
        for (const KeyedVertex& v : face) part.keys.push_back(v.key);
    }
    if (part.keys.empty()) return;
    int most = -1;  // those of the outline's vertices come first, whose first number is -1
    for (const VertexKey& key : part.keys) most = std::max(most, key[0]);
    sort_in_buckets(
        part.keys, static_cast<std::size_t>(most) + 2, [](const VertexKey& key) { return key[0] + 1; }, std::less<>());
    part.keys.erase(std::unique(part.keys.begin(), part.keys.end()), part.keys.end());
}

std::vector<VertexKey> all_keys(std::vector<ClippedPart>& parts) {
    std::vector<VertexKey> keys;
    for (ClippedPart& part : parts) {
        std::vector<VertexKey> more;
        more.reserve(keys.size() + part.keys.size());
        std::set_union(keys.begin(), keys.end(), part.keys.begin(), part.keys.end(), std::back_inserter(more));
        keys = std::move(more);
        part.keys = {};
    }
    return keys;
}

/// Finds the number of a key: those of one first cell are a few.
class KeyNumbers {
public:
    explicit KeyNumbers(const std::vector<VertexKey>& keys) : keys_(keys) {
        for (std::size_t k = 0; k < keys.size(); ++k)
            while (std::ssize(begin_) <= keys[k][0] + 1) begin_.push_back(k);
        begin_.push_back(keys.size());
    }
    int operator()(const VertexKey& key) const {
        const auto at = [&](int n) { return keys_.begin() + static_cast<std::ptrdiff_t>(begin_[static_cast<std::size_t>(n)]); };
        return static_cast<int>(std::lower_bound(at(key[0] + 1), at(key[0] + 2), key) - keys_.begin());
    }

private:
    const std::vector<VertexKey>& keys_;
    std::vector<std::size_t> begin_;  ///< of the keys of each first cell, the outline's vertices before them
};

/// Gives every key one number and one position.
CellGraph number_vertices(std::vector<ClippedPart>& parts, const Outline& outline, int sites, const StageControl& control) {
    const std::vector<VertexKey> keys = all_keys(parts);
    const KeyNumbers number_of(keys);
    CellGraph graph;
    graph.vertices.resize(keys.size());
    graph.place.reserve(keys.size());
    const int outline_edges = static_cast<int>(outline.vertices.size());
    for (const VertexKey& key : keys) {
        int place = place_inside;
        if (key[0] < 0 && key[1] < 0)
            place = place_corner;
        else if (key[2] < 0 && outline.is_disc)
            place = disc_edge_of(key);
        else if (key[2] < 0)
            place = -1 - key[2] < outline_edges ? -1 - key[2] : place_cut;
        if (key[2] >= sites && place != place_corner) {
            throw NumericalError("a Laguerre vertex inside the outline belongs to an auxiliary site");
        }
        graph.place.push_back(place);
    }
    in_shares(control.team, static_cast<int>(parts.size()), [&](IndexRange range, int) {
        for (int p = range.begin; p < range.end; ++p) {
            ClippedPart& part = parts[static_cast<std::size_t>(p)];
            for (std::size_t f = 0; f < part.faces.size(); ++f) {
                Face face;
                face.cell = part.owner[f];
                face.vertices.reserve(part.faces[f].size());
                face.labels.reserve(part.faces[f].size());
                for (const KeyedVertex& v : part.faces[f]) {
                    face.vertices.push_back(number_of(v.key));
                    face.labels.push_back(v.label);
                }
                part.numbered.push_back(std::move(face));
            }
        }
    });
    std::vector<char> placed(keys.size(), 0);
    std::size_t count = 0;
    for (const ClippedPart& part : parts) count += part.faces.size();
    graph.faces.reserve(count);
    for (ClippedPart& part : parts) {
        for (std::size_t f = 0; f < part.faces.size(); ++f) {
            for (std::size_t k = 0; k < part.faces[f].size(); ++k) {
                const int number = part.numbered[f].vertices[k];
                if (!placed[number]) graph.vertices[number] = part.faces[f][k].at;
                placed[number] = 1;
            }
            graph.faces.push_back(std::move(part.numbered[f]));
        }
        part = {};
    }
    return graph;
}

void reject_equal_centres(std::span<const Vec2> centres) {
    std::vector<int> order(centres.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int i, int j) { return before_in_plane(centres[i], centres[j]); });
    for (std::size_t k = 1; k < order.size(); ++k) {
        const Vec2 c = centres[order[k]];
        if (c == centres[order[k - 1]]) {
            throw InputError({},
                             fmt::format("discs {} and {} have the same centre ({:.6g}, {:.6g}) m",
                                         std::min(order[k - 1], order[k]), std::max(order[k - 1], order[k]), c.x, c.y),
                             "discs with different centres");
        }
    }
}

}  // namespace

std::vector<ConvexRegion> convex_regions(const Outline& outline) {
    const auto& corners = outline.vertices;
    const int n = static_cast<int>(corners.size());
    std::vector<std::vector<int>> parts(1);
    if (is_convex_polygon(corners)) {
        for (int k = 0; k < n; ++k) parts[0].push_back(k);
    } else {
        parts = convex_partition(corners);
    }
    std::map<std::pair<int, int>, int> cuts;  // a cut is shared by two regions
    std::vector<ConvexRegion> regions;
    for (std::vector<int>& part : parts) {
        const std::size_t m = part.size();
        const auto turns = [&](std::size_t k) {
            const Vec2 in = corners[part[k]] - corners[part[(k + m - 1) % m]],
                       out = corners[part[(k + 1) % m]] - corners[part[k]];
            return cross(in, out) > 1e-12 * norm(in) * norm(out);
        };
        std::size_t start = 0;
        while (start + 1 < m && !turns(start)) ++start;
        ConvexRegion region;
        for (std::size_t step = 0; step < m; ++step) {
            const std::size_t k = (start + step) % m;
            const int from = part[k], to = part[(k + 1) % m];
            if (step == 0 || turns(k)) region.push_back({{from}, {}});
            int segment = from;
            if (to != (from + 1) % n) {
                segment = n + cuts.emplace(std::minmax(from, to), static_cast<int>(cuts.size())).first->second;
            }
            region.back().stops.push_back(to);
            region.back().segments.push_back(segment);
        }
        regions.push_back(std::move(region));
    }
    return regions;
}

CellGraph clip_cells(std::span<const Vec2> centres, std::span<const double> weights, const Outline& outline,
                     const StageControl& control) {
    reject_equal_centres(centres);
    std::vector<ClippedPart> parts(static_cast<std::size_t>(control.team ? control.team->size() : 1));
    const auto regions = outline.is_disc ? std::vector<ConvexRegion>{} : convex_regions(outline);
    const auto add_faces = [&](ClippedPart& part, const std::vector<Corner>& whole, int i) {
        const std::size_t before = part.faces.size();
        if (outline.is_disc)
            part.faces.push_back(clip_by_circle(outline.flattened() ? clip_by_flats(whole, outline) : whole, i, outline));
        for (const ConvexRegion& region : regions) {
            std::vector<Corner> cell = whole;
            for (int s = 0; s < std::ssize(region) && !cell.empty(); ++s) {
                cell = clip_by_side(cell, s, outline.vertices[region[s].stops.front()], outline.vertices[region[s].stops.back()]);
            }
            if (cell.size() >= 3) part.faces.push_back(with_keys(cell, i, region, outline.vertices));
        }
        if (part.faces.size() == before || part.faces.back().size() < 3) {
            throw InputError({},
                             fmt::format("the Laguerre cell of disc {} at ({:.6g}, {:.6g}) m has no area inside the outline", i,
                                         centres[i].x, centres[i].y),
                             "discs inside the outline, and smaller grains if there are only a few");
        }
        part.owner.resize(part.faces.size(), i);
    };
    {
        const WholeCells cells(centres, weights, bounding_box(outline));
        in_shares(control.team, static_cast<int>(centres.size()), [&](IndexRange range, int thread) {
            ClippedPart& part = parts[static_cast<std::size_t>(thread)];
            try {
                for (int i = range.begin; i < range.end; ++i) add_faces(part, cells(i), i);
                sort_keys(part);
            } catch (...) {
                part.problem = std::current_exception();
            }
        });
    }
    for (const ClippedPart& part : parts)  // the first share that failed has the first cell that does, however many there are
        if (part.problem) std::rethrow_exception(part.problem);
    return number_vertices(parts, outline, static_cast<int>(centres.size()), control);
}

}  // namespace feldspar
