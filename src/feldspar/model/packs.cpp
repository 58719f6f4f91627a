#include "feldspar/model/packs.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "feldspar/model/assembly.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {
namespace {

struct Topology {
    int vertices = 0;
    bool collapsed = false;
    int start = 0;
};

// Recognises the fixed topology of specimen theory, section 4: each edge with its own triangle and two behind it, but for the collapsed edge.
std::optional<Topology> topology_of(const GrainMesh& mesh, int g) {
    const int nv = mesh.vertex_count[g], nodes = mesh.node_begin[g + 1] - mesh.node_begin[g];
    const int triangles = mesh.triangle_begin[g + 1] - mesh.triangle_begin[g];
    Topology topology{nv, nodes == 2 * nv, 0};
    if (nodes != 2 * nv + 1 - topology.collapsed || triangles != 3 * nv - 2 * topology.collapsed) return std::nullopt;
    const auto owned = [&](int k) {   // triangles from this edge's to the next one's
        const int end = k + 1 < nv ? mesh.edge_triangle[mesh.edge_begin[g] + k + 1] : mesh.triangle_begin[g + 1];
        return end - mesh.edge_triangle[mesh.edge_begin[g] + k];
    };
    for (int k = 0; k < nv; ++k) {
        if (topology.collapsed && owned(k) == 1) topology.start = (k + 1) % nv;
        else if (owned(k) != 3) return std::nullopt;
    }
    const int centre = mesh.node_begin[g] + nv;
    for (int k = 0; k < nv; ++k) {
        const int t = mesh.edge_triangle[mesh.edge_begin[g] + k], next = (k + 1) % nv;
        const int ring = mesh.triangles[t][2], ring_next = mesh.triangles[mesh.edge_triangle[mesh.edge_begin[g] + next]][2];
        const int from = mesh.node_begin[g] + k, to = mesh.node_begin[g] + next;
        if (mesh.triangles[t] != std::array{from, to, ring}) return std::nullopt;
        if (owned(k) == 1) continue;
        if (mesh.triangles[t + 1] != std::array{to, ring_next, ring} || mesh.triangles[t + 2] != std::array{centre, ring, ring_next}) return std::nullopt;
    }
    return topology;
}

// Contacts c and c + 1 may be lanes of one pack.
bool alike(const Assembly& assembly, int c) {
    const Contact &l = assembly.contacts[c], &r = assembly.contacts[c + 1];
    return l.points == r.points && l.material == r.material && l.flexible == r.flexible;
}

bool is_loose(const Contact& contact) { return contact.plate || contact.initial_shape || contact.edge_normal != Vec2{}; }

}  // namespace

