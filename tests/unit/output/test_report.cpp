// report.html: its data can be read, its text is escaped, it asks nobody for anything.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

#include "../../temporary_folder.hpp"
#include "feldspar/base/printable.hpp"
#include "feldspar/output/fragments.hpp"
#include "feldspar/output/report_data.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/output/squares.hpp"
#include "feldspar/output/variant_summary.hpp"
#include "synthetic_result.hpp"

namespace feldspar {
namespace {

using namespace testing;
using nlohmann::json;

std::string between(const std::string& text, const std::string& from, const std::string& to) {
    const std::size_t begin = text.find(from);
    if (begin == std::string::npos) return {};
    return text.substr(begin + from.size(), text.find(to, begin + from.size()) - begin - from.size());
}

std::vector<std::uint8_t> from_base64(const std::string& text) {
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<std::uint8_t> bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char letter : text) {
        if (letter == '=') break;
        bits = bits << 6 | static_cast<std::uint32_t>(letters.find(letter));
        count += 6;
        if (count >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (count -= 8)));
    }
    return bytes;
}

class Report : public ::testing::Test {
protected:
    TemporaryFolder scratch;
    RunDirectory directory = RunDirectory::create(scratch.path() / "run", "job");
    Job job = make_job();
    std::vector<TestResult> results = {make_result(), make_result(methods::uniaxial_compression, 4),
                                       make_result(methods::brazilian)};

    std::string page(bool complete = true) {
        write_report(directory, job, results, make_properties(), make_provenance(), complete);
        return read_text(directory.path() / "report.html");
    }
};

TEST_F(Report, HoldsDataThatReadsBack) {
    const json data = json::parse(between(page(), "id=\"data\">", "</script>"));
    EXPECT_EQ(data["job"]["name"], "augig");
    ASSERT_EQ(data["tests"].size(), 3U);
    EXPECT_EQ(data["tests"][0]["history"]["stress"].size(), results[0].history.size());
    EXPECT_NEAR(data["tests"][0]["history"]["strain"].back().get<double>(), 5.0, 1e-9);  // 10^-3
    EXPECT_TRUE(data["tests"][2]["nu"].is_null());
    EXPECT_EQ(data["properties"][0]["name"], "E_GPa");
    EXPECT_NEAR(data["properties"][0]["laboratory"].get<double>(), 25.8, 1e-9);
    ASSERT_EQ(data["fields"].size(), 3U);  // of a kind the weakest and the strongest packing
    EXPECT_EQ(data["fields"][1]["test"], 1);
    EXPECT_EQ(data["fields"][2]["test"], 2);
}

TEST_F(Report, MarksTheMomentsOfABrazilianTest) {
    const json data = json::parse(between(page(), "id=\"data\">", "</script>"));
    EXPECT_FALSE(data["tests"][0].contains("brazilian"));
    const json& brazilian = data["tests"][2]["brazilian"];
    EXPECT_TRUE(brazilian["flat_coefficient"].is_null()) << "of a whole disc";
    std::vector<std::string> names;
    for (const json& mark : brazilian["marks"]) names.push_back(mark["name"]);
    EXPECT_NE(std::find(names.begin(), names.end(), "first crack"), names.end());
    EXPECT_NE(std::find(names.begin(), names.end(), "strength"), names.end());
    for (const json& mark : brazilian["marks"]) {
        const std::size_t c = mark["crack"] < 0 ? results[2].cracks.size() : mark["crack"].get<std::size_t>();
        if (mark["name"] == "first crack") {
            ASSERT_LT(c, results[2].cracks.size());
            EXPECT_NEAR(mark["strain"].get<double>(), results[2].cracks[c].axial_strain * 1e3, 1e-6);
        } else if (mark["name"] == "strength") {  // on the curve that is drawn
            const auto stress = data["tests"][2]["history"]["stress"].get<std::vector<double>>();
            EXPECT_NE(std::find(stress.begin(), stress.end(), mark["stress"].get<double>()), stress.end());
        }
    }
}

