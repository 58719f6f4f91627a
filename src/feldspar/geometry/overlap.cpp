#include "feldspar/geometry/overlap.hpp"

#include <algorithm>
#include <vector>

#include "feldspar/geometry/polygon.hpp"

namespace feldspar {

// Sutherland and Hodgman: what is left of the polygon behind one edge of the convex one after the other.
std::vector<Vec2> clipped(std::span<const Vec2> polygon, std::span<const Vec2> convex) {
    std::vector<Vec2> left(polygon.begin(), polygon.end()), cut;
    for (std::size_t k = 0; k < convex.size() && !left.empty(); ++k) {
        const Vec2 a = convex[k], along = convex[(k + 1) % convex.size()] - a;
        cut.clear();
        for (std::size_t i = 0; i < left.size(); ++i) {
            const Vec2 p = left[i], q = left[(i + 1) % left.size()];
            const double at_p = cross(along, p - a), at_q = cross(along, q - a);
            if (at_p >= 0.0) cut.push_back(p);
            if ((at_p >= 0.0) != (at_q >= 0.0)) cut.push_back(p + at_p / (at_p - at_q) * (q - p));
        }
        left.swap(cut);
    }
    return left;
}

double overlap_area(std::span<const Vec2> polygon, std::span<const Vec2> convex) {
    return std::max(0.0, signed_area(clipped(polygon, convex)));
}

}  // namespace feldspar
