// The ledger: who may take a run, what is kept of it, and what it survives.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <thread>

#include "../../small_study.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/study/ledger.hpp"

namespace feldspar {
namespace {

class LedgerOfAStudy : public ::testing::Test {
protected:
    StudyFolder folder_;
    Study study_ =
        parse_study("job = \"job.toml\"\n[[axis]]\nname = \"mu\"\nkey = \"material.contact.mu\"\nvalues = [0.2, 0.5]\n",
                    folder_ / "study.toml");
    std::filesystem::path place_ = folder_ / "results";

    RunRecord done(const feldspar::Run& run, double strength_Pa) const {
        TestResult result;
        result.properties.peak_stress_Pa = strength_Pa;
        result.properties.nu = std::numeric_limits<double>::quiet_NaN();
        result.properties.peak_reached = true;
        result.evidence.grade = 'B';
        result.evidence.verdict = "quoted 'verdict', with ∑ in it";
        return record_of(run, result, collect_provenance("test", 1));
    }

    SQLite::Database raw() const { return SQLite::Database((place_ / "ledger.sqlite").string(), SQLite::OPEN_READWRITE); }
};

TEST_F(LedgerOfAStudy, KeepsEveryBitOfARecord) {
    const RunRecord record = done(study_.runs[0], 0.1 + 0.2);
    {
        Ledger ledger(place_, Ledger::Access::write);
        ASSERT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::ours);
        ledger.record(record);
    }
    const Ledger again(place_, Ledger::Access::read);
    const auto found = again.find(study_.runs[0].id);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->state, RunState::done);
    EXPECT_EQ(found->numbers.at("strength_Pa"), 0.1 + 0.2);
    EXPECT_TRUE(std::isnan(found->numbers.at("nu")));
    EXPECT_EQ(found->texts.at("verdict"), record.texts.at("verdict"));
    EXPECT_EQ(found->job, resolved_toml(study_.runs[0].job));
    EXPECT_FALSE(again.find(study_.runs[1].id));

    const TestResult result = result_of(*found);
    EXPECT_EQ(result.properties.peak_stress_Pa, 0.1 + 0.2);
    EXPECT_TRUE(result.properties.peak_reached);
    EXPECT_EQ(result.evidence.grade, 'B');
    EXPECT_EQ(result.seed, 1u);
}

TEST_F(LedgerOfAStudy, ARecordIsTheSameAsAFile) {
    const RunRecord record = done(study_.runs[0], 1.0 / 3.0);
    folder_.write("run.json", to_json(record));
    const RunRecord again = read_record(folder_ / "run.json");
    EXPECT_EQ(to_json(again), to_json(record));
    EXPECT_EQ(again.numbers.at("strength_Pa"), 1.0 / 3.0);
    folder_.write("half.json", to_json(record).substr(0, 100));
    EXPECT_THROW((void)read_record(folder_ / "half.json"), InputError);
}

TEST_F(LedgerOfAStudy, ARunIsTakenOnceAndNeverReplaced) {
    Ledger ledger(place_, Ledger::Access::write);
    Ledger other(place_, Ledger::Access::write);  // of the same process: alive
    EXPECT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::ours);
    EXPECT_EQ(other.claim(study_.runs[0]), Ledger::Claim::others);
    ledger.release(study_.runs[0].id);
    EXPECT_EQ(other.claim(study_.runs[0]), Ledger::Claim::ours);
    other.record(done(study_.runs[0], 1e6));
    EXPECT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::done);
    ledger.record(done(study_.runs[0], 2e6));
    ledger.record(failed_record(study_.runs[0], "late", Failure::numerical, {}));
    EXPECT_EQ(ledger.find(study_.runs[0].id)->numbers.at("strength_Pa"), 1e6);
    ledger.release(study_.runs[0].id);
    EXPECT_TRUE(ledger.find(study_.runs[0].id));
}

