// Jobs with first contact parameters: what is written is read again, has the user's numbers, and says what it cannot show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "feldspar/base/error.hpp"
#include "feldspar/job/first_job.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/job/job_template.hpp"
#include "feldspar/job/presets.hpp"
#include "feldspar/job/rocks.hpp"

using namespace feldspar;

namespace {

GivenRock given(std::map<std::string, std::string> values, std::string rock = "") { return {std::move(rock), std::move(values)}; }

GivenRock granite() { return given({{"UCS", "120MPa"}, {"E", "30 GPa"}, {"BTS", "9000 kPa"}, {"nu", "0.25"}}); }

// The option that an error names, and what it says.
std::pair<std::string, std::string> refused(const GivenRock& rock) {
    try {
        read_rock_numbers(rock);
    } catch (const InputError& error) {
        return {error.place().key, error.what()};
    }
    return {};
}

}  // namespace

TEST(FirstJob, IsReadAsItStandsForEveryKindOfJob) {
    for (const std::string_view kind : job_template_kinds()) {
        const FirstJob first = first_job(kind, granite());
        const Job job = parse_job(first.text, "first.toml");
        EXPECT_TRUE(first.warnings.empty()) << kind;
        EXPECT_NEAR(job.variants.front().contact.sigma_nt_Pa / first.first.contact.sigma_nt_Pa, 1.0, 1e-3)
            << kind;  // four digits
        EXPECT_EQ(job.laboratory.at("UCS"), 120e6) << kind;
        EXPECT_EQ(job.laboratory.at("BTS"), 9e6) << kind;
        EXPECT_FALSE(job.laboratory.contains("friction_angle")) << kind;  // was not given
        EXPECT_EQ(first.text.find("Augig"), std::string::npos) << kind << ": these are not its numbers";
    }
}

TEST(FirstJob, HasTheUsersUnits) {
    const std::string text = first_job("laboratory", granite()).text;
    for (const char* line :
         {"\nUCS = \"120 MPa\" ", "\nE = \"30 GPa\"", "\nBTS = \"9000 kPa\" ", "\n# cohesion = ", "\n# friction_angle = "})
        EXPECT_NE(text.find(line), std::string::npos) << line << text;
    EXPECT_NE(first_job("biaxial", given({{"UCS", "100 MPa"}, {"sigma-ci", "45 MPa"}, {"grain-size", "1.5mm"}}))
                  .text.find("\nsigma_ci = \"45 MPa\""),
              std::string::npos);
    EXPECT_NE(first_job("biaxial", given({{"UCS", "100 MPa"}, {"grain-size", "1.5mm"}}))
                  .text.find("minimum = \"1 mm\", maximum = \"2 mm\""),
              std::string::npos);
}

TEST(FirstJob, TheRulesExpectWhatIsWanted) {
    for (const GivenRock& rock : {granite(), given({{"UCS", "40 MPa"}, {"E", "12.5 GPa"}, {"BTS", "2.9 MPa"}}),
                                  given({{"UCS", "200 MPa"}, {"E", "70 GPa"}, {"DTS", "14 MPa"}, {"nu", "0.2"}})}) {
        const ReadRock read = read_rock_numbers(rock);
        const FirstParameters first = first_parameters(read.targets, read.grain_m);
        ASSERT_LT(first.wanted_ratio, first.highest_ratio)
            << first.wanted_ratio << " of " << first.lowest_ratio << " to " << first.highest_ratio;
        EXPECT_NEAR(first.expected.UCS_Pa / *read.targets.UCS_Pa, 1.0, 1e-6);
        EXPECT_NEAR(first.expected.E_Pa / *read.targets.E_Pa, 1.0, 1e-3);
        const bool of_BTS = read.targets.BTS_Pa.has_value();
        EXPECT_NEAR(of_BTS ? first.expected.BTS_Pa / *read.targets.BTS_Pa : first.expected.DTS_Pa / *read.targets.DTS_Pa, 1.0,
                    1e-6);
    }
}

