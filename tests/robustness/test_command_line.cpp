// The command line: what it offers, what it refuses, and where it writes.
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "program.hpp"

namespace feldspar::testing_program {
namespace {

TEST(CommandLine, HelpAndVersion) {
    const TemporaryFolder place;
    const Outcome help = run_program(place.path(), {"--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_NE(help.out.find("Examples:"), std::string::npos);
    EXPECT_NE(help.out.find("feldspar run"), std::string::npos);
    for (const char* command : {"run", "check", "view", "export", "new", "schema", "study", "envelope", "converge", "claims",
                                "calibrate", "export-cells", "verify"}) {
        const Outcome own = run_program(place.path(), {command, "--help"});
        EXPECT_EQ(own.code, 0);
        EXPECT_NE(own.out.find(std::string("Examples:\n  feldspar ")), std::string::npos) << own.out;
        EXPECT_NE(own.out.find(std::string("feldspar ") + command), std::string::npos) << own.out;
    }
    const Outcome version = run_program(place.path(), {"--version"});
    EXPECT_EQ(version.code, 0);
    EXPECT_EQ(version.out.rfind("feldspar 0.", 0), 0u) << version.out;
    EXPECT_TRUE(place.entries().empty());
}

TEST(CommandLine, RefusesWhatItDoesNotKnow) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    const std::vector<std::vector<std::string>> cases{
        {},
        {"walk"},
        {"run"},
        {"check"},
        {"new"},
        {"new", "triaxial"},
        {"new", "biaxial", "--presets"},
        {"new", "--presets", "--out", "x.toml"},
        {"schema", "job.toml"},
        {"schema", "--out"},
        {"run", "job.toml", "--fast"},
        {"run", "job.toml", "--threads", "0"},
        {"run", "job.toml", "--threads", "many"},
        {"run", "job.toml", "--at-once", "0"},
        {"run", "job.toml", "--at-once", "-2"},
        {"run", "job.toml", "--at-once", "257"},
        {"run", "job.toml", "--at-once", "1.5"},
        {"run", "job.toml", "--at-once", "all"},
        {"run", "job.toml", "--at-once"},
        {"check", "job.toml", "--at-once", "0"},
        {"run", "job.toml", "--seed", "-1"},
        {"run", "job.toml", "--seed", "1.5"},
        {"run", "job.toml", "--seed", "1", "--seed", "1"},
        {"run", "job.toml", "--seed"},
        {"run", "job.toml", "--out"},
        {"run", "job.toml", "--out", ""},
        {"run", "job.toml", "other.toml"},
        {"check", "job.toml", "--out", "x"},
        {"run", "job.toml", "--keep", "some"},
        {"run", "job.toml", "--set", "material.contact.tau"},
        {"run", "job.toml", "--set", "material.contact.tua=1MPa"},
        {"run", "job.toml", "--fresh", "--continue"},
        {"run", "job.toml", "--continue"},
        {"export"},
        {"export", "job.toml"},
        {"export", "none", "--vtu"},
        {"export", ".", "--vtu"},
        {"view"},
        {"view", "none"},
        {"view", "job.toml"},
        {"completion", "csh"},
        {"manual", "walk"},
        {"export-cells", "job.toml"},
        {"export-cells", "--out", "x.tess"},
        {"export-cells", "job.toml", "--out", "x.vtk"},
        {"export-cells", "job.toml", "--out", "x.tess", "--seed", "1", "--seed", "2"},
        {"export-cells", "job.toml", "--out", "none/x.tess"}};
    for (const auto& arguments : cases) {
        std::string shown;
        for (const std::string& argument : arguments) shown += " '" + argument + "'";
        SCOPED_TRACE(shown);
        const Outcome outcome = run_program(place.path(), arguments);
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_NE(outcome.err.find("feldspar: "), std::string::npos) << outcome.err;
    }
    EXPECT_EQ(place.entries(), (std::set<std::string>{"job.toml"}));
}

TEST(CommandLine, SaysHowManyTestsAtOnceAreAllowed) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    const Outcome outcome = run_program(place.path(), {"run", "job.toml", "--at-once", "300"});
    for (const char* part : {"--at-once", "300", "1", "256"}) EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    write_text(place / "wrong.toml", replaced(small_job(), "threads = 1", "at_once = \"some\""));
    const Outcome wrong = run_program(place.path(), {"run", "wrong.toml"});
    EXPECT_EQ(wrong.code, 2);
    for (const char* part : {"wrong.toml:", "run.at_once", "'some'", "\"auto\"", "1 to 256"})
        EXPECT_NE(wrong.err.find(part), std::string::npos) << wrong.err;
    EXPECT_EQ(place.entries(), (std::set<std::string>{"job.toml", "wrong.toml"}));
}

TEST(CommandLine, NewJobsAreSoundAndNeverOverwrite) {
    const TemporaryFolder place;
    for (const char* kind :
         {"uniaxial-compression", "direct-tension", "biaxial", "brazilian", "laboratory", "study", "calibration"}) {
        const Outcome printed = run_program(place.path(), {"new", kind});
        EXPECT_EQ(printed.code, 0);
        const std::string file = std::string(kind) + ".toml";
        EXPECT_EQ(run_program(place.path(), {"new", kind, "--out", file}).code, 0);
        EXPECT_EQ(read_text(place / file), printed.out);
        EXPECT_EQ(run_program(place.path(), {"new", kind, "--out", file}).code, 2);
    }
    write_text(place / "mine.toml", "mine\n");
    EXPECT_EQ(run_program(place.path(), {"new", "biaxial", "--out", "mine.toml"}).code, 2);
    EXPECT_EQ(read_text(place / "mine.toml"), "mine\n");
    EXPECT_EQ(run_program(place.path(), {"new", "biaxial", "--out", "no/such/folder.toml"}).code, 2);
    // coarser grains, so that the check takes no time
    write_text(place / "coarse.toml", replaced(read_text(place / "laboratory.toml"), "minimum = \"2 mm\", maximum = \"4 mm\"",
                                               "minimum = \"8 mm\", maximum = \"12 mm\""));
    const Outcome check = run_program(place.path(), {"check", "coarse.toml"});
    EXPECT_EQ(check.code, 0) << check.err;
}

TEST(CommandLine, NewJobsTakeTheNumbersOfARock) {
    const TemporaryFolder place;
    const std::vector<std::string> numbers{"--UCS", "120MPa", "--E", "30GPa", "--BTS", "9MPa"};
    const auto with = [&](std::vector<std::string> arguments, std::vector<std::string> more) {
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_program(place.path(), arguments);
    };
    const Outcome job = with({"new", "laboratory", "--out", "rock.toml"}, numbers);
    EXPECT_EQ(job.code, 0) << job.err;
    EXPECT_EQ(job.err.find("warning"), std::string::npos) << job.err;
    EXPECT_NE(read_text(place / "rock.toml").find("\nUCS = \"120 MPa\""), std::string::npos);
    EXPECT_EQ(with({"new", "calibration", "--out", "targets.toml"}, numbers).code, 0);
    EXPECT_NE(read_text(place / "targets.toml").find("UCS = { value = \"120 MPa\", tolerance = \"5 %\" }"), std::string::npos);
    const Outcome far = with({"new", "brazilian"}, {"--UCS", "200 MPa", "--E", "60 GPa", "--BTS", "3 MPa"});
    EXPECT_EQ(far.code, 0);
    EXPECT_NE(far.err.find("warning: UCS/BTS of 66.7 is out of reach"), std::string::npos) << far.err;
    const std::vector<std::vector<std::string>> bad{
        {"--UCS", "9MPa", "--BTS", "120MPa"}, {"--UCS", "120"}, {"--UCS", "0 MPa"}, {"--E", "30 GPa"}, {"--rock", "cheese"},
        {"--UCS", "120MPa", "--nu", "1.5"}};
    for (const std::vector<std::string>& numbers_of_none : bad) {
        const Outcome refused = with({"new", "laboratory", "--out", "none.toml"}, numbers_of_none);
        EXPECT_EQ(refused.code, 2);
        EXPECT_NE(refused.err.find("allowed"), std::string::npos) << refused.err;
    }
    EXPECT_EQ(with({"new", "study"}, numbers).code, 2);
    EXPECT_EQ(with({"new", "--presets"}, numbers).code, 2);
    EXPECT_EQ(place.entries(), (std::set<std::string>{"rock.toml", "targets.toml"}));
    const Outcome help = run_program(place.path(), {"new", "--help"});
    EXPECT_NE(help.out.find("feldspar new laboratory --UCS 120MPa --E 30GPa --BTS 9MPa"), std::string::npos) << help.out;
}

TEST(CommandLine, PrintsThePresets) {
    const TemporaryFolder place;
    const Outcome printed = run_program(place.path(), {"new", "--presets"});
    EXPECT_EQ(printed.code, 0);
    for (const char* part : {"augig-inner-particles", "augig-table7", "Table 2", "1.08e4 GPa/m", "lac-du-bonnet-granite",
                             "Potyondy, Cundall 2004", "Schultz 1995"})
        EXPECT_NE(printed.out.find(part), std::string::npos) << part;
}

TEST(CommandLine, PrintsTheKeysOfJobsAsSchemaAndAsTables) {
    const TemporaryFolder place;
    const Outcome schema = run_program(place.path(), {"schema"});
    EXPECT_EQ(schema.code, 0);
    EXPECT_NE(schema.out.find("\"$schema\": \"http://json-schema.org/draft-04/schema#\""), std::string::npos);
    EXPECT_EQ(run_program(place.path(), {"schema", "--out", "feldspar.schema.json"}).code, 0);
    EXPECT_EQ(read_text(place / "feldspar.schema.json"), schema.out);
    EXPECT_EQ(run_program(place.path(), {"schema", "--out", "feldspar.schema.json"}).code, 2);
    EXPECT_EQ(read_text(place / "feldspar.schema.json"), schema.out);
    const Outcome tables = run_program(place.path(), {"schema", "--markdown"});
    EXPECT_EQ(tables.code, 0);
    EXPECT_NE(tables.out.find("| `sigma_nt` | tensile strength |"), std::string::npos);
}

std::string job_of_two_variants() {
    return small_job(
        "[[variant]]\nname = \"bilinear\"\n[[variant]]\nname = \"Brittle, 2\"\nseeds = [2]\n"
        "[variant.material.contact]\nlaw = \"brittle\"\n[[test]]\nkind = \"direct-tension\"\n",
        "[1, 2]");
}

TEST(CommandLine, WritesCellsThatAJobReadsAgain) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    const Outcome written = run_program(place.path(), {"export-cells", "job.toml", "--out", "cells.tess"});
    ASSERT_EQ(written.code, 0) << written.err;
    EXPECT_NE(written.out.find("file = \"cells.tess\"\nunit = \"m\""), std::string::npos) << written.out;
    const std::string text = read_text(place / "cells.tess");
    EXPECT_EQ(text.rfind("***tess\n", 0), 0u);
    const Outcome again = run_program(place.path(), {"export-cells", "job.toml", "--out", "cells.tess"});
    EXPECT_EQ(again.code, 2);
    EXPECT_NE(again.err.find("exists already"), std::string::npos) << again.err;
    EXPECT_EQ(read_text(place / "cells.tess"), text);
    const std::size_t snippet = written.out.find("[specimen]\n"), rest = small_job().find("[material");
    ASSERT_TRUE(snippet != std::string::npos && rest != std::string::npos);
    write_text(place / "again.toml", written.out.substr(snippet) + small_job().substr(rest));
    const Outcome back = run_program(place.path(), {"export-cells", "again.toml", "--out", "again.tess"});
    ASSERT_EQ(back.code, 0) << back.err;
    const auto mesh = [](const std::string& tess) {
        return tess.substr(tess.find("**vertex"));
    };  // seeds and their weights are circles of the cells' areas now
    EXPECT_EQ(mesh(read_text(place / "again.tess")), mesh(text));
}

TEST(CommandLine, ChecksEachVariantOnce) {
    const TemporaryFolder place;
    write_text(place / "job.toml", job_of_two_variants());
    const Outcome outcome = run_program(place.path(), {"check", "job.toml"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (const char* part :
         {"3 runs of 1 test and 2 variants", "\nbilinear\n", "\nBrittle, 2\n", "2 x direct-tension", "1 x direct-tension"})
        EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
}

TEST(CommandLine, RunsVariantsPackingByPacking) {
    const TemporaryFolder place;
    write_text(place / "job.toml", job_of_two_variants());
    const Outcome outcome = run_program(place.path(), {"run", "job.toml", "--out", "out"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const auto summary = nlohmann::json::parse(read_text(place / "out/summary.json"));
    std::vector<std::string> order;
    for (const auto& test : summary["tests"])
        order.push_back(test["variant"].get<std::string>() + std::to_string(test["seed"].get<int>()));
    EXPECT_EQ(order, (std::vector<std::string>{"bilinear1", "bilinear2", "Brittle, 22"}));
    EXPECT_TRUE(summary["properties"].empty());
    EXPECT_EQ(summary["variants"].size(), 2u);
    for (const char* file : {"history-bilinear-direct-tension-s1.csv", "history-brittle-2-direct-tension-s2.csv",
                             "bilinear-direct-tension-s2.h5", "report.html", "packing-s1.txt", "packing-s2.txt"})
        EXPECT_TRUE(fs::exists(place / "out" / file)) << file;
    EXPECT_NE(outcome.out.find("ms a step"), std::string::npos) << outcome.out;
}

TEST(CommandLine, CheckPrintsAndWritesNothing) {
    const TemporaryFolder place;
    write_text(place / "job.toml",
               small_job("[[test]]\nkind = \"uniaxial-compression\"\n[[test]]\nkind = \"brazilian\"\n", "[1, 2]"));
    const Outcome outcome = run_program(place.path(), {"check", "job.toml"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (const char* part : {"grains", "contacts", "triangles", "memory", "stable time step", "expected", "4 runs of 2 tests"})
        EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
    EXPECT_EQ(place.entries(), (std::set<std::string>{"job.toml"}));
}

TEST(CommandLine, AFlattenedDiscIsCheckedRunAndReported) {
    const TemporaryFolder place;
    write_text(place / "job.toml",
               small_job("[[test]]\nkind = \"brazilian\"\ndiameter = \"60 mm\"\ndisc = \"flattened\"\nflat_angle = \"25 deg\"\n",
                         "[1]"));
    const Outcome checked = run_program(place.path(), {"check", "job.toml"});
    EXPECT_EQ(checked.code, 0) << checked.err;
    EXPECT_NE(checked.out.find("flats of the disc     25 degrees, 13 mm wide, 58.6 mm apart; stress = k 2P / (pi D t), k = 0."),
              std::string::npos)
        << checked.out;
    const Outcome outcome = run_program(place.path(), {"run", "job.toml", "--out", "out"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* part :
         {"valid (ISRM)", "first dip", "arc top", "first crack r/R", "25.0 deg", "k: stresses are k 2P / (pi D t)"})
        EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
    const auto brazilian = nlohmann::json::parse(read_text(place / "out/summary.json")).at("tests").at(0).at("brazilian");
    EXPECT_NEAR(brazilian.at("flat_angle_deg").get<double>(), 25.0, 1e-9);
    EXPECT_GT(brazilian.at("flat_coefficient").get<double>(), 0.87);
    EXPECT_LT(brazilian.at("flat_coefficient").get<double>(), 0.95);
    // what it leaves runs again, on the same packing
    EXPECT_NE(read_text(place / "out/packing-disc-s1.txt").find("flattened-disc 0 0 0.0"), std::string::npos);
    const Outcome again = run_program(place.path(), {"check", "out/job-resolved.toml"});
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_NE(again.out.find("25 degrees"), std::string::npos) << again.out;
}

TEST(CommandLine, ARunLeavesItsResults) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job("[[test]]\nkind = \"uniaxial-compression\"\n[[test]]\nkind = \"biaxial\"\nsigma3 = "
                                             "\"4 MPa\"\nseeds = [2]\n[[test]]\nkind = \"brazilian\"\nseeds = [2]\n",
                                             "[1, 2]"));
    const Outcome outcome = run_program(place.path(), {"run", "job.toml"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("Uniaxial compressive strength"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("report.html"), std::string::npos) << outcome.out;
    const fs::path results = place / "results/job-1";
    for (const char* file : {"job.toml", "job-resolved.toml", "summary.json", "report.html", "packing-s1.txt", "packing-s2.txt",
                             "packing-disc-s2.txt", "history-uniaxial-compression-s1.csv", "history-uniaxial-compression-s2.csv",
                             "history-biaxial-s2-p4.csv", "history-brazilian-s2.csv"})
        EXPECT_TRUE(fs::exists(results / file)) << file;
    EXPECT_FALSE(fs::exists(results / "history-brazilian-s1.csv"));
    EXPECT_EQ(read_text(results / "job.toml"), read_text(place / "job.toml"));
    const auto summary = nlohmann::json::parse(read_text(results / "summary.json"));
    EXPECT_EQ(summary.at("complete"), true);
    EXPECT_EQ(summary.at("tests").size(), 4u);
    expect_no_half_files(results);

    // the resolved job gives the same bits, on two threads; so does a seed asked for on the command line
    const Outcome again = run_program(
        place.path(), {"run", (results / "job-resolved.toml").string(), "--out", "again", "--threads", "2", "--seed", "2"});
    ASSERT_EQ(again.code, 0) << again.err;
    const auto numbers = [](const std::string& csv) {  // without the header, which says when and on how many threads
        std::string kept;
        for (std::size_t at = 0; at < csv.size();) {
            const std::size_t end = std::min(csv.find('\n', at), csv.size());
            if (csv[at] != '#') kept += csv.substr(at, end - at + 1);
            at = end + 1;
        }
        return kept;
    };
    for (const char* file : {"history-uniaxial-compression-s2.csv", "history-biaxial-s2-p4.csv", "history-brazilian-s2.csv"})
        EXPECT_EQ(numbers(read_text(results / file)), numbers(read_text(place / "again" / file))) << file;
    EXPECT_FALSE(fs::exists(place / "again/history-uniaxial-compression-s1.csv"));

    // and so does the packing that was kept
    write_text(place / "loaded.toml", replaced(small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[2]"), "thickness",
                                               "packing = \"results/job-1/packing-s2.txt\"\nthickness"));
    const Outcome loaded = run_program(place.path(), {"run", "loaded.toml", "--out", "loaded"});
    ASSERT_EQ(loaded.code, 0) << loaded.err;
    EXPECT_EQ(numbers(read_text(results / "history-uniaxial-compression-s2.csv")),
              numbers(read_text(place / "loaded/history-uniaxial-compression-s2.csv")));
}

// Whether this program can use a card or not, there is none to be seen.
void without_card() {
    setenv("CUDA_VISIBLE_DEVICES", "", 1);
    unsetenv("FELDSPAR_EMULATED_CARD");
}
void with_emulated_card() { setenv("FELDSPAR_EMULATED_CARD", "1000", 1); }
void with_small_card() { setenv("FELDSPAR_EMULATED_CARD", "0.01", 1); }

TEST(CommandLine, RefusesACardThatIsNotThere) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    for (const char* command : {"run", "check"}) {
        const Outcome refused = run_program(place.path(), {command, "job.toml", "--device", "gpu"}, without_card);
        EXPECT_EQ(refused.code, 2) << refused.err;
        EXPECT_NE(refused.err.find("graphics card"), std::string::npos) << refused.err;
        EXPECT_FALSE(fs::exists(place / "results"));
    }
    EXPECT_EQ(run_program(place.path(), {"run", "job.toml", "--device", "tpu"}).code, 2);
    const Outcome automatic = run_program(place.path(), {"run", "job.toml", "--device", "auto"}, without_card);
    EXPECT_EQ(automatic.code, 0) << automatic.err;
    EXPECT_NE(automatic.err.find("the tests run on the processor"), std::string::npos) << automatic.err;
    EXPECT_FALSE(nlohmann::json::parse(read_text(place / "results/job-1/summary.json")).at("provenance").contains("device"));
}

TEST(CommandLine, RefusesWhatACardDoesNotKnow) {
    const TemporaryFolder place;
    write_text(place / "job.toml", replaced(small_job(), "porosity", "triangles_per_grain = 60\nporosity"));
    for (const char* command : {"run", "check"}) {
        const Outcome refused = run_program(place.path(), {command, "job.toml", "--device", "gpu"}, with_emulated_card);
        EXPECT_EQ(refused.code, 2) << refused.err;
        EXPECT_NE(refused.err.find("meshed more finely"), std::string::npos) << refused.err;
        EXPECT_FALSE(fs::exists(place / "results"));
    }
    const Outcome automatic = run_program(place.path(), {"run", "job.toml", "--device", "auto"}, with_emulated_card);
    EXPECT_EQ(automatic.code, 0) << automatic.err;
    EXPECT_NE(automatic.err.find("runs on the processor: "), std::string::npos) << automatic.err;
}

TEST(CommandLine, RefusesACardWithTooLittleMemory) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    const Outcome refused = run_program(place.path(), {"run", "job.toml", "--device", "gpu"}, with_small_card);
    EXPECT_EQ(refused.code, 2) << refused.err;
    EXPECT_NE(refused.err.find("card's memory"), std::string::npos) << refused.err;
    EXPECT_FALSE(fs::exists(place / "results"));
}

TEST(CommandLine, ResultsSayWhichCardMadeThem) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    ASSERT_EQ(run_program(place.path(), {"run", "job.toml", "--out", "here"}).code, 0);
    const Outcome outcome =
        run_program(place.path(), {"run", "job.toml", "--out", "there", "--device", "gpu"}, with_emulated_card);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto summary_of = [&](const char* run) { return nlohmann::json::parse(read_text(place / run / "summary.json")); };
    const auto here = summary_of("here"), there = summary_of("there");
    EXPECT_NE(there.at("provenance").at("device").get<std::string>().find("an emulated card"), std::string::npos);
    EXPECT_FALSE(here.at("provenance").contains("device"));
}

// What was probably meant, and where to read on.
TEST(CommandLine, SuggestsCommandsAndOptions) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> cases{
        {{"rnu", "job.toml"}, {"'rnu' is not a command", "did you mean 'run'?", "'feldspar --help'"}},
        {{"chekc", "job.toml"}, {"did you mean 'check'?"}},
        {{"run", "job.toml", "--treads", "2"},
         {"'--treads' is not an option of 'feldspar run'", "did you mean '--threads'?", "'feldspar run --help'"}},
        {{"run", "job.toml", "--seeed=1"}, {"'--seeed' is not an option", "'--seed'"}},
        {{"study", "table", "x.toml", "--run"}, {"'--run' is not an option of 'feldspar study table'", "'--runs'"}},
        {{"run"}, {"'feldspar run' needs JOB.toml"}},
        {{"export-cells", "job.toml"}, {"'feldspar export-cells' needs --out FILE"}},
        {{"run", "job.toml", "--test", "UTS"}, {"the job has no test 'UTS'"}},
        {{"run", "job.toml", "--set", "material.contact.mu=0.4", "--set", "material.contact.tua=3MPa"},
         {"--set 'material.contact.tua=3MPa'", "did you mean 'tau'?"}},
        {{"run", "job.toml", "--keep", "nothing"}, {"nothing"}},
    };
    for (const auto& [arguments, parts] : cases) {
        const Outcome outcome = run_program(place.path(), arguments);
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        for (const std::string& part : parts) EXPECT_NE(outcome.err.find(part), std::string::npos) << part << "\n" << outcome.err;
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
    }
    EXPECT_EQ(place.entries(), (std::set<std::string>{"job.toml"}));
}

TEST(CommandLine, AJobComesFromStandardInput) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job("[[test]]\nkind = \"direct-tension\"\n"));
    const auto from_file = [&] { dup2(open((place / "job.toml").c_str(), O_RDONLY), STDIN_FILENO); };
    const Outcome outcome = run_program(
        place.path(), {"run", "-", "--out", "out", "--set", "numerics.accuracy=9%", "--quiet", "--keep", "numbers"}, from_file);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "out\n");
    std::istringstream lines(outcome.err);
    for (std::string line; std::getline(lines, line);) EXPECT_EQ(line.rfind("warning: ", 0), 0u) << line;
    EXPECT_EQ(read_text(place / "out/job.toml").rfind(read_text(place / "job.toml"), 0), 0u);
    EXPECT_NE(read_text(place / "out/job.toml").find("# --set numerics.accuracy=9%"), std::string::npos);
    const std::string resolved = read_text(place / "out/job-resolved.toml");
    EXPECT_NE(resolved.find("accuracy = 0.09"), std::string::npos) << resolved;
    EXPECT_NE(resolved.find("sigma_nt = \"8.5 MPa\""), std::string::npos) << resolved;
    EXPECT_FALSE(fs::exists(place / "out/direct-tension-s1.h5"));
    EXPECT_FALSE(fs::exists(place / "out/history-direct-tension-s1.csv"));
    EXPECT_TRUE(fs::exists(place / "out/report.html"));

    write_text(place / "wrong.toml", "[specimen]\nshap = 1\n");
    const Outcome wrong =
        run_program(place.path(), {"check", "-"}, [&] { dup2(open((place / "wrong.toml").c_str(), O_RDONLY), STDIN_FILENO); });
    EXPECT_EQ(wrong.code, 2);
    EXPECT_NE(wrong.err.find("standard input:2:1"), std::string::npos) << wrong.err;
}

TEST(CommandLine, JsonIsAloneOnStandardOutput) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job("[[test]]\nkind = \"direct-tension\"\n[[test]]\nkind = \"uniaxial-compression\"\n"));
    const Outcome outcome = run_program(place.path(), {"run", "job.toml", "--out", "out", "--json", "--test", "DTS"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(json.at("directory"), "out");
    EXPECT_EQ(json.at("interrupted"), false);
    ASSERT_EQ(json.at("tests").size(), 1u);
    EXPECT_EQ(json.at("tests").at(0).at("kind"), "direct-tension");
    EXPECT_EQ(json.at("properties"), nlohmann::json::parse(read_text(place / "out/summary.json")).at("properties"));
    EXPECT_NE(outcome.err.find("Report: out/report.html"), std::string::npos) << outcome.err;

    const Outcome wrong = run_program(place.path(), {"run", "job.toml", "--json", "--set", "specimen.width=-1mm"});
    EXPECT_EQ(wrong.code, 2);
    const auto error = nlohmann::json::parse(wrong.out).at("error");
    EXPECT_EQ(error.at("key"), "specimen.width");
    EXPECT_NE(error.at("message").get<std::string>().find("--set"), std::string::npos) << wrong.out;
}

// What `check` says of memory and steps, against what the run takes.
TEST(CommandLine, CheckForeseesStepsAndMemory) {
    const TemporaryFolder place;
    write_text(place / "job.toml",
               small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[1]", "kind = \"adaptive\"\naccuracy = \"2 %\"\n"));
    const Outcome check = run_program(place.path(), {"check", "job.toml"});
    ASSERT_EQ(check.code, 0) << check.err;
    std::smatch steps, memory;
    ASSERT_TRUE(std::regex_search(check.out, steps, std::regex("nine tests in ten take (\\d+) to (\\d+)"))) << check.out;
    ASSERT_TRUE(std::regex_search(check.out, memory, std::regex("memory +([\\d.]+) MB(?: to ([\\d.]+) MB)?"))) << check.out;
    const double least_MB = std::stod(memory[1]), most_MB = memory[2].matched ? std::stod(memory[2]) : least_MB;
    const Outcome run = run_program(place.path(), {"run", "job.toml", "--out", "out", "--json"});
    ASSERT_EQ(run.code, 0) << run.err;
    const double taken = nlohmann::json::parse(run.out).at("tests").at(0).at("steps");
    EXPECT_GE(taken, std::stod(steps[1]));
    EXPECT_LE(taken, std::stod(steps[2]));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which have memory of their own
    EXPECT_GE(run.resident_bytes, 0.8e6 * least_MB) << "the memory that is foreseen is to be right within a fifth";
    EXPECT_LE(run.resident_bytes, 1.2e6 * most_MB);
#endif
}

