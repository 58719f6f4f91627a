#include "feldspar/geometry/polygon.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "feldspar/geometry/segments.hpp"

namespace feldspar {

double signed_area(std::span<const Vec2> polygon) {
    if (polygon.size() < 3) return 0.0;
    const Vec2 origin = polygon[0];  // a near origin keeps the digits of a small polygon far from (0, 0)
    double twice = 0.0;
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) twice += cross(polygon[k] - origin, polygon[k + 1] - origin);
    return 0.5 * twice;
}

Vec2 centroid(std::span<const Vec2> polygon) {
    assert(!polygon.empty());
    const Vec2 origin = polygon[0];
    double twice = 0.0;
    Vec2 moment;
    Vec2 sum;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 a = polygon[k] - origin;
        const Vec2 b = polygon[(k + 1) % polygon.size()] - origin;
        const double c = cross(a, b);
        twice += c;
        moment += c * (a + b);
        sum += a;
    }
    if (twice == 0.0) return origin + (1.0 / static_cast<double>(polygon.size())) * sum;
    return origin + (1.0 / (3.0 * twice)) * moment;
}

namespace {

/// Do the segments a-b and c-d come closer than `tolerance`? Disjoint boxes are rejected first.
bool segments_touch(Vec2 a, Vec2 b, Vec2 c, Vec2 d, double tolerance) {
    if (std::max(a.x, b.x) + tolerance < std::min(c.x, d.x) || std::max(c.x, d.x) + tolerance < std::min(a.x, b.x)) return false;
    if (std::max(a.y, b.y) + tolerance < std::min(c.y, d.y) || std::max(c.y, d.y) + tolerance < std::min(a.y, b.y)) return false;
    return distance_between_segments(a, b, c, d) <= tolerance;
}

}  // namespace

bool is_simple_polygon(std::span<const Vec2> polygon) {
    const std::size_t n = polygon.size();
    if (n < 3) return false;
    for (const Vec2 v : polygon) {
        if (!std::isfinite(v.x) || !std::isfinite(v.y)) return false;
    }
    const Box box = bounding_box(polygon);
    const double size = norm(box.upper - box.lower);
    const double tolerance = 1e-12 * size;
    if (std::abs(signed_area(polygon)) <= 1e-12 * size * size) return false;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 a = polygon[i];
        const Vec2 b = polygon[(i + 1) % n];
        const Vec2 c = polygon[(i + 2) % n];
        if (norm(b - a) <= tolerance) return false;
        // Neighbours share b; they overlap when one folds back onto the other.
        if (distance_to_segment(c, a, b) <= tolerance || distance_to_segment(a, b, c) <= tolerance) return false;
        for (std::size_t j = i + 2; j < n; ++j) {
            if (i == 0 && j == n - 1) continue;
            if (segments_touch(a, b, polygon[j], polygon[(j + 1) % n], tolerance)) return false;
        }
    }
    return true;
}

bool contains(std::span<const Vec2> polygon, Vec2 point) {
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Vec2 a = polygon[j];
        const Vec2 b = polygon[i];
        if ((a.y > point.y) == (b.y > point.y)) continue;
        const double side = cross(b - a, point - a);
        if ((b.y > a.y) == (side > 0.0)) inside = !inside;
    }
    return inside;
}

Vec2 closest_on_segment(Vec2 point, Vec2 a, Vec2 b) {
    const Vec2 ab = b - a;
    const double length2 = dot(ab, ab);
    if (length2 == 0.0) return a;
    return a + std::clamp(dot(point - a, ab) / length2, 0.0, 1.0) * ab;
}

double distance_to_segment(Vec2 point, Vec2 a, Vec2 b) { return norm(point - closest_on_segment(point, a, b)); }

double distance_to_boundary(std::span<const Vec2> polygon, Vec2 point) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        least = std::min(least, distance_to_segment(point, polygon[j], polygon[i]));
    }
    return least;
}

bool is_convex_polygon(std::span<const Vec2> polygon) {
    const std::size_t n = polygon.size();
    for (std::size_t k = 0; k < n; ++k) {
        const Vec2 in = polygon[(k + 1) % n] - polygon[k];
        const Vec2 out = polygon[(k + 2) % n] - polygon[(k + 1) % n];
        if (cross(in, out) < -1e-12 * norm(in) * norm(out)) return false;
    }
    return true;
}

Box bounding_box(std::span<const Vec2> points) {
    assert(!points.empty());
    Box box{points[0], points[0]};
    for (const Vec2 p : points) {
        box.lower = {std::min(box.lower.x, p.x), std::min(box.lower.y, p.y)};
        box.upper = {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y)};
    }
    return box;
}

}  // namespace feldspar
