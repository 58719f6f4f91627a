#include "feldspar/calibration/calibrate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>

#include "feldspar/base/error.hpp"
#include "feldspar/calibration/calibration_files.hpp"
#include "feldspar/calibration/insight.hpp"
#include "feldspar/calibration/missed.hpp"
#include "feldspar/calibration/search.hpp"

namespace feldspar {
namespace {

constexpr std::size_t first_points_per_unknown = 4;  // of the space-filling set
constexpr std::size_t points_per_round = 4;          // whatever the number of threads: the way must be the same on every machine
constexpr std::size_t most_elastic_rounds = 4;
constexpr double sure = 0.95;  // probability with which the confirming mean of each target is to lie within its tolerance
constexpr double good_share =
    0.5;  // of a tolerance: elastic constants are predicted so near; doubt that hardly moves what can be had
constexpr double little_share = 0.1;  // of a tolerance: doubt that hardly moves the probability
constexpr std::size_t patience = 5;   // rounds: a search that cannot meet its targets ends when so many have brought nothing
constexpr double nothing = 0.02;      // relative change of the expected misfit
constexpr double test_share = 0.3;    // a test is worth a run where the doubt it removes is this share of a tolerance

std::vector<std::size_t> numbers_below(std::size_t count) {
    std::vector<std::size_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), std::size_t{0});
    return numbers;
}

// Runs that cannot be saved.
struct LeastRuns {
    int tests = 0;  // of a point
    int confirmation = 0;
    int first_look = 0;      // at the strengths: three points, and as many runs again for the search
    int elastic_points = 0;  // one short test each
    int all() const { return confirmation + first_look + elastic_points; }
};

LeastRuns least_runs(const Calibration& calibration) {
    std::set<std::pair<MethodId, double>> tests;
    for (const Observable& q : observables_for(calibration)) tests.insert({q.test, q.sigma3_Pa});
    const auto elastic = static_cast<std::size_t>(
        std::count_if(calibration.unknowns.begin(), calibration.unknowns.end(), [](const Unknown& u) { return u.elastic; }));
    LeastRuns least;
    least.tests = static_cast<int>(tests.size());
    least.confirmation = static_cast<int>(tests.size() * calibration.confirm_seeds.size());
    if (elastic < calibration.unknowns.size()) least.first_look = 6 * least.tests;
    if (elastic > 0) least.elastic_points = static_cast<int>(2 + first_points_per_unknown * elastic);
    return least;
}

class Calibrate {
public:
    Calibrate(const Calibration& calibration, Laboratory& laboratory, const std::function<void(const std::string&)>& note)
        : calibration_(calibration),
          laboratory_(laboratory),
          note_(note),
          quantities_(observables_for(calibration)),
          least_(least_runs(calibration)) {
        for (std::size_t u = 0; u < calibration.unknowns.size(); ++u)
            (calibration.unknowns[u].elastic ? elastic_ : strength_).push_back(u);
        best_.assign(calibration.unknowns.size(), 0.5);
    }

    CalibrationResult operator()() {
        CalibrationResult result;
        try {
            if (!elastic_.empty()) find_elastic();
            if (!strength_.empty()) find_strength();
            result = confirm();
            result.complete = true;
        } catch (const Interrupted&) {
            result.complete = false;
        }
        result.runs = laboratory_.used();
        result.failed = failed_;
        result.grade_C = grade_C_;
        result.way = way_;
        return result;
    }

private:
    void note(const std::string& text) const {
        if (note_) note_(text);
    }

    std::vector<double> values_at(const std::vector<double>& x) const {
        std::vector<double> values;
        for (std::size_t u = 0; u < x.size(); ++u) values.push_back(calibration_.unknowns[u].value_at(x[u]));
        return values;
    }

    // All unknowns: those of the part as given, the others as found so far.
    std::vector<double> whole(const std::vector<std::size_t>& part, const std::vector<double>& x) const {
        std::vector<double> all = best_;
        for (std::size_t i = 0; i < part.size(); ++i) all[part[i]] = x[i];
        return all;
    }

    std::vector<double> best_of(const std::vector<std::size_t>& part) const {
        std::vector<double> x;
        for (const std::size_t u : part) x.push_back(best_[u]);
        return x;
    }

