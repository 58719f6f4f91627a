// The rules of the house that a compiler does not see (ARCHITECTURE.md), each as a test that names the offending lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// The rooms in the order in which data visits them; a room may include itself and the rooms before it.
const std::vector<std::string> rooms{"base",   "geometry", "specimen", "laws",     "model",       "methods",
                                     "fast",   "step",     "gpu",      "ranks",    "lab",         "job",
                                     "output", "live",     "study",    "findings", "calibration", "verify"};

/// What the user asks, as plain data. Every room speaks this language, so it may be included from any floor; in turn it may
/// include nothing of the house but itself and base (SharedVocabularyIncludesNothing).
const std::set<std::string> vocabulary{"feldspar/model/spec.hpp", "feldspar/model/fixture_spec.hpp",
                                       "feldspar/model/gauge_spec.hpp", "feldspar/model/stage_spec.hpp"};

const std::set<std::string> made_at_build_time{"feldspar_commit.hpp"};

struct SourceFile {
    std::string name;  // relative to the repository
    std::vector<std::string> lines;
};

bool has_extension(const fs::path& file, const std::set<std::string>& extensions) {
    return extensions.count(file.extension().string()) > 0;
}

const std::set<std::string> code_extensions{".hpp", ".cpp"};
const std::set<std::string> text_extensions{".hpp", ".cpp", ".md",   ".txt", ".cmake", ".toml", ".json",
                                            ".js",  ".css", ".html", ".py",  ".sh",    ""};

SourceFile read(const fs::path& file) {
    SourceFile source{fs::relative(file, FELDSPAR_SOURCE_DIR).generic_string(), {}};
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) source.lines.push_back(line);
    return source;
}

/// Files under a folder of the repository, sorted; third-party files (vendor) are not ours to judge.
std::vector<SourceFile> files_under(const std::string& folder, const std::set<std::string>& extensions) {
    std::vector<SourceFile> found;
    const fs::path top = fs::path(FELDSPAR_SOURCE_DIR) / folder;
    if (!fs::exists(top)) return found;
    for (auto it = fs::recursive_directory_iterator(top); it != fs::recursive_directory_iterator(); ++it) {
        if (it->is_directory() && it->path().filename() == "vendor") {
            it.disable_recursion_pending();
        } else if (it->is_regular_file() && has_extension(it->path(), extensions)) {
            found.push_back(read(it->path()));
        }
    }
    std::sort(found.begin(), found.end(), [](const SourceFile& a, const SourceFile& b) { return a.name < b.name; });
    return found;
}

/// Everything that we wrote: the folders of the house and the files at its door.
std::vector<SourceFile> all_files() {
    std::vector<SourceFile> found;
    for (const char* folder :
         {"src", "apps", "tests", "benchmarks", "cmake", "docs", "examples", "studies", "scripts", ".ci", "python"}) {
        for (SourceFile& file : files_under(folder, text_extensions)) found.push_back(std::move(file));
    }
    for (const auto& entry : fs::directory_iterator(FELDSPAR_SOURCE_DIR)) {
        const bool ours =
            entry.is_regular_file() && has_extension(entry.path(), text_extensions) && entry.path().filename() != "LICENSE";
        if (ours) found.push_back(read(entry.path()));
    }
    return found;
}

/// Calls `visit(file, line number, match)` for every match of `pattern`, line by line.
template <class Visit>
void for_each_match(const std::vector<SourceFile>& files, const std::regex& pattern, Visit visit) {
    for (const SourceFile& file : files) {
        for (std::size_t i = 0; i < file.lines.size(); ++i) {
            for (std::sregex_iterator m(file.lines[i].begin(), file.lines[i].end(), pattern), end; m != end; ++m)
                visit(file, i + 1, *m);
        }
    }
}

std::string at(const SourceFile& file, std::size_t line) { return file.name + ":" + std::to_string(line) + ": "; }

