// Whatever call on the disk fails, and however: the program ends by itself, says which file and why, leaves only whole files, and
// the same command goes on afterwards to the results of an undisturbed run. The calls fail by failing_disk.cpp, loaded into the
// program.
//
// FELDSPAR_ALL_FAULTS=1 lets every call fail in turn, in every way; 5 takes every fifth of these. Without it some of the first
// calls for each kind of file, in one way each.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "program.hpp"

namespace feldspar::testing_program {
namespace {

using Json = nlohmann::json;

struct Fault {
    std::string kind;
    int call = 0;  ///< of this kind, from 1
    int error = EIO;
    bool onward = false;  ///< all later ones too
};

std::string text_of(const Fault& fault) {
    return fmt::format("{} {}{}: {}", fault.kind, fault.call, fault.onward ? " and onward" : "", std::strerror(fault.error));
}

// A call on a file below the directory that the disk watches.
struct Call {
    std::string kind;
    fs::path path;  ///< below that directory
    bool failed = false;
};

class Disk {
public:
    explicit Disk(fs::path below) : below_(fs::canonical(below.parent_path()) / below.filename()) {}

    // Called in the program before it starts.
    std::function<void()> with(const Fault& fault) const {
        return [=, this] {
            setenv("LD_PRELOAD", FELDSPAR_FAILING_DISK, 1);
            setenv("FAILING_DISK_BELOW", below_.c_str(), 1);
            setenv("FAILING_DISK_LOG", (log_ / "log").c_str(), 1);
            setenv("FAILING_DISK_KIND", fault.kind.c_str(), 1);
            setenv("FAILING_DISK_CALL", std::to_string(fault.call).c_str(), 1);
            setenv("FAILING_DISK_ERROR", std::to_string(fault.error).c_str(), 1);
            setenv("FAILING_DISK_ONWARD", fault.onward ? "1" : "0", 1);
            alarm(100);  // seconds; a program that hangs is ended and found out
        };
    }

    std::vector<Call> calls() const {
        std::vector<Call> all;
        std::istringstream lines(read_text(log_ / "log"));
        for (std::string line; std::getline(lines, line);) {
            Call call;
            call.failed = line.starts_with("! ");
            if (call.failed) line.erase(0, 2);
            call.kind = line.substr(0, line.find(' '));
            call.path = fs::path(line.substr(line.find(' ') + 1)).lexically_relative(below_);
            all.push_back(call);
        }
        return all;
    }

private:
    fs::path below_;
    TemporaryFolder log_;
};

// What kind of file a path is: names of processes, runs and snapshots are left out.
std::string class_of(const fs::path& path) {
    std::string text = path.string();
    for (const char* varying : {R"(\.[0-9]+-[0-9]+-[^.]+\.part$)", "[0-9a-f]{32}", "[0-9]+"})
        text = std::regex_replace(text, std::regex(varying), "");
    return text;
}

// Every so-manieth of all faults; 0 if only some are asked for.
std::size_t all_faults() {
    return std::getenv("FELDSPAR_ALL_FAULTS") != nullptr ? std::stoul(std::getenv("FELDSPAR_ALL_FAULTS")) : 0;
}

// The calls that are to fail, of those of a run without faults.
std::vector<Fault> faults_of(const std::vector<Call>& calls) {
    std::map<std::string, int> count;
    std::set<std::pair<std::string, std::string>> seen;
    std::vector<Fault> faults;
    for (const Call& call : calls) {
        const int number = ++count[call.kind];
        const bool first = seen.insert({call.kind, class_of(call.path)}).second;
        std::vector<std::string> kinds{call.kind};
        if (call.kind == "write") kinds.emplace_back("short");
        for (const std::string& kind : kinds) {
            if (all_faults() == 0 && !first) continue;
            for (const int error : {EIO, ENOSPC})
                for (const bool onward : {false, true})
                    if (kind != "short" || (!onward && error == EIO)) faults.push_back({kind, number, error, onward});
        }
    }
    std::vector<Fault> some;  // each file with another kind, error and duration
    for (std::size_t i = 0; i<faults.size(); i += all_faults()> 0 ? all_faults() : 17) some.push_back(faults[i]);
    return some;
}

std::string last_line(const std::string& text) {
    const std::size_t end = text.find_last_not_of('\n');
    const std::size_t begin = text.find_last_of('\n', end);
    return text.substr(begin == std::string::npos ? 0 : begin + 1, end - begin);
}

std::uint64_t little_endian(const std::string& bytes, std::size_t at) {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < 8; ++i)
        number |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes.at(at + i))) << (8 * i);
    return number;
}

