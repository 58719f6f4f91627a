#include "feldspar/model/packs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "feldspar/base/error.hpp"
#include "feldspar/model/assembly.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {
namespace {

struct Topology {
    int vertices = 0;
    bool collapsed = false;
    int start = 0;
};

// Recognises the fixed topology of specimen theory, section 4: each edge with its own triangle and two behind it, but for the
// collapsed edge.
std::optional<Topology> topology_of(const GrainMesh& mesh, int g) {
    const int nv = mesh.vertex_count[g], nodes = mesh.node_begin[g + 1] - mesh.node_begin[g];
    const int triangles = mesh.triangle_begin[g + 1] - mesh.triangle_begin[g];
    if (nv > kMostVertices) return std::nullopt;
    Topology topology{nv, nodes == 2 * nv, 0};
    if (nodes != 2 * nv + 1 - topology.collapsed || triangles != 3 * nv - 2 * topology.collapsed) return std::nullopt;
    const auto owned = [&](int k) {  // triangles from this edge's to the next one's
        const int end = k + 1 < nv ? mesh.edge_triangle[mesh.edge_begin[g] + k + 1] : mesh.triangle_begin[g + 1];
        return end - mesh.edge_triangle[mesh.edge_begin[g] + k];
    };
    for (int k = 0; k < nv; ++k) {
        if (topology.collapsed && owned(k) == 1)
            topology.start = (k + 1) % nv;
        else if (owned(k) != 3)
            return std::nullopt;
    }
    const int centre = mesh.node_begin[g] + nv;
    for (int k = 0; k < nv; ++k) {
        const int t = mesh.edge_triangle[mesh.edge_begin[g] + k], next = (k + 1) % nv;
        const int ring = mesh.triangles[t][2], ring_next = mesh.triangles[mesh.edge_triangle[mesh.edge_begin[g] + next]][2];
        const int from = mesh.node_begin[g] + k, to = mesh.node_begin[g] + next;
        if (mesh.triangles[t] != std::array{from, to, ring}) return std::nullopt;
        if (owned(k) == 1) continue;
        if (mesh.triangles[t + 1] != std::array{to, ring_next, ring} ||
            mesh.triangles[t + 2] != std::array{centre, ring, ring_next})
            return std::nullopt;
    }
    return topology;
}

bool has_own_normal(const Contact& contact) { return contact.edge_normal != Vec2{}; }

// Contacts c and c + 1 may be lanes of one pack.
bool alike(const Assembly& assembly, int c) {
    const Contact &l = assembly.contacts[c], &r = assembly.contacts[c + 1];
    const bool laws = l.own_law < 0 ? r.own_law < 0 : r.own_law == l.own_law + 1;
    return laws && l.points == r.points && l.material == r.material && l.flexible == r.flexible &&
           has_own_normal(l) == has_own_normal(r) && l.plate == r.plate && (!l.plate || l.b.body == r.b.body);
}

bool is_central(const Assembly& assembly, const Contact& contact) {
    return contact.points == 1 && assembly.points[contact.first_point].along_m == 0.0;
}

bool is_loose(const Contact& contact) {
    return contact.plate || contact.initial_shape || contact.smooth || contact.dilation >= 0;
}

}  // namespace

