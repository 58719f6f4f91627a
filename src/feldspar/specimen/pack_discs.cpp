#include "feldspar/specimen/pack_discs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/base/mean.hpp"
#include "feldspar/geometry/cell_grid.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

constexpr double insertion_scale = 0.5;  // of the radius: four tenths of the area that random insertion could fill
constexpr int most_attempts = 200000;    // for one disc

/// A random place for disc `number` at the insertion scale, away from the discs in `grid` and from the outline.
Vec2 find_room(int number, const Outline& outline, const Box& box, const DiscGrid& grid, const Packing& packing,
               const std::vector<double>& scaled_radii, RandomStream& random) {
    const double radius = scaled_radii[number];
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        const double x = random.uniform(box.lower.x, box.upper.x);
        const Vec2 centre = {x, random.uniform(box.lower.y, box.upper.y)};
        if (!contains(outline, centre) || distance_to_boundary(outline, centre) < radius) continue;
        bool free = true;
        grid.for_each_near(centre, radius, [&](int other) {
            const Vec2 apart = packing.centres[other] - centre;
            const double reach = radius + scaled_radii[other];
            if (dot(apart, apart) < reach * reach) free = false;
        });
        if (free) return centre;
    }
    throw InputError({"", 0, 0, "specimen.grains.diameter"},
                     fmt::format("a grain of {:.3g} mm finds no room in the outline of {:.3g} mm2", 2e3 * packing.radii_m[number],
                                 1e6 * outline.area_m2),
                     "grains several times smaller than the narrowest part of the specimen");
}

/// Sorts the discs in horizontal rows two mean diameters high, left to right within a row.
void sort_in_rows(Packing& packing, const Box& box) {
    const std::size_t n = packing.radii_m.size();
    const double mean_radius = mean_of(packing.radii_m);
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto row = [&](std::size_t i) { return std::floor((packing.centres[i].y - box.lower.y) / (4.0 * mean_radius)); };
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
        if (row(i) != row(j)) return row(i) < row(j);
        if (packing.centres[i].x != packing.centres[j].x) return packing.centres[i].x < packing.centres[j].x;
        return i < j;
    });
    Packing sorted = packing;
    for (std::size_t k = 0; k < n; ++k) {
        sorted.centres[k] = packing.centres[order[k]];
        sorted.radii_m[k] = packing.radii_m[order[k]];
        if (!packing.phases.empty()) sorted.phases[k] = packing.phases[order[k]];
    }
    packing = std::move(sorted);
}

}  // namespace

Packing place_discs(const Outline& outline, std::span<const double> diameters_m, RandomStream& random,
                    std::span<const int> phases) {
    Packing packing;
    for (const double d : diameters_m) packing.radii_m.push_back(0.5 * d);
    if (!phases.empty()) {
        std::vector<std::size_t> order(diameters_m.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t l, std::size_t r) { return diameters_m[l] > diameters_m[r]; });
        for (const std::size_t i : order) packing.phases.push_back(phases[i]);
    }
    std::stable_sort(packing.radii_m.begin(), packing.radii_m.end(), std::greater<>());
    packing.centres.resize(packing.radii_m.size());
    std::vector<double> scaled_radii;
    for (const double r : packing.radii_m) scaled_radii.push_back(insertion_scale * r);

    const Box box = bounding_box(outline);
    DiscGrid grid(box, scaled_radii);
    for (int i = 0; i < std::ssize(packing.radii_m); ++i) {
        packing.centres[i] = find_room(i, outline, box, grid, packing, scaled_radii, random);
        grid.insert(i, packing.centres[i]);
    }
    if (!packing.centres.empty()) sort_in_rows(packing, box);
    return packing;
}

Packing pack_discs(const Outline& outline, std::span<const double> diameters_m, RandomStream& random, const StageControl& control,
                   std::span<const int> phases) {
    Packing packing = place_discs(outline, diameters_m, random, phases);
    relax_discs(packing, outline, {}, control);
    return packing;
}

}  // namespace feldspar
