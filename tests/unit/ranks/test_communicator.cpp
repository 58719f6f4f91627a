// How ranks speak with each other, as threads of one program.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/ranks/communicator.hpp"

namespace feldspar {
namespace {

std::string text(std::span<const char> bytes) { return {bytes.begin(), bytes.end()}; }

TEST(Communicator, TellsAllWhatEachGives) {
    for (const int size : {1, 2, 3, 5}) {
        std::atomic<int> ended{0};
        in_one_process(size, [&](Communicator& ranks) {
            EXPECT_EQ(ranks.size(), size);
            EXPECT_EQ(ranks.on_this_machine(), size);
            EXPECT_EQ(ranks.first(), ranks.rank() == 0);
            for (int round = 0; round < 3; ++round) {
                const std::string own = std::string(static_cast<std::size_t>(100 * ranks.rank() + round), 'a') + "!";
                Gathered all;
                ranks.gather(own, all);
                ASSERT_EQ(all.of_rank.size(), static_cast<std::size_t>(size));
                for (std::size_t r = 0; r < all.of_rank.size(); ++r)
                    EXPECT_EQ(text(all.of_rank[r]), std::string(100 * r + static_cast<std::size_t>(round), 'a') + "!");
                const std::vector<char> told = ranks.from_first({'x', static_cast<char>('0' + ranks.rank())});
                EXPECT_EQ(text(told), "x0");
                EXPECT_EQ(as_the_first(ranks, ranks.first()), true);
                EXPECT_EQ(as_the_first(ranks, !ranks.first()), false);
            }
            ++ended;
        });
        EXPECT_EQ(ended, size);
    }
}

TEST(Communicator, ExchangesWithEachOther) {
    in_one_process(4, [](Communicator& ranks) {
        for (int round = 0; round < 5; ++round) {
            std::vector<std::string> out, in;
            std::vector<Transfer> transfers;
            for (int other = 0; other < ranks.size(); ++other) {
                if (other == ranks.rank()) continue;
                // of different lengths both ways
                out.push_back(std::to_string(ranks.rank()) + ">" + std::to_string(other) +
                              std::string(static_cast<std::size_t>(ranks.rank()), '.'));
                in.emplace_back(3 + static_cast<std::size_t>(other), ' ');
            }
            for (std::size_t i = 0; i < out.size(); ++i) {
                const int other = static_cast<int>(i) + (static_cast<int>(i) >= ranks.rank());
                transfers.push_back({other, out[i], in[i]});
            }
            ranks.exchange(transfers);
            for (const Transfer& transfer : transfers)
                EXPECT_EQ(text(transfer.in), std::to_string(transfer.other) + ">" + std::to_string(ranks.rank()) +
                                                 std::string(static_cast<std::size_t>(transfer.other), '.'));
        }
    });
}

TEST(Communicator, EndsAllWhenOneGivesUp) {
    std::atomic<int> lost{0};
    const auto one_fails = [&] {
        in_one_process(3, [&](Communicator& ranks) {
            if (ranks.rank() == 1) throw NumericalError("no more");
            try {
                Gathered all;
                ranks.gather({}, all);
            } catch (const RankLost&) {
                ++lost;
                throw;
            }
        });
    };
    EXPECT_THROW(one_fails(), NumericalError);  // not what follows from it
    EXPECT_EQ(lost, 2);
}

TEST(Communicator, AloneSpeaksToItself) {
    const auto ranks = alone();
    EXPECT_TRUE(ranks->alone());
    EXPECT_TRUE(ranks->first());
    Gathered all;
    ranks->gather(std::string("own"), all);
    ASSERT_EQ(all.of_rank.size(), 1U);
    EXPECT_EQ(text(all.of_rank[0]), "own");
    EXPECT_TRUE(as_the_first(*ranks, true));
    EXPECT_FALSE(as_the_first(*ranks, false));
}

TEST(Communicator, KnowsByTheEnvironmentHowManyWereStarted) {
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE"}) unsetenv(name);
    EXPECT_EQ(started_ranks(), 1);
    EXPECT_TRUE(communicator_here()->alone());
    setenv("OMPI_COMM_WORLD_SIZE", "4", 1);
    EXPECT_EQ(started_ranks(), 4);
    if (!built_with_mpi()) {
        try {
            (void)communicator_here();
            ADD_FAILURE() << "four programs that know nothing of each other";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("FELDSPAR_MPI"), std::string::npos) << error.what();
        }
    }
    unsetenv("OMPI_COMM_WORLD_SIZE");
}

}  // namespace
}  // namespace feldspar
