#include "feldspar/specimen/fill_grains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <numeric>
#include <utility>

#include "feldspar/base/error.hpp"
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
using Rows = std::vector<std::vector<std::vector<int>>>;  // of each grain and edge

Polygons polygons_of(const Tessellation& cells) {
    Polygons polygons;
    for (int g = 0; g < std::ssize(cells.cells); ++g) polygons.push_back(corners_of_cell(cells, g));
    return polygons;
}

/// Calls `work(g)` for every g of [0, count), shared out among the threads. Of the errors thrown, that of the lowest g goes on.
template <class Work>
void each(int count, Team* team, const Work& work) {
    std::vector<std::pair<int, std::exception_ptr>> errors(static_cast<std::size_t>(team ? team->size() : 1));
    in_shares(team, count, [&](IndexRange range, int thread) {
        int g = range.begin;
        try {
            for (; g < range.end; ++g) work(g);
        } catch (...) {
            errors[thread] = {g, std::current_exception()};
        }
    });
    for (const auto& [g, error] : errors) {  // shares ascend
        if (error) std::rethrow_exception(error);
    }
}

/// (S8): how many discs belong inside a ring, as a real number. m points inside a polygon with b points on it make 2 m + b - 2
/// triangles, here nearly equilateral ones with sides of the mean spacing. b counts the ring as if it had no loose places.
double discs_inside(const GrainRing& ring) {
    const double spacing = mean_spacing * ring.diameter_m;
    const double triangles = ring.area_m2 / (0.25 * std::sqrt(3.0) * spacing * spacing);
    return std::max(0.0, 0.5 * (triangles - ring.perimeter_m / spacing + 2.0));
}

double discs_in_all(const Polygons& polygons, double diameter, Team* team) {
    std::vector<double> counts(polygons.size());
    each(static_cast<int>(polygons.size()), team, [&](int g) {
        const GrainRing ring = place_ring(polygons[g], diameter);
        counts[g] = static_cast<double>(ring.centres.size()) + discs_inside(ring);
    });
    return std::accumulate(counts.begin(), counts.end(), 0.0);
}

/// A grain that is so bent or narrow that its discs must be far smaller than the common diameter may have room for millions of
/// them: it is refused.
constexpr double smallest_share = 0.05, most_inside = 10000.0;

void require_room(const Polygons& polygons, const std::vector<GrainRing>& rings, double diameter) {
    for (std::size_t g = 0; g < rings.size(); ++g) {
        if (rings[g].diameter_m >= smallest_share * diameter || discs_inside(rings[g]) <= most_inside) continue;
        const Vec2 at = centroid(polygons[g]);
        throw InputError({"", 0, 0, "specimen.grains.particles_per_grain"},
                         fmt::format("the grain at ({:.4g}, {:.4g}) mm is too narrow for inner particles of {:.3g} mm",
                                     1e3 * at.x, 1e3 * at.y, 1e3 * diameter),
                         "grains that are wider", "more particles a grain, a larger merge length, or another seed");
    }
}

/// The diameter for which the grains hold `wanted` discs, by bisection: the number falls with the diameter, but for small steps.
double diameter_for(const Polygons& polygons, double wanted, Team* team) {
    double area = 0.0;
    for (const auto& corners : polygons) area += signed_area(corners);
    const double full = std::sqrt(area / wanted);  // a square lattice
    double low = 0.5 * full, high = 1.5 * full;
    for (int i = 0; i < 20; ++i) {
        const double middle = 0.5 * (low + high);
        (discs_in_all(polygons, middle, team) > wanted ? low : high) = middle;
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

/// A grain while it is being filled.
struct Filled {
    GrainRing grain;
    RandomStream random;  ///< after the inner discs were added, or later where some were put elsewhere
    bool used_random = false;
    std::vector<InsideContact> contacts;
};

void append(const Filled& filled, Filling& filling, Rows& rows) {
    const GrainRing& grain = filled.grain;
    const int first = filling.particle_begin.back();
    filling.centres.insert(filling.centres.end(), grain.centres.begin(), grain.centres.end());
    filling.places.insert(filling.places.end(), grain.places.begin(), grain.places.end());
    filling.radii_m.insert(filling.radii_m.end(), grain.radii_m.begin(), grain.radii_m.end());
    filling.particle_begin.push_back(static_cast<int>(filling.centres.size()));
    for (const InsideContact& c : filled.contacts) filling.inside.push_back({first + c.a, first + c.b});
    rows.push_back(grain.rows);
    for (auto& row : rows.back()) {
        for (int& p : row) p += first;
    }
}

/// Fills the grains from `first` on that make a batch, side by side. All grains draw from one stream, each where the one before
/// has stopped. Adding the discs is quick and done in turn; settling seldom draws (one grain of eighteen), so all of the batch
/// settle at once as if none did, and those after one that has drawn are thrown away.
/// @returns the filled grains that count, at least one, in their order
std::vector<Filled> fill_batch(const Polygons& polygons, const std::vector<GrainRing>& rings, const std::vector<int>& counts,
                               int first, RandomStream random, Team* team) {
    const int batch = team && team->size() > 1 ? 2 * team->size() : 1;
    std::vector<Filled> filled;
    for (int g = first; g < std::min(first + batch, static_cast<int>(rings.size())); ++g) {
        GrainRing grain = rings[g];
        add_inner_discs(grain, polygons[g], counts[g], random);
        filled.push_back({std::move(grain), random, false, {}});
    }
    each(static_cast<int>(filled.size()), team, [&](int k) {
        Filled& one = filled[k];
        one.used_random = settle_discs(one.grain, polygons[first + k], one.random);
        one.contacts = contacts_inside(one.grain.centres, one.grain.radii_m, one.grain.diameter_m);
    });
    const auto drawn = std::find_if(filled.begin(), filled.end(), [](const Filled& one) { return one.used_random; });
    if (drawn != filled.end()) filled.erase(drawn + 1, filled.end());
    return filled;
}

}  // namespace

Filling fill_grains(const Tessellation& cells, double particles_per_grain, std::uint64_t seed, const StageControl& control) {
    const Polygons polygons = polygons_of(cells);
    const int grains = static_cast<int>(polygons.size());
    const double wanted = std::round(particles_per_grain * static_cast<double>(grains));
    const double diameter = diameter_for(polygons, wanted, control.team);

    std::vector<GrainRing> rings(polygons.size());
    std::vector<double> real_counts;
    long left = static_cast<long>(wanted);
    each(grains, control.team, [&](int g) { rings[g] = place_ring(polygons[g], diameter); });
    require_room(polygons, rings, diameter);
    for (const GrainRing& ring : rings) {
        real_counts.push_back(discs_inside(ring));
        left -= std::ssize(ring.centres);
    }
    const std::vector<int> counts = rounded(real_counts, left);

    Filling filling;
    filling.particle_begin.push_back(0);
    RandomStream random(seed, "grain filling");
    Rows rows;
    while (std::ssize(rows) < grains) {
        const std::vector<Filled> batch =
            fill_batch(polygons, rings, counts, static_cast<int>(rows.size()), random, control.team);
        for (const Filled& one : batch) append(one, filling, rows);
        random = batch.back().random;
        control.done(static_cast<double>(rows.size()) / grains);
    }
    join_grains(cells, rows, filling);
    return filling;
}

}  // namespace feldspar
