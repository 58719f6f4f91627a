#include "feldspar/calibration/insight.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "feldspar/base/mean.hpp"
#include "feldspar/calibration/search.hpp"

namespace feldspar {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t everywhere = 4096;  // sets that are looked at
constexpr double enough_sets = 40.0;      // that must count for a range to mean something
constexpr double evenly_spread = 0.2887;  // standard deviation of a parameter that may be anything: 1 / sqrt(12)
constexpr double not_determined = 0.5;    // of that: beyond it the data do not say much of a combination
constexpr double takes_part = 0.35;       // of a direction: an unknown with less has no say in it
constexpr double nearly_all = 0.75;       // of an unknown lies in such directions: it is open by itself

// What is believed of the targets at one set, in tolerances. The doubt is about measured quantities: targets that hang on the
// same ones go together.
struct Standing {
    std::vector<double> values;  // of the targets, in their units
    Eigen::VectorXd off;         // from what is wanted; not finite where a target does not exist
    Eigen::MatrixXd doubt;       // by target and quantity: what one standard deviation adds

    // The tolerance as two standard deviations, since nearly all good sets lie within it, and the doubt.
    Eigen::MatrixXd allowed() const {
        return doubt * doubt.transpose() + 0.25 * Eigen::MatrixXd::Identity(off.size(), off.size());
    }

    bool exists() const { return off.allFinite() && doubt.allFinite(); }

    // Of some of the targets alone.
    Standing of(const std::vector<std::size_t>& some) const { return {{}, off(some), doubt(some, Eigen::all)}; }

    // How unlikely it is that these targets are all met: -2 times the logarithm, but for a constant.
    double badness() const {
        if (!exists()) return 1e300;
        const Eigen::LLT<Eigen::MatrixXd> root(allowed());
        return off.dot(root.solve(off)) + 2.0 * root.matrixLLT().diagonal().array().log().sum();
    }

    // How far the farthest of these targets is off if the doubt is taken in their favour, by one standard deviation.
    double least_off() const {
        if (!exists()) return 1e9;
        Eigen::VectorXd favour = -doubt.transpose() * allowed().llt().solve(off);
        if (favour.norm() > 1.0) favour.normalize();
        return (off + doubt * favour).cwiseAbs().maxCoeff();
    }
};

Standing standing_at(const Learner& learner, const std::vector<double>& x) {
    const Prediction prediction = learner.at(x);
    Standing standing{prediction.values, Eigen::VectorXd(learner.targets().size()),
                      Eigen::MatrixXd(learner.targets().size(), learner.quantities().size())};
    for (std::size_t t = 0; t < learner.targets().size(); ++t) {
        const auto row = static_cast<Eigen::Index>(t);
        const Target& target = learner.targets()[t];
        standing.off[row] = (prediction.values[t] - target.value) / target.tolerance;
        for (std::size_t q = 0; q < learner.quantities().size(); ++q)
            standing.doubt(row, static_cast<Eigen::Index>(q)) = prediction.slopes[q][t] / target.tolerance;
    }
    return standing;
}

// Sets of the unknowns with the weight of what is believed of them: how likely all targets are met.
struct WeighedSets {
    std::vector<std::vector<double>> x;
    std::vector<Standing> standings;
    std::vector<double> weights;  // sum 1
};

// exp(-badness / 2) times the volume that each set stands for, of sum 1.
std::vector<double> weights_of(const std::vector<double>& badness, const std::vector<double>& volumes, double seriousness) {
    const double least = *std::min_element(badness.begin(), badness.end());
    std::vector<double> weights;
    for (std::size_t i = 0; i < badness.size(); ++i)
        weights.push_back(volumes[i] * std::exp(-0.5 * seriousness * (badness[i] - least)));
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& weight : weights) weight /= sum;
    return weights;
}

// Of how many sets of equal weight the same could be said.
double counting(const std::vector<double>& weights) {
    double squares = 0.0;
    for (const double weight : weights) squares += weight * weight;
    return 1.0 / squares;
}

