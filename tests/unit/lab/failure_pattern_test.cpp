// Failure patterns drawn by hand, with known shares, directions and concentration.
#include "feldspar/lab/failure_pattern.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

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
    result.cracks = {crack_at({0.04, 0.08}, 175.0), crack_at({0.04, 0.08}, 5.0), crack_at({0.04, 0.08}, -5.0),
                     crack_at({0.04, 0.08}, -175.0)};
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

/// Cracks of a direction along a line through the middle of the specimen, at `tilt` degrees from the loading axis, and a few
/// elsewhere.
TestResult banded(double tilt, double direction, MethodId kind = methods::uniaxial_compression) {
    TestResult result = synthetic::linear(kind, 100e6);
    result.specimen = rectangle();
    const double angle = tilt * 3.14159265358979323846 / 180.0;
    for (int i = -30; i <= 30; ++i)
        result.cracks.push_back(crack_at({0.04 + 1e-3 * i * std::sin(angle), 0.08 + 1e-3 * i * std::cos(angle)}, direction));
    return result;
}

TEST(FailurePattern, TheMostCrackedTenthHasALengthAndADirection) {
    for (const double tilt : {0.0, 25.0, 45.0}) {
        const FailurePattern pattern = failure_pattern(banded(tilt, 0.0));
        EXPECT_NEAR(pattern.band_angle_deg, tilt, 1e-6);
        EXPECT_GT(pattern.band_elongation, 100.0);
    }
    TestResult even = synthetic::linear(methods::uniaxial_compression, 100e6);
    even.specimen = rectangle();
    for (int i = 0; i < 4; ++i)  // a square of cracks: no direction
        for (int j = 0; j < 4; ++j) even.cracks.push_back(crack_at({0.033 + 0.002 * i, 0.073 + 0.002 * j}, 0.0));
    EXPECT_NEAR(failure_pattern(even).band_elongation, 1.0, 1e-6);
}

TEST(FailureMode, IsNamedByWhereTheCracksAreAndHowTheyLie) {
    EXPECT_EQ(failure_mode(banded(3.0, 2.0)).name, "axial splitting");
    EXPECT_EQ(failure_mode(banded(30.0, 2.0)).name, "shear band");
    EXPECT_EQ(failure_mode(banded(30.0, 2.0, methods::biaxial)).name, "shear band");
    EXPECT_EQ(failure_mode(banded(75.0, 2.0)).name, "axial cracks without one form");
    EXPECT_EQ(failure_mode(banded(30.0, 2.0)).words,
              "The most cracked tenth of the specimen has 100 % of the crack length; it is 1414.2 times as long as wide, at 30 "
              "degrees to the loading axis. "
              "100 % of the crack length is tensile; cracks lie at 2 degrees to the axis in the mean, with an alignment of 1.00");
    TestResult everywhere = synthetic::linear(methods::uniaxial_compression, 100e6);
    everywhere.specimen = rectangle();
    for (int i = 0; i < 10; ++i)
        for (int j = 0; j < 20; ++j)
            everywhere.cracks.push_back(crack_at({0.004 + 0.008 * i, 0.004 + 0.008 * j}, 37.0 * (i + 3 * j)));
    EXPECT_EQ(failure_mode(everywhere).name, "crushing");
}

TEST(FailureMode, IsOfSpecimensThatFailedInCompression) {
    EXPECT_TRUE(failure_mode(banded(30.0, 2.0, methods::direct_tension)).name.empty());
    TestResult few = banded(30.0, 2.0);
    few.cracks.resize(20);
    EXPECT_TRUE(failure_mode(few).name.empty());
    TestResult whole = banded(30.0, 2.0);
    while (!whole.history.empty() && whole.history.back().axial_stress_Pa < 0.999 * 100e6)
        whole.history.pop_back();  // ends at its largest stress
    EXPECT_TRUE(failure_mode(whole).name.empty());
}

TEST(FailurePattern, TheFallIsMeasuredInStrainsAtThePeak) {
    // three rows at 0.9, 0.8 and 0.7 of the peak, each a hundredth of the peak's strain later
    EXPECT_NEAR(failure_pattern(synthetic::linear(methods::uniaxial_compression, 100e6)).post_peak_strain, 0.02, 1e-9);
}

TEST(FailurePattern, NothingCrackedSaysNothing) {
    const FailurePattern pattern = failure_pattern(synthetic::record(methods::brazilian));
    for (const double value : {pattern.tensile_share, pattern.crack_angle_deg, pattern.crack_alignment,
                               pattern.crack_localisation, pattern.post_peak_strain})
        EXPECT_TRUE(std::isnan(value));
}

}  // namespace
}  // namespace feldspar
