// Laboratory numbers in, contact parameters out (docs/calibration.md).
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "feldspar/calibration/calibration.hpp"
#include "feldspar/calibration/learner.hpp"
#include "feldspar/study/execute.hpp"
#include "feldspar/study/run_record.hpp"
#include "feldspar/study/statistics.hpp"

namespace feldspar {

/// How the tests of one target went, on the packings that confirm. Tests of grade C, without a strength and failed ones are not
/// in the mean.
struct TestGrades {
    int A = 0, B = 0, C = 0;
    int unfinished = 0;  ///< of A and B: ended before the strength was known
    int failed = 0;

    int all() const { return A + B + C + failed; }
    int in_mean() const { return A + B - unfinished; }
};

/// Why a target is missed: the first that explains it.
enum class Miss { none, not_confirmed, range_end, conflict, budget, prediction, scatter, grade };

const char* name(Miss miss);

/// What became of a target.
struct TargetOutcome {
    Target target;
    double predicted = 0.0;  ///< at the best set, by what was learned
    double deviation = 0.0;  ///< standard deviation of that: how well the mean over all packings is known
    Foresight foreseen;      ///< of the mean over as many packings as confirm
    MeanInterval confirmed;  ///< on fresh packings; for values that follow from several strengths by the jackknife
    TestGrades grades;       ///< of the tests that confirm
    bool met = false;        ///< confirmed within the tolerance
    Miss miss = Miss::none;
    std::string missed;  ///< one sentence: by how much, why, what to change; empty if it is met
    /// What the ranges allow while all other targets are met; not-a-number if they never are.
    double lowest = std::numeric_limits<double>::quiet_NaN(), highest = std::numeric_limits<double>::quiet_NaN();
};

/// At least half of the tests that confirm it count.
bool enough_confirmed(const TargetOutcome& outcome);

/// What became of an unknown.
struct UnknownOutcome {
    Unknown unknown;
    double best = 0.0;
    double low = 0.0, high = 0.0;  ///< the middle 90 % of the sets that meet the targets as well as can be known
    double determined = 0.0;       ///< 0: any value of the range does; 1: a single one
    bool at_an_end = false;        ///< of its range: a wider one may serve better
};

/// Where a calibration stood when it had learned from so many runs.
struct WayPoint {
    int runs = 0;
    bool elastic = false;   ///< while the elastic constants were sought: only E and nu are looked at
    double farthest = 0.0;  ///< how far the farthest target is predicted from what is wanted, in its tolerances
    std::string target;     ///< which one that is
    double doubt = 0.0;     ///< the largest standard deviation of a prediction, in tolerances
    std::string doubtful;   ///< of which target
    double probability =
        0.0;               ///< that the mean of the confirming packings will lie within the tolerance, of the least likely target
    std::string unlikely;  ///< which one that is
    std::vector<double> best;  ///< of all unknowns, in their units
};

struct CalibrationResult {
    std::vector<UnknownOutcome> unknowns;
    std::vector<TargetOutcome> targets;
    /// [target][unknown]: relative change of the one over relative change of the other, at the best set; not-a-number where it
    /// was not looked at: elastic unknowns are found by E and nu alone.
    std::vector<std::vector<double>> sensitivity;
    std::vector<std::string> findings;  ///< in words: what cannot be told apart, what cannot be had together, what lies at an end
    std::vector<WayPoint> way;          ///< one for each time that something was learned
    Job job;                            ///< the base job with the best set: ready to run
    int runs = 0;                       ///< used, confirmation included, those that were done before too
    int failed = 0, grade_C = 0;        ///< of the tests to learn from: left out; entered as an upper bound or left out
    bool complete = false;              ///< false: interrupted
};

/// Tests that a calibration wants to see: some quantities, at some values of all unknowns, on one packing.
struct Request {
    std::vector<double> values;           ///< of all unknowns, in their units
    std::uint64_t seed = 0;               ///< of the packing
    std::vector<std::size_t> quantities;  ///< which of those that it asks for
    bool elastic = false;                 ///< only E and nu, before damage: by a test that ends at a small strain
    bool whole = false;                   ///< the tests as the job has them; else they end when their strength is known
};

/// A strength so many times the wanted one is far enough to know: a test to learn from ends there.
inline constexpr double far_from_wanted = 2.0;

/// Where the tests are made.
class Laboratory {
public:
    virtual ~Laboratory() = default;

    /// Of each request its quantities, in their order. @throws Interrupted
    virtual std::vector<std::vector<RunReading>> see(const std::vector<Request>& requests,
                                                     const std::vector<Observable>& quantities) = 0;

    /// Tests made so far, those that were in the ledger before too.
    virtual int used() const = 0;
};

/// What a run says of a quantity. A run that is not quasi-static (grade C) shows too much strength if it went too fast through a
/// law that softens: it is an upper bound then, and says nothing else. The estimated error of runs of grades A and B becomes part
/// of their noise.
/// @param elastic  a short test for E and nu before damage, which has no strength and needs no grade; @param brittle  the law of
/// the contacts
RunReading reading_of(const RunRecord& record, const Observable& quantity, bool elastic, bool brittle);

/// Makes the tests by runs on a ledger: those that are done are not repeated.
class RunLaboratory : public Laboratory {
public:
    RunLaboratory(const Calibration& calibration, Ledger& ledger, ExecuteControl control)
        : calibration_(calibration), ledger_(ledger), control_(std::move(control)) {}
    std::vector<std::vector<RunReading>> see(const std::vector<Request>& requests,
                                             const std::vector<Observable>& quantities) override;
    int used() const override { return static_cast<int>(numbers_.size()) - left_; }

    /// Of a run that was asked for: the how many-th of the calibration it is, from 1 on, those in the ledger before it counted
    /// too.
    int number_of(const Run& run) const { return numbers_.at(run.id); }

private:
    Run run_for(const Request& request, const Observable& quantity) const;
    void end_when_known(TestSpec& test) const;

    const Calibration& calibration_;
    Ledger& ledger_;
    ExecuteControl control_;
    std::map<std::string, int> numbers_;  // of the runs by their id
    int left_ = 0;                        // of them not run: interrupted
};

/// To be called before any run and before there is a directory. @throws InputError if the budget does not cover the runs that
/// confirm the answer and the first ones to learn from
void check_budget(const Calibration& calibration);

/// Learns, chooses and confirms. Everything it decides follows from the file and from what it sees, so that a second call goes
/// the same way over the runs in the ledger, and on from where the first one was interrupted.
/// @param note  told in words what it does now; may be empty
CalibrationResult calibrate(const Calibration& calibration, Laboratory& laboratory,
                            const std::function<void(const std::string&)>& note);

}  // namespace feldspar