std::vector<GrainPack> pack_grains(const GrainMesh& mesh) {
    std::map<std::pair<int, bool>, std::vector<std::pair<int, int>>> groups;  // of each topology: grain and start
    const int grains = static_cast<int>(mesh.vertex_count.size());
    for (int g = 0; g < grains; ++g)
        if (const auto topology = topology_of(mesh, g))
            groups[{topology->vertices, topology->collapsed}].push_back({g, topology->start});
    const auto height = [&](int g) { return mesh.nodes[mesh.centre_node[g]].y; };
    std::vector<GrainPack> packs;
    std::vector<double> heights;
    for (auto& [topology, members] : groups) {
        std::stable_sort(members.begin(), members.end(),
                         [&](const auto& l, const auto& r) { return height(l.first) < height(r.first); });
        for (std::size_t i = 0; i < members.size(); i += kMostLanes) {
            GrainPack pack;
            pack.vertices = topology.first;
            pack.collapsed = topology.second;
            pack.lanes = static_cast<int>(std::min<std::size_t>(kMostLanes, members.size() - i));
            double sum = 0.0;
            for (int l = 0; l < pack.lanes; ++l) {
                std::tie(pack.grain[l], pack.start[l]) = members[i + l];
                sum += height(pack.grain[l]);
            }
            packs.push_back(pack);
            heights.push_back(sum / pack.lanes);
        }
    }
    std::vector<std::size_t> order(packs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t l, std::size_t r) { return heights[l] < heights[r]; });
    std::vector<GrainPack> ordered;
    int node = 0, edge = 0, triangle = 0;
    for (const std::size_t i : order) {
        GrainPack& pack = packs[i];
        pack.first_node = std::exchange(node, node + pack.nodes() * pack.lanes);
        pack.first_edge = std::exchange(edge, edge + pack.vertices * pack.lanes);
        pack.first_triangle = std::exchange(triangle, triangle + pack.triangles() * pack.lanes);
        ordered.push_back(pack);
    }
    return ordered;
}

std::int32_t Packs::line_of(const Assembly& assembly, int body, int edge) const {
    return edge >= 0 && assembly.bodies[body].kind == BodyKind::flexible ? line_of_edge[edge] : line_of_first_body + body;
}

void index_grain_packs(Assembly& assembly) {
    Packs& packs = assembly.packs;
    packs.line_of_edge.assign(assembly.edges.size(), -1);
    packs.pack_of_body.assign(assembly.bodies.size(), -1);
    packs.forces.assign(packs.grains.size(), PackForces::own);
    const bool alike = assembly.elasticity.size() <= 1;
    for (auto* constants : {&packs.volumetric, &packs.deviatoric})
        constants->assign(alike ? 0 : kMostLanes * packs.grains.size(), 0.0);
    int lines = 0;
    for (std::size_t p = 0; p < packs.grains.size(); ++p) {
        const GrainPack& pack = packs.grains[p];
        for (int l = 0; l < pack.lanes && !alike; ++l) {
            const PlaneElasticity& D = assembly.elasticity_of(pack.grain[l]);
            packs.volumetric[kMostLanes * p + l] = 0.5 * assembly.thickness_m * (D.D11 + D.D12);
            packs.deviatoric[kMostLanes * p + l] = 0.5 * assembly.thickness_m * (D.D11 - D.D12);
        }
        packs.scale.resize(static_cast<std::size_t>(pack.first_triangle + pack.triangles() * pack.lanes));
        lines = pack.first_edge + pack.vertices * pack.lanes;
        for (int l = 0; l < pack.lanes; ++l) {
            const Body& body = assembly.bodies[pack.grain[l]];
            packs.pack_of_body[pack.grain[l]] = static_cast<std::int32_t>(p);
            int t = 0;
            for (int k = 0; k < pack.vertices; ++k) {
                const int edge = (k + pack.start[l]) % pack.vertices;
                packs.line_of_edge[body.edge_begin + edge] = pack.first_edge + k * pack.lanes + l;
                // The mesh has the triangles of its edges one after the other; the collapsed edge, the last here, has one.
                const int before = pack.collapsed && edge >= pack.start[l] && pack.start[l] > 0 ? 2 : 0;
                const int own = body.triangle_begin + 3 * edge - before;
                for (int i = 0; i < (pack.collapsed && k == pack.vertices - 1 ? 1 : 3); ++i, ++t)
                    packs.scale[static_cast<std::size_t>(pack.first_triangle + t * pack.lanes + l)] =
                        0.25 * assembly.thickness_m / assembly.triangles[own + i].volume_m3;
            }
        }
    }
    for (int b = 0; b < std::ssize(assembly.bodies); ++b)
        if (assembly.bodies[b].kind == BodyKind::flexible && packs.pack_of_body[b] < 0)
            for (int e = assembly.bodies[b].edge_begin; e < assembly.bodies[b].edge_end; ++e) packs.line_of_edge[e] = lines++;
    packs.line_of_first_body = lines;
    packs.rigid_end = 0;
    packs.loose_bodies.clear();
    for (int b = 0; b < std::ssize(assembly.bodies); ++b) {
        if (assembly.bodies[b].kind == BodyKind::rigid) {
            packs.rigid_end = b + 1;  // rigid bodies come first, plates behind them
        } else if (packs.pack_of_body[b] < 0) {
            packs.loose_bodies.push_back(b);
        }
    }
    const std::size_t all_lines = static_cast<std::size_t>(lines) + assembly.bodies.size();
    if (all_lines * sizeof(SideLine) > std::numeric_limits<std::uint32_t>::max())  // contacts find their lines by 32 bits
        throw InputError({}, fmt::format("{} edges of grains and rigid bodies are more than a specimen may have", all_lines),
                         "67 million", "larger grains, or a smaller specimen");
    packs.lines.assign(all_lines, {});
    packs.inverse_cross.assign(static_cast<std::size_t>(lines), 0.0);
}

