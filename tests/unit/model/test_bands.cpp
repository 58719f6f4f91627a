// Bands: every pack stands in one of them, and contacts of a band join only bodies of that band and of the one before.
#include <gtest/gtest.h>

#include <vector>

#include "feldspar/model/bands.hpp"
#include "fixtures.hpp"

using namespace feldspar;

namespace {

const RunControl kOneThread = fixtures::threads(1);

}  // namespace

TEST(Bands, ShareOutAllPacksAndBodiesOnce) {
    for (const GrainKind grains : {GrainKind::flexible, GrainKind::rigid}) {
        TestSetup s = fixtures::setup(fixtures::rectangle(0.04, 0.08), methods::uniaxial_compression, fixtures::model(grains));
        const Experiment e(s, kOneThread);
        const std::vector<PackRanges>& bands = e.assembly.packs.bands.ranges;
        ASSERT_FALSE(bands.empty());
        std::size_t contacts = 0, bodies = 0;
        for (std::size_t b = 0; b < bands.size(); ++b) {
            if (b > 0) {
                EXPECT_EQ(bands[b].contacts.begin, bands[b - 1].contacts.end);
                EXPECT_EQ(bands[b].grains.begin, bands[b - 1].grains.end);
                EXPECT_EQ(bands[b].rigid.begin, bands[b - 1].rigid.end);
            }
            contacts += bands[b].contacts.end - bands[b].contacts.begin;
            bodies += (bands[b].grains.end - bands[b].grains.begin) + (bands[b].rigid.end - bands[b].rigid.begin);
        }
        EXPECT_EQ(contacts, e.assembly.packs.contacts.size());
        EXPECT_EQ(bodies, grains == GrainKind::flexible ? e.assembly.packs.grains.size()
                                                        : bands.back().rigid.end - bands.front().rigid.begin);
    }
}
