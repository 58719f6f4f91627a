#include "feldspar/model/platens.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "feldspar/base/error.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Where the outline can be pressed: a grain's edge on it, or an inner particle's share of that edge. Counter-clockwise.
struct OutlineSite {
    int body = 0;
    int grain_edge = -1;   // into Assembly::edges
    SideNodes node{};
    Vec2 from, to;
    int label = 0;   // into Outline::edge_labels

    Vec2 outward() const { return (-1.0 / norm(to - from)) * rot90(to - from); }
    double length() const { return norm(to - from); }
};

std::vector<OutlineSite> outline_sites(const Assembly& assembly, const Specimen& specimen) {
    std::vector<OutlineSite> sites;
    const std::vector<Cell>& cells = specimen.cells.cells;
    if (assembly.edges.empty()) {   // the bodies are the particles
        for (const OutlineShare& share : specimen.filling.outline) {
            const std::int32_t particle = assembly.body_of_particle[share.particle];
            const Body& body = assembly.bodies[particle];
            sites.push_back({particle, -1, {body.node(0), body.node(1), -1}, share.from, share.to, cells[share.cell].outline_edges[share.edge]});
        }
        std::stable_sort(sites.begin(), sites.end(), [](const OutlineSite& l, const OutlineSite& r) { return l.body < r.body; });
        return sites;
    }
    for (int g = 0; g < std::ssize(cells); ++g)
        for (int k = 0; k < std::ssize(cells[g].vertices); ++k) {
            if (cells[g].neighbours[k] >= 0) continue;
            const int grain_edge = assembly.bodies[g].edge_begin + k;
            const GrainEdge& edge = assembly.edges[grain_edge];
            sites.push_back({g, grain_edge, edge.node, edge.from, edge.to, cells[g].outline_edges[k]});
        }
    return sites;
}

BondLaw law_at_plates(const PlateContact& contact) {
    if (contact.glued) return BondLaw::unbreakable(contact.Kn_Pa_m, 0.0);
    BondLaw law;
    law.Kn_Pa_m = contact.Kn_Pa_m;
    law.Ks_Pa_m = contact.eta * contact.Kn_Pa_m;
    law.mu = contact.mu;
    return law;
}

int add_plate(Assembly& assembly, Vec2 place, Vec2 normal, Vec2 free) {
    Body plate;
    plate.kind = BodyKind::plate;
    plate.normal = normal;
    plate.first_node = plate.centre_node = assembly.nodes.add(place, free);
    plate.node_count = 1;
    assembly.bodies.push_back(plate);
    return static_cast<int>(assembly.bodies.size()) - 1;
}

// A contact of the site with a plate at the point `touch` of the site's edge; `gap_m` is left between them.
void add_plate_contact(Assembly& assembly, const OutlineSite& site, int plate, Vec2 touch, double area_m2, double gap_m, ContactRole material) {
    const Vec2 normal = assembly.bodies[plate].normal, arm = touch - assembly.centre(site.body);
    Contact contact;
    contact.a = side_of(assembly, site.body, site.node, site.grain_edge);
    contact.b = side_of(assembly, plate, {assembly.bodies[plate].centre_node, -1, -1}, -1);
    contact.plate = true;
    contact.material = material;
    contact.offset_m = dot(arm, normal);
    contact.points = 1;
    BondState bond;
    if (assembly.laws[material].sigma_nt_Pa == 0.0) {   // not glued
        bond.un_m = gap_m;
        bond.damage = 1.0;
    }
    contact.first_point = assembly.add_point(dot(arm, rot90(normal)), area_m2, bond);
    add_contact(assembly, contact, {-1, -1, site.from, site.to});
}

struct Touch {
    OutlineSite site;
    Vec2 place;
};

// One platen as a plate: at first touch with the highest of the places (lowest for the bottom).
// `bend_m` is by how much the plate's surface stands out towards the specimen, as a function of x (a jaw's; flat: 0).
void attach_plate(Assembly& assembly, int side, const std::vector<Touch>& touches, const std::function<double(const OutlineSite&)>& area_m2,
                  const std::function<double(double)>& bend_m = [](double) { return 0.0; }) {
    const double sign = side == 0 ? 1.0 : -1.0;
    double level = -kInfinity, left = kInfinity, right = -kInfinity;
    for (const Touch& touch : touches) {
        level = std::max(level, sign * touch.place.y + bend_m(touch.place.x));
        left = std::min(left, touch.place.x);
        right = std::max(right, touch.place.x);
    }
    const int plate = add_plate(assembly, {0.5 * (left + right), sign * level}, {0.0, sign}, {0.0, 0.0});
    for (const Touch& touch : touches)
        add_plate_contact(assembly, touch.site, plate, touch.place, area_m2(touch.site), level - bend_m(touch.place.x) - sign * touch.place.y, at_plates);
    Platen& platen = assembly.platens[side];
    platen.mode = {0.0, side == 0 ? -1.0 : 0.0};
    platen.nodes = {assembly.bodies[plate].centre_node};
    platen.plate = plate;
}

