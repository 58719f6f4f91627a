// Bodies that are rigid, grains or inner particles: how they turn, what their contacts conserve, where they bend, how they are
// drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "feldspar/base/rng.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/lab/grain_fields.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/step/step.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

IndexRange all_contacts(const Assembly& assembly) { return {0, static_cast<int>(assembly.contacts.size())}; }

class RigidModels : public testing::TestWithParam<ModelSpec> {
protected:
    std::shared_ptr<const Specimen> specimen() const {
        const bool inner = GetParam().kind == GrainKind::inner_particles;  // ten times as many bodies: a smaller specimen
        return fixtures::make(
            fixtures::filled_for(GetParam(), inner ? fixtures::rectangle(0.014, 0.028) : fixtures::rectangle(0.02, 0.04)));
    }
    Assembly bodies(const Specimen& s) const {
        return assemble(s, GetParam(), fixtures::granite(), fixtures::material(GetParam()));
    }
};
INSTANTIATE_TEST_SUITE_P(Models, RigidModels, testing::ValuesIn(fixtures::rigid_models()),
                         [](const auto& tested) { return fixtures::label(tested.param); });

TEST_P(RigidModels, RigidRotationOpensContactsOnlyByTheStepsOwnError) {
    const Vec2 gaps = fixtures::gaps_of_a_rotation(bodies(*specimen()), 1000);
    EXPECT_LT(gaps.x, 5e-7);
    EXPECT_LT(gaps.y, 5e-7);
    EXPECT_GT(gaps.x, 0.0);
}

TEST_P(RigidModels, ContactForcesConserveLinearAndAngularMomentum) {
    Assembly assembly = bodies(*specimen());
    RandomStream random(7, "momentum of rigid bodies");
    for (const Body& body : assembly.bodies) {
        const Vec2 X = assembly.nodes.reference[body.centre_node];
        assembly.nodes.displacement[body.centre_node] = turned(X, 0.1) - X + Vec2{1e-7 * random.normal(), 1e-7 * random.normal()};
        assembly.nodes.displacement[body.centre_node + 1].x = (0.1 + 1e-4 * random.normal()) * body.radius_m;
        assembly.nodes.velocity[body.centre_node] = {1e-9 * random.normal(), 1e-9 * random.normal()};
        assembly.nodes.velocity[body.centre_node + 1].x = 1e-9 * random.normal();
    }
    contact_forces(assembly, all_contacts(assembly), StepSettings{}, 0);
    double sheared = 0.0;
    for (std::size_t c = 0; c < assembly.contacts.size(); ++c) {
        const Contact& contact = assembly.contacts[c];
        const SlotForces &a = assembly.slots[2 * c], &b = assembly.slots[2 * c + 1];
        const double size = norm(a.force);
        ASSERT_GT(size, 0.0);
        EXPECT_LT(norm(a.force + b.force), 1e-12 * size);  // rounding of the sums over three points
        double moment = 0.0;
        for (const auto& [side, slot] : {std::pair{contact.a, a}, std::pair{contact.b, b}}) {
            moment += cross(assembly.centre(side.body), slot.force) + turning_moment(slot);
        }
        // Lever arms of up to the body's height; three points may pull against each other and leave a small sum.
        EXPECT_LT(std::abs(moment), 1e-10 * (size * 0.04 + std::abs(turning_moment(a)) + std::abs(turning_moment(b))));
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p)
            sheared = std::max(sheared, std::abs(assembly.bond(p).Fs_N));
    }
    EXPECT_GT(sheared, 0.0);
}

