// A mistake in the job: exit code 2, one clear message with its place, and no file.
#include "program.hpp"

namespace feldspar::testing_program {
namespace {

struct BadJob {
    const char* what;
    std::string text;
    std::vector<std::string> parts;  // of the message
};

std::vector<BadJob> bad_jobs() {
    const std::string job = small_job();
    const auto edit = [&](const std::string& from, const std::string& to) { return replaced(job, from, to); };
    return {
        {"syntax error", "[", {"job.toml:1:", "syntax error"}},
        {"empty file", "", {"job.toml: missing keys: specimen, material, test"}},
        {"binary file",
         std::string("\x7f"
                     "ELF\x02\x01\0\0\xff",
                     9),
         {"job.toml:1:"}},
        {"unknown key",
         edit("porosity", "porosty"),
         {"job.toml:8:1: specimen.grains.porosty: unknown key", "did you mean 'porosity'?"}},
        {"variant named twice",
         edit("[[test]]", "[[variant]]\nname = \"a\"\n[[variant]]\nname = \"A\"\n[[test]]"),
         {"variant[2].name", "share its files with 'a'"}},
        {"preset of other grains",
         edit("[material.grain]", "[material]\nelastic_preset = \"augig-rigid\"\n[material.grain]"),
         {"job.toml:10:18", "'augig-rigid' is for kind = \"rigid\"", "augig-flexible"}},
        {"missing unit", edit("\"40 mm\"", "40"), {"job.toml:3:9: specimen.width: 40 has no unit"}},
        {"wrong unit", edit("\"8.5 MPa\"", "\"8.5 mPa\""), {"sigma_nt", "did you mean 'MPa'?"}},
        {"wrong dimension", edit("\"25.8 GPa\"", "\"25.8 mm\""), {"material.grain.E: '25.8 mm' is a length, not a stress"}},
        {"negative size", edit("\"40 mm\"", "\"-40 mm\""), {"'-40 mm' is not allowed", "greater than zero"}},
        {"porosity above 1", edit("porosity = 0.10", "porosity = 1.1"), {"porosity: 1.1 is not allowed"}},
        {"nu at 0.5 in plane strain",
         "model = { plane = \"strain\" }\n" + edit("nu = 0.23", "nu = 0.5"),
         {"material.grain.nu: 0.5 is not allowed", "plane strain"}},
        {"grains larger than the specimen", edit("maximum = \"11 mm\"", "maximum = \"110 mm\""), {"do not fit", "40 mm"}},
        {"zero strength", edit("\"8.5 MPa\"", "\"0 MPa\""), {"sigma_nt", "greater than zero"}},
        {"outline that crosses itself",
         edit("shape = \"rectangle\"\nwidth = \"40 mm\"\nheight = \"80 mm\"",
              "shape = \"polygon\"\nvertices = [[\"0 mm\", \"0 mm\"], [\"40 mm\", \"80 mm\"], [\"40 mm\", \"0 mm\"], [\"0 mm\", "
              "\"80 mm\"]]\nedge_labels = [\"a\", \"right\", \"b\", \"left\"]"),
         {"specimen.vertices: the outline crosses or touches itself"}},
        {"rigid grains", "model = { kind = \"rigid\" }\n" + job, {"material.grain.E", "these grains have no elastic constants"}},
        {"speed under adaptive", edit("accuracy = \"10 %\"", "speed = \"1e-9 m\""), {"numerics.speed", "finds its own speed"}},
        {"unstable mass",
         edit("kind = \"adaptive\"\naccuracy = \"10 %\"", "kind = \"paper\"\nmass_factor = 0.3"),
         {"mass_factor"}},
        {"unstable time step",
         edit("kind = \"adaptive\"\naccuracy = \"10 %\"", "kind = \"dynamic\"\nspeed = \"0.1 m/s\"\ntime_step = \"1 ms\""),
         {"time_step"}},
    };
}

void expect_refused(const std::string& command, const BadJob& bad) {
    SCOPED_TRACE(std::string(bad.what) + ", " + command);
    const TemporaryFolder place;
    write_text(place / "job.toml", bad.text);
    const Outcome outcome = run_program(place.path(), {command, "job.toml"});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    std::size_t messages = 0;
    for (std::size_t at = outcome.err.find("feldspar: "); at != std::string::npos; at = outcome.err.find("feldspar: ", at + 1))
        ++messages;
    EXPECT_EQ(messages, 1u) << outcome.err;
    EXPECT_LT(outcome.err.size(), 1200u) << outcome.err;
    for (const std::string& part : bad.parts)
        EXPECT_NE(outcome.err.find(part), std::string::npos) << "wanted: " << part << "\ngot: " << outcome.err;
    EXPECT_EQ(place.entries(), (std::set<std::string>{"job.toml"}));
}

TEST(BadInput, IsOneMessageAndNoFile) {
    for (const BadJob& bad : bad_jobs()) {
        expect_refused("run", bad);
        expect_refused("check", bad);
    }
}

TEST(BadInput, DamagedPacking) {
    const TemporaryFolder place;
    write_text(place / "job.toml", replaced(small_job(), "thickness = \"80 mm\"", "packing = \"packing.txt\""));
    write_text(place / "packing.txt", "this is not a packing\n");
    const Outcome outcome = run_program(place.path(), {"run", "job.toml"});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find("packing.txt"), std::string::npos) << outcome.err;
    EXPECT_EQ(place.entries(), (std::set<std::string>{"job.toml", "packing.txt"}));
}

TEST(BadInput, AllMistakesAreToldAtOnceInTheOrderOfLines) {
    std::string job = small_job();
    const std::vector<std::pair<std::string, std::string>> edits{{"\"40 mm\"", "40"},
                                                                 {"porosity", "porosty"},
                                                                 {"nu = 0.23", "nu = 0.5"},
                                                                 {"\"8.5 MPa\"", "\"8.5 mPa\""},
                                                                 {"\"10 %\"", "\"90 %\""}};
    for (const auto& [from, to] : edits) job = replaced(job, from, to);
    for (const char* command : {"run", "check", "envelope", "converge"}) {
        SCOPED_TRACE(command);
        const TemporaryFolder place;
        write_text(place / "job.toml", job);
        const Outcome outcome = run_program(place.path(), {command, "job.toml"});
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        std::size_t at = 0;
        for (const char* key : {"specimen.width", "specimen.grains.porosty", "material.grain.nu", "material.contact.sigma_nt",
                                "numerics.accuracy"}) {
            const std::size_t found = outcome.err.find(std::string(key) + ": ", at);
            ASSERT_NE(found, std::string::npos) << key << "\n" << outcome.err;
            at = found;
        }
        std::size_t places = 0;
        for (std::size_t i = outcome.err.find("job.toml:"); i != std::string::npos; i = outcome.err.find("job.toml:", i + 1))
            ++places;
        EXPECT_EQ(places, edits.size()) << outcome.err;
        EXPECT_EQ(place.entries(), (std::set<std::string>{"job.toml"}));
    }
}

TEST(BadInput, JobsThatCannotBeRead) {
    const TemporaryFolder place;
    fs::create_directory(place / "folder");
    for (const char* job : {"none-such.toml", "folder", "folder/none-such.toml", "", "none\nsuch"}) {
        SCOPED_TRACE(job);
        const Outcome outcome = run_program(place.path(), {"run", job});
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_EQ(outcome.err.rfind("feldspar: ", 0), 0u) << outcome.err;
    }
    EXPECT_EQ(place.entries(), (std::set<std::string>{"folder"}));
}

}  // namespace
}  // namespace feldspar::testing_program