TEST_F(Report, CountsAcousticEventsOverStrainAndMagnitude) {
    const json data = json::parse(between(page(), "id=\"data\">", "</script>"));
    const json& emission = data["tests"][0]["emission"];
    ASSERT_EQ(results[0].emission.events.size(), 2U);
    const auto total = [&](const char* key) {
        int sum = 0;
        for (const json& count : emission["rate"][key]) sum += count.get<int>();
        return sum;
    };
    EXPECT_EQ(total("before") + total("behind"), 2);
    EXPECT_EQ(emission["magnitudes"].front()[1], 2) << "all have at least the least magnitude";
    EXPECT_NEAR(emission["magnitudes"].back()[0].get<double>(), results[0].emission.events[0].magnitude, 0.1)
        << "the largest, within a step";
    results[0].cracks.clear();
    results[0].emission = {};
    EXPECT_TRUE(json::parse(between(page(), "id=\"data\">", "</script>"))["tests"][0]["emission"].is_null());
}

// Supplied = elastic + dissipated + kinetic + what is not accounted for, as the chart draws them, whatever the loading motion
// holds.
TEST_F(Report, ShowsABalanceOfEnergyThatCloses) {
    for (HistoryRow& row : results[0].history) {  // the loading motion's energy is put in by the rate control
        row.energy.kinetic = row.energy.rate_control = row.step % 100 == 0 ? 3.0 : 0.5;
        row.energy.kinetic += row.kinetic_deviation = 1e-3;
    }
    const json history = json::parse(between(page(), "id=\"data\">", "</script>"))["tests"][0]["history"];
    for (std::size_t r = 0; r < history["supplied"].size(); ++r) {
        double sum = 0.0;
        for (const char* part : {"grains", "contacts", "fracture", "friction", "damping", "kinetic", "residual"})
            sum += history[part][r].get<double>();
        EXPECT_NEAR(history["supplied"][r].get<double>(), sum, 1e-5 * (1.0 + sum));  // six digits are written
        EXPECT_NEAR(history["supplied"][r].get<double>(), results[0].history[r].energy.external, 1e-5 * (1.0 + sum))
            << "no step of the loading motion";
        EXPECT_NEAR(history["loading_motion"][r].get<double>(), results[0].history[r].energy.rate_control, 1e-5);
    }
}

TEST_F(Report, TellsMainPropertiesFromFurtherOnesWithTheirGrades) {
    const json properties = json::parse(between(page(), "id=\"data\">", "</script>"))["properties"];
    EXPECT_TRUE(properties[0]["main"].get<bool>()) << "E";
    EXPECT_EQ(properties[0]["grades"], (json{{"A", 2}, {"B", 0}, {"C", 0}})) << "of both compression tests";
    for (const json& property : properties) {
        const bool further = property["name"] == "UCS_over_BTS" || property["name"] == "E_tangent_GPa";
        EXPECT_FALSE(further && property["main"].get<bool>()) << property["name"];
    }
}

TEST_F(Report, ListsTheTestsThatFailedAndWhy) {
    EXPECT_TRUE(json::parse(between(page(), "id=\"data\">", "</script>"))["failed"].empty());
    TestSpec biaxial;
    biaxial.kind = methods::biaxial;
    biaxial.sigma3_Pa = 4e6;
    const std::vector<FailedTest> failed{{"", biaxial, 7, "a force is not a number </script>"}};
    write_report(directory, job, results, make_properties(), make_provenance(), false, failed);
    const std::string html = read_text(directory.path() / "report.html");
    const json list = json::parse(between(html, "id=\"data\">", "</script>"))["failed"];
    ASSERT_EQ(list.size(), 1U);
    EXPECT_EQ(list[0]["kind"], "biaxial");
    EXPECT_EQ(list[0]["sigma3"], 4);
    EXPECT_EQ(list[0]["seed"], 7);
    EXPECT_EQ(list[0]["reason"], failed[0].reason);
    // the page lays the list out before anything else of the results
    const std::string script = html.substr(html.find("function writeHeader()"));
    EXPECT_LT(script.find("writeFailed();"), script.find("function writeProperties()"));
    EXPECT_NE(html.find("\"These tests failed\""), std::string::npos);
}

