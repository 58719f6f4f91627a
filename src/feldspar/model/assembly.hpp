// What is simulated and who owns it. Every array has one owner, the Assembly; stages take what they need of it.
//
// Layout: nodes and triangles belong to one body each, so that the body stage works in a few kilobytes at a time and never
// touches another body. A contact reads both of its bodies and writes only its own two slots; a body gathers its slots in a
// fixed order. So there are no atomics, and the same bits for any number of threads. Grains of equal topology, and contacts
// with equally many points, stand side by side in packs (model/packs.hpp), so that vector instructions can take a pack at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "feldspar/base/array.hpp"
#include "feldspar/base/vec2.hpp"
#include "feldspar/laws/bond.hpp"
#include "feldspar/laws/dilation.hpp"
#include "feldspar/laws/plane_elasticity.hpp"
#include "feldspar/model/own_laws.hpp"
#include "feldspar/model/packs.hpp"
#include "feldspar/model/spec.hpp"

namespace feldspar {

/// Node arrays, all of the same length. Displacements are stored instead of positions: gaps of nanometres need the digits.
///
/// Everything that moves does so through nodes. A flexible grain has the nodes of its triangles. A rigid body has two: its
/// centre, and its turn, whose x holds the rotation as an arc on the body's contact circle (rotation x radius, m) and whose y is
/// never free. So forces, masses, damping, loading mode, stability and energy have one form for all bodies; a force on a turn is
/// a moment over the radius, its mass the moment of inertia over the radius squared. A plate has one node, free where it may
/// move.
struct Nodes {
    Array<Vec2> reference;     ///< m; of a turn: that of its centre
    Array<Vec2> displacement;  ///< m
    Array<Vec2> velocity;      ///< m per unit of time (a step, or a second with real masses)
    Array<Vec2> force;         ///< N, of the last step: contacts, triangles and pressure, without damping
    Array<Vec2> inverse_mass;  ///< 1/kg; 0 in a direction whose motion is imposed
    Array<Vec2> loading_mode;  ///< B: motion of the node per unit of platen motion; imposed where inverse_mass is 0
    Array<double> mass;        ///< kg, scaled or real

    int count() const { return static_cast<int>(reference.size()); }
    Vec2 position(int node) const { return reference[node] + displacement[node]; }

    void reserve(std::size_t nodes);
    /// Adds a node at rest. @param free  1 in a direction that is free, 0 in one that is imposed. @return its number
    int add(Vec2 place, Vec2 free);
};

/// Constant-strain triangle; the gradient of the first node's shape function is minus the sum of the other two.
struct Triangle {
    std::array<std::int32_t, 3> node{};
    std::array<Vec2, 2> gradient{};  ///< 1/m, undeformed, of the second and third node's shape functions
    double volume_m3 = 0.0;          ///< area x thickness
};

enum class BodyKind : std::uint8_t { flexible, rigid, plate };

/// Node numbers of a body: those of a flexible grain stand a lane apart from each other.
class NodeNumbers {
public:
    class Iterator {
    public:
        FELDSPAR_HD Iterator(std::int32_t node, std::int32_t stride) : node_(node), stride_(stride) {}
        FELDSPAR_HD std::int32_t operator*() const { return node_; }
        FELDSPAR_HD Iterator& operator++() {
            node_ += stride_;
            return *this;
        }
        FELDSPAR_HD friend bool operator==(const Iterator& l, const Iterator& r) { return l.node_ == r.node_; }