// Every file that a user reads is there as a whole, or not at all.
void expect_whole_files(const fs::path& results) {
    if (!fs::exists(results)) return;
    expect_no_half_files(results);
    for (const auto& entry : fs::recursive_directory_iterator(results)) {
        if (!entry.is_regular_file()) continue;
        SCOPED_TRACE(entry.path().string());
        const std::string text = read_text(entry.path());
        const std::string kind = entry.path().extension().string();
        EXPECT_TRUE(kind != ".json" || Json::accept(text));
        EXPECT_TRUE(kind != ".html" || last_line(text) == "</html>");
        EXPECT_TRUE((kind != ".vtu" && kind != ".vtm" && kind != ".pvd") || last_line(text) == "</VTKFile>");
        if (kind == ".csv") {
            EXPECT_TRUE(text.ends_with('\n'));
            std::set<std::ptrdiff_t> columns;  // equally many in each row
            std::istringstream lines(text);
            for (std::string line; std::getline(lines, line);)
                if (!line.starts_with("#")) columns.insert(std::count(line.begin(), line.end(), ','));
            EXPECT_EQ(columns.size(), 1U);
        }
        if (kind == ".h5") {
            ASSERT_GT(text.size(), 96U);
            EXPECT_EQ(text.substr(0, 8), "\x89HDF\r\n\x1a\n");
            EXPECT_EQ(little_endian(text, text[8] < 2 ? 40 : 28), text.size());  // where the file ends, as it says itself
        }
    }
}

std::map<std::string, std::string> tables_below(const fs::path& results) {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(results)) {
        if (entry.path().extension() != ".csv") continue;
        std::istringstream text(read_text(entry.path()));
        for (std::string line; std::getline(text, line);)
            if (!line.starts_with("#")) found[fs::relative(entry.path(), results).string()] += line + "\n";
    }
    return found;
}

Json without_times(Json test) {
    for (const char* key : {"wall_s", "ms_per_step", "threads"}) test.erase(key);
    return test;
}

// The numbers of all summaries and records.
std::map<std::string, Json> numbers_below(const fs::path& results) {
    std::map<std::string, Json> found;
    for (const auto& entry : fs::recursive_directory_iterator(results)) {
        const std::string name = fs::relative(entry.path(), results).string();
        if (entry.path().filename() == "run.json")
            found[name] = without_times(Json::parse(read_text(entry.path())).at("numbers"));
        if (entry.path().filename() == "summary.json")
            for (const Json& test : Json::parse(read_text(entry.path())).at("tests")) found[name].push_back(without_times(test));
    }
    return found;
}

std::vector<std::string> files_below(const fs::path& results) {
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(results))
        files.push_back(fs::relative(entry.path(), results).string());
    std::sort(files.begin(), files.end());
    return files;
}

// The reason is told where it cost something: the state before the newest one is spare, and SQLite's own files are made again.
bool must_be_told(const Call& call) {
    const std::string path = call.path.string();
    if (path == "ledger.sqlite" && call.kind == "close") return false;  // it was flushed before
    return call.kind != "unlink" && call.kind != "truncate" && !path.ends_with(".before") && path.find(".sqlite-") == path.npos;
}

class FailingDisk : public testing::Test {
protected:
    void write_inputs(const TemporaryFolder& place) const {
        write_text(place / "job.toml",
                   small_job("[[test]]\nkind = \"uniaxial-compression\"\nsnapshots = 2\n", study_ ? "[1]" : "[1, 2]"));
        write_text(
            place / "study.toml",
            "job = \"job.toml\"\nkeep = \"all\"\n[[axis]]\nname = \"mu\"\nkey = \"material.contact.mu\"\nvalues = [0.3, 0.4]\n");
    }
    std::vector<std::string> command() const {
        if (study_) return {"study", "study.toml", "--results", "results", "--checkpoint-every", "20 ms", "--threads", "1"};
        return {"run", "job.toml", "--out", "results", "--checkpoint-every", "20 ms"};
    }

