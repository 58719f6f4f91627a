#include <algorithm>
#include <cmath>

#include "feldspar/geometry/cell_grid.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {
namespace {

using Pair = std::array<int, 2>;

std::vector<Vec2> all_centres(const Assembly& body) {
    std::vector<Vec2> centres(body.grains.size());
    for (std::size_t g = 0; g < centres.size(); ++g) centres[g] = body.centre(static_cast<int>(g));
    return centres;
}

std::vector<Pair> pairs_in_contact(const Assembly& body) {
    std::vector<Pair> pairs;
    for (const Contact& contact : body.contacts)
        if (!contact.dropped && contact.b.grain >= 0)
            pairs.push_back({std::min(contact.a.grain, contact.b.grain), std::max(contact.a.grain, contact.b.grain)});
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

// Every bond of the contact is broken and open by more than the skin.
bool wide_open(const Assembly& body, const Contact& contact, double skin_m) {
    for (int p = contact.first_point; p < contact.first_point + contact.points; ++p)
        if (body.points[p].bond.damage < 1.0) return false;
    return norm(body.centre(contact.b.grain) - body.centre(contact.a.grain)) > contact.closing_distance_m + skin_m;
}

}  // namespace

ContactFinder::ContactFinder(const Assembly& body, double skin_m) : skin_m_(skin_m) {
    search(body);
    for (const Candidate& candidate : candidates_) {
        const double radii = body.grains[candidate.a].radius_m + body.grains[candidate.b].radius_m;
        const double overlap = radii - norm(body.centre(candidate.b) - body.centre(candidate.a));
        if (overlap <= 0.0) continue;
        overlapping_at_start_.push_back({candidate.a, candidate.b});
        rest_overlaps_m_.push_back(overlap);
    }
    search(body);
}

void ContactFinder::search(const Assembly& body) {
    centres_at_search_ = all_centres(body);
    candidates_.clear();
    double largest = 0.0;
    for (const Grain& grain : body.grains) largest = std::max(largest, grain.radius_m);
    CellGrid grid(bounding_box(centres_at_search_), 2.0 * largest + skin_m_, centres_at_search_.size());
    const std::vector<Pair> known = pairs_in_contact(body);
    const auto consider = [&](int a, int b) {
        const double reach = body.grains[a].radius_m + body.grains[b].radius_m + skin_m_;
        const Vec2 line = centres_at_search_[b] - centres_at_search_[a];
        if (dot(line, line) > reach * reach || std::binary_search(known.begin(), known.end(), Pair{a, b})) return;
        const auto at = std::lower_bound(overlapping_at_start_.begin(), overlapping_at_start_.end(), Pair{a, b});
        const bool overlapped = at != overlapping_at_start_.end() && *at == Pair{a, b};
        candidates_.push_back({a, b, overlapped ? rest_overlaps_m_[static_cast<std::size_t>(at - overlapping_at_start_.begin())] : 0.0});
    };
    for (int b = 0; b < static_cast<int>(centres_at_search_.size()); ++b) {   // each pair once, when its second grain comes in
        const double reach = body.grains[b].radius_m + largest + skin_m_;
        grid.for_each_near(centres_at_search_[b], reach, [&](int a) { consider(a, b); });
        grid.insert(b, centres_at_search_[b]);
    }
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& l, const Candidate& r) { return Pair{l.a, l.b} < Pair{r.a, r.b}; });
}

ContactFinder::Changes ContactFinder::update(Assembly& body, double mass_factor) {
    Changes changes;
    double moved = 0.0;
    for (std::size_t g = 0; g < body.grains.size(); ++g)
        moved = std::max(moved, norm(body.centre(static_cast<int>(g)) - centres_at_search_[g]));
    const bool research = moved > 0.5 * skin_m_;
    if (research) {
        for (Contact& contact : body.contacts) {
            if (contact.dropped || contact.b.grain < 0 || !wide_open(body, contact, skin_m_)) continue;
            contact.dropped = true;
            ++changes.dropped;
        }
        search(body);
    }
    std::erase_if(candidates_, [&](const Candidate& pair) {
        const double radii = body.grains[pair.a].radius_m + body.grains[pair.b].radius_m;
        const double d = norm(body.centre(pair.b) - body.centre(pair.a));
        if (d >= radii - pair.rest_overlap_m) return false;
        add_new_contact(body, pair.a, pair.b, pair.rest_overlap_m, radii);
        if (mass_factor > 0.0) changes.kinetic_J += add_contact_mass(body, body.contacts.back(), mass_factor);
        ++changes.made;
        return true;
    });
    if (changes.made + changes.dropped > 0) index_slots(body);
    return changes;
}

