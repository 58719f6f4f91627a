#include "feldspar/model/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "feldspar/base/error.hpp"
#include "feldspar/base/heap_bytes.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/model/attachment.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/model/texture.hpp"
#include "feldspar/specimen/cell_graph.hpp"

namespace feldspar {
namespace {

constexpr Vec2 kFree{1.0, 1.0};
constexpr Vec2 kTurn{1.0, 0.0};  // of a turn only x moves

Triangle make_triangle(std::span<const Vec2> X, const SideNodes& node, double thickness_m) {
    const Vec2 e1 = X[node[1]] - X[node[0]], e2 = X[node[2]] - X[node[0]];
    const double twice_area = cross(e1, e2);
    Triangle triangle;
    triangle.node = node;
    triangle.gradient = {Vec2{e2.y / twice_area, -e2.x / twice_area}, Vec2{-e1.y / twice_area, e1.x / twice_area}};
    triangle.volume_m3 = 0.5 * twice_area * thickness_m;
    return triangle;
}

// The nodes of the triangle behind edge k of grain g, turned so that the edge comes first; in the mesh's own numbers.
SideNodes nodes_behind_edge(const GrainMesh& mesh, int g, int k) {
    const int nv = mesh.vertex_count[g];
    const std::int32_t from = mesh.node_begin[g] + k, to = mesh.node_begin[g] + (k + 1) % nv;
    for (const int node : mesh.triangles[mesh.edge_triangle[mesh.edge_begin[g] + k]])
        if (node != from && node != to) return {from, to, node};
    throw NumericalError("a grain edge without a triangle of its own");
}

// The mesh node that is local node i of a lane: vertices, centre, ring.
int mesh_node(const GrainMesh& mesh, const GrainPack& pack, int lane, int i) {
    const int g = pack.grain[lane];
    const auto vertex = [&](int k) { return (k + pack.start[lane]) % pack.vertices; };
    if (i < pack.vertices) return mesh.node_begin[g] + vertex(i);
    if (i == pack.vertices) return mesh.centre_node[g];
    return mesh.triangles[mesh.edge_triangle[mesh.edge_begin[g] + vertex(i - pack.vertices - 1)]][2];
}

// Numbers the nodes pack by pack, and behind them those of grains that are in no pack, and adds them. Tells the bodies.
void add_nodes(Assembly& assembly, const GrainMesh& mesh) {
    assembly.packs.grains = pack_grains(mesh);
    assembly.node_of_mesh.assign(mesh.nodes.size(), -1);
    int next = 0;
    for (const GrainPack& pack : assembly.packs.grains) {
        for (int lane = 0; lane < pack.lanes; ++lane) {
            Body& body = assembly.bodies[pack.grain[lane]];
            body.first_node = pack.first_node + lane;
            body.node_stride = pack.lanes;
            for (int i = 0; i < pack.nodes(); ++i) assembly.node_of_mesh[mesh_node(mesh, pack, lane, i)] = body.node(i);
        }
        next = pack.first_node + pack.nodes() * pack.lanes;
    }
    for (int g = 0; g < std::ssize(assembly.bodies); ++g) {
        Body& body = assembly.bodies[g];
        body.node_count = mesh.node_begin[g + 1] - mesh.node_begin[g];
        if (assembly.node_of_mesh[mesh.node_begin[g]] >= 0) continue;
        body.first_node = next;
        for (int n = mesh.node_begin[g]; n < mesh.node_begin[g + 1]; ++n) assembly.node_of_mesh[n] = next++;
    }
    std::vector<Vec2> places(mesh.nodes.size());
    for (std::size_t n = 0; n < places.size(); ++n) places[assembly.node_of_mesh[n]] = mesh.nodes[n];
    assembly.nodes.reserve(places.size());
    for (const Vec2 X : places) assembly.nodes.add(X, kFree);
}

// The grain's outline; `nodes_of(k)` is where a contact on edge k hangs.
template <class NodesOf>
void add_edges(Assembly& assembly, Body& body, const Tessellation& cells, NodesOf nodes_of) {
    const std::vector<Vec2> corners = corners_of_cell(cells, body.grain);
    body.edge_begin = static_cast<std::int32_t>(assembly.edges.size());
    for (std::size_t k = 0; k < corners.size(); ++k)
        assembly.edges.push_back({nodes_of(static_cast<int>(k)), corners[k], corners[(k + 1) % corners.size()]});
    body.edge_end = static_cast<std::int32_t>(assembly.edges.size());
}

void add_flexible_grains(Assembly& assembly, const Specimen& specimen) {
    const GrainMesh& mesh = specimen.mesh;
    assembly.bodies.resize(mesh.vertex_count.size());
    add_nodes(assembly, mesh);
    const auto in_assembly = [&](const auto& t) {
        return SideNodes{assembly.node_of_mesh[t[0]], assembly.node_of_mesh[t[1]], assembly.node_of_mesh[t[2]]};
    };
    assembly.triangles.reserve(mesh.triangles.size());
    for (const auto& t : mesh.triangles)
        assembly.triangles.push_back(make_triangle(assembly.nodes.reference, in_assembly(t), assembly.thickness_m));
    for (int g = 0; g < std::ssize(assembly.bodies); ++g) {
        Body& body = assembly.bodies[g];
        body.kind = BodyKind::flexible;
        body.grain = g;
        body.triangle_begin = mesh.triangle_begin[g];
        body.triangle_end = mesh.triangle_begin[g + 1];
        body.centre_node = assembly.node_of_mesh[mesh.centre_node[g]];
        body.radius_m = specimen.packing.radii_m[g];
        add_edges(assembly, body, specimen.cells, [&](int k) { return in_assembly(nodes_behind_edge(mesh, g, k)); });
    }
}

Body rigid_body(Assembly& assembly, int grain, Vec2 centre, double radius_m) {
    Body body;
    body.kind = BodyKind::rigid;
    body.grain = grain;
    body.first_node = body.centre_node = assembly.nodes.add(centre, kFree);
    assembly.nodes.add(centre, kTurn);
    body.node_count = 2;
    body.radius_m = radius_m;
    return body;
}

void add_rigid_grains(Assembly& assembly, const Specimen& specimen) {
    for (int g = 0; g < std::ssize(specimen.cells.cells); ++g) {
        const Vec2 centre = specimen.mesh.nodes[specimen.mesh.centre_node[g]];
        Body body = rigid_body(assembly, g, centre, specimen.packing.radii_m[g]);
        const std::vector<Vec2> corners = corners_of_cell(specimen.cells, g);
        body.volume_m3 = signed_area(corners) * assembly.thickness_m;
        double polar = 0.0;  // of the triangles between the centre and the edges
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const Vec2 a = corners[k] - centre, b = corners[(k + 1) % corners.size()] - centre;
            polar += cross(a, b) * (dot(a, a) + dot(a, b) + dot(b, b)) / 12.0;
        }
        body.gyration_m2 = polar / signed_area(corners);
        add_edges(assembly, body, specimen.cells, [&](int) { return SideNodes{body.node(0), body.node(1), -1}; });
        assembly.bodies.push_back(body);
    }
}

// Particles by strips of the specimen from the bottom to the top, and from left to right in each, whatever grain they are of:
// contacts join what is near in this order, and bands can be narrow (model/bands.hpp).
std::vector<int> particles_in_strips(const Filling& filling) {
    const double strip = 3.0 * *std::max_element(filling.radii_m.begin(), filling.radii_m.end());
    std::vector<std::pair<double, double>> place;  // number of the strip, and where in it
    for (const Vec2 centre : filling.centres) place.push_back({std::floor(centre.y / strip), centre.x});
    std::vector<int> order(filling.centres.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int l, int r) { return place[l] < place[r]; });
    return order;
}

