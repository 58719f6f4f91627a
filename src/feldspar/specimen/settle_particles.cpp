#include "feldspar/specimen/settle_particles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/fire.hpp"
#include "feldspar/specimen/repulsion.hpp"

namespace feldspar {
namespace {

/// Discs first push each other apart as if they were larger by this factor, which spreads them.
constexpr double spreading = 1.25;
/// A free disc grows, by at most `largest_growth`, until its overlaps add up to four contacts (what it takes to hold a disc
/// without friction) of this overlap / diameter.
constexpr double wanted_overlap = 0.016, largest_growth = 0.15;
constexpr double first_size = 0.92;
constexpr int growth_steps = 20;
/// Inner discs keep this many radii from the cell's edges: nearer, they would stand in a row without belonging to it.
constexpr double wall_clearance = 1.5;
/// Random places among which a disc takes the roomiest, and how often a disc that does not fit is put elsewhere.
constexpr int tries_per_disc = 12, most_moves = 5;

/// By how much discs may come closer to each other before the list of near pairs is made again / common diameter.
constexpr double skin_share = 0.4;

class Settling {
public:
    Settling(GrainRing& ring, std::span<const Vec2> corners)
        : ring_(ring),
          force_(ring.centres.size()),
          fire_(ring.centres.size(), {.shortest_step = 0.05, .steps_back = false, .farthest_move_m = 0.1 * ring.diameter_m}),
          skin_(skin_share * ring.diameter_m) {
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const Vec2 a = corners[k], b = corners[(k + 1) % corners.size()];
            walls_.push_back({a, b, norm(b - a)});
        }
    }

    /// FIRE until the largest force falls under 1e-3 diameters, or after so many steps.
    void run(double factor, int steps);

    /// Sums of each disc's overlaps with all others, in m.
    std::vector<double> overlaps();

private:
    void find_neighbours(double factor);
    bool list_is_stale(double factor) const;
    double forces(double factor);
    void push_from_walls(int i, double factor);
    void hold(int i);

    /// An edge of the cell, which has the discs on its left.
    struct Wall {
        Vec2 a, b;
        double length = 0.0;
    };