    private:
        std::int32_t node_, stride_;
    };
    FELDSPAR_HD NodeNumbers(std::int32_t first, std::int32_t count, std::int32_t stride)
        : first_(first), count_(count), stride_(stride) {}
    FELDSPAR_HD Iterator begin() const { return {first_, stride_}; }
    FELDSPAR_HD Iterator end() const { return {first_ + count_ * stride_, stride_}; }

private:
    std::int32_t first_, count_, stride_;
};

/// What moves by itself: a flexible grain, a rigid grain, an inner particle (a rigid disc), a plate.
struct Body {
    BodyKind kind = BodyKind::flexible;
    std::int32_t grain = -1;  ///< the Laguerre cell that it is, or lies in; -1: a plate
    std::int32_t first_node = 0, node_count = 0;
    std::int32_t node_stride = 1;  ///< between its nodes: the lanes of its pack
    std::int32_t triangle_begin = 0, triangle_end = 0;
    std::int32_t edge_begin = 0, edge_end = 0;  ///< into Assembly::edges; none of a disc or a plate
    std::int32_t slot_begin = 0, slot_end = 0;  ///< into Assembly::slots_of_bodies
    std::int32_t pressure_begin = 0, pressure_end = 0;
    std::int32_t centre_node = 0;  ///< the node at the centroid: centre of the contact circle
    double radius_m = 0.0;         ///< of the contact circle
    Vec2 normal;                   ///< of a plate: from the specimen into it
    double volume_m3 = 0.0;        ///< of a rigid body, for its real mass; of a disc its share of the grain
    double gyration_m2 = 0.0;      ///< of a rigid body: moment of inertia over mass
    double density_kg_m3 = 0.0;

    FELDSPAR_HD std::int32_t node(int local) const { return first_node + local * node_stride; }
    FELDSPAR_HD NodeNumbers nodes() const { return {first_node, node_count, node_stride}; }
};

/// Where a contact hangs on a body: a flexible one by the triangle behind the edge (its first two nodes are the edge), a
/// rigid one by {centre, turn}, a plate by its only node.
using SideNodes = std::array<std::int32_t, 3>;

/// An edge of a grain's outline, counter-clockwise.
struct GrainEdge {
    SideNodes node{};
    Vec2 from, to;  ///< m, undeformed
};

/// One side of a contact, with what the step needs of its body.
struct ContactSide {
    SideNodes node{};
    std::int32_t body = -1;
    std::int32_t edge = -1;        ///< into Assembly::edges; -1 of a disc or a plate
    std::int32_t centre_node = 0;  ///< of the body
    double inverse_radius = 0.0;   ///< 1/m, of the body's contact circle
};

/// Two facing edges, or an edge and a plate (always side B).
/// Frame: n from A to B; reference point at the distance s along the line of centres from A's centre,
///     s = d/2 + offset (offset = (RA - RB)/2 + dv, equation (7)),   s = offset along the plate's normal (plate).
struct Contact {
    ContactSide a, b;
    double offset_m = 0.0;
    Vec2 tangent{0.0, 1.0};      ///< the edge's tangent in the frame (n, rot90(n)): it turns with n
    Vec2 edge_normal{0.0, 0.0};  ///< not zero: n is this undeformed direction, turned by the mean rotation of two rigid bodies
    double closing_distance_m = 0.0;  ///< once broken, the contact is dropped beyond this distance of the centres
    std::int32_t first_point = 0;
    std::int32_t points = 0;
    std::int32_t material = 0;   ///< its role; without a law of its own also its law: into Assembly::laws
    std::int32_t own_law = -1;   ///< into Assembly::own_laws; -1: that of its role
    bool plate = false;          ///< side B is a plate
    bool flexible = false;       ///< side A is a flexible grain, and side B if it is no plate
    bool smooth = false;         ///< its normal is that of its edge, not of the line of centres: on a joint that is cut
    bool initial_shape = false;  ///< uses the shape functions of the undeformed state (fall-back)
    bool dropped = false;        ///< carries nothing any more
    bool new_contact = false;    ///< made after detachment
    std::int16_t dilation = -1;  ///< into Assembly::dilations; -1: it does not dilate
};

/// Where a contact lay on the tessellation, for cracks and fields; the step never reads it.
struct ContactOrigin {
    std::int32_t edge_a = -1, edge_b = -1;  ///< edge of each side's grain, in the cell's own count; -1: none
    Vec2 from, to;                          ///< m, undeformed: the part of the grain edge that the contact stands for
};

/// A quadrature point of a contact: its constants and when it broke. Its bond is Assembly::bond().
struct ContactPoint {
    double along_m = 0.0;        ///< W_J: from the reference point along the edge's tangent
    double area_m2 = 0.0;        ///< A_J
    double free_gap_m = 0.0;     ///< between the circles of two bonded discs that do not touch; 0 for facing edges
    std::int32_t state = -1;     ///< where its bond stands in Assembly::bonds
    long long broken_step = -1;  ///< step at which damage became 1; -1: not broken, or broken from the start
    double broken_J = 0.0;       ///< what it had dissipated by then
    bool broke_in_tension = false;
    bool lost_compression = false;  ///< compression left at an open gap vanished when it broke
};

/// What a contact point between flexible bodies keeps of its shape functions, read only between steps and by the fall-back.
struct InitialShape {
    std::array<double, 3> a{}, b{};                  ///< of the undeformed state
    std::array<double, 3> covered_a{}, covered_b{};  ///< |N_i| sum|N_j| that the masses of the nodes already allow for
};

/// Notes how and when a point broke. Bodies that were joined over a free gap push each other from now on only when they meet.
inline void note_break(ContactPoint& point, const BondLawOf<double>& law, BondEvent event, long long step, BondState& bond) {
    point.broken_step = step;
    point.broke_in_tension = event == BondEvent::broke_in_tension;
    point.lost_compression = event == BondEvent::broke_in_shear_losing_compression;
    if (point.free_gap_m > 0.0) free_gap(law, point.area_m2, point.free_gap_m, bond);
    point.broken_J = bond.fracture_J;
}

/// The bonds of all contact points, quantity by quantity (BondState).
struct Bonds {
    Array<double> un_m, us_m, Fn_N, Fs_N, max_un_m, max_us_m, damage, fracture_J, friction_J;
    Array<double> slip_m;  ///< how far it has slipped since it broke (laws/dilation.hpp); empty where no joint dilates

