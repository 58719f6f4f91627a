// The fingerprint of a state tells which part of it differs, to the last bit.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "feldspar/model/state_hash.hpp"
#include "fixtures.hpp"

using namespace feldspar;

namespace {

const RunControl kOneThread = fixtures::threads(1);

}  // namespace

TEST(StateHash, TellsWhichPartOfAStateDiffers) {
    const TestSetup s = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.03)), methods::uniaxial_compression);
    const Experiment e(s, kOneThread);
    const StateHash before = hash_state(e.assembly);

    Assembly moved = e.assembly;
    const int node = moved.bodies.front().node(0);
    moved.nodes.displacement[node].x = std::nextafter(moved.nodes.displacement[node].x, 1.0);
    EXPECT_NE(hash_state(moved).motion, before.motion);
    EXPECT_EQ(hash_state(moved).bonds, before.bonds);

    Assembly damaged = e.assembly;
    BondState bond = damaged.bond(0);
    bond.damage = std::numeric_limits<double>::denorm_min();
    damaged.set_bond(0, bond);
    EXPECT_NE(hash_state(damaged).bonds, before.bonds);
    EXPECT_EQ(hash_state(damaged).motion, before.motion);

    Assembly broken = e.assembly;
    broken.points[0].broken_step = 7;
    EXPECT_NE(hash_state(broken).breaks, before.breaks);
    EXPECT_EQ(hash_state(broken).work, before.work);

    Assembly worked = e.assembly;
    worked.body_work.front().damping += 1.0;
    EXPECT_NE(hash_state(worked).work, before.work);

    EXPECT_EQ(hash_state(e.assembly).motion, before.motion) << "a look changes nothing";
}
