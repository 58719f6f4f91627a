// Relaxation of a packing of overlapping discs; the method stands in pack_discs.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/base/mean.hpp"
#include "feldspar/geometry/cell_grid.hpp"
#include "feldspar/specimen/fire.hpp"
#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/pack_discs.hpp"
#include "feldspar/specimen/repulsion.hpp"

namespace feldspar {
namespace {

/// By how much discs may come closer to each other before the list of near pairs, or that of far ones, is made again / mean
/// diameter. A few loose discs fly about to the last, so the near list, which costs in every step, is short and often sifted from
/// the far one, for which the discs must be searched.
constexpr double near_skin_share = 0.2, far_skin_share = 1.3;
/// A distribution is wide when its largest disc is more than so many times its smallest. In a wide one large discs, which overlap
/// by many radii of the small ones at first, would gather speed, fly out through the outline and carry small ones along: so no
/// disc keeps more speed than the farthest move needs, and masses grow with the near discs. Others are relaxed without either.
constexpr double wide_ratio = 8.0;
/// In a wide distribution, a disc's mass is its number of near discs over this, at least 1. A contact has stiffness 1, so a large
/// disc among many small ones would otherwise swing faster than a step of FIRE can follow (fire.cpp).
constexpr int near_per_mass = 12;
/// Discs whose sums are taken together, in the order of the discs: fixed, so that sums do not depend on the number of threads.
constexpr int block = 1024;

/// What one thread has of the neighbours: the discs of its share, each with those of lower number near it.
struct Share {
    IndexRange discs;
    std::vector<DiscPair> far;         ///< pairs from which the near ones are sifted, in the same order
    std::vector<DiscPair> near;        ///< by the first disc, then by the second: forces are added in this order
    std::vector<DistantPush> distant;  ///< forces on discs of the shares before, in the order of the pairs
};

/// Pairs of a disc and a piece of the outline that may touch before the lists are made again.
struct NearWall {
    int disc = 0;
    int wall = 0;  ///< edge k as k (circle_edge and flats of a disc first), re-entrant corner k as -1 - k; whole_boundary for a
                   ///< disc that has got outside

    static constexpr int whole_boundary = std::numeric_limits<int>::min();
    static constexpr int arc =
        whole_boundary +
        1;  ///< of a half disc: as a circle, since two edges of its polygon would both push near their common corner
};

/// A straight piece of the boundary, with the rock to its left.
struct WallEdge {
    Vec2 from, to;
    int before = 0, next = 0;  ///< edges
};

/// Those of the polygon and of what is packed around, loop by loop.
std::vector<WallEdge> wall_edges(const Outline& outline) {
    std::vector<WallEdge> edges;
    const auto add = [&](const std::vector<Vec2>& loop) {
        const int first = static_cast<int>(edges.size()), n = static_cast<int>(loop.size());
        for (int k = 0; k < n; ++k) edges.push_back({loop[k], loop[(k + 1) % n], first + (k + n - 1) % n, first + (k + 1) % n});
    };
    if (!outline.is_disc) add(outline.vertices);
    for (const Cutout& cutout : outline.cutouts) {
        if (cutout.packed_around) add({cutout.vertices.rbegin(), cutout.vertices.rend()});
    }
    return edges;
}

/// Sums over the contacts; the stiffness is 1, so a force is an overlap (m).
struct Sums {
    double overlap = 0.0;
    double largest_overlap = 0.0;
    double unbalanced = 0.0;  ///< of the lengths of the forces on the discs
    long touching = 0;

