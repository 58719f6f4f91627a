// The elastic law of the triangle: derivative of its energy over decades, invariance, plane stress and plane strain.
#include <gtest/gtest.h>

#include <cmath>

#include "feldspar/laws/plane_elasticity.hpp"

namespace feldspar {
namespace {

Mat2 rotated(double angle, const Mat2& F) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * F.xx - s * F.yx, c * F.xy - s * F.yy, s * F.xx + c * F.yx, s * F.xy + c * F.yy};
}

TEST(PlaneElasticity, StressIsTheDerivativeOfTheEnergyOverDecades) {
    const PlaneElasticity D = plane_elasticity(25.8e9, 0.23, PlaneState::stress);
    for (const double size : {1e-1, 1e-3, 1e-5}) {
        const Mat2 G = {0.3 * size, -0.7 * size, 0.4 * size, -0.9 * size};
        const Mat2 P = first_piola_stress(D, G);
        const double h = 1e-4 * size, largest = std::abs(P.yy);
        const auto slope = [&](double Mat2::*entry) {
            Mat2 up = G, down = G;
            up.*entry += h;
            down.*entry -= h;
            return (strain_energy_density(D, up) - strain_energy_density(D, down)) / (2.0 * h);
        };
        // Central differences of relative step 1e-4: truncation 1e-8, rounding 1e-16 / 1e-4.
        EXPECT_NEAR(slope(&Mat2::xx) / largest, P.xx / largest, 1e-7);
        EXPECT_NEAR(slope(&Mat2::xy) / largest, P.xy / largest, 1e-7);
        EXPECT_NEAR(slope(&Mat2::yx) / largest, P.yx / largest, 1e-7);
        EXPECT_NEAR(slope(&Mat2::yy) / largest, P.yy / largest, 1e-7);
    }
}

TEST(PlaneElasticity, RotationChangesNothingButTheDirection) {
    const PlaneElasticity D = plane_elasticity(25.8e9, 0.23, PlaneState::stress);
    const Mat2 F = {1.002, 0.0015, -0.0005, 0.997};
    const Mat2 FR = rotated(0.7, F);
    const Mat2 G = {F.xx - 1, F.xy, F.yx, F.yy - 1}, GR = {FR.xx - 1, FR.xy, FR.yx, FR.yy - 1};
    EXPECT_NEAR(strain_energy_density(D, GR) / strain_energy_density(D, G), 1.0, 1e-10);
    const Mat2 expected = rotated(0.7, first_piola_stress(D, G)), P = first_piola_stress(D, GR);
    EXPECT_NEAR(P.xx, expected.xx, 1e-6 * std::abs(expected.yy));
    EXPECT_NEAR(P.xy, expected.xy, 1e-6 * std::abs(expected.yy));
    EXPECT_NEAR(P.yy, expected.yy, 1e-6 * std::abs(expected.yy));
}

TEST(PlaneElasticity, UniaxialStrainGivesHookesLaw) {
    const double E = 25.8e9, nu = 0.23, strain = 1e-7;
    const Mat2 stress = first_piola_stress(plane_elasticity(E, nu, PlaneState::stress), {strain, 0, 0, -nu * strain});
    EXPECT_NEAR(stress.xx / (E * strain), 1.0, 1e-6);  // the finite strain itself is 1e-7
    EXPECT_NEAR(stress.yy / (E * strain), 0.0, 1e-6);
    const double lateral = -nu / (1.0 - nu) * strain;
    const Mat2 plane = first_piola_stress(plane_elasticity(E, nu, PlaneState::strain), {strain, 0, 0, lateral});
    EXPECT_NEAR(plane.xx / (E / (1.0 - nu * nu) * strain), 1.0, 1e-6);
    EXPECT_NEAR(plane.yy / (E * strain), 0.0, 1e-6);
}

TEST(PlaneElasticity, CauchyStressIsForceOverTheDeformedSectionAndTurnsWithTheBody) {
    const PlaneElasticity D = plane_elasticity(25.8e9, 0.23, PlaneState::stress);
    const double lx = 1.1, ly = 0.95;  // large, so that the sections differ from the undeformed ones
    const Mat2 P = first_piola_stress(D, {lx - 1.0, 0, 0, ly - 1.0});
    const double sx = P.xx / ly, sy = P.yy / lx;
    const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
    const Mat2 F = rotated(angle, {lx, 0, 0, ly});
    const Mat2 stress = cauchy_stress(D, {F.xx - 1.0, F.xy, F.yx, F.yy - 1.0});
    EXPECT_NEAR(stress.xx / sx, (c * c * sx + s * s * sy) / sx, 1e-12);
    EXPECT_NEAR(stress.yy / sx, (s * s * sx + c * c * sy) / sx, 1e-12);
    EXPECT_NEAR(stress.xy / sx, c * s * (sx - sy) / sx, 1e-12);
    EXPECT_NEAR(stress.yx / sx, c * s * (sx - sy) / sx, 1e-12);
}

}  // namespace
}  // namespace feldspar
