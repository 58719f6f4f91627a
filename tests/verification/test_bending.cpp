// A deep notch among few grains: what is left of the difference to finite elements goes away as the beam grows. The other closed
// forms of bending are checks of verify/bending.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "feldspar/methods/beam.hpp"
#include "feldspar/specimen/outline.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

constexpr double kHeight = 0.04;

struct Elastic {
    double load_N, deflection_m, opening_m, imbalance;
};

Elastic elastic(const SpecimenSpec& spec, double span_m, const ModelSpec& model, const ContactMaterial& contact, int seed = 1) {
    TestSetup s = fixtures::setup(fixtures::make(spec, seed), methods::three_point_bend);
    s.model = model;
    s.contact = contact;
    s.test.own["span"] = {span_m};
    const RunControl control = fixtures::threads(2);
    Experiment e(s, control);
    choose_step(e);
    prepare(e);
    const Reactions r = reactions(e.assembly);
    const std::vector<double> read = e.gauges.read(e.assembly);
    return {r.loading, read[0], read.size() > 1 ? read[1] : 0.0, r.rest / r.loading - 1.0};
}

// Of the same grains and contacts, in compression.
double modulus(const ModelSpec& model, const ContactMaterial& contact) {
    TestSetup s = fixtures::setup(fixtures::make(fixtures::rectangle(0.06, 0.12)), methods::uniaxial_compression);
    s.model = model;
    s.contact = contact;
    const RunControl control = fixtures::threads(2);
    Experiment e(s, control);
    choose_step(e);
    prepare(e);
    return e.stress(reactions(e.assembly).loading) / e.gauge.axial(e.assembly);
}

TEST(Bending, MouthOfADeepNotchComesToFiniteElementsAsTheBeamGrows) {  // (P39)
    const double E = modulus({}, fixtures::table7());
    // A tip among grains of a thirteenth of the height: single packings differ by 2 %. Half a height is then a ligament of seven
    // grains, and a body of few grains across is stiffer than the large one of `E` (two percent already at seven:
    // ARealBarRingsWithTheClosedFormFrequency): 3 to 4 %. So a beam of twice the height has to show that this goes away.
    struct Case {
        double x, times_height;
        int packings;
        double tolerance;
    };
    double before = 0.0;
    for (const Case& c : {Case{0.5, 1.0, 3, 0.05}, {0.5, 2.0, 1, 0.03}}) {
        double sum = 0.0;
        for (int seed = 1; seed <= c.packings; ++seed) {
            const double h = c.times_height * kHeight;
            SpecimenSpec spec = fixtures::rectangle(4.4 * h, h);
            spec.outline.notches = {{{2.2 * h, 0.0}, {2.2 * h, c.x * h}, 5e-4, ""}};
            const Elastic e = elastic(spec, 4.0 * h, {}, fixtures::table7(), seed);
            sum += e.load_N / e.opening_m * mouth_factor(c.x) / 0.08 / c.packings;
        }
        EXPECT_NEAR(sum / E, 1.0, c.tolerance) << c.x << " " << c.times_height;
        if (c.times_height > 1.0) {
            EXPECT_LT(std::abs(sum / E - 1.0), std::abs(before - 1.0));
        }
        before = sum / E;
    }
}

}  // namespace
}  // namespace feldspar
