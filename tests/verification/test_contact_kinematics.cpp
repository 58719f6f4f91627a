// Where the points of a contact lie, which way they open and shear, and that their forces turn with the body.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "feldspar/base/rng.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/fixtures.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/step/step.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

Assembly small_body(ContactKind kind = ContactKind::lobatto3) {
    ModelSpec model;
    model.contact = kind;
    return assemble(*fixtures::make(fixtures::rectangle(0.02, 0.04)), model, fixtures::granite(), fixtures::table7());
}

TEST(ContactKinematics, ForcesOfLoadedContactsTurnWithTheBody) {
    Assembly assembly = small_body();
    RandomStream random(9, "turned forces");
    for (int n = 0; n < assembly.nodes.count(); ++n)
        assembly.nodes.displacement[n] = assembly.nodes.velocity[n] = {1e-9 * random.normal(), 1e-9 * random.normal()};
    const IndexRange all{0, static_cast<int>(assembly.contacts.size())};
    contact_forces(assembly, all, StepSettings{}, 0);
    const std::vector<SlotForces> before = assembly.slots;
    const Array<Vec2> strained = assembly.nodes.displacement;
    constexpr int kSteps = 100;
    for (int k = 1; k <= kSteps; ++k) {
        for (int n = 0; n < assembly.nodes.count(); ++n) {
            const Vec2 X = assembly.nodes.reference[n], after = turned(X + strained[n], 0.3 * k / kSteps) - X;
            assembly.nodes.velocity[n] = after - assembly.nodes.displacement[n];
            assembly.nodes.displacement[n] = after;
        }
        contact_forces(assembly, all, StepSettings{}, k);
    }
    for (std::size_t slot = 0; slot < 2 * assembly.contacts.size(); ++slot) {
        const Mat2 M = before[slot].moment, now = assembly.slots[slot].moment;
        // Gaps of 1e-9 m are known to 1e-17 m a step, so forces to about 1e-7.
        EXPECT_LT(norm(assembly.slots[slot].force - turned(before[slot].force, 0.3)), 1e-6 * norm(before[slot].force));
        // R M R^T, tried on two directions.
        const double size = std::abs(M.xx) + std::abs(M.xy) + std::abs(M.yx) + std::abs(M.yy);
        for (const Vec2 direction : {Vec2{1.0, 0.0}, Vec2{0.0, 1.0}})
            EXPECT_LT(norm(now * turned(direction, 0.3) - turned(M * direction, 0.3)), 1e-6 * size);
    }
}

TEST(ContactKinematics, PointsOpenAlongTheLineOfCentresAndShearAcrossIt) {  // (C1), (C5)
    Assembly assembly = small_body();
    constexpr double kBy = 1e-9;
    for (int c = 0; c < static_cast<int>(assembly.contacts.size()); ++c) {
        const Contact& contact = assembly.contacts[c];
        const Vec2 line = assembly.centre(contact.b.body) - assembly.centre(contact.a.body), n = (1.0 / norm(line)) * line;
        for (const bool shear : {false, true}) {
            const Body& b = assembly.bodies[contact.b.body];
            std::fill(assembly.nodes.velocity.begin(), assembly.nodes.velocity.end(), Vec2{});
            for (const int i : b.nodes()) assembly.nodes.velocity[i] = kBy * (shear ? rot90(n) : n);
            for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) assembly.set_bond(p, {});
            contact_forces(assembly, {c, c + 1}, StepSettings{}, 0);
            for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
                EXPECT_NEAR(assembly.bond(p).un_m, shear ? 0.0 : kBy, 1e-12 * kBy);  // shape functions sum to 1 to rounding
                EXPECT_NEAR(assembly.bond(p).us_m, shear ? kBy : 0.0, 1e-12 * kBy);
            }
        }
    }
}

TEST(ContactKinematics, LobattoPointsLieOnTheEdgeAndIntegrateCubicsOverIt) {  // (C2), (C3) and the areas
    const Assembly assembly = small_body();
    for (const Contact& contact : assembly.contacts) {
        ASSERT_EQ(contact.points, 3);
        const Vec2 p0 = assembly.nodes.reference[contact.a.node[0]], p1 = assembly.nodes.reference[contact.a.node[1]];
        const double length = norm(p1 - p0), area = length * assembly.thickness_m;
        const ContactFrame frame = contact_frame(assembly, contact);
        double moments[4] = {0.0, 0.0, 0.0, 0.0};
        for (int i = 0; i < 3; ++i) {
            const ContactPoint& point = assembly.points[contact.first_point + i];
            const Vec2 x = frame.reference_point + point.along_m * frame.edge_tangent;
            EXPECT_LT(norm(x - (p0 + (0.5 * i) * (p1 - p0))), 1e-14);  // rounding of 0.04 m
            const double from_end = norm(x - p0) / length;
            for (int power = 0; power < 4; ++power) moments[power] += point.area_m2 * std::pow(from_end, power);
        }
        for (int power = 0; power < 4; ++power) EXPECT_NEAR(moments[power] / area, 1.0 / (power + 1), 1e-9);
    }
}

TEST(ContactKinematics, OnePointLiesAsDeepInOneCircleAsInTheOther) {  // s - RA = (d - s) - RB, for PCM and for new contacts
    Assembly assembly = small_body(ContactKind::point);
    const int bonded = static_cast<int>(assembly.contacts.size());
    for (int c = 0; c < bonded; ++c)
        add_new_contact(assembly, assembly.contacts[c].a.body, assembly.contacts[c].b.body, 0.0, 0.0);
    for (const Contact& contact : assembly.contacts) {
        ASSERT_EQ(contact.points, 1);
        const ContactFrame frame = contact_frame(assembly, contact);
        const Vec2 x = frame.reference_point + assembly.points[contact.first_point].along_m * frame.edge_tangent;
        const double in_a = assembly.bodies[contact.a.body].radius_m - norm(x - assembly.centre(contact.a.body));
        const double in_b = assembly.bodies[contact.b.body].radius_m - norm(x - assembly.centre(contact.b.body));
        EXPECT_NEAR(in_a, in_b, 1e-14);
    }
}

}  // namespace
}  // namespace feldspar