TEST_F(Report, EscapesEverythingThatAUserCanWrite) {
    job.name = "</title><script>alert(1)</script> & \"quoted\" {{data}}";
    job.text = "name = '</script><!--<script>'\n";
    results[0].evidence.verdict = "</script><script>alert(2)</script>";
    const std::string html = page();
    EXPECT_EQ(html.find("alert(1)</script>"), std::string::npos);
    EXPECT_EQ(html.find("alert(2)</script>"), std::string::npos);
    EXPECT_EQ(html.find("<!--<script>"), std::string::npos);
    EXPECT_NE(
        html.find("<title>&lt;/title&gt;&lt;script&gt;alert(1)&lt;/script&gt; &amp; &quot;quoted&quot; {{data}} - Feldspar"),
        std::string::npos);
    const json data = json::parse(between(html, "id=\"data\">", "</script>"));
    EXPECT_EQ(data["job"]["name"], job.name);
    EXPECT_EQ(data["job"]["resolved"], resolved_toml(job));
}

TEST_F(Report, ShowsControlCharactersAsText) {
    job.name = "gra\x1b[31mnite\r\a";
    results[0].evidence.verdict = "one\ntwo\x7f\xc2\x9b";
    const std::string html = page();
    EXPECT_NE(html.find("<title>gra\\x1b[31mnite\\x0d\\x07 - Feldspar"), std::string::npos);
    for (const char* character : {"\x1b", "\r", "\a", "\x7f", "\xc2\x9b"})
        EXPECT_EQ(html.find(character), std::string::npos) << printable(character);
    const json data = json::parse(between(html, "id=\"data\">", "</script>"));
    EXPECT_EQ(data["job"]["name"], "gra\\x1b[31mnite\\x0d\\x07");
    EXPECT_EQ(data["tests"][0]["verdict"], "one\ntwo\\x7f\\x9b");
}

TEST_F(Report, ANameThatIsNoUnicodeDoesNotLoseTheReport) {
    job.name = "caf\xe9";
    EXPECT_FALSE(json::parse(between(page(), "id=\"data\">", "</script>")).empty());
}

TEST_F(Report, AsksTheNetworkForNothing) {
    const std::string html = page();
    for (const char* attribute : {"src", "href"}) {
        for (const char* address : {"=\"http", "='http", "=http", "=\"//", "='//"}) {
            EXPECT_EQ(html.find(std::string(attribute) + address), std::string::npos) << attribute << address;
        }
    }
    EXPECT_EQ(html.find("@import"), std::string::npos);
    EXPECT_EQ(html.find("url("), std::string::npos);
    EXPECT_EQ(html.find("fetch("), std::string::npos);
    EXPECT_EQ(html.find("XMLHttpRequest"), std::string::npos);
    EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
    for (const char* mark : {"{{uplot_css}}", "{{css}}", "{{data}}", "{{fields}}", "{{uplot_js}}", "{{charts_js}}",
                             "{{viewer_js}}", "{{compare_js}}", "{{report_js}}"}) {
        EXPECT_EQ(html.find(mark), std::string::npos) << mark;
    }
}

TEST_F(Report, OfNoResultsIsWhole) {
    results.clear();
    const json data = json::parse(between(page(false), "id=\"data\">", "</script>"));
    EXPECT_EQ(data["complete"], false);
    EXPECT_TRUE(data["fields"].empty());
}

/// One part of a block of fields.
template <class Number>
std::vector<Number> part(const ReportFields& fields, const std::string& name) {
    const std::vector<std::uint8_t> packed = from_base64(fields.block);
    std::vector<std::uint8_t> bytes(1 << 23);
    uLongf size = bytes.size();
    EXPECT_EQ(uncompress(bytes.data(), &size, packed.data(), packed.size()), Z_OK);
    const auto& place = fields.meta["parts"][name];
    std::vector<Number> values(place["count"].get<std::size_t>());
    std::memcpy(values.data(), bytes.data() + place["at"].get<std::size_t>(), values.size() * sizeof(Number));
    return values;
}

