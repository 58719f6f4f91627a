#include "feldspar/specimen/repulsion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace feldspar {
namespace {

/// Pairs that are looked at together: enough to fill the pipelines, few enough for the innermost cache.
constexpr int chunk = 256;

/// The overlapping pairs of a chunk, a column each.
struct Overlapping {
    // One place more than pairs: every pair is written, those that count are kept.
    std::array<DiscPair, chunk + 1> discs;
    std::array<Vec2, chunk + 1> apart;        ///< from the second centre to the first, m
    std::array<double, chunk + 1> reach;      ///< m; then the force / distance
    std::array<double, chunk + 1> distance2;  ///< m^2
    int count = 0;
    bool coincident = false;  ///< some centres may lie in one place
};

// Whether a pair overlaps is hard to guess and a wrong guess costs more than the pair, so there is no branch.
void collect(std::span<const DiscPair> pairs, std::span<const Vec2> centres, std::span<const double> radii_m, double factor,
             Overlapping& found) {
    int n = 0, coincident = 0;
    for (const DiscPair pair : pairs) {
        const Vec2 apart = centres[pair.a] - centres[pair.b];
        const double reach = factor * (radii_m[pair.a] + radii_m[pair.b]);
        const double distance2 = dot(apart, apart);
        found.apart[n] = apart;
        found.reach[n] = reach;
        found.distance2[n] = distance2;
        found.discs[n] = pair;
        coincident |= distance2 == 0.0 ? 1 : 0;
        n += distance2 < reach * reach ? 1 : 0;
    }
    found.count = n;
    found.coincident = coincident != 0;
}

// From the reach to the force / distance; roots and quotients side by side in vectors.
void find_forces(std::span<const double> radii_m, double factor, Overlapping& found) {
    const int count = found.count;  // a count of its own, without which the loop is not turned into vectors
    double* reach = found.reach.data();
    const double* distance2 = found.distance2.data();
    for (int k = 0; k < count; ++k) {
        const double distance = std::sqrt(distance2[k]);
        reach[k] = (reach[k] - distance) / distance;
    }
    if (!found.coincident) return;
    for (int k = 0; k < count; ++k) {
        if (found.distance2[k] != 0.0) continue;
        found.apart[k] = {1.0, 0.0};  // any direction will do as long as it is always the same
        found.reach[k] = factor * (radii_m[found.discs[k].a] + radii_m[found.discs[k].b]);
    }
}

}  // namespace

void push_apart(std::span<const DiscPair> pairs, std::span<const Vec2> centres, std::span<const double> radii_m, double factor,
                std::span<Vec2> forces, int first_own, std::vector<DistantPush>& distant) {
    Overlapping found;
    while (!pairs.empty()) {
        const std::size_t size = std::min<std::size_t>(pairs.size(), chunk);
        collect(pairs.first(size), centres, radii_m, factor, found);
        find_forces(radii_m, factor, found);
        for (int k = 0; k < found.count; ++k) {
            const Vec2 force = found.reach[k] * found.apart[k];
            const auto [a, b] = found.discs[k];
            forces[a] += force;
            if (b >= first_own) {
                forces[b] -= force;
            } else {
                distant.push_back({b, -force});
            }
        }
        pairs = pairs.subspan(size);
    }
}

}  // namespace feldspar
