// Relaxation of a packing of overlapping discs; the method stands in pack_discs.hpp.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/cell_grid.hpp"
#include "feldspar/specimen/fire.hpp"
#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/pack_discs.hpp"

namespace feldspar {
namespace {

/// Pairs that may touch before the list is made again: pairs of discs, and pairs of a disc and a piece of the outline.
struct NearList {
    std::vector<int> begin;    ///< discs + 1 offsets into other
    std::vector<int> other;    ///< the discs of lower number near each disc
    std::vector<int> at_wall;  ///< discs near a piece of the outline ...
    std::vector<int> wall;     ///< ... and that piece: edge k as k, re-entrant corner k as -1 - k; 0 on a circle
};

/// Sums of one evaluation of the forces; the stiffness is 1, so a force is an overlap (m).
struct Sums {
    double overlap = 0.0;
    double largest_overlap = 0.0;
    long touching = 0;
};

class Relaxation {
public:
    Relaxation(Packing& packing, const Outline& outline)
        : outline_(outline),
          centres_(packing.centres),
          radii_(packing.radii_m),
          box_(bounding_box(outline)),
          force_(radii_.size()),
          grid_(box_, radii_) {
        smallest_radius_ = *std::min_element(radii_.begin(), radii_.end());
        mean_diameter_ = 2.0 * std::accumulate(radii_.begin(), radii_.end(), 0.0) / static_cast<double>(radii_.size());
        skin_ = 0.15 * mean_diameter_;
        convex_ = outline.is_disc || is_convex_polygon(outline.vertices);
    }

    void run(const RelaxationCriterion& criterion, Packing& packing);

private:
    void find_neighbours();
    void find_walls();
    bool list_is_stale() const;
    Sums forces();
    void push_apart(int i, Vec2& force, Sums& sums);
    void push_from_wall(int i, int wall, Sums& sums);
    void push(int i, Vec2 direction, double overlap, Sums& sums) {
        force_[i] += overlap * direction;
        sums.overlap += overlap;
        sums.largest_overlap = std::max(sums.largest_overlap, overlap);
        ++sums.touching;
    }
    double mean_unbalanced_force() const {
        double sum = 0.0;
        for (const Vec2 f : force_) sum += norm(f);
        return sum / static_cast<double>(force_.size());
    }

