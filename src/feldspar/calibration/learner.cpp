#include "feldspar/calibration/learner.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <set>

namespace feldspar {
namespace {

constexpr double largest_nu = 0.5;
constexpr double least_weight = 1e-3;  // of a bound, for which a value seen would have 1: below it teaches nothing
constexpr double most_standing = 8.0;  // standard deviations by which a bound may be off: farther, only its own value counts

double squared(double x) { return x * x; }

// A bound on y as a value seen, with a variance of its own (one step of expectation propagation): where everything else says that
// y keeps to the bound it weighs nothing, where that is doubted as much as is known, and where the rest contradicts it stands for
// its own value.
// @param sign  +1: y is at least the bound, -1: at most; @param scatter  variance of one value seen
// @return whether it says anything
bool as_seen(Observation& bound, double sign, const Belief& rest, double scatter) {
    const double spread = std::sqrt(rest.variance + scatter);
    if (!(spread > 0.0)) return sign * (bound.y - rest.mean) > 0.0;
    const double z = sign * (rest.mean - bound.y) / spread;
    if (z < -most_standing) return true;  // as it stands
    const boost::math::normal normal;
    const double steepness = boost::math::pdf(normal, z) / boost::math::cdf(normal, z);
    const double weight = steepness * (z + steepness);
    if (!(weight > least_weight)) return false;
    bound.y = rest.mean + sign * spread / (z + steepness);
    bound.variance += (rest.variance + scatter) * (1.0 - weight) / weight;
    return true;
}

}  // namespace

void Learner::observe(std::size_t quantity, const std::vector<double>& x, std::uint64_t seed, const RunReading& reading) {
    const bool logarithmic = quantities_[quantity].logarithmic;
    const double value = reading.value;
    if (!std::isfinite(value) || (logarithmic && value <= 0.0)) return;
    if (quantities_[quantity].name == "nu" && (value <= 0.0 || value >= largest_nu))
        return;  // of a specimen that is broken at half of its strength
    const double own = std::isfinite(reading.error) ? reading.error : 0.0;
    seen_[quantity].push_back(
        {{x, seed, logarithmic ? std::log(value) : value, squared(logarithmic ? own : own * value)}, reading.says});
}

void Learner::correct(std::size_t quantity, double by) {
    for (Seen& seen : seen_[quantity]) seen.observation.y += quantities_[quantity].logarithmic ? std::log(by) : by;
}

bool Learner::learn() {
    if (!unseen().empty()) return false;
    for (std::size_t q = 0; q < quantities_.size(); ++q)
        processes_[q] = GaussianProcess(completed(q), processes_[q] ? &*processes_[q] : nullptr);
    return true;
}

std::vector<std::size_t> Learner::unseen() const {
    std::vector<std::size_t> all;
    for (std::size_t q = 0; q < quantities_.size(); ++q)
        if (std::all_of(seen_[q].begin(), seen_[q].end(), [](const Seen& seen) { return seen.says == Says::at_most; }))
            all.push_back(q);
    return all;
}

// What was seen, and of the bounds what they add to that.
std::vector<Observation> Learner::completed(std::size_t quantity) const {
    std::vector<Observation> all;
    std::vector<Seen> bounds;
    for (const Seen& seen : seen_[quantity]) {
        if (seen.says == Says::value)
            all.push_back(seen.observation);
        else
            bounds.push_back(seen);
    }
    if (bounds.empty()) return all;
    if (all.empty()) {  // nothing is known but that it is no less
        for (const Seen& bound : bounds)
            if (bound.says == Says::at_least) all.push_back(bound.observation);
        return all;
    }
    const GaussianProcess rest(all, processes_[quantity] ? &*processes_[quantity] : nullptr);
    for (Seen& bound : bounds) {
        const double scatter = rest.packing_variance() + rest.noise_variance() + bound.observation.variance;
        if (as_seen(bound.observation, bound.says == Says::at_least ? 1.0 : -1.0, rest.at(bound.observation.x), scatter))
            all.push_back(std::move(bound.observation));
    }
    return all;
}

std::vector<Belief> Learner::beliefs(const std::vector<double>& x) const {
    std::vector<Belief> all;
    for (std::size_t q = 0; q < quantities_.size(); ++q) {
        Belief belief = processes_[q]->at(x);
        if (quantities_[q].logarithmic) {  // of y = ln value, whose scatter lifts the arithmetic mean
            const double scatter = processes_[q]->packing_variance() + processes_[q]->noise_variance();
            const double mean = std::exp(belief.mean + 0.5 * scatter);
            belief = {mean, mean * mean * belief.variance};
        }
        all.push_back(belief);
    }
    return all;
}

std::vector<double> Learner::targets_by(const std::vector<double>& means) const {
    std::vector<double> values;
    for (const Target& target : targets_) values.push_back(value_of(target, quantities_, means));
    return values;
}

double Learner::misfit(const std::vector<double>& values) const {
    double sum = 0.0;
    for (std::size_t t = 0; t < targets_.size(); ++t) {
        const double z = (values[t] - targets_[t].value) / targets_[t].tolerance;
        sum += z * z;
    }
    return std::isfinite(sum) ? sum : std::numeric_limits<double>::max();
}

namespace {

std::vector<double> means_of(const std::vector<Belief>& beliefs) {
    std::vector<double> means;
    for (const Belief& belief : beliefs) means.push_back(belief.mean);
    return means;
}

}  // namespace

Prediction Learner::at(const std::vector<double>& x) const {
    const std::vector<Belief> believed = beliefs(x);
    const std::vector<double> means = means_of(believed);
    Prediction prediction;
    prediction.values = targets_by(means);
    prediction.misfit = misfit(prediction.values);
    std::vector<double> variances(targets_.size(), 0.0);
    for (std::size_t q = 0; q < quantities_.size(); ++q) {  // by the slopes of the targets over the quantities
        std::vector<double> moved = means;
        const double deviation = std::sqrt(believed[q].variance);
        moved[q] += deviation;
        std::vector<double>& slopes = prediction.slopes.emplace_back(targets_by(moved));
        for (std::size_t t = 0; t < targets_.size(); ++t) {
            slopes[t] -= prediction.values[t];
            variances[t] += slopes[t] * slopes[t];
        }
    }
    for (std::size_t t = 0; t < targets_.size(); ++t) {
        prediction.deviations.push_back(std::sqrt(variances[t]));
        prediction.misfit += variances[t] / (targets_[t].tolerance * targets_[t].tolerance);
    }
    return prediction;
}

std::vector<Foresight> Learner::foresee(const std::vector<double>& x, std::size_t packings) const {
    const std::vector<Belief> believed = beliefs(x);
    const std::vector<double> means = means_of(believed), values = targets_by(means);
    const auto n = static_cast<double>(std::max<std::size_t>(1, packings));
    std::vector<Foresight> all(targets_.size());
    for (std::size_t q = 0; q < quantities_.size(); ++q) {
        const double unit = quantities_[q].logarithmic ? means[q] : 1.0;
        double own = 0.0;  // mean variance that tests have by their own errors
        std::size_t count = 0;
        for (const Seen& seen : seen_[q])
            if (seen.says == Says::value) own += (seen.observation.variance - own) / static_cast<double>(++count);
        const double doubt = std::sqrt(believed[q].variance);
        const double scatter = unit * std::sqrt((processes_[q]->packing_variance() + processes_[q]->noise_variance()) / n);
        const double grade = unit * std::sqrt(own / n);
        std::vector<double> moved = means;
        const double together = std::sqrt(squared(doubt) + squared(scatter) + squared(grade));
        moved[q] += together;
        const std::vector<double> changed = targets_by(moved);
        for (std::size_t t = 0; t < targets_.size(); ++t) {
            const double variance = squared(changed[t] - values[t]);
            if (!(variance > 0.0)) continue;
            all[t].doubt += variance * squared(doubt / together);  // variances until all are summed
            all[t].scatter += variance * squared(scatter / together);
            all[t].grade += variance * squared(grade / together);
        }
    }
    for (std::size_t t = 0; t < targets_.size(); ++t) {
        Foresight& f = all[t];
        f.value = values[t];
        const double variance = f.doubt + f.scatter + f.grade;
        f.deviation = std::sqrt(variance);
        f.doubt = std::sqrt(f.doubt);
        f.scatter = std::sqrt(f.scatter);
        f.grade = std::sqrt(f.grade);
        const double off = f.value - targets_[t].value, tolerance = targets_[t].tolerance;
        if (!std::isfinite(off) || !std::isfinite(variance)) {
            f.low = f.high = std::numeric_limits<double>::quiet_NaN();
            continue;
        }
        const boost::math::normal normal;
        const double half = boost::math::quantile(normal, 0.975) * f.deviation;
        f.low = f.value - half;
        f.high = f.value + half;
        if (f.deviation > 0.0)
            f.probability = boost::math::cdf(normal, (tolerance - off) / f.deviation) -
                            boost::math::cdf(normal, (-tolerance - off) / f.deviation);
        else
            f.probability = std::abs(off) <= tolerance ? 1.0 : 0.0;
    }
    return all;
}

std::vector<double> Learner::shares(const std::vector<double>& x, const std::vector<double>& deviations) const {
    const std::vector<double> means = means_of(beliefs(x)), values = targets_by(means);
    std::vector<double> shares;
    for (std::size_t q = 0; q < quantities_.size(); ++q) {
        std::vector<double> moved = means;
        moved[q] += deviations[q];
        const std::vector<double> changed = targets_by(moved);
        double largest = 0.0;
        for (std::size_t t = 0; t < targets_.size(); ++t)
            largest = std::max(largest, std::abs(changed[t] - values[t]) / targets_[t].tolerance);
        shares.push_back(largest);
    }
    return shares;
}

std::vector<double> Learner::doubts(const std::vector<double>& x) const {
    std::vector<double> deviations;
    for (const Belief& belief : beliefs(x)) deviations.push_back(std::sqrt(belief.variance));
    return shares(x, deviations);
}

std::size_t Learner::packings(std::size_t quantity) const {
    std::set<std::uint64_t> seeds;
    for (const Seen& seen : seen_[quantity]) seeds.insert(seen.observation.seed);
    return seeds.size();
}

std::vector<double> Learner::lasting_doubts(const std::vector<double>& x) const {
    std::vector<double> deviations;
    const std::vector<Belief> believed = beliefs(x);
    for (std::size_t q = 0; q < quantities_.size(); ++q) {
        const double deviation =
            std::sqrt(processes_[q]->packing_variance() / static_cast<double>(std::max<std::size_t>(1, packings(q))));
        deviations.push_back(quantities_[q].logarithmic ? believed[q].mean * deviation : deviation);
    }
    return shares(x, deviations);
}

void Learner::believe(const std::vector<double>& x) {
    for (auto& process : processes_) process->believe(x);
}

}  // namespace feldspar