namespace {

// Consecutive contacts whose bonds stand as the layout of a pack asks.
void find_contact_packs(Assembly& assembly) {
    Packs& packs = assembly.packs;
    packs.contacts.clear();
    const int contacts = static_cast<int>(assembly.contacts.size());
    for (int c = 0; c < contacts;) {
        const Contact& first = assembly.contacts[c];
        ContactPack pack;
        pack.first_contact = c;
        pack.lanes = 1;
        pack.points = first.points;
        pack.first_state = assembly.points[first.first_point].state;
        pack.material = first.material;
        pack.first_law = first.own_law;
        pack.rigid = !first.flexible;
        // The lanes' points stand right if those of the first point are consecutive and those of the second follow.
        const auto stands = [&](int lane, int lanes) {
            const Contact& contact = assembly.contacts[c + lane];
            for (int j = 0; j < contact.points; ++j)
                if (assembly.points[contact.first_point + j].state != pack.first_state + j * lanes + lane) return false;
            return true;
        };
        const int spacing = first.points > 1 ? assembly.points[first.first_point + 1].state - pack.first_state : kMostLanes;
        while (pack.lanes < spacing && c + pack.lanes < contacts && alike(assembly, c + pack.lanes - 1) &&
               stands(pack.lanes, spacing))
            ++pack.lanes;
        pack.central = std::all_of(&assembly.contacts[c], &assembly.contacts[c] + pack.lanes,
                                   [&](const Contact& contact) { return is_central(assembly, contact); });
        packs.contacts.push_back(pack);
        c += pack.lanes;
    }
}

void index_rigid_bodies(Assembly& assembly) {
    Packs& packs = assembly.packs;
    const std::size_t contacts = assembly.contacts.size();
    packs.rigid_forces.assign(packs.rigid_end > 0 ? contacts + 1 : 0, {});
    if (packs.rigid_forces.size() * sizeof(RigidForces) >
        std::numeric_limits<std::uint32_t>::max())  // bodies find them by 32 bits
        throw InputError(
            {}, fmt::format("{} contacts of rigid grains or inner particles are more than a specimen may have", contacts),
            "134 million", "larger grains, or a smaller specimen");
    const auto bytes_to = [](std::size_t contact) { return static_cast<std::uint32_t>(sizeof(RigidForces) * contact); };
    packs.rigid.clear();
    packs.more_of_rigid.clear();
    for (int b = 0; b < packs.rigid_end; ++b) {
        const Body& body = assembly.bodies[b];
        RigidBody rigid;
        rigid.as_a.fill(bytes_to(contacts));
        rigid.as_b.fill(bytes_to(contacts));
        rigid.more_begin = static_cast<std::int32_t>(packs.more_of_rigid.size());
        int as_a = 0, as_b = 0;
        for (int i = body.slot_begin; i < body.slot_end; ++i) {
            const std::int32_t slot = assembly.slots_of_bodies[i];
            int& taken = slot % 2 == 0 ? as_a : as_b;
            if (taken < kAtOnce) {
                (slot % 2 == 0 ? rigid.as_a : rigid.as_b)[taken++] = bytes_to(static_cast<std::size_t>(slot / 2));
            } else {
                packs.more_of_rigid.push_back(slot);
            }
        }
        rigid.more_end = static_cast<std::int32_t>(packs.more_of_rigid.size());
        rigid.first_node = body.first_node;
        rigid.inverse_radius = 1.0 / body.radius_m;
        packs.rigid.push_back(rigid);
    }
}

}  // namespace

