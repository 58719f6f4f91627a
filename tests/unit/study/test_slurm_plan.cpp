// What goes to a Slurm cluster: groups, estimates, the plan on disk and its scripts. (In a fixture, Run alone is a function of
// GoogleTest.)
#include <gtest/gtest.h>

#include <filesystem>
#include <numeric>

#include "../../temporary_folder.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/study/slurm.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

const std::string small_job = R"([specimen]
shape = "rectangle"
width = "40 mm"
height = "80 mm"
[specimen.grains]
diameter = { distribution = "uniform", minimum = "7 mm", maximum = "11 mm" }
[material.grain]
E = "25.8 GPa"
nu = 0.23
[material.contact]
Kn = "18.00e4 GPa/m"
eta = 0.28
sigma_nt = "8.5 MPa"
tau = "29.75 MPa"
mu = 0.40
Gfn = "20 N/m"
Gfs = "800 N/m"
[[test]]
kind = "uniaxial-compression"
[[test]]
kind = "brazilian"
diameter = "50 mm"
[run]
seeds = [1, 2, 3]
)";

class SlurmPlanTest : public ::testing::Test {
protected:
    SlurmPlanTest() {
        study_ = study_of(parse_job(small_job, "small"), "small study", place_ / "results");
        for (const feldspar::Run& run : study_.runs) runs_.push_back(&run);
    }

    // A record of a run that took so long.
    static RunRecord record_of_time(const feldspar::Run& run, double wall_s, double threads) {
        RunRecord record;
        record.id = run.id;
        record.state = RunState::done;
        record.test = name(run.test().kind);
        record.numbers = {{"wall_s", wall_s}, {"threads", threads}};
        return record;
    }

    TemporaryFolder place_;
    Study study_;
    std::vector<const feldspar::Run*> runs_;
};

using Groups = std::vector<std::vector<std::size_t>>;

TEST(SlurmGroups, NeighboursTogetherUpToTheTarget) {
    EXPECT_EQ(grouped(std::vector<double>{1, 1, 1, 1, 1}, 2.0, 100), (Groups{{0, 1}, {2, 3}, {4}}));
    EXPECT_EQ(grouped(std::vector<double>{1, 5, 1, 1}, 2.0, 100), (Groups{{0}, {1}, {2, 3}}));
    EXPECT_EQ(grouped(std::vector<double>{}, 2.0, 100), Groups{});
}

