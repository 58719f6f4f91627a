// A test of the user's own, made of the fixtures of a method, is that method; gauges read what they say.
#include <gtest/gtest.h>

#include <cmath>

#include "feldspar/base/error.hpp"
#include "feldspar/lab/quantities.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

FixtureSpec end(const ModelSpec& model, bool top) {
    FixtureSpec end;
    end.name = top ? "upper end" : "lower end";
    end.part.label = top ? "top" : "bottom";
    end.motion = {0.0, top ? 1.0 : 0.0};
    if (model.kind == GrainKind::flexible) {
        end.imposes_y = true;
        end.pins_middle = !top;
    } else {
        end.kind = FixtureKind::plate;
        end.normal = {0.0, top ? 1.0 : -1.0};
        end.contact.glued = true;
    }
    return end;
}

GaugeSpec between(const char* name, Vec2 from, Vec2 to, GaugeKind kind) {
    const Vec2 line = to - from;
    GaugeSpec gauge;
    gauge.name = name;
    gauge.kind = kind;
    const Vec2 weight = (1.0 / (kind == GaugeKind::strain ? dot(line, line) : norm(line))) * line;
    gauge.points = {{to, weight}, {from, -weight}};
    return gauge;
}

TestSetup pulled(const ModelSpec& model, MethodId kind) {
    TestSetup s = fixtures::setup(fixtures::rectangle(0.02, 0.04), kind, model);
    s.test = usual_test(kind);
    if (kind != methods::custom) return s;
    s.test.custom.name = "pull";
    s.test.custom.fixtures = {end(model, true), end(model, false)};
    GaugeSpec force;
    force.name = "upper-force";
    force.kind = GaugeKind::force;
    force.fixture = "upper end";
    force.direction = {0.0, -1.0};
    s.test.custom.gauges = {force, between("extension", {0.01, 0.005}, {0.01, 0.035}, GaugeKind::displacement),
                            between("strain", {0.01, 0.005}, {0.01, 0.035}, GaugeKind::strain)};
    return s;
}

std::vector<ModelSpec> models() {
    return {ModelSpec{}, fixtures::model(GrainKind::rigid), fixtures::model(GrainKind::inner_particles)};
}

class CustomTests : public testing::TestWithParam<ModelSpec> {};
INSTANTIATE_TEST_SUITE_P(Models, CustomTests, testing::ValuesIn(models()),
                         [](const auto& tested) { return fixtures::label(tested.param); });

TEST_P(CustomTests, OfTheFixturesOfDirectTensionHaveItsStiffnessAndItsFirstDamage) {
    const RunControl control = fixtures::threads(1);
    const TestSetup own = pulled(GetParam(), methods::custom), method = pulled(GetParam(), methods::direct_tension);
    Experiment a(own, control), b(method, control);
    for (Experiment* e : {&a, &b}) {
        choose_step(*e);
        prepare(*e);
        evaluate_forces(e->assembly, e->team, Strength::unlimited);
    }
    EXPECT_DOUBLE_EQ(a.length_m, b.length_m);
    EXPECT_DOUBLE_EQ(a.section_m2, b.section_m2);
    const double load_a = loading_reaction(a.assembly), load_b = loading_reaction(b.assembly);
    EXPECT_NEAR(load_a / a.platen_travel_m / (load_b / b.platen_travel_m), 1.0, 1e-3);  // what the relaxations leave moving
    // Both stop at some share of the first damage: 0.98 of it, or where a further round would no longer change it by more than 5
    // %.
    EXPECT_NEAR(load_a / load_b, 1.0, 0.06);

    const std::vector<double> read = a.gauges.read(a.assembly);
    EXPECT_NEAR(read[0] / load_a, 1.0, 1e-9);  // the specimen pulls the upper end down
    EXPECT_NEAR(read[2] / (read[1] / 0.03), 1.0, 1e-12);
    EXPECT_NEAR(read[2] / -a.gauge.axial(a.assembly), 1.0,
                0.1);  // two points of a body some seven grains wide, against all in its middle
    // The time in which rates are measured is a wave's for a bar, up to its lateral motion and its plates.
    EXPECT_NEAR(a.travel_time / b.travel_time, 1.0, 0.15);
}

TEST(TestsOfTheUsersOwn, DefineNoPropertyOfTheRock) {
    TestResult result;
    result.test.kind = methods::custom;
    for (const TestQuantity& quantity : test_quantities())
        for (const QuantityGroup group :
             {QuantityGroup::elastic, QuantityGroup::initiation, QuantityGroup::damage, QuantityGroup::post_peak,
              QuantityGroup::brazilian, QuantityGroup::flattened, QuantityGroup::of_method})
            if (quantity.group == group) {
                EXPECT_TRUE(std::isnan(quantity.value(result))) << quantity.name;
            }
}

TEST(TestsOfTheUsersOwn, GaugesOutsideAndOnFixturesThatAreNotThereAreRefused) {
    const RunControl control = fixtures::threads(1);
    TestSetup outside = pulled({}, methods::custom);
    outside.test.custom.gauges = {between("far", {0.01, 0.005}, {0.01, 0.06}, GaugeKind::displacement)};
    EXPECT_THROW(Experiment(outside, control), InputError);
    TestSetup unknown = pulled({}, methods::custom);
    unknown.test.custom.gauges.front().fixture = "nobody";
    EXPECT_THROW(Experiment(unknown, control), InputError);
    TestSetup controlled = pulled({}, methods::custom);
    controlled.test.control = LoadControl::gauge;
    controlled.test.control_gauge = "CMOD";
    EXPECT_THROW(Experiment(controlled, control), InputError);
}

TEST(TestsOfTheUsersOwn, PartsOfTheBoundaryMoveWithFlexibleGrainsOnly) {
    const RunControl control = fixtures::threads(1);
    TestSetup rigid = pulled(fixtures::model(GrainKind::rigid), methods::custom);
    rigid.test.custom.fixtures = {end({}, true), end({}, false)};
    EXPECT_THROW(Experiment(rigid, control), InputError);
}

TEST(Gauges, ReadNoExtensionFromAMotionOfTheWholeBody) {
    for (const ModelSpec& model : models()) {
        const RunControl control = fixtures::threads(1);
        const TestSetup s = pulled(model, methods::custom);
        Experiment e(s, control);
        const Vec2 shift = {3e-6, -2e-6};
        const double turn = 1e-7;  // small: what it adds to lengths is of second order
        Nodes& nodes = e.assembly.nodes;
        for (const Body& body : e.assembly.bodies)
            for (const int n : body.nodes()) {
                const bool is_turn = body.kind == BodyKind::rigid && n != body.centre_node;
                nodes.displacement[n] = is_turn ? Vec2{turn * body.radius_m, 0.0} : shift + turn * rot90(nodes.reference[n]);
            }
        const std::vector<double> read = e.gauges.read(e.assembly);
        EXPECT_NEAR(read[1], 0.0, 1e-15) << name(model.kind);
        EXPECT_NEAR(read[2], 0.0, 1e-13) << name(model.kind);
    }
}

}  // namespace
}  // namespace feldspar