Vec2 at_x(const OutlineSite& site, double x) {
    x = std::clamp(x, std::min(site.from.x, site.to.x), std::max(site.from.x, site.to.x));
    return site.from + ((x - site.from.x) / (site.to.x - site.from.x)) * (site.to - site.from);
}

double distance_in_x(const OutlineSite& site, double x) {
    return std::max({0.0, std::min(site.from.x, site.to.x) - x, x - std::max(site.from.x, site.to.x)});
}

const std::string& label_of(const OutlineSite& site, const Specimen& specimen) { return specimen.outline.edge_labels[site.label]; }

void require_ends(const std::array<bool, 2>& found) {
    if (!found[0] || !found[1]) throw InputError({}, "the outline has no edge labelled \"top\" or none labelled \"bottom\"");
}

struct Extent {
    double lower = kInfinity, upper = -kInfinity;
    void include(double value) {
        lower = std::min(lower, value);
        upper = std::max(upper, value);
    }
};

// Where a membrane touches a site: at the height of the body's centre, or of the nearer end.
double at_height_of_body(const Assembly& assembly, const OutlineSite& site) {
    return std::clamp(assembly.centre(site.body).y, std::min(site.from.y, site.to.y), std::max(site.from.y, site.to.y));
}

int plate_at(double y, const Extent& height, int plates) {
    const double length = (height.upper - height.lower) / plates;
    return std::clamp(static_cast<int>((y - height.lower) / length), 0, plates - 1);
}

using Sides = std::array<std::vector<OutlineSite>, 2>;

bool each_plate_has_a_body(const Assembly& assembly, const Sides& sides, const std::array<Extent, 2>& heights, int plates) {
    for (int side = 0; side < 2; ++side) {
        std::vector<bool> touched(static_cast<std::size_t>(plates), false);
        for (const OutlineSite& site : sides[side]) touched[plate_at(at_height_of_body(assembly, site), heights[side], plates)] = true;
        if (std::find(touched.begin(), touched.end(), false) != touched.end()) return false;
    }
    return true;
}

// A plate with no body behind it would press on nothing.
void require_a_body_behind_each_plate(const Assembly& assembly, const Sides& sides, const std::array<Extent, 2>& heights, int plates) {
    int most = plates;
    while (most > 1 && !each_plate_has_a_body(assembly, sides, heights, most)) --most;
    if (most < plates)
        throw InputError({.key = "membrane_plates"}, fmt::format("{} plates a side are too many: one of them would have no grain behind it", plates),
                         fmt::format("{} plates a side for this specimen", most));
}

}  // namespace

void attach_platen_rows(Assembly& assembly, const Specimen& specimen) {
    Platen& top = assembly.platens[0];
    Platen& bottom = assembly.platens[1];
    top.mode = {0.0, -1.0};
    int begun = -1;   // sites come grain by grain
    for (const OutlineSite& site : outline_sites(assembly, specimen)) {
        const std::string& label = label_of(site, specimen);
        if (label == "top" || label == "bottom") {
            auto& row = label == "top" ? top.nodes : bottom.nodes;
            row.insert(row.end(), {site.node[0], site.node[1]});
            continue;
        }
        Body& grain = assembly.bodies[site.body];
        if (begun != site.body) grain.pressure_begin = static_cast<std::int32_t>(assembly.pressure_edges.size());
        begun = site.body;
        assembly.pressure_edges.push_back({site.node[0], site.node[1], site.outward(), 0.0});
        grain.pressure_end = static_cast<std::int32_t>(assembly.pressure_edges.size());
    }
    for (Platen* platen : {&top, &bottom}) {
        std::sort(platen->nodes.begin(), platen->nodes.end());
        platen->nodes.erase(std::unique(platen->nodes.begin(), platen->nodes.end()), platen->nodes.end());
        for (const int node : platen->nodes) assembly.nodes.inverse_mass[node].y = 0.0;
    }
    require_ends({!top.nodes.empty(), !bottom.nodes.empty()});
    double centre = 0.0;
    for (const int node : bottom.nodes) centre += assembly.nodes.reference[node].x / static_cast<double>(bottom.nodes.size());
    const auto held = std::min_element(bottom.nodes.begin(), bottom.nodes.end(), [&](int i, int j) {
        return std::abs(assembly.nodes.reference[i].x - centre) < std::abs(assembly.nodes.reference[j].x - centre);
    });
    assembly.nodes.inverse_mass[*held].x = 0.0;
    index_contacts(assembly);
}

