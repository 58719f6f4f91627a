// The tables of a test's numbers and of a rock's properties: names that can be told apart, numbers that are given back, tests
// that define them.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "feldspar/lab/rock_properties.hpp"
#include "feldspar/methods/method.hpp"
#include "synthetic_records.hpp"

using namespace feldspar;
using namespace feldspar::synthetic;

namespace {

TestResult broken(MethodId kind) {
    TestResult r = linear(kind, 100e6, 100, kind == methods::direct_tension ? -1.0 : 1.0);
    if (r.cracks.empty()) r.cracks = path({{0.0, -0.01}, {0.0, 0.01}}, 400);
    r.properties = measure(r);
    return r;
}

}  // namespace

TEST(Quantities, HaveNamesOfTheirOwnInEachFile) {
    std::set<std::string> kept, summary, report;
    for (const TestQuantity& q : test_quantities()) {
        const std::string group =
            std::to_string(static_cast<int>(q.group)) + " ";  // summary.json and the report nest some groups
        EXPECT_TRUE(kept.insert(q.kept_name()).second) << q.kept_name();
        EXPECT_TRUE(q.summary == TestQuantity::absent || summary.insert(group + q.summary_name()).second) << q.summary_name();
        EXPECT_TRUE(q.report == TestQuantity::absent || report.insert(group + q.report_name()).second) << q.report_name();
        EXPECT_TRUE(q.ledger != TestQuantity::absent || q.summary != TestQuantity::absent || q.report != TestQuantity::absent)
            << q.name << " is in no file";
    }
}

TEST(Quantities, CarryTheirUnitInTheirName) {
    EXPECT_EQ(test_quantity("E_tangent").kept_name(), "E_tangent_Pa");
    EXPECT_EQ(test_quantity("E_tangent").summary_name(), "E_tangent_GPa");
    EXPECT_EQ(test_quantity("sigma_cd").summary_name(), "sigma_cd_MPa");
    EXPECT_EQ(test_quantity("section_width").summary_name(), "section_width_mm");
    EXPECT_EQ(test_quantity("BTS_first_crack_angle").kept_name(), "BTS_first_crack_angle_deg");
    EXPECT_EQ(test_quantity("nu").summary_name(), "nu");
    EXPECT_EQ(test_quantity("strength").kept_name(), "strength_Pa");
    EXPECT_EQ(test_quantity("strength").summary_name(), "peak_stress_MPa");
    EXPECT_EQ(test_quantity("strength").report_name(), "peak");
    EXPECT_THROW(test_quantity("unheard_of"), std::logic_error);
}

TEST(Quantities, AreGivenBackAsTheyAreKept) {
    for (const MethodId kind : test_methods()) {
        TestResult copy;
        copy.test.kind = kind;
        const TestResult original = broken(kind);
        for (const TestQuantity& q : test_quantities()) q.put(copy, q.value(original));
        for (const TestQuantity& q : test_quantities()) {
            if (q.place.put == nullptr) continue;
            const double before = q.value(original), after = q.value(copy);
            EXPECT_TRUE(before == after || (std::isnan(before) && std::isnan(after))) << q.name << " of " << name(kind);
        }
    }
    TestResult result;
    test_quantity("steps").put(result, std::nan(""));  // a ledger without this column
    EXPECT_EQ(result.steps, 0);
}

TEST(Quantities, AreNumbersOnlyOfTestsThatDefineThem) {
    for (const MethodId kind : test_methods()) {
        const TestResult result = broken(kind);
        for (const TestQuantity& q : test_quantities()) {
            if (q.tests.contains(kind)) continue;
            EXPECT_TRUE(std::isnan(q.value(result))) << q.name << " of " << name(kind);
            if (q.place.form != QuantityForm::real) continue;
            EXPECT_TRUE(std::isnan(q.place.of(result))) << q.name << " of " << name(kind) << ": measure() and the table disagree";
        }
    }
    EXPECT_NEAR(test_quantity("E").value(broken(methods::direct_tension)), E, 1.0);
    EXPECT_EQ(test_quantity("BTS_split").value(broken(methods::brazilian)), 1.0);
    const TestResult compressed = broken(methods::uniaxial_compression);
    EXPECT_EQ(test_quantity("cracks_tensile").value(compressed), static_cast<double>(compressed.cracks.size()));
}

TEST(RockProperties, ComeFromWhatExists) {
    std::set<std::string_view> names;
    for (const RockProperty& p : rock_properties()) {
        using enum RockProperty::Source;
        EXPECT_TRUE(names.insert(p.name).second) << p.name;
        EXPECT_EQ(p.source == formed, p.tests.empty()) << p.name;
        EXPECT_FALSE(p.label.empty() || p.symbol.empty()) << p.name;
        switch (p.source) {
            case test:
                ASSERT_EQ(p.tests.size(), 1U) << p.name;
                ASSERT_NE(p.quantity, nullptr) << p.name;
                EXPECT_TRUE(p.quantity->tests.contains(*p.tests.begin()))
                    << p.name << " is read from a test that does not define it";
                break;
            case ratio: {
                ASSERT_TRUE(rock_property(p.above) != nullptr && rock_property(p.below) != nullptr) << p.name;
                std::set<MethodId> both = rock_property(p.above)->tests;
                both.insert(rock_property(p.below)->tests.begin(), rock_property(p.below)->tests.end());
                EXPECT_EQ(p.tests, both) << p.name;
                break;
            }
            case envelope:
                EXPECT_NE(p.fit, nullptr) << p.name;
                break;
            case shear_envelope:
                EXPECT_NE(p.shear_fit, nullptr) << p.name;
                break;
            case confined_strength:
            case formed:
                break;
        }
    }
}

TEST(RockProperties, AreFoundByTheirNames) {
    for (const RockProperty& p : rock_properties())
        EXPECT_TRUE(p.source == RockProperty::Source::confined_strength || kept_rock_property(p.kept_name()) == &p) << p.name;
    EXPECT_EQ(rock_property("unheard_of"), nullptr);
    EXPECT_EQ(kept_rock_property("E"), nullptr) << "the name has its unit";
    EXPECT_EQ(confined_strength(2.5e6), "sigma1_at_sigma3_2.5MPa_Pa");
    EXPECT_EQ(pressure_of_confined_strength_MPa(confined_strength(2.5e6)), 2.5);
    EXPECT_EQ(kept_rock_property(confined_strength(2.5e6))->source, RockProperty::Source::confined_strength);
    EXPECT_FALSE(pressure_of_confined_strength_MPa("UCS_Pa").has_value());
}

TEST(RockProperties, AreWhatASummaryHas) {
    std::vector<TestResult> results;
    for (const MethodId kind : test_methods()) {
        results.push_back(broken(kind));
        if (kind == methods::biaxial) results.back().test.sigma3_Pa = 4e6;
    }
    for (const auto& [name, statistics] : summarise(results).values) EXPECT_NE(kept_rock_property(name), nullptr) << name;
}
