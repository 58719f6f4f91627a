#include "feldspar/model/fixtures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/model/assemble.hpp"

namespace feldspar {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Where the outline can be pressed: a grain's edge on it, or an inner particle's share of that edge. Counter-clockwise.
struct OutlineSite {
    int body = 0;
    int grain_edge = -1;  // into Assembly::edges
    SideNodes node{};
    Vec2 from, to;
    int label = 0;  // into Outline::edge_labels

    Vec2 outward() const { return (-1.0 / norm(to - from)) * rot90(to - from); }
    double length() const { return norm(to - from); }
};

std::vector<OutlineSite> outline_sites(const Assembly& assembly, const Specimen& specimen) {
    std::vector<OutlineSite> sites;
    const std::vector<Cell>& cells = specimen.cells.cells;
    if (assembly.edges.empty()) {  // the bodies are the particles
        for (const OutlineShare& share : specimen.filling.outline) {
            const std::int32_t particle = assembly.body_of_particle[share.particle];
            const Body& body = assembly.bodies[particle];
            sites.push_back({particle,
                             -1,
                             {body.node(0), body.node(1), -1},
                             share.from,
                             share.to,
                             cells[share.cell].outline_edges[share.edge]});
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

struct Extent {
    double lower = kInfinity, upper = -kInfinity;
    void include(double value) {
        lower = std::min(lower, value);
        upper = std::max(upper, value);
    }
};

// Coordinate along a plate with this normal: x for horizontal plates.
struct Along {
    Vec2 direction;
    explicit Along(Vec2 normal) : direction(rot90(normal)) {  // to the right, or up
        if (direction.x < 0.0 || (direction.x == 0.0 && direction.y < 0.0)) direction = -direction;
    }
    double operator()(Vec2 place) const { return dot(place, direction); }
};

// The point of the site whose coordinate along the plate is nearest to `c`.
Vec2 at_coordinate(const OutlineSite& site, const Along& along, double c) {
    const double from = along(site.from), to = along(site.to);
    c = std::clamp(c, std::min(from, to), std::max(from, to));
    return to == from ? site.from : site.from + ((c - from) / (to - from)) * (site.to - site.from);
}

double distance_along(const OutlineSite& site, const Along& along, double c) {
    const double from = along(site.from), to = along(site.to);
    return std::max({0.0, std::min(from, to) - c, c - std::max(from, to)});
}

BondLaw law_at(const PlateContact& contact) {
    if (contact.glued) return BondLaw::unbreakable(contact.Kn_Pa_m, 0.0);
    return BondLaw::frictional(contact.Kn_Pa_m, contact.eta, contact.mu);
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
void add_plate_contact(Assembly& assembly, const OutlineSite& site, int plate, Vec2 touch, double area_m2, double gap_m,
                       std::int32_t material, bool glued = false) {
    const Vec2 normal = assembly.bodies[plate].normal, arm = touch - assembly.centre(site.body);
    Contact contact;
    contact.a = side_of(assembly, site.body, site.node, site.grain_edge);
    contact.b = side_of(assembly, plate, {assembly.bodies[plate].centre_node, -1, -1}, -1);
    contact.plate = true;
    contact.material = material;
    contact.offset_m = dot(arm, normal);
    contact.points = 1;
    BondState bond;
    if (!glued) {
        bond.un_m = gap_m;
        bond.damage = 1.0;
    }
    contact.first_point = assembly.add_point(dot(arm, rot90(normal)), area_m2, bond);
    add_contact(assembly, contact, {-1, -1, site.from, site.to});
}

// The coordinate of a site's body along a membrane, kept within the site.
double beside_centre(const Assembly& assembly, const OutlineSite& site, const Along& along) {
    const double from = along(site.from), to = along(site.to);
    return std::clamp(along(assembly.centre(site.body)), std::min(from, to), std::max(from, to));
}

int plate_at(double c, const Extent& extent, int plates) {
    const double length = (extent.upper - extent.lower) / plates;
    return std::clamp(static_cast<int>((c - extent.lower) / length), 0, plates - 1);
}

// One list of fixtures being put to one specimen.
class Attaching {
public:
    Attaching(Assembly& assembly, const Specimen& specimen)
        : assembly_(assembly), specimen_(specimen), sites_(outline_sites(assembly, specimen)), taken_(sites_.size(), false) {}

    void operator()(const FixtureSpec& spec) {
        switch (spec.kind) {
            case FixtureKind::nodes:
                return attach_nodes(spec);
            case FixtureKind::plate:
                return attach_plate(spec);
            case FixtureKind::membrane:
                return attach_membrane(spec);
            case FixtureKind::pressure:
                return attach_pressure(spec);
        }
    }

    /// After the last fixture: pressures, body by body.
    void finish() {
        std::stable_sort(pressed_.begin(), pressed_.end(), [](const Pressed& l, const Pressed& r) { return l.body < r.body; });
        std::vector<double> areas(assembly_.dead_loads.size(), 0.0);
        for (const auto& [number, edge] : pressed_) {
            Body& body = assembly_.bodies[number];
            const auto here = static_cast<std::int32_t>(assembly_.pressure_edges.size());
            if (body.pressure_end == 0) body.pressure_begin = here;
            body.pressure_end = here + 1;
            assembly_.pressure_edges.push_back(edge);
            const Array<Vec2>& X = assembly_.nodes.reference;
            const double area =
                (edge.plate_length_m > 0.0 ? edge.plate_length_m : norm(X[edge.node_b] - X[edge.node_a])) * assembly_.thickness_m;
            assembly_.dead_loads[edge.load].resultant_m2 += -area * edge.outward;
            areas[edge.load] += area;
        }
        constexpr double kRounding = 1e-9;  // opposite sides cancel but for their rounding
        for (std::size_t i = 0; i < areas.size(); ++i)
            for (double Vec2::*c : {&Vec2::x, &Vec2::y})
                if (std::abs(assembly_.dead_loads[i].resultant_m2.*c) < kRounding * areas[i])
                    assembly_.dead_loads[i].resultant_m2.*c = 0.0;
    }

private:
    struct TouchedSite {
        OutlineSite site;
        Vec2 place;
        double area_m2;
    };

    const std::string& label_of(const OutlineSite& site) const { return specimen_.outline.edge_labels[site.label]; }

    bool belongs(const OutlineSite& site, const BoundaryPart& part) const {
        if (!part.label.empty() && label_of(site) != part.label) return false;
        if (part.facing != Vec2{} && dot(site.outward(), part.facing) < part.least_cosine) return false;
        if (part.inside) {
            const Vec2 middle = 0.5 * (site.from + site.to), a = (*part.inside)[0], b = (*part.inside)[1];
            if (middle.x < std::min(a.x, b.x) || middle.x > std::max(a.x, b.x) || middle.y < std::min(a.y, b.y) ||
                middle.y > std::max(a.y, b.y))
                return false;
        }
        return !part.at || distance_to_segment(*part.at, site.from, site.to) <= part.reach_m;
    }

    // Into sites_, in their order. What moves with a fixture, or is pressed by one, is taken.
    std::vector<std::size_t> sites_of(const FixtureSpec& spec, bool takes) {
        std::vector<std::size_t> found;
        for (std::size_t s = 0; s < sites_.size(); ++s)
            if (belongs(sites_[s], spec.part) && !(spec.part.remaining && taken_[s])) found.push_back(s);
        if (takes)
            for (const std::size_t s : found) taken_[s] = true;
        return found;
    }

    void require(bool found, const FixtureSpec& spec) const {
        if (found) return;
        if (!spec.part.label.empty())
            throw InputError({}, fmt::format("the outline has no edge labelled \"{}\", which the fixture \"{}\" needs",
                                             spec.part.label, spec.name));
        throw InputError({}, fmt::format("no grain on the boundary lies where the fixture \"{}\" is", spec.name));
    }

    Fixture& add_fixture(const FixtureSpec& spec) {
        Fixture fixture;
        fixture.name = spec.name;
        fixture.motion = spec.motion;
        assembly_.fixtures.push_back(std::move(fixture));
        return assembly_.fixtures.back();
    }

    // Rigid bodies have no nodes on the boundary: those of their sites are centre and turn.
    void require_flexible(const FixtureSpec& spec) const {
        if (assembly_.node_of_mesh.empty())
            throw InputError(
                {.key = "test.fixture"},
                fmt::format("the fixture \"{}\" takes the nodes on the boundary, which only flexible grains have", spec.name),
                "a plate, roller or jaw for rigid grains and inner particles");
    }

    void attach_nodes(const FixtureSpec& spec) {
        require_flexible(spec);
        std::vector<std::int32_t> nodes;
        for (const std::size_t s : sites_of(spec, true)) nodes.insert(nodes.end(), {sites_[s].node[0], sites_[s].node[1]});
        require(!nodes.empty(), spec);
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
        Nodes& all = assembly_.nodes;
        for (const int node : nodes) {
            if (spec.imposes_x) all.inverse_mass[node].x = 0.0;
            if (spec.imposes_y) all.inverse_mass[node].y = 0.0;
        }
        if (spec.pins_middle) pin_middle(nodes, spec.imposes_y);
        Fixture& fixture = add_fixture(spec);
        fixture.nodes = std::move(nodes);
        fixture.imposed = {spec.imposes_x ? 1.0 : 0.0, spec.imposes_y ? 1.0 : 0.0};
    }

    void pin_middle(const std::vector<std::int32_t>& nodes, bool along_x) {
        const Array<Vec2>& X = assembly_.nodes.reference;
        double Vec2::*const c = along_x ? &Vec2::x : &Vec2::y;
        double centre = 0.0;
        for (const int node : nodes) centre += X[node].*c / static_cast<double>(nodes.size());
        const auto held = std::min_element(nodes.begin(), nodes.end(),
                                           [&](int i, int j) { return std::abs(X[i].*c - centre) < std::abs(X[j].*c - centre); });
        assembly_.nodes.inverse_mass[*held].*c = 0.0;
    }

    void attach_pressure(const FixtureSpec& spec) {
        require_flexible(spec);
        const std::int32_t load = add_load(spec);
        for (const std::size_t s : sites_of(spec, false)) {
            const OutlineSite& site = sites_[s];
            pressed_.push_back({site.body, {site.node[0], site.node[1], site.outward(), 0.0, load}});
        }
    }

    std::int32_t add_load(const FixtureSpec& spec) {
        assembly_.dead_loads.push_back(
            {.name = spec.name, .given_Pa = spec.pressure_Pa, .stiffness_Pa_m = spec.spring_Pa_m, .outward = spec.normal});
        return static_cast<std::int32_t>(assembly_.dead_loads.size()) - 1;
    }

    void press_plate(const FixtureSpec& spec, int plate, double length_m) {
        const std::int32_t load = add_load(spec);
        const int node = assembly_.bodies[plate].centre_node;
        DeadLoad& added = assembly_.dead_loads.back();
        if (spec.force_N != 0.0) added.given_Pa = spec.force_N / (length_m * assembly_.thickness_m);
        added.plate_node = node;
        pressed_.push_back({plate, {node, node, spec.normal, length_m, load}});
    }

    // How far a curved surface has come towards the specimen (hollow) or gone back from it (round), at `c` along the plate; none
    // where a round one ends.
    std::optional<double> bend(const FixtureSpec& spec, const Along& along, double c) const {
        if (spec.radius_m == 0.0) return 0.0;
        const double from_axis = c - along(*spec.axis), radius = std::abs(spec.radius_m),
                     under = radius * radius - from_axis * from_axis;
        if (!(under >= 0.0)) return std::nullopt;
        const double sagitta = radius - std::sqrt(under);
        return spec.radius_m > 0.0 ? sagitta : -sagitta;
    }

    std::vector<TouchedSite> under_circles(const FixtureSpec& spec, const Along& along) {
        std::vector<TouchedSite> touches;
        for (std::size_t i = 0; i < sites_.size();) {
            const int body = sites_[i].body;
            const double c = along(assembly_.centre(body));
            std::size_t best = sites_.size();
            bool on_flat = false;
            for (; i < sites_.size() && sites_[i].body == body; ++i) {
                const OutlineSite& site = sites_[i];
                if (!spec.flat_label.empty() && label_of(site) == spec.flat_label) {
                    touches.push_back({site, 0.5 * (site.from + site.to), site.length() * assembly_.thickness_m});
                    taken_[i] = on_flat = true;
                }
                if (!belongs(site, spec.part)) continue;
                if (best == sites_.size() || distance_along(site, along, c) < distance_along(sites_[best], along, c)) best = i;
            }
            if (best == sites_.size() || on_flat) continue;
            touches.push_back({sites_[best], at_coordinate(sites_[best], along, c),
                               2.0 * assembly_.bodies[body].radius_m * assembly_.thickness_m});
            taken_[best] = true;
        }
        return touches;
    }

    std::vector<TouchedSite> touches_of(const FixtureSpec& spec, const Along& along) {
        if (spec.touch == Touch::under_circle) return under_circles(spec, along);
        std::vector<TouchedSite> touches;
        for (const std::size_t s : sites_of(spec, true)) {
            const OutlineSite& site = sites_[s];
            const double c = along(spec.touch == Touch::nearest_axis ? *spec.axis : assembly_.centre(site.body));
            touches.push_back({site, at_coordinate(site, along, c), site.length() * assembly_.thickness_m});
        }
        return touches;
    }

    // Fixtures that touch alike share a law.
    std::int32_t law_of(const FixtureSpec& spec) {
        for (std::size_t i = 0; i < laws_.size(); ++i)
            if (laws_[i] == spec.contact) return role_of(i);
        const std::int32_t role = role_of(laws_.size());
        if (role >= contact_roles)
            throw InputError(
                {}, fmt::format("plates of more than {} kinds, in stiffness and friction", contact_roles - at_more_plates + 1),
                "fewer kinds of plates");
        laws_.push_back(spec.contact);
        assembly_.laws[role] = law_at(spec.contact);
        return role;
    }
    static std::int32_t role_of(std::size_t law) {
        return law == 0 ? static_cast<std::int32_t>(at_plates) : at_more_plates + static_cast<std::int32_t>(law) - 1;
    }

    void attach_plate(const FixtureSpec& spec) {
        const Along along(spec.normal);
        const std::vector<TouchedSite> touches = touches_of(spec, along);
        double level = -kInfinity;
        Extent extent;
        bool any = false;
        for (const TouchedSite& touch : touches) {
            const auto out = bend(spec, along, along(touch.place));
            if (!out) continue;
            level = std::max(level, dot(spec.normal, touch.place) + *out);
            extent.include(along(touch.place));
            any = true;
        }
        require(any, spec);
        const std::int32_t material = law_of(spec);
        const Vec2 free = spec.pressed ? Vec2{std::abs(spec.normal.x), std::abs(spec.normal.y)} : Vec2{};
        const int plate =
            add_plate(assembly_, level * spec.normal + 0.5 * (extent.lower + extent.upper) * along.direction, spec.normal, free);
        for (const TouchedSite& touch : touches)
            if (const auto out = bend(spec, along, along(touch.place)))
                add_plate_contact(assembly_, touch.site, plate, touch.place, touch.area_m2,
                                  level - *out - dot(spec.normal, touch.place), material, spec.contact.glued);
        if (spec.pressed) press_plate(spec, plate, whole_length(touches, along));
        Fixture& fixture = add_fixture(spec);
        fixture.imposed = Vec2{1.0, 1.0} - free;
        fixture.nodes = {assembly_.bodies[plate].centre_node};
        fixture.plate = plate;
    }

    // Over which a pressed plate covers the specimen, along itself.
    static double whole_length(const std::vector<TouchedSite>& touches, const Along& along) {
        Extent extent;
        for (const TouchedSite& touch : touches)
            for (const Vec2 end : {touch.site.from, touch.site.to}) extent.include(along(end));
        return extent.upper - extent.lower;
    }

    bool each_plate_has_a_body(const std::vector<std::size_t>& side, const Along& along, const Extent& extent, int plates) const {
        std::vector<bool> touched(static_cast<std::size_t>(plates), false);
        for (const std::size_t s : side) touched[plate_at(beside_centre(assembly_, sites_[s], along), extent, plates)] = true;
        return std::find(touched.begin(), touched.end(), false) == touched.end();
    }

    // A plate with no body behind it would press on nothing.
    void require_a_body_behind_each_plate(const std::vector<std::size_t>& side, const Along& along, const Extent& extent,
                                          int plates) const {
        int most = plates;
        while (most > 1 && !each_plate_has_a_body(side, along, extent, most)) --most;
        if (most < plates)
            throw InputError({.key = "membrane_plates"},
                             fmt::format("{} plates a side are too many: one of them would have no grain behind it", plates),
                             fmt::format("{} plates a side for this specimen", most));
    }

    void attach_membrane(const FixtureSpec& spec) {
        assembly_.laws[at_membranes] = law_at(spec.contact);
        const Along along(spec.normal);
        const std::vector<std::size_t> side = sites_of(spec, false);
        require(!side.empty(), spec);
        Extent extent;
        for (const std::size_t s : side) {
            for (const Vec2 end : {sites_[s].from, sites_[s].to}) extent.include(along(end));
            if (std::abs(dot(sites_[s].outward(), along.direction)) > 1e-6)
                throw InputError({},
                                 fmt::format("the side \"{}\" is not vertical, but the membrane of rigid grains and inner "
                                             "particles moves only horizontally",
                                             label_of(sites_[s])),
                                 "a rectangle, or flexible grains");
        }
        require_a_body_behind_each_plate(side, along, extent, spec.plates);
        const std::int32_t load = add_load(spec);
        const double length = (extent.upper - extent.lower) / spec.plates, level = dot(sites_[side.front()].from, spec.normal);
        const int first = static_cast<int>(assembly_.bodies.size());
        for (int i = 0; i < spec.plates; ++i) {
            const Vec2 place = level * spec.normal + (extent.lower + (i + 0.5) * length) * along.direction;
            const int plate = add_plate(assembly_, place, spec.normal, {std::abs(spec.normal.x), std::abs(spec.normal.y)});
            const int node = assembly_.bodies[plate].centre_node;
            pressed_.push_back({plate, {node, node, spec.normal, length, load}});
        }
        for (const std::size_t s : side) {
            const OutlineSite& site = sites_[s];
            const double c = beside_centre(assembly_, site, along);
            const Vec2 touch = dot(site.from, spec.normal) * spec.normal + c * along.direction;
            add_plate_contact(assembly_, site, first + plate_at(c, extent, spec.plates), touch,
                              site.length() * assembly_.thickness_m, 0.0, at_membranes);
        }
    }

    Assembly& assembly_;
    const Specimen& specimen_;
    std::vector<OutlineSite> sites_;
    std::vector<bool> taken_;
    std::vector<PlateContact> laws_;
    struct Pressed {
        int body;
        PressureEdge edge;
    };
    std::vector<Pressed> pressed_;
};

}  // namespace

void attach(Assembly& assembly, const Specimen& specimen, std::span<const FixtureSpec> fixtures) {
    Attaching attach_one(assembly, specimen);
    for (const FixtureSpec& fixture : fixtures) attach_one(fixture);
    attach_one.finish();
    index_bodies(assembly);
    index_contacts(assembly);
    release_spare_memory(assembly);
}

double labelled_width_m(const Specimen& specimen, const std::string& label) {
    Extent width;
    for (const Cell& cell : specimen.cells.cells)
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            if (cell.neighbours[k] >= 0 || specimen.outline.edge_labels[cell.outline_edges[k]] != label) continue;
            for (const int v : {cell.vertices[k], cell.vertices[(k + 1) % cell.vertices.size()]})
                width.include(specimen.cells.vertices[v].x);
        }
    return width.upper > width.lower ? width.upper - width.lower : 0.0;
}

}  // namespace feldspar
