#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "feldspar/base/error.hpp"
#include "feldspar/base/sort_in_buckets.hpp"
#include "feldspar/geometry/cell_grid.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/attachment.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {
namespace {

using Pair = std::array<int, 2>;

std::vector<Vec2> all_centres(const Assembly& assembly) {
    std::vector<Vec2> centres(assembly.bodies.size());
    for (std::size_t b = 0; b < centres.size(); ++b) centres[b] = assembly.centre(static_cast<int>(b));
    return centres;
}

// Nothing is searched or sorted by a place before it is known to be one.
void expect_finite(double length, std::size_t body) {
    if (!std::isfinite(length)) throw NumericalError(fmt::format("the position of body {} is not a finite number", body));
}

// Pairs of bodies, the smaller number first, sorted.
class KnownPairs {
public:
    KnownPairs(std::vector<Pair> pairs, std::size_t bodies) : pairs_(std::move(pairs)) {
        begin_ = sort_in_buckets(
            pairs_, bodies, [](const Pair& pair) { return pair[0]; }, std::less<>());
    }
    bool contains(int a, int b) const {
        const auto at = [&](std::size_t n) { return pairs_.begin() + static_cast<std::ptrdiff_t>(begin_[n]); };
        return std::binary_search(at(static_cast<std::size_t>(a)), at(static_cast<std::size_t>(a) + 1), Pair{a, b});
    }

private:
    std::vector<Pair> pairs_;
    std::vector<std::size_t> begin_;  // of those of each first body
};

KnownPairs pairs_in_contact(const Assembly& assembly) {
    std::vector<Pair> pairs;
    for (const Contact& contact : assembly.contacts)
        if (!contact.dropped && !contact.plate)
            pairs.push_back({std::min(contact.a.body, contact.b.body), std::max(contact.a.body, contact.b.body)});
    return {std::move(pairs), assembly.bodies.size()};
}

// Every bond of the contact is broken and open by more than the skin.
bool wide_open(const Assembly& assembly, const Contact& contact, double skin_m) {
    for (int p = contact.first_point; p < contact.first_point + contact.points; ++p)
        if (assembly.bond(p).damage < 1.0) return false;
    return norm(assembly.centre(contact.b.body) - assembly.centre(contact.a.body)) > contact.closing_distance_m + skin_m;
}

}  // namespace

ContactFinder::ContactFinder(const Assembly& assembly, double skin_m) : skin_m_(skin_m) {
    search(assembly);
    for (const Candidate& candidate : candidates_) {
        const double radii = assembly.bodies[candidate.a].radius_m + assembly.bodies[candidate.b].radius_m;
        const double overlap = radii - norm(assembly.centre(candidate.b) - assembly.centre(candidate.a));
        if (overlap <= 0.0) continue;
        overlapping_at_start_.push_back({candidate.a, candidate.b});
        rest_overlaps_m_.push_back(overlap);
    }
    search(assembly);
}

void ContactFinder::search(const Assembly& assembly) {
    centres_at_search_ = all_centres(assembly);
    for (std::size_t b = 0; b < centres_at_search_.size(); ++b)
        expect_finite(centres_at_search_[b].x + centres_at_search_[b].y, b);
    candidates_.clear();
    double largest = 0.0;
    for (const Body& body : assembly.bodies) largest = std::max(largest, body.radius_m);
    CellGrid grid(bounding_box(centres_at_search_), 2.0 * largest + skin_m_, centres_at_search_.size());
    const KnownPairs known = pairs_in_contact(assembly);
    const auto consider = [&](int a, int b) {
        const double reach = assembly.bodies[a].radius_m + assembly.bodies[b].radius_m + skin_m_;
        const Vec2 line = centres_at_search_[b] - centres_at_search_[a];
        if (dot(line, line) > reach * reach || known.contains(a, b)) return;
        const auto at = std::lower_bound(overlapping_at_start_.begin(), overlapping_at_start_.end(), Pair{a, b});
        const bool overlapped = at != overlapping_at_start_.end() && *at == Pair{a, b};
        candidates_.push_back(
            {a, b, overlapped ? rest_overlaps_m_[static_cast<std::size_t>(at - overlapping_at_start_.begin())] : 0.0});
    };
    for (int b = 0; b < static_cast<int>(centres_at_search_.size()); ++b) {  // each pair once, when its second body comes in
        if (assembly.bodies[b].kind == BodyKind::plate) continue;
        const double reach = assembly.bodies[b].radius_m + largest + skin_m_;
        grid.for_each_near(centres_at_search_[b], reach, [&](int a) { consider(a, b); });
        grid.insert(b, centres_at_search_[b]);
    }
    sort_in_buckets(
        candidates_, assembly.bodies.size(), [](const Candidate& pair) { return pair.a; },
        [](const Candidate& l, const Candidate& r) { return l.b < r.b; });
}