// The discs of a grain share its volume by their own areas.
void add_inner_particles(Assembly& assembly, const Specimen& specimen) {
    const Filling& filling = specimen.filling;
    std::vector<int> grain(filling.centres.size());
    std::vector<double> volume_over_squares;  // of each grain
    for (int g = 0; g < std::ssize(specimen.cells.cells); ++g) {
        double squares = 0.0;
        for (int p = filling.particle_begin[g]; p < filling.particle_begin[g + 1]; ++p) {
            squares += filling.radii_m[p] * filling.radii_m[p];
            grain[p] = g;
        }
        volume_over_squares.push_back(signed_area(corners_of_cell(specimen.cells, g)) * assembly.thickness_m / squares);
    }
    assembly.body_of_particle.resize(filling.centres.size());
    for (const int p : particles_in_strips(filling)) {
        const double R = filling.radii_m[p];
        Body body = rigid_body(assembly, grain[p], filling.centres[p], R);
        body.volume_m3 = volume_over_squares[grain[p]] * R * R;
        body.gyration_m2 = 0.5 * R * R;
        assembly.body_of_particle[p] = static_cast<std::int32_t>(assembly.bodies.size());
        assembly.bodies.push_back(body);
    }
}

// Geometry of a contact on the line p0 -> p1 between its two bodies (equations (5)-(8)).
void place_on_line(const Assembly& assembly, Contact& contact, Vec2 p0, Vec2 p1) {
    const Vec2 xa = assembly.centre(contact.a.body), xb = assembly.centre(contact.b.body);
    const double d = norm(xb - xa), length = norm(p1 - p0);
    const Vec2 n = (1.0 / d) * (xb - xa), t = (1.0 / length) * (p1 - p0);
    const double s = cross(p0 - xa, t) / cross(n, t);  // where the line of centres meets the edge's line
    contact.offset_m = s - 0.5 * d;                    // = (RA - RB)/2 + dv
    contact.tangent = {dot(t, n), dot(t, rot90(n))};
}