TEST_F(LedgerOfAStudy, AFailedRunHasAReasonAndMayBeTakenAgain) {
    Ledger ledger(place_, Ledger::Access::write);
    ASSERT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::ours);
    const Provenance program = collect_provenance("test", 1);
    ledger.record(failed_record(study_.runs[0], "there is not enough memory", Failure::other, program));
    EXPECT_EQ(ledger.find(study_.runs[0].id)->reason, "there is not enough memory");
    EXPECT_EQ(ledger.claim(study_.runs[0], &program), Ledger::Claim::ours);
    ledger.record(done(study_.runs[0], 3e6));
    EXPECT_EQ(ledger.find(study_.runs[0].id)->reason, "");
}

TEST_F(LedgerOfAStudy, AFailureForGoodIsKeptForTheProgramThatHadIt) {
    const Provenance program = collect_provenance("test", 1);
    Provenance later = program, patched = program;
    later.version = "9.9.9";
    patched.commit = "another";
    for (const Failure failure : {Failure::input, Failure::numerical}) {
        const feldspar::Run& run = study_.runs[failure == Failure::input ? 0 : 1];
        {
            Ledger ledger(place_, Ledger::Access::write);
            ASSERT_EQ(ledger.claim(run, &program), Ledger::Claim::ours);
            ledger.record(failed_record(run, "a force is not a number", failure, program));
            EXPECT_EQ(ledger.claim(run), Ledger::Claim::failed);  // what has failed here is not tried again here
        }
        for (const Provenance* other : std::initializer_list<const Provenance*>{&later, &patched, nullptr}) {
            Ledger ledger(place_, Ledger::Access::write);
            EXPECT_EQ(ledger.claim(run, &program), Ledger::Claim::failed);
            EXPECT_EQ(ledger.find(run.id)->reason, "a force is not a number");
            ASSERT_EQ(ledger.claim(run, other), Ledger::Claim::ours);  // another program's failure, or all may be tried again
            ledger.record(failed_record(run, "a force is not a number", failure, program));
        }
    }
}

TEST_F(LedgerOfAStudy, WhatFailedBeforeThereWereKindsOfFailuresMayBeTakenAgain) {
    const Provenance program = collect_provenance("test", 1);
    {
        Ledger ledger(place_, Ledger::Access::write);
        ASSERT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::ours);
        ledger.record(failed_record(study_.runs[0], "a force is not a number", Failure::numerical, program));
        raw().exec("ALTER TABLE run DROP COLUMN failure");
        raw().exec("ALTER TABLE run DROP COLUMN checksum");
    }
    Ledger ledger(place_, Ledger::Access::write);
    EXPECT_EQ(ledger.claim(study_.runs[0], &program), Ledger::Claim::ours);
}

TEST_F(LedgerOfAStudy, WhatADeadProcessHadIsFree) {
    { const Ledger made(place_, Ledger::Access::write); }
    const pid_t child = fork();
    if (child == 0) {
        Ledger ledger(place_, Ledger::Access::write);
        _exit(ledger.claim(study_.runs[0]) == Ledger::Claim::ours ? 0 : 1);  // without a word
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0);
    Ledger ledger(place_, Ledger::Access::write);
    EXPECT_EQ(ledger.find(study_.runs[0].id)->state, RunState::running);
    EXPECT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::ours);
}

TEST_F(LedgerOfAStudy, WhatASilentMachineHadIsFreeAfterAWhile) {
    Ledger ledger(place_, Ledger::Access::write, std::chrono::milliseconds(100));
    ASSERT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::ours);
    EXPECT_TRUE(ledger.holds(study_.runs[0].id));
    raw().exec("UPDATE run SET holder = 'elsewhere 1 2'");
    EXPECT_FALSE(ledger.holds(study_.runs[0].id));
    EXPECT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::others);
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    EXPECT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::others);  // heard of a moment ago
    raw().exec("UPDATE run SET heard = heard - 3600");
    EXPECT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::others);  // is watched first
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    EXPECT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::ours);
}

// The clock of the other machine, or of this one, is hours wrong, or jumps: whoever gives signs of life keeps the run.
TEST_F(LedgerOfAStudy, AClockThatJumpsTakesNoRunAway) {
    for (const char* jump : {"UPDATE run SET heard = heard - 36000", "UPDATE run SET heard = heard + 36000"}) {
        Ledger ledger(place_, Ledger::Access::write, std::chrono::milliseconds(300));
        ASSERT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::ours);
        raw().exec("UPDATE run SET holder = 'elsewhere 1 2'");
        raw().exec(jump);
        for (int beat = 0; beat < 6; ++beat) {
            EXPECT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::others);
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            raw().exec("UPDATE run SET heard = heard + 20");
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        EXPECT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::others);
        std::this_thread::sleep_for(std::chrono::milliseconds(350));
        EXPECT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::ours);  // silent at last
        ledger.release(study_.runs[0].id);
    }
}