    void touch(double by) {
        overlap += by;
        largest_overlap = std::max(largest_overlap, by);
        ++touching;
    }
    void operator+=(const Sums& o) {
        overlap += o.overlap;
        largest_overlap = std::max(largest_overlap, o.largest_overlap);
        unbalanced += o.unbalanced;
        touching += o.touching;
    }
};

class Relaxation {
public:
    Relaxation(Packing& packing, const Outline& outline, const StageControl& control)
        : outline_(outline),
          control_(control),
          centres_(packing.centres),
          radii_(packing.radii_m),
          count_(static_cast<int>(radii_.size())),
          force_(radii_.size()),
          grid_(bounding_box(outline), radii_),
          shares_(static_cast<std::size_t>(control.team ? control.team->size() : 1)) {
        const auto [least, largest] = std::minmax_element(radii_.begin(), radii_.end());
        smallest_radius_ = *least;
        largest_radius_ = *largest;
        mean_diameter_ = 2.0 * mean_of(radii_);
        skin_ = near_skin_share * mean_diameter_;
        far_skin_ = far_skin_share * mean_diameter_;
        edges_ = wall_edges(outline);
        has_arc_ = !outline.is_disc && outline.radius_m > 0.0;
        first_edge_ = outline.is_disc ? bottom_flat + 1 : 0;
        const bool packed_around = std::any_of(outline.cutouts.begin(), outline.cutouts.end(),
                                               [](const Cutout& cutout) { return cutout.packed_around; });
        convex_ = !packed_around && (outline.is_disc || is_convex_polygon(outline.vertices));
    }

    void run(const RelaxationCriterion& criterion, Packing& packing);

private:
    void search_far();
    void search_far(Share& share) const;
    void sift_near();
    void find_walls();
    void call_back();
    bool wide() const { return largest_radius_ > wide_ratio * smallest_radius_; }
    void choose_masses();
    const std::vector<Vec2>& accelerations();
    bool moved_beyond(double distance, const std::vector<Vec2>& since) const;
    void forces();
    double wall_overlap(NearWall pair, Vec2& inward) const;
    Sums measure() const;
    Sums measure(IndexRange discs) const;
    void tell(double residual, double wanted);

