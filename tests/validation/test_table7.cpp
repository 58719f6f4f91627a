// Table 7 of the paper, plane stress, on five packings: what the flexible model of the Augig granite gives, and whether it
// depends on the loading rate. Minutes, so it is run on demand: ctest --preset validation -R Table7
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "../verification/fixtures.hpp"
#include "feldspar/lab/rate_control.hpp"

namespace feldspar {
namespace {

constexpr std::uint64_t kSeeds = 5;

TestResult run(MethodId kind, std::uint64_t seed, double target_factor) {
    const bool disc = kind == methods::brazilian;
    TestSetup s = fixtures::setup(fixtures::make(disc ? fixtures::disc(0.08) : fixtures::rectangle(0.08, 0.16), seed), kind);
    s.numerics.residual_target = target_factor * residual_target(s.numerics, kind);
    const TestResult r = run_test(s, fixtures::threads(2));
    fmt::print("{} seed {} target x {:.2f}: {:.3f} MPa, E {:.2f} GPa, steps to peak {}, grade {}, energy residual {:.1e}\n",
               name(kind), seed, target_factor, r.properties.peak_stress_Pa / 1e6, r.properties.E_secant_Pa / 1e9,
               r.steps_to_peak, r.evidence.grade, r.energy_residual);
    EXPECT_LT(r.energy_residual, 5e-3);
    EXPECT_TRUE(r.properties.peak_reached);
    return r;
}

std::vector<double> strengths(MethodId kind) {
    std::vector<double> values;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) values.push_back(run(kind, seed, 1.0).properties.peak_stress_Pa);
    std::sort(values.begin(), values.end());
    return values;
}

TEST(Table7, UniaxialCompressiveStrength) {
    const std::vector<double> values = strengths(methods::uniaxial_compression);
    EXPECT_GT(values[kSeeds / 2], 102e6);
    EXPECT_LT(values[kSeeds / 2], 130e6);
}

TEST(Table7, DirectTensileStrength) {
    const std::vector<double> values = strengths(methods::direct_tension);
    EXPECT_GT(values[kSeeds / 2], 7.9e6);
    EXPECT_LT(values[kSeeds / 2], 8.9e6);
}

TEST(Table7,
     BrazilianStrengthScatters) {  // numerical strengths scatter by 8 to 20 % over packings; the mean is near the prototype's
    const std::vector<double> values = strengths(methods::brazilian);
    EXPECT_GT(values.front(), 4e6);
    EXPECT_LT(values.back(), 13e6);
}

TEST(Table7, CompressionAndTensionDoNotDependOnTheLoadingRate) {
    for (const MethodId kind : std::initializer_list<MethodId>{methods::uniaxial_compression, methods::direct_tension}) {
        for (std::uint64_t seed = 1; seed <= 2; ++seed) {
            const double peak = run(kind, seed, 1.0).properties.peak_stress_Pa,
                         slower = run(kind, seed, 1.0 / 3.0).properties.peak_stress_Pa;
            EXPECT_NEAR(slower / peak, 1.0, 0.02) << name(kind) << " seed " << seed;
        }
    }
}

TEST(Table7, ThePapersOwnNumericsAgree) {  // fixed speed 6.25e-9 m a step and local damping: known to be 2 to 5 % high
    for (const MethodId kind : std::initializer_list<MethodId>{methods::uniaxial_compression, methods::direct_tension}) {
        TestSetup s = fixtures::setup(fixtures::make(fixtures::rectangle(0.08, 0.16)), kind);
        const double adaptive = run_test(s, fixtures::threads(2)).properties.peak_stress_Pa;
        s.numerics.kind = NumericsKind::paper;
        const TestResult r = run_test(s, fixtures::threads(2));
        fmt::print("{}: paper numerics {:.3f} MPa in {} steps, adaptive {:.3f} MPa\n", name(kind),
                   r.properties.peak_stress_Pa / 1e6, r.steps, adaptive / 1e6);
        EXPECT_GT(r.properties.peak_stress_Pa / adaptive, 0.99);
        EXPECT_LT(r.properties.peak_stress_Pa / adaptive, 1.06);
    }
}

}  // namespace
}  // namespace feldspar
