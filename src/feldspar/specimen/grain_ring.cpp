#include "feldspar/specimen/grain_ring.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"

namespace feldspar {
namespace {

/// A disc that stands for one or several neighbouring vertices of the cell.
struct CornerDisc {
    Vec2 centre;
    int first = 0, last = 0;  ///< cell vertices, counter-clockwise; the edges before `first` and from `last` on leave here
};

/// The edges of a cell as unit directions.
class CellEdges {
public:
    explicit CellEdges(std::span<const Vec2> corners) : corners_(corners) {
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const Vec2 chord = corners[(k + 1) % corners.size()] - corners[k];
            directions_.push_back((1.0 / norm(chord)) * chord);
        }
    }
    int count() const { return static_cast<int>(corners_.size()); }
    int before(int k) const { return (k + count() - 1) % count(); }
    Vec2 start(int k) const { return corners_[k]; }
    Vec2 direction(int k) const { return directions_[k]; }
    Vec2 inward(int k) const { return rot90(directions_[k]); }

    /// Centre of the disc in vertex k: it touches both edges, or the vertex itself where the cell bends around it.
    Vec2 in_vertex(int k, double radius) const {
        const Vec2 a = inward(before(k)), b = inward(k);
        const bool bends_around = cross(direction(before(k)), direction(k)) < 0.0;
        if (bends_around) return start(k) + (radius / norm(a + b)) * (a + b);
        return start(k) + (radius / (1.0 + dot(a, b))) * (a + b);
    }
    /// Centre of the disc that touches edges `k` and `next`, which need not meet; nothing if they do not close towards it.
    std::optional<Vec2> touching(int k, int next, double radius) const {
        const double turn = cross(direction(k), direction(next));
        if (turn < 1e-6) return std::nullopt;
        const Vec2 p = start(k) + radius * inward(k), q = start(next) + radius * inward(next);
        return p + (cross(q - p, direction(next)) / turn) * direction(k);
    }

private:
    std::span<const Vec2> corners_;
    std::vector<Vec2> directions_;
};

/// Length left on the edge between two neighbouring corner discs, negative if they have passed each other.
double room_between(const CellEdges& edges, const CornerDisc& from, const CornerDisc& to) {
    return dot(to.centre - from.centre, edges.direction(from.last));
}

/// The corner discs, joined until no two neighbours overlap too much. Fewer than three: the radius does not fit.
std::vector<CornerDisc> corner_discs(const CellEdges& edges, double radius) {
    std::vector<CornerDisc> discs;
    for (int k = 0; k < edges.count(); ++k) discs.push_back({edges.in_vertex(k, radius), k, k});
    while (discs.size() >= 3) {
        std::size_t tightest = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < discs.size(); ++i) {
            const double room = room_between(edges, discs[i], discs[(i + 1) % discs.size()]);
            if (room < least) {
                least = room;
                tightest = i;
            }
        }
        if (least >= 2.0 * radius * (1.0 - largest_particle_overlap)) break;
        const std::size_t next = (tightest + 1) % discs.size();
        CornerDisc joined = {0.5 * (discs[tightest].centre + discs[next].centre), discs[tightest].first, discs[next].last};
        if (least < 0.0) {
            const auto centre = edges.touching(edges.before(joined.first), joined.last, radius);
            if (!centre) return {};
            joined.centre = *centre;
        }
        discs[tightest] = joined;
        discs.erase(discs.begin() + static_cast<std::ptrdiff_t>(next));
    }
    return discs;
}

/// Appends the discs between two corner discs, evenly spread: as many as have room without overlap.
void add_row(GrainRing& ring, const CellEdges& edges, const CornerDisc& from, const CornerDisc& to) {
    const int k = from.last;
    const double room = room_between(edges, from, to);
    const int gaps = std::max(1, static_cast<int>(room / ring.diameter_m));
    const Vec2 first = edges.start(k) + dot(from.centre - edges.start(k), edges.direction(k)) * edges.direction(k) +
                       (0.5 * ring.diameter_m) * edges.inward(k);
    for (int i = 1; i < gaps; ++i) {
        ring.rows[k].push_back(static_cast<int>(ring.centres.size()));
        ring.centres.push_back(first + (room * i / gaps) * edges.direction(k));
        ring.radii_m.push_back(0.5 * ring.diameter_m);
        ring.places.push_back(ParticlePlace::edge);
        ring.along.push_back(edges.direction(k));
    }
}

