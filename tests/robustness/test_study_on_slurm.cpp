// A study on a cluster without a cluster: stand-ins for Slurm's programs run the scripts at once, or only put them into their
// queue.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace feldspar::testing_program {
namespace {

using nlohmann::json;

// sbatch: numbers the job and, unless it is told to hold or to refuse, runs the script: once, or for every element of the array.
constexpr const char* stand_in_sbatch = R"(#!/bin/sh
for script; do :; done
[ "$script" = --version ] && exit 0
if [ -e "$STAND_IN/refuse" ]; then echo "sbatch: error: invalid partition specified: moon" >&2; exit 1; fi
number=$(($(cat "$STAND_IN/last" 2>/dev/null || echo 0) + 1))
echo $number > "$STAND_IN/last"
echo "$@" >> "$STAND_IN/calls"
last=$(sed -n 's/^#SBATCH --array=0-\([0-9]*\).*/\1/p' "$script")
if [ -e "$STAND_IN/hold" ]; then
    for k in ${last:+$(seq 0 "$last")}; do echo "$number $k PENDING" >> "$STAND_IN/queue"; done
    [ -n "$last" ] || echo "$number N/A PENDING" >> "$STAND_IN/queue"
elif [ -n "$last" ]; then
    for k in $(seq 0 "$last"); do SLURM_ARRAY_TASK_ID=$k sh "$script" > element-$k.out 2>&1 < /dev/null; done
else
    sh "$script" > gather.out 2>&1 < /dev/null
fi
echo $number
)";
constexpr const char* stand_in_squeue = "#!/bin/sh\n[ \"$1\" = --version ] || cat \"$STAND_IN/queue\" 2>/dev/null\nexit 0\n";
constexpr const char* stand_in_sacct = "#!/bin/sh\necho 'Slurm accounting storage is disabled' >&2\nexit 1\n";
constexpr const char* stand_in_scontrol = "#!/bin/sh\ncat \"$STAND_IN/ended\" 2>/dev/null\nexit 0\n";