TEST_P(RigidModels, ForcesOfLoadedContactsTurnWithTheBodies) {
    // Loaded by small random motions, then turned: what the turning itself adds is of first order in the step (see above), so the
    // change against the turned forces of twice as many steps is half as large.
    const auto turned_error = [&](int steps) {
        Assembly assembly = bodies(*specimen());
        RandomStream random(9, "turned forces");
        Array<Vec2> loaded(assembly.nodes.reference.size());
        for (const Body& body : assembly.bodies) {
            loaded[body.centre_node] = {1e-7 * random.normal(), 1e-7 * random.normal()};
            loaded[body.centre_node + 1] = {1e-7 * random.normal(), 0.0};
        }
        assembly.nodes.displacement = assembly.nodes.velocity = loaded;
        StepSettings elastic;
        elastic.strength = Strength::unlimited;
        contact_forces(assembly, all_contacts(assembly), elastic, 0);
        const std::vector<SlotForces> before = assembly.slots;
        for (int k = 1; k <= steps; ++k) {
            const double angle = 0.3 * k / steps;
            for (const Body& body : assembly.bodies) {
                const int centre = body.centre_node, turn = centre + 1;
                const Vec2 X = assembly.nodes.reference[centre];
                const Vec2 after = turned(X + loaded[centre], angle) - X;
                const Vec2 arc = loaded[turn] + Vec2{angle * body.radius_m, 0.0};
                assembly.nodes.velocity[centre] = after - assembly.nodes.displacement[centre];
                assembly.nodes.velocity[turn] = arc - assembly.nodes.displacement[turn];
                assembly.nodes.displacement[centre] = after;
                assembly.nodes.displacement[turn] = arc;
            }
            contact_forces(assembly, all_contacts(assembly), elastic, k);
        }
        double error = 0.0, size = 0.0;
        for (std::size_t slot = 0; slot < 2 * assembly.contacts.size(); ++slot) {
            error = std::max(error, norm(assembly.slots[slot].force - turned(before[slot].force, 0.3)));
            size = std::max(size, norm(before[slot].force));
        }
        return error / size;
    };
    const double coarse = turned_error(1000), fine = turned_error(2000);
    EXPECT_LT(coarse, 1.0);
    EXPECT_NEAR(coarse / fine, 2.0, 0.2);
}

TEST_P(RigidModels, DrawnGrainsFollowARigidMotionExactly) {
    const auto s = specimen();
    Assembly assembly = bodies(*s);
    fixtures::turn_to(assembly, 0.3);
    const std::vector<Vec2> drawn = mesh_displacements(assembly, *s, assembly.nodes.displacement);
    ASSERT_EQ(drawn.size(), s->mesh.nodes.size());
    for (std::size_t n = 0; n < drawn.size(); ++n) {
        const Vec2 X = s->mesh.nodes[n];
        EXPECT_LT(norm(drawn[n] - (turned(X, 0.3) - X)), 1e-14);  // rounding of the least squares over 0.04 m
    }
}

TEST_P(RigidModels, AGrainsBodiesHaveItsVolumeAndItsMass) {
    const auto s = specimen();
    Assembly assembly = bodies(*s);
    set_real_masses(assembly);
    std::vector<double> volume(s->cells.cells.size(), 0.0), mass = volume;
    for (const Body& body : assembly.bodies) {
        volume[body.grain] += body.volume_m3;
        mass[body.grain] += assembly.nodes.mass[body.centre_node];
        EXPECT_GT(body.gyration_m2, 0.0);
    }
    for (std::size_t g = 0; g < volume.size(); ++g) {
        std::vector<Vec2> corners;
        for (const int v : s->cells.cells[g].vertices) corners.push_back(s->cells.vertices[v]);
        const double expected = signed_area(corners) * assembly.thickness_m;
        EXPECT_NEAR(volume[g] / expected, 1.0, 1e-12);
        EXPECT_NEAR(mass[g] / (2650.0 * expected), 1.0, 1e-12);
    }
}

TEST(InnerParticles, DrawnGrainsFollowAHomogeneousStrainExactly) {
    const ModelSpec model = fixtures::model(GrainKind::inner_particles);
    const auto s = fixtures::make(fixtures::filled_for(model, fixtures::rectangle(0.02, 0.04)));
    Assembly assembly = assemble(*s, model, fixtures::granite(), fixtures::material(model));
    const auto field = [](Vec2 X) { return Vec2{1e-3 + 2e-3 * X.x - 1e-3 * X.y, -3e-3 * X.x + 0.5e-3 * X.y}; };
    for (const Body& body : assembly.bodies)
        assembly.nodes.displacement[body.centre_node] = field(assembly.nodes.reference[body.centre_node]);
    const std::vector<Vec2> drawn = mesh_displacements(assembly, *s, assembly.nodes.displacement);
    for (std::size_t n = 0; n < drawn.size(); ++n)
        EXPECT_LT(norm(drawn[n] - field(s->mesh.nodes[n])), 1e-16);  // of displacements of 1e-3
}