    std::uint64_t next_seed() { return calibration_.seeds[turn_++ % calibration_.seeds.size()]; }

    int runs_left() const { return calibration_.budget - laboratory_.used(); }

    int confirmation_runs() const { return least_.confirmation; }

    // ---- elastic constants, by tests that end before the first damage

    void find_elastic() {
        std::vector<Target> targets;
        for (const Target& t : calibration_.targets)
            if (t.name == "E" || t.name == "nu") targets.push_back(t);
        std::vector<Observable> quantities;
        for (const Observable& q : quantities_)
            if (q.name == "E" || q.name == "nu") quantities.push_back(q);
        elastic_learner_.emplace(quantities, targets);
        note(fmt::format("elastic constants: {} unknowns, short tests", elastic_.size()));
        see_elastic(evenly(elastic_.size(), static_cast<std::size_t>(least_.elastic_points)));
        for (std::size_t round = 0; round < most_elastic_rounds; ++round) {
            learn(*elastic_learner_);
            const std::vector<double> x = best_point(*elastic_learner_, elastic_.size());
            put_best(elastic_, x);
            if (well_predicted(*elastic_learner_, x)) break;
            constexpr int more = 3;
            if (runs_left() - more < confirmation_runs() + least_.first_look) break;  // the strengths need what is left
            see_elastic(promising_points(*elastic_learner_, elastic_.size(), more, round));
        }
        learn(*elastic_learner_);
        put_best(elastic_, best_point(*elastic_learner_, elastic_.size()));
        tell(*elastic_learner_, elastic_);
    }

    void see_elastic(const std::vector<std::vector<double>>& points) {
        std::vector<Request> requests;
        const std::vector<std::size_t> all = numbers_below(elastic_learner_->quantities().size());
        for (const auto& x : points) requests.push_back({values_at(whole(elastic_, x)), next_seed(), all, true});
        see(requests, points, *elastic_learner_);
    }

    // E and nu at half of the strength are not those before damage: aims the elastic constants so that the former meet the
    // targets.
    void correct_elastic() {
        if (!elastic_learner_ || !strength_learner_) return;
        const std::vector<double> x_elastic = best_of(elastic_);
        const std::vector<Belief> before = elastic_learner_->beliefs(x_elastic);
        const std::vector<Belief> at_half = strength_learner_->beliefs(best_point(*strength_learner_, strength_.size()));
        std::vector<Target> aims = elastic_learner_->targets();
        for (Target& aim : aims)
            for (std::size_t q = 0; q < quantities_.size(); ++q)
                if (quantities_[q].name == aim.name) {
                    const double now = before[index_of(elastic_learner_->quantities(), aim.name)].mean;
                    if (quantities_[q].logarithmic)
                        aim.value *= now / at_half[q].mean;
                    else
                        aim.value += now - at_half[q].mean;
                }
        aimed_ = elastic_learner_;
        aimed_->aim_at(aims);
        // near by: what E and nu lose until half of the strength depends on the constants too
        const std::vector<double> x = best_point(*aimed_, elastic_.size(), x_elastic);
        const std::vector<Belief> after = aimed_->beliefs(x);
        for (std::size_t q = 0; q < quantities_.size(); ++q) {
            const std::size_t e = index_of(elastic_learner_->quantities(), quantities_[q].name);
            if (e == elastic_learner_->quantities().size()) continue;
            strength_learner_->correct(
                q, quantities_[q].logarithmic ? after[e].mean / before[e].mean : after[e].mean - before[e].mean);
        }
        put_best(elastic_, x);
        note(fmt::format("elastic constants, for E and nu at half of the strength: {}", set_text(elastic_)));
    }

    static std::size_t index_of(const std::vector<Observable>& quantities, const std::string& name) {
        std::size_t q = 0;
        while (q < quantities.size() && quantities[q].name != name) ++q;
        return q;
    }

    // ---- strengths