auto line_count(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

// A workplace with a small study and a stand-in for Slurm.
class Cluster {
public:
    Cluster() {
        fs::create_directory(tools());
        for (const auto& [name, script] : {std::pair{"sbatch", stand_in_sbatch}, std::pair{"squeue", stand_in_squeue},
                                           std::pair{"sacct", stand_in_sacct}, std::pair{"scontrol", stand_in_scontrol}}) {
            write_text(tools() / name, script);
            fs::permissions(tools() / name, fs::perms::owner_all);
        }
        write_text(place_ / "job.toml", small_job());
        write_study("");
    }

    // Two runs a value of the fracture energy, and whatever else is given.
    void write_study(const std::string& more) const {
        write_text(place_ / "study.toml",
                   "job = \"job.toml\"\nseeds = [1, 2]\n" + more +
                       "[[axis]]\nname = \"Gfn\"\nkey = \"material.contact.Gfn\"\nvalues = [\"20 N/m\", \"30 N/m\"]\n");
    }

    Outcome study(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "study");
        return run_program(place_.path(), arguments, [this] { enter(); });
    }

    Outcome submit(std::vector<std::string> more = {}) const {
        std::vector<std::string> arguments{"study.toml", "--results", "there", "--on", "slurm", "--group-minutes", "1e-9"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return study(arguments);
    }

    // In the child: the stand-ins come first.
    void enter() const {
        setenv("STAND_IN", tools().c_str(), 1);
        setenv("PATH", (tools().string() + ":" + std::getenv("PATH")).c_str(), 1);
    }

    fs::path tools() const { return place_ / "tools"; }
    fs::path operator/(const std::string& name) const { return place_ / name; }
    const fs::path& path() const { return place_.path(); }
    void tell(const std::string& what, const std::string& text = "") const { write_text(tools() / what, text); }
    void untell(const std::string& what) const { fs::remove(tools() / what); }
    int calls() const { return static_cast<int>(line_count(read_text(tools() / "calls"))); }

private:
    TemporaryFolder place_;
};

// The records below a directory of results, by id, without what differs from machine to machine.
std::map<std::string, json> records_in(const fs::path& results) {
    std::map<std::string, json> records;
    for (const auto& entry : fs::directory_iterator(results / "runs")) {
        if (!fs::exists(entry.path() / "run.json")) continue;
        json record = json::parse(read_text(entry.path() / "run.json"));
        record.erase("checksum");  // also of what is taken out here
        for (const char* key : {"wall_s", "ms_per_step", "threads"}) record["numbers"].erase(key);
        for (const char* key : {"started", "command_line"}) record["texts"].erase(key);
        records[entry.path().filename().string()] = record;
    }
    return records;
}

// The ledger as CSV, a row a run.
std::string rows_of(const Cluster& cluster, const std::string& results) {
    const Outcome table = cluster.study({"table", "study.toml", "--results", results, "--runs"});
    EXPECT_EQ(table.code, 0) << table.err;
    return table.out;
}

TEST(StudyOnSlurm, HasTheSameRowsAsHere) {
    const Cluster cluster;
    const Outcome here = cluster.study({"study.toml", "--results", "here"});
    ASSERT_EQ(here.code, 0) << here.err;
    const Outcome there = cluster.submit();
    ASSERT_EQ(there.code, 0) << there.err << there.out;
    EXPECT_NE(there.out.find("4 elements of job 1; job 2"), std::string::npos) << there.out;
    const auto records = records_in(cluster / "there");
    EXPECT_EQ(records.size(), 4u);
    EXPECT_EQ(records, records_in(cluster / "here"));
    EXPECT_EQ(line_count(rows_of(cluster, "there")), line_count(rows_of(cluster, "here")));
    expect_no_half_files(cluster / "there");
}

TEST(StudyOnSlurm, ElementsLeaveTheLedgerAlone) {
    const Cluster cluster;
    cluster.tell("hold");
    ASSERT_EQ(cluster.submit().code, 0);
    const std::string before = read_text(cluster / "there/ledger.sqlite");
    const Outcome element = cluster.study({"element", "there/slurm/1", "0"});
    EXPECT_EQ(element.code, 0) << element.err;
    EXPECT_EQ(read_text(cluster / "there/ledger.sqlite"), before);
    EXPECT_EQ(records_in(cluster / "there").size(), 1u);
    const Outcome again = cluster.study({"element", "there/slurm/1", "0"});  // requeued
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_NE(again.err.find("0 done now, 1 before"), std::string::npos) << again.err;
    EXPECT_EQ(cluster.study({"element", "there/slurm/1", "4"}).code, 2);
    EXPECT_EQ(cluster.study({"element", "there", "0"}).code, 2);
}

TEST(StudyOnSlurm, QueuedRunsAreNotSubmittedTwice) {
    const Cluster cluster;
    cluster.tell("hold");
    ASSERT_EQ(cluster.submit().code, 0);
    EXPECT_EQ(cluster.calls(), 2);
    const Outcome again = cluster.submit();
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(cluster.calls(), 2) << again.out;
    EXPECT_NE(again.out.find("4 runs already in Slurm's queue"), std::string::npos) << again.out;
    const Outcome status = cluster.study({"status", "study.toml", "--results", "there"});
    EXPECT_NE(status.out.find("Slurm job 1: 0/4 runs; elements: 0 running, 4 waiting"), std::string::npos) << status.out;

    cluster.tell("queue", "1 2 RUNNING\n1 3 RUNNING\n2 N/A PENDING\n");  // two elements have gone, without a result
    cluster.untell("hold");
    const Outcome rest = cluster.submit();
    EXPECT_EQ(rest.code, 0) << rest.err;
    EXPECT_NE(rest.out.find("Submitted 2 runs"), std::string::npos) << rest.out;
    EXPECT_EQ(records_in(cluster / "there").size(), 2u);
}

TEST(StudyOnSlurm, LostRunsAreReportedAndSubmittedAgain) {
    const Cluster cluster;
    cluster.tell("hold");
    ASSERT_EQ(cluster.submit().code, 0);
    cluster.tell("queue");
    cluster.tell("ended",
                 "JobId=5 ArrayJobId=1 ArrayTaskId=0 JobName=x JobState=TIMEOUT Reason=None ExitCode=0:15\n"
                 "JobId=1 ArrayJobId=1 ArrayTaskId=1-2 JobName=x JobState=CANCELLED Reason=None ExitCode=0:0\n"
                 "JobId=6 ArrayJobId=1 ArrayTaskId=3 JobName=x JobState=FAILED Reason=NonZeroExitCode ExitCode=130:0\n");
    const Outcome gathered = cluster.study({"gather", "study.toml", "--results", "there"});
    EXPECT_EQ(gathered.code, 3) << gathered.err;
    EXPECT_NE(gathered.out.find("1 run of element 1_0: it reached its time limit"), std::string::npos) << gathered.out;
    EXPECT_NE(gathered.out.find("1 run of element 1_1: it was cancelled"), std::string::npos) << gathered.out;
    EXPECT_NE(gathered.out.find("1 run of element 1_3: it was asked to stop"), std::string::npos) << gathered.out;
    EXPECT_NE(gathered.out.find("0 runs taken into the ledger, 0 in the queue, 0 failed, 4 not done"), std::string::npos)
        << gathered.out;
    cluster.untell("hold");
    const Outcome again = cluster.submit({"--wait"});
    EXPECT_EQ(again.code, 0) << again.err << again.out;
    EXPECT_EQ(records_in(cluster / "there").size(), 4u);
    EXPECT_EQ(cluster.study({"gather", "there"}).code, 0);
    EXPECT_NE(cluster.submit().out.find("Nothing to submit: 4 runs done"), std::string::npos);
}

TEST(StudyOnSlurm, FailuresCarryTheirReason) {
    const Cluster cluster;
    cluster.write_study(
        "[[axis]]\nname = \"masses\"\n[[axis.value]]\nlabel = \"sound\"\nset = {}\n"
        "[[axis.value]]\nlabel = \"unstable\"\nset = { numerics.mass_factor = 0.01 }\nseeds = [1]\n");
    const Outcome first = cluster.submit({"--wait"});
    EXPECT_EQ(first.code, 3) << first.err << first.out;
    EXPECT_NE(first.out.find("failed: uniaxial-compression, seed 1 (run "), std::string::npos) << first.out;
    EXPECT_NE(first.out.find("mass_factor"), std::string::npos) << first.out;
    EXPECT_NE(read_text(cluster / "there/slurm/1/gather.out").find("2 failed"), std::string::npos)
        << read_text(cluster / "there/slurm/1/gather.out");
    const Outcome again = cluster.submit();  // they would fail again
    EXPECT_NE(again.out.find("2 runs failed before and not repeated"), std::string::npos) << again.out;
    EXPECT_NE(again.out.find("Nothing to submit"), std::string::npos) << again.out;
    const Outcome asked = cluster.submit({"--retry-failed"});
    EXPECT_NE(asked.out.find("Submitted 2 runs"), std::string::npos) << asked.out;
}

TEST(StudyOnSlurm, AnElementEndsCleanlyWhenAsked) {
    const Cluster cluster;
    write_text(cluster / "job.toml",
               small_job("[[test]]\nkind = \"uniaxial-compression\"\n", "[1]", "kind = \"paper\"\nspeed = \"1e-12 m\"\n"));
    cluster.tell("hold");
    ASSERT_EQ(cluster.submit().code, 0);
    Program element(cluster.path(), {"study", "element", "there/slurm/1", "0"}, [&] { cluster.enter(); });
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    element.send(SIGTERM);
    const Outcome outcome = element.finish();
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_NE(outcome.err.find("0 done now, 0 before, 0 failed, 1 left"), std::string::npos) << outcome.err;
    EXPECT_TRUE(records_in(cluster / "there").empty());
    expect_no_half_files(cluster / "there");
}

TEST(StudyOnSlurm, ARefusalIsPassedOn) {
    const Cluster cluster;
    cluster.tell("refuse");
    const Outcome refused = cluster.submit({"--partition", "moon"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("invalid partition specified: moon"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("there/slurm/1/array.sh"), std::string::npos) << refused.err;
    cluster.untell("refuse");
    EXPECT_NE(cluster.submit().out.find("Submitted 4 runs"), std::string::npos);
}

TEST(StudyOnSlurm, WithoutSlurmItSaysSo) {
    const Cluster cluster;
    const Outcome outcome =
        run_program(cluster.path(), {"study", "study.toml", "--on", "slurm"}, [] { setenv("PATH", "/nowhere", 1); });
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find("no program 'sbatch' on the PATH"), std::string::npos) << outcome.err;
    EXPECT_EQ(cluster.study({"study.toml", "--partition", "x"}).code, 2) << "only together with --on slurm";
    EXPECT_EQ(cluster.study({"study.toml", "--on", "moon"}).code, 2);
    EXPECT_EQ(cluster.study({"gather", "study.toml"}).code, 2) << "nothing was ever submitted";
}

}  // namespace
}  // namespace feldspar::testing_program
