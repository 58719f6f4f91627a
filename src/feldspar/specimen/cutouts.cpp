#include "feldspar/specimen/cutouts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/geometry/segments.hpp"

namespace feldspar {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double pi = std::numbers::pi;

/// Bridges of rock thinner than this share of a mean grain are refused, and an end of a notch nearer to a boundary than half of
/// that lies on it.
constexpr double least_bridge = 0.5;
constexpr int edges_of_a_measured_circle = 3600;
/// Joined cuts that meet at a smaller angle leave wedges too thin for grains.
constexpr double least_crossing_angle_rad = 20.0 * pi / 180.0;

constexpr const char* holes_key = "specimen.holes";
constexpr const char* notches_key = "specimen.notches";

std::string in_mm(double length_m) { return fmt::format("{:.4g} mm", 1e3 * length_m); }
std::string in_mm(Vec2 p) { return fmt::format("({:.4g}, {:.4g}) mm", 1e3 * p.x, 1e3 * p.y); }

bool finite(Vec2 p) { return std::isfinite(p.x) && std::isfinite(p.y); }

/// The outline as a polygon, a circle finely divided.
std::vector<Vec2> outer_polygon(const Outline& outline) {
    if (!outline.is_disc) return outline.vertices;
    std::vector<Vec2> corners;
    for (int k = 0; k < edges_of_a_measured_circle; ++k) {
        Vec2 p = turned({outline.radius_m, 0.0}, 2.0 * pi * k / edges_of_a_measured_circle);
        if (outline.flattened()) p.y = std::clamp(p.y, -outline.flat_height_m, outline.flat_height_m);
        corners.push_back(outline.centre + p);
    }
    return corners;
}

/// Area of a simple polygon's part inside a convex counter-clockwise one. Parts that hang together by lines of no width add none.
double common_area(std::vector<Vec2> polygon, std::span<const Vec2> convex) {
    for (std::size_t e = 0; e < convex.size() && !polygon.empty(); ++e) {
        const Vec2 a = convex[e], along = convex[(e + 1) % convex.size()] - a;
        std::vector<Vec2> kept;
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const Vec2 p = polygon[k], q = polygon[(k + 1) % polygon.size()];
            const double dp = cross(along, p - a), dq = cross(along, q - a);
            if (dp >= 0.0) kept.push_back(p);
            if ((dp >= 0.0) != (dq >= 0.0)) kept.push_back(p + (dp / (dp - dq)) * (q - p));
        }
        polygon = std::move(kept);
    }
    return signed_area(polygon);
}

/// Least distance of two chains of segments (m), 0 if they cross. A polygon is a closed chain.
double distance_between(std::span<const Vec2> a, bool a_closed, std::span<const Vec2> b, bool b_closed) {
    double least = infinity;
    for (std::size_t i = 0; i + (a_closed ? 0 : 1) < a.size(); ++i) {
        const Vec2 p = a[i], q = a[(i + 1) % a.size()];
        for (std::size_t j = 0; j + (b_closed ? 0 : 1) < b.size(); ++j) {
            const Vec2 r = b[j], s = b[(j + 1) % b.size()];
            least = std::min(least, distance_between_segments(p, q, r, s));
        }
    }
    return least;
}

class CutoutMaker {
public:
    CutoutMaker(Outline& outline, const GrainScale& grains) : outline_(outline), grains_(grains), outer_(outer_polygon(outline)) {
        const Box box = bounding_box(outline);
        size_ = norm(box.upper - box.lower);
        bridge_ = std::max(1e-6 * size_, least_bridge * grains.mean_m);
    }