    void find_strength() {
        strength_learner_.emplace(quantities_, calibration_.targets);
        Learner& learner = *strength_learner_;
        const auto tests = static_cast<std::size_t>(least_.tests);  // check_budget: at least three points are affordable
        const int for_learning = runs_left() - confirmation_runs();
        const std::size_t affordable = static_cast<std::size_t>(std::max(0, for_learning / 2)) / tests;
        const std::size_t first = std::min(affordable, first_points_per_unknown * strength_.size() + 2);
        note(fmt::format("strengths: {} unknowns, {} points spread over their ranges, {} tests each", strength_.size(), first,
                         tests));
        look_first(evenly(strength_.size(), first));
        learn(learner);
        correct_elastic();

        std::vector<double> misfits;  // of the best, by rounds
        for (std::size_t round = 0;; ++round) {
            learn(learner);
            std::vector<double> x = best_point(learner, strength_.size());
            if (elastic_alone_is_unlikely(learner, x)) {  // what cracks take off E has changed since the constants were aimed
                correct_elastic();
                learn(learner);
                x = best_point(learner, strength_.size());
            }
            put_best(strength_, x);
            tell(learner, strength_);
            const int affordable_runs = runs_left() - confirmation_runs();
            if (will_be_confirmed(learner, x)) {
                note(fmt::format(
                    "the confirming means will lie within their tolerances, each with {:.0f} % at least: the search ends",
                    100.0 * sure));
                break;
            }
            if (affordable_runs <= 0) break;
            misfits.push_back(learner.at(x).misfit);
            if (no_surer(learner, x) && stalled(misfits)) {
                note(
                    fmt::format("{} rounds have brought no better set, and more runs on these seeds would not make it surer: the "
                                "search ends with {} runs left",
                                patience, affordable_runs));
                break;
            }
            std::vector<std::vector<double>> next = promising_points(learner, strength_.size(), points_per_round - 1, round);
            next.push_back(x);  // what would be the answer
            std::vector<std::vector<std::size_t>> wanted;
            int runs = 0;
            for (const auto& point : next) {
                wanted.push_back(worth_seeing(learner, point));
                runs += run_count(wanted.back());
            }
            while (runs > affordable_runs && !next.empty()) {
                runs -= run_count(wanted.back());
                next.pop_back();
                wanted.pop_back();
            }
            if (next.empty()) break;
            see_strength(next, wanted);
            if (round % 5 == 4) {
                learn(learner);
                correct_elastic();
            }
        }
    }

    // Tests under confinement cost most, and teach little of a rock whose uniaxial strength is far from what is wanted: they wait
    // for it.
    void look_first(const std::vector<std::vector<double>>& points) {
        std::vector<std::size_t> confined, others;
        for (std::size_t q = 0; q < quantities_.size(); ++q) (quantities_[q].sigma3_Pa > 0.0 ? confined : others).push_back(q);
        std::vector<Request> requests;
        for (const auto& point : points) requests.push_back({values_at(whole(strength_, point)), next_seed(), others});
        const auto readings = see(requests, points, *strength_learner_);

        const std::size_t UCS = index_of(quantities_, "UCS");
        const auto place = static_cast<std::size_t>(std::find(others.begin(), others.end(), UCS) - others.begin());
        const double wanted = wanted_UCS_Pa(calibration_.targets);
        std::vector<std::pair<double, std::size_t>> by_distance;  // of the uniaxial strength, as a logarithm
        for (std::size_t p = 0; p < points.size(); ++p) {
            const double distance = place < others.size() ? std::abs(std::log(readings[p][place].value / wanted)) : 0.0;
            by_distance.emplace_back(std::isnan(distance) ? 0.0 : distance, p);
        }
        std::stable_sort(by_distance.begin(), by_distance.end());
        std::vector<Request> near;
        std::vector<std::vector<double>> near_points;
        for (std::size_t i = 0; i < by_distance.size(); ++i) {
            const auto [distance, p] = by_distance[i];
            if (distance > std::log(far_from_wanted) && 2 * i >= points.size()) break;
            near.push_back({requests[p].values, requests[p].seed, confined});
            near_points.push_back(points[p]);
        }
        if (!confined.empty()) see(near, near_points, *strength_learner_);
    }

    int run_count(const std::vector<std::size_t>& wanted) const {
        std::set<std::pair<MethodId, double>> tests;
        for (const std::size_t q : wanted) tests.insert({quantities_[q].test, quantities_[q].sigma3_Pa});
        return static_cast<int>(tests.size());
    }