/// Fails for each match, except in the given files.
void expect_nowhere(const std::vector<SourceFile>& files, const std::regex& pattern, const std::string& why,
                    const std::set<std::string>& except = {}) {
    for_each_match(files, pattern, [&](const SourceFile& file, std::size_t line, const std::smatch& match) {
        if (except.count(file.name) == 0) ADD_FAILURE() << at(file, line) << "'" << match.str() << "': " << why;
    });
}

std::size_t floor_of(const std::string& room) {
    return static_cast<std::size_t>(std::find(rooms.begin(), rooms.end(), room) - rooms.begin());
}

}  // namespace

TEST(Conventions, IncludesGoOneWay) {
    const std::regex include(R"re(^\s*#\s*include\s*"([^"]+)")re");
    std::size_t seen = 0;
    for (const std::string& room : rooms) {
        for_each_match(files_under("src/feldspar/" + room, code_extensions), include,
                       [&](const SourceFile& file, std::size_t line, const std::smatch& match) {
                           ++seen;
                           const std::string target = match[1];
                           if (vocabulary.count(target) > 0 || made_at_build_time.count(target) > 0) return;
                           if (target.rfind("feldspar/", 0) != 0) {
                               ADD_FAILURE() << at(file, line) << "include our own headers as \"feldspar/<room>/<file>\"";
                               return;
                           }
                           const std::string other = target.substr(9, target.find('/', 9) - 9);
                           ASSERT_LT(floor_of(other), rooms.size()) << at(file, line) << "there is no room '" << other << "'";
                           EXPECT_LE(floor_of(other), floor_of(room))
                               << at(file, line) << "'" << room << "' must not know '" << other << "'";
                       });
    }
    EXPECT_GT(seen, 20u) << "no includes found: is this test looking at the right folder?";
}

/// A test method is one file and one line of a list: nothing outside its room asks for a method by its name, neither code nor the
/// scripts of pages. Checks of closed forms are, as tests, of this method or that.
TEST(Conventions, MethodsAreNamedInTheirRoomOnly) {
    std::string names;
    for (const std::string& line : read(fs::path(FELDSPAR_SOURCE_DIR) / "src/feldspar/methods/list.inc").lines) {
        std::smatch method;
        if (!std::regex_match(line, method, std::regex(R"re(FELDSPAR_METHOD\((\w+)\))re"))) continue;
        std::string name = method[1];
        std::replace(name.begin(), name.end(), '_', '-');
        names += (names.empty() ? "" : "|") + name;
    }
    ASSERT_NE(names, "") << "the list of methods has changed its form";
    std::vector<SourceFile> files;
    for (const char* folder : {"src", "apps"})
        for (SourceFile& file : files_under(folder, {".cpp", ".hpp", ".js"}))
            if (file.name.rfind("src/feldspar/methods/", 0) != 0 && file.name.rfind("src/feldspar/verify/", 0) != 0)
                files.push_back(std::move(file));
    const std::string why = "ask a fact of the method (methods/method.hpp)";
    expect_nowhere(files, std::regex(R"re(\bmethods::\w+)re"), why);
    // compared with, or looked up: `kind == "biaxial"`, `seeds("biaxial")`
    expect_nowhere(files, std::regex("(===? *|[a-z_]\\()\"(" + names + ")\""), why);
}

TEST(Conventions, SharedVocabularyIncludesNothing) {
    for (const std::string& header : vocabulary) {
        const SourceFile file = read(fs::path(FELDSPAR_SOURCE_DIR) / "src" / header);
        ASSERT_FALSE(file.lines.empty()) << header;
        for_each_match({file}, std::regex(R"re(^\s*#\s*include\s*"([^"]+)")re"),
                       [&](const SourceFile& in, std::size_t line, const std::smatch& match) {
                           const std::string target = match[1];
                           EXPECT_TRUE(vocabulary.count(target) > 0 || target.rfind("feldspar/base/", 0) == 0)
                               << at(in, line) << "the shared vocabulary is plain data and depends on no room";
                       });
    }
}

/// Two types of one name in the program's only namespace: their constructors, or vectors of them, have one name for the linker,
/// which takes either. Texts that are compiled anew for each set of instructions stand in namespaces of their own.
TEST(Conventions, ATypeHasANameOfItsOwn) {
    std::map<std::string, std::string> places;
    const std::regex type(R"re(^(?:struct|class|enum|enum class) (\w+)(?: final)?(?: :[^:;][^;]*)? \{)re");
    std::vector<SourceFile> headers;
    for (SourceFile& file : files_under("src/feldspar", {".hpp"}))
        if (file.name.rfind("src/feldspar/fast/", 0) != 0) headers.push_back(std::move(file));
    for_each_match(headers, type, [&](const SourceFile& file, std::size_t line, const std::smatch& match) {
        const auto [there, first] = places.emplace(match[1], at(file, line));
        EXPECT_TRUE(first) << at(file, line) << match[1] << " is the name of a type at " << there->second;
    });
    EXPECT_GT(places.size(), 100u) << "no types found: is this test looking at the right folder?";
}

TEST(Conventions, EveryRoomIsInTheList) {
    for (const auto& entry : fs::directory_iterator(fs::path(FELDSPAR_SOURCE_DIR) / "src/feldspar")) {
        if (!entry.is_directory()) continue;
        EXPECT_LT(floor_of(entry.path().filename().string()), rooms.size()) << entry.path().filename();
    }
}

TEST(Conventions, EveryHeaderSaysWhatItIs) {
    for (const SourceFile& file : files_under("src", {".hpp"})) {
        ASSERT_FALSE(file.lines.empty()) << file.name;
        EXPECT_EQ(file.lines.front().rfind("// ", 0), 0u) << file.name << ": starts with a comment on what it is for";
        EXPECT_NE(std::find(file.lines.begin(), file.lines.end(), "#pragma once"), file.lines.end())
            << file.name << ": #pragma once";
    }
}

// The patterns are put together so that this file does not hold what it looks for.
TEST(Conventions, NoPathsOfOneMachine) {
    const std::string slash = "/";
    expect_nowhere(all_files(), std::regex("(^|[\\s\"'(=])" + slash + "(home|root|work|Users|mnt)" + slash + "\\w+"),
                   "a path of one machine");
}

TEST(Conventions, NoUnfinishedNotes) {
    expect_nowhere(all_files(), std::regex(std::string("\\b(TO") + "DO|FIX" + "ME|XX" + "X)\\b"), "finish it, or file an issue");
}

TEST(Conventions, TheLibraryNeitherPrintsNorExits) {
    expect_nowhere(
        files_under("src", code_extensions),
        std::regex(
            R"(std::(cout|cerr|clog|puts|exit|abort|terminate|quick_exit)\b|\bf?printf\s*\(|fmt::print\b|(^|[^\w.])exit\s*\()"),
        "the library throws; only the program prints and exits");
}

TEST(Conventions, RandomNumbersComeFromNamedStreams) {
    expect_nowhere(files_under("src", code_extensions),
                   std::regex(R"(std::(random_device|mt19937\w*|\w+_distribution)\b|\bs?rand\s*\()"),
                   "use RandomStream: the same numbers on every platform");
}

// A comment that cites (C12) must find an equation (C12) in docs/theory.
TEST(Conventions, CitedEquationsExist) {
    std::set<std::string> equations;
    const auto theory = files_under("docs/theory", {".md"});
    for_each_match(theory, std::regex(R"(\\tag\{([A-Z]\d+)|^\(([A-Z]\d+)\))"),
                   [&](const SourceFile& file, std::size_t line, const std::smatch& match) {
                       const std::string number = match[1].matched ? match[1] : match[2];
                       EXPECT_TRUE(equations.insert(number).second) << at(file, line) << "(" << number << ") is numbered twice";
                   });
    EXPECT_GT(equations.size(), 50u);
    auto citing = theory;
    for (const char* folder : {"src", "tests", "docs/decisions"}) {
        for (SourceFile& file : files_under(folder, {".hpp", ".cpp", ".md"})) citing.push_back(std::move(file));
    }
    for_each_match(citing, std::regex(R"(\(([STCMLP]\d+)\))"),
                   [&](const SourceFile& file, std::size_t line, const std::smatch& match) {
                       EXPECT_EQ(equations.count(match[1]), 1u)
                           << at(file, line) << "cites (" << match[1] << "), which docs/theory does not have";
                   });
}

// Links between our own pages must lead somewhere.
TEST(Conventions, LinksInTheDocumentationWork) {
    std::vector<SourceFile> pages;
    for (SourceFile& file : all_files()) {
        if (file.name.size() > 3 && file.name.substr(file.name.size() - 3) == ".md") pages.push_back(std::move(file));
    }
    for_each_match(pages, std::regex(R"(\]\(([^)#:\s]+)(#[^)]*)?\))"),
                   [&](const SourceFile& file, std::size_t line, const std::smatch& match) {
                       const fs::path target = fs::path(FELDSPAR_SOURCE_DIR) / fs::path(file.name).parent_path() / match[1].str();
                       EXPECT_TRUE(fs::exists(target)) << at(file, line) << "no such file: " << match[1];
                   });
}

// CMakeLists.txt says the version; what reads it from there (the program, the packages, the Python package) needs no look here.
TEST(Conventions, TheVersionIsTheSameEverywhere) {
    const auto version_in = [](const std::string& name, const std::string& pattern) {
        const std::regex version(pattern);
        for (const std::string& line : read(fs::path(FELDSPAR_SOURCE_DIR) / name).lines)
            if (std::smatch match; std::regex_search(line, match, version)) return match.str(1);
        return "no version in " + name;
    };
    const std::string version = version_in("CMakeLists.txt", R"re(^project\(feldspar VERSION (\d+\.\d+\.\d+) )re");
    EXPECT_EQ(version_in("CITATION.cff", R"re(^version: (\S+)$)re"), version);
    EXPECT_EQ(version_in("packaging/conda/meta.yaml", R"re(^\{% set version = "(.*)" %\}$)re"), version);
    EXPECT_EQ(version_in("CHANGELOG.md", R"re(^## \[(\d.*)\])re"), version) << "the first version there is the last one released";
    EXPECT_EQ(version_in("pyproject.toml", R"re(^dynamic = \["(version)"\]$)re"), "version")
        << "the build takes it from CMakeLists.txt";
    EXPECT_EQ(version_in("docs/install.md", R"re(find_package\(Feldspar (\S+) )re"), version.substr(0, version.rfind('.')));
    EXPECT_EQ(version_in("CITATION.cff", R"re(^date-released: (\d{4}-\d{2}-\d{2})$)re"),
              version_in("CHANGELOG.md", R"re(^## \[\d[^\]]*\] - (\d{4}-\d{2}-\d{2})$)re"));
}

TEST(Conventions, ScriptsStopAtTheFirstError) {
    std::vector<SourceFile> scripts = files_under("scripts", text_extensions);
    for (const char* name : {"check", "demo", "bench", ".ci/run"}) scripts.push_back(read(fs::path(FELDSPAR_SOURCE_DIR) / name));
    EXPECT_GE(scripts.size(), 6u);
    for (const SourceFile& script : scripts) {
        ASSERT_FALSE(script.lines.empty()) << script.name;
        EXPECT_NE(std::find(script.lines.begin(), script.lines.end(), "set -euo pipefail"), script.lines.end()) << script.name;
        const auto permissions = fs::status(fs::path(FELDSPAR_SOURCE_DIR) / script.name).permissions();
        EXPECT_NE(permissions & fs::perms::owner_exec, fs::perms::none) << script.name << " is not executable";
    }
}
