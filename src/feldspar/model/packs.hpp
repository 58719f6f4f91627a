// Packs: equal things side by side, so that one vector instruction serves all of a pack.
//
// A lane is a grain in a grain pack and a contact in a contact pack; no lane ever looks at another. All arrays that a step
// streams through are laid out pack by pack, each quantity of all lanes together:
//
//     node i of lane l        first_node + i x lanes + l       all node arrays (Nodes): vertices, centre, ring
//     edge k of lane l        first_edge + k x lanes + l       lines, inverse_cross, bare
//     triangle t of lane l    first_triangle + t x lanes + l   scale
//     point j of lane l       first_state + j x lanes + l      bonds (Bonds), along, area
//
// Grains are grouped by topology: the number of vertices, and whether the shortest edge of the ring is collapsed
// (specimen theory, section 4). Vertices are counted from behind the collapsed edge, so that it is the last one. Packs of grains
// are ordered by height, and those of contacts by the places of the grains that they join, so that a contiguous share is a band
// of the specimen.
//
// A grain edge has one line of 64 bytes between its grain and its contact: the grain leaves in it how the edge moves, the contact
// reads that, and leaves in it what the edge feels. Rigid bodies have a line each, for how they move and have turned, and each of
// their contacts leaves what both sides feel in a short line.
//
// What is not in a pack (finely meshed grains, plates, contacts at plates, contacts on the fall-back shape functions) is loose,
// and goes through the readable form of the same stage.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "feldspar/base/array.hpp"
#include "feldspar/base/vec2.hpp"
#include "feldspar/model/bands.hpp"

namespace feldspar {

struct GrainMesh;
struct Assembly;

inline constexpr int kMostLanes = 8;
inline constexpr int kFetchAhead = 3;     ///< packs of contacts whose lines are fetched before they are needed
inline constexpr int kMostVertices = 32;  ///< of a packed grain; those with more stay loose
inline constexpr int kAtOnce = 5;  ///< contacts on each side that a rigid body sums unconditionally; missing ones point to a zero
                                   ///< record, which avoids a branch

/// What else a step has to do for a pack of grains.
enum class PackForces : std::uint8_t {
    own,              ///< nothing: only contacts and triangles act on it, and nobody reads its node forces
    kept,             ///< its node forces are read by others: a platen's reaction
    on_top_of_others  ///< node forces already hold what acts from outside, pressures, and are kept
};

/// Grains of one topology.
struct GrainPack {
    std::int32_t lanes = 0;  ///< 1 ... kMostLanes
    std::int32_t vertices = 0;
    bool collapsed = false;                        ///< the ring has one node less, and the last edge only its own triangle
    std::array<std::int32_t, kMostLanes> grain{};  ///< of each lane
    std::array<std::int32_t, kMostLanes> start{};  ///< its vertex in the cell's own count that comes first here
    std::int32_t first_node = 0;
    std::int32_t first_edge = 0;
    std::int32_t first_triangle = 0;

    FELDSPAR_HD int nodes() const { return 2 * vertices + 1 - collapsed; }
    FELDSPAR_HD int triangles() const { return 3 * vertices - 2 * collapsed; }
};

/// The grains of the mesh that have a common topology, in packs; numbers of nodes, edges and triangles from 0 on.
std::vector<GrainPack> pack_grains(const GrainMesh& mesh);

/// Consecutive contacts with equally many points of one material; all with laws of their own, or none; all with a normal of their
/// own, or none; if at a plate, all at the same.
struct ContactPack {
    std::int32_t first_contact = 0;
    std::int32_t lanes = 0;
    std::int32_t points = 0;
    std::int32_t first_state = 0;
    std::int32_t material = 0;
    std::int32_t first_law = -1;  ///< of a pack whose contacts have laws of their own: into Assembly::own_laws
    std::int32_t first_normal =
        -1;  ///< of a pack whose contacts have a normal of their own, which are central: into Packs::normal_x, normal_y
    bool rigid = false;       ///< both sides are rigid bodies
    bool central = false;     ///< its contacts have one point, at the reference point
    bool intact = false;      ///< no point of it has any damage
    bool plain = false;       ///< all lanes are taken, take part, and may leave their forces in the lines that they read
    std::uint8_t active = 0;  ///< lane l takes part if bit l is set
};

/// How a body's side of a contact moves: v + L (x - centre), of the triangle behind the edge, or of the rigid body.
struct SideField {
    Vec2 centre;    ///< m, of the contact circle
    Vec2 velocity;  ///< of the field at the centre, m per unit of time
    Mat2 gradient;  ///< L, 1 per unit of time
};

/// What a contact does to one of its bodies: the force, and its first moment about the body's centre, sum of F (x) (x - centre).
/// A linear velocity field v + L (x - centre) gets the power F v + M : L, so this is all that a body needs to know, be it the
/// triangle behind an edge, a rigid body (turning moment Myx - Mxy) or a plate (C20).
struct SlotForces {
    Vec2 force;   ///< N
    Mat2 moment;  ///< N m