void index_contact_packs(Assembly& assembly) {
    Packs& packs = assembly.packs;
    const int contacts = static_cast<int>(assembly.contacts.size());

    assembly.slots.assign(static_cast<std::size_t>(2 * contacts), {});

    // Slots of the contacts on each edge: none, one, or several that share it.
    const std::size_t edges = packs.inverse_cross.size();
    std::vector<std::int32_t> only(edges, -1), pack_of_line(edges, -1);
    std::map<std::int32_t, std::vector<std::int32_t>> several;  // by line
    for (int c = 0; c < contacts; ++c) {
        const Contact& contact = assembly.contacts[c];
        if (contact.dropped || !contact.flexible) continue;
        for (int side = 0; side < 2 - contact.plate; ++side) {
            const ContactSide& s = side == 0 ? contact.a : contact.b;
            const std::int32_t line = packs.line_of_edge[s.edge];
            pack_of_line[line] = packs.pack_of_body[s.body];
            if (only[line] >= 0) {
                auto& all = several[line];
                if (all.empty()) all.push_back(only[line]);
                all.push_back(2 * c + side);
            } else {
                only[line] = 2 * c + side;
            }
        }
    }
    packs.bare.assign(edges, 0);
    for (std::size_t line = 0; line < edges; ++line)
        if (only[line] < 0) {
            packs.bare[line] = 1;
            packs.lines[line].forces = {};
        }
    packs.shared_edges.clear();
    packs.shared_slots.clear();
    packs.shared.assign(packs.lines.size(), 0);
    for (const auto& [line, slots] : several) {
        packs.shared[line] = 1;
        const auto begin = static_cast<std::int32_t>(packs.shared_slots.size());
        packs.shared_slots.insert(packs.shared_slots.end(), slots.begin(), slots.end());
        packs.shared_edges.push_back({pack_of_line[line], line, begin, static_cast<std::int32_t>(packs.shared_slots.size())});
    }
    std::stable_sort(packs.shared_edges.begin(), packs.shared_edges.end(),
                     [](const SharedEdge& l, const SharedEdge& r) { return l.pack < r.pack; });

    packs.along.resize(assembly.bonds.un_m.size());
    packs.area.resize(assembly.bonds.un_m.size());
    for (const ContactPoint& point : assembly.points) {
        packs.along[point.state] = point.along_m;
        packs.area[point.state] = point.area_m2;
    }
    packs.loose_contacts.clear();
    index_rigid_bodies(assembly);
    find_contact_packs(assembly);
    cut_into_bands(assembly);
    for (auto* array : {&packs.offset, &packs.tangent_x, &packs.tangent_y, &packs.normal_x, &packs.normal_y}) array->clear();
    for (auto* array : {&packs.line_a, &packs.line_b}) array->clear();
    for (ContactPack& pack : packs.contacts) {
        const bool own_normal = has_own_normal(assembly.contacts[pack.first_contact]);
        if (own_normal) pack.first_normal = static_cast<std::int32_t>(packs.normal_x.size());
        for (int lane = 0; lane < kMostLanes; ++lane) {  // lanes beyond the last repeat it: harmless to read
            const Contact& contact = assembly.contacts[pack.first_contact + std::min(lane, pack.lanes - 1)];
            packs.offset.push_back(contact.offset_m);
            packs.tangent_x.push_back(contact.tangent.x);
            packs.tangent_y.push_back(contact.tangent.y);
            if (own_normal) {
                packs.normal_x.push_back(contact.edge_normal.x);
                packs.normal_y.push_back(contact.edge_normal.y);
            }
            const std::int32_t a = packs.line_of(assembly, contact.a.body, contact.a.edge),
                               b = packs.line_of(assembly, contact.b.body, contact.b.edge);
            packs.line_a.push_back(static_cast<std::uint32_t>(sizeof(SideLine) * static_cast<std::size_t>(a)));
            packs.line_b.push_back(static_cast<std::uint32_t>(sizeof(SideLine) * static_cast<std::size_t>(b)));
        }
    }
    for (auto* array : {&packs.line_a, &packs.line_b}) array->resize(array->size() + kMostLanes * kFetchAhead, 0);
}

