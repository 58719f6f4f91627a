// Jobs as they are written out with every default, and the identities of runs. Both are recorded (golden.hpp). An identity that
// moves makes every run that anyone has in a ledger count as not done, so a new key, a new default or another order of keys must
// be a decision.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "feldspar/job/job_template.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/study/study.hpp"
#include "golden.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

const fs::path source = FELDSPAR_SOURCE_DIR;

struct NamedJob {
    std::string name;  // its path in the repository, or "template <kind>"
    Job job;
};

// Every TOML file of a folder, by its path in the repository, with its text.
std::map<std::string, std::string> files_of(const std::string& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(source / folder))
        if (entry.path().extension() == ".toml")
            files[fs::relative(entry.path(), source).generic_string()] = "\n" + read_text(entry.path());
    return files;
}

bool stands_on_a_job(const std::string& text) { return text.find("\njob = ") != std::string::npos; }
bool has_a_specimen(const std::string& text) { return text.find("\n[specimen]") != std::string::npos; }
bool has_targets(const std::string& text) { return text.find("\n[targets]") != std::string::npos; }

// All examples, the jobs that studies stand on, what `feldspar new` prints, and jobs made for these tests.
const std::vector<NamedJob>& jobs() {
    static const std::vector<NamedJob> all = [] {
        std::vector<NamedJob> found;
        for (const char* folder : {"examples", "studies", "tests/regression"})
            for (const auto& [file, text] : files_of(folder))
                if (has_a_specimen(text) && !stands_on_a_job(text)) found.push_back({file, read_job(source / file)});
        for (const std::string_view kind : job_template_kinds())
            found.push_back({fmt::format("template {}", kind), parse_job(job_template(kind), std::string(kind))});
        return found;
    }();
    return all;
}

// Without what depends on where the sources are.
std::string without_source(std::string text) {
    for (std::size_t at = 0; (at = text.find(source.string() + "/", at)) != std::string::npos;)
        text.erase(at, source.string().size() + 1);
    return text;
}

TEST(ResolvedJobs, AreThoseRecorded) {
    golden::File recorded("resolved-jobs.txt", golden::File::Kind::texts);
    std::set<std::string> keys;
    for (const auto& [name, job] : jobs()) {
        keys.insert(name);
        recorded.expect(name, without_source(resolved_toml(job)));
    }
    recorded.expect_only(keys);
    EXPECT_GE(keys.size(), 15U) << "jobs are not found any more";
}

TEST(ResolvedJobs, ReadBackResolveToThemselves) {
    for (const auto& [name, job] : jobs())
        EXPECT_EQ(resolved_toml(parse_job(resolved_toml(job), job.name)), resolved_toml(job)) << name;
}

// Of several runs: their number and a hash of all identities in their order.
std::string all_of(const std::vector<Run>& runs) {
    std::string ids;
    for (const Run& run : runs) ids += run.id;
    return fmt::format("{},{:016x}", runs.size(), static_cast<std::uint64_t>(XXH3_64bits(ids.data(), ids.size())));
}

TEST(RunIdentities, AreThoseRecorded) {
    golden::File recorded("run-identities.csv", golden::File::Kind::table, "runs,identity");
    std::set<std::string> keys;
    const auto expect = [&](const std::string& key, const std::string& value) {
        EXPECT_TRUE(keys.insert(key).second) << key;
        recorded.expect(key, value);
    };
    for (const auto& [name, job] : jobs()) {
        for (const Variant& variant : job.variants)
            for (const TestSpec& test : job.tests) {
                const std::uint64_t seed = test.seeds.empty() ? job.seeds.front() : test.seeds.front();
                if (!variant.runs(test, seed)) continue;
                const std::string of_test = fmt::format("{}{}", feldspar::name(test.kind),
                                                        test.kind == methods::biaxial || method_of(test).specimen.sheared
                                                            ? fmt::format(" at {:.6g} MPa", test.sigma3_Pa / 1e6)
                                                            : "");
                expect(fmt::format("{} | {}{}{} | seed {}", name, variant.stem, variant.stem.empty() ? "" : " ", of_test, seed),
                       "1," + make_run(job, variant, test, seed).id);
            }
        expect(name + " | all", all_of(study_of(job, job.name, "results").runs));
    }
    std::size_t studies = 0;
    for (const auto& [file, text] : files_of("studies")) {
        if (!stands_on_a_job(text) || has_targets(text)) continue;
        ++studies;
        const Study study = read_study(source / file);
        expect(file + " | all", all_of(study.runs));
        expect(file + " | first", "1," + study.runs.front().id);
        expect(file + " | last", "1," + study.runs.back().id);
    }
    EXPECT_GE(studies, 10U) << "studies are not found any more";
    recorded.expect_only(keys);
}

}  // namespace
}  // namespace feldspar