void attach_brazilian_plates(Assembly& assembly, const Specimen& specimen, const PlateContact& contact) {
    assembly.laws[at_plates] = law_at_plates(contact);
    const std::vector<OutlineSite> sites = outline_sites(assembly, specimen);
    const auto is_flat = [&](const OutlineSite& site, int side) { return site.label == (side == 0 ? top_flat : bottom_flat); };   // labels of a whole disc are 0
    for (int side = 0; side < 2; ++side) {
        const double sign = side == 0 ? 1.0 : -1.0;
        std::vector<Touch> touches;
        for (std::size_t i = 0; i < sites.size();) {   // of each body the edge under the outermost point of its circle
            const int body = sites[i].body;
            const double x = assembly.centre(body).x;
            const OutlineSite* best = nullptr;
            bool on_flat = false;
            for (; i < sites.size() && sites[i].body == body; ++i) {
                if (is_flat(sites[i], side)) {
                    touches.push_back({sites[i], 0.5 * (sites[i].from + sites[i].to)});
                    on_flat = true;
                }
                if (sign * sites[i].outward().y < 0.5) continue;   // steeper than 60 degrees: no plate ever reaches it
                if (best == nullptr || distance_in_x(sites[i], x) < distance_in_x(*best, x)) best = &sites[i];
            }
            if (best != nullptr && !on_flat) touches.push_back({*best, at_x(*best, x)});
        }
        if (touches.empty()) throw InputError({}, "no grain of the disc faces the plates");
        const auto sagitta = [&](double x) {   // how far a jaw's arc has come down at x
            const double from_axis = x - specimen.outline.centre.x, radius = contact.jaw_radius_m;
            return radius > 0.0 ? radius - std::sqrt(radius * radius - from_axis * from_axis) : 0.0;
        };
        const auto area_m2 = [&](const OutlineSite& site) {
            return (is_flat(site, side) ? site.length() : 2.0 * assembly.bodies[site.body].radius_m) * assembly.thickness_m;
        };
        attach_plate(assembly, side, touches, area_m2, sagitta);
    }
    index_bodies(assembly);
    index_contacts(assembly);
}

void attach_end_plates(Assembly& assembly, const Specimen& specimen, const PlateContact& contact) {
    assembly.laws[at_plates] = law_at_plates(contact);
    std::array<std::vector<Touch>, 2> touches;
    for (const OutlineSite& site : outline_sites(assembly, specimen)) {
        const std::string& label = label_of(site, specimen);
        if (label != "top" && label != "bottom") continue;
        touches[label == "top" ? 0 : 1].push_back({site, at_x(site, assembly.centre(site.body).x)});
    }
    require_ends({!touches[0].empty(), !touches[1].empty()});
    for (int side = 0; side < 2; ++side)
        attach_plate(assembly, side, touches[side], [&](const OutlineSite& site) { return site.length() * assembly.thickness_m; });
    index_bodies(assembly);
    index_contacts(assembly);
}

void attach_membranes(Assembly& assembly, const Specimen& specimen, const PlateContact& contact, int plates) {
    assembly.laws[at_membranes] = law_at_plates(contact);
    Sides sides;   // left, right
    std::array<Extent, 2> heights;
    for (const OutlineSite& site : outline_sites(assembly, specimen)) {
        const std::string& label = label_of(site, specimen);
        if (label == "top" || label == "bottom") continue;
        if (std::abs(site.outward().y) > 1e-6)
            throw InputError({}, fmt::format("the side \"{}\" is not vertical, but the membrane of rigid grains and inner particles moves only horizontally", label),
                             "a rectangle, or flexible grains");
        const int side = site.outward().x < 0.0 ? 0 : 1;
        sides[side].push_back(site);
        for (const Vec2 end : {site.from, site.to}) heights[side].include(end.y);
    }
    require_a_body_behind_each_plate(assembly, sides, heights, plates);
    for (int side = 0; side < 2; ++side) {
        const double height = heights[side].upper - heights[side].lower, length = height / plates;
        const Vec2 outward = {side == 0 ? -1.0 : 1.0, 0.0};
        const int first = static_cast<int>(assembly.bodies.size());
        for (int i = 0; i < plates; ++i) {
            const Vec2 place = {sides[side].front().from.x, heights[side].lower + (i + 0.5) * length};
            const int plate = add_plate(assembly, place, outward, {1.0, 0.0});
            Body& body = assembly.bodies[plate];
            body.pressure_begin = static_cast<std::int32_t>(assembly.pressure_edges.size());
            assembly.pressure_edges.push_back({body.centre_node, body.centre_node, outward, length});
            body.pressure_end = body.pressure_begin + 1;
        }
        for (const OutlineSite& site : sides[side]) {
            const double y = at_height_of_body(assembly, site);
            const int plate = first + plate_at(y, heights[side], plates);
            add_plate_contact(assembly, site, plate, {site.from.x, y}, site.length() * assembly.thickness_m, 0.0, at_membranes);
        }
    }
    index_bodies(assembly);
    index_contacts(assembly);
}

double loaded_width_m(const Assembly& assembly, const Specimen& specimen) {
    Extent width;
    for (const OutlineSite& site : outline_sites(assembly, specimen))
        if (label_of(site, specimen) == "top")
            for (const Vec2 end : {site.from, site.to}) width.include(end.x);
    return width.upper - width.lower;
}

}  // namespace feldspar