    // Quantities whose doubt matters at this point, and those that come with the same tests; at least the most doubtful one.
    std::vector<std::size_t> worth_seeing(const Learner& learner, const std::vector<double>& x) const {
        const std::vector<double> doubts = learner.doubts(x);
        const double largest = *std::max_element(doubts.begin(), doubts.end());
        std::set<std::pair<MethodId, double>> tests;
        for (std::size_t q = 0; q < quantities_.size(); ++q)
            if (doubts[q] >= std::min(test_share, largest)) tests.insert({quantities_[q].test, quantities_[q].sigma3_Pa});
        std::vector<std::size_t> wanted;
        for (std::size_t q = 0; q < quantities_.size(); ++q)
            if (tests.contains({quantities_[q].test, quantities_[q].sigma3_Pa})) wanted.push_back(q);
        return wanted;
    }

    void see_strength(const std::vector<std::vector<double>>& points, const std::vector<std::vector<std::size_t>>& wanted) {
        std::vector<Request> requests;
        for (std::size_t p = 0; p < points.size(); ++p)
            requests.push_back({values_at(whole(strength_, points[p])), next_seed(), wanted[p]});
        see(requests, points, *strength_learner_);
    }

    // ---- both

    std::vector<std::vector<RunReading>> see(const std::vector<Request>& requests, const std::vector<std::vector<double>>& points,
                                             Learner& learner) {
        auto readings = laboratory_.see(requests, learner.quantities());
        for (std::size_t r = 0; r < requests.size(); ++r) {
            std::set<std::pair<MethodId, double>> tests;
            for (std::size_t i = 0; i < requests[r].quantities.size(); ++i) {
                const Observable& quantity = learner.quantities()[requests[r].quantities[i]];
                learner.observe(requests[r].quantities[i], points[r], requests[r].seed, readings[r][i]);
                if (!tests.insert({quantity.test, quantity.sigma3_Pa}).second) continue;
                failed_ += readings[r][i].grade == 'x';
                grade_C_ += readings[r][i].grade == 'C';
            }
        }
        return readings;
    }

    void learn(Learner& learner) const {
        if (learner.learn()) return;
        std::vector<std::string> names;
        for (const std::size_t q : learner.unseen()) names.push_back(learner.quantities()[q].name);
        throw NumericalError(
            fmt::format("calibration: no test shows {}: {} tests failed, {} have grade C, the others ended before; their runs "
                        "say why. A finer numerics.accuracy mends "
                        "grade C, narrower ranges mend the others",
                        fmt::join(names, ", "), failed_, grade_C_));
    }

    void put_best(const std::vector<std::size_t>& part, const std::vector<double>& x) {
        for (std::size_t i = 0; i < part.size(); ++i) best_[part[i]] = x[i];
    }

    std::size_t confirming() const { return calibration_.confirm_seeds.size(); }

    // The mean over the confirming packings will lie within the tolerance, for every target.
    bool will_be_confirmed(const Learner& learner, const std::vector<double>& x) const {
        const auto foreseen = learner.foresee(x, confirming());
        return std::all_of(foreseen.begin(), foreseen.end(), [](const Foresight& f) { return f.probability >= sure; });
    }

    // Only E or nu are not sure, and the strength's unknowns do not move them.
    bool elastic_alone_is_unlikely(const Learner& learner, const std::vector<double>& x) const {
        if (!elastic_learner_) return false;
        const auto foreseen = learner.foresee(x, confirming());
        bool any = false;
        for (std::size_t t = 0; t < foreseen.size(); ++t) {
            if (foreseen[t].probability >= sure) continue;
            if (learner.targets()[t].name != "E" && learner.targets()[t].name != "nu") return false;
            any = true;
        }
        return any;
    }

    // Every target is predicted well within its tolerance, and that is well known.
    static bool well_predicted(const Learner& learner, const std::vector<double>& x) {
        return within(learner, x, good_share) && no_surer(learner, x, good_share);
    }

