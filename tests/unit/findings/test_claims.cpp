// Claims held against made-up values of packings whose verdict is known, malformed claims files, and the claims of the project
// itself.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "feldspar/base/error.hpp"
#include "feldspar/findings/claims.hpp"

namespace feldspar {
namespace {

/// The value of a property at a point (labels) on a packing.
using Formula = std::function<double(const std::vector<std::string>& labels, int seed)>;

/// A study of made-up points with all combinations of the labels; labels that begin with a digit are numbers.
StudiesByName made_up(const std::vector<std::pair<std::string, std::vector<std::string>>>& axes,
                      const std::map<std::string, Formula>& properties, int packings) {
    StudyResults results;
    std::vector<std::vector<std::string>> points{{}};
    for (const auto& [axis, labels] : axes) {
        results.study.axes.push_back(axis);
        std::vector<std::vector<std::string>> longer;
        for (const auto& point : points)
            for (const std::string& label : labels) {
                longer.push_back(point);
                longer.back().push_back(label);
            }
        points = longer;
    }
    for (const auto& labels : points) {
        Point point;
        PointResults found;
        for (const std::string& label : labels)
            point.values.push_back({label, label[0] >= '0' && label[0] <= '9' ? std::stod(label) : std::nan("")});
        found.values = point.values;
        point.job.laboratory = {{"UCS", 100e6}};
        for (const auto& [property, formula] : properties)
            for (int seed = 1; seed <= packings; ++seed) {
                found.properties.values[property].seeds.push_back(static_cast<std::uint64_t>(seed));
                found.properties.values[property].values.push_back(formula(labels, seed));
            }
        results.study.points.push_back(point);
        results.points.push_back(found);
    }
    return {{"study", results}};
}

std::string with_statement(const std::string& statement) {
    return "title = \"t\"\nsource = \"s\"\n[[claim]]\nid = \"C1\"\nfigure = \"1\"\nsays = \"c\"\n[[claim.statement]]\nsays = "
           "\"s\"\nstudy = \"study\"\n" +
           statement;
}

StatementResult judged(const std::string& statement, const StudiesByName& studies) {
    const ClaimList list = parse_claims(with_statement(statement), "claims.toml");
    return evaluate(list.claims.front(), studies).statements.front();
}

/// Scatter that packings share: it leaves paired differences.
double scatter(int seed) { return 1e6 * (seed % 3); }

/// UCS of rigid grains 100 MPa and of flexible ones `more` above it, on packings that scatter, with 0.1 MPa of noise that they do
/// not share.
StudiesByName two_models(double more_Pa, int packings = 5, double noise_Pa = 0.1e6) {
    return made_up({{"grains", {"rigid", "flexible"}}},
                   {{"UCS_Pa",
                     [=](const auto& labels, int seed) {
                         const bool rigid = labels[0] == "rigid";
                         return 100e6 + scatter(seed) + (rigid ? 0.0 : more_Pa + noise_Pa * (seed % 2 == 0 ? 1 : -1));
                     }}},
                   packings);
}

const std::string flexible_greater =
    "rule = \"greater\"\nproperty = \"UCS_Pa\"\nfirst = { grains = \"flexible\" }\nsecond = { grains = \"rigid\" }\n";

TEST(Claims, GreaterIsDecidedOnPairedDifferences) {
    const StatementResult yes = judged(flexible_greater, two_models(0.5e6));
    EXPECT_EQ(yes.verdict, Verdict::reproduced);
    ASSERT_EQ(yes.comparisons.size(), 1u);
    EXPECT_EQ(yes.comparisons[0].interval.count, 5);
    EXPECT_NEAR(yes.comparisons[0].interval.mean, 0.48, 1e-9);
    EXPECT_EQ(yes.comparisons[0].unit, "MPa");
    EXPECT_EQ(yes.comparisons[0].what, "flexible less rigid");
    EXPECT_EQ(judged(flexible_greater, two_models(-0.5e6)).verdict, Verdict::contradicted);
    EXPECT_EQ(judged(flexible_greater, two_models(0.05e6)).verdict, Verdict::undecided);
}

TEST(Claims, ADifferenceMayBeFoundToBeNone) {
    const std::string none = "no_difference = \"1 %\"\n";  // of 100 MPa; noise of 0.1 MPa is far below it
    const StatementResult zero = judged(flexible_greater + none, two_models(0.0));
    EXPECT_EQ(zero.verdict, Verdict::no_difference);
    EXPECT_NEAR(zero.comparisons[0].nothing, 1.0, 0.02) << "MPa";
    EXPECT_FALSE(zero.comparisons[0].packings_to_decide);
    EXPECT_EQ(judged(flexible_greater, two_models(0.0)).verdict, Verdict::undecided) << "nothing is said of it";
    EXPECT_EQ(judged(flexible_greater + none, two_models(0.5e6)).verdict, Verdict::reproduced) << "small, but above zero";
    EXPECT_EQ(judged(flexible_greater + "no_difference = 5e3\n", two_models(0.0)).verdict, Verdict::undecided) << "0.005 MPa";
    const StatementResult open = judged(flexible_greater + none, two_models(0.0, 5, 3e6));
    EXPECT_EQ(open.verdict, Verdict::undecided) << "3 MPa of noise";
    ASSERT_TRUE(open.comparisons[0].packings_to_decide);
    EXPECT_GT(*open.comparisons[0].packings_to_decide, 40);
    const std::string text = claims_text(std::vector<ClaimResult>{{{"C1", "1", "c", {}}, Verdict::undecided, {open}}});
    EXPECT_NE(text.find(fmt::format("about {} packings would decide it", *open.comparisons[0].packings_to_decide)),
              std::string::npos)
        << text;
}

TEST(Claims, WhatIsNoDifferenceCanBeSaidOnceForAFile) {
    const ClaimList list = parse_claims("no_difference = \"2 %\"\n" + with_statement(flexible_greater), "claims.toml");
    EXPECT_EQ(list.claims[0].statements[0].no_difference.size, 0.02);
    const ClaimList other =
        parse_claims("no_difference = \"2 %\"\n" + with_statement(flexible_greater + "no_difference = \"1 %\"\n"), "claims.toml");
    EXPECT_EQ(other.claims[0].statements[0].no_difference.size, 0.01);
    const ClaimList bound =
        parse_claims("no_difference = \"2 %\"\n" +
                         with_statement("rule = \"negligible\"\nproperty = \"UCS_Pa\"\naxis = \"mu\"\nbound = \"5 %\"\n"),
                     "claims.toml");
    EXPECT_TRUE(std::isnan(bound.claims[0].statements[0].no_difference.size)) << "its bound says it";
}

// 30 comparisons without any effect, one of which is beyond 2.5 % by chance: alone it contradicts, among 30 it does not.
TEST(Claims, OneContradictionAmongManyMustHoldTogetherWithThem) {
    std::vector<std::string> mu;
    for (int i = 0; i < 30; ++i) mu.push_back(fmt::format("{}", i));
    const auto noise = [](int seed) { return 1e6 * (seed % 2 == 0 ? 1.5 : -1.0); };  // means -0 over five: -0.0
    const auto studies = [&](double least) {
        return made_up({{"grains", {"rigid", "flexible"}}, {"mu", mu}},
                       {{"UCS_Pa",
                         [=](const auto& labels, int seed) {
                             if (labels[0] == "rigid") return 100e6;
                             return 100e6 + noise(seed) + (labels[1] == "7" ? least : 0.0);
                         }}},
                       5);
    };
    EXPECT_EQ(judged(flexible_greater + "where = { mu = 7 }\n", studies(-2.5e6)).verdict, Verdict::contradicted);
    const StatementResult among = judged(flexible_greater, studies(-2.5e6));
    EXPECT_EQ(among.comparisons.size(), 30u);
    EXPECT_EQ(among.verdict, Verdict::undecided);
    EXPECT_EQ(judged(flexible_greater, studies(-20e6)).verdict, Verdict::contradicted) << "as far as this it holds";
}

TEST(Claims, AnotherDefinitionOfThePropertyIsShownBesideWithoutAVote) {
    StudiesByName studies = two_models(0.5e6);
    for (PointResults& point : studies.at("study").points) {  // the other definition says the opposite
        PropertyStatistics other = point.properties.values.at("UCS_Pa");
        for (double& value : other.values) value = -value;
        point.properties.values["UCS_fitted_Pa"] = other;
    }
    const ClaimList list =
        parse_claims(with_statement(flexible_greater + "also_property = [\"UCS_fitted_Pa\"]\n"), "claims.toml");
    const ClaimResult result = evaluate(list.claims.front(), studies);
    ASSERT_EQ(result.statements.size(), 2u);
    EXPECT_TRUE(result.statements[0].votes);
    EXPECT_FALSE(result.statements[1].votes);
    EXPECT_EQ(result.statements[0].verdict, Verdict::reproduced);
    EXPECT_EQ(result.statements[1].verdict, Verdict::contradicted);
    EXPECT_EQ(result.statements[1].statement.says, "s, by UCS_fitted_Pa");
    EXPECT_NEAR(result.statements[1].comparisons[0].interval.mean, -0.48, 1e-9);
    EXPECT_EQ(result.verdict, Verdict::reproduced) << "it has no vote";
}

TEST(Claims, TooFewPackingsDecideNothing) {
    const StatementResult few = judged(flexible_greater, two_models(50e6, 4));
    EXPECT_EQ(few.verdict, Verdict::undecided);
    EXPECT_EQ(few.comparisons[0].interval.count, 4);
    EXPECT_EQ(judged(flexible_greater + "packings = 3\n", two_models(50e6, 4)).verdict, Verdict::reproduced);
    EXPECT_EQ(judged(flexible_greater, two_models(50e6, 0)).verdict, Verdict::undecided);
}

TEST(Claims, APackingWithoutAValueIsLeftOutOfThePairs) {
    StudiesByName studies = two_models(50e6, 6);
    studies.at("study").points[0].properties.values["UCS_Pa"].values[2] = std::nan("");
    EXPECT_EQ(judged(flexible_greater, studies).comparisons[0].interval.count, 5);
}

TEST(Claims, RunsThatAreMissingAreToldFromValuesThatAre) {
    StudiesByName studies = two_models(50e6, 4);
    Study& study = studies.at("study").study;
    for (std::size_t p = 0; p < 2; ++p)
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
            feldspar::Run run;
            run.id = std::to_string(10 * p + seed);
            run.point = p;
            run.job.tests = {TestSpec{}};
            run.job.seeds = {seed};
            study.runs.push_back(run);
            if (seed == 5) continue;
            TestResult result;
            result.seed = seed;
            studies.at("study").points[p].results.push_back(result);
        }
    const StatementResult result = judged(flexible_greater, studies);
    EXPECT_EQ(result.verdict, Verdict::not_run);
    EXPECT_EQ(result.runs, 10);
    EXPECT_EQ(result.missing, 2);
    RunRecord lost;
    lost.id = "5";
    studies.at("study").points[0].failed.push_back(lost);
    EXPECT_EQ(judged(flexible_greater, studies).failed, 1);
    EXPECT_NE(
        claims_text(std::vector<ClaimResult>{{{"C1", "1", "c", {}}, Verdict::not_run, {result}}}).find("2 of 10 runs missing"),
        std::string::npos);
}

/// A property that is `f` of the number on the second axis, for two models.
StudiesByName along_mu(const std::function<double(bool flexible, double mu)>& f, const std::string& property = "UCS_Pa") {
    return made_up({{"grains", {"rigid", "flexible"}}, {"mu", {"0.2", "0.5", "0.8"}}},
                   {{property,
                     [=](const auto& labels, int seed) {
                         return f(labels[0] == "flexible", std::stod(labels[1])) * (1.0 + 1e-5 * seed * (seed % 2 == 0 ? 1 : -1));
                     }}},
                   5);
}

TEST(Claims, RisesWithTakesEachStepAndTheEnds) {
    const std::string rises = "rule = \"rises_with\"\nproperty = \"UCS_Pa\"\naxis = \"mu\"\n";
    const StatementResult yes = judged(rises, along_mu([](bool, double mu) { return 100e6 * mu; }));
    EXPECT_EQ(yes.verdict, Verdict::reproduced);
    EXPECT_EQ(yes.comparisons.size(), 6u);
    EXPECT_EQ(yes.comparisons[2].what, "rigid: mu 0.2 to 0.8");
    const auto hump = [](bool flexible, double mu) { return 100e6 * (flexible && mu > 0.6 ? 0.4 : mu); };
    const StatementResult part = judged(rises, along_mu(hump));
    EXPECT_EQ(part.verdict, Verdict::in_part);
    EXPECT_EQ(part.count(Verdict::reproduced), 5);
    EXPECT_EQ(part.count(Verdict::contradicted), 1);
    EXPECT_EQ(judged("rule = \"falls_with\"\nproperty = \"UCS_Pa\"\naxis = \"mu\"\n",
                     along_mu([](bool, double mu) { return 100e6 / mu; }))
                  .verdict,
              Verdict::reproduced);
}

TEST(Claims, NegligibleIsInsideAndMattersOutsideTheBound) {
    const auto rule = [](const char* name, const char* bound) {
        return fmt::format("rule = \"{}\"\nproperty = \"UCS_Pa\"\naxis = \"mu\"\nbound = {}\n", name, bound);
    };
    const StudiesByName little = along_mu([](bool, double mu) { return 100e6 * (1.0 + 0.01 * mu); });
    const StudiesByName much = along_mu([](bool, double mu) { return 100e6 * mu; });
    EXPECT_EQ(judged(rule("negligible", "\"5 %\""), little).verdict, Verdict::reproduced);
    EXPECT_EQ(judged(rule("negligible", "\"5 %\""), much).verdict, Verdict::contradicted);
    EXPECT_EQ(judged(rule("matters", "\"5 %\""), much).verdict, Verdict::reproduced);
    EXPECT_EQ(judged(rule("matters", "\"5 %\""), little).verdict, Verdict::contradicted);
    EXPECT_EQ(judged(rule("negligible", "1e6"), little).verdict, Verdict::reproduced);
    EXPECT_EQ(judged(rule("negligible", "1e5"), little).verdict, Verdict::contradicted);
    EXPECT_EQ(judged("rule = \"negligible\"\nproperty = \"UCS_Pa\"\naxis = \"grains\"\nwhere = { grains = [\"rigid\", "
                     "\"flexible\"] }\nbound = \"0.5 %\"\n",
                     two_models(0.5e6, 5, 1e6))
                  .verdict,
              Verdict::undecided);
}

TEST(Claims, InfluencesCompareRelativeChangesWhicheverWayTheyGo) {
    const std::string flexible_more =
        "rule = \"influence_greater\"\nproperty = \"UCS_Pa\"\naxis = \"mu\"\nfirst = { grains = \"flexible\" }\nsecond = { "
        "grains = \"rigid\" }\n";
    const auto falls_more = [](bool flexible, double mu) {
        return flexible ? 500e6 * (1.0 - 0.5 * mu) : 100e6 * (1.0 + 0.1 * mu);
    };
    EXPECT_EQ(judged(flexible_more, along_mu(falls_more)).verdict, Verdict::reproduced);
    EXPECT_EQ(
        judged(flexible_more, along_mu([](bool flexible, double mu) { return 100e6 * (1.0 + (flexible ? 0.1 : 0.5) * mu); }))
            .verdict,
        Verdict::contradicted);
}

TEST(Claims, InfluencesOfTwoAxesAndOfTwoPropertiesCompare) {
    const StudiesByName studies = made_up(
        {{"Kn", {"1", "2"}}, {"eta", {"0.2", "0.4"}}},
        {{"E_Pa",
          [](const auto& l, int seed) { return 1e9 * std::stod(l[0]) * (1.0 + 0.1 * std::stod(l[1])) * (1.0 + 1e-6 * seed); }},
         {"nu", [](const auto& l, int seed) { return std::stod(l[1]) * (1.0 + 1e-6 * seed * seed); }}},
        5);
    EXPECT_EQ(judged("rule = \"influence_greater\"\nproperty = \"E_Pa\"\naxis = \"Kn\"\nthan_axis = \"eta\"\nfirst = { eta = 0.2 "
                     "}\nsecond = { Kn = 1 }\n",
                     studies)
                  .verdict,
              Verdict::reproduced);
    EXPECT_EQ(
        judged("rule = \"influence_greater\"\nproperty = \"E_Pa\"\naxis = \"eta\"\nthan_property = \"nu\"\nfirst = { Kn = 1 }\n",
               studies)
            .verdict,
        Verdict::contradicted);
}

TEST(Claims, LinearWithMeasuresDeparturesFromTheLine) {
    const std::string linear = "rule = \"linear_with\"\nproperty = \"friction_angle_deg\"\naxis = \"mu\"\nbound = \"10 %\"\n";
    EXPECT_EQ(judged(linear, along_mu([](bool, double mu) { return 40.0 + 10.0 * mu; }, "friction_angle_deg")).verdict,
              Verdict::reproduced);
    const StatementResult bent =
        judged(linear, along_mu([](bool, double mu) { return 40.0 + 10.0 * mu * mu; }, "friction_angle_deg"));
    EXPECT_EQ(bent.verdict, Verdict::contradicted);
    EXPECT_NEAR(bent.comparisons[0].interval.mean, 100.0 * (0.21 - 0.3) / 0.6, 0.1);
}

TEST(Claims, BetweenAndCloserTakeThreeModels) {
    const auto three = [](double middle) {
        return made_up({{"grains", {"low", "middle", "high"}}},
                       {{"UCS_Pa",
                         [=](const auto& l, int seed) {
                             return (l[0] == "low"    ? 100e6
                                     : l[0] == "high" ? 200e6
                                                      : middle) +
                                    1e5 * ((seed * static_cast<int>(l[0].size())) % 4);
                         }}},
                       5);
    };
    const std::string between =
        "rule = \"between\"\nproperty = \"UCS_Pa\"\nfirst = { grains = \"middle\" }\nsecond = { grains = \"high\" }\nthird = { "
        "grains = \"low\" }\n";
    EXPECT_EQ(judged(between, three(150e6)).verdict, Verdict::reproduced);
    EXPECT_EQ(judged(between, three(250e6)).verdict, Verdict::in_part) << "above one bound, but not under the other";
    const std::string closer =
        "rule = \"closer\"\nproperty = \"UCS_Pa\"\nfirst = { grains = \"middle\" }\nsecond = { grains = \"high\" }\nthird = { "
        "grains = \"low\" }\n";
    EXPECT_EQ(judged(closer, three(190e6)).verdict, Verdict::reproduced);
    EXPECT_EQ(judged(closer, three(110e6)).verdict, Verdict::contradicted);
}

TEST(Claims, ValuesAndQuotientsAreHeldAgainstNumbers) {
    const StudiesByName studies = two_models(10e6);
    const auto with = [](const std::string& rest) { return "property = \"UCS_Pa\"\n" + rest; };
    EXPECT_EQ(judged(with("rule = \"above\"\nnumber = \"90 MPa\"\n"), studies).verdict, Verdict::reproduced);
    EXPECT_EQ(judged(with("rule = \"below\"\nnumber = \"90 MPa\"\n"), studies).verdict, Verdict::contradicted);
    EXPECT_EQ(judged(with("rule = \"within\"\nbound = \"5 %\"\nfirst = { grains = \"rigid\" }\n"), studies).verdict,
              Verdict::reproduced)
        << "the laboratory's 100 MPa";
    EXPECT_EQ(judged(with("rule = \"within\"\nbound = \"5 %\"\nfirst = { grains = \"flexible\" }\n"), studies).verdict,
              Verdict::contradicted);
    const StatementResult ratio = judged(with("rule = \"within\"\nnumber = 1.1\nbound = \"2 %\"\nfirst = { grains = \"flexible\" "
                                              "}\nsecond = { grains = \"rigid\" }\n"),
                                         studies);
    EXPECT_EQ(ratio.verdict, Verdict::reproduced);
    EXPECT_EQ(judged("rule = \"below\"\nproperty = \"UCS_Pa / UCS_Pa\"\nnumber = 1.5\n", studies).verdict, Verdict::reproduced);
}

TEST(Claims, VerdictsAreTakenTogether) {
    using enum Verdict;
    const auto all = [](std::vector<Verdict> verdicts) { return together(verdicts); };
    EXPECT_EQ(all({reproduced, reproduced}), reproduced);
    EXPECT_EQ(all({reproduced, undecided}), undecided);
    EXPECT_EQ(all({reproduced, contradicted, not_run}), in_part);
    EXPECT_EQ(all({undecided, contradicted}), contradicted);
    EXPECT_EQ(all({reproduced, not_run}), not_run);
    EXPECT_EQ(all({reproduced, not_evaluated}), undecided);
    EXPECT_EQ(all({not_evaluated}), not_evaluated);
    EXPECT_EQ(all({no_difference, no_difference}), no_difference);
    EXPECT_EQ(all({no_difference, reproduced}), in_part);
    EXPECT_EQ(all({no_difference, contradicted}), contradicted);
    EXPECT_EQ(all({no_difference, undecided}), undecided);
}

TEST(Claims, NumbersOfTheLedgerAreProperties) {
    RunRecord record;
    record.state = RunState::done;
    record.test = "brazilian";
    record.seed = 7;
    record.numbers = {{"ms_per_step", 0.5}, {"nu", std::nan("")}};
    PointResults point;
    add_run_numbers(point, std::vector{record});
    EXPECT_EQ(point.properties.values.at("ms_per_step of brazilian").values, std::vector<double>{0.5});
    EXPECT_FALSE(point.properties.values.contains("nu of brazilian"));
    EXPECT_EQ(tests_behind("ms_per_step of brazilian"), std::set<MethodId>{methods::brazilian});
    EXPECT_EQ(tests_behind("brittleness_k1"), std::set<MethodId>{methods::uniaxial_compression});
    EXPECT_EQ(tests_behind("sigma1_at_sigma3_10MPa_Pa"), std::set<MethodId>{methods::biaxial});
    EXPECT_TRUE(tests_behind("mohr_coulomb_N").empty()) << "no summary of a point has it";
    EXPECT_TRUE(tests_behind("ms_per_stride of brazilian").empty());
}

/// A malformed claims file: where the message points, and what it says.
struct BadClaims {
    std::string text;
    int line;
    std::string part;
};

TEST(Claims, MistakesAreNamedWithTheirLine) {
    const std::string greater = "rule = \"greater\"\nproperty = \"UCS_Pa\"\n";
    const std::vector<BadClaims> mistakes{
        {"title = \"t\"\nsource = \"s\"\n", 0, "missing key: claim"},
        {"title = \"t\"\nsource = \"s\"\nclaim = 3\n", 3, "not a list"},
        {"title = \"t\"\nsource = \"s\"\n[[claim]]\nid = \"C1\"\nfigure = \"1\"\nsays = \"c\"\n", 3, "missing key: statement"},
        {with_statement("rule = \"larger\"\nproperty = \"UCS_Pa\"\n"), 10, "'larger' is not one of the choices"},
        {with_statement(greater), 7, "missing key: second"},
        {with_statement(greater + "first = { grains = \"a\" }\nsecond = { grains = \"b\" }\nbound = \"5 %\"\n"), 14, "bound"},
        {with_statement(greater + "first = { grains = [\"a\"] }\nsecond = { grains = \"b\" }\n"), 12, "list of labels"},
        {with_statement(greater + "first = 3\nsecond = { grains = \"b\" }\n"), 12, "chooses no points"},
        {with_statement("rule = \"negligible\"\nproperty = \"UCS_Pa\"\naxis = \"mu\"\n"), 7, "missing key: bound"},
        {with_statement("rule = \"negligible\"\nproperty = \"UCS_Pa\"\naxis = \"mu\"\nbound = \"-5 %\"\n"), 13, "not allowed"},
        {with_statement("rule = \"above\"\nproperty = \"UCS_Pa\"\nnumber = 90\n"), 12, "no unit"},
        {with_statement("rule = \"above\"\nproperty = \"UCS_Pa / \"\nnumber = 90\n"), 11, "is not a property"},
        {with_statement("rule = \"influence_greater\"\nproperty = \"UCS_Pa\"\naxis = \"mu\"\n"), 10,
         "nothing that the influence is compared with"},
        {with_statement(greater + "not_evaluated = \"no time\"\n"), 9, "study"},
        {with_statement(greater + "colour = 1\n"), 12, "unknown key"},
        {with_statement(
             "rule = \"negligible\"\nproperty = \"UCS_Pa\"\naxis = \"mu\"\nbound = \"5 %\"\nno_difference = \"2 %\"\n"),
         14, "no_difference"},
        {"no_difference = 3\n" + with_statement(greater), 1, "an amount cannot hold for all properties"},
    };
    for (const BadClaims& bad : mistakes) {
        try {
            (void)parse_claims(bad.text, "claims.toml");
            ADD_FAILURE() << "accepted: " << bad.text;
        } catch (const InputError& error) {
            EXPECT_EQ(error.place().line, bad.line) << error.what();
            EXPECT_NE(std::string(error.what()).find(bad.part), std::string::npos) << error.what();
        }
    }
}

TEST(Claims, StatementsThatTheStudyCannotHoldAreRefused) {
    StudiesByName studies = along_mu([](bool, double mu) { return mu; });
    feldspar::Run run;
    run.job.tests = {TestSpec{}};
    studies.at("study").study.runs = {run};  // uniaxial compression only
    const std::vector<BadClaims> mistakes{
        {"rule = \"rises_with\"\nproperty = \"UCS\"\naxis = \"mu\"\n", 11, "'UCS' is not a property"},
        {"rule = \"rises_with\"\nproperty = \"DTS_Pa\"\naxis = \"mu\"\n", 11, "needs a test"},
        {"rule = \"rises_with\"\nproperty = \"UCS_Pa\"\naxis = \"my\"\n", 12, "'my' is not an axis"},
        {"rule = \"greater\"\nproperty = \"UCS_Pa\"\nfirst = { grains = \"flexibel\" }\nsecond = { grains = \"rigid\" }\n", 12,
         "did you mean 'flexible'"},
        {"rule = \"greater\"\nproperty = \"UCS_Pa\"\nfirst = { grains = \"flexible\" }\nsecond = { mu = 0.2 }\n", 13,
         "which value of the axis 'grains'"},
        {"rule = \"rises_with\"\nproperty = \"UCS_Pa\"\naxis = \"mu\"\nwhere = { mu = [0.2, 0.3] }\n", 13,
         "'0.3' is not a value"},
        {"rule = \"linear_with\"\nproperty = \"UCS_Pa\"\naxis = \"grains\"\nbound = \"5 %\"\n", 12, "is not a number"},
        {"rule = \"within\"\nproperty = \"nu\"\nbound = \"5 %\"\n", 7, "no laboratory value"},
    };
    for (const BadClaims& bad : mistakes) {
        const ClaimList list = parse_claims(with_statement(bad.text), "claims.toml");
        try {
            check_claims(list, studies);
            ADD_FAILURE() << "accepted: " << bad.text;
        } catch (const InputError& error) {
            EXPECT_EQ(error.place().line, bad.line) << error.what();
            EXPECT_NE(std::string(error.what()).find(bad.part), std::string::npos) << error.what();
        }
    }
}

// Every study file reads and makes runs; every claim speaks of what its studies have, and can be evaluated.
TEST(PaperStudies, ReadAndHoldTheClaims) {
    const std::filesystem::path folder = std::filesystem::path(FELDSPAR_SOURCE_DIR) / "studies/paper";
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string stem = entry.path().stem().string();
        if (entry.path().extension() != ".toml" || stem == "granite" || stem == "claims") continue;
        const Study study = read_study(entry.path());
        EXPECT_FALSE(study.runs.empty()) << stem;
        EXPECT_EQ(study.name, stem);
        EXPECT_EQ(study.results, std::filesystem::path("results/paper")) << stem;
        ++files;
    }
    EXPECT_GE(files, 15);
    const ClaimList list = read_claims(folder);
    EXPECT_EQ(list.claims.size(), 23u);
    StudiesByName studies = read_studies(list);
    for (auto& [stem, results] : studies) results.study.results = "no-such-directory";
    add_results(studies);
    std::vector<ClaimResult> results;
    for (const Claim& claim : list.claims) {
        results.push_back(evaluate(claim, studies));
        for (const StatementResult& statement : results.back().statements)
            EXPECT_TRUE(statement.verdict == Verdict::not_run || statement.verdict == Verdict::not_evaluated)
                << claim.id << ": " << statement.statement.says;
    }
    EXPECT_NE(claims_markdown(list, results).find("not run"), std::string::npos);
}

}  // namespace
}  // namespace feldspar