TEST(CommandLine, CheckForeseesThatPressureMakesATestLonger) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job("[[test]]\nkind = \"uniaxial-compression\"\n[[test]]\nkind = \"biaxial\"\n"
                                             "sigma3 = [\"2 MPa\", \"20 MPa\"]\n"));
    const std::string said = run_program(place.path(), {"check", "job.toml"}).out;
    std::vector<double> steps;
    const std::regex about("about (\\d+) steps");
    for (std::sregex_iterator found(said.begin(), said.end(), about), end; found != end; ++found)
        steps.push_back(std::stod((*found)[1]));
    ASSERT_EQ(steps.size(), 3u) << said;
    EXPECT_LT(steps[0], steps[1]);
    EXPECT_LT(steps[1], steps[2]);
    const std::string limited = run_program(place.path(), {"check", "job.toml", "--set", "numerics.maximum_steps=500"}).out;
    EXPECT_NE(limited.find("expected, each        500 steps"), std::string::npos) << limited;

    const Outcome object = run_program(place.path(), {"check", "job.toml", "--json"});
    ASSERT_EQ(object.code, 0) << object.err;
    const auto json = nlohmann::json::parse(object.out);
    ASSERT_EQ(json.at("tests").size(), 3u);
    EXPECT_EQ(json.at("tests").at(2).at("test"), "biaxial at 20 MPa");
    EXPECT_NEAR(json.at("tests").at(2).at("steps").at("usual").get<double>(), steps[2], 0.06 * steps[2])
        << "two digits are printed";
    EXPECT_NE(object.err.find("is sound"), std::string::npos);
    ASSERT_FALSE(json.at("warnings").empty());
    const std::string narrow = json.at("warnings").back();
    EXPECT_EQ(narrow.find("Specimen (seed 1): "), 0u) << narrow;
    const Outcome quiet = run_program(place.path(), {"check", "job.toml", "--quiet"});
    EXPECT_EQ(quiet.out, "");
    EXPECT_NE(quiet.err.find("warning: " + narrow), std::string::npos) << quiet.err;
    const Outcome wrong = run_program(place.path(), {"check", "job.toml", "--json", "--set", "specimen.width=-1mm"});
    EXPECT_EQ(nlohmann::json::parse(wrong.out).at("error").at("key"), "specimen.width");
}

