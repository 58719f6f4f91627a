// When a disc is split, on crack patterns drawn by hand: a disc of 80 mm, grains of 3 mm.
#include "feldspar/lab/disc_splitting.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "feldspar/lab/brazilian_failure.hpp"
#include "feldspar/lab/properties.hpp"
#include "synthetic_records.hpp"

namespace feldspar {
namespace {

using namespace synthetic;

SplittingCrack searched(const std::vector<Crack>& cracks) {
    SplittingCrack splitting({{0.0, 0.0}, disc_radius, disc_grain});
    for (const Crack& c : cracks) splitting.add(c);
    return splitting;
}

std::vector<Crack> both(std::vector<Crack> a, const std::vector<Crack>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

TEST(SplittingCrack, AStraightPathSplitsTheDiscWhenItReachesSixTenthsOfTheDiameter) {
    // from -24 to 24 mm in 1.5 mm: 32 cracks; the 32nd completes 48 mm = 0.6 D
    const SplittingCrack splitting = searched(path({{0.0, -0.024}, {0.0, 0.0241}}, 100));
    ASSERT_TRUE(splitting.split());
    EXPECT_EQ(*splitting.split_step(), 131);
    EXPECT_EQ(splitting.begin()->step, 100);
    EXPECT_NEAR(splitting.span(), 0.601, 2e-3) << "the ends are where they were drawn";
    EXPECT_FALSE(searched(path({{0.0, -0.024}, {0.0, 0.0235}}, 100)).split()) << "0.594 of the diameter";
}

TEST(SplittingCrack, TwoHalvesThatDoNotMeetDoNotSplitIt) {
    const auto lower = path({{0.0, -0.030}, {0.0, -0.0005}}, 0), upper = path({{0.0, 0.0005}, {0.0, 0.030}}, 100);
    EXPECT_FALSE(searched(both(lower, upper)).split()) << "1 mm between them, more than a quarter of a grain";
    EXPECT_NEAR(searched(both(lower, upper)).span(), 29.5 / 80.0, 1e-9);
    const auto bridge = path({{0.0, -0.0005}, {0.0, 0.0005}}, 500);
    const SplittingCrack splitting = searched(both(both(lower, upper), bridge));
    ASSERT_TRUE(splitting.split());
    EXPECT_EQ(*splitting.split_step(), 500) << "the crack that joins them";
    EXPECT_EQ(splitting.begin()->step, 0) << "the earliest of both halves";
    EXPECT_TRUE(searched(both(path({{0.0, -0.030}, {0.0, 0.0}}, 0), path({{0.0006, 0.0}, {0.0006, 0.030}}, 100))).split())
        << "a fifth of a grain apart: an end point between them holds still";
}

TEST(SplittingCrack, CracksBesideThePlatesDoNotSplitIt) {
    auto cracks = both(path({{-0.008, 0.036}, {0.008, 0.036}}, 0), path({{-0.008, -0.036}, {0.008, -0.036}}, 100));
    cracks = both(cracks, both(path({{0.0, 0.028}, {0.0, 0.038}}, 200), path({{0.0, -0.038}, {0.0, -0.028}}, 300)));
    const SplittingCrack splitting = searched(cracks);
    EXPECT_FALSE(splitting.split());
    EXPECT_LT(splitting.span(), 0.2);
    EXPECT_EQ(splitting.begin()->step, 0);
}

TEST(SplittingCrack, APathOutsideTheCentralBandDoesNotSplitIt) {
    EXPECT_FALSE(searched(path({{0.012, -0.030}, {0.012, 0.030}}, 0)).split()) << "the band is 8 mm to either side";
    EXPECT_TRUE(searched(path({{0.007, -0.030}, {0.007, 0.030}}, 0)).split());
    EXPECT_FALSE(searched(path({{0.0, -0.030}, {0.0, -0.002}, {0.014, 0.0}, {0.0, 0.002}, {0.0, 0.030}}, 0)).split())
        << "leaves the band between its halves";
    EXPECT_EQ(searched(path({{0.012, -0.030}, {0.012, 0.030}}, 0)).begin(), std::nullopt);
    // coarse grains widen the band: two grains of 6 mm
    EXPECT_DOUBLE_EQ((LoadedDisc{{0.0, 0.0}, disc_radius, 0.006}).band_half_width_m(), 0.012);
}

TEST(SplittingCrack, APathThatWandersSplitsItAndBranchesDoNotMatter) {
    const auto zigzag = path({{0.0, -0.026}, {0.005, -0.016}, {-0.006, -0.004}, {0.004, 0.010}, {0.0, 0.026}}, 0);
    EXPECT_TRUE(searched(zigzag).split());
    const auto branch = path({{0.005, -0.016}, {0.030, -0.014}}, 500);
    EXPECT_TRUE(searched(both(branch, zigzag)).split());
    EXPECT_FALSE(searched(path({{-0.007, 0.0}, {0.007, 0.0}}, 0)).split()) << "as long as it is, it lies across";
}

TEST(SplittingCrack, TwoCracksOnOneLineWithAGapBetweenThemDoNotCross) {
    const auto lower = path({{0.0, -0.030}, {0.0, -0.0005}}, 0), upper = path({{0.0002, 0.0005}, {-0.0001, 0.030}}, 100);
    EXPECT_FALSE(searched(both(lower, upper)).split()) << "the line of one meets the other; the cracks are 1 mm apart";
}

TEST(SplittingCrack, TheOrderOfCracksWithinAStepDoesNotMatter) {
    auto cracks = path({{0.0, -0.026}, {0.005, -0.016}, {-0.006, -0.004}, {0.004, 0.010}, {0.0, 0.026}}, 0);
    for (Crack& c : cracks) c.step = c.step / 20;  // many at once
    const SplittingCrack one = searched(cracks);
    std::stable_sort(cracks.begin(), cracks.end(),
                     [](const Crack& a, const Crack& b) { return a.step != b.step ? a.step < b.step : a.place.x > b.place.x; });
    const SplittingCrack other = searched(cracks);
    EXPECT_EQ(one.split_step(), other.split_step());
    EXPECT_EQ(one.begin()->step, other.begin()->step);
    EXPECT_DOUBLE_EQ(one.span(), other.span());
}

// (P1): a dip at 6.2, a higher stress at 9 while the disc splits, and a still higher one when its halves carry load again.
TEST(BrazilianStrength, IsTheLargestStressUntilTheDiscIsSplit) {
    TestResult r = disc_record({1e6, 4e6, 6.2e6, 5e6, 7e6, 9e6, 8.9e6, 4e6, 11e6});
    r.cracks = path({{0.0, 0.036}, {0.0, 0.038}}, 25);  // beside the plate, early
    for (Crack& c : path({{0.0, -0.026}, {0.0, 0.026}}, 61)) {
        c.step = 61;
        r.cracks.push_back(c);
    }
    const TestProperties p = measure(r);
    EXPECT_DOUBLE_EQ(p.peak_stress_Pa, 9e6);
    EXPECT_TRUE(p.peak_reached);
    EXPECT_TRUE(p.brazilian.split);
    EXPECT_FALSE(p.brazilian.valid) << "all at once: the first of the list counts, at -25.25 mm, r/R 0.63";
    EXPECT_NEAR(p.brazilian.splitting_radius, 25.25 / 40.0, 0.01);
    EXPECT_DOUBLE_EQ(p.brazilian.first_dip_Pa, 6.2e6);
    EXPECT_DOUBLE_EQ(p.brazilian.largest_Pa, 11e6);
}

TEST(BrazilianStrength, IsALowerBoundWhileTheDiscIsWhole) {
    TestResult r = disc_record({1e6, 4e6, 6.2e6, 5e6, 7e6, 9e6, 4e6});
    r.cracks = path({{0.0, -0.026}, {0.0, 0.0}}, 21);
    const TestProperties p = measure(r);
    EXPECT_DOUBLE_EQ(p.peak_stress_Pa, 9e6);
    EXPECT_FALSE(p.peak_reached);
    EXPECT_FALSE(p.brazilian.split);
    EXPECT_FALSE(p.brazilian.valid);
    EXPECT_NEAR(p.brazilian.crack_span, 26.0 / 80.0, 1e-3);
    EXPECT_NE(judge(r).verdict.find("not split"), std::string::npos);
}

TEST(BrazilianStrength, SaysWhereTheFirstCrackAndTheSplittingOneBegan) {
    TestResult r = disc_record({2e6, 4e6, 6e6, 8e6, 3e6});
    Crack beside = path({{0.010, 0.034}, {0.0105, 0.034}}, 11).front();  // in no path
    beside.axial_stress_Pa = 4e6;
    std::vector<Crack> from_centre = path({{0.0, -0.001}, {0.0, 0.001}}, 21);
    for (Crack& c : from_centre) c.axial_stress_Pa = 6e6;
    r.cracks = both({beside}, from_centre);
    for (const auto& half : {path({{0.0, 0.001}, {0.0, 0.030}}, 31), path({{0.0, -0.001}, {0.0, -0.030}}, 31)})
        r.cracks = both(r.cracks, half);
    const BrazilianFailure b = measure(r).brazilian;
    EXPECT_NEAR(b.first_crack_radius, std::hypot(10.25, 34.0) / 40.0, 1e-9);
    EXPECT_NEAR(b.first_crack_angle_deg, std::atan2(10.25, 34.0) * 180.0 / std::acos(-1.0), 1e-9);
    EXPECT_DOUBLE_EQ(b.first_crack_share, 0.5);
    EXPECT_NEAR(b.splitting_radius, 0.0, 0.03);
    EXPECT_DOUBLE_EQ(b.splitting_share, 0.75);
    EXPECT_TRUE(b.valid);
    EXPECT_EQ(judge(r).verdict.find("centre start"), std::string::npos);

    r.cracks =
        both(path({{0.0, 0.038}, {0.0, 0.020}}, 1), r.cracks);  // the same path meets a crack from the plate that came first
    const BrazilianFailure from_plate = measure(r).brazilian;
    EXPECT_GT(from_plate.splitting_radius, 0.9);
    EXPECT_TRUE(from_plate.split);
    EXPECT_FALSE(from_plate.valid);
    EXPECT_NE(judge(r).verdict.find("Not a centre start"), std::string::npos);
}

TEST(BrazilianStrength, ItsMomentsAreMarkedInTheirOrder) {
    TestResult r = disc_record({1e6, 4e6, 6.2e6, 5e6, 7e6, 9e6, 8.9e6, 4e6, 11e6});
    r.cracks = path({{0.0, 0.036}, {0.0, 0.0365}}, 15);
    for (Crack& c : path({{0.0, -0.026}, {0.0, 0.026}}, 45)) {
        c.step = 45 + (c.step - 45) / 3;
        c.axial_stress_Pa = 7e6;
        c.axial_strain = 5e-5;
        r.cracks.push_back(c);
    }
    const std::vector<BrazilianMark> marks = brazilian_marks(r);
    std::vector<std::string> names;
    for (const BrazilianMark& mark : marks) names.push_back(mark.name);
    EXPECT_EQ(names, (std::vector<std::string>{"first crack", "first dip", "start of the splitting crack", "strength",
                                               "largest stress"}));
    EXPECT_EQ(marks[0].crack, 0);
    EXPECT_EQ(marks[1].crack, -1);
    EXPECT_DOUBLE_EQ(marks[1].stress_Pa, 6.2e6);
    EXPECT_DOUBLE_EQ(marks[1].axial_strain, 30e-6) << "its row is at step 30";
    EXPECT_EQ(marks[2].crack, 1) << "the first of the path";
    EXPECT_DOUBLE_EQ(marks[2].stress_Pa, 7e6);
    EXPECT_DOUBLE_EQ(marks[3].stress_Pa, 9e6);
    EXPECT_DOUBLE_EQ(marks[4].stress_Pa, 11e6);
    EXPECT_TRUE(brazilian_marks(linear(methods::uniaxial_compression, 100e6)).empty());
    EXPECT_EQ(brazilian_marks(disc_record({1e6, 2e6})).size(), 2u)
        << "without cracks: the strength, and the dip that is where it is";
}

TEST(BrazilianStrength, SaysWhyATestIsNotValid) {
    BrazilianFailure b;
    EXPECT_EQ(validity_in_words(b), "no: not split");
    b.split = true;
    b.splitting_radius = 0.912;
    EXPECT_EQ(validity_in_words(b), "no: split from r/R 0.91");
    b.valid = true;
    EXPECT_EQ(validity_in_words(b), "yes");
}

TEST(BrazilianStrength, KeepsTheArcsOfContactOfTheRowOfTheStrength) {
    TestResult r = disc_record({2e6, 4e6, 6e6, 8e6, 3e6});
    for (std::size_t i = 0; i < r.history.size(); ++i) {
        r.history[i].contact_arc_top_deg = 1.0 + static_cast<double>(i);
        r.history[i].contact_arc_bottom_deg = 11.0 + static_cast<double>(i);
    }
    EXPECT_DOUBLE_EQ(measure(r).brazilian.contact_arc_top_deg, 4.0);
    EXPECT_DOUBLE_EQ(measure(r).brazilian.contact_arc_bottom_deg, 14.0);
}

// sin(2a)/a - 1 = 1 - 4/3 a^2 + ...; at a right angle of load on either side nothing is left of it but 2/pi * 2 - 1.
TEST(Arcs, TakeTensionFromTheCentre) {
    EXPECT_EQ(tension_under_arcs(0.0), 1.0);
    const double a = 0.5 * 4.0 * std::acos(-1.0) / 180.0;
    EXPECT_NEAR(tension_under_arcs(4.0), 1.0 - 4.0 / 3.0 * a * a, 1e-6);  // the next term is 4/15 a^4 = 4e-7
    EXPECT_NEAR(tension_under_arcs(90.0), 4.0 / std::acos(-1.0) - 1.0, 1e-12);

    TestResult r = disc_record({2e6, 4e6, 6e6, 8e6, 3e6});
    const auto remarks_at = [&](double arc_deg) {
        for (HistoryRow& row : r.history) row.contact_arc_top_deg = row.contact_arc_bottom_deg = arc_deg;
        return measure(r).remarks;
    };
    EXPECT_TRUE(remarks_at(20.0).empty());
    ASSERT_EQ(remarks_at(30.0).size(), 1u);
    EXPECT_NE(remarks_at(30.0).front().find("arcs of 30 degrees: the tension in its centre was down to 0.91"), std::string::npos)
        << remarks_at(30.0).front();
}

}  // namespace
}  // namespace feldspar