    const Outline& outline_;
    std::vector<Vec2>& centres_;
    const std::vector<double>& radii_;
    Box box_;
    std::vector<Vec2> force_;     ///< m (stiffness 1)
    std::vector<Vec2> listed_at_;
    DiscGrid grid_;
    NearList near_;
    double smallest_radius_ = 0.0;
    double mean_diameter_ = 0.0;
    double skin_ = 0.0;
    bool convex_ = true;
};

void Relaxation::find_neighbours() {
    near_.begin.assign(1, 0);
    near_.other.clear();
    grid_.clear();
    for (int i = 0; i < std::ssize(radii_); ++i) {
        grid_.for_each_near(centres_[i], radii_[i] + skin_, [&](int j) {
            const double reach = radii_[i] + radii_[j] + skin_;
            const Vec2 apart = centres_[i] - centres_[j];
            if (dot(apart, apart) < reach * reach) near_.other.push_back(j);
        });
        std::sort(near_.other.begin() + near_.begin.back(), near_.other.end());
        near_.begin.push_back(static_cast<int>(near_.other.size()));
        grid_.insert(i, centres_[i]);
    }
    find_walls();
    listed_at_ = centres_;
}

void Relaxation::find_walls() {
    near_.at_wall.clear();
    near_.wall.clear();
    const auto add = [&](int i, int wall) {
        near_.at_wall.push_back(i);
        near_.wall.push_back(wall);
    };
    if (outline_.is_disc) {
        for (int i = 0; i < std::ssize(radii_); ++i) {
            if (norm(centres_[i] - outline_.centre) + radii_[i] + skin_ > outline_.radius_m) add(i, 0);
        }
        return;
    }
    const auto& corners = outline_.vertices;
    const int n = static_cast<int>(corners.size());
    for (int k = 0; k < n; ++k) {
        const Vec2 a = corners[k], b = corners[(k + 1) % n], c = corners[(k + 2) % n];
        const bool reentrant = cross(b - a, c - b) < 0.0;
        const Vec2 middle = 0.5 * (a + b);
        const double half = 0.5 * std::max(std::abs(b.x - a.x), std::abs(b.y - a.y));
        grid_.for_each_near(middle, half + skin_, [&](int i) {
            if (distance_to_segment(centres_[i], a, b) < radii_[i] + skin_) add(i, k);
            if (reentrant && norm(centres_[i] - b) < radii_[i] + skin_) add(i, -1 - (k + 1) % n);
        });
    }
}

bool Relaxation::list_is_stale() const {
    const double limit = 0.25 * skin_ * skin_;
    for (std::size_t i = 0; i < centres_.size(); ++i) {
        const Vec2 moved = centres_[i] - listed_at_[i];
        if (dot(moved, moved) > limit) return true;
    }
    return false;
}

void Relaxation::push_apart(int i, Vec2& force, Sums& sums) {
    const Vec2 centre = centres_[i];
    const double radius = radii_[i];
    for (int e = near_.begin[i]; e < near_.begin[i + 1]; ++e) {
        const int j = near_.other[e];
        const Vec2 apart = centre - centres_[j];
        const double reach = radius + radii_[j];
        const double distance2 = dot(apart, apart);
        if (distance2 >= reach * reach) continue;
        const double distance = std::sqrt(distance2);
        const double overlap = reach - distance;
        // Two centres in one place part along x: rare, and any direction will do as long as it is always the same.
        const Vec2 f = distance > 0.0 ? (overlap / distance) * apart : Vec2{overlap, 0.0};
        force += f;
        force_[j] -= f;
        sums.overlap += overlap;
        sums.largest_overlap = std::max(sums.largest_overlap, overlap);
        ++sums.touching;
    }
}

void Relaxation::push_from_wall(int i, int wall, Sums& sums) {
    if (outline_.is_disc) {
        const Vec2 out = centres_[i] - outline_.centre;
        const double distance = norm(out);
        const double overlap = distance + radii_[i] - outline_.radius_m;
        if (overlap > 0.0 && distance > 0.0) push(i, (-1.0 / distance) * out, overlap, sums);
        return;
    }
    const auto& corners = outline_.vertices;
    const std::size_t n = corners.size();
    if (wall < 0) {  // a re-entrant corner, where neither edge is faced
        const std::size_t k = static_cast<std::size_t>(-1 - wall);
        const Vec2 before = corners[k] - corners[(k + n - 1) % n], after = corners[(k + 1) % n] - corners[k];
        const Vec2 apart = centres_[i] - corners[k];
        const double distance = norm(apart);
        if (dot(apart, before) < 0.0 || dot(apart, after) > 0.0 || distance >= radii_[i] || distance == 0.0) return;
        push(i, (1.0 / distance) * apart, radii_[i] - distance, sums);
        return;
    }
    const Vec2 a = corners[static_cast<std::size_t>(wall)];
    const Vec2 ab = corners[(static_cast<std::size_t>(wall) + 1) % n] - a;
    const double length = norm(ab);
    const Vec2 along = (1.0 / length) * ab;
    const double position = dot(centres_[i] - a, along);
    const double height = cross(along, centres_[i] - a);  // positive inside
    if (position < 0.0 || position > length || height >= radii_[i]) return;
    // A centre beyond the edge is pushed back in, unless a non-convex outline has another arm there, to which it belongs.
    if (height <= 0.0 && !convex_ && contains(outline_, centres_[i])) return;
    push(i, rot90(along), radii_[i] - height, sums);
}

Sums Relaxation::forces() {
    if (listed_at_.empty() || list_is_stale()) find_neighbours();
    std::fill(force_.begin(), force_.end(), Vec2{});
    Sums sums;
    for (int i = 0; i < std::ssize(radii_); ++i) {
        Vec2 own;
        push_apart(i, own, sums);
        force_[i] += own;
    }
    for (std::size_t w = 0; w < near_.wall.size(); ++w) push_from_wall(near_.at_wall[w], near_.wall[w], sums);
    return sums;
}

void Relaxation::run(const RelaxationCriterion& criterion, Packing& packing) {
    Fire fire(radii_.size(), {.shortest_step = 0.01, .steps_back = true, .farthest_move_m = 0.1 * smallest_radius_});
    for (int step = 0; step <= criterion.most_steps; ++step) {
        const Sums sums = forces();
        if (step % 10 != 0) {  // the criterion costs a root for each disc, so it is judged at every tenth step
            fire.advance(centres_, force_);
            continue;
        }
        const double contacts = static_cast<double>(std::max(1L, sums.touching));
        const double contact_force = sums.overlap / contacts;
        packing.residual = contact_force > 0.0 ? mean_unbalanced_force() / contact_force : 0.0;
        packing.overlap_mean = contact_force / mean_diameter_;
        packing.overlap_max = sums.largest_overlap / mean_diameter_;
        packing.relaxation_steps = step;
        if (packing.residual <= criterion.residual || packing.overlap_mean <= criterion.loose_overlap) return;
        fire.advance(centres_, force_);
    }
    throw NumericalError(fmt::format("the relaxation of the packing stopped after {} steps at a residual of {:.2e} (allowed {:.1e})",
                                     criterion.most_steps, packing.residual, criterion.residual));
}

}  // namespace

void relax_discs(Packing& packing, const Outline& outline, const RelaxationCriterion& criterion) {
    if (packing.centres.empty()) return;
    Relaxation(packing, outline).run(criterion, packing);
    for (std::size_t i = 0; i < packing.centres.size(); ++i) {
        if (!contains(outline, packing.centres[i])) {
            throw NumericalError(fmt::format("disc {} left the outline during the relaxation, at ({:.6g}, {:.6g}) m", i,
                                             packing.centres[i].x, packing.centres[i].y));
        }
    }
}

}  // namespace feldspar
