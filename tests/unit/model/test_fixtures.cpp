// Which part of a boundary a fixture takes, and what it is told where there is none.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "feldspar/base/error.hpp"
#include "feldspar/model/assemble.hpp"
#include "fixtures.hpp"

using namespace feldspar;

namespace {

constexpr double kWidth = 0.02, kHeight = 0.03, kNear = 1e-9;

const Specimen& block() {
    static const auto specimen = fixtures::make(fixtures::rectangle(kWidth, kHeight));
    return *specimen;
}

FixtureSpec row(const std::string& label) {
    FixtureSpec fixture;
    fixture.name = fixture.part.label = label;
    fixture.imposes_x = fixture.imposes_y = true;
    return fixture;
}

Assembly attached(const std::vector<FixtureSpec>& fixtures, GrainKind grains = GrainKind::flexible) {
    Assembly assembly = assemble(block(), fixtures::model(grains), fixtures::granite(), fixtures::table7());
    attach(assembly, block(), fixtures);
    return assembly;
}

}  // namespace

TEST(Fixtures, ARowOfNodesIsThatOfItsLabel) {
    const Assembly assembly = attached({row("top")});
    ASSERT_EQ(assembly.fixtures.size(), 1u);
    const std::set<std::int32_t> held(assembly.fixtures[0].nodes.begin(), assembly.fixtures[0].nodes.end());
    EXPECT_EQ(held.size(), assembly.fixtures[0].nodes.size()) << "no node twice";
    const auto at_top = [&](int n) { return std::abs(assembly.nodes.reference[n].y - kHeight) < kNear; };
    for (const std::int32_t n : held) EXPECT_TRUE(at_top(n)) << n;
    for (const GrainEdge& edge : assembly.edges)  // a grain that touches the top with a corner has a node there and no edge
        if (at_top(edge.node[0]) && at_top(edge.node[1])) {
            EXPECT_TRUE(held.contains(edge.node[0]) && held.contains(edge.node[1]));
        }
}

TEST(Fixtures, AConditionOfPlaceNarrowsThePart) {
    FixtureSpec left = row("top");
    left.part.at = Vec2{0.0, kHeight};
    left.part.reach_m = 0.25 * kWidth;
    const Assembly part = attached({left}), whole = attached({row("top")});
    EXPECT_LT(part.fixtures[0].nodes.size(), whole.fixtures[0].nodes.size());
    // edges that come within reach count as a whole: they end at most a grain beyond
    for (const int n : part.fixtures[0].nodes) EXPECT_LT(part.nodes.reference[n].x, 0.25 * kWidth + 0.005);
}

TEST(Fixtures, WhatRemainsIsWhatNoneBeforeHasTaken) {
    FixtureSpec rest = row("");
    rest.part.remaining = true;
    const Assembly assembly = attached({row("top"), row("bottom"), rest});
    const std::vector<std::int32_t>& sides = assembly.fixtures[2].nodes;
    EXPECT_FALSE(sides.empty());
    for (const int n : sides)
        EXPECT_TRUE(std::abs(assembly.nodes.reference[n].x) < kNear || std::abs(assembly.nodes.reference[n].x - kWidth) < kNear)
            << n;
}

TEST(Fixtures, APlateStartsAtFirstTouchAndPressesAlongItsNormal) {
    for (const GrainKind grains : {GrainKind::flexible, GrainKind::rigid}) {
        const Assembly assembly = attached(fixtures::end_plates({1e13, 0.3, 0.0, false}), grains);
        int at_plates = 0;
        for (const Contact& contact : assembly.contacts) {
            if (!contact.plate) continue;
            ++at_plates;
            const ContactFrame frame = contact_frame(assembly, contact);
            EXPECT_EQ(std::abs(frame.n.y), 1.0);
            EXPECT_GE(assembly.bond(contact.first_point).un_m, -1e-12) << "nothing overlaps at the start";
        }
        EXPECT_GT(at_plates, 4);
    }
}

TEST(Fixtures, AreToldWhereTheyTakeNothing) {
    EXPECT_THROW(attached({row("roof")}), InputError);
    FixtureSpec far = row("top");
    far.part.at = Vec2{1.0, 1.0};
    far.part.reach_m = 0.001;
    EXPECT_THROW(attached({far}), InputError);
}
