// Packs: equal things side by side, so that one vector instruction serves all of a pack.
//
// A lane is a grain in a grain pack and a contact in a contact pack; no lane ever looks at another. All arrays that a step
// streams through are laid out pack by pack, each quantity of all lanes together:
//
//     node i of lane l        first_node + i x lanes + l       all node arrays (Nodes); vertices, centre, ring
//     edge k of lane l        first_edge + k x lanes + l       fields, inverse_cross, slot_of_edge
//     triangle t of lane l    first_triangle + t x lanes + l   scale
//     point j of lane l       first_state + j x lanes + l      bonds (Bonds), along, area
//
// Grains are grouped by topology: the number of vertices, and whether the shortest edge of the ring is collapsed
// (specimen theory, section 4). Vertices are counted from behind the collapsed edge, so that it is the last one. Packs are ordered by
// height, so that the contiguous share of a thread is a band of the specimen.
// What is not in a pack (finely meshed grains, contacts at plates or with a normal of their own, contacts on the fall-back
// shape functions) is loose, and goes through the readable form of the same stage.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

struct GrainMesh;
struct Assembly;

inline constexpr int kMostLanes = 8;

/// Grains of one topology.
struct GrainPack {
    std::int32_t lanes = 0;                          ///< 1 ... kMostLanes
    std::int32_t vertices = 0;
    bool collapsed = false;                          ///< the ring has one node less, and the last edge only its own triangle
    std::array<std::int32_t, kMostLanes> grain{};    ///< of each lane
    std::array<std::int32_t, kMostLanes> start{};    ///< its vertex in the cell's own count that comes first here
    std::int32_t first_node = 0;
    std::int32_t first_edge = 0;
    std::int32_t first_triangle = 0;

    int nodes() const { return 2 * vertices + 1 - collapsed; }
    int triangles() const { return 3 * vertices - 2 * collapsed; }
};

/// The grains of the mesh that have a common topology, in packs; numbers of nodes, edges and triangles from 0 on.
std::vector<GrainPack> pack_grains(const GrainMesh& mesh);

/// Consecutive contacts with equally many points of one material.
struct ContactPack {
    std::int32_t first_contact = 0;
    std::int32_t lanes = 0;
    std::int32_t points = 0;
    std::int32_t first_state = 0;
    std::int32_t material = 0;
    bool rigid = false;          ///< both sides are rigid bodies
    std::uint8_t active = 0;     ///< lane l takes part if bit l is set
};

/// How a body's side of a contact moves: v + L (x - centre), of the triangle behind the edge, or of the rigid body.
struct alignas(64) SideField {
    Vec2 centre;     ///< m, of the contact circle
    Vec2 velocity;   ///< of the field at the centre, m per unit of time
    Mat2 gradient;   ///< L, 1 per unit of time
};

/// A side whose edge has several contacts: their slots are summed before the body looks at them.
struct SharedEdge {
    std::int32_t body = 0;
    std::int32_t sum = 0;                      ///< the slot that holds the sum
    std::int32_t begin = 0, end = 0;           ///< into Packs::shared_slots
};

/// Everything that the packs add to an assembly. Derived: follows from bodies, contacts and points.
struct Packs {
    std::vector<GrainPack> grains;
    std::vector<std::int32_t> loose_bodies;          ///< not in a grain pack and not rigid: plates, finely meshed grains
    std::int32_t rigid_begin = 0, rigid_end = 0;     ///< bodies
    std::vector<double> scale;                       ///< of each triangle: 1 / (4 x area), 1/m2
    std::vector<std::int32_t> field_of_edge;         ///< of each GrainEdge; bodies without edges have theirs behind all edges
    std::int32_t field_of_first_body = 0;
    std::vector<SideField> fields;                   ///< written by the body stage, read by the contact stage
    std::vector<double> inverse_cross;               ///< of each edge field: 1 / (2 x present area of its triangle)
    std::vector<std::int32_t> slot_of_edge;          ///< of each edge field: the slot with its contact's force; of the empty slot if it has none
    std::vector<SharedEdge> shared_edges;            ///< by body
    std::vector<std::int32_t> shared_slots;

    std::vector<ContactPack> contacts;
    std::vector<std::int32_t> loose_contacts;
    std::vector<double> offset, tangent_x, tangent_y;   ///< kMostLanes a pack
    std::vector<std::int32_t> field_a, field_b;         ///< kMostLanes a pack
    std::vector<double> along, area;                    ///< as bonds

    std::int32_t field_of(const Assembly& assembly, int body, int edge) const;
};

/// Makes the packs of grains of an assembly that has its nodes in their order; once.
void index_grain_packs(Assembly& assembly);

/// Makes the packs of contacts; after contacts were added or dropped.
void index_contact_packs(Assembly& assembly);

/// Decides which contacts take part in their packs and which are loose, by their present flags.
void sort_out_contacts(Assembly& assembly);

}  // namespace feldspar