std::vector<GrainPack> pack_grains(const GrainMesh& mesh) {
    std::map<std::pair<int, bool>, std::vector<std::pair<int, int>>> groups;   // of each topology: grain and start
    const int grains = static_cast<int>(mesh.vertex_count.size());
    for (int g = 0; g < grains; ++g)
        if (const auto topology = topology_of(mesh, g)) groups[{topology->vertices, topology->collapsed}].push_back({g, topology->start});
    const auto height = [&](int g) { return mesh.nodes[mesh.centre_node[g]].y; };
    std::vector<GrainPack> packs;
    std::vector<double> heights;
    for (auto& [topology, members] : groups) {
        std::stable_sort(members.begin(), members.end(), [&](const auto& l, const auto& r) { return height(l.first) < height(r.first); });
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

std::int32_t Packs::field_of(const Assembly& assembly, int body, int edge) const {
    return edge >= 0 && assembly.bodies[body].kind == BodyKind::flexible ? field_of_edge[edge] : field_of_first_body + body;
}

void index_grain_packs(Assembly& assembly) {
    Packs& packs = assembly.packs;
    packs.field_of_edge.assign(assembly.edges.size(), -1);
    std::vector<bool> packed(assembly.bodies.size(), false);
    int fields = 0;
    for (const GrainPack& pack : packs.grains) {
        packs.scale.resize(static_cast<std::size_t>(pack.first_triangle + pack.triangles() * pack.lanes));
        fields = pack.first_edge + pack.vertices * pack.lanes;
        for (int l = 0; l < pack.lanes; ++l) {
            const Body& body = assembly.bodies[pack.grain[l]];
            packed[pack.grain[l]] = true;
            int t = 0;
            for (int k = 0; k < pack.vertices; ++k) {
                const int edge = (k + pack.start[l]) % pack.vertices;
                packs.field_of_edge[body.edge_begin + edge] = pack.first_edge + k * pack.lanes + l;
                // The mesh has the triangles of its edges one after the other; the collapsed edge, the last here, has one.
                const int before = pack.collapsed && edge >= pack.start[l] && pack.start[l] > 0 ? 2 : 0;
                const int own = body.triangle_begin + 3 * edge - before;
                for (int i = 0; i < (pack.collapsed && k == pack.vertices - 1 ? 1 : 3); ++i, ++t)
                    packs.scale[static_cast<std::size_t>(pack.first_triangle + t * pack.lanes + l)] =
                        0.25 * assembly.thickness_m / assembly.triangles[own + i].volume_m3;
            }
        }
    }
    for (std::int32_t& field : packs.field_of_edge)
        if (field < 0) field = fields++;
    packs.field_of_first_body = fields;
    packs.rigid_begin = packs.rigid_end = 0;
    packs.loose_bodies.clear();
    for (int b = 0; b < std::ssize(assembly.bodies); ++b) {
        if (assembly.bodies[b].kind == BodyKind::rigid) {
            packs.rigid_end = b + 1;   // rigid bodies come first, plates behind them
        } else if (!packed[b]) {
            packs.loose_bodies.push_back(b);
        }
    }
    packs.fields.assign(static_cast<std::size_t>(fields) + assembly.bodies.size(), {});
    packs.inverse_cross.assign(static_cast<std::size_t>(fields), 0.0);
}

void index_contact_packs(Assembly& assembly) {
    Packs& packs = assembly.packs;
    const int contacts = static_cast<int>(assembly.contacts.size());

    // Slots: two a contact, an empty one, and a sum for each edge that several contacts share.
    const std::int32_t empty = 2 * contacts;
    packs.slot_of_edge.assign(packs.inverse_cross.size(), empty);
    packs.shared_edges.clear();
    packs.shared_slots.clear();
    std::map<std::int32_t, std::vector<std::int32_t>> shared;   // by field
    std::vector<std::int32_t> body_of_field(packs.inverse_cross.size(), -1);
    for (int c = 0; c < contacts; ++c) {
        const Contact& contact = assembly.contacts[c];
        if (contact.dropped || !contact.flexible) continue;
        for (int side = 0; side < 2 - contact.plate; ++side) {
            const ContactSide& s = side == 0 ? contact.a : contact.b;
            const std::int32_t field = packs.field_of_edge[s.edge];
            std::int32_t& slot = packs.slot_of_edge[field];
            body_of_field[field] = s.body;
            if (slot != empty) {
                auto& all = shared[field];
                if (all.empty()) all.push_back(slot);
                all.push_back(2 * c + side);
            } else {
                slot = 2 * c + side;
            }
        }
    }
    std::int32_t sum = empty + 1;
    for (const auto& [field, slots] : shared) {
        const auto begin = static_cast<std::int32_t>(packs.shared_slots.size());
        packs.shared_slots.insert(packs.shared_slots.end(), slots.begin(), slots.end());
        packs.shared_edges.push_back({body_of_field[field], sum, begin, static_cast<std::int32_t>(packs.shared_slots.size())});
        packs.slot_of_edge[field] = sum++;
    }
    std::stable_sort(packs.shared_edges.begin(), packs.shared_edges.end(), [](const SharedEdge& l, const SharedEdge& r) { return l.body < r.body; });
    assembly.slots.resize(static_cast<std::size_t>(sum));
    std::fill(assembly.slots.begin() + empty, assembly.slots.end(), SlotForces{});

    packs.along.resize(assembly.bonds.un_m.size());
    packs.area.resize(assembly.bonds.un_m.size());
    for (const ContactPoint& point : assembly.points) {
        packs.along[point.state] = point.along_m;
        packs.area[point.state] = point.area_m2;
    }
    packs.contacts.clear();
    packs.loose_contacts.clear();
    for (auto* array : {&packs.offset, &packs.tangent_x, &packs.tangent_y}) array->clear();
    for (auto* array : {&packs.field_a, &packs.field_b}) array->clear();
    for (int c = 0; c < contacts;) {
        const Contact& first = assembly.contacts[c];
        ContactPack pack{c, 1, first.points, assembly.points[first.first_point].state, first.material, !first.flexible};
        // The lanes' points stand as the layout asks if those of the first point are consecutive and those of the second follow.
        const auto stands = [&](int lane, int lanes) {
            const Contact& contact = assembly.contacts[c + lane];
            for (int j = 0; j < contact.points; ++j)
                if (assembly.points[contact.first_point + j].state != pack.first_state + j * lanes + lane) return false;
            return true;
        };
        const int spacing = first.points > 1 ? assembly.points[first.first_point + 1].state - pack.first_state : kMostLanes;
        while (pack.lanes < spacing && c + pack.lanes < contacts && alike(assembly, c + pack.lanes - 1) && stands(pack.lanes, spacing)) ++pack.lanes;
        for (int lane = 0; lane < kMostLanes; ++lane) {   // lanes beyond the last repeat it: harmless to read
            const Contact& contact = assembly.contacts[c + std::min(lane, pack.lanes - 1)];
            packs.offset.push_back(contact.offset_m);
            packs.tangent_x.push_back(contact.tangent.x);
            packs.tangent_y.push_back(contact.tangent.y);
            packs.field_a.push_back(packs.field_of(assembly, contact.a.body, contact.a.edge));
            packs.field_b.push_back(packs.field_of(assembly, contact.b.body, contact.b.edge));
        }
        packs.contacts.push_back(pack);
        c += pack.lanes;
    }
}

void sort_out_contacts(Assembly& assembly) {
    assembly.packs.loose_contacts.clear();
    for (ContactPack& pack : assembly.packs.contacts) {
        pack.active = 0;
        for (int lane = 0; lane < pack.lanes; ++lane) {
            const Contact& contact = assembly.contacts[pack.first_contact + lane];
            if (contact.dropped) continue;
            if (is_loose(contact)) {
                assembly.packs.loose_contacts.push_back(pack.first_contact + lane);
            } else {
                pack.active = static_cast<std::uint8_t>(pack.active | 1U << lane);
            }
        }
    }
}

}  // namespace feldspar
