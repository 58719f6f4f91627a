#include "feldspar/geometry/segments.hpp"

#include <algorithm>

#include "feldspar/geometry/polygon.hpp"

namespace feldspar {

bool segments_cross(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    const double side_c = cross(b - a, c - a), side_d = cross(b - a, d - a);
    const double side_a = cross(d - c, a - c), side_b = cross(d - c, b - c);
    return side_c * side_d < 0.0 && side_a * side_b < 0.0;
}

double distance_between_segments(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    if (segments_cross(a, b, c, d)) return 0.0;
    return std::min(
        {distance_to_segment(a, c, d), distance_to_segment(b, c, d), distance_to_segment(c, a, b), distance_to_segment(d, a, b)});
}

}  // namespace feldspar
