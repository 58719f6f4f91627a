// The specimens of the benchmark, small: every stage runs in every state, does its work and leaves the state as it was.
#include <gtest/gtest.h>

#include <filesystem>

#include "benchmarks/granite.hpp"

namespace feldspar::benchmarks {
namespace {

constexpr double kSmall = 0.25;  // a sixteenth of the paper's grains

class EveryGranite : public testing::TestWithParam<std::tuple<GrainKind, Load>> {};

TEST_P(EveryGranite, RunsEveryStageInEveryState) {
    const auto [grains, load] = GetParam();
    Granite granite(grains, load, kSmall, {});
    const Counts counts = granite.counts();
    EXPECT_GT(counts.grains, 20);
    EXPECT_GT(counts.points, counts.grains);
    EXPECT_EQ(counts.triangles > 0, grains == GrainKind::flexible);
    EXPECT_GT(counts.memory_bytes, 0.0);
    for (const int threads : {1, 2}) {
        Team team(threads);
        for (const State state : {State::breaking, State::elastic, State::relaxing}) {
            granite.set(state);
            const Granite::Damage before = granite.damage();
            EXPECT_EQ(before.broken > 0, state == State::breaking);
            for (const Stage stage : {Stage::contacts, Stage::bodies, Stage::step, Stage::energies}) granite.run(stage, team, 20);
            const Granite::Damage after = granite.damage();
            EXPECT_EQ(after.softened, before.softened) << name(state);
            EXPECT_EQ(after.broken, before.broken) << name(state);
            Counts then = granite.counts();
            EXPECT_NEAR(then.memory_bytes, counts.memory_bytes,
                        1e-3 * counts.memory_bytes);  // a state that was copied has no spare room
            then.memory_bytes = counts.memory_bytes;
            EXPECT_EQ(then, counts);
        }
        granite.set(State::breaking);
        granite.run(Stage::step, team, 1);
        EXPECT_TRUE(granite.forces_are_sound());
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryGranite,
                         testing::Combine(testing::Values(GrainKind::flexible, GrainKind::rigid, GrainKind::inner_particles),
                                          testing::Values(Load::uniaxial, Load::brazilian)));

TEST(BreakingGranite, HasTheSharesOfDamageThatItSays) {
    Granite granite(GrainKind::flexible, Load::uniaxial, 0.5, {});
    granite.set(State::breaking);
    const double points = static_cast<double>(granite.counts().points);  // flexible grains between rows of nodes: all are bonds
    EXPECT_NEAR(static_cast<double>(granite.damage().softened) / points, 0.30, 0.03);
    EXPECT_NEAR(static_cast<double>(granite.damage().broken) / points, 0.10, 0.02);
    granite.set(State::elastic);
    EXPECT_EQ(granite.damage().softened + granite.damage().broken, 0);
}

TEST(Packings, AreKeptAndGiveTheSameSpecimen) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "feldspar-benchmark-packings";
    std::filesystem::remove_all(folder);
    const Counts made = Granite(GrainKind::flexible, Load::uniaxial, kSmall, folder).counts();
    ASSERT_FALSE(std::filesystem::is_empty(folder));
    EXPECT_EQ(Granite(GrainKind::flexible, Load::uniaxial, kSmall, folder).counts(), made);
    EXPECT_EQ(Granite(GrainKind::flexible, Load::uniaxial, kSmall, {}).counts(), made);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace feldspar::benchmarks