ContactFinder::Changes ContactFinder::update(Assembly& assembly, double mass_factor) {
    Changes changes;
    double moved = 0.0;
    for (std::size_t b = 0; b < assembly.bodies.size() && assembly.bodies[b].kind != BodyKind::plate;
         ++b) {  // plates stand at the end
        const double distance = norm(assembly.centre(static_cast<int>(b)) - centres_at_search_[b]);
        expect_finite(distance, b);
        moved = std::max(moved, distance);
    }
    const bool research = moved > 0.5 * skin_m_;
    if (research) {
        for (Contact& contact : assembly.contacts) {
            if (contact.dropped || contact.plate || !wide_open(assembly, contact, skin_m_)) continue;
            contact.dropped = true;
            for (int p = contact.first_point; p < contact.first_point + contact.points;
                 ++p) {  // carries nothing, and holds nothing
                BondState bond = assembly.bond(p);
                bond.Fn_N = bond.Fs_N = 0.0;
                assembly.set_bond(p, bond);
            }
            ++changes.dropped;
        }
        search(assembly);
    }
    std::erase_if(candidates_, [&](const Candidate& pair) {
        const double radii = assembly.bodies[pair.a].radius_m + assembly.bodies[pair.b].radius_m;
        const double d = norm(assembly.centre(pair.b) - assembly.centre(pair.a));
        if (d >= radii - pair.rest_overlap_m) return false;
        add_new_contact(assembly, pair.a, pair.b, pair.rest_overlap_m, radii);
        const int p = assembly.contacts.back().first_point;
        changes.elastic_J +=
            elastic_energy(assembly.law_of(assembly.contacts.back()), assembly.points[p].area_m2, assembly.bond(p));
        if (mass_factor > 0.0) changes.kinetic_J += add_contact_mass(assembly, assembly.contacts.back(), mass_factor);
        ++changes.made;
        return true;
    });
    if (changes.made + changes.dropped > 0) index_contacts(assembly);
    return changes;
}