TEST(FirstJob, StrengthsScaleWithTheRock) {
    // Ten times the strengths and moduli: the same rock in other units, so the same dimensionless contacts.
    const auto rock = [](double times) {
        RockTargets targets;
        targets.E_Pa = times * 10e9;
        targets.UCS_Pa = times * 40e6;
        targets.BTS_Pa = times * 3e6;
        return first_parameters(targets, 3e-3);
    };
    const FirstParameters one = rock(1.0), ten = rock(10.0);
    EXPECT_NEAR(ten.contact.sigma_nt_Pa / one.contact.sigma_nt_Pa, 10.0, 1e-9);
    EXPECT_NEAR(ten.contact.tau_Pa / one.contact.tau_Pa, 10.0, 1e-9);
    EXPECT_NEAR(ten.contact.mu, one.contact.mu, 1e-9);
    EXPECT_NEAR(ten.contact.Gfn_J_m2 / one.contact.Gfn_J_m2, 10.0, 1e-9);
}

TEST(FirstJob, SaysWhatIsOutOfReach) {
    const FirstJob first = first_job("laboratory", given({{"UCS", "200 MPa"}, {"E", "69 GPa"}, {"BTS", "4 MPa"}}));
    ASSERT_FALSE(first.warnings.empty());
    EXPECT_NE(first.warnings.front().find("UCS/BTS of 50 is out of reach"), std::string::npos) << first.warnings.front();
    EXPECT_NE(first.warnings.front().find("docs/theory/heterogeneity.md"), std::string::npos);
    EXPECT_NE(first.text.find("# NOTE: UCS/BTS of 50 is out of reach"), std::string::npos);
    EXPECT_NEAR(first.first.expected.UCS_Pa, 200e6, 1.0);
    parse_job(first.text, "first.toml");
}

TEST(FirstJob, SaysWhereTheRulesWereNotMeasured) {
    const FirstJob first = first_job("laboratory", given({}, "cherokee-marble"));  // E is 830 times its UCS
    EXPECT_TRUE(std::any_of(first.warnings.begin(), first.warnings.end(), [](const std::string& warning) {
        return warning.find("is below what the rules were measured at") != std::string::npos;
    }));
}

TEST(FirstJob, RefusesWhatNoRockHas) {
    EXPECT_EQ(refused(given({{"UCS", "-120 MPa"}})).first, "--UCS");
    EXPECT_EQ(refused(given({{"UCS", "120"}})).first, "--UCS");
    EXPECT_EQ(refused(given({{"UCS", "120 mm"}})).first, "--UCS");
    EXPECT_EQ(refused(given({{"UCS", "120 MPa"}, {"E", "30 GPa/m"}})).first, "--E");
    EXPECT_EQ(refused(given({{"UCS", "120 MPa"}, {"nu", "0.7"}})).first, "--nu");
    EXPECT_EQ(refused(given({{"UCS", "120 MPa"}, {"nu", "quarter"}})).first, "--nu");
    EXPECT_EQ(refused(given({{"UCS", "120 MPa"}, {"friction-angle", "95 deg"}})).first, "--friction-angle");
    EXPECT_EQ(refused(given({{"UCS", "120 MPa"}, {"grain-size", "0.1 m"}})).first, "--grain-size");
    EXPECT_EQ(refused(given({{"E", "30 GPa"}})).first, "--UCS");  // no strength
    const auto [key, text] = refused(given({{"UCS", "9 MPa"}, {"BTS", "120 MPa"}}));
    EXPECT_EQ(key, "--UCS");
    EXPECT_NE(text.find("exchanged"), std::string::npos) << text;
    EXPECT_NE(refused(given({{"UCS", "120 MPa"}}, "grannite")).second.find("granite"), std::string::npos);
}

