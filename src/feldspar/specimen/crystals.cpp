#include "feldspar/specimen/crystals.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include "feldspar/geometry/polygon.hpp"

namespace feldspar {

std::vector<int> group_into_crystals(const Tessellation& cells, const Packing& crystals) {
    std::vector<int> by_height(crystals.centres.size());
    std::iota(by_height.begin(), by_height.end(), 0);
    std::stable_sort(by_height.begin(), by_height.end(),
                     [&](int l, int r) { return crystals.centres[l].y < crystals.centres[r].y; });
    // Packed discs leave no gap as wide as the largest of them: the nearest one, by power, is within two of its diameters.
    const double reach = 4.0 * *std::max_element(crystals.radii_m.begin(), crystals.radii_m.end());
    std::map<int, int> number;
    std::vector<int> crystal;
    for (int c = 0; c < std::ssize(cells.cells); ++c) {
        const Vec2 x = centroid(corners_of_cell(cells, c));
        const auto power = [&](int d) {
            const Vec2 r = x - crystals.centres[d];
            return dot(r, r) - crystals.radii_m[d] * crystals.radii_m[d];
        };
        const auto from = std::lower_bound(by_height.begin(), by_height.end(), x.y - reach,
                                           [&](int d, double y) { return crystals.centres[d].y < y; });
        int nearest = -1;
        double least = std::numeric_limits<double>::infinity();
        for (auto d = from; d != by_height.end() && crystals.centres[*d].y <= x.y + reach; ++d)
            if (const double p = power(*d); p < least) {
                least = p;
                nearest = *d;
            }
        if (nearest < 0)  // a loose packing
            for (const int d : by_height)
                if (const double p = power(d); p < least) {
                    least = p;
                    nearest = d;
                }
        crystal.push_back(number.emplace(nearest, static_cast<int>(number.size())).first->second);
    }
    return crystal;
}

}  // namespace feldspar
