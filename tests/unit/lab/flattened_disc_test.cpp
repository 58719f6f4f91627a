// (P31): the coefficient of a flattened disc, against what is published and against finite elements.
#include "feldspar/methods/flattened_disc.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "feldspar/lab/disc_splitting.hpp"
#include "synthetic_records.hpp"

namespace feldspar {
namespace {

double k(double degrees, FlatLoading loading) { return flat_coefficient(degrees * std::numbers::pi / 180.0, loading); }

// Finite elements of the disc between rigid and yielding plates: 864 quadrilaterals of nine nodes on a quarter, nu 0.23. The
// tolerance is what the fits leave.
TEST(FlattenedDisc, IsThatOfFiniteElementsForEveryPlate) {
    struct Case {
        double degrees, hardness, eta, mu, expected;
    };
    for (const Case& c : {Case{10, 0, 0, 0, 0.9910},    {20, 0, 0, 0, 0.9643},         {30, 0, 0, 0, 0.9203},
                          {40, 0, 0, 0, 0.8607},        {10, 1e4, 0, 0, 0.9847},       {20, 1e4, 0, 0, 0.9399},
                          {30, 1e4, 0, 0, 0.8694},      {40, 1e4, 0, 0, 0.7798},       {20, 0.43, 0, 0, 0.9606},
                          {20, 48, 0, 0, 0.9419},       {20, 0.43, 0.28, 0.4, 0.9566}, {20, 0.43, 1, 0.4, 0.9494},
                          {20, 48, 0.28, 0.05, 0.9371}, {20, 48, 0.28, 0.2, 0.9240},   {20, 48, 0.28, 0.4, 0.9155},
                          {20, 48, 0.28, 1e9, 0.9145},  {10, 1e3, 0.28, 0.4, 0.9681},  {30, 1e3, 0.28, 0.4, 0.8396},
                          {40, 1e3, 0.28, 0.4, 0.7547}, {30, 0.43, 0.28, 0.4, 0.9076}})
        EXPECT_NEAR(k(c.degrees, {c.hardness, c.eta, c.mu}), c.expected, 2e-3)
            << c.degrees << " degrees, hardness " << c.hardness << ", mu " << c.mu;
}

// How hard the plate is goes by the modulus of the disc: of plane strain E / (1 - nu^2), of rigid grains what their contacts
// make.
TEST(FlattenedDisc, ThePlateIsAsHardAsTheDiscIsSoft) {
    Specimen specimen;
    specimen.spec.outline.flat_angle_rad = 20.0 * std::numbers::pi / 180.0;
    specimen.outline.radius_m = 0.04;
    specimen.quality.mean_diameter_m = 0.003;
    const GrainMaterial grain{40e9, 0.4, 2650.0};
    ContactMaterial contact;
    contact.Kn_Pa_m = 2e13;
    contact.eta = 0.28;
    TestSpec test;
    test.plate_Kn_Pa_m = 3e12;
    test.plate_mu = 0.3;
    const double half_width = 0.04 * std::sin(10.0 * std::numbers::pi / 180.0);
    const auto expect = [&](GrainKind kind, PlaneState plane, double E_Pa) {
        ModelSpec model;
        model.kind = kind;
        model.plane = plane;
        EXPECT_NEAR(flat_coefficient(specimen, model, grain, contact, test), k(20.0, {3e12 * half_width / E_Pa, 0.28, 0.3}),
                    1e-12);
    };
    expect(GrainKind::flexible, PlaneState::stress, 40e9);
    expect(GrainKind::flexible, PlaneState::strain, 40e9 / 0.84);
    expect(GrainKind::rigid, PlaneState::stress, 2e13 * 0.003);
    specimen.spec.particles_per_grain = 9.0;
    expect(GrainKind::inner_particles, PlaneState::stress, 2e13 * 0.003 / 3.0);
}

TEST(FlattenedDisc, HasLessOfTheLoadInItsCentreTheWiderAndHarderAndRougherItIsPressed) {
    for (double degrees = 10.0; degrees < 40.0; degrees += 1.0) {
        EXPECT_GT(k(degrees, {}), k(degrees + 1.0, {}));
        EXPECT_GT(k(degrees, {0.1, 0.3, 0.4}), k(degrees, {1.0, 0.3, 0.4}));
        EXPECT_GT(k(degrees, {1.0, 0.3, 0.1}), k(degrees, {1.0, 0.3, 0.4}));
    }
}

TEST(FlattenedDisc, IsSplitByAPathOverSixTenthsOfWhatIsLeftOfItsDiameter) {
    const LoadedDisc whole{{0.0, 0.0}, 0.04, 0.003}, flattened{{0.0, 0.0}, 0.04, 0.003, 0.03};
    SplittingCrack a(whole), b(flattened);
    for (const Crack& c : synthetic::path({{0.0, -0.019}, {0.0, 0.019}}, 0)) {  // 38 mm: 0.475 of 80 mm, 0.633 of 60 mm
        a.add(c);
        b.add(c);
    }
    EXPECT_FALSE(a.split());
    EXPECT_TRUE(b.split());
    EXPECT_NEAR(b.span(), 38.0 / 60.0, 1e-9);
}

}  // namespace
}  // namespace feldspar