// On the circles' own contact plane (dv = 0).
double plane_between_circles(const Assembly& assembly, const Contact& contact) {
    return 0.5 * (assembly.bodies[contact.a.body].radius_m - assembly.bodies[contact.b.body].radius_m);
}

double free_gap_between_circles(const Assembly& assembly, const Contact& contact) {
    const double radii = assembly.bodies[contact.a.body].radius_m + assembly.bodies[contact.b.body].radius_m;
    return std::max(0.0, norm(assembly.centre(contact.b.body) - assembly.centre(contact.a.body)) - radii);
}

void set_closing_distance(const Assembly& assembly, Contact& contact) {
    const double radii = assembly.bodies[contact.a.body].radius_m + assembly.bodies[contact.b.body].radius_m;
    contact.closing_distance_m = std::max(radii, norm(assembly.centre(contact.b.body) - assembly.centre(contact.a.body)));
}

void add_bonded_contact(Assembly& assembly, ContactKind kind, int ga, int ka, int gb, int kb, bool smooth) {
    const GrainEdge& edge_a = assembly.edges[assembly.bodies[ga].edge_begin + ka];
    const GrainEdge& edge_b = assembly.edges[assembly.bodies[gb].edge_begin + kb];
    Contact contact;
    contact.smooth = smooth;
    contact.a = side_of(assembly, ga, edge_a.node, assembly.bodies[ga].edge_begin + ka);
    contact.b = side_of(assembly, gb, edge_b.node, assembly.bodies[gb].edge_begin + kb);
    const Vec2 p0 = edge_a.from, p1 = edge_a.to;
    const double area = norm(p1 - p0) * assembly.thickness_m;
    place_on_line(assembly, contact, p0, p1);
    set_closing_distance(assembly, contact);
    contact.first_point = static_cast<std::int32_t>(assembly.points.size());
    if (kind == ContactKind::lobatto3) {
        contact.points = 3;
        const ContactFrame frame = contact_frame(assembly, contact);
        const double from = dot(p0 - frame.reference_point, frame.edge_tangent), to = from + norm(p1 - p0);
        assembly.add_point(from, area / 6.0);
        assembly.add_point(0.5 * (from + to), 2.0 * area / 3.0);
        assembly.add_point(to, area / 6.0);
    } else {
        contact.points = 1;  // PCM
        contact.offset_m = plane_between_circles(assembly, contact);
        assembly.add_point(0.0, area);
    }
    add_contact(assembly, contact, {ka, kb, p0, p1});
}

// Bonds of contacts with several points stand pack by pack: the first points of all its contacts, then the second ones.
void lay_out_bonds(Assembly& assembly) {
    const int contacts = static_cast<int>(assembly.contacts.size());
    std::int32_t state = 0;
    for (int c = 0; c < contacts; c += kMostLanes) {
        const int lanes = std::min(kMostLanes, contacts - c), points = assembly.contacts[c].points;
        for (int j = 0; j < points; ++j)
            for (int lane = 0; lane < lanes; ++lane) assembly.points[assembly.contacts[c + lane].first_point + j].state = state++;
    }
}

