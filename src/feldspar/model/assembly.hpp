// What is simulated and who owns it. Every array has one owner, the Assembly; stages take what they need of it.
//
// Layout: nodes and triangles belong to one grain each and are contiguous by grain, so that the grain stage works in a
// few kilobytes at a time and never touches another grain. A contact reads both of its grains and writes only its own two
// slots; a grain gathers its slots in a fixed order. So there are no atomics, and the same bits for any number of threads.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "feldspar/base/vec2.hpp"
#include "feldspar/laws/bond.hpp"
#include "feldspar/laws/plane_elasticity.hpp"
#include "feldspar/model/spec.hpp"

namespace feldspar {

/// Node arrays, all of the same length. Displacements are stored instead of positions: gaps of nanometres need the digits.
struct Nodes {
    std::vector<Vec2> reference;      ///< m
    std::vector<Vec2> displacement;   ///< m
    std::vector<Vec2> velocity;       ///< m per unit of time (a step, or a second with real masses)
    std::vector<Vec2> force;          ///< N, of the last step: contacts, triangles and pressure, without damping
    std::vector<Vec2> inverse_mass;   ///< 1/kg; 0 in a direction whose motion is imposed
    std::vector<Vec2> loading_mode;   ///< B: motion of the node per unit of platen motion; imposed where inverse_mass is 0
    std::vector<double> mass;         ///< kg, scaled or real

    int count() const { return static_cast<int>(reference.size()); }
    Vec2 position(int node) const { return reference[node] + displacement[node]; }
};

/// Constant-strain triangle; the gradient of the first node's shape function is minus the sum of the other two.
struct Triangle {
    std::array<std::int32_t, 3> node{};
    std::array<Vec2, 2> gradient{};   ///< 1/m, undeformed, of the second and third node's shape functions
    double volume_m3 = 0.0;           ///< area x thickness
};

struct Grain {
    std::int32_t node_begin = 0, node_end = 0;
    std::int32_t triangle_begin = 0, triangle_end = 0;
    std::int32_t edge_begin = 0, edge_end = 0;       ///< into Assembly::grain_edges
    std::int32_t slot_begin = 0, slot_end = 0;       ///< into Assembly::slots_of_grains
    std::int32_t pressure_begin = 0, pressure_end = 0;
    std::int32_t centre_node = 0;                    ///< the node at the centroid: centre of the contact circle
    double radius_m = 0.0;                           ///< of the contact circle
};

/// The triangle behind a grain's edge: first two nodes are the edge, counter-clockwise.
using EdgeNodes = std::array<std::int32_t, 3>;

/// One side of a contact: a grain through the triangle that owns its edge, or a platen.
struct ContactSide {
    EdgeNodes node{};          ///< of the triangle behind the edge; unused by a platen
    std::int32_t grain = -1;   ///< < 0: a platen
    std::int32_t platen = 0;   ///< which, if it is one
};

/// Two facing grain edges, or a grain and a platen (always side B).
/// Frame: n from A to B; reference point at the distance s along n from A's centre,
///     s = d/2 + offset (grains; offset = (RA - RB)/2 + dv, equation (7)),   s = offset (platen).
struct Contact {
    ContactSide a, b;
    double offset_m = 0.0;
    Vec2 tangent{0.0, 1.0};        ///< the edge's tangent in the frame (n, rot90(n)): it turns with n
    double closing_distance_m = 0.0; ///< once broken, the contact is dropped beyond this distance of the centres
    std::int32_t first_point = 0;
    std::int32_t points = 0;
    std::int32_t material = 0;     ///< into Assembly::laws
    bool initial_shape = false;    ///< uses the shape functions of the undeformed state (fall-back)
    bool dropped = false;          ///< carries nothing any more
    bool new_contact = false;      ///< made after detachment
};

/// A quadrature point of a contact: its constants and its bond.
struct ContactPoint {
    double along_m = 0.0;          ///< W_J: from the reference point along the edge's tangent
    double area_m2 = 0.0;          ///< A_J
    BondState bond;
    long long broken_step = -1;    ///< step at which damage became 1; -1: not broken, or broken from the start
    bool broke_in_tension = false;
    bool lost_compression = false; ///< compression left at an open gap vanished when it broke
};

/// What a contact point keeps of its shape functions, read only between steps and by the fall-back.
struct InitialShape {
    std::array<double, 3> a{}, b{};              ///< of the undeformed state
    std::array<double, 3> covered_a{}, covered_b{};  ///< |N_i| sum|N_j| that the masses of the nodes already allow for
};

using SlotForces = std::array<Vec2, 3>;   ///< forces on the three nodes of a contact side (a platen uses the first)

/// A rigid plate, or the rows of nodes that stand for it.
struct Platen {
    Vec2 normal;                               ///< from the specimen into the platen
    Vec2 mode;                                 ///< its motion per unit of platen motion: (0, -1) for the loading platen, (0, 0) at rest
    double position_m = 0.0;                   ///< along y, of a plate in contact
    std::vector<std::int32_t> nodes;           ///< nodes whose y motion it imposes (flexible specimens)
    std::vector<std::int32_t> contacts;        ///< plate contacts (Brazilian)
};

/// A boundary edge under pressure.
struct PressureEdge {
    std::int32_t node_a = 0, node_b = 0;
    Vec2 outward;                              ///< unit normal of the undeformed edge
};

/// Work done on a grain, accumulated every step (J).
struct GrainWork {
    double damping = 0.0;    ///< taken out by damping
    double pressure = 0.0;   ///< put in by the lateral pressure
};

/// The whole body.
struct Assembly {
    double thickness_m = 0.0;
    PlaneElasticity elasticity;
    std::vector<BondLaw> laws;                 ///< by Contact::material: 0 between grains, 1 at plates
    Nodes nodes;
    std::vector<Triangle> triangles;
    std::vector<Grain> grains;
    std::vector<EdgeNodes> grain_edges;
    std::vector<Contact> contacts;
    std::vector<ContactPoint> points;
    std::vector<InitialShape> initial_shapes;  ///< a contact point
    std::vector<SlotForces> slots;             ///< 2 x contact + side
    std::vector<std::int32_t> slots_of_grains; ///< slot numbers, contiguous by grain
    std::vector<PressureEdge> pressure_edges;  ///< contiguous by grain
    std::vector<GrainWork> grain_work;
    std::array<Platen, 2> platens;             ///< 0 loading (top), 1 at rest (bottom)
    double pressure_Pa = 0.0;                  ///< on the pressure edges, compression positive

