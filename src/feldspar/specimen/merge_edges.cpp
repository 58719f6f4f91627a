#include "feldspar/specimen/merge_edges.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>

#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

/// An edge in the queue, with its length at the time; the vertex numbers decide between equal lengths.
struct ShortEdge {
    double length;
    int a, b;  ///< a < b
    friend bool operator>(const ShortEdge& l, const ShortEdge& r) {
        if (l.length != r.length) return l.length > r.length;
        return l.a != r.a ? l.a > r.a : l.b > r.b;
    }
};

/// What merging would make of two vertices.
struct Meeting {
    Vec2 at;
    int place;
};

class EdgeMerger {
public:
    EdgeMerger(CellGraph& graph, const Outline& outline, double merge_length)
        : graph_(graph), outline_(outline), merge_length_(merge_length), faces_at_(graph.vertices.size()) {
        for (int f = 0; f < std::ssize(graph.faces); ++f) {
            for (const int v : graph.faces[f].vertices) faces_at_[v].push_back(f);
        }
    }

    int run() {
        for (const Face& face : graph_.faces) {
            for (std::size_t k = 0; k < face.vertices.size(); ++k) {
                const int a = face.vertices[k], b = face.vertices[(k + 1) % face.vertices.size()];
                if (a < b || face.labels[k] < 0) enqueue(a, b);
            }
        }
        int merged = 0;
        while (!queue_.empty()) {
            const ShortEdge edge = queue_.top();
            queue_.pop();
            // Out of date when an end has moved since: the edge was queued again then, if it is still short.
            if (edge.length == norm(graph_.vertices[edge.a] - graph_.vertices[edge.b]) && merge(edge.a, edge.b)) ++merged;
        }
        return merged;
    }

private:
    void enqueue(int a, int b) {
        const double length = norm(graph_.vertices[a] - graph_.vertices[b]);
        if (length < merge_length_) queue_.push({length, std::min(a, b), std::max(a, b)});
    }

    /// The label of the edge between a and b in the face, or nothing if it is not an edge of the face.
    static std::optional<int> edge_label(const Face& face, int a, int b) {
        const std::size_t n = face.vertices.size();
        for (std::size_t k = 0; k < n; ++k) {
            const int u = face.vertices[k], v = face.vertices[(k + 1) % n];
            if ((u == a && v == b) || (u == b && v == a)) return face.labels[k];
        }
        return std::nullopt;
    }

    std::optional<Meeting> meeting(int a, int b, bool edge_on_outline) const {
        const int pa = graph_.place[a], pb = graph_.place[b];
        const Vec2 xa = graph_.vertices[a], xb = graph_.vertices[b];
        const Vec2 middle = 0.5 * (xa + xb);
        if (pa == place_inside && pb == place_inside) return Meeting{middle, place_inside};
        if (pa == place_inside) return Meeting{xb, pb};
        if (pb == place_inside) return Meeting{xa, pa};
        if (!edge_on_outline || (pa == place_corner && pb == place_corner)) return std::nullopt;
        if (pa == place_corner) return Meeting{xa, pa};
        if (pb == place_corner) return Meeting{xb, pb};
        if (pa != pb) return std::nullopt;
        if (!outline_.is_disc || pa != circle_edge) return Meeting{middle, pa};
        const Vec2 out = middle - outline_.centre;
        return Meeting{outline_.centre + (outline_.radius_m / norm(out)) * out, pa};
    }

    /// The face after the merge: b replaced by a, and the edge between them gone.
    static Face replaced(const Face& face, int a, int b) {
        Face result;
        result.cell = face.cell;
        const std::size_t n = face.vertices.size();
        const auto renamed = [&](std::size_t k) { return face.vertices[k] == b ? a : face.vertices[k]; };
        for (std::size_t k = 0; k < n; ++k) {
            if (renamed(k) == renamed((k + 1) % n)) continue;
            result.vertices.push_back(renamed(k));
            result.labels.push_back(face.labels[k]);
        }
        return result;
    }

    /// Three vertices or more, each once, and the centroid well to the left of every edge: by 1 % of the root of the area.
    /// Edges of no length, which wait for their own merging, do not count.
    bool sound(const Face& face) const {
        if (face.vertices.size() < 3) return false;
        std::vector<Vec2> corners;
        for (const int v : face.vertices) {
            corners.push_back(graph_.vertices[v]);
            if (std::count(face.vertices.begin(), face.vertices.end(), v) > 1) return false;
        }
        const double area = signed_area(corners);
        if (area <= 0.0) return false;
        const Vec2 centre = centroid(corners);
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const Vec2 a = corners[k], b = corners[(k + 1) % corners.size()];
            if (cross(a - centre, b - centre) < 0.01 * norm(b - a) * std::sqrt(area) - 1e-12 * area) return false;
        }
        return true;
    }

    bool merge(int a, int b) {
        std::vector<int> affected = faces_at_[a];
        affected.insert(affected.end(), faces_at_[b].begin(), faces_at_[b].end());
        std::sort(affected.begin(), affected.end());
        affected.erase(std::unique(affected.begin(), affected.end()), affected.end());

        bool found = false, on_outline = false;
        for (const int f : affected) {
            const auto label = edge_label(graph_.faces[f], a, b);
            found = found || label.has_value();
            on_outline = on_outline || (label.has_value() && *label < 0);
        }
        if (!found) return false;
        const auto target = meeting(a, b, on_outline);
        if (!target) return false;

        const Vec2 old_a = graph_.vertices[a];
        graph_.vertices[a] = target->at;
        std::vector<Face> changed;
        for (const int f : affected) {
            changed.push_back(replaced(graph_.faces[f], a, b));
            if (!sound(changed.back())) {
                graph_.vertices[a] = old_a;
                return false;
            }
        }
        graph_.place[a] = target->place;
        for (std::size_t k = 0; k < affected.size(); ++k) graph_.faces[affected[k]] = std::move(changed[k]);
        faces_at_[a] = affected;
        faces_at_[b].clear();
        for (const int f : affected) {
            const Face& face = graph_.faces[f];
            for (std::size_t k = 0; k < face.vertices.size(); ++k) {
                const int u = face.vertices[k], v = face.vertices[(k + 1) % face.vertices.size()];
                if (u == a || v == a) enqueue(u, v);
            }
        }
        return true;
    }

    CellGraph& graph_;
    const Outline& outline_;
    double merge_length_;
    std::vector<std::vector<int>> faces_at_;  ///< a vertex: the faces that name it
    std::priority_queue<ShortEdge, std::vector<ShortEdge>, std::greater<>> queue_;
};

}  // namespace

int merge_short_edges(CellGraph& graph, const Outline& outline, double merge_length) {
    return EdgeMerger(graph, outline, merge_length).run();
}

void drop_unused_vertices(CellGraph& graph) {
    std::vector<int> number(graph.vertices.size(), -1);
    for (const Face& face : graph.faces) {
        for (const int v : face.vertices) number[v] = 0;
    }
    int used = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] < 0) continue;
        graph.vertices[used] = graph.vertices[v];
        graph.place[used] = graph.place[v];
        number[v] = used++;
    }
    graph.vertices.resize(used);
    graph.place.resize(used);
    for (Face& face : graph.faces) {
        for (int& v : face.vertices) v = number[v];
    }
}

}  // namespace feldspar