WeighedSets weigh(const Learner& learner, const std::vector<double>& best) {
    WeighedSets sets;
    sets.x = evenly(best.size(), everywhere, 1);
    const std::size_t wide = sets.x.size();
    // the same again nearer to the best, so that a small region of good sets is not missed; each stands for the volume that it
    // fills
    std::vector<double> volumes(wide, 1.0);
    double half = 0.5;
    for (int zoom = 0; zoom < 3; ++zoom) {
        half *= 0.5;
        for (const std::vector<double>& even :
             evenly(best.size(), everywhere / 4, 1 + everywhere * static_cast<std::size_t>(zoom + 2))) {
            std::vector<double> x(best.size());
            bool inside = true;
            for (std::size_t i = 0; i < x.size(); ++i) {
                x[i] = best[i] + half * (2.0 * even[i] - 1.0);
                inside = inside && x[i] >= 0.0 && x[i] <= 1.0;
            }
            if (!inside) continue;
            sets.x.push_back(x);
            volumes.push_back(4.0 * std::pow(2.0 * half, static_cast<double>(best.size())));
        }
    }
    std::vector<double> badness;
    for (const std::vector<double>& x : sets.x) badness.push_back(sets.standings.emplace_back(standing_at(learner, x)).badness());
    // where no set is good, a handful that is a little less bad than the others would have all the weight: misfits are taken less
    // seriously then
    double seriousness = 1.0;
    do {
        sets.weights = weights_of(badness, volumes, seriousness);
        seriousness *= 0.7;
    } while (counting(sets.weights) < enough_sets && seriousness > 1e-3);
    return sets;
}

double quantile(const WeighedSets& sets, std::size_t i, double share) {
    std::vector<std::pair<double, double>> ordered;
    for (std::size_t s = 0; s < sets.x.size(); ++s) ordered.emplace_back(sets.x[s][i], sets.weights[s]);
    std::sort(ordered.begin(), ordered.end());
    double sum = 0.0;
    for (const auto& [x, weight] : ordered)
        if ((sum += weight) >= share) return x;
    return ordered.back().first;
}

std::string change(const Unknown& unknown, double dx) {
    if (unknown.logarithmic) {
        const double factor = std::pow(unknown.high / unknown.low, dx);
        return fmt::format("{} x {:.2g}", unknown.name, factor);
    }
    return fmt::format("{} {:+.2g}", unknown.name, (unknown.high - unknown.low) * dx);
}

// Directions in which the good sets spread nearly as far as the ranges do. Where none is good there are none to speak of, only
// numbers.
void find_inseparable(const WeighedSets& sets, const Calibration& calibration, const std::vector<std::size_t>& part,
                      bool any_good, CalibrationResult& result) {
    const auto n = static_cast<Eigen::Index>(part.size());
    Eigen::VectorXd centre = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t s = 0; s < sets.x.size(); ++s)
        centre += sets.weights[s] * Eigen::Map<const Eigen::VectorXd>(sets.x[s].data(), n);
    for (std::size_t s = 0; s < sets.x.size(); ++s) {
        const Eigen::VectorXd off = Eigen::Map<const Eigen::VectorXd>(sets.x[s].data(), n) - centre;
        spread += sets.weights[s] * off * off.transpose();
    }
    for (Eigen::Index i = 0; i < n; ++i)
        result.unknowns[part[static_cast<std::size_t>(i)]].determined =
            std::clamp(1.0 - std::sqrt(spread(i, i)) / evenly_spread, 0.0, 1.0);
    if (!any_good) return;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(spread);
    std::vector<Eigen::Index> open;  // directions
    Eigen::VectorXd share = Eigen::VectorXd::Zero(n);
    for (Eigen::Index k = n; k-- > 0 && std::sqrt(std::max(0.0, solver.eigenvalues()[k])) >= not_determined * evenly_spread;) {
        open.push_back(k);
        share += solver.eigenvectors().col(k).cwiseAbs2();
    }
    const auto unknown_at = [&](Eigen::Index i) -> const Unknown& {
        return calibration.unknowns[part[static_cast<std::size_t>(i)]];
    };
    std::vector<std::string> free;
    for (Eigen::Index i = 0; i < n; ++i)
        if (share[i] > nearly_all) free.push_back(unknown_at(i).name);
    if (!free.empty())
        result.findings.push_back(fmt::format(
            "The targets say little of {}: nearly every value in the range does, {}.", fmt::join(free, " and "),
            free.size() == static_cast<std::size_t>(n) ? "as long as the others follow" : "with others that go with it"));
    for (const Eigen::Index k : open) {
        const double deviation = std::sqrt(solver.eigenvalues()[k]);
        Eigen::VectorXd direction = solver.eigenvectors().col(k);
        Eigen::Index strongest = 0;
        direction.cwiseAbs().maxCoeff(&strongest);
        if (direction[strongest] < 0.0) direction = -direction;
        std::vector<std::string> names, changes;
        for (Eigen::Index i = 0; i < n; ++i) {
            if (std::abs(direction[i]) < takes_part || share[i] > nearly_all) continue;
            names.push_back(unknown_at(i).name);
            changes.push_back(change(unknown_at(i), deviation * direction[i]));
        }
        if (names.size() > 1)
            result.findings.push_back(
                fmt::format("The targets cannot tell {} apart: {} together change none of them by more than its tolerance.",
                            fmt::join(names, ", "), fmt::join(changes, ", ")));
    }
}

