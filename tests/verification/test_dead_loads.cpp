// Pressures and weight that act before the loading and beside it: a column under gravity, a block that slides, plates under a
// force and behind a spring.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "feldspar/lab/body_energy.hpp"
#include "feldspar/lab/elastic_start.hpp"
#include "feldspar/lab/recorder.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

constexpr double kWidth = 0.03, kHeight = 0.02, kThickness = 0.08, kGravity = 9.81, kDensity = 2650.0, kMu = 0.4;

FixtureSpec plate(const char* name, const char* label, Vec2 normal, double mu = 0.0, Vec2 motion = {}) {
    FixtureSpec plate;
    plate.name = name;
    plate.kind = FixtureKind::plate;
    plate.part.label = label;
    plate.normal = plate.part.facing = normal;
    plate.motion = motion;
    plate.contact.mu = mu;
    return plate;
}

FixtureSpec pressed(FixtureSpec plate, double force_N, double spring_Pa_m = 0.0) {
    plate.pressed = true;
    plate.force_N = force_N;
    plate.spring_Pa_m = spring_Pa_m;
    return plate;
}

GaugeSpec of_fixture(GaugeKind kind, const char* fixture, Vec2 direction) {
    GaugeSpec gauge;
    gauge.name = fixture;
    gauge.kind = kind;
    gauge.fixture = fixture;
    gauge.direction = direction;
    return gauge;
}

GaugeSpec force_on(const char* fixture, Vec2 direction) { return of_fixture(GaugeKind::force, fixture, direction); }
GaugeSpec way_of(const char* fixture, Vec2 direction) { return of_fixture(GaugeKind::displacement, fixture, direction); }

TestSetup setup(const ModelSpec& model, double height_m, std::vector<FixtureSpec> list, bool weighs) {
    TestSetup s = fixtures::setup(fixtures::rectangle(kWidth, height_m), methods::custom, model);
    s.test = usual_test(methods::custom);
    s.test.custom.name = "dead-loads";
    s.test.custom.fixtures = std::move(list);
    if (weighs) s.test.custom.gravity_m_s2 = {0.0, -kGravity};
    return s;
}

double weight_N(double height_m) { return kDensity * kGravity * kWidth * height_m * kThickness; }

class DeadLoads : public testing::TestWithParam<ModelSpec> {};
std::vector<ModelSpec> models() {
    return {ModelSpec{}, fixtures::model(GrainKind::rigid), fixtures::model(GrainKind::inner_particles)};
}
INSTANTIATE_TEST_SUITE_P(Models, DeadLoads, testing::ValuesIn(models()),
                         [](const auto& tested) { return fixtures::label(tested.param); });

TEST_P(DeadLoads, OfAColumnAreItsWeightAndTheStressThatGrowsDownwards) {
    constexpr double height_m = 0.06;
    const RunControl control = fixtures::threads(1);
    const TestSetup s = setup(GetParam(), height_m, {plate("table", "bottom", {0.0, -1.0}, kMu)}, true);
    Experiment e(s, control);
    choose_step(e);
    e.set_dead_loads(1.0);
    const Relaxation rest = relax(e.assembly, e.team, Strength::unlimited, 1e-6, 50000, nullptr);
    ASSERT_TRUE(rest.converged);
    const Vec2 on_table = felt_by(e.assembly, e.assembly.fixtures.front());
    EXPECT_NEAR(on_table.y / -weight_N(height_m), 1.0, 1e-4);  // what the relaxation leaves moving
    EXPECT_NEAR(dead_resultant(e.assembly).y / -weight_N(height_m), 1.0, 1e-9);
    // Over the whole body the mean stress is rho g times the height of its centre, to the bit but for what moves: (1/A) of the
    // virtual work of a uniform vertical strain.
    GaugeSpec mean;
    mean.name = "mean";
    mean.kind = GaugeKind::mean_stress;
    mean.region = {{-1.0, -1.0}, {1.0, 1.0}, 0.0};
    mean.direction = {0.0, 1.0};
    const Gauges gauges(e.assembly, *s.specimen, {mean});
    EXPECT_NEAR(gauges.read(e.assembly).front() / (0.5 * kDensity * kGravity * height_m), 1.0, 1e-3);
    // A linear body that is at rest has half of what gravity has done as elastic energy.
    const StoredEnergy stored = stored_energy(e.assembly, 0.0);
    EXPECT_NEAR(2.0 * (stored.grains_J + stored.contacts_J) / e.weight_work(), 1.0, 1e-3);
}

