#include "feldspar/model/assemble.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "feldspar/base/error.hpp"

namespace feldspar {
namespace {

Triangle make_triangle(const std::vector<Vec2>& X, const std::array<int, 3>& t, double thickness_m) {
    const Vec2 e1 = X[t[1]] - X[t[0]], e2 = X[t[2]] - X[t[0]];
    const double twice_area = cross(e1, e2);
    Triangle triangle;
    triangle.node = {t[0], t[1], t[2]};
    triangle.gradient = {Vec2{e2.y / twice_area, -e2.x / twice_area}, Vec2{-e1.y / twice_area, e1.x / twice_area}};
    triangle.volume_m3 = 0.5 * twice_area * thickness_m;
    return triangle;
}

// The nodes of the triangle behind edge k of grain g, turned so that the edge comes first.
EdgeNodes nodes_behind_edge(const GrainMesh& mesh, int g, int k) {
    const int nv = mesh.vertex_count[g];
    const std::int32_t from = mesh.node_begin[g] + k, to = mesh.node_begin[g] + (k + 1) % nv;
    for (const int node : mesh.triangles[mesh.edge_triangle[mesh.edge_begin[g] + k]])
        if (node != from && node != to) return {from, to, node};
    throw NumericalError("a grain edge without a triangle of its own");
}

void copy_grains(Assembly& body, const Specimen& specimen) {
    const GrainMesh& mesh = specimen.mesh;
    const int grains = static_cast<int>(mesh.vertex_count.size());
    body.grains.resize(grains);
    body.grain_work.resize(grains);
    for (int g = 0; g < grains; ++g) {
        Grain& grain = body.grains[g];
        grain.node_begin = mesh.node_begin[g];
        grain.node_end = mesh.node_begin[g + 1];
        grain.triangle_begin = mesh.triangle_begin[g];
        grain.triangle_end = mesh.triangle_begin[g + 1];
        grain.edge_begin = mesh.edge_begin[g];
        grain.edge_end = mesh.edge_begin[g + 1];
        grain.centre_node = mesh.centre_node[g];
        grain.radius_m = specimen.packing.radii_m[g];
        for (int k = 0; k < mesh.vertex_count[g]; ++k) body.grain_edges.push_back(nodes_behind_edge(mesh, g, k));
    }
}

// Geometry of a bonded contact on the edge p0 -> p1 of grain A, whose other side is grain B (equations (5)-(8)).
void place_on_edge(const Assembly& body, Contact& contact, Vec2 p0, Vec2 p1) {
    const Vec2 xa = body.centre(contact.a.grain), xb = body.centre(contact.b.grain);
    const double d = norm(xb - xa), length = norm(p1 - p0);
    const Vec2 n = (1.0 / d) * (xb - xa), t = (1.0 / length) * (p1 - p0);
    const double s = cross(p0 - xa, t) / cross(n, t);   // where the line of centres meets the edge's line
    contact.offset_m = s - 0.5 * d;                     // = (RA - RB)/2 + dv
    contact.tangent = {dot(t, n), dot(t, rot90(n))};
}

// The initial shape functions of a contact's points on both sides.
void remember_shapes(Assembly& body, const Contact& contact) {
    const ContactFrame frame = contact_frame(body, contact);
    const auto pa = corners(body.nodes, contact.a.node);
    for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
        const Vec2 x = frame.reference_point + body.points[p].along_m * frame.edge_tangent;
        InitialShape shape;
        shape.a = shape_functions(pa, x);
        if (contact.b.grain >= 0) shape.b = shape_functions(corners(body.nodes, contact.b.node), x);
        stiffness_shares(shape.a, shape.b, contact.b.grain >= 0, shape.covered_a, shape.covered_b);
        body.initial_shapes.push_back(shape);
    }
}

void add_bonded_contact(Assembly& body, ContactKind kind, int ga, int ka, int gb, int kb) {
    Contact contact;
    contact.a = {body.grain_edges[body.grains[ga].edge_begin + ka], ga, 0};
    contact.b = {body.grain_edges[body.grains[gb].edge_begin + kb], gb, 0};
    const Vec2 p0 = body.nodes.position(contact.a.node[0]), p1 = body.nodes.position(contact.a.node[1]);
    const double area = norm(p1 - p0) * body.thickness_m;
    place_on_edge(body, contact, p0, p1);
    const double radii = body.grains[ga].radius_m + body.grains[gb].radius_m;
    contact.closing_distance_m = std::max(radii, norm(body.centre(gb) - body.centre(ga)));
    contact.first_point = static_cast<std::int32_t>(body.points.size());
    if (kind == ContactKind::lobatto3) {
        contact.points = 3;
        const ContactFrame frame = contact_frame(body, contact);
        const double from = dot(p0 - frame.reference_point, frame.edge_tangent), to = from + norm(p1 - p0);
        body.points.push_back({from, area / 6.0, {}, -1, false, false});
        body.points.push_back({0.5 * (from + to), 2.0 * area / 3.0, {}, -1, false, false});
        body.points.push_back({to, area / 6.0, {}, -1, false, false});
    } else {
        contact.points = 1;   // PCM: on the discs' own contact plane (dv = 0)
        contact.offset_m = 0.5 * (body.grains[ga].radius_m - body.grains[gb].radius_m);
        body.points.push_back({0.0, area, {}, -1, false, false});
    }
    body.contacts.push_back(contact);
    remember_shapes(body, contact);
}

void add_bonded_contacts(Assembly& body, const Tessellation& cells, ContactKind kind) {
    std::map<std::pair<int, int>, std::pair<int, int>> owner;   // directed vertex pair -> (cell, edge)
    for (int g = 0; g < static_cast<int>(cells.cells.size()); ++g) {
        const Cell& cell = cells.cells[g];
        const int nv = static_cast<int>(cell.vertices.size());
        for (int k = 0; k < nv; ++k) owner[{cell.vertices[k], cell.vertices[(k + 1) % nv]}] = {g, k};
    }
    for (int g = 0; g < static_cast<int>(cells.cells.size()); ++g) {
        const Cell& cell = cells.cells[g];
        const int nv = static_cast<int>(cell.vertices.size());
        for (int k = 0; k < nv; ++k) {
            if (cell.neighbours[k] <= g) continue;
            const auto other = owner.find({cell.vertices[(k + 1) % nv], cell.vertices[k]});
            if (other == owner.end()) throw NumericalError("the tessellation is not conforming");
            add_bonded_contact(body, kind, g, k, other->second.first, other->second.second);
        }
    }
}

// Edge of a grain whose midpoint is closest to x.
EdgeNodes closest_edge(const Assembly& body, int grain, Vec2 x) {
    EdgeNodes best{};
    double best_distance = std::numeric_limits<double>::infinity();
    for (int e = body.grains[grain].edge_begin; e < body.grains[grain].edge_end; ++e) {
        const Vec2 p0 = body.nodes.position(body.grain_edges[e][0]), p1 = body.nodes.position(body.grain_edges[e][1]);
        const Vec2 line = p1 - p0;
        const double along = std::clamp(dot(x - p0, line) / dot(line, line), 0.0, 1.0);
        const double distance = norm(x - (p0 + along * line));
        if (distance < best_distance) {
            best_distance = distance;
            best = body.grain_edges[e];
        }
    }
    return best;
}

}  // namespace