    const Outline& outline_;
    const StageControl& control_;
    std::vector<Vec2>& centres_;
    const std::vector<double>& radii_;
    int count_;
    std::vector<Vec2> force_;                    ///< m (stiffness 1)
    std::vector<double> inverse_mass_;           ///< a disc; empty where all are 1
    std::vector<Vec2> acceleration_;             ///< m, where masses differ
    std::vector<Vec2> sifted_at_, searched_at_;  ///< where the discs were when the lists were made; empty before
    DiscGrid grid_;
    std::vector<Share> shares_;  ///< one a thread
    std::vector<WallEdge> edges_;
    bool has_arc_ = false;  ///< a half disc
    int first_edge_ = 0;    ///< number of edges_[0] as a wall
    std::vector<NearWall> walls_;
    double smallest_radius_ = 0.0, largest_radius_ = 0.0;
    double mean_diameter_ = 0.0;
    double skin_ = 0.0, far_skin_ = 0.0;
    double first_residual_ = 0.0, share_done_ = 0.0;
    bool convex_ = true;
};

void Relaxation::search_far(Share& share) const {
    share.far.clear();
    for (int i = share.discs.begin; i < share.discs.end; ++i) {
        const std::ptrdiff_t before = std::ssize(share.far);
        grid_.for_each_near(centres_[i], radii_[i] + far_skin_, [&](int j) {
            const double reach = radii_[i] + radii_[j] + far_skin_;
            const Vec2 apart = centres_[i] - centres_[j];
            if (j < i && dot(apart, apart) < reach * reach) share.far.push_back({i, j});
        });
        std::sort(share.far.begin() + before, share.far.end(), [](DiscPair l, DiscPair r) { return l.b < r.b; });
    }
}

void Relaxation::search_far() {
    grid_.clear();
    for (int i = 0; i < count_; ++i) grid_.insert(i, centres_[i]);
    in_shares(control_.team, count_, [&](IndexRange discs, int thread) {
        shares_[thread].discs = discs;
        search_far(shares_[thread]);
    });
    searched_at_ = centres_;
}

void Relaxation::sift_near() {
    if (moved_beyond(0.5 * (far_skin_ - skin_), searched_at_)) search_far();
    in_shares(control_.team, count_, [&](IndexRange, int thread) {
        Share& share = shares_[thread];
        share.near.resize(share.far.size());
        std::size_t count = 0;
        for (const DiscPair pair : share.far) {
            const double reach = radii_[pair.a] + radii_[pair.b] + skin_;
            const Vec2 apart = centres_[pair.a] - centres_[pair.b];
            share.near[count] = pair;
            count += dot(apart, apart) < reach * reach ? 1 : 0;
        }
        share.near.resize(count);
    });
    find_walls();
    if (wide()) choose_masses();
    sifted_at_ = centres_;
}

void Relaxation::choose_masses() {
    std::vector<int> near(radii_.size(), 0);
    for (const Share& share : shares_) {
        for (const DiscPair pair : share.near) {
            ++near[pair.a];
            ++near[pair.b];
        }
    }
    inverse_mass_.clear();
    for (const int count : near) inverse_mass_.push_back(std::min(1.0, static_cast<double>(near_per_mass) / std::max(1, count)));
}

const std::vector<Vec2>& Relaxation::accelerations() {
    if (inverse_mass_.empty()) return force_;
    acceleration_.resize(force_.size());
    for (std::size_t i = 0; i < force_.size(); ++i) acceleration_[i] = inverse_mass_[i] * force_[i];
    return acceleration_;
}

void Relaxation::find_walls() {
    walls_.clear();
    if (outline_.is_disc) {
        for (int i = 0; i < count_; ++i) {
            if (norm(centres_[i] - outline_.centre) + radii_[i] + skin_ > outline_.radius_m) walls_.push_back({i, circle_edge});
            if (!outline_.flattened() ||
                std::abs(centres_[i].y - outline_.centre.y) + radii_[i] + skin_ <= outline_.flat_height_m)
                continue;
            walls_.push_back({i, centres_[i].y > outline_.centre.y ? top_flat : bottom_flat});
        }
        if (edges_.empty()) return;
    }
    const double far = largest_radius_ + skin_;
    const int arc_end = has_arc_ ? static_cast<int>(outline_.vertices.size()) : 0;  // edge 0 is the flat
    for (int i = 0; has_arc_ && i < count_; ++i) {
        if (norm(centres_[i] - outline_.centre) + radii_[i] + skin_ > outline_.radius_m) walls_.push_back({i, NearWall::arc});
    }
    for (int k = 0; k < std::ssize(edges_); ++k) {
        if (k > 0 && k < arc_end) continue;
        const Vec2 a = edges_[k].from, b = edges_[k].to, c = edges_[edges_[k].next].to;
        const bool reentrant = cross(b - a, c - b) < 0.0;
        const Vec2 lower = {std::min(a.x, b.x) - far, std::min(a.y, b.y) - far},
                   upper = {std::max(a.x, b.x) + far, std::max(a.y, b.y) + far};
        const std::ptrdiff_t before = std::ssize(walls_);
        for (int i = 0; i < count_; ++i) {
            const Vec2 p = centres_[i];
            if (p.x < lower.x || p.x > upper.x || p.y < lower.y || p.y > upper.y) continue;
            if (distance_to_segment(p, a, b) < radii_[i] + skin_) walls_.push_back({i, first_edge_ + k});
        }
        const std::ptrdiff_t end = std::ssize(walls_);
        for (std::ptrdiff_t w = before; reentrant && w < end; ++w) {
            const int i = walls_[w].disc;
            if (norm(centres_[i] - b) < radii_[i] + skin_) walls_.push_back({i, -1 - edges_[k].next});
        }
    }
    call_back();
}

/// A small disc that large ones have squeezed far out, or past a corner, faces no edge any more.
void Relaxation::call_back() {
    const Box box = bounding_box(outline_);
    std::vector<int> outside;  // in the order of the discs
    for (int i = 0; i < count_; ++i) {
        const Vec2 p = centres_[i];
        const bool in_box = p.x > box.lower.x && p.x < box.upper.x && p.y > box.lower.y && p.y < box.upper.y;
        if (!in_box || (!convex_ && !contains(outline_, p))) outside.push_back(i);
    }
    if (outside.empty()) return;
    std::vector<bool> faced(radii_.size(), false);
    Vec2 inward;
    for (const NearWall pair : walls_) {
        if (wall_overlap(pair, inward) > 0.0) faced[pair.disc] = true;
    }
    for (const int i : outside) {
        if (!faced[i] && !contains(outline_, centres_[i])) walls_.push_back({i, NearWall::whole_boundary});
    }
}

bool Relaxation::moved_beyond(double distance, const std::vector<Vec2>& since) const {
    if (since.empty()) return true;
    std::atomic<bool> beyond = false;
    in_shares(control_.team, count_, [&](IndexRange discs, int) {
        int movers = 0;
        for (int i = discs.begin; i < discs.end; ++i) {
            const Vec2 moved = centres_[i] - since[i];
            movers += dot(moved, moved) > distance * distance ? 1 : 0;
        }
        if (movers > 0) beyond = true;
    });
    return beyond;
}

/// How far the disc overlaps the piece of the outline (m), 0 if it does not, and the direction back.
double Relaxation::wall_overlap(NearWall pair, Vec2& inward) const {
    const Vec2 centre = centres_[pair.disc];
    const double radius = radii_[pair.disc];
    if (outline_.is_disc && (pair.wall == top_flat || pair.wall == bottom_flat)) {
        const double outward = pair.wall == top_flat ? 1.0 : -1.0;
        inward = {0.0, -outward};
        return std::max(0.0, outward * (centre.y - outline_.centre.y) + radius - outline_.flat_height_m);
    }
    if (pair.wall == NearWall::arc || (outline_.is_disc && pair.wall == circle_edge)) {
        const Vec2 out = centre - outline_.centre;
        const double distance = norm(out);
        const double overlap = distance + radius - outline_.radius_m;
        if (overlap <= 0.0 || distance == 0.0) return 0.0;
        inward = (-1.0 / distance) * out;
        return overlap;
    }
    if (pair.wall == NearWall::whole_boundary) {
        if (contains(outline_, centre)) return 0.0;
        double nearest = std::numeric_limits<double>::infinity();
        for (const WallEdge& edge : edges_) {
            const Vec2 a = edge.from, ab = edge.to - a;
            const Vec2 back = a + std::clamp(dot(centre - a, ab) / dot(ab, ab), 0.0, 1.0) * ab - centre;
            if (const double distance = norm(back); distance < nearest && distance > 0.0) {
                nearest = distance;
                inward = (1.0 / distance) * back;
            }
        }
        return radius + nearest;
    }
    if (pair.wall < 0) {  // a re-entrant corner, where neither edge is faced
        const WallEdge& edge = edges_[static_cast<std::size_t>(-1 - pair.wall)];
        const Vec2 before = edge.from - edges_[static_cast<std::size_t>(edge.before)].from, after = edge.to - edge.from;
        const Vec2 apart = centre - edge.from;
        const double distance = norm(apart);
        if (dot(apart, before) < 0.0 || dot(apart, after) > 0.0 || distance >= radius || distance == 0.0) return 0.0;
        inward = (1.0 / distance) * apart;
        return radius - distance;
    }
    const WallEdge& edge = edges_[static_cast<std::size_t>(pair.wall - first_edge_)];
    const Vec2 a = edge.from;
    const Vec2 ab = edge.to - a;
    const double length = norm(ab);
    const Vec2 along = (1.0 / length) * ab;
    const double position = dot(centre - a, along);
    const double height = cross(along, centre - a);  // positive inside
    if (position < 0.0 || position > length || height >= radius) return 0.0;
    // A centre beyond the edge is pushed back in, unless a non-convex outline has another arm there, to which it belongs.
    if (height <= 0.0 && !convex_ && contains(outline_, centre)) return 0.0;
    inward = rot90(along);
    return radius - height;
}

/// Forces of the pairs in the order of their discs, whoever computes them: each thread adds those between its own discs, and
/// hands those on discs of earlier shares over to their owners, who add them after their own. Then the walls.
void Relaxation::forces() {
    if (moved_beyond(0.5 * skin_, sifted_at_)) sift_near();
    in_shares(control_.team, count_, [&](IndexRange discs, int thread) {
        Share& share = shares_[thread];
        share.distant.clear();
        std::fill(force_.begin() + discs.begin, force_.begin() + discs.end, Vec2{});
        push_apart(share.near, centres_, radii_, 1.0, force_, discs.begin, share.distant);
    });
    in_shares(control_.team, count_, [&](IndexRange discs, int thread) {
        for (std::size_t later = static_cast<std::size_t>(thread) + 1; later < shares_.size(); ++later) {
            for (const DistantPush& push : shares_[later].distant) {
                if (push.disc >= discs.begin && push.disc < discs.end) force_[push.disc] += push.force;
            }
        }
    });
    for (const NearWall pair : walls_) {
        Vec2 inward;
        const double overlap = wall_overlap(pair, inward);
        if (overlap > 0.0) force_[pair.disc] += overlap * inward;
    }
}

/// Sums over a block of discs: their forces, and their overlaps with discs of lower number.
Sums Relaxation::measure(IndexRange discs) const {
    Sums sums;
    const auto at = std::find_if(shares_.begin(), shares_.end(), [&](const Share& s) { return discs.begin < s.discs.end; });
    for (auto share = at; share != shares_.end() && share->discs.begin < discs.end; ++share) {
        auto pair =
            std::lower_bound(share->near.begin(), share->near.end(), discs.begin, [](DiscPair p, int i) { return p.a < i; });
        for (; pair != share->near.end() && pair->a < discs.end; ++pair) {
            const Vec2 apart = centres_[pair->a] - centres_[pair->b];
            const double reach = radii_[pair->a] + radii_[pair->b], distance2 = dot(apart, apart);
            if (distance2 < reach * reach) sums.touch(reach - std::sqrt(distance2));
        }
    }
    for (int i = discs.begin; i < discs.end; ++i) sums.unbalanced += norm(force_[i]);
    return sums;
}

Sums Relaxation::measure() const {
    const int blocks = (count_ + block - 1) / block;
    std::vector<Sums> parts(static_cast<std::size_t>(blocks));
    in_shares(control_.team, blocks, [&](IndexRange range, int) {
        for (int k = range.begin; k < range.end; ++k)
            parts[k] = measure(IndexRange{k * block, std::min(count_, (k + 1) * block)});
    });
    Sums sums;
    for (const Sums& part : parts) sums += part;
    for (const NearWall pair : walls_) {
        Vec2 inward;
        const double overlap = wall_overlap(pair, inward);
        if (overlap > 0.0) sums.touch(overlap);
    }
    return sums;
}

/// The residual falls by and large as a power of the steps, with ups and downs: the share done is told on its logarithm, and
/// never falls.
void Relaxation::tell(double residual, double wanted) {
    first_residual_ = std::max(first_residual_, residual);
    if (residual > wanted && wanted > 0.0 && first_residual_ > wanted) {
        share_done_ = std::max(share_done_, std::log(first_residual_ / residual) / std::log(first_residual_ / wanted));
    }
    control_.done(share_done_);
}

void Relaxation::run(const RelaxationCriterion& criterion, Packing& packing) {
    Fire fire(radii_.size(),
              {.shortest_step = 0.01, .steps_back = true, .farthest_move_m = 0.1 * smallest_radius_, .forget_speed = wide()});
    for (int step = 0; step <= criterion.most_steps; ++step) {
        forces();
        if (step % 10 != 0) {  // the criterion costs another look at all pairs, so it is judged at every tenth step
            fire.advance(centres_, accelerations(), control_.team);
            continue;
        }
        const Sums sums = measure();
        const double contacts = static_cast<double>(std::max(1L, sums.touching));
        const double contact_force = sums.overlap / contacts;
        packing.residual = contact_force > 0.0 ? sums.unbalanced / static_cast<double>(count_) / contact_force : 0.0;
        packing.overlap_mean = contact_force / mean_diameter_;
        packing.overlap_max = sums.largest_overlap / mean_diameter_;
        packing.relaxation_steps = step;
        if (packing.residual <= criterion.residual || packing.overlap_mean <= criterion.loose_overlap) return;
        tell(packing.residual, criterion.residual);
        fire.advance(centres_, accelerations(), control_.team);
    }
    throw NumericalError(
        fmt::format("the relaxation of the packing stopped after {} steps at a residual of {:.2e} (allowed {:.1e})",
                    criterion.most_steps, packing.residual, criterion.residual));
}

}  // namespace

void relax_discs(Packing& packing, const Outline& outline, const RelaxationCriterion& criterion, const StageControl& control) {
    if (packing.centres.empty()) return;
    Relaxation(packing, outline, control).run(criterion, packing);
    for (std::size_t i = 0; i < packing.centres.size(); ++i) {
        if (!contains(outline, packing.centres[i])) {
            throw NumericalError(fmt::format("disc {} left the outline during the relaxation, at ({:.6g}, {:.6g}) m", i,
                                             packing.centres[i].x, packing.centres[i].y));
        }
    }
}

}  // namespace feldspar
