// What a finished job leaves: its summary.json, and the columns of its histories as hashes. Recorded (golden.hpp), with portable
// kernels, without what differs from run to run (times, threads, version, machine).
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "feldspar/fast/choose_kernels.hpp"
#include "feldspar/lab/run_test.hpp"
#include "feldspar/output/results.hpp"
#include "golden.hpp"

namespace feldspar {
namespace {

using Json = nlohmann::ordered_json;

class Results : public testing::Test {
protected:
    static void SetUpTestSuite() {
        use_kernels(kernels_portable);
        run_.folder = std::make_unique<TemporaryFolder>();
        Job& job = run_.job;
        job = read_job(golden::folder() / "small.toml");
        for (TestSpec& test : job.tests)
            if (test.specimen)
                test.specimen->packing_file = golden::folder() / "disc.packing";  // a job has one packing file, of its rectangle
        const auto rectangle = std::make_shared<const Specimen>(make_specimen(job.specimen, 1));
        const Variant& rock = job.variants.front();
        for (const TestSpec& test : job.tests)
            run_.results.push_back(
                run_test({test.specimen ? std::make_shared<const Specimen>(make_specimen(*test.specimen, 1)) : rectangle,
                          rock.model, rock.grain, rock.contact, rock.numerics, test},
                         {}));
        const RunDirectory directory = RunDirectory::create(*run_.folder / "run", job.name);
        const Provenance provenance;  // empty
        for (const TestResult& result : run_.results) write_history_csv(directory, result, provenance);
        write_summary(directory, job, run_.results, summarise(run_.results), provenance, true);
    }
    static void TearDownTestSuite() { run_ = {}; }

    static std::filesystem::path path() { return *run_.folder / "run"; }

    struct Run {
        std::unique_ptr<TemporaryFolder> folder;
        Job job;
        std::vector<TestResult> results;
    };
    static inline Run run_;
};

TEST_F(Results, HaveTheRecordedSummary) {
    Json summary = Json::parse(read_text(path() / "summary.json"));
    for (Json& test : summary["tests"])
        for (const char* key : {"wall_s", "ms_per_step", "threads"}) EXPECT_EQ(test.erase(key), 1U) << key;
    for (const char* key : {"version", "commit", "provenance", "job"})
        EXPECT_EQ(summary.erase(key), 1U) << key;  // the job has a file of its own
    golden::File recorded("summaries.txt", golden::File::Kind::texts);
    std::set<std::string> keys;
    const auto expect = [&](const std::string& key, const Json& part) {
        keys.insert(key);
        recorded.expect(key, part.dump(1) + "\n");
    };
    for (const Json& test : summary["tests"]) expect("test " + test["kind"].get<std::string>(), test);
    summary.erase("tests");
    for (const auto& [key, part] : summary.items()) expect("summary " + key, part);
    recorded.expect_only(keys);
}

TEST_F(Results, HaveTheRecordedHistories) {
    golden::File recorded("histories.csv", golden::File::Kind::table, "rows,last,values");
    std::set<std::string> keys;
    for (const TestResult& result : run_.results) {
        std::vector<std::string> names;
        std::vector<std::vector<std::string>> columns;
        for (const std::string& line : golden::split(read_text(path() / ("history-" + test_stem(result) + ".csv")), '\n')) {
            if (line.starts_with("#")) continue;
            const std::vector<std::string> cells = golden::split(line, ',');
            if (names.empty()) {
                names = cells;
                columns.resize(names.size());
                continue;
            }
            ASSERT_EQ(cells.size(), names.size());
            for (std::size_t c = 0; c < cells.size(); ++c) columns[c].push_back(cells[c]);
        }
        ASSERT_FALSE(columns.empty());
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const std::string text = fmt::format("{}", fmt::join(columns[c], "\n")),
                              key = fmt::format("{} {}", test_stem(result), names[c]);
            keys.insert(key);
            recorded.expect(key, fmt::format("{},{:.5g},{:016x}", columns[c].size(), std::stod(columns[c].back()),
                                             static_cast<std::uint64_t>(XXH3_64bits(text.data(), text.size()))));
        }
    }
    recorded.expect_only(keys);
}

}  // namespace
}  // namespace feldspar