Assembly assemble(const Specimen& specimen, const ModelSpec& model, const GrainMaterial& grain, const ContactMaterial& contact) {
    Assembly body;
    body.thickness_m = specimen.spec.thickness_m;
    body.elasticity = plane_elasticity(grain.E_Pa, grain.nu, model.plane);
    body.laws.push_back(BondLaw::make(contact));
    body.nodes.reference = specimen.mesh.nodes;
    const std::size_t count = body.nodes.reference.size();
    for (auto* array : {&body.nodes.displacement, &body.nodes.velocity, &body.nodes.force, &body.nodes.loading_mode}) array->resize(count);
    body.nodes.inverse_mass.assign(count, {1.0, 1.0});
    body.nodes.mass.assign(count, 1.0);
    for (const auto& t : specimen.mesh.triangles) body.triangles.push_back(make_triangle(specimen.mesh.nodes, t, body.thickness_m));
    copy_grains(body, specimen);
    add_bonded_contacts(body, specimen.cells, model.contact);
    index_slots(body);
    return body;
}

void index_slots(Assembly& body) {
    std::vector<std::vector<std::int32_t>> of_grain(body.grains.size());
    for (std::size_t c = 0; c < body.contacts.size(); ++c) {
        const Contact& contact = body.contacts[c];
        if (contact.dropped) continue;
        of_grain[contact.a.grain].push_back(static_cast<std::int32_t>(2 * c));
        if (contact.b.grain >= 0) of_grain[contact.b.grain].push_back(static_cast<std::int32_t>(2 * c + 1));
    }
    body.slots_of_grains.clear();
    for (std::size_t g = 0; g < body.grains.size(); ++g) {
        body.grains[g].slot_begin = static_cast<std::int32_t>(body.slots_of_grains.size());
        body.slots_of_grains.insert(body.slots_of_grains.end(), of_grain[g].begin(), of_grain[g].end());
        body.grains[g].slot_end = static_cast<std::int32_t>(body.slots_of_grains.size());
    }
    body.slots.resize(2 * body.contacts.size());
}

