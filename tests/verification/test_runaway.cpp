// A motion that feeds itself is stopped at once, with its place and a cause; a test whose end never comes ends all the same.
#include <gtest/gtest.h>

#include "feldspar/base/error.hpp"
#include "feldspar/lab/recorder.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

struct Runaway {
    long long steps = 0;  // until it was stopped
    std::string what;
};

// A specimen whose masses become so small, once it is loaded, that its step is unstable: all of them, or those of one grain.
Runaway run_with_light_nodes(bool all, double factor) {
    TestSetup setup = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04), 3), methods::uniaxial_compression);
    const RunControl control = fixtures::threads(1);
    TestResult result;
    result.test = setup.test;
    result.model = setup.model;
    result.contact = setup.contact;
    result.specimen = setup.specimen;
    Experiment e(setup, control);
    choose_step(e);
    Recorder recorder(e, result);
    prepare(e);
    const auto lighten = [&](int node) {
        e.assembly.nodes.mass[node] /= factor;
        e.assembly.nodes.inverse_mass[node] = factor * e.assembly.nodes.inverse_mass[node];
    };
    if (all) {
        for (int n = 0; n < e.assembly.nodes.count(); ++n) lighten(n);
    } else {
        for (const int n : e.assembly.bodies[17].nodes()) lighten(n);
    }
    Runaway runaway;
    try {
        load(e, recorder, result);
    } catch (const NumericalError& error) {
        runaway.what = error.what();
    }
    runaway.steps = result.steps;
    return runaway;
}

TEST(Runaway, IsStoppedWithinAHundredSteps) {
    for (const bool all : {true, false}) {
        const Runaway runaway = run_with_light_nodes(all, 6.0);
        EXPECT_LE(runaway.steps, 100) << runaway.what;
        EXPECT_NE(runaway.what.find("at step "), std::string::npos) << runaway.what;
        EXPECT_NE(runaway.what.find(" mm: "), std::string::npos) << runaway.what;  // its place
    }
}

// What grows slowly is stopped by its energy.
TEST(Runaway, IsStoppedByItsEnergyBeforeNumbersRunOut) {
    const Runaway runaway = run_with_light_nodes(true, 1.9);
    EXPECT_NE(runaway.what.find("than was ever supplied"), std::string::npos) << runaway.what;
}

TEST(Runaway, LeavesItsRecord) {
    TestSetup setup = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04), 3), methods::uniaxial_compression);
    setup.contact.sigma_nt_Pa = setup.contact.tau_Pa = 1e12;  // nothing breaks
    setup.test.maximum_strain = 1.0;                          // so that it is pressed until grains turn inside out
    setup.numerics.kind = NumericsKind::paper;
    setup.numerics.speed_m = 1e-4;
    RunControl control = fixtures::threads(1);
    std::size_t rows = 0, pictures = 0;
    control.failed = [&](const TestResult& record) {
        rows = record.history.size();
        pictures = record.snapshots.size();
    };
    EXPECT_THROW((void)run_test(setup, control), NumericalError);
    EXPECT_GT(rows, 0U);
    EXPECT_GT(pictures, 0U);
}

}  // namespace
}  // namespace feldspar
