// The list of cases: names that are unique, filters, goals that belong to a case.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "benchmarks/cases.hpp"
#include "benchmarks/goals.hpp"
#include "feldspar/base/error.hpp"

namespace feldspar::benchmarks {
namespace {

std::set<std::string> names(const std::vector<Case>& cases) {
    std::set<std::string> all;
    for (const Case& one : cases) EXPECT_TRUE(all.insert(name(one)).second) << name(one) << " is there twice";
    return all;
}

TEST(Cases, HaveUniqueNamesAndTheQuickOnesAreAmongTheFull) {
    for (const std::vector<int>& threads : {std::vector<int>{1, 2}, std::vector<int>{4}, std::vector<int>{1, 2, 8}}) {
        const auto quick = names(make_cases(false, threads)), full = names(make_cases(true, threads));
        EXPECT_LT(quick.size(), full.size());
        EXPECT_TRUE(std::includes(full.begin(), full.end(), quick.begin(), quick.end()));
    }
}

TEST(Cases, OfOneSpecimenStandTogether) {
    for (const bool full : {false, true}) {
        std::set<std::string> left;
        std::string current;
        for (const Case& one : make_cases(full, {1, 2})) {
            const std::string specimen = name(one.specimen);
            if (specimen == current) continue;
            EXPECT_TRUE(left.insert(specimen).second) << specimen << " would be built twice";
            current = specimen;
        }
    }
}

TEST(Cases, CoverEveryKindOfGrainAndLoadOnThePaperSize) {
    const auto quick = names(make_cases(false, {1, 2}));
    for (const char* grains : {"flexible", "rigid", "inner-particles"}) {
        for (const char* rest :
             {"/uniaxial/paper/elastic/step/1t", "/uniaxial/paper/elastic/step/2t", "/uniaxial/paper/elastic/contacts/1t",
              "/uniaxial/paper/elastic/bodies/2t", "/uniaxial/paper/breaking/step/1t", "/brazilian/paper/elastic/step/2t"})
            EXPECT_EQ(quick.count(grains + std::string(rest)), 1u) << grains << rest;
    }
}

TEST(Filter, IsARegularExpressionThatMayFindAnyPart) {
    const auto cases = make_cases(true, {1, 2});
    const auto kept = filtered(cases, "^rigid/.*100k/breaking/step/1t$");
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_EQ(name(kept[0]), "rigid/uniaxial/100k/breaking/step/1t");
    EXPECT_TRUE(filtered(cases, "no such case").empty());
    EXPECT_EQ(filtered(cases, "").size(), cases.size());
    EXPECT_THROW(filtered(cases, "("), InputError);
}

TEST(Sizes, GrowWithTheRootOfTheGrains) {
    const SpecimenChoice paper{GrainKind::rigid, Load::uniaxial, Size::paper},
        large{GrainKind::rigid, Load::uniaxial, Size::grains_100k};
    EXPECT_DOUBLE_EQ(length_scale(paper), 1.0);
    EXPECT_NEAR(length_scale(large) * length_scale(large) * grain_count(paper), 100000.0, 1e-6);
    EXPECT_LT(needed_memory(paper), needed_memory(large));
}

TEST(Goals, BelongToCases) {
    const auto full = names(make_cases(true, {1, 2}));
    for (const Goal& goal : kGoals) EXPECT_EQ(full.count(goal.case_name), 1u) << goal.case_name;
}

TEST(Goals, AreThoseOfTheWidestVectors) {
    const std::string flexible = "flexible/uniaxial/paper/elastic/step/1t";
    EXPECT_EQ(goal_milliseconds(flexible, 512), 0.15);
    EXPECT_EQ(goal_milliseconds(flexible, 256), 0.25);
    EXPECT_EQ(goal_milliseconds(flexible, 128), std::nullopt);
    EXPECT_EQ(goal_milliseconds("another case", 512), std::nullopt);
}

}  // namespace
}  // namespace feldspar::benchmarks