namespace {

// Whether any shape function has departed from its initial value by more than the fall-back allows.
bool departs(const std::array<double, 3>& now, const std::array<double, 3>& initial) {
    return std::abs(now[0] - initial[0]) > 0.5 || std::abs(now[1] - initial[1]) > 0.5 || std::abs(now[2] - initial[2]) > 0.5;
}

// Gives the nodes of one side the mass that the point's present shape functions ask for beyond what is covered.
double cover(Assembly& body, const EdgeNodes& nodes, const std::array<double, 3>& needed, std::array<double, 3>& covered, double per_share) {
    double kinetic = 0.0;
    for (int i = 0; i < 3; ++i) {
        if (needed[i] <= covered[i]) continue;
        kinetic += add_mass(body.nodes, nodes[i], per_share * (needed[i] - covered[i]));
        covered[i] = needed[i];
    }
    return kinetic;
}

// An extrapolated point is stiffer than the masses were made for: sum |N| grows from 1 to 2 a side before the fall-back. The
// bound has a margin of a tenth (largest omega^2 3.5 of 4), so masses follow in steps of that size.
double follow_stiffness(Assembly& body, const Contact& contact, int p, const std::array<double, 3>& Na, const std::array<double, 3>& Nb,
                        double mass_factor) {
    InitialShape& shape = body.initial_shapes[p];
    const bool grain_b = contact.b.grain >= 0;
    std::array<double, 3> a{}, b{};
    stiffness_shares(Na, Nb, grain_b, a, b);
    bool beyond = false;
    for (int i = 0; i < 3; ++i) beyond = beyond || a[i] > 1.1 * shape.covered_a[i] + 0.05 || b[i] > 1.1 * shape.covered_b[i] + 0.05;
    if (!beyond) return 0.0;
    const BondLaw& law = body.laws[contact.material];
    const double per_share = 0.25 * mass_factor * body.points[p].area_m2 * std::max(law.Kn_Pa_m, law.Ks_Pa_m);
    double kinetic = cover(body, contact.a.node, a, shape.covered_a, per_share);
    if (grain_b) kinetic += cover(body, contact.b.node, b, shape.covered_b, per_share);
    return kinetic;
}

}  // namespace

ShapeChoice choose_shape_functions(Assembly& body, double mass_factor) {
    ShapeChoice choice;
    for (Contact& contact : body.contacts) {
        contact.initial_shape = false;
        if (contact.dropped) continue;
        const ContactFrame frame = contact_frame(body, contact);
        const bool grain_b = contact.b.grain >= 0;
        const auto pa = corners(body.nodes, contact.a.node);
        const auto pb = grain_b ? corners(body.nodes, contact.b.node) : pa;
        const auto shapes_at = [&](int p) {
            const Vec2 x = frame.reference_point + body.points[p].along_m * frame.edge_tangent;
            return std::array{shape_functions(pa, x), shape_functions(pb, x)};
        };
        const int end = contact.first_point + contact.points;
        for (int p = contact.first_point; p < end && !contact.initial_shape; ++p) {
            const auto [Na, Nb] = shapes_at(p);
            contact.initial_shape = departs(Na, body.initial_shapes[p].a) || (grain_b && departs(Nb, body.initial_shapes[p].b));
        }
        if (contact.initial_shape) {
            choice.fallback_sides += grain_b ? 2 : 1;
        } else if (mass_factor > 0.0) {
            for (int p = contact.first_point; p < end; ++p) {
                const auto [Na, Nb] = shapes_at(p);
                choice.kinetic_J += follow_stiffness(body, contact, p, Na, Nb, mass_factor);
            }
        }
    }
    return choice;
}

}  // namespace feldspar