TEST(CommandLine, FieldsAreExportedFromTheRun) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job("[[test]]\nkind = \"direct-tension\"\n[[test]]\nkind = \"brazilian\"\n"));
    ASSERT_EQ(run_program(place.path(), {"run", "job.toml", "--out", "out"}).code, 0);
    EXPECT_FALSE(fs::exists(place / "out/direct-tension-s1.pvd"));
    const Outcome outcome = run_program(place.path(), {"export", "out", "--vtu", "--test", "BTS"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* file :
         {"brazilian-s1.pvd", "brazilian-s1.py", "brazilian-s1/snapshot-000.vtm", "brazilian-s1/contacts-000.vtu"})
        EXPECT_TRUE(fs::exists(place / "out/paraview" / file)) << file;
    EXPECT_FALSE(fs::exists(place / "out/paraview/direct-tension-s1.pvd"));
    const Outcome again = run_program(place.path(), {"export", "out", "--vtu"});
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_NE(again.out.find("in place of those of an earlier export"), std::string::npos) << again.out;
    EXPECT_TRUE(fs::exists(place / "out/paraview/direct-tension-s1.pvd"));
    expect_no_half_files(place / "out");
    const Outcome unknown = run_program(place.path(), {"export", "out", "--vtu", "--test", "brasilian"});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_NE(unknown.err.find("brazilian-s1"), std::string::npos) << unknown.err;
    EXPECT_EQ(run_program(place.path(), {"export", "out/brazilian-s1.h5", "--vtu", "--out", "elsewhere"}).code, 0);
    EXPECT_TRUE(fs::exists(place / "elsewhere/brazilian-s1.pvd"));
}

