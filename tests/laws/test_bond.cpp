// Properties that every contact law must have, looped over the laws. Closed forms of each are checks of verify/contact_laws.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../table7.hpp"
#include "feldspar/base/rng.hpp"
#include "feldspar/laws/bond.hpp"
#include "feldspar/laws/dilation.hpp"

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

constexpr double kTanPsi = 0.2, kLimit = 1e-4;

// A broken joint under a normal stress, sheared by `reach`. @param stiffness_Pa_m  of what presses it: 0, a constant stress
struct Sheared {
    double opening_m = 0.0, shear_N = 0.0, normal_N = 0.0, work_J = 0.0, slip_m = 0.0, first_slip_u_m = -1.0;
    BondState state;
};

Sheared shear(double reach_m, double stiffness_Pa_m, const Dilation& dilation, int steps = 4000) {
    ContactMaterial m = fixtures::table7();
    m.sigma_nt_Pa = m.tau_Pa = 0.0;
    m.mu = 0.5;
    const BondLaw law = BondLaw::make(m);
    constexpr double kStress = 5e6;
    const double kn = law.Kn_Pa_m * kArea, K = stiffness_Pa_m * kArea;
    Sheared r;
    r.state.damage = 1.0;
    r.state.un_m = -kStress * kArea / kn;
    r.state.Fn_N = kStress * kArea;
    double un = 0.0;  // since then
    for (int k = 0; k < steps; ++k) {
        const double du = reach_m / steps, Fn_before = r.state.Fn_N, Fs_before = r.state.Fs_N;
        // The opening at which what presses it and the joint are in balance: both forces fall or grow with it.
        double low = -1e-5, high = 1e-5;
        BondState after;
        double slip = 0.0, dun = 0.0;
        for (int i = 0; i < 80; ++i) {
            dun = 0.5 * (low + high);
            after = r.state;
            slip = r.slip_m;
            slide_with_dilation(law, dilation, kArea, dun, du, after, slip);
            (after.Fn_N > kStress * kArea + K * (un + dun) ? low : high) = dun;
        }
        if (r.first_slip_u_m < 0.0 && slip > 0.0) r.first_slip_u_m = (k + 1) * du;
        un += dun;
        r.state = after;
        r.slip_m = slip;
        r.work_J -= 0.5 * (Fn_before + after.Fn_N) * dun + 0.5 * (Fs_before + after.Fs_N) * du;
    }
    r.opening_m = un;
    r.shear_N = -r.state.Fs_N;
    r.normal_N = r.state.Fn_N;
    return r;
}

TEST(Dilation, StopsWithinAStepAtItsLimitAndWorksBothWays) {
    // Steps of any size leave the same opening, since the step in which the limit is reached is divided there.
    const double fine = shear(3.0 * kLimit, 2e9, {kTanPsi, kLimit}, 6000).opening_m,
                 coarse = shear(3.0 * kLimit, 2e9, {kTanPsi, kLimit}, 7).opening_m;
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
