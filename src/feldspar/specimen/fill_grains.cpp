#include "feldspar/specimen/fill_grains.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "feldspar/base/rng.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/filling_contacts.hpp"
#include "feldspar/specimen/grain_ring.hpp"
#include "feldspar/specimen/settle_particles.hpp"

namespace feldspar {
namespace {

/// c in (S8): sides of the triangles between neighbouring discs / diameter, which sets how many fit into a ring.
constexpr double mean_spacing = 1.0;

using Polygons = std::vector<std::vector<Vec2>>;

Polygons polygons_of(const Tessellation& cells) {
    Polygons polygons;
    for (int g = 0; g < std::ssize(cells.cells); ++g) polygons.push_back(corners_of_cell(cells, g));
    return polygons;
}

/// (S8): how many discs belong inside a ring, as a real number. m points inside a polygon with b points on it make 2 m + b - 2
/// triangles, here nearly equilateral ones with sides of the mean spacing. b counts the ring as if it had no loose places.
double discs_inside(const GrainRing& ring) {
    const double spacing = mean_spacing * ring.diameter_m;
    const double triangles = ring.area_m2 / (0.25 * std::sqrt(3.0) * spacing * spacing);
    return std::max(0.0, 0.5 * (triangles - ring.perimeter_m / spacing + 2.0));
}

double discs_in_all(const Polygons& polygons, double diameter) {
    double sum = 0.0;
    for (const auto& corners : polygons) {
        const GrainRing ring = place_ring(corners, diameter);
        sum += static_cast<double>(ring.centres.size()) + discs_inside(ring);
    }
    return sum;
}

/// The diameter for which the grains hold `wanted` discs, by bisection: the number falls with the diameter, but for small steps.
double diameter_for(const Polygons& polygons, double wanted) {
    double area = 0.0;
    for (const auto& corners : polygons) area += signed_area(corners);
    const double full = std::sqrt(area / wanted);  // a square lattice
    double low = 0.5 * full, high = 1.5 * full;
    for (int i = 0; i < 20; ++i) {
        const double middle = 0.5 * (low + high);
        (discs_in_all(polygons, middle) > wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// Whole numbers that are nearest to the real ones with the sum that is wanted: largest remainders are rounded up.
std::vector<int> rounded(const std::vector<double>& numbers, long wanted) {
    std::vector<int> whole;
    for (const double x : numbers) whole.push_back(static_cast<int>(x));
    const long missing = wanted - std::accumulate(whole.begin(), whole.end(), 0L);
    std::vector<int> order(numbers.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return numbers[a] - whole[a] > numbers[b] - whole[b]; });
    for (long i = 0; i < std::min(missing, static_cast<long>(order.size())); ++i) ++whole[order[static_cast<std::size_t>(i)]];
    return whole;
}

void append(const GrainRing& grain, Filling& filling, std::vector<std::vector<std::vector<int>>>& rows) {
    const int first = filling.particle_begin.back();
    filling.centres.insert(filling.centres.end(), grain.centres.begin(), grain.centres.end());
    filling.places.insert(filling.places.end(), grain.places.begin(), grain.places.end());
    filling.radii_m.insert(filling.radii_m.end(), grain.radii_m.begin(), grain.radii_m.end());
    filling.particle_begin.push_back(static_cast<int>(filling.centres.size()));
    for (const InsideContact& c : contacts_inside(grain.centres, grain.radii_m, grain.diameter_m)) {
        filling.inside.push_back({first + c.a, first + c.b});
    }
    rows.push_back(grain.rows);
    for (auto& row : rows.back()) {
        for (int& p : row) p += first;
    }
}

}  // namespace

Filling fill_grains(const Tessellation& cells, double particles_per_grain, std::uint64_t seed) {
    const Polygons polygons = polygons_of(cells);
    const double wanted = std::round(particles_per_grain * static_cast<double>(polygons.size()));
    const double diameter = diameter_for(polygons, wanted);

    std::vector<GrainRing> grains;
    std::vector<double> real_counts;
    long left = static_cast<long>(wanted);
    for (const auto& corners : polygons) {
        grains.push_back(place_ring(corners, diameter));
        real_counts.push_back(discs_inside(grains.back()));
        left -= std::ssize(grains.back().centres);
    }
    const std::vector<int> counts = rounded(real_counts, left);

    Filling filling;
    filling.particle_begin.push_back(0);
    RandomStream random(seed, "grain filling");
    std::vector<std::vector<std::vector<int>>> rows;
    for (std::size_t g = 0; g < polygons.size(); ++g) {
        fill_ring(grains[g], polygons[g], counts[g], random);
        append(grains[g], filling, rows);
    }
    join_grains(cells, rows, filling);
    return filling;
}

}  // namespace feldspar