void attach_platen_rows(Assembly& body, const Specimen& specimen) {
    Platen& top = body.platens[0];
    Platen& bottom = body.platens[1];
    top.normal = {0.0, 1.0};
    top.mode = {0.0, -1.0};
    bottom.normal = {0.0, -1.0};
    for (std::size_t g = 0; g < body.grains.size(); ++g) {
        const Cell& cell = specimen.cells.cells[g];
        Grain& grain = body.grains[g];
        grain.pressure_begin = static_cast<std::int32_t>(body.pressure_edges.size());
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            if (cell.neighbours[k] >= 0) continue;
            const EdgeNodes& edge = body.grain_edges[grain.edge_begin + static_cast<int>(k)];
            const std::string& label = specimen.outline.edge_labels[cell.outline_edges[k]];
            if (label == "top" || label == "bottom") {
                auto& row = label == "top" ? top.nodes : bottom.nodes;
                row.insert(row.end(), {edge[0], edge[1]});
            } else {
                const Vec2 line = body.nodes.reference[edge[1]] - body.nodes.reference[edge[0]];
                body.pressure_edges.push_back({edge[0], edge[1], (-1.0 / norm(line)) * rot90(line)});
            }
        }
        grain.pressure_end = static_cast<std::int32_t>(body.pressure_edges.size());
    }
    for (Platen* platen : {&top, &bottom}) {
        std::sort(platen->nodes.begin(), platen->nodes.end());
        platen->nodes.erase(std::unique(platen->nodes.begin(), platen->nodes.end()), platen->nodes.end());
        if (platen->nodes.empty()) throw InputError({}, "the outline has no edge labelled \"top\" or none labelled \"bottom\"");
        for (const int node : platen->nodes) body.nodes.inverse_mass[node].y = 0.0;
    }
    double centre = 0.0;
    for (const int node : bottom.nodes) centre += body.nodes.reference[node].x / static_cast<double>(bottom.nodes.size());
    const auto held = std::min_element(bottom.nodes.begin(), bottom.nodes.end(), [&](int i, int j) {
        return std::abs(body.nodes.reference[i].x - centre) < std::abs(body.nodes.reference[j].x - centre);
    });
    body.nodes.inverse_mass[*held].x = 0.0;
}