    void add_hole(const HoleSpec& hole, const std::string& name, const std::string& label) {
        Cutout cutout;
        cutout.name = name;
        cutout.vertices = hole.vertices_m.empty() ? round_hole(hole, name) : polygonal_hole(hole, name);
        cutout.area_m2 = signed_area(cutout.vertices);
        const double across = hole.vertices_m.empty() ? hole.diameter_m : 2.0 * std::sqrt(cutout.area_m2 / pi);
        if (across < grains_.largest_m)
            throw InputError(
                {"", 0, 0, holes_key},
                fmt::format("{} is {} across, smaller than a grain of {}", name, in_mm(across), in_mm(grains_.largest_m)),
                "holes at least as large as the largest grain", "leave the hole out, or take smaller grains");
        const bool inside =
            std::all_of(cutout.vertices.begin(), cutout.vertices.end(), [&](Vec2 p) { return feldspar::contains(outer_, p); });
        const double apart = distance_between(cutout.vertices, true, outer_, true);
        if (!inside || apart < bridge_) {
            throw InputError(
                {"", 0, 0, holes_key},
                inside && apart > 1e-6 * size_
                    ? fmt::format("{} leaves a bridge of {} to the boundary, thinner than half a grain", name, in_mm(apart))
                    : fmt::format("{} touches or crosses the boundary", name),
                "holes that lie in the rock, half a mean grain or more from its boundary",
                outline_.is_disc ? "move it inwards, or make it smaller"
                                 : "move it inwards, or draw a bay in the outline: shape = \"polygon\"");
        }
        for (const Cutout& other : outline_.cutouts) {
            const double between = distance_between(cutout.vertices, true, other.vertices, true);
            const bool within = feldspar::contains(std::span<const Vec2>(other.vertices), cutout.vertices.front()) ||
                                feldspar::contains(std::span<const Vec2>(cutout.vertices), other.vertices.front());
            if (within || between < bridge_)
                throw InputError({"", 0, 0, holes_key},
                                 within || between <= 1e-6 * size_
                                     ? fmt::format("{} and {} touch or overlap", other.name, name)
                                     : fmt::format("{} and {} leave a bridge of {}, thinner than half a grain", other.name, name,
                                                   in_mm(between)),
                                 "holes with rock between them, half a mean grain or more",
                                 "draw them as one hole with vertices, or move one");
        }
        add(std::move(cutout), label);
    }

    /// All notches there will be: a joined one may end on another, whichever comes first.
    void expect(const std::vector<NotchSpec>& notches) {
        expected_ = notches;
        first_notch_ = static_cast<int>(outline_.cutouts.size());
    }

    /// @throws InputError  joined cuts that end on each other in a ring
    void require_order() const {
        std::vector<char> done(outline_.cutouts.size(), 0);
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t n = 0; n < done.size(); ++n) {
                const auto& on = outline_.cutouts[n].ends_on;
                if (done[n] || std::any_of(on.begin(), on.end(),
                                           [&](int other) { return other >= 0 && !done[static_cast<std::size_t>(other)]; }))
                    continue;
                done[n] = 1;
                changed = true;
            }
        }
        for (std::size_t n = 0; n < done.size(); ++n)
            if (!done[n])
                throw InputError(
                    {"", 0, 0, notches_key}, fmt::format("{} and others end on each other in a ring", outline_.cutouts[n].name),
                    "a cut through which others end, and that ends on none of them", "lengthen one of them beyond where it ends");
    }

    void add_notch(const NotchSpec& given, const std::string& name, const std::string& label) {
        NotchSpec notch = given;
        const std::array<int, 2> ends_on = given.joined ? bring_ends_onto_others(notch) : std::array{-1, -1};
        if (!finite(notch.from_m) || !finite(notch.to_m) || !(notch.width_m >= 0.0) || !std::isfinite(notch.width_m))
            throw InputError({"", 0, 0, notches_key}, fmt::format("{} has no finite place and width", name),
                             "two points and a width of zero or more");
        const double length = norm(notch.to_m - notch.from_m);
        const double inside = length_in_rock(notch);
        if (inside <= 0.01 * length)
            throw InputError(
                {"", 0, 0, notches_key},
                fmt::format("{}, from {} to {}, lies outside the rock", name, in_mm(notch.from_m), in_mm(notch.to_m)),
                "a notch that begins at a boundary and ends in the rock, or one with both ends in the rock");
        if (inside < std::max(grains_.largest_m, notch.width_m))
            throw InputError({"", 0, 0, notches_key},
                             inside < grains_.largest_m
                                 ? fmt::format("{} is {} long in the rock, shorter than a grain of {}", name, in_mm(inside),
                                               in_mm(grains_.largest_m))
                                 : fmt::format("{} is {} long in the rock, less than its width", name, in_mm(inside)),
                             "notches longer than the largest grain and than wide",
                             "lengthen it, take smaller grains, or draw it as a hole with vertices");
        Cutout cutout;
        cutout.name = name;
        const std::array<Vec2, 2> ends = {notch.from_m, notch.to_m};
        cutout.ends_on = ends_on;
        for (int e = 0; e < 2; ++e)
            cutout.tips[e] = ends_on[e] < 0 && in_rock(ends[e]) && distance_to_rocks_boundary(ends[e]) > 0.5 * bridge_;
        cutout.joined = notch.joined;
        if (notch.joined && notch.width_m > 0.0)
            throw InputError({"", 0, 0, notches_key},
                             fmt::format("{} is {} wide, but its faces are to stay in contact", name, in_mm(notch.width_m)),
                             "width = \"0 mm\" beside joined = true");
        if (!notch.joined && !cutout.tips[0] && !cutout.tips[1] && !at_hole(ends[0]) && !at_hole(ends[1]))
            throw InputError({"", 0, 0, notches_key},
                             fmt::format("{}, from {} to {}, cuts the specimen in two", name, in_mm(ends[0]), in_mm(ends[1])),
                             "a notch that ends in the rock", "move one end inwards");
        shape_notch(cutout, notch);
        check_bridges(cutout, notch);
        add(std::move(cutout), label);
        axes_.push_back(notch);
    }