TEST(CommandLine, ViewFindsTheNewestReport) {
    const TemporaryFolder place;
    for (const char* run : {"results/a-1", "results/a-2"}) {
        fs::create_directories(place / run);
        write_text(place / run / "report.html", "x\n");
    }
    fs::last_write_time(place / "results/a-1/report.html",
                        fs::last_write_time(place / "results/a-2/report.html") + std::chrono::seconds(5));
    const auto no_display = [] {
        unsetenv("DISPLAY");
        unsetenv("WAYLAND_DISPLAY");
    };
    const Outcome newest = run_program(place.path(), {"view"}, no_display);
    EXPECT_EQ(newest.code, 0) << newest.err;
    EXPECT_EQ(newest.out, (fs::canonical(place.path()) / "results/a-1/report.html").string() + "\n");
    EXPECT_NE(newest.err.find("no display"), std::string::npos) << newest.err;
    const Outcome one = run_program(place.path(), {"view", "results/a-2", "--print"});
    EXPECT_EQ(one.out, (fs::canonical(place.path()) / "results/a-2/report.html").string() + "\n");
    EXPECT_TRUE(one.err.empty()) << one.err;
    fs::create_directory(place / "empty");
    EXPECT_EQ(run_program(place.path(), {"view", "empty"}).code, 2);
}