TEST(SlurmGroups, LongerWhenThereWouldBeTooMany) {
    const std::vector<double> seconds(10'000, 60.0);
    const Groups groups = grouped(seconds, 60.0, 1000);
    EXPECT_LE(groups.size(), 1000u);
    EXPECT_GE(groups.size(), 500u);
    std::size_t next = 0;
    for (const auto& group : groups)
        for (const std::size_t run : group) EXPECT_EQ(run, next++);
    EXPECT_EQ(next, seconds.size());
}

TEST(SlurmGroups, ElementsAsSlurmWritesThem) {
    using Elements = std::vector<std::size_t>;
    EXPECT_EQ(elements_in("3"), Elements{3});
    EXPECT_EQ(elements_in("4-6,9%2"), (Elements{4, 5, 6, 9}));
    EXPECT_EQ(elements_in("N/A"), Elements{});
    EXPECT_EQ(elements_in("1-"), Elements{});
    EXPECT_EQ(elements_in(""), Elements{});
}

TEST_F(SlurmPlanTest, TimesOfLikeRunsReplaceTheDefaults) {
    const feldspar::Run &first = study_.runs[0], &disc = study_.runs[1], &second = study_.runs[2];
    ASSERT_EQ(first.test().kind, second.test().kind);
    ASSERT_EQ(disc.test().kind, methods::brazilian);
    const TimeEstimate unknown;
    EXPECT_GT(unknown.seconds(first), 0.0);
    const TimeEstimate known(study_.runs, std::vector{record_of_time(first, 50.0, 2.0)});
    EXPECT_DOUBLE_EQ(known.seconds(second), 100.0) << "two threads for 50 s";
    EXPECT_DOUBLE_EQ(known.seconds(disc), unknown.seconds(disc));
}

TEST_F(SlurmPlanTest, IsOnDiskWithEverythingThatAnElementNeeds) {
    SlurmOptions options;
    options.group_minutes = 1e-6;  // every run by itself
    options.cpus = 2;
    const SlurmPlan plan = write_plan(study_.results, study_, runs_, TimeEstimate{}, options, "/opt/feldspar");
    EXPECT_EQ(plan.groups.size(), study_.runs.size());
    EXPECT_EQ(plan.directory, study_.results / "slurm" / "1");

    SlurmPlan read = read_plan(plan.directory / ".");
    EXPECT_EQ(read.directory, plan.directory);
    EXPECT_EQ(read.results(), study_.results);
    EXPECT_EQ(read.groups, plan.groups);
    EXPECT_EQ(read.study, "small study");
    EXPECT_EQ(read.cpus, 2);
    EXPECT_EQ(read.keep, Keep::histories);
    EXPECT_TRUE(read.array_job.empty());

    for (const feldspar::Run& run : study_.runs) {  // the same run comes back from its file
        const Job job = read_job(plan.job_file(run.id));
        EXPECT_EQ(make_run(job, job.variants.front(), job.tests.front(), job.seeds.front()).id, run.id);
    }

    read.array_job = "17";
    write_plan_file(read);
    write_plan(study_.results, study_, runs_, TimeEstimate{}, {}, "/opt/feldspar");
    const std::vector<SlurmPlan> plans = read_plans(study_.results);
    ASSERT_EQ(plans.size(), 2u);
    EXPECT_EQ(plans[0].array_job, "17");
    EXPECT_EQ(plans[1].directory.filename(), "2");
    EXPECT_EQ(plans[1].groups.size(), 1u) << "ten minutes hold them all";
}

TEST_F(SlurmPlanTest, ScriptsSayWhatTheUserAsked) {
    SlurmOptions options;
    options.partition = "short";
    options.account = "rock";
    options.time = "0:30:00";
    options.cpus = 4;
    options.array_limit = 8;
    options.group_minutes = 1e-6;
    options.sbatch = "--mem=2G --constraint=\"avx512\"";
    const SlurmPlan plan = write_plan(study_.results, study_, runs_, TimeEstimate{}, options, "/opt/it's here/feldspar");
    const std::string array = read_text(plan.directory / "array.sh"), gather = read_text(plan.directory / "gather.sh");
    for (const char* line : {"#SBATCH --partition=short\n", "#SBATCH --account=rock\n", "#SBATCH --time=0:30:00\n",
                             "#SBATCH --mem=2G --constraint=\"avx512\"\n", "#SBATCH --array=0-5%8\n",
                             "#SBATCH --cpus-per-task=4\n", "#SBATCH --job-name=feldspar-small-study\n", "#SBATCH --requeue\n",
                             "exec '/opt/it'\\''s here/feldspar' study element . \"$SLURM_ARRAY_TASK_ID\"\n"})
        EXPECT_NE(array.find(line), std::string::npos) << line << array;
    for (const char* line : {"#SBATCH --partition=short\n", "#SBATCH --cpus-per-task=1\n", "study gather ../..\n"})
        EXPECT_NE(gather.find(line), std::string::npos) << line << gather;
    EXPECT_EQ(gather.find("--array"), std::string::npos);
}

TEST_F(SlurmPlanTest, RubbishIsRefused) {
    EXPECT_THROW(read_plan(place_.path()), InputError);
    place_.write("plan.json", "{}");
    EXPECT_THROW(read_plan(place_.path()), InputError);
    place_.write("plan.json", "{\"feldspar_slurm_plan\": 1000}");
    EXPECT_THROW(read_plan(place_.path()), InputError);
}

// It is a file that somebody may have sent: its words become names of files and arguments of Slurm's programs.
TEST_F(SlurmPlanTest, NamesNoFileElsewhereAndNoOptionOfSlurm) {
    SlurmPlan plan = write_plan(study_.results, study_, runs_, TimeEstimate{}, SlurmOptions{}, "/opt/feldspar");
    EXPECT_NO_THROW(read_plan(plan.directory));
    for (const char* id : {"../../../elsewhere", "/etc/passwd", "", "a b"}) {
        SlurmPlan bad = plan;
        bad.groups.front().front() = id;
        write_plan_file(bad);
        EXPECT_THROW(read_plan(plan.directory), InputError) << id;
    }
    for (const char* number : {"--clusters=moon", "12;rm", " 12"}) {
        SlurmPlan bad = plan;
        bad.array_job = number;
        write_plan_file(bad);
        EXPECT_THROW(read_plan(plan.directory), InputError) << number;
    }
}

TEST_F(SlurmPlanTest, ALineEndInAnOptionIsNoCommand) {
    const std::string bad = "rock\ntouch made";
    for (const auto& member : {&SlurmOptions::partition, &SlurmOptions::account, &SlurmOptions::time, &SlurmOptions::sbatch}) {
        SlurmOptions options;
        options.*member = bad;
        EXPECT_THROW(write_plan(study_.results, study_, runs_, TimeEstimate{}, options, "/opt/feldspar"), InputError);
    }
    EXPECT_FALSE(fs::exists(study_.results / "slurm"));
}

}  // namespace
}  // namespace feldspar
