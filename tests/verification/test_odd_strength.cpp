// What a test says of itself when nothing broke, when contacts cannot break, and when all went as usual (lab/odd_strength.hpp).
#include <gtest/gtest.h>

#include <algorithm>

#include "feldspar/lab/odd_strength.hpp"
#include "feldspar/lab/scaling_rules.hpp"
#include "fixtures.hpp"

using namespace feldspar;

namespace {

// A small column of the granite of Table 7, quickly.
TestSetup column() {
    TestSetup s = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04)), methods::uniaxial_compression);
    s.numerics.accuracy = 0.02;
    s.test.stop_fraction = 0.94;
    return s;
}

bool says(const TestResult& result, const std::string& words) {
    return std::any_of(result.properties.remarks.begin(), result.properties.remarks.end(),
                       [&](const std::string& remark) { return remark.find(words) != std::string::npos; });
}

std::string all(const TestResult& result) {
    std::string text;
    for (const std::string& remark : result.properties.remarks) text += remark + "\n";
    return text;
}

}  // namespace

TEST(OddStrength, AStressThatBreaksNothingIsExplained) {
    TestSetup s = column();
    s.test.maximum_stress_Pa = 12e6;  // a tenth of the strength
    const TestResult result = run_test(s, {});
    ASSERT_TRUE(result.cracks.empty());
    EXPECT_FALSE(result.properties.peak_reached);
    EXPECT_TRUE(says(result, "Nothing broke: the stress has reached its maximum of 12 MPa.")) << all(result);
    EXPECT_TRUE(says(result, "The contact nearest to failure, at (")) << all(result);
    EXPECT_TRUE(says(result, "By the scaling rules such contacts bear about ")) << all(result);
    // its grains are pushed apart on their way to a strength of about 120 MPa: the nearest contact is on its way, and whole
    EXPECT_GT(result.nearest.share, 0.1);
    EXPECT_LT(result.nearest.share, 1.0);
    EXPECT_EQ(result.nearest.damage, 0.0);
    EXPECT_GE(result.nearest.place.x, -0.02);
    EXPECT_LE(result.nearest.place.y, 0.04);
    EXPECT_TRUE(says(result, " % of its strength in ")) << all(result);
    s.test.maximum_stress_Pa = 30e6;  // softening begins a good while before the first crack
    const TestResult softened = run_test(s, {});
    ASSERT_TRUE(softened.cracks.empty());
    EXPECT_GT(softened.nearest.damage, 0.0);
    EXPECT_EQ(softened.nearest.share, 1.0);
    EXPECT_TRUE(says(softened, " of its strength there was gone.")) << all(softened);
    TestResult gone = softened;
    gone.nearest.damage = 0.998;
    gone.properties.remarks = why_odd(gone, gone.properties);
    EXPECT_TRUE(says(gone, ": 100 % of its strength there was gone.")) << all(gone);  // two digits, and no 1e+02
}

TEST(OddStrength, AStrainThatBreaksNothingIsExplained) {
    TestSetup s = column();
    s.test.maximum_strain = 5e-4;  // 12 MPa
    const TestResult result = run_test(s, {});
    ASSERT_TRUE(result.cracks.empty());
    EXPECT_TRUE(says(result, "Nothing broke: the axial strain has reached its maximum of 0.0005.")) << all(result);
}

TEST(OddStrength, TheShareGrowsWithTheLoad) {
    double before = 0.0;
    for (const double stress_Pa : {4e6, 8e6, 16e6}) {
        TestSetup s = column();
        s.test.maximum_stress_Pa = stress_Pa;
        const TestResult result = run_test(s, {});
        // elastic: in proportion to the load, to the row at which the test ends (a fiftieth of the load)
        if (before > 0.0 && result.nearest.damage == 0.0) {
            EXPECT_NEAR(result.nearest.share / before, 2.0, 0.15);
        }
        before = result.nearest.share;
    }
}

TEST(OddStrength, ContactsThatCannotBreakBrittlyAreNamed) {
    TestSetup s = column();
    s.contact.Gfn_J_m2 = 5000.0;
    s.test.maximum_strain = 4e-3;
    const TestResult result = run_test(s, {});
    EXPECT_TRUE(says(result, "Gfn = 5000 N/m makes contacts that cannot break brittly")) << all(result);
    EXPECT_TRUE(says(result, "12 to 38 N/m")) << all(result);
    EXPECT_NEAR(softening_over_grain(result),
                s.grain.E_Pa * 5000.0 / (s.contact.sigma_nt_Pa * s.contact.sigma_nt_Pa) / s.specimen->quality.mean_diameter_m,
                1e-9);
}

TEST(OddStrength, AnOrdinaryTestSaysNothing) {
    const MethodId kinds[] = {methods::uniaxial_compression, methods::direct_tension};
    for (const MethodId kind : kinds) {
        TestSetup s = column();
        s.test = usual_test(kind);
        s.test.stop_fraction = 0.94;
        const TestResult result = run_test(s, {});
        ASSERT_TRUE(result.properties.peak_reached);
        EXPECT_TRUE(why_odd(result, result.properties).empty()) << all(result);
    }
}

TEST(OddStrength, ContactsThatAreWeakFromTheStartFailEarly) {
    TestSetup s = column();
    const TestResult usual = run_test(s, {});
    TestResult early = usual;  // the same record, of contacts of which more is expected
    early.contact.sigma_nt_Pa *= 4.0;
    early.contact.tau_Pa *= 4.0;
    early.contact.Gfn_J_m2 *= 16.0;
    early.contact.Gfs_J_m2 *= 16.0;
    const std::vector<std::string> why = why_odd(early, early.properties);
    ASSERT_EQ(why.size(), 1u);
    EXPECT_NE(why.front().find("It failed early"), std::string::npos) << why.front();
    EXPECT_NE(why.front().find("the first crack, in "), std::string::npos) << why.front();
    early.rock.initial_cracks.broken = 0.2;  // nothing is expected of a rock that is broken before the test
    EXPECT_TRUE(why_odd(early, early.properties).empty());
}
