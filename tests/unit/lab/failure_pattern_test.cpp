// Failure patterns drawn by hand, with known shares, directions and concentration.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "feldspar/lab/failure_pattern.hpp"
#include "synthetic_records.hpp"

namespace feldspar {
namespace {

/// A crack of length 2 h at a place, its direction `degrees` from the loading axis.
Crack crack_at(Vec2 place, double degrees, double h = 0.5e-3, CrackMode mode = CrackMode::tensile) {
    const double angle = degrees * 3.14159265358979323846 / 180.0;
    const Vec2 along{h * std::sin(angle), h * std::cos(angle)};
    Crack crack = synthetic::crack(1, 1e6);
    crack.mode = mode;
    crack.place = place;
    crack.from = place - along;
    crack.to = place + along;
    return crack;
}

/// 80 x 160 mm: ten times twenty squares of 8 mm, twenty of which are a tenth.
std::shared_ptr<const Specimen> rectangle() {
    auto specimen = std::make_shared<Specimen>();
    specimen->mesh.nodes = {{0.0, 0.0}, {0.08, 0.0}, {0.08, 0.16}, {0.0, 0.16}};
    specimen->outline.area_m2 = 0.08 * 0.16;
    return specimen;
}

TEST(FailurePattern, SharesAreByLength) {
    TestResult result = synthetic::linear(methods::uniaxial_compression, 100e6);
    result.cracks = {crack_at({0.04, 0.08}, 0.0, 1.5e-3), crack_at({0.04, 0.09}, 0.0, 0.5e-3, CrackMode::shear)};
    EXPECT_NEAR(failure_pattern(result).tensile_share, 0.75, 1e-12);
}

TEST(FailurePattern, DirectionsAreLinesWithoutAHead) {
    TestResult result = synthetic::linear(methods::uniaxial_compression, 100e6);
    result.cracks = {crack_at({0.04, 0.08}, 175.0), crack_at({0.04, 0.08}, 5.0), crack_at({0.04, 0.08}, -5.0), crack_at({0.04, 0.08}, -175.0)};
    FailurePattern pattern = failure_pattern(result);
    EXPECT_NEAR(pattern.crack_angle_deg, 0.0, 1e-9);
    EXPECT_NEAR(pattern.crack_alignment, std::cos(10.0 * 3.14159265358979323846 / 180.0), 1e-12);

    result.cracks = {crack_at({0.04, 0.08}, 80.0), crack_at({0.04, 0.08}, 100.0)};
    EXPECT_NEAR(failure_pattern(result).crack_angle_deg, 90.0, 1e-9);

    result.cracks = {crack_at({0.04, 0.08}, 0.0), crack_at({0.04, 0.08}, 90.0)};
    EXPECT_NEAR(failure_pattern(result).crack_alignment, 0.0, 1e-12);
}

TEST(FailurePattern, OneBandIsAllInATenthAndEvenCrackingIsATenth) {
    TestResult result = synthetic::linear(methods::uniaxial_compression, 100e6);
    result.specimen = rectangle();
    for (int i = 0; i < 10; ++i) result.cracks.push_back(crack_at({0.004 + 0.008 * i, 0.084}, 90.0));
    EXPECT_NEAR(failure_pattern(result).crack_localisation, 1.0, 1e-9);

    result.cracks.clear();
    for (int i = 0; i < 10; ++i)
        for (int j = 0; j < 20; ++j) result.cracks.push_back(crack_at({0.004 + 0.008 * i, 0.004 + 0.008 * j}, 0.0));
    EXPECT_NEAR(failure_pattern(result).crack_localisation, 0.1, 1e-9);
}

TEST(FailurePattern, TheFallIsMeasuredInStrainsAtThePeak) {
    // three rows at 0.9, 0.8 and 0.7 of the peak, each a hundredth of the peak's strain later
    EXPECT_NEAR(failure_pattern(synthetic::linear(methods::uniaxial_compression, 100e6)).post_peak_strain, 0.02, 1e-9);
}

TEST(FailurePattern, NothingCrackedSaysNothing) {
    const FailurePattern pattern = failure_pattern(synthetic::record(methods::brazilian));
    for (const double value : {pattern.tensile_share, pattern.crack_angle_deg, pattern.crack_alignment, pattern.crack_localisation, pattern.post_peak_strain})
        EXPECT_TRUE(std::isnan(value));
}

}  // namespace
}  // namespace feldspar
