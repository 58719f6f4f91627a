// How a contact hangs on a body: the one thing in which flexible grains, rigid bodies and plates differ to a contact.
//
// An attachment says, for a point x of the contact, how the side's nodes move that point (`Weights`), with which velocity, and
// at which arm from the body's centre a force at the point acts. The body takes force and moment back by the very weights that
// the velocity comes from, so what the contact does to the nodes is the work that it does at the point (paper, equations (9)-(10)
// and (18)-(19)). `Model` is an Assembly, or what has its members (gpu/).
#pragma once

#include <array>

#include "feldspar/model/assembly.hpp"

namespace feldspar {

/// Linear shape functions of the triangle with current corners p at the point x (equation (10)); x may lie outside.
FELDSPAR_HD inline std::array<double, 3> shape_functions(const std::array<Vec2, 3>& p, Vec2 x) {
    const Vec2 e1 = p[1] - p[0], e2 = p[2] - p[0], r = x - p[0];
    const double inverse = 1.0 / cross(e1, e2);
    const double N1 = cross(r, e2) * inverse, N2 = cross(e1, r) * inverse;
    return {1.0 - N1 - N2, N1, N2};
}

template <class NodeArrays>
FELDSPAR_HD std::array<Vec2, 3> corners(const NodeArrays& nodes, const SideNodes& t) {
    return {nodes.position(t[0]), nodes.position(t[1]), nodes.position(t[2])};
}

/// What the corners p of a triangle feel of a force F and its moment M about a centre c that moves with the triangle's linear
/// field: f_i = N_i(c) F + M grad N_i (C20).
FELDSPAR_HD inline std::array<Vec2, 3> forces_on_corners(const std::array<Vec2, 3>& p, Vec2 centre, const SlotForces& slot) {
    const Vec2 e1 = p[1] - p[0], e2 = p[2] - p[0], r = centre - p[0], F = slot.force;
    const double inverse = 1.0 / cross(e1, e2);
    const Vec2 Mx = {slot.moment.xx + r.x * F.x, slot.moment.yx + r.x * F.y};  // about p[0], column by column
    const Vec2 My = {slot.moment.xy + r.y * F.x, slot.moment.yy + r.y * F.y};
    const Vec2 f1 = inverse * (e2.y * Mx - e2.x * My), f2 = inverse * (e1.x * My - e1.y * Mx);
    return {F - f1 - f2, f1, f2};
}

/// A flexible grain: by the triangle behind the edge.
class TriangleAttachment {
public:
    using Weights = std::array<double, 3>;

    template <class Model>
    FELDSPAR_HD TriangleAttachment(const Model& assembly, const ContactSide& side)
        : centre_(assembly.nodes.position(side.centre_node)),
          corner_(corners(assembly.nodes, side.node)),
          velocity_{assembly.nodes.velocity[side.node[0]], assembly.nodes.velocity[side.node[1]],
                    assembly.nodes.velocity[side.node[2]]} {}

    FELDSPAR_HD Weights at(Vec2 x) const { return shape_functions(corner_, x); }
    FELDSPAR_HD Vec2 velocity(const Weights& N) const { return N[0] * velocity_[0] + N[1] * velocity_[1] + N[2] * velocity_[2]; }
    /// Weights of the undeformed state belong to another point of the triangle than x: the arm is that point's.
    FELDSPAR_HD Vec2 arm(const Weights& N, Vec2) const {
        return N[0] * (corner_[0] - centre_) + N[1] * (corner_[1] - centre_) + N[2] * (corner_[2] - centre_);
    }

private:
    Vec2 centre_;
    std::array<Vec2, 3> corner_;
    std::array<Vec2, 3> velocity_;
};

/// A rigid body: v + omega x r, the turn being an arc at the contact circle's radius.
class RigidAttachment {
public:
    using Weights = Vec2;  ///< motion of the point per unit of arc: rot90(r) / radius

    template <class Model>
    FELDSPAR_HD RigidAttachment(const Model& assembly, const ContactSide& side)
        : centre_(assembly.nodes.position(side.node[0])),
          velocity_(assembly.nodes.velocity[side.node[0]]),
          arc_velocity_(assembly.nodes.velocity[side.node[1]].x),
          inverse_radius_(side.inverse_radius) {}

    FELDSPAR_HD Weights at(Vec2 x) const { return inverse_radius_ * rot90(x - centre_); }
    FELDSPAR_HD Vec2 velocity(Weights arc) const { return velocity_ + arc_velocity_ * arc; }
    FELDSPAR_HD Vec2 arm(Weights, Vec2 x) const { return x - centre_; }

private:
    Vec2 centre_, velocity_;
    double arc_velocity_;
    double inverse_radius_;
};

/// A plate: it does not turn.
class PlateAttachment {
public:
    struct Weights {};

    template <class Model>
    FELDSPAR_HD PlateAttachment(const Model& assembly, const ContactSide& side)
        : velocity_(assembly.nodes.velocity[side.node[0]]) {}

    FELDSPAR_HD Weights at(Vec2) const { return {}; }
    FELDSPAR_HD Vec2 velocity(Weights) const { return velocity_; }
    FELDSPAR_HD Vec2 arm(Weights, Vec2) const { return {}; }

private:
    Vec2 velocity_;
};

/// Calls work.template operator()<A, B>() with the attachments of a contact's two sides.
template <class Work>
FELDSPAR_HD decltype(auto) with_attachments(const Contact& contact, Work&& work) {
    if (contact.plate)
        return contact.flexible ? work.template operator()<TriangleAttachment, PlateAttachment>()
                                : work.template operator()<RigidAttachment, PlateAttachment>();
    return contact.flexible ? work.template operator()<TriangleAttachment, TriangleAttachment>()
                            : work.template operator()<RigidAttachment, RigidAttachment>();
}

}  // namespace feldspar