    void reserve(std::size_t count);
    void resize(std::size_t count);
    BondState at(std::size_t i) const {
        return {un_m[i], us_m[i], Fn_N[i], Fs_N[i], max_un_m[i], max_us_m[i], damage[i], fracture_J[i], friction_J[i]};
    }
    void set(std::size_t i, const BondState& s);
};

/// What loads the specimen or holds it (model/fixtures.hpp): nodes of its own, or the node of a plate in contact with it.
struct Fixture {
    std::string name;
    Vec2 motion;                      ///< per unit of the loading motion: (0, -1) for a platen that comes down; zero at rest
    std::vector<std::int32_t> nodes;  ///< whose motion it imposes, and whose forces make its reaction
    Vec2 imposed{0.0, 1.0};           ///< 1 in a component that it imposes, else 0
    std::int32_t plate = -1;          ///< body of the plate, if it is one

    bool moves() const { return motion != Vec2{}; }
};

/// A pressure that is given and does not follow the loading motion: on a part of the boundary, on the plates of a membrane, or on
/// one plate.
struct DeadLoad {
    std::string name;              ///< of its fixture
    double given_Pa = 0.0;         ///< with which the test begins; compression positive
    double pressure_Pa = 0.0;      ///< at present; of one plate: where its spring has its rest
    double stiffness_Pa_m = 0.0;   ///< of the spring that presses one plate; 0: the pressure stays whatever the plate does
    std::int32_t plate_node = -1;  ///< of one plate with a spring
    bool springs = false;          ///< the spring acts: the plate has come to `rest_m`
    double rest_m = 0.0;           ///< displacement of the plate along `outward` at which the pressure is pressure_Pa
    Vec2 outward{};                ///< of one plate: from the specimen into it
    Vec2 resultant_m2{};           ///< force on specimen and plates for a pressure of one, undeformed
};

/// A boundary edge under pressure, or a plate under one.
struct PressureEdge {
    std::int32_t node_a = 0, node_b = 0;  ///< a plate's node twice
    Vec2 outward;                         ///< unit normal of the undeformed edge
    double plate_length_m = 0.0;          ///< of a plate; 0: the pressure acts over the current distance of the nodes
    std::int32_t load = 0;                ///< into Assembly::dead_loads
};

/// Work done on a body, accumulated every step (J).
struct BodyWork {
    double damping = 0.0;   ///< taken out by damping
    double pressure = 0.0;  ///< put in by pressures
};

/// Materials of contacts, by Contact::material. Plates that touch alike share one; others have those from `at_more_plates` on.
enum ContactRole : std::int32_t {
    between_grains = 0,
    at_plates = 1,
    inside_grains = 2,
    at_membranes = 3,
    at_more_plates = 4,
    contact_roles = 10
};

/// Pressure of a load whose plate, if it has one with a spring, is displaced by `u`. A spring does not pull.
template <class Load>
FELDSPAR_HD double pressure_of(const Load& load, Vec2 u) {
    if (!load.springs) return load.pressure_Pa;
    const double pressure_Pa = load.pressure_Pa + load.stiffness_Pa_m * (dot(u, load.outward) - load.rest_m);
    return 0.0 < pressure_Pa ? pressure_Pa : 0.0;
}

/// Everything that a test moves.
struct Assembly {
    double thickness_m = 0.0;
    std::vector<PlaneElasticity> elasticity;  ///< of flexible grains: one for all, or one each
    std::array<BondLaw, contact_roles> laws;  ///< by role
    OwnLaws own_laws;                         ///< of contacts between the grains of a rock whose contacts are not alike
    std::vector<Dilation> dilations;          ///< of joints that dilate
    Nodes nodes;
    std::vector<Triangle> triangles;
    std::vector<Body> bodies;  ///< the grains, or their inner particles; then the plates
    std::vector<GrainEdge> edges;
    std::vector<std::int32_t> node_of_mesh;      ///< flexible grains: node of each node of the grain mesh
    std::vector<std::int32_t> body_of_particle;  ///< inner particles: body of each particle of the filling
    std::vector<Contact> contacts;
    std::vector<ContactOrigin> origins;  ///< a contact
    std::vector<ContactPoint> points;
    Bonds bonds;                                ///< of the points, in the order of the packs
    std::vector<InitialShape> initial_shapes;   ///< a contact point; empty where no body is flexible
    std::vector<SlotForces> slots;              ///< 2 x contact + side; packs leave forces in their own lines instead
    std::vector<std::int32_t> slots_of_bodies;  ///< slot numbers, contiguous by body
    std::vector<PressureEdge> pressure_edges;   ///< contiguous by body
    std::vector<BodyWork> body_work;
    std::vector<Fixture> fixtures;     ///< those whose reaction is felt: not membranes
    std::vector<DeadLoad> dead_loads;  ///< on the pressure edges
    Array<Vec2> weight;                ///< N, of each node: what gravity does; empty without gravity
    Packs packs;