TEST(FirstJob, NamedRocksGiveWhatIsMissing) {
    const FirstJob whole = first_job("laboratory", given({}, "lac-du-bonnet-granite"));
    const Job job = parse_job(whole.text, "first.toml");
    EXPECT_EQ(job.laboratory.at("UCS"), 200e6);
    EXPECT_NE(whole.text.find("Potyondy, Cundall 2004"), std::string::npos);
    const ReadRock part = read_rock_numbers(given({{"UCS", "150 MPa"}}, "granite"));
    EXPECT_EQ(part.laboratory.size(), 1u);  // the user's alone
    EXPECT_NEAR(*part.targets.UCS_Pa / *part.targets.BTS_Pa, 122.1 / 8.8, 1e-9);
    EXPECT_FALSE(part.assumed.empty());
    for (const LiteratureRock& rock : literature_rocks()) {
        EXPECT_FALSE(rock.source.empty());
        EXPECT_GT(rock.UCS_MPa, rock.BTS_MPa) << rock.name;
        parse_job(first_job("laboratory", given({}, std::string(rock.name))).text, "first.toml");
    }
}

TEST(FirstJob, PresetsOfRocksAreTheRules) {
    int rocks = 0;
    for (const LiteratureRock& rock : literature_rocks()) {
        const std::string name(rock.name),
            keys =
                "[specimen]\nshape = \"rectangle\"\nwidth = \"80 mm\"\nheight = \"160 mm\"\n[specimen.grains]\ndiameter = { "
                "distribution = \"uniform\", minimum = \"2 mm\", maximum = \"4 mm\" }\n";
        const std::vector<Preset> strengths(strength_presets().begin(), strength_presets().end());
        if (std::none_of(strengths.begin(), strengths.end(), [&](const Preset& preset) { return preset.name == name; }))
            continue;  // the Augig granite has those of its paper
        ++rocks;
        const Job job = parse_job(keys + "[material]\nelastic_preset = \"" + name + "\"\nstrength_preset = \"" + name +
                                      "\"\n[[test]]\nkind = \"uniaxial-compression\"\n",
                                  "job");
        const FirstParameters first = first_job("laboratory", given({}, name)).first;
        const ContactMaterial &preset = job.variants.front().contact, &rule = first.contact;
        for (const auto& [one, other] :
             {std::pair(preset.Kn_Pa_m, rule.Kn_Pa_m), std::pair(preset.sigma_nt_Pa, rule.sigma_nt_Pa),
              std::pair(preset.tau_Pa, rule.tau_Pa), std::pair(preset.mu, rule.mu), std::pair(preset.Gfn_J_m2, rule.Gfn_J_m2),
              std::pair(preset.Gfs_J_m2, rule.Gfs_J_m2), std::pair(job.variants.front().grain.E_Pa, first.grain.E_Pa)})
            EXPECT_NEAR(one / other, 1.0, 2e-3) << name;  // three to four digits
    }
    EXPECT_GE(rocks, 6);
}

TEST(FirstJob, ContactsThatNoRockHasAreWarnedOf) {
    const std::string text = first_job("uniaxial-compression", granite()).text;
    const auto warned = [&](std::vector<std::pair<std::string, std::string>> values, const std::string& words) {
        const std::vector<std::string> all = warnings(parse_job(with_values(text, "material.contact", values), "job"));
        return std::any_of(all.begin(), all.end(),
                           [&](const std::string& warning) { return warning.find(words) != std::string::npos; });
    };
    EXPECT_TRUE(warnings(parse_job(text, "job")).empty());
    EXPECT_TRUE(warned({{"mu", "30"}}, "mu = 30 lies outside what rocks have"));
    EXPECT_TRUE(warned({{"eta", "3"}}, "eta = 3 lies outside what rocks have"));
    EXPECT_TRUE(warned({{"Gfn", "\"5000 N/m\""}}, "Gfn = 5000 N/m lies outside what rocks have"));
    // ten times the strengths that the laboratory asks for
    EXPECT_TRUE(warned({{"sigma_nt", "\"63 MPa\""}, {"tau", "\"268 MPa\""}},
                       "by the scaling rules (docs/validation/first-parameters.md), the laboratory has 120 MPa"));
}
