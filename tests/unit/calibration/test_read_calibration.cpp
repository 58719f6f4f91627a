// Files of targets and unknowns: defaults, and what is said of mistakes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "../../switched_on.hpp"
#include "../job/broken_lines.hpp"
#include "calibration_files.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/job/job_template.hpp"
#include "feldspar/job/mistakes.hpp"

namespace feldspar {
namespace {

class ReadCalibration : public ::testing::Test {
protected:
    InputError mistake(const std::string& text) const {
        try {
            (void)folder_.read(text);
        } catch (const InputError& error) {
            return error;
        }
        ADD_FAILURE() << "no error for\n" << text;
        return InputError({}, "");
    }
    std::vector<InputError> mistakes(const std::string& text) const {
        try {
            (void)folder_.read(text);
        } catch (const InputError& error) {
            return each_mistake(error);
        }
        return {};
    }
    static std::string only_message(const std::vector<InputError>& one) { return one.size() == 1 ? one.front().what() : ""; }
    static std::string edited(std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    }
    CalibrationFolder folder_;
};

TEST_F(ReadCalibration, RangesFollowFromTheRock) {
    const Calibration calibration = folder_.read(
        "[targets]\nE = \"25 GPa\"\nUCS = { value = \"120 MPa\", tolerance = \"4 %\" }\nBTS = { value = \"9 MPa\", "
        "standard_deviation = \"1.5 MPa\" }\n"
        "friction_angle = \"50 deg\"\n[[unknown]]\nkey = \"material.contact.Kn\"\n[[unknown]]\nkey = \"material.grain.E\"\n" +
        strength_unknowns);
    ASSERT_EQ(calibration.unknowns.size(), 7u);
    const Unknown &Kn = calibration.unknowns[0], &E = calibration.unknowns[1], &sigma_nt = calibration.unknowns[2];
    EXPECT_TRUE(Kn.elastic);
    EXPECT_LT(Kn.low, 18e4);  // Table 1's value lies inside
    EXPECT_GT(Kn.high, 18e4);
    EXPECT_EQ(Kn.unit, "GPa/m");
    EXPECT_DOUBLE_EQ(E.low, 20.0);
    EXPECT_FALSE(sigma_nt.elastic);
    EXPECT_DOUBLE_EQ(sigma_nt.low, 4.5);
    const Unknown& Gfn = calibration.unknowns[5];  // (9 MPa)^2 / 25 GPa in a grain of 3 mm: 9.72 N/m
    EXPECT_DOUBLE_EQ(Gfn.low, 0.2916);             // 0.03 of it
    EXPECT_DOUBLE_EQ(Gfn.high, 300.0);
    EXPECT_EQ(calibration.targets[1].tolerance, 0.04 * 120e6);
    EXPECT_EQ(calibration.targets[2].tolerance, 1.5e6);
    EXPECT_DOUBLE_EQ(calibration.targets[3].value, 50.0);  // degrees
    EXPECT_EQ(calibration.seeds.size(), 20u);
    EXPECT_EQ(calibration.confirm_seeds.size(), 10u);

    const Job job = calibration.job_with({18e4, 26.0, 8.0, 3.0, 0.4, 20.0, 40.0});
    EXPECT_DOUBLE_EQ(job.variants.front().contact.tau_Pa, 24e6);
    EXPECT_DOUBLE_EQ(job.variants.front().contact.Gfs_J_m2, 800.0);
    EXPECT_DOUBLE_EQ(job.variants.front().grain.E_Pa, 26e9);
}

TEST_F(ReadCalibration, RangesOfStiffnessFitEveryKindOfGrain) {  // Table 1 lies well inside
    const auto Kn = [&](const std::string& kind) {
        return folder_
            .read("[set]\nmodel.kind = \"" + kind + "\"\nmaterial.elastic_preset = \"augig-" + kind +
                  "\"\n[targets]\nE = \"25.8 GPa\"\n[[unknown]]\nkey = \"material.contact.Kn\"\n")
            .unknowns[0];
    };
    for (const auto& [kind, table_1] :
         {std::pair{"flexible", 18e4}, std::pair{"rigid", 1.08e4}, std::pair{"inner-particles", 4.9e4}}) {
        EXPECT_LT(1.5 * Kn(kind).low, table_1) << kind;
        EXPECT_GT(Kn(kind).high, 1.5 * table_1) << kind;
    }
}

// Rocks whose fracture energies are known, hidden or found: E and tensile strength of the specimen, Gfn and sigma_nt^2 / (2 Kn),
// below which contacts are brittle (docs/calibration.md).
TEST_F(ReadCalibration, RangesOfFractureEnergyHoldFromBrittleToTough) {
    struct KnownRock {
        const char* name;
        double E_GPa, tension_MPa, Gfn, brittle;
        bool rigid = false;
    };
    for (const KnownRock& rock :
         {KnownRock{"granite, Table 7", 24.2, 8.30, 20.0, 0.20}, KnownRock{"granite, calibrated", 25.8, 8.8, 3.2, 0.56},
          KnownRock{"sandstone, calibrated", 12.5, 2.8, 0.79, 0.222}, KnownRock{"sandstone, hidden", 12.2, 3.44, 7.0, 0.068},
          KnownRock{"marble, hidden", 41.6, 8.13, 40.0, 0.072}, KnownRock{"tough", 24.2, 10.3, 150.0, 0.20},
          KnownRock{"tougher", 24.2, 10.7, 200.0, 0.20}, KnownRock{"hard", 65.0, 14.0, 15.0, 0.28},
          KnownRock{"runaway", 43.0, 4.8, 8.0, 0.047}, KnownRock{"rigid, Table 2", 25.0, 9.2, 66.0, 6.1, true},
          KnownRock{"rigid, calibrated", 25.8, 8.8, 34.0, 22.5, true}}) {
        const std::string kind = rock.rigid ? "[set]\nmodel.kind = \"rigid\"\nmaterial.elastic_preset = \"augig-rigid\"\n" : "";
        const Unknown Gfn = folder_
                                .read(kind + "[targets]\nE = \"" + std::to_string(rock.E_GPa) + " GPa\"\nDTS = \"" +
                                      std::to_string(rock.tension_MPa) + " MPa\"\n[[unknown]]\nkey = \"material.contact.Gfn\"\n")
                                .unknowns[0];
        EXPECT_LT(1.5 * Gfn.low, rock.Gfn) << rock.name;
        EXPECT_GE(Gfn.high, 1.5 * rock.Gfn) << rock.name;
        EXPECT_LT(Gfn.low, 2.2 * rock.brittle)
            << rock.name;  // contacts that are all but brittle lie within too: they soften over as little as they stretch
    }
}

TEST_F(ReadCalibration, PiecesAreLaidOverTheJob) {
    const Calibration calibration = folder_.read(
        "[set]\ntest.brazilian.plate_Kn = \"900 GPa/m\"\ntest.biaxial.sigma3 = \"5 MPa\"\nmaterial.contact.mu = 0.25\n"
        "[targets]\nsigma1 = [{ sigma3 = \"5 MPa\", value = \"150 MPa\" }]\nBTS = \"9 MPa\"\n[[unknown]]\nkey = "
        "\"material.contact.sigma_nt\"\n");
    const Job job = calibration.job_with({8.0});
    EXPECT_DOUBLE_EQ(job.tests[2].plate_Kn_Pa_m.value(), 900e9);
    EXPECT_DOUBLE_EQ(job.variants.front().contact.mu, 0.25);
    EXPECT_EQ(calibration.sigma3_Pa, std::vector<double>{5e6});
    const InputError unknown = mistake(
        "[set]\ntest.brazilian.plate_kn = 1\n[targets]\nBTS = \"9 MPa\"\n[[unknown]]\nkey = \"material.contact.sigma_nt\"\n");
    EXPECT_EQ(unknown.place().key, "set");
    EXPECT_NE(unknown.suggestion().find("plate_Kn"), std::string::npos);
}

TEST_F(ReadCalibration, ValuesAndParametersAreInverse) {
    Unknown unknown;
    unknown.low = 4.0;
    unknown.high = 400.0;
    EXPECT_DOUBLE_EQ(unknown.value_at(0.5), 40.0);
    EXPECT_DOUBLE_EQ(unknown.x_of(40.0), 0.5);
    unknown.logarithmic = false;
    EXPECT_DOUBLE_EQ(unknown.value_at(0.25), 103.0);
    EXPECT_DOUBLE_EQ(unknown.value_at(2.0), 400.0);  // never beyond the range
}

TEST_F(ReadCalibration, MistakesAreSaid) {
    const std::string targets = "[targets]\nUCS = \"120 MPa\"\n", mu = "[[unknown]]\nkey = \"material.contact.mu\"\n";
    EXPECT_NE(mistake("[targets]\nUSC = \"120 MPa\"\n" + mu).suggestion().find("UCS"), std::string::npos);
    EXPECT_EQ(mistake("[targets]\nUCS = \"120 GPa/m\"\n" + mu).place().line, 3);
    EXPECT_NE(mistake(targets).problem().find("unknown"), std::string::npos);
    EXPECT_NE(mistake(targets + mu + mu).problem().find("twice"), std::string::npos);
    EXPECT_NE(mistake(targets + "[[unknown]]\nkey = \"material.contact.Kn\"\n").place().key.find("range"), std::string::npos);
    EXPECT_NE(mistake(targets + "[[unknown]]\nkey = \"material.grain.nu\"\n").problem().find("neither is a target"),
              std::string::npos);
    EXPECT_NE(mistake("[targets]\nE = \"25 GPa\"\n" + mu).problem().find("none is a target"), std::string::npos);
    EXPECT_NE(mistake(targets + "[[unknown]]\nkey = \"material.contact.mu\"\nrange = [0.5, 0.2]\n").problem().find("empty"),
              std::string::npos);
    EXPECT_NE(mistake(targets + "[[unknown]]\nkey = \"material.contact.sigma_nt\"\nrange = [\"5 MPa\", \"10 kPa\"]\n")
                  .problem()
                  .find("units"),
              std::string::npos);
    EXPECT_NE(mistake(targets + "[[unknown]]\nkey = \"material.contact.muu\"\nrange = [0.1, 0.2]\n").suggestion().find("mu"),
              std::string::npos);
    EXPECT_NE(mistake("confirm_seeds = [3]\n" + targets + mu).problem().find("learns from"), std::string::npos);
    EXPECT_NE(
        mistake("[targets]\nsigma1 = [{ sigma3 = \"7 MPa\", value = \"150 MPa\" }]\n" + mu).problem().find("no biaxial test"),
        std::string::npos);
    EXPECT_NE(mistake("[targets]\nUCS = { value = \"1 MPa\", tolerance = \"1 %\", standard_deviation = \"1 MPa\" }\n" + mu)
                  .problem()
                  .find("beside"),
              std::string::npos);
}

TEST_F(ReadCalibration, StrengthsInTheWrongOrderAreRefused) {
    const std::string mu = "[[unknown]]\nkey = \"material.contact.mu\"\n";
    const auto key = [&](const std::string& targets) { return mistake("[targets]\n" + targets + mu).place().key; };
    EXPECT_EQ(key("UCS = \"8.8 MPa\"\nBTS = \"122 MPa\"\n"), "targets.UCS");
    EXPECT_EQ(key("UCS = \"8.8 MPa\"\nDTS = \"8.8 MPa\"\n"), "targets.UCS");
    EXPECT_EQ(key("cohesion = \"2 MPa\"\nfriction_angle = \"30 deg\"\nBTS = \"9 MPa\"\n"),
              "targets.cohesion");  // 2 c sqrt(3) = 6.93 MPa
    EXPECT_EQ(key("BTS = \"9 MPa\"\nUCS_over_BTS = 0.9\n"), "targets.UCS_over_BTS");
    EXPECT_EQ(key("UCS = \"120 MPa\"\nsigma1 = [{ sigma3 = \"10 MPa\", value = \"100 MPa\" }]\n"), "targets.sigma1");
    EXPECT_NO_THROW(folder_.read("[targets]\nUCS = \"120 MPa\"\nBTS = \"9 MPa\"\n" + mu));
}

TEST_F(ReadCalibration, ResultsStayInTheResultsDirectory) {
    const std::string rest = "[targets]\nUCS = \"120 MPa\"\n[[unknown]]\nkey = \"material.contact.mu\"\n";
    for (const char* key : {"results", "name"}) {
        for (const char* name : {"../../../escaped", "/tmp/escaped", "..", "a/b", ""}) {
            const InputError error = mistake(std::string(key) + " = \"" + name + "\"\n" + rest);
            EXPECT_EQ(error.place().key, key) << name;
            EXPECT_EQ(error.place().line, 2) << name;
        }
    }
    EXPECT_EQ(folder_.read("results = \"granite-1.2\"\n" + rest).results, std::filesystem::path("results") / "granite-1.2");
}

const std::string whole_calibration = R"(name = "rock"
results = "rock"
seeds = [1, 2]
confirm_seeds = [11, 12]
budget = 100
[set]
material.contact.mu = 0.25
[targets]
E = "25 GPa"
nu = 0.2
UCS = { value = "120 MPa", tolerance = "4 %" }
BTS = { value = "9 MPa", standard_deviation = "1.5 MPa" }
sigma1 = [{ sigma3 = "10 MPa", value = "190 MPa" }]
[[unknown]]
key = "material.contact.Kn"
[[unknown]]
name = "E"
key = "material.grain.E"
range = ["10 GPa", "50 GPa"]
scale = "linear"
[[unknown]]
name = "tau/sigma_nt"
key = "material.contact.tau"
times = "material.contact.sigma_nt"
range = [2, 4]
)";

TEST_F(ReadCalibration, FiveMistakesAreToldInTheOrderOfLinesEachAsIfAlone) {
    const std::vector<std::pair<std::string, std::string>> edits{{"budget = 100", "budget = 1"},
                                                                 {"material.contact.mu = 0.25", "material.contact.muu = 0.25"},
                                                                 {"nu = 0.2", "nu = \"0.2\""},
                                                                 {"key = \"material.contact.Kn\"", "key = \"Kn\""},
                                                                 {"range = [2, 4]", "range = [4, 2]"}};
    std::string text = whole_calibration;
    std::set<std::string> wanted, told;
    for (const auto& [from, to] : edits) {
        text = edited(text, from, to);
        wanted.insert(only_message(mistakes(edited(whole_calibration, from, to))));
    }
    int line = -1;
    for (const InputError& error : mistakes(text)) {
        told.insert(error.what());
        EXPECT_GE(error.place().line, line);
        line = error.place().line;
    }
    EXPECT_EQ(told, wanted);
    EXPECT_EQ(wanted.size(), 5u);
}

TEST_F(ReadCalibration, OneBrokenLineIsOneMistake) {
    EXPECT_TRUE(mistakes(whole_calibration).empty());
    for (const BrokenLine& broken : broken_lines(whole_calibration)) {
        const std::vector<InputError> found = mistakes(broken.text);
        ASSERT_EQ(found.size(), 1u) << broken.written << "\n" << found.front().what() << "\n" << found.back().what();
    }
}

TEST(ExamplesOfCalibrations, Read) {
    struct Example {
        const char* name;
        std::size_t targets, quantities;  // E, nu, UCS; BTS, a confined strength; DTS
    };
    for (const auto& [name, targets, quantities] :
         {Example{"examples/calibration/augig.toml", 6, 5}, Example{"examples/calibration/augig-rigid.toml", 6, 5},
          Example{"examples/calibration/transjurane.toml", 6, 5}, Example{"studies/twins/twin-granite.toml", 6, 6},
          Example{"studies/twins/twin-sandstone.toml", 6, 6}, Example{"studies/twins/twin-marble.toml", 6, 6},
          Example{"studies/twins/twin-inner.toml", 4, 4}, Example{"examples/calibration/augig-scatter.toml", 6, 6},
          Example{"examples/calibration/granite.toml", 4, 4}}) {
        const Calibration calibration = read_calibration(std::filesystem::path(FELDSPAR_SOURCE_DIR) / name);
        EXPECT_EQ(calibration.targets.size(), targets) << name;
        EXPECT_TRUE(contradictions(calibration.targets).empty()) << name;
        EXPECT_EQ(observables_for(calibration).size(), quantities) << name;
    }
}

TEST(CalibrationTemplate, ReadsBesideAJob) {
    const TemporaryFolder folder;
    folder.write("rock.toml", job_template("laboratory"));
    const Calibration calibration = parse_calibration(calibration_template(), folder / "targets.toml");
    EXPECT_EQ(calibration.targets.size(), 5u);
    EXPECT_EQ(calibration.unknowns.size(), 7u);
    const Calibration all = parse_calibration(switched_on(calibration_template()), folder / "targets.toml");
    EXPECT_EQ(all.targets.size(), 8u);
    EXPECT_EQ(all.seeds.size(), 10u);
    EXPECT_TRUE(contradictions(all.targets).empty());
}

TEST(CalibrationTemplate, TakesTheNumbersOfARock) {
    const TemporaryFolder folder;
    folder.write("rock.toml", job_template("laboratory"));
    const auto unknown = [](const Calibration& calibration, const char* key) {
        return std::any_of(calibration.unknowns.begin(), calibration.unknowns.end(),
                           [&](const Unknown& one) { return one.key == key; });
    };
    GivenRock rock{.rock = "", .values = {{"UCS", "120 MPa"}, {"E", "30 GPa"}, {"BTS", "9 MPa"}}};
    const Calibration few = parse_calibration(calibration_template(read_rock_numbers(rock)), folder / "targets.toml");
    ASSERT_EQ(few.targets.size(), 3u);  // no angle of another rock
    EXPECT_FALSE(unknown(few, "material.contact.mu"));
    EXPECT_FALSE(unknown(few, "material.grain.nu"));
    rock.values["nu"] = "0.2";
    rock.values["friction-angle"] = "48 deg";
    const Calibration more = parse_calibration(calibration_template(read_rock_numbers(rock)), folder / "targets.toml");
    EXPECT_EQ(more.targets.size(), 5u);
    EXPECT_TRUE(unknown(more, "material.contact.mu"));
    EXPECT_TRUE(unknown(more, "material.grain.nu"));
}

TEST_F(ReadCalibration, SettingsGoOverTheJobButNotOverWhatIsSought) {
    const std::string text =
        "job = \"rock.toml\"\n[set]\nnumerics.accuracy = \"3 %\"\n[targets]\nUCS = \"120 MPa\"\nBTS = \"9 MPa\"\n"
        "[[unknown]]\nkey = \"material.contact.sigma_nt\"\n[[unknown]]\nkey = \"material.contact.tau\"\n";
    const auto read = [&](std::vector<std::string> settings) {
        return parse_calibration(text, folder_ / "targets.toml", settings);
    };
    const Calibration set = read({"numerics.accuracy=6 %", "material.contact.mu=0.5"});
    const Job job = set.job_with({8.0, 30.0});
    EXPECT_DOUBLE_EQ(job.variants.front().numerics.accuracy, 0.06);
    EXPECT_DOUBLE_EQ(job.variants.front().contact.mu, 0.5);
    EXPECT_DOUBLE_EQ(job.variants.front().contact.tau_Pa, 30e6) << "the unknown";
    try {
        (void)read({"material.contact.tau=20 MPa"});
        ADD_FAILURE() << "no error";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("the unknown 'tau' decides this key"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace feldspar