void attach_plates(Assembly& body, const Specimen& specimen, const ContactMaterial& contact, double stiffness_factor, double mu) {
    BondLaw law = body.laws.at(0);
    law.Kn_Pa_m = stiffness_factor * contact.Kn_Pa_m;
    law.Ks_Pa_m = contact.eta * law.Kn_Pa_m;
    law.mu = mu;
    body.laws.push_back(law);
    const auto material = static_cast<std::int32_t>(body.laws.size() - 1);
    for (int side = 0; side < 2; ++side) {
        Platen& platen = body.platens[side];
        const double sign = side == 0 ? 1.0 : -1.0;
        platen.normal = {0.0, sign};
        platen.mode = {0.0, side == 0 ? -1.0 : 0.0};
        platen.position_m = -sign * std::numeric_limits<double>::infinity();
        for (int g = 0; g < static_cast<int>(body.grains.size()); ++g) {
            const Cell& cell = specimen.cells.cells[g];
            const Vec2 centre = body.centre(g);
            int best = -1;          // the outline edge of this grain under the outermost point of its circle
            double best_gap = std::numeric_limits<double>::infinity();
            for (int k = 0; k < static_cast<int>(cell.vertices.size()); ++k) {
                if (cell.neighbours[k] >= 0) continue;
                const EdgeNodes& edge = body.grain_edges[body.grains[g].edge_begin + k];
                const Vec2 p0 = body.nodes.reference[edge[0]], p1 = body.nodes.reference[edge[1]];
                const Vec2 outward = (-1.0 / norm(p1 - p0)) * rot90(p1 - p0);
                if (sign * outward.y < 0.5) continue;   // steeper than 60 degrees: no plate ever reaches it
                const double gap = std::max({0.0, std::min(p0.x, p1.x) - centre.x, centre.x - std::max(p0.x, p1.x)});
                if (gap < best_gap) {
                    best_gap = gap;
                    best = k;
                }
            }
            if (best < 0) continue;
            const EdgeNodes& edge = body.grain_edges[body.grains[g].edge_begin + best];
            const Vec2 p0 = body.nodes.reference[edge[0]], p1 = body.nodes.reference[edge[1]];
            const double x = std::clamp(centre.x, std::min(p0.x, p1.x), std::max(p0.x, p1.x));
            const Vec2 touch = p0 + ((x - p0.x) / (p1.x - p0.x)) * (p1 - p0);
            Contact plate;
            plate.a = {edge, g, 0};
            plate.b.platen = side;
            plate.material = material;
            plate.offset_m = dot(touch - centre, platen.normal);
            plate.tangent = {0.0, 1.0};
            plate.first_point = static_cast<std::int32_t>(body.points.size());
            plate.points = 1;
            ContactPoint point;
            point.along_m = dot(touch - centre, rot90(platen.normal));
            point.area_m2 = 2.0 * body.grains[g].radius_m * body.thickness_m;
            point.bond.damage = 1.0;
            body.points.push_back(point);
            platen.contacts.push_back(static_cast<std::int32_t>(body.contacts.size()));
            body.contacts.push_back(plate);
            platen.position_m = sign * std::max(sign * platen.position_m, sign * touch.y);
            remember_shapes(body, plate);
        }
        if (platen.contacts.empty()) throw InputError({}, "no grain of the disc faces the plates");
        for (const int c : platen.contacts) {   // the gap that is left at first touch
            ContactPoint& point = body.points[body.contacts[c].first_point];
            point.bond.un_m = sign * (platen.position_m - (body.centre(body.contacts[c].a.grain).y + sign * body.contacts[c].offset_m));
        }
    }
    index_slots(body);
}

void add_new_contact(Assembly& body, int grain_a, int grain_b, double rest_overlap_m, double closing_distance_m) {
    const double ra = body.grains[grain_a].radius_m, rb = body.grains[grain_b].radius_m;
    const Vec2 xa = body.centre(grain_a), line = body.centre(grain_b) - xa;
    const double d = norm(line);
    Contact contact;
    contact.offset_m = 0.5 * (ra - rb);
    contact.closing_distance_m = closing_distance_m;
    contact.new_contact = true;
    const Vec2 x = xa + ((0.5 * d + contact.offset_m) / d) * line;
    contact.a = {closest_edge(body, grain_a, x), grain_a, 0};
    contact.b = {closest_edge(body, grain_b, x), grain_b, 0};
    const auto length = [&](const EdgeNodes& e) { return norm(body.nodes.position(e[1]) - body.nodes.position(e[0])); };
    contact.first_point = static_cast<std::int32_t>(body.points.size());
    contact.points = 1;
    ContactPoint point;
    point.area_m2 = std::min(length(contact.a.node), length(contact.b.node)) * body.thickness_m;
    point.bond.un_m = -(ra + rb - d - rest_overlap_m);
    point.bond.damage = 1.0;
    body.points.push_back(point);
    body.contacts.push_back(contact);
    remember_shapes(body, contact);
}

double Assembly::memory_bytes() const {
    const auto bytes = [](const auto& v) { return static_cast<double>(v.capacity() * sizeof(v[0])); };
    return bytes(nodes.reference) * 6.0 + bytes(nodes.mass) + bytes(triangles) + bytes(grains) + bytes(grain_edges) + bytes(contacts) +
           bytes(points) + bytes(initial_shapes) + bytes(slots) + bytes(slots_of_grains) + bytes(pressure_edges) + bytes(grain_work);
}

}  // namespace feldspar
