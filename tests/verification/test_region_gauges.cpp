// Means of stress and strain over a region, for every kind of grain, against the load on the specimen; the stress at a hole
// against finite elements.
#include <gtest/gtest.h>

#include <cmath>

#include "feldspar/base/error.hpp"
#include "feldspar/lab/recorder.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

constexpr double kWidth = 0.03, kHeight = 0.06;

GaugeSpec mean(GaugeKind kind, GaugeRegion region, Vec2 direction, Vec2 normal = {}) {
    GaugeSpec gauge;
    gauge.name = "mean";
    gauge.kind = kind;
    gauge.region = region;
    gauge.direction = direction;
    gauge.normal = normal;
    return gauge;
}

GaugeSpec stress(GaugeRegion region, Vec2 direction, Vec2 normal = {}) {
    return mean(GaugeKind::mean_stress, region, direction, normal);
}

class RegionGauges : public testing::TestWithParam<ModelSpec> {};
std::vector<ModelSpec> models() {
    return {ModelSpec{}, fixtures::model(GrainKind::rigid), fixtures::model(GrainKind::inner_particles)};
}
INSTANTIATE_TEST_SUITE_P(Models, RegionGauges, testing::ValuesIn(models()),
                         [](const auto& tested) { return fixtures::label(tested.param); });

TEST_P(RegionGauges, ReadTheStressOfTheLoadAndTheStrainOfTheMiddle) {  // (P41), (P42), (P46)
    const RunControl control = fixtures::threads(1);
    const TestSetup s = fixtures::setup(fixtures::rectangle(kWidth, kHeight), methods::uniaxial_compression, GetParam());
    Experiment e(s, control);
    choose_step(e);
    prepare(e);
    evaluate_forces(e.assembly, e.team, Strength::unlimited);
    const GaugeRegion all{{-1.0, -1.0}, {1.0, 1.0}}, lower{{-1.0, -1.0}, {1.0, 0.023}}, upper{{-1.0, 0.023}, {1.0, 1.0}},
        middle{{-1.0, 0.25 * kHeight}, {1.0, 0.75 * kHeight}}, circle{{0.5 * kWidth, 0.5 * kHeight}, {}, 0.4 * kWidth};
    const Vec2 x{1.0, 0.0}, y{0.0, 1.0}, slant = std::sqrt(0.5) * Vec2{1.0, 1.0}, across = std::sqrt(0.5) * Vec2{1.0, -1.0};
    const Gauges gauges(e.assembly, *s.specimen,
                        {stress(all, y), stress(all, x), stress(all, x, y), stress(all, slant), stress(all, slant, across),
                         stress(lower, y), stress(upper, y), stress(middle, y), stress(circle, y),
                         mean(GaugeKind::mean_strain, middle, y), mean(GaugeKind::mean_strain, middle, x)});
    const std::vector<double> read = gauges.read(e.assembly);
    const double load = e.stress(reactions(e.assembly).loading);
    // Two boxes that make up the specimen: their means, by their areas, make up the whole's.
    EXPECT_NEAR((0.023 * read[5] + (kHeight - 0.023) * read[6]) / kHeight / read[0], 1.0, 1e-9);
    // Across any section goes the load; a box cuts through grains, and within a cut grain the stress varies.
    EXPECT_NEAR(read[7] / load, 1.0, 0.005);              // measured: 0.0001 to 0.001 off, by the kind of grain
    EXPECT_NEAR(read[8] / load, 1.0, 0.02);               // measured: 0.0001 to 0.007
    if (GetParam().kind == GrainKind::inner_particles) {  // the specimen's gauge has another particle's centre for each grain
        EXPECT_NEAR(read[9] / e.gauge.axial(e.assembly), 1.0, 0.03);
    } else {
        EXPECT_NEAR(read[9] / e.gauge.axial(e.assembly), 1.0, 1e-6);
        EXPECT_NEAR(read[10] / e.gauge.lateral(e.assembly), 1.0, 1e-6);
    }
}

TEST(RegionGauges, ReadNothingFromAMotionOfTheWholeBodyAndRefuseEmptyRegions) {
    const RunControl control = fixtures::threads(1);
    const TestSetup s = fixtures::setup(fixtures::rectangle(kWidth, kHeight), methods::uniaxial_compression, ModelSpec{});
    Experiment e(s, control);
    const GaugeRegion middle{{0.0, 0.02}, {kWidth, 0.04}}, outside{{0.1, 0.0}, {0.2, 0.1}}, tiny{{0.015, 0.03}, {}, 1e-5};
    const Gauges gauges(e.assembly, *s.specimen,
                        {mean(GaugeKind::mean_strain, middle, {0.0, 1.0}),
                         mean(GaugeKind::mean_strain, middle, {1.0, 0.0}, {0.0, 1.0}), stress(tiny, {0.0, 1.0})});
    Nodes& nodes = e.assembly.nodes;
    for (int n = 0; n < nodes.count(); ++n) nodes.displacement[n] = Vec2{3e-6, -2e-6} + 1e-7 * rot90(nodes.reference[n]);
    const std::vector<double> read = gauges.read(e.assembly);
    EXPECT_NEAR(read[0], 0.0, 1e-13);
    EXPECT_NEAR(read[1], 0.0, 1e-13);
    EXPECT_NEAR(read[2], 0.0, 1.0);  // Pa; rounding of 25.8 GPa times 1e-14
    for (const GaugeSpec& bad : {stress(outside, {0.0, 1.0}), mean(GaugeKind::mean_strain, tiny, {0.0, 1.0})})
        EXPECT_THROW(Gauges(e.assembly, *s.specimen, {bad}), InputError);
}

TEST(RegionGauges, OfEnergyReadTheLedger) {
    TestSetup s = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04)), methods::custom);
    s.test = usual_test(methods::custom);
    FixtureSpec top, bottom;
    top.name = top.part.label = "top";
    bottom.name = bottom.part.label = "bottom";
    top.imposes_x = top.imposes_y = bottom.imposes_x = bottom.imposes_y = true;
    top.motion = {0.0, 1.0};
    s.test.custom.name = "pull";
    s.test.custom.fixtures = {top, bottom};
    for (const EnergyTerm term : energy_terms) {
        GaugeSpec gauge;
        gauge.name = name(term);
        gauge.kind = GaugeKind::energy;
        gauge.term = term;
        s.test.custom.gauges.push_back(gauge);
    }
    s.numerics.accuracy = 0.05;
    const TestResult result = run_test(s, fixtures::threads(1));
    ASSERT_GT(result.history.size(), 30U);
    for (const HistoryRow& row : result.history) {
        const EnergyLedger& e = row.energy;
        const double expected[] = {e.supplied(), e.elastic_grains + e.elastic_contacts, e.fracture, e.friction, e.damping,
                                   e.kinetic};
        for (std::size_t g = 0; g < row.gauges.size(); ++g)
            EXPECT_NEAR(row.gauges[g], expected[g], 1e-12 * result.energy_at_end.supplied());
    }
    EXPECT_GT(result.history.back().gauges[2], 0.0);
}

}  // namespace
}  // namespace feldspar