// How far each target can go while the others are met, and what cannot be had together. @return whether all can
bool find_conflicts(const WeighedSets& sets, const Learner& learner, CalibrationResult& result) {
    const auto& targets = learner.targets();
    const auto least_off = [&](const std::vector<std::size_t>& some) {
        double least = std::numeric_limits<double>::infinity();
        for (const Standing& standing : sets.standings) least = std::min(least, standing.of(some).least_off());
        return least;
    };
    const auto outcome_of = [&](std::size_t t) -> TargetOutcome* {
        for (TargetOutcome& outcome : result.targets)
            if (outcome.target.label() == targets[t].label()) return &outcome;
        return nullptr;
    };
    std::vector<std::size_t> all(targets.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    std::vector<bool> reachable(targets.size(), false);
    for (const std::size_t t : all) {
        std::vector<std::size_t> others = all;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(t));
        double lowest = nan, highest = nan;
        for (const Standing& standing : sets.standings) {
            if (!others.empty() && standing.of(others).least_off() > 1.0) continue;
            lowest = std::fmin(lowest, standing.values[t]);
            highest = std::fmax(highest, standing.values[t]);
        }
        reachable[t] = least_off({t}) <= 1.0;
        if (TargetOutcome* outcome = outcome_of(t)) {
            outcome->lowest = std::fmin(outcome->lowest, lowest);  // E and nu hang on the unknowns of both parts
            outcome->highest = std::fmax(outcome->highest, highest);
        }
        if (!reachable[t])
            result.findings.push_back(
                fmt::format("{} cannot be reached anywhere in the ranges, whatever the other targets.", targets[t].label()));
    }
    for (std::size_t t = 0; t < targets.size(); ++t)
        for (std::size_t o = 0; o < t; ++o) {
            if (!reachable[t] || !reachable[o]) continue;
            const double least = least_off({o, t});
            if (least > 1.0)
                result.findings.push_back(
                    fmt::format("{} and {} cannot be met together in these ranges: at best one of them is {:.2g} tolerances off.",
                                targets[o].label(), targets[t].label(), least));
        }
    const double least = least_off(all);
    if (least > 1.0)
        result.findings.push_back(
            fmt::format("No set in the ranges meets all targets together: at best the farthest of them is {:.2g} tolerances off, "
                        "doubt taken in its favour.",
                        least));
    return least <= 1.0;
}

}  // namespace

