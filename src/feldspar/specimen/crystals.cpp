#include "feldspar/specimen/crystals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "feldspar/geometry/cell_grid.hpp"
#include "feldspar/geometry/polygon.hpp"

namespace feldspar {

std::vector<int> group_into_crystals(const Tessellation& cells, const Packing& crystals) {
    std::vector<int> by_height(crystals.centres.size());
    std::iota(by_height.begin(), by_height.end(), 0);
    std::stable_sort(by_height.begin(), by_height.end(),
                     [&](int l, int r) { return crystals.centres[l].y < crystals.centres[r].y; });
    std::vector<int> place(by_height.size());  // of each disc in that order, which decides between equally near ones
    for (std::size_t k = 0; k < by_height.size(); ++k) place[by_height[k]] = static_cast<int>(k);
    // Packed discs leave no gap as wide as the largest of them: the nearest one, by power, is within two of its diameters.
    const double largest = *std::max_element(crystals.radii_m.begin(), crystals.radii_m.end()), reach = 4.0 * largest;
    CellGrid grid(bounding_box(crystals.centres), reach, crystals.centres.size());
    for (const int d : by_height) grid.insert(d, crystals.centres[d]);
    std::map<int, int> number;
    std::vector<int> crystal;
    for (int c = 0; c < std::ssize(cells.cells); ++c) {
        const Vec2 x = centroid(corners_of_cell(cells, c));
        const auto power = [&](int d) {
            const Vec2 r = x - crystals.centres[d];
            return dot(r, r) - crystals.radii_m[d] * crystals.radii_m[d];
        };
        int nearest = -1;
        double least = reach * reach - largest * largest;  // a disc beyond the reach has no less
        grid.for_each_near(x, reach, [&](int d) {
            const double p = power(d);
            if (p > least || (p == least && (nearest < 0 || place[d] > place[nearest]))) return;
            least = p;
            nearest = d;
        });
        for (const double rows : {reach, std::numeric_limits<double>::infinity()}) {  // of a loose packing: near rows, then all
            if (nearest >= 0) break;
            least = std::numeric_limits<double>::infinity();
            for (const int d : by_height)
                if (const double p = power(d); std::abs(crystals.centres[d].y - x.y) <= rows && p < least) {
                    least = p;
                    nearest = d;
                }
        }
        crystal.push_back(number.emplace(nearest, static_cast<int>(number.size())).first->second);
    }
    return crystal;
}

}  // namespace feldspar
