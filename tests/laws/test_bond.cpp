// Properties that every contact law must have, looped over the laws. Closed forms of each are checks of verify/contact_laws.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../table7.hpp"
#include "feldspar/base/rng.hpp"
#include "feldspar/laws/bond.hpp"
#include "feldspar/laws/dilation.hpp"
#include "feldspar/verify/dilating_point.hpp"

namespace feldspar {
namespace {

constexpr double kArea = 8e-5;

ContactMaterial material(ContactLaw law) {
    ContactMaterial m = fixtures::table7();
    m.law = law;
    return m;
}

class EveryLaw : public testing::TestWithParam<ContactLaw> {};
INSTANTIATE_TEST_SUITE_P(Laws, EveryLaw,
                         testing::Values(ContactLaw::bilinear, ContactLaw::bilinear_literal, ContactLaw::linear,
                                         ContactLaw::brittle),
                         [](const auto& tested) {
                             std::string text = name(tested.param);
                             std::erase(text, '-');
                             return text;
                         });

TEST_P(EveryLaw, WorkIsStoredOrDissipatedAndNeitherIsEverNegative) {
    RandomStream random(3, "law walk");
    const BondLaw law = BondLaw::make(material(GetParam()));
    for (int walk = 0; walk < 50; ++walk) {
        BondState s;
        double work = 0.0, scale = 0.0, un_trend = random.uniform(-1.0, 1.5), us_trend = random.uniform(-1.0, 1.0);
        for (int k = 0; k < 2000; ++k) {
            const double dun = 1e-9 * (un_trend + 4.0 * random.normal()), dus = 3e-8 * (us_trend + 2.0 * random.normal());
            const BondState before = s;
            update_bond(law, kArea, dun, dus, s);
            work -= 0.5 * (before.Fn_N + s.Fn_N) * dun + 0.5 * (before.Fs_N + s.Fs_N) * dus;
            scale = std::max(scale, std::abs(work));
            ASSERT_GE(s.damage, before.damage);
            ASSERT_LE(s.damage, 1.0);
            // The trapezoidal account of one increment may lose up to the energy of the increment itself when sliding reverses.
            ASSERT_GE(s.friction_J, before.friction_J - law.Ks_Pa_m * kArea * dus * dus - 1e-15);
        }
        // The account is an identity: it must close to rounding.
        EXPECT_NEAR(work, elastic_energy(law, kArea, s) + s.fracture_J + s.friction_J, 1e-9 * scale + 1e-15);
        EXPECT_GE(s.fracture_J + s.friction_J, -1e-6 * scale);
    }
}

TEST_P(EveryLaw, NeverExceedsItsLimits) {
    RandomStream random(4, "law limits");
    const BondLaw law = BondLaw::make(material(GetParam()));
    BondState s;
    for (int k = 0; k < 20000; ++k) {
        if (k % 2000 == 0) s = {};
        update_bond(law, kArea, 2e-9 * random.normal(), 5e-8 * random.normal(), s);
        EXPECT_GE(s.Fn_N, -(1.0 - s.damage) * law.sigma_nt_Pa * kArea * (1.0 + 1e-9));
        EXPECT_LE(std::abs(s.Fs_N), ((1.0 - s.damage) * law.tau_Pa * kArea + law.mu * std::max(s.Fn_N, 0.0)) * (1.0 + 1e-9));
    }
}

TEST(BondLaw, ShearMeasureBeyondFrictionDelaysDamageUnderPressure) {
    ContactMaterial m = material(ContactLaw::bilinear);
    const auto damage_after_shear = [&](ShearMeasure measure) {
        m.shear_measure = measure;
        const BondLaw law = BondLaw::make(m);
        BondState s;
        update_bond(law, kArea, -3e-7, 0.0, s);  // 54 MPa of compression
        for (int k = 0; k < 1000; ++k) update_bond(law, kArea, 0.0, 8e-10, s);
        return s.damage;
    };
    EXPECT_GT(damage_after_shear(ShearMeasure::total), 0.0);
    EXPECT_EQ(damage_after_shear(ShearMeasure::beyond_friction), 0.0);
}

TEST(Softening, WithoutEnergyToSoftenTheDirectionIsBrittle) {
    EXPECT_TRUE(SofteningEnvelope::make(ContactLaw::bilinear, 8.5e6, 18e13, 0.19).brittle);  // 2 G / F below F / k
    EXPECT_FALSE(SofteningEnvelope::make(ContactLaw::bilinear, 8.5e6, 18e13, 0.21).brittle);
}

// ---------------------------------------------------------------------------------------------------------------------- dilation

using bodies::kLimit, bodies::kTanPsi, bodies::shear;

TEST(Dilation, StopsWithinAStepAtItsLimitAndWorksBothWays) {
    // Steps of any size leave the same opening, since the step in which the limit is reached is divided there.
    const double fine = shear(3.0 * kLimit, 2e9, 6000).opening_m, coarse = shear(3.0 * kLimit, 2e9, 7).opening_m;
    EXPECT_NEAR(coarse / fine, 1.0, 1e-3);
    const BondLaw law = BondLaw::make(fixtures::table7());
    const Dilation d{kTanPsi, kLimit};
    BondState s;
    s.damage = 1.0;
    s.un_m = -1e-7;
    s.Fn_N = law.Kn_Pa_m * kArea * 1e-7;
    double slip = 0.0;
    slide_with_dilation(law, d, kArea, 0.0, 1e-5, s, slip);
    const double there = slip;
    EXPECT_GT(there, 0.0);
    slide_with_dilation(law, d, kArea, 0.0, -3e-5, s, slip);
    EXPECT_GT(slip, there) << "slip back counts too";
    slide_with_dilation(law, d, kArea, 1e-4, 1e-5, s, slip);
    EXPECT_EQ(s.Fn_N, 0.0);
    EXPECT_EQ(s.Fs_N, 0.0) << "open faces carry nothing";
}

// Without dilation the step is that of broken points.
TEST(Dilation, OfNoAngleIsCoulombsFriction) {
    const BondLaw law = BondLaw::make(fixtures::table7());
    RandomStream random(1, "dilation");
    BondState a, b;
    a.damage = b.damage = 1.0;
    double slip = 0.0;
    for (int k = 0; k < 2000; ++k) {
        const double dun = 2e-8 * (random.uniform() - 0.52), dus = 1e-7 * (random.uniform() - 0.5);
        update_bond(law, kArea, dun, dus, a);
        slide_with_dilation(law, {0.0, 1.0}, kArea, dun, dus, b, slip);
        EXPECT_EQ(a.un_m, b.un_m);
        EXPECT_EQ(a.Fn_N, b.Fn_N);
        EXPECT_EQ(a.Fs_N, b.Fs_N);
        EXPECT_NEAR(a.friction_J, b.friction_J, 1e-9 * std::abs(a.friction_J) + 1e-18);
        EXPECT_NEAR(a.fracture_J, b.fracture_J, 1e-9 * std::abs(a.fracture_J) + 1e-18);
    }
}

}  // namespace
}  // namespace feldspar