TEST(CommandLine, PagesAndCompletionsKnowEveryCommand) {
    const TemporaryFolder place;
    const std::string names = run_program(place.path(), {"manual", "--list"}).out;
    for (const char* command : {"run", "check", "view", "export", "study", "calibrate"}) {
        EXPECT_NE(names.find(std::string("feldspar-") + command + "\n"), std::string::npos) << names;
        const Outcome page = run_program(place.path(), {"manual", command});
        EXPECT_EQ(page.code, 0);
        for (const char* part : {".SH NAME\n", ".SH SYNOPSIS\n", ".SH OPTIONS\n", ".SH EXAMPLES\n", ".SH EXIT STATUS\n"})
            EXPECT_NE(page.out.find(part), std::string::npos) << part << page.out;
        for (const char* shell : {"bash", "zsh", "fish"})
            EXPECT_NE(run_program(place.path(), {"completion", shell}).out.find(command), std::string::npos) << shell;
    }
    EXPECT_EQ(names.find("element"), std::string::npos);  // not the user's to call
    EXPECT_NE(run_program(place.path(), {"manual", "study", "status"}).out.find("feldspar study status"), std::string::npos);
    EXPECT_NE(run_program(place.path(), {"new", "UCS"}).out.find("uniaxial-compression"), std::string::npos);
}