    static bool within(const Learner& learner, const std::vector<double>& x, double share) {
        const Prediction prediction = learner.at(x);
        for (std::size_t t = 0; t < learner.targets().size(); ++t)
            if (!(std::abs(prediction.values[t] - learner.targets()[t].value) <= share * learner.targets()[t].tolerance))
                return false;
        return true;
    }

    // No more runs on these packings would make the prediction much surer: doubt is small, or what so many packings leave.
    static bool no_surer(const Learner& learner, const std::vector<double>& x) {
        return no_surer(learner, x, within(learner, x, 1.0) ? little_share : good_share);
    }
    static bool no_surer(const Learner& learner, const std::vector<double>& x, double share) {
        const std::vector<double> doubts = learner.doubts(x), lasting = learner.lasting_doubts(x);
        for (std::size_t q = 0; q < doubts.size(); ++q)
            if (doubts[q] > std::max(share, 1.3 * lasting[q])) return false;
        return true;
    }

    static bool stalled(const std::vector<double>& misfits) {
        if (misfits.size() <= patience) return false;
        const auto [least, most] = std::minmax_element(misfits.end() - patience - 1, misfits.end());
        return *most <= (1.0 + nothing) * *least;
    }

    std::string set_text(const std::vector<std::size_t>& part) const {
        std::vector<std::string> words;
        for (const std::size_t u : part) {
            const Unknown& unknown = calibration_.unknowns[u];
            words.push_back(unknown.name + " = " + unknown_text(unknown, unknown.value_at(best_[u])));
        }
        return fmt::format("{}", fmt::join(words, ", "));
    }

    // Says where it stands, and keeps that.
    void tell(const Learner& learner, const std::vector<std::size_t>& part) {
        const std::vector<double> x = best_of(part);
        const Prediction prediction = learner.at(x);
        double worst = 0.0, doubt = 0.0;
        std::string which, doubtful;
        for (std::size_t t = 0; t < learner.targets().size(); ++t) {
            const double off = std::abs(prediction.values[t] - learner.targets()[t].value) / learner.targets()[t].tolerance;
            const double doubt_here = prediction.deviations[t] / learner.targets()[t].tolerance;
            if (doubt_here >= doubt) {
                doubt = doubt_here;
                doubtful = learner.targets()[t].label();
            }
            if (off < worst) continue;
            worst = off;
            which = learner.targets()[t].label();
        }
        double least = 1.0;
        std::string unlikely;
        const auto foreseen = learner.foresee(x, confirming());
        for (std::size_t t = 0; t < foreseen.size(); ++t) {
            if (!unlikely.empty() && foreseen[t].probability >= least) continue;
            least = foreseen[t].probability;
            unlikely = learner.targets()[t].label();
        }
        way_.push_back(
            {laboratory_.used(), &part == &elastic_, worst, which, doubt, doubtful, least, unlikely, values_at(best_)});
        note(
            fmt::format("{} runs; best so far {}; farthest from its target: {}, {:.2g} times its tolerance; least likely to be "
                        "confirmed: {}, {:.0f} %",
                        laboratory_.used(), set_text(part), which, worst, unlikely, 100.0 * least));
    }

