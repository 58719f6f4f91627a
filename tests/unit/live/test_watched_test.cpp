// A test that is looked at while it runs: what is seen of it, that looking changes no bit, and that its user may end it.
#include <gtest/gtest.h>

#include <optional>

#include "../../verification/fixtures.hpp"
#include "feldspar/lab/test_watch.hpp"

namespace feldspar {
namespace {

class Looking final : public TestWatch {
public:
    explicit Looking(int looks = -1) : looks_(looks) {}
    bool due() override { return true; }
    void see(const TestSight& sight) override {
        ++seen;
        rows = sight.so_far().history.size();
        displacements = sight.displacements();
    }
    bool ended() const override { return looks_ >= 0 && seen >= looks_; }

    int seen = 0;
    std::size_t rows = 0;
    std::vector<Vec2> displacements;

private:
    int looks_;  // after which the user ends the test; < 0: never
};

TestSetup small_test() {
    TestSetup setup =
        fixtures::setup(fixtures::rectangle(0.012, 0.024), methods::uniaxial_compression, {}, ContactLaw::bilinear, 5);
    setup.numerics.accuracy = 0.05;
    return setup;
}

TestResult run(const TestSetup& setup, TestWatch* watch) {
    RunControl control = fixtures::threads(1);
    control.watch = watch;
    return run_test(setup, control);
}

TEST(WatchedTest, LookingAtEveryRecordChangesNoBit) {
    const TestSetup setup = small_test();
    Looking looking;
    const TestResult seen = run(setup, &looking), alone = run(setup, nullptr);
    EXPECT_GT(looking.seen, 20);
    ASSERT_EQ(seen.history.size(), alone.history.size());
    ASSERT_EQ(seen.cracks.size(), alone.cracks.size());
    for (std::size_t row = 0; row < seen.history.size(); ++row) {
        EXPECT_EQ(seen.history[row].axial_stress_Pa, alone.history[row].axial_stress_Pa);
        EXPECT_EQ(seen.history[row].energy.residual(), alone.history[row].energy.residual());
        EXPECT_EQ(seen.history[row].lateral_strain_gauge, alone.history[row].lateral_strain_gauge);
    }
    const std::vector<Vec2>& u = seen.snapshots.back().displacement_m;
    ASSERT_EQ(u.size(), alone.snapshots.back().displacement_m.size());
    for (std::size_t n = 0; n < u.size(); ++n) EXPECT_EQ(u[n].x, alone.snapshots.back().displacement_m[n].x);
    EXPECT_EQ(seen.stop_reason, alone.stop_reason);
    // what was seen last is what the test left
    EXPECT_EQ(looking.rows, seen.history.size());
    ASSERT_EQ(looking.displacements.size(), u.size());
    for (std::size_t n = 0; n < u.size(); ++n) EXPECT_EQ(looking.displacements[n].y, u[n].y);
}

TEST(WatchedTest, EndsWhenItsUserWantsItWithAllThatItHas) {
    TestSetup setup = small_test();
    setup.numerics.confirm = true;  // an ended test is not repeated
    Looking ending(5);
    const TestResult result = run(setup, &ending);
    EXPECT_EQ(ending.seen, 5);
    EXPECT_EQ(result.history.size(), ending.rows);
    EXPECT_FALSE(result.interrupted) << "it is done: the same command does not run it again";
    EXPECT_EQ(result.stop_reason, kEndedByUser);
    EXPECT_FALSE(result.properties.peak_reached);
    EXPECT_FALSE(result.snapshots.empty());
    ASSERT_FALSE(result.properties.remarks.empty());
    EXPECT_EQ(result.properties.remarks.back(), "The test was ended by the user, before its own end.");
}

}  // namespace
}  // namespace feldspar