private:
    /// Where the axes of two notches meet: their shares of the way on either.
    struct Meeting {
        double own = 0.0, other = 0.0;
        double sine = 0.0;  ///< of the angle between them
    };
    static Meeting meeting(const NotchSpec& notch, const NotchSpec& other) {
        const Vec2 a = notch.to_m - notch.from_m, b = other.to_m - other.from_m, apart = other.from_m - notch.from_m;
        const double slope = cross(a, b), sine = std::abs(slope) / (norm(a) * norm(b));
        if (sine < 1e-9) return {infinity, infinity, 0.0};
        return {cross(apart, b) / slope, cross(apart, a) / slope, sine};
    }

    bool share_an_end(const NotchSpec& a, const NotchSpec& b) const {
        for (const Vec2 p : {a.from_m, a.to_m})
            for (const Vec2 q : {b.from_m, b.to_m})
                if (norm(p - q) < 1e-9 * size_) return true;
        return false;
    }

    /// An end of a joined cut that is nearer to another one than half a bridge lies on it. @return on which, by the numbers of
    /// cutouts
    std::array<int, 2> bring_ends_onto_others(NotchSpec& notch) const {
        std::array<int, 2> on = {-1, -1};
        const NotchSpec given = notch;
        for (int n = 0; n < std::ssize(expected_); ++n) {
            const NotchSpec& other = expected_[static_cast<std::size_t>(n)];
            if (!other.joined || other == given || share_an_end(given, other)) continue;
            const Meeting meet = meeting(given, other);
            if (!(meet.other > 0.0 && meet.other < 1.0) || !std::isfinite(meet.own)) continue;
            const double length = norm(given.to_m - given.from_m);
            for (int e = 0; e < 2; ++e) {
                if (std::abs(meet.own - e) * length > 0.5 * bridge_) continue;
                const Vec2 at = other.from_m + meet.other * (other.to_m - other.from_m);
                if (!in_rock(at)) continue;
                on[static_cast<std::size_t>(e)] = first_notch_ + n;
                (e == 0 ? notch.from_m : notch.to_m) = at;
            }
        }
        return on;
    }

    std::vector<Vec2> round_hole(const HoleSpec& hole, const std::string& name) const {
        if (!(hole.diameter_m > 0.0) || !std::isfinite(hole.diameter_m) || !finite(hole.centre_m))
            throw InputError({"", 0, 0, holes_key}, fmt::format("{} has a diameter of {:g} m", name, hole.diameter_m),
                             "a diameter greater than zero");
        const int n = arc_edges(0.5 * hole.diameter_m, grains_.mean_m);
        const double radius = 0.5 * hole.diameter_m * std::sqrt(2.0 * pi / (n * std::sin(2.0 * pi / n)));  // of the same area
        std::vector<Vec2> corners;
        for (int k = 0; k < n; ++k) corners.push_back(hole.centre_m + turned({radius, 0.0}, 2.0 * pi * (k + 0.5) / n));
        return corners;
    }

    static std::vector<Vec2> polygonal_hole(const HoleSpec& hole, const std::string& name) {
        if (!std::all_of(hole.vertices_m.begin(), hole.vertices_m.end(), finite) || !is_simple_polygon(hole.vertices_m))
            throw InputError({"", 0, 0, holes_key}, fmt::format("{} crosses or touches itself, or has no area", name),
                             "a simple polygon of at least three different vertices");
        std::vector<Vec2> corners = hole.vertices_m;
        if (signed_area(corners) < 0.0) std::reverse(corners.begin(), corners.end());
        return corners;
    }

    /// In the outline and in no hole.
    bool in_rock(Vec2 p) const { return feldspar::contains(outer_, p) && !at_hole(p, 0.0); }

    /// In a hole, or nearer to it than the ends of notches that lie on its boundary.
    bool at_hole(Vec2 p) const { return at_hole(p, 0.5 * bridge_); }
    bool at_hole(Vec2 p, double near) const {
        return std::any_of(outline_.cutouts.begin(), outline_.cutouts.end(), [&](const Cutout& hole) {
            if (hole.slit || hole.is_cut()) return false;
            const std::span<const Vec2> corners = hole.vertices;
            return feldspar::contains(corners, p) || (near > 0.0 && feldspar::distance_to_boundary(corners, p) <= near);
        });
    }

    double distance_to_rocks_boundary(Vec2 p) const {
        double least = feldspar::distance_to_boundary(std::span<const Vec2>(outer_), p);
        for (const Cutout& hole : outline_.cutouts) {
            if (!hole.slit && !hole.is_cut())
                least = std::min(least, feldspar::distance_to_boundary(std::span<const Vec2>(hole.vertices), p));
        }
        return least;
    }

    double length_in_rock(const NotchSpec& notch) const {
        const Vec2 a = notch.from_m, ab = notch.to_m - notch.from_m;
        std::vector<double> stops = {0.0, 1.0};  // along the axis, where it meets a boundary
        const auto note = [&](std::span<const Vec2> corners) {
            for (std::size_t k = 0; k < corners.size(); ++k) {
                const Vec2 p = corners[k], pq = corners[(k + 1) % corners.size()] - p;
                const double slope = cross(ab, pq);
                if (slope == 0.0) continue;
                const double t = cross(p - a, pq) / slope, s = cross(p - a, ab) / slope;
                if (t > 0.0 && t < 1.0 && s >= 0.0 && s <= 1.0) stops.push_back(t);
            }
        };
        note(outer_);
        for (const Cutout& hole : outline_.cutouts) {
            if (!hole.slit && !hole.is_cut()) note(hole.vertices);
        }
        std::sort(stops.begin(), stops.end());
        double inside = 0.0;
        for (std::size_t k = 0; k + 1 < stops.size(); ++k)
            inside += in_rock(a + 0.5 * (stops[k] + stops[k + 1]) * ab) ? stops[k + 1] - stops[k] : 0.0;
        return inside * norm(ab);
    }

    /// The rectangle or the cut, reaching out of the rock at open ends.
    void shape_notch(Cutout& cutout, const NotchSpec& notch) const {
        const Vec2 along = (1.0 / norm(notch.to_m - notch.from_m)) * (notch.to_m - notch.from_m);
        const Vec2 across = 0.5 * notch.width_m * rot90(along);
        const auto stays = [&](int e) {
            return cutout.tips[static_cast<std::size_t>(e)] || cutout.ends_on[static_cast<std::size_t>(e)] >= 0;
        };
        const Vec2 from = stays(0) ? notch.from_m : moved_out(notch.from_m, -along, across, cutout.name),
                   to = stays(1) ? notch.to_m : moved_out(notch.to_m, along, across, cutout.name);
        if (notch.width_m == 0.0) {
            cutout.vertices = {from, to};
            cutout.packed_around = false;
            return;
        }
        cutout.slit = true;
        cutout.vertices = {from - across, to - across, to + across, from + across};
        cutout.packed_around = notch.width_m > grains_.mean_m;
        cutout.area_m2 = common_area(outer_, cutout.vertices);
        for (const Cutout& hole : outline_.cutouts) {
            if (!hole.slit && !hole.is_cut()) cutout.area_m2 -= common_area(hole.vertices, cutout.vertices);
        }
    }

    /// An open end, moved on no farther than it must be for its whole width to be out of the rock: behind a hole there is rock
    /// again.
    Vec2 moved_out(Vec2 end, Vec2 outward, Vec2 across, const std::string& name) const {
        constexpr int steps = 40;
        const double farthest = 5.0 * (2.0 * norm(across) + bridge_);
        for (int k = 0; k <= steps; ++k) {
            const Vec2 p = end + (farthest * k / steps) * outward;
            const auto out = [&](Vec2 corner) { return !in_rock(corner) && distance_to_rocks_boundary(corner) > 1e-6 * size_; };
            if (out(p - across) && out(p + across)) return p;
        }
        throw InputError(
            {"", 0, 0, notches_key},
            fmt::format("the end of {} at {} leaves a bridge to the boundary, thinner than half a grain", name, in_mm(end)),
            "ends that reach out of the rock with their whole width, or lie half a mean grain or more from its boundary",
            "lengthen the notch, or shorten it");
    }

    void check_bridges(const Cutout& cutout, const NotchSpec& notch) const {
        const Vec2 half = 0.5 * notch.width_m * rot90((1.0 / norm(notch.to_m - notch.from_m)) * (notch.to_m - notch.from_m));
        const std::array<Vec2, 2> ends = {notch.from_m, notch.to_m};
        for (int e = 0; e < 2; ++e) {
            for (const Vec2 p : {ends[e] - half, ends[e] + half}) {
                if (!cutout.tips[e]) continue;
                const double left = in_rock(p) ? distance_to_rocks_boundary(p) : 0.0;
                if (left >= bridge_) continue;
                throw InputError(
                    {"", 0, 0, notches_key},
                    fmt::format("the end of {} at {} leaves a bridge of {} to the boundary, thinner than half a grain",
                                cutout.name, in_mm(ends[e]), in_mm(left)),
                    "ends on a boundary, or half a mean grain or more from it", "move the end onto the boundary or away from it");
            }
        }
        for (std::size_t k = 0; k < axes_.size(); ++k) {
            const NotchSpec& other = axes_[k];
            const std::array<Vec2, 2> a = {notch.from_m, notch.to_m}, b = {other.from_m, other.to_m};
            const double between = distance_between(a, false, b, false) - 0.5 * (notch.width_m + other.width_m);
            if ((notch.joined || other.joined) && share_an_end(notch, other))
                continue;  // a joint may go on where a notch or another joint ends
            if (notch.joined && other.joined && check_crossing(k, notch, other, cutout.name)) continue;
            if (between < bridge_)
                throw InputError(
                    {"", 0, 0, notches_key},
                    fmt::format("notch {} and {} touch, cross, or leave a bridge thinner than half a grain", k + 1, cutout.name),
                    "notches with rock between them, half a mean grain or more",
                    "move one, or draw both as one hole with vertices");
        }
    }

    /// Whether two joined cuts cross, or one ends on the other, so that there is room for grains around the place.
    bool check_crossing(std::size_t number, const NotchSpec& notch, const NotchSpec& other, const std::string& name) const {
        const Meeting meet = meeting(notch, other);
        constexpr double kOn = 1e-9;  // of the lengths: an end that has been brought there
        if (!(meet.own > -kOn && meet.own < 1.0 + kOn && meet.other > -kOn && meet.other < 1.0 + kOn)) return false;
        const auto refuse = [&](const std::string& problem, const std::string& allowed) {
            throw InputError({"", 0, 0, notches_key}, fmt::format("notch {} and {} {}", number + 1, name, problem), allowed,
                             "move or turn one");
        };
        if (meet.sine < std::sin(least_crossing_angle_rad))
            refuse(fmt::format("cross at {:.3g} degrees", std::asin(meet.sine) * 180.0 / pi),
                   "cuts that cross at 20 degrees or more: thinner wedges hold no grains");
        for (const auto& [share, cut] : {std::pair{meet.own, notch}, std::pair{meet.other, other}}) {
            const double length = norm(cut.to_m - cut.from_m);
            for (const double way : {share * length, (1.0 - share) * length})
                if (way > kOn * length && way < bridge_ && in_rock(way == share * length ? cut.from_m : cut.to_m))
                    refuse(fmt::format("cross {} before one of them ends", in_mm(way)),
                           "cuts that end on each other, or go on by half a mean grain or more");
        }
        const Vec2 at = notch.from_m + meet.own * (notch.to_m - notch.from_m);
        if (!in_rock(at)) return true;
        for (const Vec2 p : crossings_)
            if (norm(p - at) < bridge_)
                refuse(fmt::format("cross at {}, {} from where others do", in_mm(at), in_mm(norm(p - at))),
                       "crossings half a mean grain or more apart");
        crossings_.push_back(at);
        return true;
    }

    void add(Cutout cutout, const std::string& label) {
        cutout.first_edge = static_cast<int>(outline_.edge_labels.size());
        outline_.edge_labels.insert(outline_.edge_labels.end(), cutout.vertices.size(), label);
        outline_.area_m2 -= cutout.area_m2;
        outline_.cutouts.push_back(std::move(cutout));
    }

    Outline& outline_;
    const GrainScale& grains_;
    std::vector<Vec2> outer_;
    std::vector<NotchSpec> axes_, expected_;
    int first_notch_ = 0;
    mutable std::vector<Vec2> crossings_;  ///< of joined cuts
    double size_ = 0.0, bridge_ = 0.0;
};

