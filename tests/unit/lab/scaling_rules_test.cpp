// The rules of first parameters against the runs they were fitted to, and their inverse.
#include "feldspar/lab/scaling_rules.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>

using namespace feldspar;

namespace {

constexpr double grain_m = 3e-3;

// The table's rows by column.
std::vector<std::map<std::string, std::string>> rows_of_table() {
    std::ifstream file(std::string(FELDSPAR_SOURCE_DIR) + "/docs/validation/first-parameters.csv");
    std::vector<std::map<std::string, std::string>> rows;
    std::vector<std::string> names;
    for (std::string line; std::getline(file, line);) {
        std::vector<std::string> cells;
        std::istringstream in(line + ",");
        for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
        if (names.empty()) {
            names = cells;
            continue;
        }
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (i == 0) rows.emplace_back();
            rows.back()[names[i]] = i < cells.size() ? cells[i] : "";
        }
    }
    return rows;
}

}  // namespace

TEST(ScalingRules, AreThoseOfTheTable) {
    const auto rows = rows_of_table();
    ASSERT_GT(rows.size(), 80u);
    double UCS = 0.0, DTS = 0.0, BTS = 0.0;
    int even = 0;
    for (const auto& row : rows) {
        const auto number = [&](const char* name) { return std::stod(row.at(name)); };
        if (!row.at("weibull_modulus").empty() || number("mu") > 0.9) continue;  // as the fit of even rocks
        const GrainMaterial grain{number("E_GPa") * 1e9, number("nu"), 2650.0};
        ContactMaterial c;
        c.Kn_Pa_m = number("Kn_GPa_m") * 1e9;
        c.eta = number("eta");
        c.sigma_nt_Pa = number("sigma_nt_MPa") * 1e6;
        c.tau_Pa = number("tau_MPa") * 1e6;
        c.mu = number("mu");
        c.Gfn_J_m2 = number("Gfn_N_m");
        c.Gfs_J_m2 = number("Gfs_N_m");
        const RockNumbers expected = expected_rock(grain, c, grain_m);
        ++even;
        UCS += std::pow(std::log(expected.UCS_Pa / (number("UCS_MPa") * 1e6)), 2);
        DTS += std::pow(std::log(expected.DTS_Pa / (number("DTS_MPa") * 1e6)), 2);
        BTS += std::pow(std::log(expected.BTS_Pa / (number("BTS_MPa") * 1e6)), 2);
        EXPECT_NEAR(expected.E_Pa / (number("E_rock_GPa") * 1e9), 1.0, 0.02)
            << row.at("point");  // the modulus follows from stiffnesses alone
        EXPECT_NEAR(expected.nu, number("nu_rock"), 0.02)
            << row.at("point");  // to 0.003 but where it cracks before a tenth of its strength
    }
    ASSERT_GT(even, 60);
    // On the packings that they were fitted to the rules err less than on those that were left out.
    EXPECT_LT(std::sqrt(UCS / even), rule_errors.UCS);
    EXPECT_LT(std::sqrt(DTS / even), rule_errors.DTS);
    EXPECT_LT(std::sqrt(BTS / even), rule_errors.BTS);
}

TEST(ScalingRules, RatiosRiseAlongTheWay) {
    // The wanted ratio moves tau/sigma_nt, friction and brittleness together, so a higher ratio has more of each.
    double tau = 0.0, mu = 0.0, brittle = 1e9;
    for (const double ratio : {7.0, 9.0, 12.0, 16.0, 20.0}) {
        RockTargets targets;
        targets.E_Pa = 40e9;
        targets.UCS_Pa = 120e6;
        targets.BTS_Pa = 120e6 / ratio;
        const FirstParameters first = first_parameters(targets, grain_m);
        ASSERT_TRUE(first.ratio_reached()) << ratio;
        const ContactMaterial& c = first.contact;
        EXPECT_GT(c.tau_Pa / c.sigma_nt_Pa, tau);
        EXPECT_GT(c.mu, mu);
        EXPECT_LT(c.Gfn_J_m2 / (c.sigma_nt_Pa * c.sigma_nt_Pa), brittle);
        tau = c.tau_Pa / c.sigma_nt_Pa;
        mu = c.mu;
        brittle = c.Gfn_J_m2 / (c.sigma_nt_Pa * c.sigma_nt_Pa);
    }
}

TEST(ScalingRules, FrictionFollowsTheAngle) {
    RockTargets targets;
    targets.E_Pa = 40e9;
    targets.UCS_Pa = 120e6;
    targets.BTS_Pa = 12e6;
    targets.friction_angle_deg = 45.0;
    const FirstParameters low = first_parameters(targets, grain_m);
    targets.friction_angle_deg = 55.0;
    const FirstParameters high = first_parameters(targets, grain_m);
    EXPECT_TRUE(low.friction_reached && high.friction_reached);
    EXPECT_LT(low.contact.mu, high.contact.mu);
    EXPECT_NEAR(high.expected.friction_angle_deg, 55.0, 0.1);
    targets.friction_angle_deg = 15.0;  // no contacts of the experiment have so little
    EXPECT_FALSE(first_parameters(targets, grain_m).friction_reached);
}

TEST(ScalingRules, CohesionAndFrictionAngleStandForTheStrength) {
    RockTargets targets;
    targets.E_Pa = 40e9;
    targets.cohesion_Pa = 20e6;
    targets.friction_angle_deg = 50.0;
    targets.BTS_Pa = 10e6;
    const FirstParameters first = first_parameters(targets, grain_m);
    const double UCS_Pa = 2.0 * 20e6 * 2.74748;  // tan 70 deg
    EXPECT_NEAR(first.wanted_ratio, UCS_Pa / 10e6, 1e-4);
    EXPECT_NEAR(first.expected.UCS_Pa / UCS_Pa, 1.0, 1e-5);
}

TEST(ScalingRules, ScatterRaisesTheRatio) {
    RockTargets targets;
    targets.E_Pa = 40e9;
    targets.UCS_Pa = 120e6;
    targets.BTS_Pa = 120e6 / 24.0;
    EXPECT_GT(first_parameters(targets, grain_m).wanted_ratio, first_parameters(targets, grain_m).highest_ratio);
    const auto scatter = scatter_for(targets, grain_m);
    ASSERT_TRUE(scatter.has_value());
    EXPECT_NEAR(first_parameters(targets, grain_m, *scatter).highest_ratio / 24.0, 1.0, 1e-3);  // the least that does
    targets.BTS_Pa = 120e6 / 100.0;
    EXPECT_FALSE(scatter_for(targets, grain_m).has_value());
    EXPECT_THROW(first_parameters({}, grain_m), std::invalid_argument);
}