// A block is pushed along a table by a plate behind it, from its own weight or under a plate with a given force.
TEST_P(DeadLoads, LetABlockSlideAtFrictionTimesTheNormalForce) {
    const RunControl control = fixtures::threads(1);
    for (const bool weighs : {true, false}) {
        const double normal_N = weighs ? weight_N(kHeight) : 20e3;
        std::vector<FixtureSpec> list{plate("table", "bottom", {0.0, -1.0}, kMu),
                                      plate("pusher", "left", {-1.0, 0.0}, 0.0, {1.0, 0.0})};
        if (!weighs) list.push_back(pressed(plate("lid", "top", {0.0, 1.0}), normal_N));
        TestSetup s = setup(GetParam(), kHeight, std::move(list), weighs);
        s.test.custom.gauges = {force_on("table", {0.0, -1.0}), force_on("table", {1.0, 0.0})};
        s.test.maximum_strain = weighs ? 2e-5 : 2e-3;  // it slides from about a third of that on
        s.test.control = LoadControl::displacement;
        const TestResult r = run_test(s, control);
        EXPECT_EQ(r.cracks.size(), 0U);
        const HistoryRow& end = r.history.back();
        EXPECT_NEAR(end.gauges[0] / normal_N, 1.0, 1e-3) << (weighs ? "weight" : "lid");
        EXPECT_NEAR(end.gauges[1] / (kMu * end.gauges[0]), 1.0, 1e-3) << (weighs ? "weight" : "lid");
        EXPECT_NEAR(end.stress_top_Pa * r.section_m2 / (kMu * normal_N), 1.0, 1e-3) << (weighs ? "weight" : "lid");
        EXPECT_NEAR(end.stress_bottom_Pa / end.stress_top_Pa, 1.0, 1e-3);
        EXPECT_LT(r.energy_residual, 1e-3);
    }
}

TEST_P(DeadLoads, BehindASpringGrowWithTheWayOfThePlate) {  // (L21)
    const RunControl control = fixtures::threads(1);
    constexpr double force_N = 20e3, spring_Pa_m = 2e12;
    // Pressed from the left, the specimen widens upwards against the lid.
    TestSetup s = setup(
        GetParam(), kHeight,
        {plate("table", "bottom", {0.0, -1.0}, kMu), plate("wall", "right", {1.0, 0.0}),
         plate("pusher", "left", {-1.0, 0.0}, 0.0, {1.0, 0.0}), pressed(plate("lid", "top", {0.0, 1.0}), force_N, spring_Pa_m)},
        false);
    s.test.custom.gauges = {force_on("lid", {0.0, 1.0}), way_of("lid", {0.0, 1.0})};
    s.test.maximum_stress_Pa = 30e6;
    const TestResult r = run_test(s, control);
    const HistoryRow &start = r.history[1], &end = r.history.back();
    ASSERT_EQ(start.phase, Phase::consolidation);
    EXPECT_NEAR(start.gauges[0] / force_N, 1.0, 1e-3);
    const double risen_m = end.gauges[1] - start.gauges[1];
    EXPECT_GT(risen_m, 0.0);
    EXPECT_GT(end.gauges[0], 1.05 * force_N);
    EXPECT_NEAR(end.gauges[0] / (force_N + spring_Pa_m * kWidth * kThickness * risen_m), 1.0, 1e-3);
    EXPECT_LT(r.energy_residual, 1e-3);
}