TEST(ReportFields, ReadBackWithinAStep) {
    const std::vector<TestResult> results = {make_result()};
    const auto list = report_fields(results, 1 << 20);
    ASSERT_EQ(list.size(), 1U);
    const ReportFields& fields = list[0];
    const GrainMesh& mesh = results[0].specimen->mesh;
    EXPECT_EQ(part<float>(fields, "nodes").size(), 2 * mesh.nodes.size());
    EXPECT_EQ(part<std::uint16_t>(fields, "corners")[3 * 5 + 2], 4);  // the centre of grain 1, counted from its first node
    EXPECT_EQ(part<std::uint8_t>(fields, "crack_mode"), (std::vector<std::uint8_t>{0, 1}));
    EXPECT_EQ(part<std::int32_t>(fields, "crack_nodes")[0], 1);  // the right edge of grain 0
    const double scale = fields.meta["snapshots"][1]["scale"].get<double>();
    const auto steps = part<std::int16_t>(fields, "u1");
    std::int16_t sum = 0;
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
        sum = static_cast<std::int16_t>(sum + steps[n]);
        EXPECT_NEAR(sum * scale, results[0].snapshots[1].displacement_m[n].x * 1e3, scale);
    }
    EXPECT_EQ(part<std::uint8_t>(fields, "damage1")[1], 255);
    const auto levels = part<std::uint8_t>(fields, "sigma1_2");
    EXPECT_EQ(levels.size(), mesh.triangles.size());
}

TEST(ReportFields, StayWithinTheBudget) {
    const std::vector<TestResult> results = {make_result(methods::uniaxial_compression, 1, 12, 12),
                                             make_result(methods::brazilian, 1, 12, 12)};
    const auto all = report_fields(results, 1 << 20);
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[0].meta["snapshots"].size(), 3U);
    const std::size_t one = all[0].block.size();
    const auto tight = report_fields(results, 2 * one - 2);  // the first loses its start; so may the second, or has what is left
    ASSERT_EQ(tight.size(), 2U);
    EXPECT_EQ(tight[0].meta["snapshots"].size(), 2U);
    EXPECT_LE(tight[0].block.size() + tight[1].block.size(), 2 * one - 2);
    EXPECT_TRUE(report_fields(results, 10).empty());
}

TEST(ReportFields, AreOfTheMedianTheWeakestAndTheStrongestPacking) {
    std::vector<TestResult> results;
    for (const double strength_MPa : {5.0, 3.0, 1.0, 4.0, 2.0}) {
        results.push_back(make_result(methods::uniaxial_compression, static_cast<std::uint64_t>(strength_MPa)));
        results.back().properties.peak_stress_Pa = 1e6 * strength_MPa;
    }
    results.push_back(make_result(methods::brazilian));
    const auto list = report_fields(results, 1 << 20);
    ASSERT_EQ(list.size(), 4U);
    const auto is = [&](std::size_t i, const char* role, std::size_t test) {
        EXPECT_EQ(list[i].meta["role"], role);
        EXPECT_EQ(list[i].meta["test"], test);
    };
    is(0, "median", 1);
    is(1, "weakest", 2);
    is(2, "strongest", 0);
    is(3, "", 5);  // alone
    const auto scarce =
        report_fields(results, 3 * list[0].block.size());  // where there is little room, every kind has its median at least
    ASSERT_GE(scarce.size(), 2U);
    EXPECT_EQ(scarce[0].meta["role"], "median");
    EXPECT_EQ(scarce.back().meta["test"], 5U);
}