using Interval = std::array<double, 2>;

/// The polygon's inside on the horizontal line at `y`, in order; `y` is not the height of a vertex.
std::vector<Interval> intervals_at(std::span<const Vec2> corners, double y) {
    std::vector<double> crossings;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec2 a = corners[k], b = corners[(k + 1) % corners.size()];
        if ((a.y < y) != (b.y < y)) crossings.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    std::sort(crossings.begin(), crossings.end());
    std::vector<Interval> result;
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) result.push_back({crossings[i], crossings[i + 1]});
    return result;
}

}  // namespace

void add_cutouts(Outline& outline, const OutlineSpec& spec, const GrainScale& grains) {
    if (!spec.is_cut()) return;
    CutoutMaker maker(outline, grains);
    if (spec.shape == Shape::ring) maker.add_hole({{0.0, 0.0}, spec.hole_diameter_m, {}, {}}, "the hole of the ring", "hole");
    for (std::size_t k = 0; k < spec.holes.size(); ++k) {
        const std::string& label = spec.holes[k].label;
        maker.add_hole(spec.holes[k], fmt::format("hole {}", k + 1), label.empty() ? fmt::format("hole-{}", k + 1) : label);
    }
    maker.expect(spec.notches);
    for (std::size_t k = 0; k < spec.notches.size(); ++k) {
        const std::string& label = spec.notches[k].label;
        maker.add_notch(spec.notches[k], fmt::format("notch {}", k + 1), label.empty() ? fmt::format("notch-{}", k + 1) : label);
    }
    maker.require_order();
}

std::vector<Vec2> arc_corners(Vec2 centre, double radius_m, double from_rad, double to_rad, int edges) {
    std::vector<Vec2> corners;
    for (int k = 0; k <= edges; ++k)
        corners.push_back(centre + turned({radius_m, 0.0}, from_rad + (to_rad - from_rad) * k / edges));
    return corners;
}

double width_at(std::span<const Vec2> corners, std::span<const Cutout> cutouts, double y) {
    std::vector<Interval> gone;
    for (const Cutout& cutout : cutouts) {
        if (cutout.is_cut()) continue;
        const std::vector<Interval> more = intervals_at(cutout.vertices, y);
        gone.insert(gone.end(), more.begin(), more.end());
    }
    std::sort(gone.begin(), gone.end());
    double width = 0.0;
    for (const Interval& rock : intervals_at(corners, y)) {
        width += rock[1] - rock[0];
        double done = rock[0];  // of the interval, up to here
        for (const Interval& hole : gone) {
            const double from = std::max(hole[0], done), to = std::min(hole[1], rock[1]);
            if (to <= from) continue;
            width -= to - from;
            done = to;
        }
    }
    return width;
}

}  // namespace feldspar