namespace {

// Whether any shape function has departed from its initial value by more than the fall-back allows.
bool departs(const std::array<double, 3>& now, const std::array<double, 3>& initial) {
    return std::abs(now[0] - initial[0]) > 0.5 || std::abs(now[1] - initial[1]) > 0.5 || std::abs(now[2] - initial[2]) > 0.5;
}

// Gives the nodes of one side the mass that the point's present shape functions ask for beyond what is covered.
double cover(Assembly& assembly, const SideNodes& nodes, const std::array<double, 3>& needed, std::array<double, 3>& covered,
             double per_share) {
    double kinetic = 0.0;
    for (int i = 0; i < 3; ++i) {
        if (needed[i] <= covered[i]) continue;
        kinetic += add_mass(assembly.nodes, nodes[i], per_share * (needed[i] - covered[i]));
        covered[i] = needed[i];
    }
    return kinetic;
}

// An extrapolated point is stiffer than the masses were made for: sum |N| grows from 1 to 2 a side before the fall-back. The
// bound has a margin of a tenth (largest omega^2 3.5 of 4), so masses follow in steps of that size.
double follow_stiffness(Assembly& assembly, const Contact& contact, int p, const std::array<double, 3>& Na,
                        const std::array<double, 3>& Nb, double mass_factor) {
    InitialShape& shape = assembly.initial_shapes[p];
    const bool b_is_grain = !contact.plate;
    std::array<double, 3> a{}, b{};
    stiffness_shares(Na, Nb, b_is_grain, a, b);
    bool beyond = false;
    for (int i = 0; i < 3; ++i)
        beyond = beyond || a[i] > 1.1 * shape.covered_a[i] + 0.05 || b[i] > 1.1 * shape.covered_b[i] + 0.05;
    if (!beyond) return 0.0;
    const BondLaw law = assembly.law_of(contact);
    const double per_share = 0.25 * mass_factor * assembly.points[p].area_m2 * std::max(law.Kn_Pa_m, law.Ks_Pa_m);
    double kinetic = cover(assembly, contact.a.node, a, shape.covered_a, per_share);
    if (b_is_grain) kinetic += cover(assembly, contact.b.node, b, shape.covered_b, per_share);
    return kinetic;
}

// The choice for one contact. @return what it adds to the whole
ShapeChoice choose(Assembly& assembly, Contact& contact, double mass_factor) {
    ShapeChoice choice;
    contact.initial_shape = false;
    if (contact.dropped || !contact.flexible) return choice;
    const ContactFrame frame = contact_frame(assembly, contact);
    const bool b_is_grain = !contact.plate;
    const auto pa = corners(assembly.nodes, contact.a.node);
    const auto pb = b_is_grain ? corners(assembly.nodes, contact.b.node) : pa;
    const auto shapes_at = [&](int p) {
        const Vec2 x = frame.reference_point + assembly.points[p].along_m * frame.edge_tangent;
        return std::array{shape_functions(pa, x), shape_functions(pb, x)};
    };
    const int end = contact.first_point + contact.points;
    for (int p = contact.first_point; p < end && !contact.initial_shape; ++p) {
        const auto [Na, Nb] = shapes_at(p);
        contact.initial_shape =
            departs(Na, assembly.initial_shapes[p].a) || (b_is_grain && departs(Nb, assembly.initial_shapes[p].b));
    }
    if (contact.initial_shape) {
        choice.fallback_sides += b_is_grain ? 2 : 1;
    } else if (mass_factor > 0.0) {
        for (int p = contact.first_point; p < end; ++p) {
            const auto [Na, Nb] = shapes_at(p);
            choice.kinetic_J += follow_stiffness(assembly, contact, p, Na, Nb, mass_factor);
        }
    }
    return choice;
}

void add(ShapeChoice& sum, const ShapeChoice& one) {
    sum.fallback_sides += one.fallback_sides;
    sum.kinetic_J += one.kinetic_J;
}

// Smallest height of the triangle behind an edge: a point that moves by it changes some shape function by 1.
double smallest_height(const Assembly& assembly, const SideNodes& node) {
    const auto p = corners(assembly.nodes, node);
    const double longest = std::max({norm(p[1] - p[0]), norm(p[2] - p[1]), norm(p[0] - p[2])});
    return std::abs(cross(p[1] - p[0], p[2] - p[0])) / longest;
}

}  // namespace

ShapeChoice choose_shape_functions(Assembly& assembly, double mass_factor) {
    ShapeChoice choice;
    for (Contact& contact : assembly.contacts) add(choice, choose(assembly, contact, mass_factor));
    return choice;
}

void ShapeWatch::measure(const Assembly& assembly, std::size_t first_contact) {
    for (std::size_t c = first_contact; c < assembly.contacts.size(); ++c) {
        const Contact& contact = assembly.contacts[c];
        double height = 0.0;
        if (contact.flexible) {
            height = smallest_height(assembly, contact.a.node);
            if (!contact.plate) height = std::min(height, smallest_height(assembly, contact.b.node));
        }
        allowed_m_.push_back(0.02 * height);
        seen_m_.resize(assembly.points.size());
        remember(assembly, contact);
    }
}

void ShapeWatch::remember(const Assembly& assembly, const Contact& contact) {
    for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
        const auto i = static_cast<std::size_t>(assembly.points[p].state);
        seen_m_[p] = {assembly.bonds.un_m[i], assembly.bonds.us_m[i]};
    }
}

bool ShapeWatch::has_moved(const Assembly& assembly, const Contact& contact, std::size_t c) const {
    for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
        const auto i = static_cast<std::size_t>(assembly.points[p].state);
        const double un = assembly.bonds.un_m[i] - seen_m_[p].x, us = assembly.bonds.us_m[i] - seen_m_[p].y;
        if (std::abs(un) > allowed_m_[c] || std::abs(us) > allowed_m_[c]) return true;
    }
    return false;
}

ShapeChoice ShapeWatch::look(Assembly& assembly, double mass_factor) {
    constexpr int kAll = 20;  // looks
    measure(assembly, allowed_m_.size());
    const bool all = looks_++ % kAll == 0;
    ShapeChoice choice;
    for (std::size_t c = 0; c < assembly.contacts.size(); ++c) {
        Contact& contact = assembly.contacts[c];
        if (!contact.flexible || !(all || contact.initial_shape || has_moved(assembly, contact, c))) continue;
        add(choice, choose(assembly, contact, mass_factor));
        remember(assembly, contact);
    }
    return choice;
}

}  // namespace feldspar
