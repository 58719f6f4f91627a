// What is read of a plate with a hole, from a record written by hand.
#include "feldspar/lab/hole_failure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "feldspar/methods/round_hole.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

constexpr double mm = 1e-3, MPa = 1e6;
constexpr Vec2 kCentre{30.0 * mm, 60.0 * mm};
constexpr double kRadius = 6.0 * mm, kGrain = 2.0 * mm;

Crack crack(long long step, double stress_Pa, CrackMode mode, double depth_m, double angle_deg) {
    Crack c;
    c.step = step;
    c.axial_stress_Pa = stress_Pa;
    c.mode = mode;
    c.place = kCentre + (kRadius + depth_m) * turned({1.0, 0.0}, angle_deg * M_PI / 180.0);
    return c;
}

// Rows every ten steps, the stress growing by 10 MPa each until 60 and falling then; 3.2 and -1.2 times it at the edge.
TestResult record(double sigma3_Pa = 0.0) {
    TestResult r;
    r.test.kind = methods::hole_compression;
    r.test.sigma3_Pa = sigma3_Pa;
    Specimen specimen;
    specimen.spec.outline.width_m = 60.0 * mm;
    specimen.spec.outline.height_m = 120.0 * mm;
    specimen.spec.outline.holes = {{kCentre, 2.0 * kRadius, {}, ""}};
    specimen.outline = make_outline(specimen.spec.outline);
    specimen.quality.mean_diameter_m = kGrain;
    r.specimen = std::make_shared<const Specimen>(std::move(specimen));
    r.gauges.resize(2);
    r.gauges[0].name = side_stress_gauge;
    r.gauges[1].name = pole_stress_gauge;
    for (int i = 0; i <= 8; ++i) {
        HistoryRow row;
        row.step = 10 * i;
        row.axial_stress_Pa = 10.0 * MPa * (i <= 6 ? i : 12 - i);
        row.sigma3_Pa = sigma3_Pa;
        row.gauges = {3.2 * row.axial_stress_Pa, -1.2 * row.axial_stress_Pa};
        row.cracks_tensile = i >= 3 ? 1 : 0;
        r.history.push_back(row);
    }
    r.cracks = {
        crack(22, 25.0 * MPa, CrackMode::tensile, 5.0 * mm, 90.0),    // above the pole, but deeper than a grain
        crack(25, 28.0 * MPa, CrackMode::shear, 0.5 * mm, 88.0),      // at the pole, but in shear
        crack(28, 29.0 * MPa, CrackMode::tensile, 0.5 * mm, -100.0),  // at the lower pole
        crack(35, 37.0 * MPa, CrackMode::tensile, 1.0 * mm, 175.0),   // at the left side
        crack(44, 48.0 * MPa, CrackMode::shear, 6.5 * mm, 10.0),      // right, too deep to hang together yet
        crack(45, 49.0 * MPa, CrackMode::tensile, 1.5 * mm, 0.0),     // right: one and a half
        crack(55, 58.0 * MPa, CrackMode::shear, 3.0 * mm, -20.0),     // right: deeper than a grain, the breakout begins
        crack(75, 52.0 * MPa, CrackMode::shear, 4.8 * mm, 5.0),       // joins the first one
        crack(76, 52.0 * MPa, CrackMode::shear, 3.5 * mm, 60.0),      // between side and pole: neither
    };
    return r;
}

TEST(HoleFailure, IsReadFromTheRecord) {
    const TestResult r = record();
    const HoleProperties p = hole_failure(r, {6, 60.0 * MPa, true});
    EXPECT_NEAR(p.radius_m, kRadius, 1e-12);
    EXPECT_NEAR(p.radius_over_grain, 3.0, 1e-12);
    EXPECT_NEAR(p.side_factor, 3.2, 1e-12);
    EXPECT_NEAR(p.pole_factor, -1.2, 1e-12);
    EXPECT_DOUBLE_EQ(p.pole_crack_Pa, 29.0 * MPa);
    EXPECT_DOUBLE_EQ(p.side_crack_Pa, 37.0 * MPa);
    EXPECT_DOUBLE_EQ(p.breakout_Pa, 58.0 * MPa);
    EXPECT_NEAR(p.breakout_side_stress_Pa, 3.2 * 60.0 * MPa, 1.0);  // of the row that closes the interval
    EXPECT_NEAR(p.depth_at_peak_m, 3.0 * mm, 1e-9);
    EXPECT_NEAR(p.depth_at_end_m, 6.5 * mm, 1e-9);
}

TEST(HoleFailure, UnderAPressureThereAreNoFactorsAndWithoutCracksThereIsNoFailure) {
    TestResult r = record(4.0 * MPa);
    EXPECT_TRUE(std::isnan(hole_failure(r, {6, 60.0 * MPa, true}).side_factor));
    r.cracks.clear();
    const HoleProperties p = hole_failure(r, {6, 60.0 * MPa, true});
    for (const double none : {p.pole_crack_Pa, p.side_crack_Pa, p.breakout_Pa, p.breakout_side_stress_Pa})
        EXPECT_TRUE(std::isnan(none));
    EXPECT_EQ(p.depth_at_end_m, 0.0);
}

}  // namespace
}  // namespace feldspar
