// Samples of each distribution against its closed-form moments, and the sieve curve against the areas that come out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "feldspar/base/error.hpp"
#include "feldspar/specimen/grain_sizes.hpp"
#include "sample_specimens.hpp"

namespace feldspar {
namespace {

constexpr int many = 200000;

GrainSizeSpec log_normal() {
    GrainSizeSpec spec;
    spec.kind = GrainSizeKind::log_normal;
    spec.median_m = 0.003;
    spec.log_standard_deviation = 0.4;
    spec.minimum_m = 0.001;
    spec.maximum_m = 0.005;
    return spec;
}

GrainSizeSpec sieve() {
    GrainSizeSpec spec;
    spec.kind = GrainSizeKind::sieve;
    spec.sieve = {{0.001, 0.0}, {0.002, 0.3}, {0.003, 0.3}, {0.004, 0.9}, {0.006, 1.0}};
    return spec;
}

/// The mean must lie within four standard errors of the closed form, and so must the mean square.
void expect_moments(const GrainSizeSpec& spec, const char* stream) {
    RandomStream random(1, stream);
    const auto d = sample_diameters(spec, many, random);
    double sum = 0.0, sum2 = 0.0, sum4 = 0.0;
    for (const double x : d) {
        sum += x;
        sum2 += x * x;
        sum4 += x * x * x * x;
    }
    const double mean = sum / many, square = sum2 / many;
    const DiameterMoments moments = diameter_moments(spec);
    EXPECT_NEAR(mean, moments.mean_m, 4.0 * std::sqrt((square - mean * mean) / many));
    EXPECT_NEAR(square, moments.mean_square_m2, 4.0 * std::sqrt((sum4 / many - square * square) / many));
}

TEST(GrainSizes, UniformMoments) {
    const GrainSizeSpec spec = rectangle().grain_sizes;
    expect_moments(spec, "uniform");
    EXPECT_DOUBLE_EQ(diameter_moments(spec).mean_m, 0.003);
    EXPECT_NEAR(diameter_moments(spec).mean_square_m2, 28e-6 / 3.0, 1e-18);
}

TEST(GrainSizes, LogNormalMomentsAndBounds) {
    expect_moments(log_normal(), "log-normal");
    RandomStream random(2, "log-normal");
    const auto d = sample_diameters(log_normal(), many, random);
    EXPECT_GE(*std::min_element(d.begin(), d.end()), 0.001);
    EXPECT_LE(*std::max_element(d.begin(), d.end()), 0.005);
}

TEST(GrainSizes, LogNormalMedianWithoutMuchTruncation) {
    GrainSizeSpec spec = log_normal();
    spec.minimum_m = 0.003 * std::exp(-2.4);  // six standard deviations either way
    spec.maximum_m = 0.003 * std::exp(2.4);
    RandomStream random(3, "log-normal");
    auto d = sample_diameters(spec, many, random);
    std::nth_element(d.begin(), d.begin() + many / 2, d.end());
    EXPECT_NEAR(d[many / 2], 0.003, 0.003 * 0.4 * 1.2533 * 4.0 / std::sqrt(many));
    EXPECT_NEAR(diameter_moments(spec).mean_m, 0.003 * std::exp(0.08), 1e-9);
}

TEST(GrainSizes, LogNormalInTheUpperTail) {
    GrainSizeSpec spec = log_normal();
    spec.minimum_m = 0.008;
    spec.maximum_m = 0.016;
    expect_moments(spec, "tail");
}

TEST(GrainSizes, SieveCurveComesOutAsAreaFractions) {
    expect_moments(sieve(), "sieve");
    RandomStream random(4, "sieve");
    const auto d = sample_diameters(sieve(), many, random);
    double area = 0.0;
    for (const double x : d) area += x * x;
    const auto passing = [&](double size) {
        double finer = 0.0;
        for (const double x : d) finer += x <= size ? x * x : 0.0;
        return finer / area;
    };
    for (const SievePoint point : sieve().sieve) EXPECT_NEAR(passing(point.diameter_m), point.passing, 0.01) << point.diameter_m;
    EXPECT_NEAR(passing(std::sqrt(0.003 * 0.004)), 0.6, 0.01) << "half-way in ln d";
}

TEST(GrainSizes, CountingDiameter) {
    EXPECT_DOUBLE_EQ(counting_diameter(rectangle().grain_sizes), 0.003);
    const DiameterMoments moments = diameter_moments(sieve());
    EXPECT_DOUBLE_EQ(counting_diameter(sieve()), std::sqrt(moments.mean_square_m2));
}

TEST(GrainSizes, OneStreamGivesTheSameNumbersAgain) {
    RandomStream first(5, "sizes"), second(5, "sizes"), other(6, "sizes");
    const auto spec = rectangle().grain_sizes;
    const auto a = sample_diameters(spec, 100, first);
    EXPECT_EQ(a, sample_diameters(spec, 100, second));
    EXPECT_NE(a, sample_diameters(spec, 100, other));
}

TEST(GrainSizes, ImpossibleDistributionsAreRefused) {
    const auto refused = [](GrainSizeSpec spec) { EXPECT_THROW(check_grain_sizes(spec), InputError); };
    GrainSizeSpec uniform = rectangle().grain_sizes;
    uniform.minimum_m = 0.0;
    refused(uniform);
    uniform.minimum_m = 0.005;
    refused(uniform);
    GrainSizeSpec ln = log_normal();
    ln.log_standard_deviation = 0.0;
    refused(ln);
    ln = log_normal();
    ln.median_m = 1.0;  // nothing left between the bounds
    refused(ln);
    GrainSizeSpec curve = sieve();
    curve.sieve.back().passing = 0.99;
    refused(curve);
    curve = sieve();
    curve.sieve[2].passing = 0.2;
    refused(curve);
    curve = sieve();
    curve.sieve.resize(1);
    refused(curve);
}

TEST(GrainSizes, ALongTailOfASieveCurveHoldsNoGrains) {
    EXPECT_EQ(largest_of_sieve_m({{0.001, 0.0}, {0.002, 1.0}, {0.05, 1.0}}), 0.002);
    EXPECT_EQ(largest_of_sieve_m({{0.001, 0.0}, {0.002, 0.5}, {0.05, 1.0}}), 0.05);
}

TEST(GrainSizes, AFewGrainsOfAWideDistributionHaveTheAreaAskedFor) {
    // one grain of 16 mm has the area of a thousand of 0.5 mm: random samples miss the area by half
    GrainSizeSpec wide;
    wide.kind = GrainSizeKind::sieve;
    wide.sieve = {{0.0005, 0.0}, {0.0016, 0.1}, {0.003, 0.3}, {0.008, 0.7}, {0.016, 1.0}};
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        RandomStream random(seed, "wide");
        double squares = 0.0;
        for (const double d : sample_diameters(wide, 1270, random)) squares += d * d;
        EXPECT_NEAR(squares / (1270 * diameter_moments(wide).mean_square_m2), 1.0, 0.1) << seed;
    }
}

}  // namespace
}  // namespace feldspar