void add_contacts_of_grains(Assembly& assembly, const Tessellation& cells, ContactKind kind) {
    std::unordered_map<std::uint64_t, std::pair<int, int>> owner;  // directed edge -> (cell, edge of the cell)
    owner.reserve(std::accumulate(cells.cells.begin(), cells.cells.end(), std::size_t{0},
                                  [](std::size_t sum, const Cell& cell) { return sum + cell.vertices.size(); }));
    for (int g = 0; g < std::ssize(cells.cells); ++g) {
        const Cell& cell = cells.cells[g];
        const int nv = static_cast<int>(cell.vertices.size());
        for (int k = 0; k < nv; ++k) owner[dart(cell.vertices[k], cell.vertices[(k + 1) % nv])] = {g, k};
    }
    struct Facing {
        int place;      // sum of those of the two grains, in the order of packs or rigid bodies
        double height;  // twice that of the edge's middle
        int ga, ka, gb, kb;
    };
    std::vector<Facing> facing;
    std::vector<int> place(cells.cells.size());
    std::iota(place.begin(), place.end(), 0);
    for (int p = 0; p < std::ssize(assembly.packs.grains); ++p)
        for (int lane = 0; lane < assembly.packs.grains[p].lanes; ++lane) place[assembly.packs.grains[p].grain[lane]] = p;
    for (int g = 0; g < std::ssize(cells.cells); ++g) {
        const Cell& cell = cells.cells[g];
        const int nv = static_cast<int>(cell.vertices.size());
        for (int k = 0; k < nv; ++k) {
            if (cell.neighbours[k] <= g) continue;
            const int from = cell.vertices[k], to = cell.vertices[(k + 1) % nv];
            const auto other = owner.find(dart(to, from));
            if (other == owner.end()) throw NumericalError("the tessellation is not conforming");
            facing.push_back({place[g] + place[other->second.first], cells.vertices[from].y + cells.vertices[to].y, g, k,
                              other->second.first, other->second.second});
        }
    }
    // From bottom to top, as the packs of grains are: a contiguous share is a band of the specimen (model/bands.hpp).
    std::stable_sort(facing.begin(), facing.end(), [](const Facing& l, const Facing& r) {
        return std::pair{l.place, l.height} < std::pair{r.place, r.height};
    });
    const std::size_t points_each = kind == ContactKind::lobatto3 ? 3 : 1;
    assembly.contacts.reserve(facing.size());
    assembly.origins.reserve(facing.size());
    assembly.points.reserve(points_each * facing.size());
    assembly.bonds.reserve(points_each * facing.size());
    if (!assembly.triangles.empty()) assembly.initial_shapes.reserve(points_each * facing.size());
    for (const Facing& f : facing) add_bonded_contact(assembly, kind, f.ga, f.ka, f.gb, f.kb, cells.cells[f.ga].on_seam(f.ka));
    lay_out_bonds(assembly);
}

// A disc hangs by its centre and its turn.
SideNodes nodes_of_disc(const Assembly& assembly, int body) {
    return {assembly.bodies[body].node(0), assembly.bodies[body].node(1), -1};
}

ContactSide side_of(const Assembly& assembly, int body) { return side_of(assembly, body, nodes_of_disc(assembly, body), -1); }

double smaller_diameter(const Assembly& assembly, int a, int b) {
    return 2.0 * std::min(assembly.bodies[a].radius_m, assembly.bodies[b].radius_m);
}

void add_inside_contact(Assembly& assembly, const InsideContact& pair) {
    Contact contact;
    contact.a = side_of(assembly, pair.a);
    contact.b = side_of(assembly, pair.b);
    contact.offset_m = plane_between_circles(assembly, contact);
    contact.material = inside_grains;
    contact.first_point = static_cast<std::int32_t>(assembly.points.size());
    contact.points = 1;
    assembly.add_point(0.0, smaller_diameter(assembly, pair.a, pair.b) * assembly.thickness_m);
    add_contact(assembly, contact, {});
}

