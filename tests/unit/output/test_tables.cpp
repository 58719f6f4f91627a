// The files that users read as tables: history CSV and summary.json.
#include <gtest/gtest.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "../../temporary_folder.hpp"
#include "feldspar/output/history_columns.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/output/user_units.hpp"
#include "feldspar/output/variant_summary.hpp"
#include "synthetic_result.hpp"

namespace feldspar {
namespace {

using namespace testing;
using nlohmann::json;

class Tables : public ::testing::Test {
protected:
    TemporaryFolder scratch;
    RunDirectory directory = RunDirectory::create(scratch.path() / "run", "job");

    json summary(const std::vector<TestResult>& results, bool complete = true) {
        write_summary(directory, make_job(), results, make_properties(), make_provenance(), complete);
        return json::parse(read_text(directory.path() / "summary.json"));
    }
};

std::vector<std::string> split(const std::string& line, char mark) {
    std::vector<std::string> parts;
    std::istringstream stream(line);
    for (std::string part; std::getline(stream, part, mark);) parts.push_back(part);
    return parts;
}

TEST(TestStem, NamesKindSeedAndPressure) {
    EXPECT_EQ(test_stem(make_result()), "uniaxial-compression-s3");
    TestResult biaxial = make_result(methods::biaxial, 1);
    EXPECT_EQ(test_stem(biaxial), "biaxial-s1-p4");
    biaxial.test.sigma3_Pa = 2.5e6;
    EXPECT_EQ(test_stem(biaxial), "biaxial-s1-p2.5");
    biaxial.test.sigma3_Pa = 10e6;
    EXPECT_EQ(test_stem(biaxial), "biaxial-s1-p10");
}

TEST(TestStem, BeginsWithTheVariant) {
    TestResult result = make_result();
    result.variant = "Rigid, brittle";
    EXPECT_EQ(test_stem(result), "rigid-brittle-uniaxial-compression-s3");
}

TEST_F(Tables, AVariantStaysInItsLineOfTheHistory) {
    TestResult result = make_result();
    result.variant = "rigid\n\x1b[31m1,2";
    write_history_csv(directory, result, make_provenance());
    EXPECT_NE(
        read_text(directory.path() / ("history-" + test_stem(result) + ".csv")).find("\n# variant: rigid\\x0a\\x1b[31m1,2\n"),
        std::string::npos);
}

TEST_F(Tables, SummaryListsTestsThatFailed) {
    EXPECT_FALSE(summary({make_result()}).contains("failed")) << "of none";
    TestSpec biaxial;
    biaxial.kind = methods::biaxial;
    biaxial.sigma3_Pa = 2.5e6;
    const std::vector<FailedTest> failed{{"", biaxial, 7, "a force is not a number"},
                                         {"rigid, brittle", TestSpec{}, 3, "it did not relax"}};
    write_summary(directory, make_job(), std::vector{make_result()}, make_properties(), make_provenance(), false, failed);
    const json list = json::parse(read_text(directory.path() / "summary.json")).at("failed");
    EXPECT_EQ(list, json::parse(R"([
        {"name": "biaxial-s7-p2.5", "kind": "biaxial", "seed": 7, "sigma3_MPa": 2.5, "reason": "a force is not a number"},
        {"variant": "rigid, brittle", "name": "rigid-brittle-uniaxial-compression-s3", "kind": "uniaxial-compression", "seed": 3,
         "reason": "it did not relax"}])"));
}

TEST_F(Tables, SummaryKeepsVariantsApart) {
    Job job = make_job();
    job.variants = make_variants();
    std::vector<TestResult> results;
    for (const Variant& variant : job.variants)
        for (const std::uint64_t seed : {3, 4}) results.push_back(make_result_of(variant, seed));
    results.back().ms_per_step = 4.0;
    write_summary(directory, job, results, make_properties(), make_provenance(), true);
    const json read = json::parse(read_text(directory.path() / "summary.json"));
    EXPECT_TRUE(read["properties"].empty());
    EXPECT_TRUE(read["envelope"]["fits"].empty());
    EXPECT_EQ(read["tests"][0]["variant"], "rigid, brittle");
    ASSERT_EQ(read["variants"].size(), 2U);
    const json& rigid = read["variants"][0];
    EXPECT_EQ(rigid["name"], "rigid, brittle");
    EXPECT_EQ(rigid["model"], "rigid");
    EXPECT_EQ(rigid["contact"], "lobatto3");
    EXPECT_EQ(rigid["normal"], "centres");
    EXPECT_EQ(rigid["law"], "brittle");
    EXPECT_EQ(rigid["properties"]["UCS_MPa"]["seeds"], (std::vector<int>{3, 4}));
    EXPECT_NEAR(rigid["properties"]["UCS_MPa"]["median"].get<double>(), 122.1, 1e-9);
    EXPECT_TRUE(rigid.contains("envelope"));
    EXPECT_EQ(rigid["ms_per_step"]["uniaxial-compression"], 1.0);
    const json& inner = read["variants"][1];
    EXPECT_EQ(inner["model"], "inner-particles");
    EXPECT_EQ(inner["normal"], "edge");
    EXPECT_EQ(inner["ms_per_step"]["uniaxial-compression"], 3.0);  // median of 2 and 4
}

TEST_F(Tables, SummaryWithoutVariantsSaysNothingOfThem) {
    const json read = summary({make_result()});
    EXPECT_FALSE(read.contains("variants"));
    EXPECT_FALSE(read["tests"][0].contains("variant"));
}

TEST(BrokenShare, IsThatOfTheContactsBetweenGrains) {
    TestResult result = make_result();
    // 4 x 3 grains of 1 mm: 17 contacts of 1 mm, as thick as the specimen; each crack is half a contact
    const double crack = result.cracks[0].area_m2 / (17e-3 * result.specimen->spec.thickness_m);
    const std::vector<double> share = broken_share(result);
    ASSERT_EQ(share.size(), 3U);
    EXPECT_EQ(share[0], 0.0);
    EXPECT_NEAR(share[1], crack, 1e-12);
    EXPECT_NEAR(share[2], 2.0 * crack, 1e-12);
}

TEST_F(Tables, HistoryHasAHeaderThatSaysUnitsAndSigns) {
    write_history_csv(directory, make_result(), make_provenance());
    const std::string text = read_text(directory.path() / "history-uniaxial-compression-s3.csv");
    EXPECT_NE(text.find("# signs: compression positive"), std::string::npos);
    for (const HistoryColumn& column : history_columns()) {
        EXPECT_NE(text.find(std::string("#   ") + column.name + " [" + column.unit + "]"), std::string::npos) << column.name;
    }
}

TEST_F(Tables, HistoryReadsBackToTheLastBit) {
    const TestResult result = make_result();
    write_history_csv(directory, result, make_provenance());
    std::istringstream stream(read_text(directory.path() / "history-uniaxial-compression-s3.csv"));
    std::string line;
    while (std::getline(stream, line) && line.starts_with("#")) {
    }
    const auto names = split(line, ',');
    const auto columns = history_columns();
    ASSERT_EQ(names.size(), columns.size());
    for (std::size_t c = 0; c < columns.size(); ++c) EXPECT_EQ(names[c], columns[c].name);
    std::size_t row = 0;
    for (; std::getline(stream, line); ++row) {
        const auto cells = split(line, ',');
        ASSERT_EQ(cells.size(), columns.size());
        for (std::size_t c = 0; c < columns.size(); ++c) {
            double value = 0.0;
            std::from_chars(cells[c].data(), cells[c].data() + cells[c].size(), value);
            EXPECT_EQ(value, columns[c].value(result.history[row])) << names[c];
        }
    }
    EXPECT_EQ(row, result.history.size());
}

TEST_F(Tables, HistoryDependsOnTheResultsAlone) {
    TestResult result = make_result();
    write_history_csv(directory, result, make_provenance());
    const std::string before = read_text(directory.path() / "history-uniaxial-compression-s3.csv");
    Provenance later = make_provenance();
    later.started = "2027-01-01T00:00:00Z";
    later.machine = "another machine";
    later.threads = 64;
    later.command_line = "feldspar run --threads 64 augig.toml";
    result.threads = 64;
    result.wall_s = 1.0;
    write_history_csv(directory, result, later);
    EXPECT_EQ(read_text(directory.path() / "history-uniaxial-compression-s3.csv"), before);
}

TEST_F(Tables, SummaryHasEveryPromisedName) {
    const json top = summary({make_result(), make_result(methods::brazilian, 3)});
    for (const char* name : {"version", "commit", "seeds", "specimen", "brazilian_specimen", "tests", "properties", "laboratory",
                             "envelope", "job", "provenance", "complete", "signs"}) {
        EXPECT_TRUE(top.contains(name)) << name;
    }
    for (const char* name : {"grains", "contacts", "nodes", "triangles", "merged_edges", "vertices_per_grain", "grain_sizes_mm",
                             "asked_sizes_mm", "size_spread", "hexatic_order"}) {
        EXPECT_TRUE(top["specimen"].contains(name)) << name;
    }
    for (const char* name : {"kind",
                             "model",
                             "contact",
                             "law",
                             "numerics",
                             "plane",
                             "seed",
                             "sigma3_MPa",
                             "peak_stress_MPa",
                             "section_width_mm",
                             "remarks",
                             "peak_reached",
                             "first_crack_MPa",
                             "E_GPa",
                             "E_tangent_GPa",
                             "nu",
                             "steps",
                             "steps_to_peak",
                             "preparation_steps",
                             "wall_s",
                             "ms_per_step",
                             "threads",
                             "error_estimate",
                             "error_bound",
                             "residual_median",
                             "load_per_travel_time",
                             "imbalance_mean",
                             "travel_time",
                             "residual_mean",
                             "residual_at_peak",
                             "imbalance_max",
                             "kinetic_over_strain",
                             "damping_over_fracture",
                             "cracks_tensile",
                             "cracks_shear",
                             "energy_residual",
                             "quasi_static"}) {
        EXPECT_TRUE(top["tests"][0].contains(name)) << name;
    }
    for (const char* name : {"E_GPa", "nu", "UCS_MPa", "cohesion_MPa", "friction_angle_deg", "hoek_brown_mi"}) {
        for (const char* part : {"median", "minimum", "maximum", "seeds"})
            EXPECT_TRUE(top["properties"][name].contains(part)) << name;
    }
}

TEST_F(Tables, SummaryIsInUserUnits) {
    const json top = summary({make_result(), make_result(methods::biaxial, 4)}, false);
    const json& test = top["tests"][0];
    EXPECT_EQ(test["kind"], "uniaxial-compression");
    EXPECT_EQ(test["contact"], "lobatto3");
    EXPECT_EQ(test["plane"], "stress");
    EXPECT_NEAR(test["peak_stress_MPa"].get<double>(), 122.1, 1e-12);
    EXPECT_NEAR(test["E_GPa"].get<double>(), 25.0, 1e-12);
    EXPECT_NEAR(test["section_width_mm"].get<double>(), 80.0, 1e-12);
    EXPECT_EQ(test["remarks"][0], "A remark on the numbers.");
    for (const char* part : {"mean", "minimum", "maximum", "D50"}) EXPECT_TRUE(top["specimen"]["grain_sizes_mm"].contains(part));
    EXPECT_EQ(test["cracks_tensile"], 1);
    EXPECT_EQ(test["cracks_shear"], 1);
    EXPECT_EQ(test["quasi_static"], "A");
    EXPECT_NEAR(top["tests"][1]["sigma3_MPa"].get<double>(), 4.0, 1e-12);
    EXPECT_NEAR(top["properties"]["UCS_MPa"]["median"].get<double>(), 120.0, 1e-12);
    EXPECT_NEAR(top["properties"]["E_GPa"]["maximum"].get<double>(), 26.0, 1e-12);
    EXPECT_NEAR(top["properties"]["friction_angle_deg"]["median"].get<double>(), 52.0, 1e-12);
    EXPECT_NEAR(top["laboratory"]["friction_angle_deg"].get<double>(), 53.0, 0.01);
    EXPECT_NEAR(top["laboratory"]["UCS_MPa"].get<double>(), 122.1, 1e-12);
    EXPECT_NEAR(top["envelope"]["fits"][0]["sigma1_MPa"][2].get<double>(), 200.0, 1e-12);
    EXPECT_EQ(top["specimens"].size(), 2U);
    EXPECT_EQ(top["specimen"]["grains"], 12);
    EXPECT_EQ(top["complete"], false);
}

TEST_F(Tables, WhatIsNotDefinedIsNull) {
    const json top = summary({make_result(methods::brazilian)});
    EXPECT_TRUE(top["tests"][0]["nu"].is_null());
    EXPECT_TRUE(top["tests"][0]["sigma_cd_MPa"].is_null());
    EXPECT_TRUE(top["tests"][0]["peak_change_at_third"].is_null());
    EXPECT_TRUE(top["properties"]["hoek_brown_mi"]["median"].is_null());
}

TEST_F(Tables, SummaryOfNothingIsStillWhole) {
    const json top = summary({}, false);
    EXPECT_TRUE(top["tests"].empty());
    EXPECT_EQ(top["complete"], false);
}

TEST_F(Tables, SummaryListsTheFilesThatExist) {
    const TestResult result = make_result();
    EXPECT_TRUE(summary({result})["tests"][0]["files"].empty());
    write_history_csv(directory, result, make_provenance());
    EXPECT_EQ(summary({result})["tests"][0]["files"]["history"], "history-uniaxial-compression-s3.csv");
}

TEST(UserUnits, EveryNameCarriesItsUnit) {
    EXPECT_EQ(user_quantity("E_tangent_Pa").name, "E_tangent_GPa");
    EXPECT_EQ(user_quantity("BTS_Pa").name, "BTS_MPa");
    EXPECT_EQ(user_quantity("hoek_brown_UCS_Pa").name, "hoek_brown_UCS_MPa");
    EXPECT_EQ(user_quantity("nu").name, "nu");
    EXPECT_EQ(user_quantity("unheard_of").label, "unheard_of");
    EXPECT_EQ(user_quantity("sigma1_at_sigma3_10MPa_Pa").label, "Strength at \u03c3\u2083 = 10 MPa");
    EXPECT_LT(user_quantity("sigma1_at_sigma3_4MPa_Pa").rank, user_quantity("sigma1_at_sigma3_10MPa_Pa").rank);
    EXPECT_LT(user_quantity("sigma1_at_sigma3_10MPa_Pa").rank, user_quantity("sigma_cd_Pa").rank);
    EXPECT_EQ(property_of_laboratory("friction_angle"), "friction_angle_deg");
    EXPECT_EQ(property_of_laboratory("E"), "E_Pa");
}

TEST(Provenance, NamesProgramMachineAndTime) {
    const Provenance provenance = collect_provenance("feldspar run job.toml", 2);
    EXPECT_FALSE(provenance.version.empty());
    EXPECT_FALSE(provenance.commit.empty());
    EXPECT_FALSE(provenance.machine.empty());
    EXPECT_FALSE(provenance.compiler.empty());
    ASSERT_EQ(provenance.started.size(), 20U);
    EXPECT_EQ(provenance.started.back(), 'Z');
    EXPECT_EQ(provenance.threads, 2);
}

}  // namespace
}  // namespace feldspar
