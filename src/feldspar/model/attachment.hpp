// How a contact hangs on a body: the one thing in which flexible grains, rigid bodies and plates differ to a contact.
//
// An attachment says, for a point x of the contact, how the side's nodes move that point (`Weights`), with which velocity, and
// where a force at the point goes. The force goes back by the very weights that the velocity comes from, so what the contact
// does to the nodes is the work that it does at the point (paper, equations (9)-(10) and (18)-(19)).
#pragma once

#include <array>

#include "feldspar/model/assembly.hpp"

namespace feldspar {

/// Linear shape functions of the triangle with current corners p at the point x (equation (10)); x may lie outside.
inline std::array<double, 3> shape_functions(const std::array<Vec2, 3>& p, Vec2 x) {
    const Vec2 e1 = p[1] - p[0], e2 = p[2] - p[0], r = x - p[0];
    const double inverse = 1.0 / cross(e1, e2);
    const double N1 = cross(r, e2) * inverse, N2 = cross(e1, r) * inverse;
    return {1.0 - N1 - N2, N1, N2};
}

inline std::array<Vec2, 3> corners(const Nodes& nodes, const SideNodes& t) {
    return {nodes.position(t[0]), nodes.position(t[1]), nodes.position(t[2])};
}

/// A flexible grain: by the triangle behind the edge.
class TriangleAttachment {
public:
    using Weights = std::array<double, 3>;

    TriangleAttachment(const Assembly& assembly, const ContactSide& side)
        : corner_(corners(assembly.nodes, side.node)),
          velocity_{assembly.nodes.velocity[side.node[0]], assembly.nodes.velocity[side.node[1]], assembly.nodes.velocity[side.node[2]]} {}

    Weights at(Vec2 x) const { return shape_functions(corner_, x); }
    Vec2 velocity(const Weights& N) const { return N[0] * velocity_[0] + N[1] * velocity_[1] + N[2] * velocity_[2]; }
    static void add(SlotForces& slot, const Weights& N, Vec2 force) {
        for (int i = 0; i < 3; ++i) slot[i] += N[i] * force;
    }

private:
    std::array<Vec2, 3> corner_;
    std::array<Vec2, 3> velocity_;
};

/// A rigid body: v + omega x r, the turn being an arc at the contact circle's radius.
class RigidAttachment {
public:
    using Weights = Vec2;   ///< motion of the point per unit of arc: rot90(r) / radius

    RigidAttachment(const Assembly& assembly, const ContactSide& side)
        : centre_(assembly.nodes.position(side.node[0])),
          velocity_(assembly.nodes.velocity[side.node[0]]),
          arc_velocity_(assembly.nodes.velocity[side.node[1]].x),
          inverse_radius_(side.inverse_radius) {}

    Weights at(Vec2 x) const { return inverse_radius_ * rot90(x - centre_); }
    Vec2 velocity(Weights arc) const { return velocity_ + arc_velocity_ * arc; }
    static void add(SlotForces& slot, Weights arc, Vec2 force) {
        slot[0] += force;
        slot[1].x += dot(arc, force);
    }

private:
    Vec2 centre_, velocity_;
    double arc_velocity_;
    double inverse_radius_;
};

/// A plate: it does not turn.
class PlateAttachment {
public:
    struct Weights {};

    PlateAttachment(const Assembly& assembly, const ContactSide& side) : velocity_(assembly.nodes.velocity[side.node[0]]) {}

    Weights at(Vec2) const { return {}; }
    Vec2 velocity(Weights) const { return velocity_; }
    static void add(SlotForces& slot, Weights, Vec2 force) { slot[0] += force; }

private:
    Vec2 velocity_;
};

/// Calls work.template operator()<A, B>() with the attachments of a contact's two sides.
template <class Work>
decltype(auto) with_attachments(const Contact& contact, Work&& work) {
    if (contact.plate)
        return contact.flexible ? work.template operator()<TriangleAttachment, PlateAttachment>() : work.template operator()<RigidAttachment, PlateAttachment>();
    return contact.flexible ? work.template operator()<TriangleAttachment, TriangleAttachment>() : work.template operator()<RigidAttachment, RigidAttachment>();
}

}  // namespace feldspar