// A wall of 200 x 200 grains, whose squares of 2 mm have four grains each.
TEST(Squares, HaveTheMeansOfTheGrainsInThem) {
    TestResult result = make_result(methods::uniaxial_compression, 3, 200, 200);
    const auto stress_of = [](std::size_t grain) { return 1e6 * static_cast<double>(grain % 7); };
    Snapshot& snapshot = result.snapshots.back();
    for (std::size_t t = 0; t < snapshot.stress_xx_Pa.size(); ++t) {
        snapshot.stress_xx_Pa[t] = stress_of(t / 4);
        snapshot.damage[t] = t / 4 == 0 ? 1.0F : 0.0F;
    }
    for (std::size_t n = 0; n < snapshot.displacement_m.size(); ++n)
        snapshot.displacement_m[n] = 1e-3 * result.specimen->mesh.nodes[n];
    result.cracks.assign(100'001, result.cracks.front());
    for (std::size_t c = 0; c < result.cracks.size(); ++c) result.cracks[c].place = {0.101, 0.0505};  // square 50 of row 25
    const Squares squares = in_squares(result, 10'000);
    EXPECT_NEAR(squares.side_m, 2e-3, 1e-12);
    EXPECT_DOUBLE_EQ(squares.grains_in_one, 4.0);
    const GrainMesh& mesh = squares.result.specimen->mesh;
    ASSERT_EQ(mesh.vertex_count.size(), 10'000U);
    const Snapshot& drawn = squares.result.snapshots.back();
    for (const std::size_t square : {0UL, 77UL, 9999UL}) {
        const std::size_t first = 2 * (square % 100) + 400 * (square / 100);  // the grain at its lower left
        const double mean = 0.25 * (stress_of(first) + stress_of(first + 1) + stress_of(first + 200) + stress_of(first + 201));
        EXPECT_NEAR(drawn.stress_xx_Pa[2 * square], mean, 1e-6);
        EXPECT_EQ(drawn.stress_xx_Pa[2 * square + 1], drawn.stress_xx_Pa[2 * square]);
    }
    EXPECT_NEAR(drawn.damage[0], 0.25, 1e-6);
    EXPECT_EQ(drawn.damage[2], 0.0F);
    const int inner = 4 * (25 * 100 + 50);  // its lower left corner, around which the wall is the same in all directions
    EXPECT_NEAR(mesh.nodes[inner].x, 0.100, 1e-12);
    EXPECT_NEAR(drawn.displacement_m[inner].x, 1e-3 * 0.100, 1e-9);
    EXPECT_NEAR(drawn.displacement_m[inner].y, 1e-3 * 0.050, 1e-9);
    EXPECT_EQ(squares.crack_every, 3);
    EXPECT_EQ(squares.result.cracks.size(), 33'334U);
    EXPECT_EQ(squares.square_of_crack.back(), 25 * 100 + 50);
}

TEST(Squares, StandForASpecimenThatIsTooLargeToDraw) {
    const std::vector<TestResult> results = {make_result(methods::uniaxial_compression, 3, 200, 200)};
    const auto list = report_fields(results, 4 << 20);
    ASSERT_EQ(list.size(), 1U);
    EXPECT_NEAR(list[0].meta["squares"]["grains"].get<double>(), 2.5, 0.05);  // whole numbers of rows and columns
    EXPECT_EQ(list[0].meta["snapshots"].size(), 3U);
    EXPECT_EQ(list[0].meta["snapshots"][2]["cracks"], 2);
    EXPECT_EQ(list[0].meta["snapshots"][2]["tensile"], 1);
    EXPECT_EQ(part<std::int32_t>(list[0], "crack_square").size(), 2U);
    const auto tight = report_fields(results, list[0].block.size() / 3);  // fewer moments first, then larger squares
    ASSERT_EQ(tight.size(), 1U);
    EXPECT_LE(tight[0].block.size(), list[0].block.size() / 3);
    EXPECT_TRUE(tight[0].meta.contains("squares"));
    EXPECT_FALSE(report_fields(std::vector{make_result()}, 1 << 20)[0].meta.contains("squares")) << "a small one has its grains";
    const auto patterns = report_patterns(results);
    EXPECT_EQ(part<std::int32_t>(patterns[0], "begin").size(), 801U) << "the border of the wall, not its grains";
}

TEST(Fragments, HangTogetherWhileATenthOfTheirEdgeIsWhole) {
    const TestResult result = make_result();  // 4 x 3 grains
    const Specimen& specimen = *result.specimen;
    std::vector<Crack> cracks;
    const auto cut = [&](int a, int b, double share) {  // of the edge between them
        Crack crack;
        crack.grain_a = b;
        crack.grain_b = a;
        crack.to = {share * 1e-3, 0.0};
        cracks.push_back(crack);
    };
    EXPECT_EQ(fragments(specimen, cracks, 0), std::vector<int>(12, 0));
    for (int row = 0; row < 3; ++row)
        cut(4 * row, 4 * row + 1, row == 1 ? 0.89 : 1.0);  // between the first column and the second
    EXPECT_EQ(fragments(specimen, cracks, 3), std::vector<int>(12, 0)) << "the middle one holds";
    cut(4, 5, 0.02);
    EXPECT_EQ(fragments(specimen, cracks, 4), (std::vector<int>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}));
    EXPECT_EQ(fragments(specimen, cracks, 3), std::vector<int>(12, 0));
    cut(10, 11, 1.0);
    cut(7, 11, 1.0);
    EXPECT_EQ(fragments(specimen, cracks, 6), (std::vector<int>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 2}));
    EXPECT_EQ(part<std::int32_t>(report_fields(std::vector{result}, 1 << 20)[0], "fragment2"), std::vector<int>(12, 0));
}

TEST(Base64, MatchesItsDefinition) {
    const auto encode = [](const std::string& text) {
        return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    };
    EXPECT_EQ(encode(""), "");
    EXPECT_EQ(encode("f"), "Zg==");
    EXPECT_EQ(encode("fo"), "Zm8=");
    EXPECT_EQ(encode("foobar"), "Zm9vYmFy");
}

/// A job of two variants on two packings.
class VariantReport : public Report {
protected:
    VariantReport() {
        job.variants = make_variants();
        results.clear();
        for (const std::uint64_t seed : {3, 4}) {
            const auto packing = make_wall(4, 3, seed);  // shared by the variants
            for (const Variant& variant : job.variants) {
                results.push_back(make_result_of(variant, seed));
                results.back().specimen = packing;
            }
        }
    }
};

TEST_F(VariantReport, TellsThemApart) {
    const json data = json::parse(between(page(), "id=\"data\">", "</script>"));
    EXPECT_TRUE(data["properties"].empty());
    ASSERT_EQ(data["variants"].size(), 2U);
    EXPECT_EQ(data["variants"][0]["name"], "rigid, brittle");
    EXPECT_EQ(data["variants"][1]["normal"], "edge");
    EXPECT_EQ(data["variants"][1]["ms_per_step"]["uniaxial-compression"], 2);
    EXPECT_FALSE(data["variants"][0]["properties"].empty());
    EXPECT_EQ(data["tests"][1]["variant"], "inner particles");
    const json& history = data["tests"][0]["history"];
    EXPECT_EQ(history["broken"].size(), history["stress"].size());
    EXPECT_EQ(history["broken"].front(), 0);
    EXPECT_NEAR(history["broken"].back().get<double>(), 100.0 * broken_share(results[0]).back(), 1e-4);
    EXPECT_EQ(data["fields"].size(), 2U);  // one packing a variant
}

TEST_F(VariantReport, HasTheCracksOfEveryTest) {
    const std::string html = page();
    const json data = json::parse(between(html, "id=\"data\">", "</script>"));
    ASSERT_EQ(data["patterns"].size(), 2U);  // one a packing
    EXPECT_EQ(data["patterns"][1]["tests"][0]["test"], 2);
    EXPECT_EQ(data["patterns"][1]["tests"][1]["test"], 3);
    EXPECT_NE(html.find("id=\"pattern-1\""), std::string::npos);
    const std::vector<ReportFields> patterns = report_patterns(results);
    const auto ends = part<std::uint16_t>(patterns[0], "ends1");
    const double x0 = patterns[0].meta["x0"], y0 = patterns[0].meta["y0"], scale = patterns[0].meta["scale"];
    ASSERT_EQ(ends.size(), 8U);
    EXPECT_NEAR(x0 + scale * ends[0], 1.0, 1e-3);  // mm
    EXPECT_NEAR(y0 + scale * ends[1], 0.25, 1e-3);
    EXPECT_EQ(part<std::uint8_t>(patterns[0], "mode1"), (std::vector<std::uint8_t>{0, 1}));
    EXPECT_EQ(part<std::int32_t>(patterns[0], "begin").back(), 48);  // twelve grains of four corners
}

TEST_F(VariantReport, SharesItsFieldsFairly) {
    const std::vector<ReportFields> all = report_fields(results, std::size_t{1} << 20);
    ASSERT_EQ(all.size(), 2U);
    ASSERT_EQ(all[0].meta["snapshots"].size(), 3U);
    // too little for one in full beside anything of the other: both become coarser
    const std::vector<ReportFields> scarce = report_fields(results, 2 * all[0].block.size() - 2);
    ASSERT_EQ(scarce.size(), 2U);
    EXPECT_LT(scarce[0].meta["snapshots"].size(), 3U);
    EXPECT_EQ(scarce[0].meta["snapshots"].back()["label"], "end");
}

}  // namespace
}  // namespace feldspar