    const PlaneElasticity& elasticity_of(int body) const {
        return elasticity.size() == 1 ? elasticity.front() : elasticity[body];
    }
    BondLaw law_of(const Contact& contact) const {
        return contact.own_law < 0 ? laws[contact.material] : BondLaw(bond_law(own_laws.form, own_laws.at(contact.own_law)));
    }
    Vec2 centre(int body) const { return nodes.position(bodies[body].centre_node); }
    /// Rotation of a rigid body, rad.
    double rotation(const Body& body) const { return nodes.displacement[body.centre_node + 1].x / body.radius_m; }
    double rotation(int body) const { return rotation(bodies[body]); }
    /// Whether any pressure acts.
    bool is_pressed() const {
        return std::any_of(dead_loads.begin(), dead_loads.end(),
                           [](const DeadLoad& load) { return load.pressure_Pa != 0.0 || load.springs; });
    }
    /// Pressure of a load at present, or where its plate was at a displacement of `back` before.
    double pressure_Pa(const DeadLoad& load, Vec2 back = {}) const {
        return pressure_of(load, load.springs ? nodes.displacement[load.plate_node] - back : Vec2{});
    }
    BondState bond(int point) const { return bonds.at(static_cast<std::size_t>(points[point].state)); }
    void set_bond(int point, const BondState& bond) { bonds.set(static_cast<std::size_t>(points[point].state), bond); }
    /// Adds a contact point. @return its number
    int add_point(double along_m, double area_m2, const BondState& bond = {});
    /// Slip of a point of a joint that dilates, m.
    double& slip_m(int point) { return bonds.slip_m[static_cast<std::size_t>(points[point].state)]; }
    /// By how much the faces at a point have climbed over each other, m.
    double dilated_m(const Contact& contact, int point) const {
        if (contact.dilation < 0) return 0.0;
        const Dilation& dilation = dilations[contact.dilation];
        return dilation.tan_psi * std::min(bonds.slip_m[points[point].state], dilation.slip_m);
    }
    double memory_bytes() const;
};

/// G = F - I of a triangle, from the displacements of all nodes.
inline Mat2 displacement_gradient(std::span<const Vec2> u, const Triangle& triangle) {
    const auto [i, j, k] = triangle.node;
    const Vec2 gj = triangle.gradient[0], gk = triangle.gradient[1];
    const Vec2 uj = u[j] - u[i], uk = u[k] - u[i];
    return {uj.x * gj.x + uk.x * gk.x, uj.x * gj.y + uk.x * gk.y, uj.y * gj.x + uk.y * gk.x, uj.y * gj.y + uk.y * gk.y};
}

/// Outward normal of side A of a contact on a cut joint: of both edges' mean direction now. @tparam Model  an Assembly, or what
/// has its members
template <class Model>
FELDSPAR_HD Vec2 normal_of_edges(const Model& assembly, const Contact& contact) {
    Vec2 along;
    if (contact.flexible) {
        const auto edge = [&](const ContactSide& side) {
            return assembly.nodes.position(side.node[1]) - assembly.nodes.position(side.node[0]);
        };
        along = edge(contact.a) - edge(contact.b);
    } else {
        const GrainEdge& edge = assembly.edges[contact.a.edge];
        along = turned(edge.to - edge.from, 0.5 * (assembly.rotation(contact.a.body) + assembly.rotation(contact.b.body)));
    }
    return (-1.0 / norm(along)) * rot90(along);
}

/// Direction and length of a contact's frame in the current configuration.
struct ContactFrame {
    Vec2 n;  ///< of the law
    Vec2 reference_point;
    Vec2 edge_tangent;
    double distance_m = 0.0;  ///< of the centres; 0 for a plate
};

template <class Model>
FELDSPAR_HD ContactFrame contact_frame(const Model& assembly, const Contact& contact) {
    ContactFrame f;
    const Vec2 xa = assembly.nodes.position(contact.a.centre_node);
    double s = contact.offset_m;
    if (contact.plate) {
        f.n = assembly.bodies[contact.b.body].normal;
    } else {
        const Vec2 line = assembly.nodes.position(contact.b.centre_node) - xa;
        f.distance_m = norm(line);
        f.n = (1.0 / f.distance_m) * line;
        s += 0.5 * f.distance_m;
    }
    f.reference_point = xa + s * f.n;
    f.edge_tangent = contact.tangent.x * f.n + contact.tangent.y * rot90(f.n);
    if (contact.smooth) f.n = normal_of_edges(assembly, contact);
    if (contact.edge_normal != Vec2{})
        f.n = turned(contact.edge_normal, 0.5 * (assembly.rotation(contact.a.body) + assembly.rotation(contact.b.body)));
    return f;
}

}  // namespace feldspar
