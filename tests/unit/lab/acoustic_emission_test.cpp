// Events, magnitudes, moments and statistics of cracks.
#include "feldspar/lab/acoustic_emission.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "feldspar/base/rng.hpp"

namespace feldspar {
namespace {

TestResult result_with(std::vector<Crack> cracks) {
    TestResult r;
    auto specimen = std::make_shared<Specimen>();
    specimen->quality.cell_sizes.mean_m = 0.003;
    r.specimen = specimen;
    r.grain = {60e9, 0.25, 2700.0};
    r.length_m = 0.15;
    r.travel_steps = 400.0;  // 0.375 mm a step: a radius of 15 mm is 40 steps
    r.cracks = std::move(cracks);
    return r;
}

Crack crack(long long step, Vec2 place, double energy_J = 1e-3) {
    Crack c;
    c.step = step;
    c.place = place;
    c.energy_J = energy_J;
    c.area_m2 = 1e-4;
    c.normal = {0.0, 1.0};
    return c;
}

TEST(AcousticEvents, GatherCracksThatAreNearInPlaceAndTime) {
    const AcousticEmission e =
        acoustic_emission(result_with({crack(100, {0.0, 0.0}), crack(130, {0.01, 0.0}),  // joins
                                       crack(131, {0.1, 0.0}),                           // elsewhere
                                       crack(165, {0.0, 0.01}),    // joins: 35 steps after the last of its event
                                       crack(300, {0.0, 0.0})}));  // later
    EXPECT_DOUBLE_EQ(e.radius_m, 0.015);
    EXPECT_DOUBLE_EQ(e.window_steps, 40.0);
    ASSERT_EQ(e.events.size(), 3U);
    EXPECT_EQ(e.events[0].cracks, 3);
    EXPECT_EQ(e.events[1].cracks, 1);
    EXPECT_EQ(e.events[2].first_step, 300);
    EXPECT_NEAR(e.events[0].place.x, 0.01 / 3.0, 1e-15);
    EXPECT_EQ(gather_events(result_with({crack(100, {0.0, 0.0}), crack(130, {0.01, 0.0})}), 2.0).events.size(),
              2U);  // a smaller radius
}

TEST(AcousticEvents, AreCountedForSeveralRadii) {
    const AcousticEmission e =
        acoustic_emission(result_with({crack(100, {0.0, 0.0}), crack(101, {0.01, 0.0})}));  // 3.3 grains apart
    ASSERT_EQ(e.counts.size(), 3U);
    EXPECT_EQ(e.counts[0].events, 2U);
    EXPECT_EQ(e.counts[1].events, 2U);
    EXPECT_EQ(e.counts[2].events, 1U);
    EXPECT_EQ(e.counts[2].events, e.events.size());
    EXPECT_TRUE(acoustic_emission(result_with({})).counts.empty());
}

TEST(AcousticEvents, HaveTheEnergyOfTheirCracks) {
    std::vector<Crack> cracks;
    RandomStream random(3, "cracks");
    double energy = 0.0;
    for (int i = 0; i < 500; ++i) {
        cracks.push_back(crack(7 * i, {0.1 * random.uniform(), 0.1 * random.uniform()}, 1e-4 * random.uniform()));
        energy += cracks.back().energy_J;
    }
    double sum = 0.0;
    for (const AcousticEvent& event : acoustic_emission(result_with(cracks)).events) sum += event.energy_J;
    EXPECT_NEAR(sum / energy, 1.0, 1e-12);
}

TEST(BValue, HasTheErrorOfTheExample) {  // SeismoStats: 24 magnitudes in bins of 0.1
    const std::vector<double> m{2.0, 2.5, 2.1, 2.2, 2.5, 2.2, 2.6, 2.3, 2.7, 2.2, 2.4, 2.0,
                                2.7, 2.2, 2.3, 2.1, 2.4, 2.6, 2.2, 2.2, 2.7, 2.4, 2.2, 2.5};
    const BValue fit = b_value(m, 2.0, 0.1);
    EXPECT_EQ(fit.events, 24);
    // Its error there is that of Utsu's b, 1.108837: the error goes with the square of b.
    EXPECT_NEAR(fit.error * std::pow(1.108837 / fit.b, 2), 0.127673 * std::pow(1.108837 / 1.114920, 2), 1e-5);
}

TEST(BValue, OfFewEventsIsNotTold) {
    std::vector<Crack> cracks;
    for (int i = 0; i < fewest_events - 1; ++i) cracks.push_back(crack(1000 * i, {}, 1e-3 * (i + 1)));
    const AcousticEmission e = acoustic_emission(result_with(cracks));
    EXPECT_EQ(std::ssize(e.events), fewest_events - 1);
    EXPECT_TRUE(std::isnan(e.b_value.b));
    EXPECT_TRUE(std::isnan(e.fractal_dimension));
}

}  // namespace
}  // namespace feldspar