TEST_F(LedgerOfAStudy, AFileThatWasRemovedOrReplacedIsNotWrittenTo) {
    for (const bool replaced : {false, true}) {
        Ledger ledger(place_, Ledger::Access::write);
        ASSERT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::ours);
        std::filesystem::rename(place_ / "ledger.sqlite", place_ / "elsewhere");
        if (replaced) std::filesystem::copy_file(place_ / "elsewhere", place_ / "ledger.sqlite");
        EXPECT_THROW((void)ledger.claim(study_.runs[1]), OutputError);
        EXPECT_THROW(ledger.record(done(study_.runs[0], 4e6)), OutputError);
        std::filesystem::remove_all(place_);
    }
}

TEST_F(LedgerOfAStudy, ANumberThatChangedOnTheDiskIsNotBelieved) {
    Ledger ledger(place_, Ledger::Access::write);
    ASSERT_EQ(ledger.claim(study_.runs[0]), Ledger::Claim::ours);
    ledger.record(done(study_.runs[0], 4e6));
    EXPECT_TRUE(ledger.find(study_.runs[0].id));
    for (const char* change : {"UPDATE run SET strength_Pa = 4000000.5", "UPDATE run SET strength_Pa = 4e6, verdict = 'good'",
                               "UPDATE run SET verdict = NULL, job = ''"}) {
        raw().exec(change);
        EXPECT_THROW((void)ledger.find(study_.runs[0].id), OutputError);
        EXPECT_THROW((void)ledger.claim(study_.runs[0]), OutputError);
    }
    raw().exec("UPDATE run SET checksum = NULL");  // as an earlier version writes it
    EXPECT_TRUE(ledger.find(study_.runs[0].id));
}

TEST_F(LedgerOfAStudy, SaysWhichRunsAStudyConsistsOf) {
    Ledger ledger(place_, Ledger::Access::write);
    ledger.enrol(study_);
    ledger.enrol(study_);
    EXPECT_EQ(raw().execAndGet("SELECT count(*) FROM member WHERE study = 'study'").getInt(), 8);
    EXPECT_EQ(raw().execAndGet("SELECT count(*) FROM member WHERE axis = 'mu' AND number = 0.5").getInt(), 4);
    EXPECT_EQ(raw().execAndGet("SELECT count(*) FROM member WHERE number = 0.5 AND label = '0.5'").getInt(), 4);
}

TEST_F(LedgerOfAStudy, LearnsColumnsThatAnEarlierVersionDidNotKnow) {
    {
        Ledger ledger(place_, Ledger::Access::write);
        (void)ledger.claim(study_.runs[0]);
        ledger.record(done(study_.runs[0], 4e6));
        raw().exec("ALTER TABLE run DROP COLUMN energy_residual");
        raw().exec("ALTER TABLE run DROP COLUMN checksum");
    }
    Ledger ledger(place_, Ledger::Access::write);
    EXPECT_EQ(ledger.find(study_.runs[0].id)->numbers.at("strength_Pa"), 4e6);
    EXPECT_TRUE(std::isnan(ledger.find(study_.runs[0].id)->numbers.at("energy_residual")));
}

TEST_F(LedgerOfAStudy, RefusesWhatItCannotRead) {
    EXPECT_THROW(Ledger(place_, Ledger::Access::read), InputError);  // nothing there
    std::filesystem::create_directories(place_);
    folder_.write("results/ledger.sqlite", std::string(4096, 'x'));
    EXPECT_THROW(Ledger(place_, Ledger::Access::write), InputError);
    std::filesystem::remove(place_ / "ledger.sqlite");
    { const Ledger made(place_, Ledger::Access::write); }
    raw().exec("PRAGMA user_version = 99");
    EXPECT_THROW(Ledger(place_, Ledger::Access::read), InputError);
}

}  // namespace
}  // namespace feldspar