void add_across_contact(Assembly& assembly, const AcrossContact& across, ContactNormal normal, bool smooth) {
    Contact contact;
    contact.a = side_of(assembly, across.a);
    contact.b = side_of(assembly, across.b);
    place_on_line(assembly, contact, across.from, across.to);
    if (normal == ContactNormal::edge || smooth) {
        const Vec2 line = across.to - across.from;
        contact.edge_normal = (-1.0 / norm(line)) * rot90(line);  // out of A's cell, which lies to the left of its edges
    }
    set_closing_distance(assembly, contact);
    contact.first_point = static_cast<std::int32_t>(assembly.points.size());
    contact.points = 1;
    assembly.add_point(0.0, norm(across.to - across.from) * assembly.thickness_m);
    if (contact.edge_normal == Vec2{}) assembly.points.back().free_gap_m = free_gap_between_circles(assembly, contact);
    add_contact(assembly, contact, {across.edge_a, across.edge_b, across.from, across.to});
}

// From the first particles to the last, so that a sweep over the contacts goes through the particles once; those inside grains
// and those across edges in turn, a full pack of either.
void add_contacts_of_particles(Assembly& assembly, const Tessellation& cells, Filling filling, ContactNormal normal) {
    const auto in_order = [&](auto& all) {  // and from now on between bodies
        for (auto& contact : all) {
            contact.a = assembly.body_of_particle[contact.a];
            contact.b = assembly.body_of_particle[contact.b];
        }
        std::stable_sort(all.begin(), all.end(), [](const auto& l, const auto& r) { return l.a + l.b < r.a + r.b; });
    };
    in_order(filling.inside);
    in_order(filling.across);
    auto inside = filling.inside.begin();
    auto across = filling.across.begin();
    while (inside != filling.inside.end() || across != filling.across.end()) {
        const bool inside_first =
            across == filling.across.end() || (inside != filling.inside.end() && inside->a + inside->b < across->a + across->b);
        for (int lane = 0; lane < kMostLanes; ++lane) {
            if (inside_first && inside != filling.inside.end()) add_inside_contact(assembly, *inside++);
            if (!inside_first && across != filling.across.end()) {
                add_across_contact(assembly, *across, normal, cells.cells[across->cell_a].on_seam(across->edge_a));
                ++across;
            }
        }
    }
}

// The initial shape functions of a contact's points on both sides.
void remember_shapes(Assembly& assembly, const Contact& contact) {
    const ContactFrame frame = contact_frame(assembly, contact);
    const auto pa = corners(assembly.nodes, contact.a.node);
    for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
        const Vec2 x = frame.reference_point + assembly.points[p].along_m * frame.edge_tangent;
        InitialShape shape;
        shape.a = shape_functions(pa, x);
        if (!contact.plate) shape.b = shape_functions(corners(assembly.nodes, contact.b.node), x);
        stiffness_shares(shape.a, shape.b, !contact.plate, shape.covered_a, shape.covered_b);
        assembly.initial_shapes.push_back(shape);
    }
}

// Where a point of the undeformed edge of this body is now.
Vec2 now(const Assembly& assembly, const Body& body, const SideNodes& node, int end, Vec2 X) {
    if (body.kind == BodyKind::flexible) return assembly.nodes.position(node[end]);
    return assembly.nodes.position(body.centre_node) +
           turned(X - assembly.nodes.reference[body.centre_node], assembly.rotation(body));
}

// The edge of a grain that is closest to x, and its length; a disc hangs by its centre and is as wide as its diameter.
struct ClosestEdge {
    SideNodes node{};
    std::int32_t edge = -1;
    double length_m = 0.0;
};

ClosestEdge closest_edge(const Assembly& assembly, int index, Vec2 x) {
    const Body& body = assembly.bodies[index];
    if (body.edge_begin == body.edge_end) return {nodes_of_disc(assembly, index), -1, 2.0 * body.radius_m};
    ClosestEdge best;
    double best_distance = std::numeric_limits<double>::infinity();
    for (int e = body.edge_begin; e < body.edge_end; ++e) {
        const GrainEdge& edge = assembly.edges[e];
        const Vec2 p0 = now(assembly, body, edge.node, 0, edge.from), line = now(assembly, body, edge.node, 1, edge.to) - p0;
        const double along = std::clamp(dot(x - p0, line) / dot(line, line), 0.0, 1.0);
        const double distance = norm(x - (p0 + along * line));
        if (distance < best_distance) {
            best_distance = distance;
            best = {edge.node, e, norm(line)};
        }
    }
    return best;
}

}  // namespace