    GrainRing& ring_;
    std::vector<Wall> walls_;
    std::vector<Vec2> force_;
    Fire fire_;
    double skin_;
    std::vector<DiscPair> near_;  ///< by the second disc, then by the first
    std::vector<DistantPush> nothing_distant_;
    std::vector<Vec2> listed_at_;  ///< where the discs were and how far they reached when the list was made; empty before
    std::vector<double> listed_reach_;
};

void Settling::find_neighbours(double factor) {
    near_.clear();
    for (int i = 0; i < std::ssize(ring_.centres); ++i) {
        for (int j = i + 1; j < std::ssize(ring_.centres); ++j) {
            const Vec2 apart = ring_.centres[j] - ring_.centres[i];
            const double far = factor * (ring_.radii_m[i] + ring_.radii_m[j]) + skin_;
            if (dot(apart, apart) < far * far) near_.push_back({j, i});
        }
    }
    listed_at_ = ring_.centres;
    listed_reach_.clear();
    for (const double r : ring_.radii_m) listed_reach_.push_back(factor * r);
}

/// A pair that is not in the list overlaps at the earliest when its two discs have used up the skin, by moving or by growing.
bool Settling::list_is_stale(double factor) const {
    if (listed_at_.empty()) return true;
    int movers = 0;
    for (std::size_t i = 0; i < listed_at_.size(); ++i) {
        const Vec2 moved = ring_.centres[i] - listed_at_[i];
        const double room = 0.5 * skin_ - (factor * ring_.radii_m[i] - listed_reach_[i]);
        movers += room < 0.0 || dot(moved, moved) > room * room ? 1 : 0;
    }
    return movers > 0;
}

void Settling::push_from_walls(int i, double factor) {
    const double radius = std::max(factor * factor, wall_clearance) * ring_.radii_m[i];
    const Vec2 p = ring_.centres[i];
    for (const Wall& wall : walls_) {
        if (cross(wall.b - wall.a, p - wall.a) > radius * wall.length) continue;
        const Vec2 out = p - closest_on_segment(p, wall.a, wall.b);
        const double distance = norm(out);
        if (distance < radius && distance > 0.0) force_[i] += ((radius - distance) / distance) * out;
    }
}

/// Keeps the force on a ring disc along the edge that it may slide on; a corner disc has none.
void Settling::hold(int i) { force_[i] = dot(force_[i], ring_.along[i]) * ring_.along[i]; }

/// @returns the square of the largest force (m^2, stiffness 1)
double Settling::forces(double factor) {
    if (list_is_stale(factor)) find_neighbours(factor);
    std::fill(force_.begin(), force_.end(), Vec2{});
    push_apart(near_, ring_.centres, ring_.radii_m, factor, force_, 0, nothing_distant_);
    double largest2 = 0.0;
    for (int i = 0; i < std::ssize(ring_.centres); ++i) {
        if (ring_.places[i] == ParticlePlace::interior) {
            push_from_walls(i, factor);
        } else {
            hold(i);
        }
        largest2 = std::max(largest2, dot(force_[i], force_[i]));
    }
    return largest2;
}

void Settling::run(double factor, int steps) {
    const double enough = 1e-3 * ring_.diameter_m;
    for (int step = 0; step < steps; ++step) {
        if (forces(factor) < enough * enough) return;
        fire_.advance(ring_.centres, force_);
    }
}

std::vector<double> Settling::overlaps() {
    if (list_is_stale(1.0)) find_neighbours(1.0);
    std::vector<double> sums(ring_.centres.size());
    for (const auto [j, i] : near_) {
        const double overlap = std::max(0.0, ring_.radii_m[i] + ring_.radii_m[j] - norm(ring_.centres[j] - ring_.centres[i]));
        sums[i] += overlap;
        sums[j] += overlap;
    }
    return sums;
}

/// A random place in the cell that keeps clear of the walls and of all discs as well as any of some tries.
Vec2 roomiest_place(const GrainRing& ring, std::span<const Vec2> corners, const Box& box, RandomStream& random) {
    Vec2 best = ring.centres.front();
    double most = -1.0;
    for (int trial = 0; trial < tries_per_disc;) {
        const double x = random.uniform(box.lower.x, box.upper.x), y = random.uniform(box.lower.y, box.upper.y);
        if (!contains(corners, {x, y})) continue;
        ++trial;
        double room2 = std::numeric_limits<double>::infinity();
        for (const Vec2 c : ring.centres) {
            const Vec2 apart = c - Vec2{x, y};
            room2 = std::min(room2, dot(apart, apart));
        }
        if (room2 > most) {
            most = room2;
            best = {x, y};
        }
    }
    return best;
}

void add_inner_disc(GrainRing& ring, Vec2 place) {
    ring.centres.push_back(place);
    ring.radii_m.push_back(0.5 * ring.diameter_m);
    ring.places.push_back(ParticlePlace::interior);
    ring.along.push_back({});
}

/// The disc to take away: of the pair that overlaps most, the one that is held least; or an inner disc in the wall; or -1.
int worst_disc(const GrainRing& ring, std::span<const Vec2> corners) {
    int worst = -1;
    double most = largest_particle_overlap * ring.diameter_m * (1.0 + 1e-6);
    for (int i = 0; i < std::ssize(ring.centres); ++i) {
        for (int j = i + 1; j < std::ssize(ring.centres); ++j) {
            const double overlap = ring.radii_m[i] + ring.radii_m[j] - norm(ring.centres[j] - ring.centres[i]);
            if (overlap <= most) continue;
            most = overlap;
            worst = ring.places[j] < ring.places[i] ? j : i;
        }
    }
    if (worst >= 0) return worst;
    for (int i = 0; i < std::ssize(ring.centres); ++i) {
        const Vec2 p = ring.centres[i];
        if (!contains(corners, p) || distance_to_boundary(corners, p) < ring.radii_m[i] * (1.0 - 1e-10)) return i;
    }
    return -1;
}

/// Moves inner discs that still press into a wall off it.
void clear_walls(GrainRing& ring, std::span<const Vec2> corners) {
    for (int i = 0; i < std::ssize(ring.centres); ++i) {
        if (ring.places[i] != ParticlePlace::interior) continue;
        const double radius = ring.radii_m[i];
        for (int sweep = 0; sweep < 20; ++sweep) {
            for (std::size_t k = 0; k < corners.size(); ++k) {
                Vec2& p = ring.centres[i];
                const Vec2 nearest = closest_on_segment(p, corners[k], corners[(k + 1) % corners.size()]);
                const double distance = norm(p - nearest);
                if (distance < radius && distance > 0.0) p = nearest + (radius / distance) * (p - nearest);
            }
        }
    }
}

/// Changes the radius of a free disc; an edge disc stays in touch with its edge.
void resize(GrainRing& ring, int i, double radius) {
    ring.centres[i] += (radius - ring.radii_m[i]) * rot90(ring.along[i]);
    ring.radii_m[i] = radius;
}

/// Gives each free disc the size at which it is just held by its neighbours, and lets all settle.
void grow_discs(GrainRing& ring, std::span<const Vec2> corners) {
    const double d = ring.diameter_m;
    for (int i = 0; i < std::ssize(ring.centres); ++i) {
        if (ring.places[i] == ParticlePlace::interior) resize(ring, i, 0.5 * first_size * d);
    }
    Settling settling(ring, corners);
    for (int step = 0; step < growth_steps; ++step) {
        settling.run(1.0, 20);
        const std::vector<double> overlap = settling.overlaps();
        for (int i = 0; i < std::ssize(ring.centres); ++i) {
            if (ring.places[i] == ParticlePlace::vertex) continue;
            const double missing = wanted_overlap - overlap[i] / (4.0 * d);
            const double size = 2.0 * ring.radii_m[i] / d + std::clamp(missing, -0.03, 0.02);
            resize(ring, i, 0.5 * d * std::clamp(size, 1.0 - largest_growth, 1.0 + largest_growth));
        }
    }
    settling.run(1.0, 100);
}

}  // namespace

void add_inner_discs(GrainRing& ring, std::span<const Vec2> corners, int count, RandomStream& random) {
    const Box box = bounding_box(corners);
    for (int i = 0; i < count; ++i) add_inner_disc(ring, roomiest_place(ring, corners, box, random));
}

bool settle_discs(GrainRing& ring, std::span<const Vec2> corners, RandomStream& random) {
    const Box box = bounding_box(corners);
    bool used = false;
    Settling(ring, corners).run(spreading, 60);
    for (int moves = most_moves;; --moves) {
        grow_discs(ring, corners);
        clear_walls(ring, corners);
        const int worst = worst_disc(ring, corners);
        if (worst < 0 || ring.places[worst] == ParticlePlace::vertex) return used;
        const bool inner = ring.places[worst] == ParticlePlace::interior;
        erase_disc(ring, worst);
        if (!inner || moves <= 0) continue;
        add_inner_disc(ring, roomiest_place(ring, corners, box, random));
        used = true;
    }
}

}  // namespace feldspar