    CalibrationResult confirm() {
        note(fmt::format("confirming on {} fresh packings: {}", calibration_.confirm_seeds.size(),
                         set_text(numbers_below(calibration_.unknowns.size()))));
        const std::vector<std::size_t> all = numbers_below(quantities_.size());
        std::vector<Request> requests;
        for (const std::uint64_t seed : calibration_.confirm_seeds)
            requests.push_back({values_at(best_), seed, all, false, true});
        const auto by_packing = laboratory_.see(requests, quantities_);
        std::vector<std::vector<double>> seen(quantities_.size());
        for (const auto& readings : by_packing)  // a bound confirms nothing
            for (std::size_t q = 0; q < quantities_.size(); ++q)
                seen[q].push_back(readings[q].is_value() ? readings[q].value : std::nan(""));

        CalibrationResult result;
        const Learner* learner = strength_learner_ ? &*strength_learner_ : &*elastic_learner_;
        const std::vector<std::size_t>& part = strength_learner_ ? strength_ : elastic_;
        const std::vector<double> x = best_of(part);
        const Prediction prediction = learner->at(x);
        const auto foreseen = learner->foresee(x, confirming());
        for (std::size_t t = 0; t < learner->targets().size(); ++t) {
            TargetOutcome outcome;
            outcome.foreseen = foreseen[t];
            outcome.target = learner->targets()[t];
            outcome.predicted = prediction.values[t];
            outcome.deviation = prediction.deviations[t];
            outcome.confirmed = confirmed_interval(outcome.target, quantities_, seen);
            outcome.grades = grades_of(outcome.target, by_packing);
            outcome.met =
                enough_confirmed(outcome) && std::abs(outcome.confirmed.mean - outcome.target.value) <= outcome.target.tolerance;
            result.targets.push_back(outcome);
        }
        for (std::size_t u = 0; u < calibration_.unknowns.size(); ++u) {
            UnknownOutcome outcome;
            outcome.unknown = calibration_.unknowns[u];
            outcome.best = outcome.unknown.value_at(best_[u]);
            outcome.at_an_end = best_[u] < 0.01 || best_[u] > 0.99;
            result.unknowns.push_back(outcome);
        }
        result.sensitivity.assign(result.targets.size(), std::vector<double>(calibration_.unknowns.size(), std::nan("")));
        result.findings = contradictions(calibration_.targets);  // run all the same
        if (elastic_learner_) look_into(aimed_ ? *aimed_ : *elastic_learner_, calibration_, elastic_, best_, result);
        if (strength_learner_) look_into(*strength_learner_, calibration_, strength_, best_, result);
        result.runs = laboratory_.used();
        say_what_is_missed(calibration_, result);
        result.job = calibration_.job_with(values_at(best_));
        for (const std::string& warning : warnings(result.job)) result.findings.push_back(warning + ".");
        return result;
    }

    // Of the tests that the target needs, each once.
    TestGrades grades_of(const Target& target, const std::vector<std::vector<RunReading>>& by_packing) const {
        TestGrades grades;
        for (const auto& readings : by_packing) {
            std::set<std::pair<MethodId, double>> tests;
            for (std::size_t q = 0; q < quantities_.size(); ++q) {
                if (!needs(target, quantities_, q) || !tests.insert({quantities_[q].test, quantities_[q].sigma3_Pa}).second)
                    continue;
                const RunReading& reading = readings[q];
                const bool failed = reading.grade == 'x' || (reading.grade == '-' && !std::isfinite(reading.value));
                if (failed)
                    ++grades.failed;
                else if (reading.grade == 'C')
                    ++grades.C;
                else {
                    ++(reading.grade == 'B' ? grades.B : grades.A);
                    grades.unfinished += !reading.is_value();
                }
            }
        }
        return grades;
    }

    const Calibration& calibration_;
    Laboratory& laboratory_;
    const std::function<void(const std::string&)>& note_;
    std::vector<Observable> quantities_;
    LeastRuns least_;
    std::vector<std::size_t> elastic_, strength_;  // unknowns
    std::vector<double> best_;                     // of all unknowns, 0 ... 1
    std::optional<Learner> elastic_learner_, strength_learner_;
    std::optional<Learner> aimed_;  // the elastic one, aimed at what E and nu are to be before damage
    std::vector<WayPoint> way_;
    std::size_t turn_ = 0;          // of the packings
    int failed_ = 0, grade_C_ = 0;  // tests to learn from
};

}  // namespace

void check_budget(const Calibration& calibration) {
    const LeastRuns least = least_runs(calibration);
    if (calibration.budget >= least.all()) return;
    std::string parts = fmt::format("{} confirm the answer", least.confirmation);
    if (least.elastic_points > 0) parts += fmt::format(", the elastic constants take {}", least.elastic_points);
    if (least.first_look > 0) parts += fmt::format(", a first look at the strengths takes {}", least.first_look);
    throw InputError({calibration.file.string(), 0, 0, "budget"},
                     fmt::format("{} runs are too few: {}", calibration.budget, parts),
                     fmt::format("at least {} runs, or fewer confirm_seeds", least.all()));
}

CalibrationResult calibrate(const Calibration& calibration, Laboratory& laboratory,
                            const std::function<void(const std::string&)>& note) {
    check_budget(calibration);
    return Calibrate(calibration, laboratory, note)();
}

}  // namespace feldspar
