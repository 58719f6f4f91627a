// Text of a user's, or of a file that somebody has sent: it stands in pages, tables, scripts and on the terminal, and commands
// none of them. Nothing is written outside the results' directory, or through a link that another user has put into a shared one.
#include "program.hpp"

namespace feldspar::testing_program {
namespace {

const std::string hostile =
    R"(</script><img src=x onerror='alert(1)'>\" onload=\"alert(2) {{data}} \u001b[31m)";  // as it stands in TOML

int count_of(const std::string& text, const std::string& what) {
    int count = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size())) ++count;
    return count;
}

void expect_harmless_page(const fs::path& file) {
    const std::string page = read_text(file);
    EXPECT_NE(page.find("onerror"), std::string::npos) << "the text is not on the page: this test shows nothing";
    EXPECT_EQ(page.find("<img"), std::string::npos);
    EXPECT_EQ(page.find('\x1b'), std::string::npos);
    EXPECT_EQ(count_of(page, "<script"), count_of(page, "</script>"));
    EXPECT_EQ(count_of(page, "<html"), 1);
}

TEST(HostileText, OfAJobCommandsNoPageTableOrTerminal) {
    TemporaryFolder place;
    for (const std::string& name : {hostile, std::string("../../elsewhere")}) {  // names of files come of it
        place.write("job.toml", small_job() + "[[variant]]\nname = \"" + name + "\"\n");
        const Outcome refused = run_program(place.path(), {"run", "job.toml", "--out", "out"});
        EXPECT_EQ(refused.code, 2);
        EXPECT_EQ(refused.err.find('\x1b'), std::string::npos);
    }
    place.write("job.toml", "# " + hostile + "\n" +
                                replaced(small_job(), "thickness",
                                         "labels = [{ name = \"" + hostile +
                                             "\", at = [\"0 mm\", \"40 mm\"], within = \"10 mm\" }]\nthickness"));
    const Outcome outcome = run_program(place.path(), {"run", "job.toml", "--out", "out"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ((outcome.out + outcome.err).find('\x1b'), std::string::npos);
    expect_harmless_page(place / "out/report.html");
    for (const std::string& entry : place.entries()) {
        EXPECT_TRUE(entry == "job.toml" || entry.starts_with("out")) << entry;
        EXPECT_EQ(entry.find_first_of("<>'\"\x1b "), std::string::npos) << entry;
        if (entry.ends_with(".csv")) {
            EXPECT_EQ(read_text(place / entry).find('\x1b'), std::string::npos) << entry;
        }
    }
}

TEST(HostileText, OfAStudyCommandsNoPageOrSpreadsheet) {
    TemporaryFolder place;
    place.write("job.toml", small_job());
    place.write(
        "study.toml",
        "job = \"job.toml\"\ntitle = \"" + hostile +
            "\"\n[[axis]]\nname = \"=1+1\"\n[[axis.value]]\nlabel = \"=HYPERLINK(1)\"\n[[axis.value]]\nlabel = \"" + hostile +
            "\"\nset = { material.contact.mu = 0.5 }\n[[axis.value]]\nlabel = \"-5 %\"\nset = { material.contact.mu = 0.38 }\n");
    const Outcome outcome = run_program(place.path(), {"study", "study.toml"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ((outcome.out + outcome.err).find('\x1b'), std::string::npos);
    expect_harmless_page(place / "results/study/study.html");
    const Outcome table = run_program(place.path(), {"study", "table", "study.toml"});
    ASSERT_EQ(table.code, 0) << table.err;
    const std::string csv = table.out;
    EXPECT_NE(csv.find("'=1+1,"), std::string::npos) << csv;
    EXPECT_NE(csv.find("\n'=HYPERLINK(1),"), std::string::npos) << csv;
    EXPECT_NE(csv.find("\n-5 %,"), std::string::npos) << csv;
    EXPECT_EQ(csv.find('\x1b'), std::string::npos);
}

TEST(HostileText, NamesNoDirectoryOfResults) {
    TemporaryFolder place;
    place.write("job.toml", small_job());
    for (const char* name : {"../escaped", "/tmp/escaped", "..", ".hidden", "a/b", "a\\u0000b", "a b"}) {
        place.write("study.toml", std::string("job = \"job.toml\"\nresults = \"") + name + "\"\n");
        EXPECT_EQ(run_program(place.path(), {"study", "study.toml"}).code, 2) << name;
        place.write("named.toml", std::string("name = \"") + name + "\"\n" + small_job());
        EXPECT_EQ(run_program(place.path(), {"run", "named.toml"}).code, 2) << name;
    }
    EXPECT_EQ(place.entries(), (std::set<std::string>{"job.toml", "study.toml", "named.toml"}));
}

// In a directory to which others may write, a file of a name that can be foreseen may be a link to anything.
TEST(SharedDirectories, FilesAreNotWrittenThroughLinks) {
    TemporaryFolder place;
    place.write("victim", "precious");
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {  // exec keeps the number of the process, by which the file that is written aside is named
        if (chdir(place.path().c_str()) != 0) _exit(126);
        std::error_code error;
        fs::create_symlink("victim", ".feldspar-" + std::to_string(getpid()) + "-0.part", error);
        execl(FELDSPAR_PROGRAM, "feldspar", "new", "brazilian", "--out", "new.toml", nullptr);
        _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 0);
    EXPECT_EQ(read_text(place / "victim"), "precious");
    EXPECT_NE(read_text(place / "new.toml").find("brazilian"), std::string::npos);
}

TEST(SharedDirectories, ALockThatIsALinkIsNotOpened) {
    TemporaryFolder place;
    place.write("job.toml", small_job());
    fs::create_directories(place / "out/checkpoints");
    fs::create_symlink("../../made", place / "out/checkpoints/lock");
    const Outcome outcome = run_program(place.path(), {"run", "job.toml", "--out", "out"});
    EXPECT_NE(outcome.code, 0);
    EXPECT_FALSE(fs::exists(place / "made")) << "a file was made through the link";
}

}  // namespace
}  // namespace feldspar::testing_program