namespace {

// The arrays of nodes, or of bonds, that are as long as there are of them.
auto arrays_of(Nodes& n) {
    return std::tie(n.reference, n.displacement, n.velocity, n.force, n.inverse_mass, n.loading_mode, n.mass);
}
auto arrays_of(Bonds& b) {
    return std::tie(b.un_m, b.us_m, b.Fn_N, b.Fs_N, b.max_un_m, b.max_us_m, b.damage, b.fracture_J, b.friction_J);
}

template <class Arrays, class Work>
void for_each_array(Arrays&& arrays, Work work) {
    std::apply([&](auto&... array) { (work(array), ...); }, arrays);
}

}  // namespace

int Nodes::add(Vec2 place, Vec2 free) {
    reference.push_back(place);
    for (auto* array : {&displacement, &velocity, &force, &loading_mode}) array->push_back({});
    inverse_mass.push_back(free);
    mass.push_back(1.0);
    return count() - 1;
}

void Nodes::reserve(std::size_t nodes) {
    for_each_array(arrays_of(*this), [&](auto& array) { array.reserve(nodes); });
}

void release_spare_memory(Assembly& a) {
    const auto release = [](auto& array) { array.shrink_to_fit(); };
    for_each_array(arrays_of(a.nodes), release);
    for_each_array(arrays_of(a.bonds), release);
    for_each_array(std::tie(a.triangles, a.bodies, a.edges, a.contacts, a.origins, a.points, a.initial_shapes), release);
    for_each_array(std::tie(a.packs.offset, a.packs.tangent_x, a.packs.tangent_y, a.packs.line_a, a.packs.line_b,
                            a.packs.contacts, a.packs.scale),
                   release);
}

void Bonds::reserve(std::size_t count) {
    for_each_array(arrays_of(*this), [&](auto& quantity) { quantity.reserve(count); });
}

void Bonds::resize(std::size_t count) {
    for_each_array(arrays_of(*this), [&](auto& quantity) { quantity.resize(count); });
}

void Bonds::set(std::size_t i, const BondState& s) {
    un_m[i] = s.un_m;
    us_m[i] = s.us_m;
    Fn_N[i] = s.Fn_N;
    Fs_N[i] = s.Fs_N;
    max_un_m[i] = s.max_un_m;
    max_us_m[i] = s.max_us_m;
    damage[i] = s.damage;
    fracture_J[i] = s.fracture_J;
    friction_J[i] = s.friction_J;
}

int Assembly::add_point(double along_m, double area_m2, const BondState& bond) {
    ContactPoint point;
    point.along_m = along_m;
    point.area_m2 = area_m2;
    point.state = static_cast<std::int32_t>(points.size());
    points.push_back(point);
    bonds.resize(points.size());
    set_bond(point.state, bond);
    return point.state;
}

namespace {

// Grains of their own elastic constants and density.
void set_grains(Assembly& assembly, const Texture& texture, const ModelSpec& model, const Heterogeneity& rock) {
    for (Body& body : assembly.bodies) {
        const GrainMaterial grain = texture.grain(body.grain);
        body.density_kg_m3 = grain.density_kg_m3;
        if (model.kind != GrainKind::flexible) continue;
        if (rock.grains_differ() || assembly.elasticity.empty())
            assembly.elasticity.push_back(plane_elasticity(grain.E_Pa, grain.nu, model.plane));
    }
}

// A contact that is broken from the start.
void open(Assembly& assembly, const Contact& contact, double opening_m) {
    for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
        BondState bond = assembly.bond(p);
        bond.damage = 1.0;
        bond.un_m = assembly.points[p].free_gap_m + opening_m;
        assembly.set_bond(p, bond);
    }
}