MeanInterval confirmed_interval(const Target& target, const std::vector<Observable>& quantities,
                                const std::vector<std::vector<double>>& seen) {
    const std::size_t packings = seen.front().size();
    const auto mean_without = [&](std::size_t q, std::size_t left_out) {
        std::vector<double> values;
        for (std::size_t p = 0; p < packings; ++p)
            if (p != left_out && std::isfinite(seen[q][p])) values.push_back(seen[q][p]);
        return values.empty() ? nan : mean_of(values);
    };
    const auto means_without = [&](std::size_t left_out) {
        std::vector<double> means;
        for (std::size_t q = 0; q < quantities.size(); ++q) means.push_back(mean_without(q, left_out));
        return means;
    };
    std::vector<std::size_t> needed;
    for (std::size_t q = 0; q < quantities.size(); ++q)
        if (needs(target, quantities, q)) needed.push_back(q);
    if (needed.size() == 1) {  // a plain mean
        std::vector<double> values;
        for (const double value : seen[needed.front()])
            if (std::isfinite(value)) values.push_back(value);
        return mean_interval(values);
    }
    std::size_t fewest = packings;  // values of one quantity
    std::vector<std::size_t> some;  // packings with a value of any
    for (const std::size_t q : needed)
        fewest = std::min<std::size_t>(
            fewest, static_cast<std::size_t>(
                        std::count_if(seen[q].begin(), seen[q].end(), [](double value) { return std::isfinite(value); })));
    for (std::size_t p = 0; p < packings; ++p)
        if (std::any_of(needed.begin(), needed.end(), [&](std::size_t q) { return std::isfinite(seen[q][p]); }))
            some.push_back(p);
    const double whole = value_of(target, quantities, means_without(packings));
    if (fewest == 0 || !std::isfinite(whole)) return mean_interval({});
    if (fewest == 1) return mean_interval(std::span(&whole, 1));
    std::vector<double> pseudo;  // n whole - (n - 1) without: of a plain mean the values themselves
    const auto n = static_cast<double>(some.size());
    for (const std::size_t p : some) pseudo.push_back(n * whole - (n - 1.0) * value_of(target, quantities, means_without(p)));
    MeanInterval interval = mean_interval(pseudo);
    const double half = student_quantile(static_cast<double>(fewest - 1)) * interval.standard_deviation / std::sqrt(n);
    interval.count = static_cast<int>(fewest);
    interval.mean = whole;
    interval.low = whole - half;
    interval.high = whole + half;
    return interval;
}

void look_into(const Learner& learner, const Calibration& calibration, const std::vector<std::size_t>& part,
               const std::vector<double>& best_of_all, CalibrationResult& result) {
    std::vector<double> best;
    for (const std::size_t u : part) best.push_back(best_of_all[u]);
    constexpr double step = 0.02;
    for (std::size_t i = 0; i < part.size(); ++i) {
        std::vector<double> up = best, down = best;
        up[i] = std::min(1.0, best[i] + step);
        down[i] = std::max(0.0, best[i] - step);
        const Unknown& unknown = calibration.unknowns[part[i]];
        const double relative = std::log(unknown.value_at(up[i]) / unknown.value_at(down[i]));
        const Prediction above = learner.at(up), below = learner.at(down);
        for (std::size_t t = 0; t < learner.targets().size(); ++t)
            for (std::size_t r = 0; r < result.targets.size(); ++r)
                if (result.targets[r].target.label() == learner.targets()[t].label() &&
                    (unknown.elastic || learner.targets()[t].name != "E"))
                    result.sensitivity[r][part[i]] = std::log(above.values[t] / below.values[t]) / relative;
    }
    const WeighedSets sets = weigh(learner, best);
    const bool any_good = find_conflicts(sets, learner, result);
    find_inseparable(sets, calibration, part, any_good, result);
    for (std::size_t i = 0; i < part.size(); ++i) {
        result.unknowns[part[i]].low = calibration.unknowns[part[i]].value_at(quantile(sets, i, 0.05));
        result.unknowns[part[i]].high = calibration.unknowns[part[i]].value_at(quantile(sets, i, 0.95));
        if (result.unknowns[part[i]].at_an_end)
            result.findings.push_back(
                fmt::format("{} lies at an end of its range: a wider one may serve better.", calibration.unknowns[part[i]].name));
    }
}

}  // namespace feldspar