namespace {

// Which lanes take part, and what that allows for.
void sort_out_contacts(Assembly& assembly, int p) {
    Packs& packs = assembly.packs;
    ContactPack& pack = packs.contacts[p];
    const double* damage = &assembly.bonds.damage[pack.first_state];
    pack.intact = std::all_of(damage, damage + pack.lanes * pack.points, [](double D) { return D == 0.0; });
    if (pack.rigid && pack.plain) return;  // only flexible sides fall back from one block to the next
    pack.active = 0;
    pack.plain = pack.lanes == kMostLanes;
    for (int lane = 0; lane < pack.lanes; ++lane) {
        const Contact& contact = assembly.contacts[pack.first_contact + lane];
        const bool takes_part = !contact.dropped && !is_loose(contact);
        if (takes_part) pack.active = static_cast<std::uint8_t>(pack.active | 1U << lane);
        if (!contact.dropped && !takes_part) packs.loose_contacts.push_back(pack.first_contact + lane);
        const std::size_t at = static_cast<std::size_t>(kMostLanes * p + lane);
        pack.plain = pack.plain && takes_part && !packs.shared[packs.line_a[at] / sizeof(SideLine)] &&
                     !packs.shared[packs.line_b[at] / sizeof(SideLine)];
    }
}

}  // namespace

int pack_of_node(const Packs& packs, int node) {
    const auto behind = std::upper_bound(packs.grains.begin(), packs.grains.end(), node,
                                         [](int n, const GrainPack& pack) { return n < pack.first_node; });
    if (behind == packs.grains.begin()) return -1;
    const GrainPack& pack = *(behind - 1);
    return node < pack.first_node + pack.nodes() * pack.lanes ? static_cast<int>(&pack - packs.grains.data()) : -1;
}

void sort_out_packs(Assembly& assembly) {
    Packs& packs = assembly.packs;
    std::fill(packs.forces.begin(), packs.forces.end(), PackForces::own);
    for (const Fixture& fixture : assembly.fixtures)
        for (const int node : fixture.nodes)
            if (const int pack = pack_of_node(packs, node); pack >= 0) packs.forces[pack] = PackForces::kept;
    if (assembly.is_pressed())
        for (std::size_t b = 0; b < assembly.bodies.size(); ++b)
            if (packs.pack_of_body[b] >= 0 && assembly.bodies[b].pressure_begin < assembly.bodies[b].pressure_end)
                packs.forces[packs.pack_of_body[b]] = PackForces::on_top_of_others;
    packs.loose_contacts.clear();
    for (PackRanges& band : packs.bands.ranges) {
        band.loose_contacts.begin = static_cast<int>(packs.loose_contacts.size());
        for (int p = band.contacts.begin; p < band.contacts.end; ++p) sort_out_contacts(assembly, p);
        band.loose_contacts.end = static_cast<int>(packs.loose_contacts.size());
    }
}

}  // namespace feldspar