// Laws of their own for the contacts between grains, and inside grains of minerals whose stiffness is not that of the others.
void set_contacts(Assembly& assembly, const Texture& texture, const ContactMaterial& contact, const Heterogeneity& rock) {
    if (!rock.contacts_differ()) return;
    assembly.own_laws.form = {contact.law, contact.shear_measure == ShearMeasure::beyond_friction,
                              contact.tension_unloading == TensionUnloading::secant};
    const bool own_inside = !rock.minerals.phases.empty();
    std::vector<std::int16_t> dilation_of(rock.joints.size(), -1);
    for (std::size_t j = 0; j < rock.joints.size(); ++j) {
        if (!(rock.joints[j].dilation > 0.0)) continue;
        dilation_of[j] = static_cast<std::int16_t>(assembly.dilations.size());
        assembly.dilations.push_back({rock.joints[j].dilation, rock.joints[j].dilation_slip_m});
    }
    if (!assembly.dilations.empty()) assembly.bonds.slip_m.assign(assembly.points.size(), 0.0);
    for (std::size_t c = 0; c < assembly.contacts.size(); ++c) {
        Contact& made = assembly.contacts[c];
        const ContactOrigin& origin = assembly.origins[c];
        const int a = assembly.bodies[made.a.body].grain, b = assembly.bodies[made.b.body].grain;
        if (made.material == inside_grains) {
            if (!own_inside) continue;
            constexpr double kNever = std::numeric_limits<double>::infinity();
            const ContactMaterial inside = texture.between(texture.phases()[a], texture.phases()[a]);
            made.own_law =
                assembly.own_laws.add({inside.Kn_Pa_m, inside.eta * inside.Kn_Pa_m, kNever, kNever, kNever, kNever, 0.0});
        } else {
            const GrainContact joined = texture.contact(a, b, origin.from, origin.to);
            made.own_law = assembly.own_laws.add(law_constants(joined.material));
            if (joined.joint >= 0) made.dilation = dilation_of[joined.joint];
            if (joined.broken) open(assembly, made, joined.opening_m);
        }
    }
}

}  // namespace

Assembly assemble(const Specimen& specimen, const ModelSpec& model, const GrainMaterial& grain, const ContactMaterial& contact,
                  const Heterogeneity& rock) {
    Assembly assembly;
    const Texture texture(specimen, grain, contact, rock);
    assembly.thickness_m = specimen.spec.thickness_m;
    assembly.laws[between_grains] = BondLaw::make(contact);
    assembly.laws[inside_grains] = BondLaw::unbreakable(contact.Kn_Pa_m, contact.eta);
    switch (model.kind) {
        case GrainKind::flexible:
            add_flexible_grains(assembly, specimen);
            add_contacts_of_grains(assembly, specimen.cells, model.contact);
            break;
        case GrainKind::rigid:
            add_rigid_grains(assembly, specimen);
            add_contacts_of_grains(assembly, specimen.cells, model.contact);
            break;
        case GrainKind::inner_particles:
            if (specimen.filling.particle_begin.empty())
                throw InputError({.key = "specimen.grains.particles_per_grain"},
                                 "the grains of this specimen are not filled with particles",
                                 "a number of particles per grain, such as 26");
            add_inner_particles(assembly, specimen);
            add_contacts_of_particles(assembly, specimen.cells, specimen.filling, model.normal);
            break;
    }
    set_grains(assembly, texture, model, rock);
    set_contacts(assembly, texture, contact, rock);
    index_bodies(assembly);
    index_contacts(assembly);
    release_spare_memory(assembly);
    return assembly;
}

ContactSide side_of(const Assembly& assembly, int body, const SideNodes& node, int edge) {
    const Body& b = assembly.bodies[body];
    return {node, body, edge, b.centre_node, b.radius_m > 0.0 ? 1.0 / b.radius_m : 0.0};
}

void add_contact(Assembly& assembly, const Contact& contact, const ContactOrigin& origin) {
    assembly.contacts.push_back(contact);
    assembly.origins.push_back(origin);
    assembly.contacts.back().flexible = assembly.bodies[contact.a.body].kind == BodyKind::flexible;
    if (assembly.contacts.back().flexible) remember_shapes(assembly, contact);
}

void index_bodies(Assembly& assembly) {
    assembly.body_work.resize(assembly.bodies.size());
    index_grain_packs(assembly);
}