GrainRing ring_through(const CellEdges& edges, const std::vector<CornerDisc>& discs, double diameter) {
    GrainRing ring;
    ring.diameter_m = diameter;
    ring.rows.resize(static_cast<std::size_t>(edges.count()));
    std::vector<Vec2> polygon;
    std::vector<int> numbers;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const CornerDisc& disc = discs[i];
        const int number = static_cast<int>(ring.centres.size());
        ring.centres.push_back(disc.centre);
        ring.radii_m.push_back(0.5 * diameter);
        ring.places.push_back(ParticlePlace::vertex);
        ring.along.push_back({});
        for (int k = disc.first; k != disc.last; k = (k + 1) % edges.count()) ring.rows[k] = {number};
        ring.rows[disc.last] = {number};
        add_row(ring, edges, disc, discs[(i + 1) % discs.size()]);
        numbers.push_back(number);
        polygon.push_back(disc.centre);
        ring.perimeter_m += norm(discs[(i + 1) % discs.size()].centre - disc.centre);
    }
    for (std::size_t i = 0; i < discs.size(); ++i) ring.rows[discs[i].last].push_back(numbers[(i + 1) % discs.size()]);
    ring.area_m2 = signed_area(polygon);
    return ring;
}

/// In narrow corners discs of different rows meet: takes edge discs away until none overlap too much.
/// @returns false if two corner discs do
bool clear_overlaps(GrainRing& ring) {
    const double nearest = ring.diameter_m * (1.0 - largest_particle_overlap) * (1.0 - 1e-9);
    for (int i = 0; i < std::ssize(ring.centres); ++i) {
        for (int j = i + 1; j < std::ssize(ring.centres); ++j) {
            if (norm(ring.centres[j] - ring.centres[i]) >= nearest) continue;
            if (ring.places[j] == ParticlePlace::edge) {
                erase_disc(ring, j--);
            } else if (ring.places[i] == ParticlePlace::edge) {
                erase_disc(ring, i--);
                break;
            } else {
                return false;
            }
        }
    }
    return true;
}

/// Leaves out of each row the discs that stand behind the edge or nearly so, as a disc shared with a neighbouring edge may
/// where the cell bends around a corner.
/// @returns false if a row has none left
bool clear_rows(GrainRing& ring, const CellEdges& edges) {
    for (int k = 0; k < edges.count(); ++k) {
        const auto behind = [&](int i) {
            return dot(ring.centres[i] - edges.start(k), edges.inward(k)) < 0.25 * ring.diameter_m;
        };
        std::erase_if(ring.rows[k], behind);
        if (ring.rows[k].empty()) return false;
    }
    return true;
}

bool lies_inside(std::span<const Vec2> corners, const GrainRing& ring) {
    const double radius = 0.5 * ring.diameter_m;
    return std::all_of(ring.centres.begin(), ring.centres.end(), [&](Vec2 p) {
        return contains(corners, p) && distance_to_boundary(corners, p) >= radius * (1.0 - 1e-10);
    });
}

}  // namespace

void erase_disc(GrainRing& ring, int gone) {
    ring.centres.erase(ring.centres.begin() + gone);
    ring.radii_m.erase(ring.radii_m.begin() + gone);
    ring.places.erase(ring.places.begin() + gone);
    ring.along.erase(ring.along.begin() + gone);
    for (auto& row : ring.rows) {
        std::erase(row, gone);
        for (int& i : row) i -= i > gone ? 1 : 0;
    }
}

GrainRing place_ring(std::span<const Vec2> corners, double diameter_m) {
    const CellEdges edges(corners);
    for (int trial = 0; trial < 200; ++trial, diameter_m *= 0.95) {
        const std::vector<CornerDisc> discs = corner_discs(edges, 0.5 * diameter_m);
        if (discs.size() < 3) continue;
        GrainRing ring = ring_through(edges, discs, diameter_m);
        if (ring.area_m2 > 0.0 && clear_overlaps(ring) && clear_rows(ring, edges) && lies_inside(corners, ring)) return ring;
    }
    throw NumericalError("a grain has no room for three inner particles");
}

}  // namespace feldspar
