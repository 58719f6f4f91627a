// Commands that make a study of a job: envelope and converge, each on a specimen that breaks within a second.
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace feldspar::testing_program {
namespace {

const std::string fast = "kind = \"adaptive\"\naccuracy = \"10 %\"\n";

std::string laboratory() { return "[laboratory]\nUCS = \"120 MPa\"\nconfined = [[\"4 MPa\", \"150 MPa\"]]\n"; }

TEST(Envelope, RunsSavesAndGoesOn) {
    const TemporaryFolder place;
    // seven grains wide: with four, a confined specimen may never reach a peak
    const std::string job =
        replaced(replaced(small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[1]", fast), "\"7 mm\"", "\"4 mm\""),
                 "\"11 mm\"", "\"7 mm\"");
    write_text(place / "job.toml", job + laboratory());
    const std::vector<std::string> command{"envelope", "job.toml", "--seeds", "2", "--sigma3", "3 MPa", "9 MPa"};
    const Outcome first = run_program(place.path(), command);
    EXPECT_EQ(first.code, 0) << first.err;
    EXPECT_NE(first.out.find("10 runs done now"), std::string::npos) << first.out;
    for (const char* part : {"Cohesion", "Friction angle", "Hoek-Brown", "Brazilian tensile strength", "rms residual"})
        EXPECT_NE(first.out.find(part), std::string::npos) << part << "\n" << first.out;
    const fs::path results = place / "results/job-envelope";
    const auto json = nlohmann::json::parse(read_text(results / "envelope.json"));
    const auto& envelope = json["envelopes"][0];
    EXPECT_EQ(envelope["strengths"].size(), 3u);
    EXPECT_EQ(envelope["packings"].size(), 2u);
    EXPECT_EQ(envelope["tests"].size(), 10u);
    EXPECT_EQ(json["laboratory"]["confined"][0][1], 150);
    EXPECT_EQ(json["missing"], 0);
    const std::string page = read_text(results / "envelope.html");
    EXPECT_NE(page.find("Strength envelope of job"), std::string::npos);
    EXPECT_EQ(page.find("{{"), std::string::npos);
    EXPECT_EQ(read_text(results / "envelope.csv").rfind("# Strength envelope of job", 0), 0u);

    const Outcome again = run_program(place.path(), command);  // nothing is run twice
    EXPECT_NE(again.out.find("0 runs done now, 10 before"), std::string::npos) << again.out;

    std::vector<std::string> for_programs = command, quiet = command;
    for_programs.push_back("--json");
    quiet.push_back("--quiet");
    const Outcome object = run_program(place.path(), for_programs);
    ASSERT_EQ(object.code, 0) << object.err;
    const auto printed = nlohmann::json::parse(object.out);
    EXPECT_EQ(printed.at("envelopes"), json.at("envelopes"));
    EXPECT_EQ(printed.at("page"), "results/job-envelope/envelope.html");
    EXPECT_EQ(printed.at("interrupted"), false);
    EXPECT_EQ(printed.at("executed").at("done_before"), 10);
    EXPECT_NE(object.err.find("Cohesion"), std::string::npos) << "the table is for the reader";
    const Outcome silent = run_program(place.path(), quiet);
    EXPECT_EQ(silent.out, "results/job-envelope\n");
    EXPECT_EQ(silent.err.find("10 done already"), std::string::npos) << silent.err;
    EXPECT_NE(silent.err.find("The job has no brazilian test"), std::string::npos) << "what was added to the job is said";
    expect_no_half_files(place / "results");
}

TEST(Envelope, RefusesWhatItCannotDo) {
    const TemporaryFolder place;
    write_text(place / "job.toml", small_job());
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"--sigma3", "5 mm"}, {"--sigma3", "0 MPa"}, {"--seeds", "0"}, {"--variant", "rigid"}}) {
        std::vector<std::string> command{"envelope", "job.toml"};
        command.insert(command.end(), arguments.begin(), arguments.end());
        const Outcome outcome = run_program(place.path(), command);
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_NE(outcome.err.find(arguments.front()), std::string::npos) << outcome.err;
    }
    EXPECT_EQ(place.entries(), (std::set<std::string>{"job.toml"}));
}

TEST(Converge, RunsAndJudges) {
    const TemporaryFolder place;
    write_text(place / "job.toml",
               replaced(replaced(small_job("[[test]]\nkind = \"direct-tension\"\n", "[1]", fast), "\"7 mm\"", "\"5 mm\""),
                        "\"11 mm\"", "\"5.3 mm\""));
    const Outcome outcome = run_program(place.path(), {"converge", "job.toml", "--seeds", "2"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const fs::path results = place / "results/job-converge";
    const auto json = nlohmann::json::parse(read_text(results / "converge.json"));
    ASSERT_EQ(json["axes"].size(), 4u) << outcome.err;
    for (const auto& axis : json["axes"]) {
        EXPECT_FALSE(axis["verdict"]["words"].get<std::string>().empty());
        EXPECT_EQ(axis["properties"].size(), 1u) << axis["name"];
    }
    EXPECT_FALSE(json["overall"].get<std::string>().empty());
    EXPECT_NE(outcome.out.find("DTS"), std::string::npos) << outcome.out;
    EXPECT_NE(read_text(results / "converge.html").find("Convergence of job"), std::string::npos);
    EXPECT_FALSE(read_text(results / "converge.csv").empty());
    EXPECT_EQ(run_program(place.path(), {"converge", "job.toml", "--test", "brazilian"}).code, 2);
    EXPECT_EQ(run_program(place.path(), {"converge", "job.toml", "--within", "5 MPa"}).code, 2);
}

}  // namespace
}  // namespace feldspar::testing_program
