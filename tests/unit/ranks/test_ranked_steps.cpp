// Steps that ranks make together have the bits of a program that is alone, for any number of ranks and threads.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/model/state_hash.hpp"
#include "feldspar/ranks/ranked_steps.hpp"
#include "feldspar/ranks/share.hpp"
#include "stirred.hpp"

namespace feldspar {
namespace {

class RankedSteps : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(States, RankedSteps, testing::ValuesIn(cases()), label);

TEST_P(RankedSteps, HaveTheBitsOfAProgramThatIsAlone) {
    const TestSetup setup = setup_of(GetParam());
    for (const Damping damping : {Damping::viscous, Damping::local}) {
        constexpr int kCalls = 2, kSteps = 5;  // some of these bodies fly apart later
        Stirred stirred(setup);
        stirred.settings.damping = damping;
        stirred.settings.viscous = 0.02;
        const double alone_J = stirred.go_on(kCalls, kSteps);
        const StateHash hash = hash_state(stirred.e.assembly);
        ASSERT_TRUE(std::isfinite(alone_J));
        EXPECT_GT(std::count_if(stirred.e.assembly.points.begin(), stirred.e.assembly.points.end(),
                                [](const ContactPoint& point) { return point.broken_step >= 0; }),
                  10);
        const auto company =
            damping == Damping::local ? std::vector{std::pair{2, 1}, std::pair{3, 2}} : std::vector{std::pair{4, 1}};
        for (const auto& [size, threads] : company) {
            std::mutex mutex;
            in_one_process(size, [&, size = size, threads = threads](Communicator& ranks) {
                Stirred own(setup, threads);
                own.settings.damping = damping;
                own.settings.viscous = 0.02;
                const auto device = open_ranks(ranks);
                own.settings.device = device.get();
                const double work_J = own.go_on(kCalls, kSteps);
                const std::string what = fmt::format("rank {} of {}", ranks.rank(), size);
                const std::lock_guard lock(mutex);
                EXPECT_EQ(work_J, alone_J) << what;
                EXPECT_EQ(difference(own.e.assembly.nodes.force, stirred.e.assembly.nodes.force), 0.0) << what;
                const StateHash here = hash_state(own.e.assembly);
                EXPECT_EQ(here.motion, hash.motion) << what;
                EXPECT_EQ(here.bonds, hash.bonds) << what;
                EXPECT_EQ(here.breaks, hash.breaks) << what;
                EXPECT_EQ(here.work, hash.work) << what;
            });
        }
    }
}

TEST(Share, GivesEveryBodyAndContactToOneRank) {
    for (const GrainKind kind : {GrainKind::flexible, GrainKind::rigid, GrainKind::inner_particles}) {
        Stirred stirred(setup_of({methods::brazilian, fixtures::model(kind), ContactLaw::bilinear}));
        Assembly& assembly = stirred.e.assembly;
        sort_out_packs(assembly);
        for (const int size : {1, 2, 4, 7}) {
            std::vector<int> nodes(assembly.nodes.displacement.size(), 0), bodies(assembly.bodies.size(), 0),
                packs(assembly.packs.contacts.size(), 0);
            std::vector<Share> shares;
            for (int rank = 0; rank < size; ++rank) shares.push_back(share_of_rank(assembly, rank, size));
            std::size_t loose = 0, most = 0, all = 0;
            for (const OwnPart& part : shares.front().parts) {
                for (const IndexRange range : part.nodes)
                    for (int n = range.begin; n < range.end; ++n) ++nodes[static_cast<std::size_t>(n)];
                for (const int b : part.bodies) ++bodies[static_cast<std::size_t>(b)];
                for (const int p : part.contact_packs) ++packs[static_cast<std::size_t>(p)];
                loose += part.loose_contacts.size();
                most = std::max(most, part.bodies.size());
                all += part.bodies.size();
            }
            const auto is_one = [](int n) { return n == 1; };
            EXPECT_TRUE(std::all_of(nodes.begin(), nodes.end(), is_one)) << size;
            EXPECT_TRUE(std::all_of(bodies.begin(), bodies.end(), is_one)) << size;
            EXPECT_TRUE(std::all_of(packs.begin(), packs.end(), is_one)) << size;
            EXPECT_EQ(loose, assembly.packs.loose_contacts.size());
            // about as much for each: packs of eight grains, and of those some hundred
            EXPECT_LT(static_cast<double>(most), 1.3 * static_cast<double>(all) / size + 8.0) << name(kind) << ", " << size;
            // what one tells, the other expects
            for (const Share& share : shares)
                for (const Border& border : share.borders) {
                    const int rank = static_cast<int>(&share - shares.data());
                    const std::vector<Border>& others = shares[static_cast<std::size_t>(border.other)].borders;
                    const auto back =
                        std::find_if(others.begin(), others.end(), [&](const Border& b) { return b.other == rank; });
                    ASSERT_NE(back, others.end());
                    EXPECT_EQ(back->lines_in, border.lines_out);
                    EXPECT_EQ(back->nodes_in, border.nodes_out);
                }
        }
    }
}

TEST(RanksRefuse, MoreOfThemThanPacks) {
    const TestSetup setup = setup_of({methods::uniaxial_compression, fixtures::model(GrainKind::flexible), ContactLaw::bilinear});
    const int units = units_to_share(Stirred(setup).e.assembly);
    const auto too_many = [&] {
        in_one_process(units + 1, [&](Communicator& ranks) {
            Stirred own(setup);
            const auto device = open_ranks(ranks);
            own.settings.device = device.get();
            own.go_on(1, 1);
        });
    };
    EXPECT_THROW(too_many(), InputError);
}

TEST(RanksRefuse, ToGoOnWhenTheyHaveNotComeToTheSame) {
    const TestSetup setup = setup_of({methods::uniaxial_compression, fixtures::model(GrainKind::rigid), ContactLaw::bilinear});
    for (const bool at_once : {true, false}) {  // another specimen; or another order later
        const auto differ = [&] {
            in_one_process(3, [&](Communicator& ranks) {
                Stirred own(setup);
                if (at_once && ranks.rank() == 1) own.e.assembly.nodes.displacement[5].x += 1e-15;
                const auto device = open_ranks(ranks);
                own.settings.device = device.get();
                own.go_on(1, 2);
                EXPECT_FALSE(at_once);
                if (ranks.rank() == 1) own.settings.speed *= 1.0 + 1e-15;
                own.go_on(1, 2);
            });
        };
        try {
            differ();
            ADD_FAILURE() << "nobody has noticed";
        } catch (const NumericalError& error) {
            EXPECT_NE(std::string(error.what()).find("rank 1 of 3"), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace feldspar
