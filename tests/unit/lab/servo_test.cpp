// The servo on rows made up for it: travel time 400 steps, rows every 10 steps, platens at 0.4 mm.
#include "feldspar/lab/servo.hpp"

#include <gtest/gtest.h>

using namespace feldspar;

namespace {

constexpr double kShare = 0.01, kTravelTime = 400.0, kTravel = 4e-4, kElastic = 2.0;
constexpr int kBlock = 10;
constexpr double kForward = kShare * kTravel / kTravelTime;          // of a body in which nothing fails
constexpr double kLimit = kShare * kElastic / kTravelTime * kBlock;  // J between two rows

HistoryRow dissipated(double fracture, double friction = 0.0) {
    HistoryRow row;
    row.energy.elastic_grains = 0.75 * kElastic;
    row.energy.elastic_contacts = 0.25 * kElastic;
    row.energy.fracture = fracture;
    row.energy.friction = friction;
    return row;
}

// So many travel times at this share of the limit.
Servo after(double limits, int rows = 400) {
    Servo servo(LoadControl::dissipation, kShare, kTravelTime);
    for (int i = 0; i < rows; ++i) servo.observe(dissipated(0.5 * limits * kLimit * i, 0.5 * limits * kLimit * i), kBlock);
    return servo;
}

}  // namespace

TEST(Servo, IsOffWithDisplacementControl) {
    EXPECT_FALSE(Servo(LoadControl::displacement, kShare, kTravelTime).on());
    EXPECT_TRUE(Servo(LoadControl::dissipation, kShare, kTravelTime).on());
    EXPECT_TRUE(Servo(LoadControl::lateral_strain, kShare, kTravelTime).on());
    EXPECT_FALSE(Servo(LoadControl::displacement, kShare, kTravelTime).unloading());
}

TEST(Servo, PlatenRestsWhereTheDissipationIsAtItsLimit) {
    EXPECT_NEAR(after(1.0).speed(kTravel) / kForward, 0.0, 1e-9);
    EXPECT_NEAR(after(0.0).speed(kTravel) / kForward, 1.0, 1e-9);
    EXPECT_NEAR(after(0.5).speed(kTravel) / kForward, 0.5, 1e-9) << "fracture and friction count alike";
    EXPECT_NEAR(after(2.0).speed(kTravel) / kForward, -1.0, 1e-9);
}

TEST(Servo, ArrestsWhatFailsAlreadyBelowItsLimit) {
    EXPECT_NEAR(after(0.0).arrest(kTravel), 0.0, 1e-20);
    EXPECT_NEAR(after(0.25).arrest(kTravel) / kForward, 2.0, 1e-9);
    EXPECT_NEAR(after(0.5).arrest(kTravel) / kForward, 4.0, 1e-9) << "as fast as it may";
    EXPECT_NEAR(after(5.0).arrest(kTravel) / kForward, 4.0, 1e-9);
}

TEST(Servo, GoesBackAtFourTimesItsForwardSpeedAtMost) { EXPECT_NEAR(after(50.0).speed(kTravel) / kForward, -4.0, 1e-9); }

TEST(Servo, HowFarItGoesBackForABurstDoesNotDependOnTheSmoothing) {
    // A burst of 30 limits within one row, then nothing: the platen loses in all as much travel as it would have won in 30 rows.
    Servo servo(LoadControl::dissipation, kShare, kTravelTime);
    double travel = 0.0, spent = 0.0;
    servo.observe(dissipated(spent), kBlock);
    constexpr int kRows = 200;
    for (int i = 0; i < kRows; ++i) {
        if (i == 50) spent += 12.0 * kLimit;  // smoothed over four rows: 3 limits, so the bound of -4 is not reached
        servo.observe(dissipated(spent), kBlock);
        travel += servo.speed(kTravel) * kBlock;
    }
    EXPECT_NEAR(travel / (kForward * kBlock), kRows - 12.0, 0.01);
}

TEST(Servo, LateralStrainMayGrowByItsShareInATravelTime) {
    const auto after_growth = [](double limits) {
        Servo servo(LoadControl::lateral_strain, kShare, kTravelTime);
        HistoryRow row;
        row.lateral_strain_gauge = -1e-3;  // where loading began: of an isotropic stress, say
        servo.observe(row, kBlock);
        double widening = 2e-3;
        for (int i = 0; i < 400; ++i) {
            row.lateral_strain_gauge = -1e-3 - widening;
            servo.observe(row, kBlock);
            widening *= 1.0 + limits * kShare * kBlock / kTravelTime;
        }
        return servo.speed(kTravel) / kForward;
    };
    EXPECT_NEAR(after_growth(0.0), 1.0, 1e-9);
    EXPECT_NEAR(after_growth(1.0), 0.0, 1e-3);  // growth is taken over the widening at the end of a row: a 4000th less
    EXPECT_NEAR(after_growth(2.0), -1.0, 2e-3);
}

TEST(Servo, AnUnloadedBodyIsNotAFailedOne) {
    EXPECT_TRUE(after(0.0).unloading()) << "its stress is low because the platen went back";
    EXPECT_FALSE(after(1.0).unloading());
    EXPECT_FALSE(after(3.0).unloading());
}