    FELDSPAR_HD void add(Vec2 F, Vec2 arm) {
        force += F;
        moment.xx += F.x * arm.x;
        moment.xy += F.x * arm.y;
        moment.yx += F.y * arm.x;
        moment.yy += F.y * arm.y;
    }
    FELDSPAR_HD void add(const SlotForces& other) {
        force += other.force;
        moment.xx += other.moment.xx;
        moment.xy += other.moment.xy;
        moment.yx += other.moment.yx;
        moment.yy += other.moment.yy;
    }
};

/// About the body's centre, N m.
FELDSPAR_HD inline double turning_moment(const SlotForces& slot) { return slot.moment.yx - slot.moment.xy; }

/// A line between a body and a contact: first how the side moves, then what it feels.
union alignas(64) SideLine {
    SideField field;
    SlotForces forces;

    SideLine() : field{} {}
};

/// What a contact of a rigid body does.
struct alignas(32) RigidForces {
    Vec2 force;                             ///< on side B, N; on side A the opposite
    double moment_a = 0.0, moment_b = 0.0;  ///< turning each side, N m
};

/// What the step of a rigid body needs of it.
struct RigidBody {
    std::array<std::uint32_t, kAtOnce> as_a{}, as_b{};  ///< its first contacts as either side: distance in bytes from the first
                                                        ///< rigid_forces; of no contact, where it has less
    std::int32_t more_begin = 0, more_end = 0;          ///< the others, into Packs::more_of_rigid
    std::int32_t first_node = 0;                        ///< its centre; the turn follows
    double inverse_radius = 0.0;                        ///< 1/m, of the contact circle
};

/// An edge with several contacts: they leave their forces in their own slots, which are summed before the grain looks at them.
struct SharedEdge {
    std::int32_t pack = -1;
    std::int32_t line = 0;
    std::int32_t begin = 0, end = 0;  ///< into Packs::shared_slots
};

/// Everything that the packs add to an assembly. Derived: follows from bodies, contacts and points.
struct Packs {
    std::vector<GrainPack> grains;
    std::vector<PackForces> forces;           ///< of each pack of grains
    std::vector<std::int32_t> pack_of_body;   ///< -1: in none
    std::vector<std::int32_t> loose_bodies;   ///< not in a grain pack and not rigid: plates, finely meshed grains
    std::int32_t rigid_end = 0;               ///< bodies [0, rigid_end) are rigid
    Array<RigidBody> rigid;                   ///< these
    std::vector<std::int32_t> more_of_rigid;  ///< slots of the contacts that a body has beyond kAtOnce as either side
    Array<double> scale;                      ///< of each triangle: 1 / (4 x area), 1/m2
    Array<double> volumetric, deviatoric;     ///< kMostLanes a pack: (D11 + D12) t / 2 and (D11 - D12) t / 2 of each grain; empty
                                              ///< where all grains are alike
    std::vector<std::int32_t> line_of_edge;   ///< of each GrainEdge of a flexible body
    std::int32_t line_of_first_body = 0;
    Array<SideLine> lines;                 ///< of the edges of flexible grains; then of the bodies
    Array<double> inverse_cross;           ///< of each edge line: 1 / (2 x present area of its triangle)
    std::vector<std::uint8_t> bare;        ///< of each edge line: 1 if no contact hangs on the edge: it stays zero
    std::vector<std::uint8_t> shared;      ///< of each line: 1 if several contacts hang on the edge, which leave it alone
    std::vector<SharedEdge> shared_edges;  ///< by pack
    std::vector<std::int32_t> shared_slots;

    std::vector<ContactPack> contacts;
    std::vector<std::int32_t> loose_contacts;  ///< in the order of their packs
    Bands bands;
    Array<double> offset, tangent_x, tangent_y;  ///< kMostLanes a pack
    Array<double> normal_x, normal_y;     ///< kMostLanes a pack of contacts with a normal of their own: Contact::edge_normal
    Array<std::uint32_t> line_a, line_b;  ///< kMostLanes a pack: distance in bytes from the first line; some more at the end
    Array<double> along, area;            ///< as bonds
    Array<RigidForces> rigid_forces;      ///< of each contact, and of no contact: zero; none without rigid bodies

    /// Whether an edge of a flexible grain has one contact, which leaves its forces in the edge's line.
    bool only_contact_on(int edge) const { return edge >= 0 && !shared[line_of_edge[edge]]; }
    /// Where a contact on this edge of this body finds how it moves.
    std::int32_t line_of(const Assembly& assembly, int body, int edge) const;
};

/// The pack of grains that holds a node; -1: none.
int pack_of_node(const Packs& packs, int node);

/// Makes the packs of grains of an assembly that has its nodes in their order; once.
void index_grain_packs(Assembly& assembly);

/// Makes the packs of contacts; after contacts were added or dropped.
void index_contact_packs(Assembly& assembly);

/// Decides by the present flags which contacts take part in their packs and which are loose, and by pressure and platens what
/// else acts on the packs of grains. Before a block of steps.
void sort_out_packs(Assembly& assembly);

}  // namespace feldspar
