// Forces of a step: they cancel over the body, vanish for rigid motions, and do not depend on how steps are cut into blocks.
#include <gtest/gtest.h>

#include <cmath>

#include "feldspar/model/state_hash.hpp"
#include "fixtures.hpp"

using namespace feldspar;

namespace {

const RunControl kOneThread = fixtures::threads(1);

struct Sums {
    Vec2 force;
    double absolute_N = 0.0;
};

// Of the forces of all contacts on the bodies' nodes, at the present state.
Sums sums(const Assembly& assembly) {
    Sums s;
    for (int n = 0; n < assembly.nodes.count(); ++n) {
        s.force += assembly.nodes.force[n];
        s.absolute_N += std::abs(assembly.nodes.force[n].x) + std::abs(assembly.nodes.force[n].y);
    }
    return s;
}

}  // namespace

// What a contact does to one side it does to the other with the other sign, and stresses of a grain are no force on it.
TEST(Forces, OfFlexibleGrainsCancelOverTheBody) {
    const TestSetup s = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.03)), methods::uniaxial_compression);
    Experiment e(s, kOneThread);
    for (int n = 0; n < e.assembly.nodes.count(); ++n) {  // strains of about 1e-5, uneven
        const Vec2 x = e.assembly.nodes.reference[n];
        e.assembly.nodes.displacement[n] =
            1e-5 * Vec2{0.003 * std::sin(700.0 * x.y) + 0.3 * x.x, 0.002 * std::cos(900.0 * x.x) - x.y};
    }
    evaluate_forces(e.assembly, e.team, Strength::unlimited);
    const Sums s1 = sums(e.assembly);
    ASSERT_GT(s1.absolute_N, 0.0);
    EXPECT_LT(std::abs(s1.force.x) + std::abs(s1.force.y), 1e-9 * s1.absolute_N);  // rounding of some thousand sums
}

TEST(Forces, VanishInATranslation) {
    for (const GrainKind grains : {GrainKind::flexible, GrainKind::rigid}) {
        const TestSetup s =
            fixtures::setup(fixtures::rectangle(0.02, 0.03), methods::uniaxial_compression, fixtures::model(grains));
        Experiment e(s, kOneThread);
        for (const Body& body : e.assembly.bodies) {
            if (body.kind == BodyKind::rigid)
                e.assembly.nodes.displacement[body.centre_node] = {1e-5, -2e-5};
            else
                for (const int n : body.nodes()) e.assembly.nodes.displacement[n] = {1e-5, -2e-5};
        }
        evaluate_forces(e.assembly, e.team, Strength::real);
        // against the force of one contact of a square millimetre at such an opening
        EXPECT_LT(sums(e.assembly).absolute_N,
                  1e-6 * s.contact.Kn_Pa_m * 2e-5 * 1e-6 * static_cast<double>(e.assembly.contacts.size()));
    }
}

TEST(Steps, InOneBlockOrOneByOneLeaveTheSameBits) {
    for (const GrainKind grains : {GrainKind::flexible, GrainKind::rigid}) {
        TestSetup s = fixtures::setup(fixtures::rectangle(0.02, 0.03), methods::uniaxial_compression, fixtures::model(grains));
        s.numerics.kind = NumericsKind::paper;
        Experiment block(s, kOneThread), single(s, kOneThread);
        for (Experiment* e : {&block, &single}) {
            choose_step(*e);
            prepare(*e);
        }
        block.run(20);
        for (int i = 0; i < 20; ++i) single.run(1);
        const StateHash a = hash_state(block.assembly), b = hash_state(single.assembly);
        EXPECT_EQ(a.motion, b.motion);
        EXPECT_EQ(a.bonds, b.bonds);
        EXPECT_EQ(a.work, b.work);
        EXPECT_EQ(block.platen_work.loading, single.platen_work.loading);
    }
}

// Two plates' nodes with forces: what is imposed does not follow them, and that is the reaction.
TEST(Reactions, AreWhatIsImposedFeels) {
    Assembly assembly;
    for (int n = 0; n < 3; ++n) assembly.nodes.add({}, {1.0, 1.0});
    assembly.nodes.force = {{1.0, 10.0}, {2.0, 20.0}, {5.0, 70.0}};
    Fixture rest, loading;
    rest.nodes = {0, 1};
    rest.imposed = {1.0, 1.0};
    loading.nodes = {2};
    loading.imposed = {0.0, 1.0};
    loading.motion = {0.0, -1.0};
    assembly.fixtures = {rest, loading};
    EXPECT_EQ(reaction(assembly, rest).x, 3.0);
    EXPECT_EQ(reaction(assembly, rest).y, 30.0);
    EXPECT_EQ(reaction(assembly, loading).x, 0.0) << "free to slide";
    EXPECT_EQ(reaction(assembly, loading).y, 70.0);
    EXPECT_EQ(loading_reaction(assembly), 70.0) << "pushed down against what pushes up";
    const Reactions both = reactions(assembly);
    EXPECT_EQ(both.loading, 70.0);
    EXPECT_EQ(both.rest, -30.0);
    assembly.weight = {{0.0, 0.0}, {0.0, -4.0}, {0.0, -6.0}};
    EXPECT_EQ(reactions(assembly).rest, -40.0) << "who holds the specimen holds its weight";
}
