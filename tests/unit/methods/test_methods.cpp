// The facts of the test methods agree with each other, and what a job has that says nothing follows from them.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "feldspar/methods/method.hpp"

using namespace feldspar;

TEST(Methods, EveryKindHasItsOwn) {
    std::set<std::string> purposes;
    for (const TestKind kind : test_kinds) {
        EXPECT_EQ(method_of(kind).kind, kind) << name(kind);
        EXPECT_TRUE(purposes.insert(method_of(kind).purpose).second) << name(kind);
    }
    EXPECT_EQ(purposes.size(), test_kinds.size());
}

TEST(Methods, FactsAgree) {
    for (const TestKind kind : test_kinds) {
        const TestMethod& m = method_of(kind);
        SCOPED_TRACE(name(kind));
        EXPECT_EQ(std::abs(m.loading.sign), 1.0);
        EXPECT_FALSE(m.specimen.glued && m.loading.sign > 0.0);                    // what is pressed needs no glue, and what is pulled does
        EXPECT_FALSE(m.specimen.own_disc && m.specimen.confined);                  // a disc has no sides to press on
        EXPECT_FALSE(m.loading.tensile && (m.loading.bends || m.loading.widens));  // columns and dilation are of compression
        EXPECT_LE(m.verdict.imbalance_a, m.verdict.imbalance_b);
        EXPECT_GT(m.rate.residual_target * m.rate.residual_share, 0.0);
        // With R* at its first target the unbalanced part of the error is of the order of the accuracy asked for, in every method.
        EXPECT_GE(m.rate.residual_target * m.rate.residual_share, 1.0 - 1e-12);
        EXPECT_LE(m.rate.residual_target * m.rate.residual_share, 2.0);
    }
}

TEST(Methods, UsualDiscsStandBetweenJawsOnTapeAndFlattenedOnesBetweenPlates) {
    const TestSpec disc = usual_test(TestKind::brazilian), flattened = usual_test(TestKind::brazilian, true), column = usual_test(TestKind::uniaxial_compression);
    EXPECT_EQ(disc.plates, PlateShape::curved);
    EXPECT_EQ(disc.plate_Kn_Pa_m, 1.6e12);
    EXPECT_EQ(flattened.plates, PlateShape::flat);
    EXPECT_EQ(flattened.plate_Kn_Pa_m, std::nullopt);
    EXPECT_EQ(column.plate_Kn_Pa_m, std::nullopt);
}

TEST(Methods, OnlyAdaptiveNumericsFollowTheBranchBehindTheStrength) {
    EXPECT_EQ(usual_control(TestKind::biaxial, true), LoadControl::dissipation);
    EXPECT_EQ(usual_control(TestKind::biaxial, false), LoadControl::displacement);
    EXPECT_EQ(usual_control(TestKind::direct_tension, true), LoadControl::displacement);
}

TEST(Methods, OnlyAPressureConfines) {
    TestSpec test = usual_test(TestKind::biaxial);
    EXPECT_FALSE(is_confined(test));
    test.sigma3_Pa = 1e6;
    EXPECT_TRUE(is_confined(test));
    test.kind = TestKind::uniaxial_compression;
    EXPECT_FALSE(is_confined(test));
}
