// Where the points of a contact lie, which way they open and shear, and that their forces turn with the body.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "feldspar/base/rng.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/step/step.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

Vec2 turned(Vec2 x, double angle) { return {std::cos(angle) * x.x - std::sin(angle) * x.y, std::sin(angle) * x.x + std::cos(angle) * x.y}; }

Assembly small_body(ContactKind kind = ContactKind::lobatto3) {
    ModelSpec model;
    model.contact = kind;
    return assemble(*fixtures::make(fixtures::rectangle(0.02, 0.04)), model, fixtures::granite(), fixtures::table7());
}

TEST(ContactKinematics, ForcesOfLoadedContactsTurnWithTheBody) {
    Assembly body = small_body();
    RandomStream random(9, "turned forces");
    for (int n = 0; n < body.nodes.count(); ++n)
        body.nodes.displacement[n] = body.nodes.velocity[n] = {1e-9 * random.normal(), 1e-9 * random.normal()};
    const IndexRange all{0, static_cast<int>(body.contacts.size())};
    contact_forces(body, all, StepSettings{}, 0);
    const std::vector<SlotForces> before = body.slots;
    const std::vector<Vec2> strained = body.nodes.displacement;
    constexpr int kSteps = 100;
    for (int k = 1; k <= kSteps; ++k) {
        for (int n = 0; n < body.nodes.count(); ++n) {
            const Vec2 X = body.nodes.reference[n], after = turned(X + strained[n], 0.3 * k / kSteps) - X;
            body.nodes.velocity[n] = after - body.nodes.displacement[n];
            body.nodes.displacement[n] = after;
        }
        contact_forces(body, all, StepSettings{}, k);
    }
    for (std::size_t slot = 0; slot < before.size(); ++slot)
        for (int i = 0; i < 3; ++i) {
            const Vec2 expected = turned(before[slot][i], 0.3);
            // Gaps of 1e-9 m are known to 1e-17 m a step, so forces to about 1e-7.
            EXPECT_LT(norm(body.slots[slot][i] - expected), 1e-6 * (norm(before[slot][0]) + norm(before[slot][1]) + norm(before[slot][2])));
        }
}

TEST(ContactKinematics, PointsOpenAlongTheLineOfCentresAndShearAcrossIt) {   // (C1), (C5)
    Assembly body = small_body();
    constexpr double kBy = 1e-9;
    for (int c = 0; c < static_cast<int>(body.contacts.size()); ++c) {
        const Contact& contact = body.contacts[c];
        const Vec2 line = body.centre(contact.b.grain) - body.centre(contact.a.grain), n = (1.0 / norm(line)) * line;
        for (const bool shear : {false, true}) {
            const Grain& b = body.grains[contact.b.grain];
            std::fill(body.nodes.velocity.begin(), body.nodes.velocity.end(), Vec2{});
            for (int i = b.node_begin; i < b.node_end; ++i) body.nodes.velocity[i] = kBy * (shear ? rot90(n) : n);
            for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) body.points[p].bond = {};
            contact_forces(body, {c, c + 1}, StepSettings{}, 0);
            for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
                EXPECT_NEAR(body.points[p].bond.un_m, shear ? 0.0 : kBy, 1e-12 * kBy);   // shape functions sum to 1 to rounding
                EXPECT_NEAR(body.points[p].bond.us_m, shear ? kBy : 0.0, 1e-12 * kBy);
            }
        }
    }
}

TEST(ContactKinematics, LobattoPointsLieOnTheEdgeAndIntegrateCubicsOverIt) {   // (C2), (C3) and the areas
    const Assembly body = small_body();
    for (const Contact& contact : body.contacts) {
        ASSERT_EQ(contact.points, 3);
        const Vec2 p0 = body.nodes.reference[contact.a.node[0]], p1 = body.nodes.reference[contact.a.node[1]];
        const double length = norm(p1 - p0), area = length * body.thickness_m;
        const ContactFrame frame = contact_frame(body, contact);
        double moments[4] = {0.0, 0.0, 0.0, 0.0};
        for (int i = 0; i < 3; ++i) {
            const ContactPoint& point = body.points[contact.first_point + i];
            const Vec2 x = frame.reference_point + point.along_m * frame.edge_tangent;
            EXPECT_LT(norm(x - (p0 + (0.5 * i) * (p1 - p0))), 1e-14);   // rounding of 0.04 m
            const double from_end = norm(x - p0) / length;
            for (int power = 0; power < 4; ++power) moments[power] += point.area_m2 * std::pow(from_end, power);
        }
        for (int power = 0; power < 4; ++power) EXPECT_NEAR(moments[power] / area, 1.0 / (power + 1), 1e-9);
    }
}

TEST(ContactKinematics, OnePointLiesAsDeepInOneCircleAsInTheOther) {   // s - RA = (d - s) - RB, for PCM and for new contacts
    Assembly body = small_body(ContactKind::point);
    const int bonded = static_cast<int>(body.contacts.size());
    for (int c = 0; c < bonded; ++c) add_new_contact(body, body.contacts[c].a.grain, body.contacts[c].b.grain, 0.0, 0.0);
    for (const Contact& contact : body.contacts) {
        ASSERT_EQ(contact.points, 1);
        const ContactFrame frame = contact_frame(body, contact);
        const Vec2 x = frame.reference_point + body.points[contact.first_point].along_m * frame.edge_tangent;
        const double in_a = body.grains[contact.a.grain].radius_m - norm(x - body.centre(contact.a.grain));
        const double in_b = body.grains[contact.b.grain].radius_m - norm(x - body.centre(contact.b.grain));
        EXPECT_NEAR(in_a, in_b, 1e-14);
    }
}

}  // namespace
}  // namespace feldspar
