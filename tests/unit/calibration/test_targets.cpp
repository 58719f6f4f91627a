// From what runs show to what the laboratory measured.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "calibration_files.hpp"
#include "feldspar/calibration/insight.hpp"

namespace feldspar {
namespace {

const CalibrationFolder& folder() {
    static const CalibrationFolder one;
    return one;
}

TEST(Targets, AskForTheTestsThatShowThem) {
    const Calibration calibration = folder().read(
        "[targets]\ncohesion = \"21 MPa\"\nfriction_angle = \"53 deg\"\nUCS_over_BTS = 14\nE = \"25 GPa\"\n"
        "[[unknown]]\nkey = \"material.contact.mu\"\n[[unknown]]\nkey = \"material.grain.E\"\n");
    std::vector<std::string> names;
    for (const Observable& observable : observables_for(calibration)) names.push_back(observable.name);
    EXPECT_EQ(names, (std::vector<std::string>{"E", "UCS", "BTS", "sigma1 at 10 MPa"}));
}

TEST(Targets, FollowFromTheMeansByTheirFormulas) {
    const Calibration calibration = folder().read(
        "[targets]\ncohesion = \"21 MPa\"\nfriction_angle = \"53 deg\"\nUCS_over_DTS = 14\nnu = 0.2\n"
        "[[unknown]]\nkey = \"material.contact.mu\"\n[[unknown]]\nkey = \"material.contact.eta\"\n");
    const auto observables = observables_for(calibration);
    const double phi = 40.0, c = 25e6, N = std::pow(std::tan((45.0 + 0.5 * phi) * std::numbers::pi / 180.0), 2.0);
    std::vector<double> means;
    for (const Observable& o : observables)
        means.push_back(o.name == "UCS"   ? 2.0 * c * std::sqrt(N)
                        : o.name == "DTS" ? 8e6
                        : o.name == "nu"  ? 0.23
                                          : 2.0 * c * std::sqrt(N) + N * 10e6);
    for (const Target& target : calibration.targets) {
        const double value = value_of(target, observables, means);
        if (target.name == "cohesion") {
            EXPECT_NEAR(value, c, 1e-6 * c);
        }
        if (target.name == "friction_angle") {
            EXPECT_NEAR(value, phi, 1e-9);
        }
        if (target.name == "UCS_over_DTS") {
            EXPECT_NEAR(value, 2.0 * c * std::sqrt(N) / 8e6, 1e-9);
        }
        if (target.name == "nu") {
            EXPECT_EQ(value, 0.23);
        }
    }
}

TEST(Targets, RatiosAreThoseOfTheMeans) {
    const auto read = [](const char* targets) {
        return folder().read(std::string("[targets]\n") + targets + "[[unknown]]\nkey = \"material.contact.mu\"\n");
    };
    const auto ratio = [](const Calibration& calibration, std::map<std::string, double> mean) {
        const auto observables = observables_for(calibration);
        std::vector<double> means;
        for (const Observable& o : observables) means.push_back(mean.at(o.name));
        return value_of(calibration.targets.front(), observables, means);
    };
    EXPECT_DOUBLE_EQ(ratio(read("UCS_over_BTS = 14\n"), {{"UCS", 120e6}, {"BTS", 10e6}}), 12.0);
    EXPECT_DOUBLE_EQ(ratio(read("BTS_over_DTS = 1.1\n"), {{"BTS", 9e6}, {"DTS", 6e6}}), 1.5);
}

TEST(Targets, SayWhatStrengthACompressionTestIsToShow) {
    const auto target = [](const char* name, double value, double sigma3 = 0.0) { return Target{name, sigma3, value, 1.0}; };
    const std::vector<Target> targets{target("UCS", 100e6), target("friction_angle", 30.0),
                                      target("sigma1", 250e6, 20e6)};  // N = 3
    TestSpec test;
    EXPECT_DOUBLE_EQ(wanted_strength_Pa(test, targets), 100e6);
    test.kind = methods::biaxial;
    test.sigma3_Pa = 10e6;
    EXPECT_NEAR(wanted_strength_Pa(test, targets), 130e6, 1.0);
    test.sigma3_Pa = 20e6;
    EXPECT_DOUBLE_EQ(wanted_strength_Pa(test, targets), 250e6);
    EXPECT_TRUE(std::isnan(wanted_strength_Pa(test, {target("UCS", 100e6)})));
    test.kind = methods::brazilian;
    EXPECT_TRUE(std::isnan(wanted_strength_Pa(test, targets)));
}

TEST(Targets, ThatContradictEachOtherAreSaid) {
    const auto said = [](const std::string& targets) {
        return contradictions(folder().read("[targets]\n" + targets + "[[unknown]]\nkey = \"material.contact.mu\"\n").targets);
    };
    const auto impossible = said("UCS = \"100 MPa\"\ncohesion = \"40 MPa\"\nfriction_angle = \"50 deg\"\n");
    ASSERT_EQ(impossible.size(), 1u);
    EXPECT_NE(impossible[0].find("219.8"), std::string::npos) << impossible[0];  // 2 x 40 x tan(70 deg)
    EXPECT_TRUE(said("UCS = \"122.1 MPa\"\ncohesion = \"21 MPa\"\nfriction_angle = \"53 deg\"\n").empty());  // Augig: 125.5
    EXPECT_EQ(said("UCS = \"100 MPa\"\nBTS = \"10 MPa\"\nUCS_over_BTS = 14\n").size(), 1u);
    EXPECT_TRUE(said("UCS = \"100 MPa\"\ncohesion = \"40 MPa\"\n").empty());  // some angle goes with them
}

TEST(Targets, IntervalsOfPlainMeansAreThoseOfTheValues) {
    const Calibration calibration =
        folder().read("[targets]\nUCS = \"120 MPa\"\nUCS_over_DTS = 14\n[[unknown]]\nkey = \"material.contact.mu\"\n");
    const auto observables = observables_for(calibration);
    const std::vector<std::vector<double>> seen{{118e6, 122e6, 126e6, 114e6, std::nan("")}, {8e6, 8.2e6, 8.1e6, 7.9e6, 8e6}};
    const MeanInterval plain = confirmed_interval(calibration.targets[0], observables, seen);
    const MeanInterval direct = mean_interval(std::vector<double>{118e6, 122e6, 126e6, 114e6});
    EXPECT_EQ(plain.count, 4);  // the failed one is left out
    EXPECT_NEAR(plain.mean, direct.mean, 1.0);
    EXPECT_NEAR(plain.half_width(), direct.half_width(), 1.0);
    const MeanInterval ratio = confirmed_interval(calibration.targets[1], observables, seen);
    EXPECT_NEAR(ratio.mean, 120e6 / 8.04e6, 1e-9);  // the direct tension of the packing whose uniaxial test failed counts
    EXPECT_GT(ratio.half_width(), 0.0);
}

TEST(Targets, OfCrackInitiationAreReadFromTheCrackVolumetricStrain) {
    const std::vector<Target> targets{{.name = "sigma_ci_over_UCS", .value = 0.45}, {.name = "sigma_cd_over_UCS", .value = 0.8}};
    const std::vector<Observable> quantities = observables_for(targets, {});
    ASSERT_EQ(quantities.size(), 3U);  // sigma_ci, UCS, sigma_cd, each once
    EXPECT_EQ(quantities[0].column, "sigma_ci_crack_volume_Pa");
    EXPECT_EQ(quantities[1].name, "UCS");
    EXPECT_DOUBLE_EQ(value_of(targets[0], quantities, {50e6, 100e6, 80e6}), 0.5);
    EXPECT_DOUBLE_EQ(value_of(targets[1], quantities, {50e6, 100e6, 80e6}), 0.8);
    EXPECT_EQ(property_of({.name = "sigma_ci"}), "sigma_ci_crack_volume_Pa");
}

}  // namespace
}  // namespace feldspar