TEST(DirectShear, HasItsNormalStressAndItsShearForceInBalance) {
    const RunControl control = fixtures::threads(1);
    for (const double stiffness_Pa_m : {0.0, 20e9}) {
        TestSetup s = fixtures::setup(fixtures::rectangle(0.04, 0.02), methods::direct_shear, ModelSpec{});
        s.test = usual_test(methods::direct_shear);
        s.test.sigma3_Pa = 5e6;
        s.test.maximum_strain = 0.01;
        s.test.stop_fraction = 0.8;
        if (stiffness_Pa_m > 0.0) s.test.own["normal_stiffness"] = {stiffness_Pa_m};
        const TestResult r = run_test(s, control);
        const auto value = [&](const char* name) {
            const auto properties = method_of(r.test).properties;
            for (std::size_t i = 0; i < properties.size(); ++i)
                if (properties[i].name == name) return r.properties.of_method[i];
            return std::nan("");
        };
        ASSERT_TRUE(r.properties.peak_reached);
        const HistoryRow& peak =
            *std::max_element(r.history.begin(), r.history.end(),
                              [](const HistoryRow& a, const HistoryRow& b) { return a.axial_stress_Pa < b.axial_stress_Pa; });
        EXPECT_GT(value("shear_strength"), 5e6);
        EXPECT_NEAR(peak.stress_bottom_Pa / peak.stress_top_Pa, 1.0, 0.02);
        const double left = r.length_m / (r.length_m - peak.platen_displacement_m);
        EXPECT_NEAR(value("shear_strength") / (left * r.properties.peak_stress_Pa), 1.0, 1e-3);
        const double given = 5e6 + stiffness_Pa_m * (peak.gauges[0] - r.history[1].gauges[0]);
        EXPECT_NEAR(value("shear_normal_stress") / (left * given), 1.0, 0.01)
            << stiffness_Pa_m;  // what a plate that moves lacks of balance
        EXPECT_LT(r.energy_residual, 2e-3);
    }
}

TEST(DirectShear, UnderANormalStressThatDamagesTheRockBeginsWithoutAComputedStart) {
    const RunControl control = fixtures::threads(1);
    TestSetup s = fixtures::setup(fixtures::rectangle(0.04, 0.02), methods::direct_shear, ModelSpec{});
    s.test = usual_test(methods::direct_shear);
    s.test.sigma3_Pa = 60e6;  // half of the strength in compression
    s.test.maximum_stress_Pa = 20e6;
    const TestResult r = run_test(s, control);
    EXPECT_TRUE(
        std::none_of(r.history.begin(), r.history.end(), [](const HistoryRow& row) { return row.phase == Phase::elastic; }));
    EXPECT_EQ(r.stop_reason, "the stress has reached its maximum of 20 MPa");
    for (const HistoryRow& row : r.history)
        if (row.phase == Phase::loading) {
            EXPECT_NEAR(row.gauges[1] / (60e6 * r.section_m2), 1.0, 0.02);  // the ramp comes to rest within a hundredth
        }
    EXPECT_LT(r.energy_residual, 2e-3);
}

TEST(EndPlates, WithFrictionHoldTheEndsOfASquatSpecimen) {
    const RunControl control = fixtures::threads(1);
    std::array<double, 2> strength{};
    std::array<double, 2> spread{};
    for (const bool rubs : {false, true}) {
        TestSetup s = fixtures::setup(fixtures::rectangle(0.04, 0.02), methods::uniaxial_compression, ModelSpec{});
        if (rubs) s.test.plate_mu = 0.1;
        const TestResult r = run_test(s, control);
        strength[rubs] = r.properties.peak_stress_Pa;
        spread[rubs] = r.properties.nu_initial;
        EXPECT_LT(r.energy_residual, 2e-3);
    }
    EXPECT_GT(strength[1], 1.3 * strength[0]);  // half as high as wide, so it is confined from end to end; measured 1.68
    EXPECT_LT(spread[1], 0.8 * spread[0]);      // measured 0.145 and 0.231
}

}  // namespace
}  // namespace feldspar
