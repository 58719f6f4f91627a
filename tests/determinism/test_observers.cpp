// A test that is watched is the same test; one that is led through stages has the bits of the test whose setup has these stages.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>

#include "../verification/fixtures.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/lab/observer.hpp"

namespace feldspar {
namespace {

class Observer final : public TestObserver {
public:
    explicit Observer(std::function<TestOrders(const TestView&)> look, std::optional<StageSpec> first = {})
        : look_(std::move(look)), first_(std::move(first)) {}
    std::optional<StageSpec> begins() override { return first_; }
    TestOrders look(const TestView& view) override {
        ++looks;
        return look_(view);
    }
    void leaves(Assembly&& assembly) noexcept override { left = std::move(assembly); }
    int looks = 0;
    Assembly left;

private:
    std::function<TestOrders(const TestView&)> look_;
    std::optional<StageSpec> first_;
};

TestResult run(const TestSetup& setup, TestObserver& observer) {
    RunControl control;
    control.observer = &observer;
    return run_test(setup, control);
}

void expect_same_bits(const TestResult& a, const TestResult& b) {
    ASSERT_EQ(a.history.size(), b.history.size());
    const auto same = [](double x, double y) { return std::memcmp(&x, &y, sizeof x) == 0; };
    for (std::size_t i = 0; i < a.history.size(); ++i) {
        const HistoryRow &x = a.history[i], &y = b.history[i];
        ASSERT_EQ(x.step, y.step) << "row " << i;
        ASSERT_EQ(x.stage, y.stage) << "row " << i;
        ASSERT_TRUE(same(x.axial_strain, y.axial_strain) && same(x.axial_stress_Pa, y.axial_stress_Pa) &&
                    same(x.residual, y.residual) && same(x.platen_speed, y.platen_speed) && same(x.sigma3_Pa, y.sigma3_Pa) &&
                    same(x.energy.external, y.energy.external) && same(x.energy.damping, y.energy.damping) &&
                    same(x.energy.kinetic, y.energy.kinetic))
            << "row " << i;
    }
    ASSERT_EQ(a.cracks.size(), b.cracks.size());
    for (std::size_t i = 0; i < a.cracks.size(); ++i) ASSERT_EQ(a.cracks[i].step, b.cracks[i].step) << "crack " << i;
    EXPECT_EQ(a.stop_reason, b.stop_reason);
}

TestSetup small(MethodId kind = methods::uniaxial_compression, const ModelSpec& model = {}) {
    TestSetup s = fixtures::setup(fixtures::rectangle(0.016, 0.032), kind, model);
    s.numerics.accuracy = 0.05;
    return s;
}

TEST(Observers, WhoOnlyLooksChangesNoBit) {
    const TestSetup s = small();
    Observer observer([](const TestView& view) {
        EXPECT_EQ(view.row().step, view.result.history.back().step);
        EXPECT_GT(view.assembly.nodes.count(), 0);
        EXPECT_FALSE(view.stage_ended);
        return TestOrders{};
    });
    const TestResult watched = run(s, observer);
    expect_same_bits(watched, run_test(s, {}));
    EXPECT_GT(observer.looks, 10);
    EXPECT_GT(watched.cracks.size(), 0U);
    EXPECT_GT(observer.left.nodes.count(), 0) << "the body is handed on at the end";
}

class Led : public testing::TestWithParam<ModelSpec> {};
INSTANTIATE_TEST_SUITE_P(Models, Led, testing::Values(ModelSpec{}, fixtures::model(GrainKind::rigid)),
                         [](const auto& tested) { return fixtures::label(tested.param); });

TEST_P(Led, ThroughStagesItHasTheBitsOfATestWithTheseStages) {
    TestSetup s = small(methods::biaxial, GetParam());
    s.test.sigma3_Pa = 4e6;
    s.test.membrane_plates = 6;
    const std::vector<StageSpec> stages{{.kind = StageKind::load, .end = StageEnd::stress, .value = 30e6},
                                        {.kind = StageKind::hold, .travel_times = 5.0},
                                        {.kind = StageKind::unload, .end = StageEnd::stress, .value = 10e6},
                                        {.kind = StageKind::confine, .sigma3_Pa = 6e6},
                                        {.kind = StageKind::load}};
    TestSetup staged = s;
    for (const StageSpec& stage : stages) staged.test.stages.push_back({{stage}});
    const TestResult wanted = run_test(staged, {});
    ASSERT_EQ(wanted.stages.size(), stages.size()) << wanted.stop_reason;

    std::size_t next = 1;
    Observer observer(
        [&](const TestView& view) {
            TestOrders orders;
            if (view.stage_ended && next < stages.size()) orders.stage = stages[next++];
            return orders;
        },
        stages.front());
    const TestResult led = run(s, observer);
    expect_same_bits(led, wanted);
    ASSERT_EQ(led.stages.size(), stages.size());
    for (std::size_t i = 0; i < stages.size(); ++i) EXPECT_EQ(led.stages[i].ended, wanted.stages[i].ended);
    EXPECT_EQ(led.test.stages, staged.test.stages) << "the result tells how it was led";
}

TEST(Observers, AStageMayBeCutShort) {
    Observer observer(
        [](const TestView& view) {
            TestOrders orders;
            if (view.stage == 1 && view.row().axial_stress_Pa > 20e6)
                orders.stage = StageSpec{.kind = StageKind::unload, .end = StageEnd::stress, .value = 5e6};
            return orders;
        },
        StageSpec{.kind = StageKind::load});
    const TestResult led = run(small(), observer);
    ASSERT_EQ(led.stages.size(), 2U);
    EXPECT_EQ(led.stages[0].ended, "another stage was ordered");
    EXPECT_GT(led.history[led.stages[0].last_row].axial_stress_Pa, 20e6);
    EXPECT_NEAR(led.history.back().axial_stress_Pa / 5e6, 1.0, 0.02)
        << "an end is met to a thousandth of the largest load, and what moves on";
}

TEST(Observers, MayEndATest) {
    Observer observer([](const TestView& view) {
        TestOrders orders;
        if (view.row().axial_strain > 1e-3) orders.stop = "far enough";
        return orders;
    });
    const TestResult ended = run(small(), observer);
    EXPECT_EQ(ended.stop_reason, "far enough");
    EXPECT_FALSE(ended.interrupted);
    EXPECT_NEAR(ended.history.back().axial_strain / 1e-3, 1.0, 0.1) << "a record is 10 steps";
}

// The books stay in order whatever is ordered: pressures and motions that jump, a speed that is given and goes back.
TEST(Observers, OrdersOfLoadAreInTheBooks) {
    TestSetup s = small(methods::biaxial);
    s.test.sigma3_Pa = 4e6;
    s.numerics.maximum_steps = 3000;
    int orders_given = 0;
    bool went_back = false, other_pressure = false,
         other_motion = false;  // as seen on the way: a test that goes back forgets these rows
    double motion = 0.0;
    Observer observer([&](const TestView& view) {
        TestOrders orders;
        went_back = went_back || view.row().platen_speed < 0.0;
        other_pressure = other_pressure || view.row().sigma3_Pa == 5e6;
        if (motion == 0.0) motion = view.assembly.fixtures[0].motion.y;
        other_motion = other_motion || view.assembly.fixtures[0].motion.y != motion;
        const long long n = view.result.steps / 10;
        if (n % 20 != 0) return orders;
        ++orders_given;
        switch (n / 20 % 5) {
            case 1:
                orders.pressures = {{"", 5e6}};
                break;
            case 2:
                orders.pace = TestOrders::Pace::given;
                orders.speed = -0.5 * std::abs(view.speed);
                break;
            case 3:
                orders.pace = TestOrders::Pace::own;
                break;
            case 4:
                orders.motions = {{view.assembly.fixtures[0].name, 0.9 * view.assembly.fixtures[0].motion}};
                break;
            default:
                orders.pressures = {{"", 4e6}};
                break;
        }
        return orders;
    });
    const TestResult led = run(s, observer);
    EXPECT_GT(orders_given, 5);
    EXPECT_LT(led.energy_residual, 2e-3) << "of the work supplied, at any row";
    EXPECT_TRUE(went_back);
    EXPECT_TRUE(other_pressure);
    EXPECT_TRUE(other_motion);
}

TEST(Observers, AGivenSpeedHoldsWithNumericsThatKeepOne) {
    TestSetup s = small();
    s.numerics.kind = NumericsKind::paper;
    s.numerics.maximum_steps = 500;
    Observer observer([](const TestView& view) {
        TestOrders orders;
        if (view.row().step == 100) orders = {.pace = TestOrders::Pace::given, .speed = 2.0 * view.speed};
        if (view.row().step == 300) orders.pace = TestOrders::Pace::own;
        return orders;
    });
    const TestResult led = run(s, observer);
    double first = led.history.front().platen_speed;
    EXPECT_GT(first, 0.0);
    for (const HistoryRow& row : led.history)
        EXPECT_EQ(row.platen_speed, row.step > 100 && row.step <= 300 ? 2.0 * first : first) << "at step " << row.step;
    EXPECT_LT(led.energy_residual, 1e-3);
}

void expect_refused(const TestSetup& setup, const TestOrders& orders, const std::string& key) {
    Observer observer([&](const TestView&) { return orders; });
    try {
        (void)run(setup, observer);
        FAIL() << "refused nothing: " << key;
    } catch (const InputError& error) {
        EXPECT_EQ(error.place().key, key) << error.what();
    }
    EXPECT_GT(observer.left.nodes.count(), 0) << "the body is handed on after an error, too";
}

TEST(Observers, OrdersThatCannotBeCarriedOutAreRefused) {
    const TestSetup s = small();
    expect_refused(s, {.stage = StageSpec{.kind = StageKind::hold}}, "stage");
    expect_refused(s, {.pressures = {{"", 1e6}}}, "pressure");
    expect_refused(s, {.motions = {{"nowhere", {}}}}, "fixture");
    expect_refused(s, {.pace = TestOrders::Pace::given, .speed = std::nan("")}, "speed");
    TestSetup confined = small(methods::biaxial);
    confined.test.sigma3_Pa = 4e6;
    expect_refused(confined, {.pressures = {{"", -1.0}}}, "pressure");
    Observer begins([](const TestView&) { return TestOrders{}; }, StageSpec{});
    EXPECT_THROW((void)run(small(methods::cyclic_compression), begins), InputError) << "it has stages of its own";
}

}  // namespace
}  // namespace feldspar