TEST(InnerParticles, PullingAGrainApartNeverBreaksIt) {
    const ModelSpec model = fixtures::model(GrainKind::inner_particles);
    const auto s = fixtures::two_grain_bar(0.003, 0.003, 26.0);
    Assembly assembly = assemble(*s, model, fixtures::granite(), fixtures::material(model));
    ContactFinder finder(assembly, 1e-4);
    for (int k = 1; k <= 10; ++k) {  // to twice its size
        for (const Body& body : assembly.bodies) {
            const Vec2 X = assembly.nodes.reference[body.centre_node], after = (0.1 * k) * X;
            assembly.nodes.velocity[body.centre_node] = after - assembly.nodes.displacement[body.centre_node];
            assembly.nodes.displacement[body.centre_node] = after;
        }
        contact_forces(assembly, all_contacts(assembly), StepSettings{}, k);
    }
    finder.update(assembly, 1.0);
    int inside = 0, across = 0;
    for (const Contact& contact : assembly.contacts) {
        const BondState bond = assembly.bond(contact.first_point);
        if (contact.material == inside_grains) {
            ++inside;
            EXPECT_FALSE(contact.dropped);
            EXPECT_EQ(bond.damage, 0.0);
            EXPECT_NEAR(bond.Fn_N / (-4.9e13 * assembly.points[contact.first_point].area_m2 * bond.un_m), 1.0, 1e-12);
            EXPECT_GT(bond.un_m, 0.0);
        } else {
            ++across;
            EXPECT_TRUE(contact.dropped);  // the others break and go
        }
    }
    EXPECT_EQ(inside, static_cast<int>(s->filling.inside.size()));
    EXPECT_EQ(across, static_cast<int>(s->filling.across.size()));
    EXPECT_GT(across, 0);
}

TEST(InnerParticles, ContactsAcrossAnEdgeShareItsAreaAndThoseInsideHaveTheSmallerDiameter) {
    for (const ContactNormal normal : {ContactNormal::centres, ContactNormal::edge}) {
        const ModelSpec model = fixtures::model(GrainKind::inner_particles, ContactKind::point, normal);
        const auto s = fixtures::make(fixtures::filled_for(model, fixtures::rectangle(0.02, 0.04)));
        const Assembly assembly = assemble(*s, model, fixtures::granite(), fixtures::material(model));
        double across = 0.0, edges = 0.0;
        for (std::size_t c = 0; c < assembly.contacts.size(); ++c) {
            const Contact& contact = assembly.contacts[c];
            const Body &a = assembly.bodies[contact.a.body], &b = assembly.bodies[contact.b.body];
            const double area = assembly.points[contact.first_point].area_m2;
            if (contact.material == inside_grains) {
                EXPECT_EQ(a.grain, b.grain);
                EXPECT_DOUBLE_EQ(area, 2.0 * std::min(a.radius_m, b.radius_m) * assembly.thickness_m);
                continue;
            }
            EXPECT_NE(a.grain, b.grain);
            across += area;
            const ContactFrame frame = contact_frame(assembly, contact);
            const Vec2 edge = assembly.origins[c].to - assembly.origins[c].from;
            if (normal == ContactNormal::edge) {
                EXPECT_NEAR(dot(frame.n, edge) / norm(edge), 0.0, 1e-12);
                EXPECT_GT(dot(frame.n, assembly.centre(contact.b.body) - assembly.centre(contact.a.body)), 0.0);  // out of A
            } else {
                EXPECT_NEAR(std::abs(cross(frame.n, assembly.centre(contact.b.body) - assembly.centre(contact.a.body))), 0.0,
                            1e-16);
            }
            EXPECT_NEAR(cross(frame.reference_point - assembly.origins[c].from, edge) / norm(edge), 0.0,
                        1e-14);  // on the edge's line
        }
        for (const Cell& cell : s->cells.cells)
            for (std::size_t k = 0; k < cell.vertices.size(); ++k)
                if (cell.neighbours[k] >= 0)
                    edges += 0.5 * norm(s->cells.vertices[cell.vertices[(k + 1) % cell.vertices.size()]] -
                                        s->cells.vertices[cell.vertices[k]]);
        EXPECT_NEAR(across / (edges * assembly.thickness_m), 1.0, 1e-12);
    }
}

}  // namespace
}  // namespace feldspar
