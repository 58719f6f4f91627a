#include "tests/growth/all_pairs.hpp"

namespace feldspar {

int near_pairs_of_all(std::span<const Vec2> points, double reach) {
    int count = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (norm(points[i] - points[j]) < reach) ++count;
    return count;
}

}  // namespace feldspar