TEST(CommandLine, VerifyRunsTheChecksThatAreAskedForAndLeavesAPage) {
    const TemporaryFolder place;
    for (const char* wrong : {"(", "no-such-check"}) {
        const Outcome outcome = run_program(place.path(), {"verify", "--only", wrong});
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_NE(outcome.err.find("--only"), std::string::npos) << outcome.err;
        EXPECT_NE(outcome.err.find("verify --list"), std::string::npos) << outcome.err;
    }
    const Outcome list = run_program(place.path(), {"verify", "--list", "--only", "^laws"});
    EXPECT_EQ(list.code, 0) << list.err;
    EXPECT_NE(list.out.find("laws.work-in-shear: "), std::string::npos) << list.out;
    EXPECT_EQ(list.out.find("two-grains"), std::string::npos) << list.out;
    EXPECT_TRUE(place.entries().empty());
    const Outcome run = run_program(place.path(), {"verify", "--only", "laws.work-in", "--threads", "1"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.out.find("2 of 2 within their bounds"), std::string::npos) << run.out;
    for (const char* file : {"verify.html", "verify.json", "verify.md"})
        EXPECT_TRUE(fs::exists(place / "results/verify-1" / file)) << file;
    EXPECT_EQ(run_program(place.path(), {"verify", "--only", "laws.work-in", "--out", "results"}).code, 2);
}

TEST(CommandLine, ClaimsAreHeldAgainstWhatHasBeenRun) {
    const TemporaryFolder place;
    const std::string paper = std::string(FELDSPAR_SOURCE_DIR) + "/studies/paper";
    const Outcome all =
        run_program(place.path(), {"claims", paper, "--results", "none", "--csv", "all.csv", "--markdown", "all.md"});
    EXPECT_EQ(all.code, 0) << all.err;
    EXPECT_NE(all.out.find("Claims: 23 of 23 not run"), std::string::npos) << all.out;
    EXPECT_EQ(read_text(place / "all.csv").rfind("claim,figure,claim_verdict,statement,", 0), 0U);
    EXPECT_NE(read_text(place / "all.md").find("not run"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(place / "none")) << "nothing is made where nothing is";
    const Outcome one = run_program(place.path(), {"claims", paper, "--results", "none", "--claim", "C01"});
    EXPECT_EQ(one.code, 0) << one.err;
    EXPECT_NE(one.out.find("Claims: 1 of 1 not run"), std::string::npos) << one.out;
    const Outcome unknown = run_program(place.path(), {"claims", paper, "--claim", "nonsense"});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_NE(unknown.err.find("there is no claim 'nonsense'"), std::string::npos) << unknown.err;
}

TEST(CommandLine, AnExistingDirectoryIsRefused) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    fs::create_directory(place / "kept");
    write_text(place / "kept/summary.json", "mine\n");
    write_text(place / "file", "mine\n");
    for (const char* out : {"kept", "kept/", "file", "."}) {
        SCOPED_TRACE(out);
        const Outcome outcome = run_program(place.path(), {"run", "job.toml", "--out", out});
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_NE(outcome.err.find("exists already"), std::string::npos) << outcome.err;
    }
    EXPECT_EQ(place.entries(), (std::set<std::string>{"job.toml", "kept", "kept/summary.json", "file"}));
    EXPECT_EQ(read_text(place / "kept/summary.json"), "mine\n");
}

}  // namespace
}  // namespace feldspar::testing_program