    void sweep() {
        const TemporaryFolder whole;
        write_inputs(whole);
        const Disk watched(whole / "results");
        const Outcome undisturbed = run_program(whole.path(), command(), watched.with({"none", 0, 0, false}));
        ASSERT_EQ(undisturbed.code, 0) << undisturbed.err;
        const std::vector<Fault> faults = faults_of(watched.calls());
        ASSERT_GT(faults.size(), 15U);  // one a kind of call and file; far fewer would say that calls are not seen
        int injected = 0, ended = 0;
        for (const Fault& fault : faults) {
            const TemporaryFolder place;
            write_inputs(place);
            const Disk disk(place / "results");
            const Outcome outcome = run_program(place.path(), command(), disk.with(fault));
            std::vector<Call> failed = disk.calls();
            std::erase_if(failed, [](const Call& call) { return !call.failed; });
            SCOPED_TRACE(text_of(fault) + (failed.empty() ? " (not met)" : ", on '" + failed.front().path.string() + "'") + "\n" +
                         outcome.err);
            injected += failed.empty() ? 0 : 1;
            ended += outcome.code != 0 ? 1 : 0;
            judge(fault, failed, outcome, place / "results");
            if (outcome.code != 0 || fs::exists(place / "results/checkpoints/job")) go_on(place);
            expect_like(place / "results", whole / "results", fault);
            if (HasFatalFailure() || failures_in_a_row() > 12) break;
        }
        std::cout << fmt::format("{} faults met, {} of them ended the program\n", injected, ended);
        EXPECT_GT(injected, static_cast<int>(faults.size()) / 2);
    }

    bool study_ = false;

private:
    int failures_in_a_row() const {
        return ::testing::UnitTest::GetInstance()->current_test_info()->result()->total_part_count();
    }

    void judge(const Fault& fault, const std::vector<Call>& failed, const Outcome& outcome, const fs::path& results) const {
        const bool before_the_run = !failed.empty() && (failed.front().kind == "mkdir" || outcome.out.empty());
        EXPECT_TRUE(outcome.code == 0 || outcome.code == 4 || (before_the_run && outcome.code == 2)) << outcome.code;
        EXPECT_TRUE(!failed.empty() || outcome.code == 0);
        if (outcome.code != 0 || (fault.kind != "short" && std::any_of(failed.begin(), failed.end(), must_be_told))) {
            EXPECT_TRUE(outcome.err.find(std::strerror(fault.error)) != std::string::npos ||
                        outcome.err.find("ledger.sqlite") != std::string::npos)
                << "the reason is not told";
            EXPECT_NE(outcome.err.find("results"), std::string::npos) << "the file is not told";
        }
        EXPECT_TRUE(outcome.code == 0 || outcome.err.find("feldspar: ") != std::string::npos);
        EXPECT_TRUE(outcome.code == 0 || fault.kind != "short");
        if (fault.kind != "unlink") expect_whole_files(results);  // what cannot be removed stays
        if (!study_ || !fs::exists(results / "ledger.sqlite")) return;
        const Outcome status = run_program(results.parent_path(), {"study", "status", "study.toml", "--results", "results"});
        EXPECT_EQ(status.code, 0) << status.err;
    }

    void go_on(const TemporaryFolder& place) const {
        const Outcome again = run_program(place.path(), command());
        EXPECT_EQ(again.code, 0) << "afterwards: " << again.err;
    }

    static void expect_like(const fs::path& results, const fs::path& whole, const Fault& fault) {
        ASSERT_TRUE(fs::exists(results));
        EXPECT_TRUE(tables_below(results) == tables_below(whole));
        EXPECT_EQ(numbers_below(results), numbers_below(whole));
        if (fault.kind == "unlink") return;
        EXPECT_EQ(files_below(results), files_below(whole));
        expect_whole_files(results);
    }
};

TEST_F(FailingDisk, UnderARun) { sweep(); }

// Files that a command makes where the user wants them.
TEST_F(FailingDisk, UnderFilesThatCommandsMake) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"new", "uniaxial-compression", "--out", "made/job.toml"},
          std::vector<std::string>{"export-cells", "job.toml", "--out", "made/cells.tess"}}) {
        for (const char* kind : {"open", "write", "short", "fsync", "close"}) {
            const TemporaryFolder place;
            write_inputs(place);
            fs::create_directory(place / "made");
            const Outcome outcome = run_program(place.path(), arguments, Disk(place / "made").with({kind, 1, ENOSPC, true}));
            SCOPED_TRACE(arguments.front() + ", " + kind + "\n" + outcome.err);
            if (std::string(kind) == "short") {
                EXPECT_EQ(outcome.code, 0);
                EXPECT_EQ(count_entries(place / "made"), 1);
                continue;
            }
            EXPECT_EQ(outcome.code, std::string(kind) == "open" ? 2 : 4);
            EXPECT_NE(outcome.err.find(arguments.back()), std::string::npos);
            EXPECT_NE(outcome.err.find(std::strerror(ENOSPC)), std::string::npos);
            EXPECT_EQ(count_entries(place / "made"), 0);
            EXPECT_EQ(run_program(place.path(), arguments).code, 0);
        }
    }
}

class FailingDiskUnderAStudy : public FailingDisk {
protected:
    FailingDiskUnderAStudy() { study_ = true; }
};

TEST_F(FailingDiskUnderAStudy, GoesOn) { sweep(); }

}  // namespace
}  // namespace feldspar::testing_program