    Vec2 centre(int grain) const { return nodes.position(grains[grain].centre_node); }
    double memory_bytes() const;
};

/// G = F - I of a triangle, from the displacements of all nodes.
inline Mat2 displacement_gradient(const std::vector<Vec2>& u, const Triangle& triangle) {
    const auto [i, j, k] = triangle.node;
    const Vec2 gj = triangle.gradient[0], gk = triangle.gradient[1];
    const Vec2 uj = u[j] - u[i], uk = u[k] - u[i];
    return {uj.x * gj.x + uk.x * gk.x, uj.x * gj.y + uk.x * gk.y, uj.y * gj.x + uk.y * gk.x, uj.y * gj.y + uk.y * gk.y};
}

/// Direction and length of a contact's frame in the current configuration.
struct ContactFrame {
    Vec2 n;
    Vec2 reference_point;
    Vec2 edge_tangent;
    double distance_m = 0.0;   ///< of the centres; 0 for a platen
};

inline ContactFrame contact_frame(const Assembly& body, const Contact& contact) {
    ContactFrame f;
    const Vec2 xa = body.centre(contact.a.grain);
    double s = contact.offset_m;
    if (contact.b.grain >= 0) {
        const Vec2 line = body.centre(contact.b.grain) - xa;
        f.distance_m = norm(line);
        f.n = (1.0 / f.distance_m) * line;
        s += 0.5 * f.distance_m;
    } else {
        f.n = body.platens[contact.b.platen].normal;
    }
    f.reference_point = xa + s * f.n;
    f.edge_tangent = contact.tangent.x * f.n + contact.tangent.y * rot90(f.n);
    return f;
}

/// Linear shape functions of the triangle with current corners p at the point x (equation (10)); x may lie outside.
inline std::array<double, 3> shape_functions(const std::array<Vec2, 3>& p, Vec2 x) {
    const Vec2 e1 = p[1] - p[0], e2 = p[2] - p[0], r = x - p[0];
    const double inverse = 1.0 / cross(e1, e2);
    const double N1 = cross(r, e2) * inverse, N2 = cross(e1, r) * inverse;
    return {1.0 - N1 - N2, N1, N2};
}

inline std::array<Vec2, 3> corners(const Nodes& nodes, const EdgeNodes& t) {
    return {nodes.position(t[0]), nodes.position(t[1]), nodes.position(t[2])};
}

}  // namespace feldspar