void index_contacts(Assembly& assembly) {
    std::vector<std::int32_t> count(assembly.bodies.size() + 1, 0);
    const auto for_each_slot = [&](auto visit) {
        for (std::size_t c = 0; c < assembly.contacts.size(); ++c) {
            if (assembly.contacts[c].dropped) continue;
            visit(assembly.contacts[c].a.body, static_cast<std::int32_t>(2 * c));
            visit(assembly.contacts[c].b.body, static_cast<std::int32_t>(2 * c + 1));
        }
    };
    for_each_slot([&](int body, std::int32_t) { ++count[body + 1]; });
    for (std::size_t b = 0; b < assembly.bodies.size(); ++b) {
        count[b + 1] += count[b];
        assembly.bodies[b].slot_begin = assembly.bodies[b].slot_end = count[b];
    }
    assembly.slots_of_bodies.resize(static_cast<std::size_t>(count.back()));
    for_each_slot([&](int body, std::int32_t slot) { assembly.slots_of_bodies[assembly.bodies[body].slot_end++] = slot; });
    index_contact_packs(assembly);
}

namespace {

// Room for new contacts: they are few, and arrays that grow on their own would take twice their memory for the first one.
void keep_room(Assembly& assembly) {
    const std::size_t points = assembly.points.size(), contacts = assembly.contacts.size();
    const auto more = [](std::size_t count) { return count + count / 32 + 16; };
    if (points == assembly.points.capacity()) {
        assembly.points.reserve(more(points));
        assembly.bonds.reserve(more(points));
        if (!assembly.initial_shapes.empty()) assembly.initial_shapes.reserve(more(points));
    }
    if (contacts == assembly.contacts.capacity()) {
        assembly.contacts.reserve(more(contacts));
        assembly.origins.reserve(more(contacts));
    }
}

// A new contact in a rock whose contacts are not alike: stiffness and friction are the means of those of the contacts that the
// two bodies have.
std::int32_t law_between(Assembly& assembly, int body_a, int body_b) {
    LawConstants<double> mean;
    int count = 0;
    for (const int b : {body_a, body_b}) {
        const Body& body = assembly.bodies[b];
        for (int i = body.slot_begin; i < body.slot_end; ++i) {
            const Contact& contact = assembly.contacts[assembly.slots_of_bodies[i] / 2];
            if (contact.own_law < 0 || contact.material != between_grains) continue;
            const LawConstants<double> law = assembly.own_laws.at(contact.own_law);
            mean.Kn_Pa_m += law.Kn_Pa_m;
            mean.Ks_Pa_m += law.Ks_Pa_m;
            mean.mu += law.mu;
            ++count;
        }
    }
    const BondLaw& usual = assembly.laws[between_grains];
    if (count == 0) return assembly.own_laws.add({.Kn_Pa_m = usual.Kn_Pa_m, .Ks_Pa_m = usual.Ks_Pa_m, .mu = usual.mu});
    return assembly.own_laws.add({.Kn_Pa_m = mean.Kn_Pa_m / count, .Ks_Pa_m = mean.Ks_Pa_m / count, .mu = mean.mu / count});
}

}  // namespace

void add_new_contact(Assembly& assembly, int body_a, int body_b, double rest_overlap_m, double closing_distance_m) {
    keep_room(assembly);
    const double ra = assembly.bodies[body_a].radius_m, rb = assembly.bodies[body_b].radius_m;
    const Vec2 xa = assembly.centre(body_a), line = assembly.centre(body_b) - xa;
    const double d = norm(line);
    Contact contact;
    contact.offset_m = 0.5 * (ra - rb);
    contact.closing_distance_m = closing_distance_m;
    contact.new_contact = true;
    const Vec2 x = xa + ((0.5 * d + contact.offset_m) / d) * line;
    const ClosestEdge edge_a = closest_edge(assembly, body_a, x), edge_b = closest_edge(assembly, body_b, x);
    contact.a = side_of(assembly, body_a, edge_a.node, edge_a.edge);
    contact.b = side_of(assembly, body_b, edge_b.node, edge_b.edge);
    contact.points = 1;
    const double area = std::min(edge_a.length_m, edge_b.length_m) * assembly.thickness_m;
    BondState bond;
    bond.un_m = -(ra + rb - d - rest_overlap_m);
    bond.damage = 1.0;
    if (!assembly.own_laws.empty()) contact.own_law = law_between(assembly, body_a, body_b);
    if (bond.un_m < 0.0) bond.Fn_N = -assembly.law_of(contact).Kn_Pa_m * area * bond.un_m;
    contact.first_point = assembly.add_point(0.0, area, bond);
    add_contact(assembly, contact, {});
}

double Assembly::memory_bytes() const { return heap_bytes(*this); }

}  // namespace feldspar
