#include "feldspar/calibration/learner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace feldspar {
namespace {

constexpr double largest_nu = 0.5;

}  // namespace

void Learner::observe(std::size_t quantity, const std::vector<double>& x, std::uint64_t seed, double value, bool at_least) {
    const bool logarithmic = quantities_[quantity].logarithmic;
    if (!std::isfinite(value) || (logarithmic && value <= 0.0)) return;
    if (quantities_[quantity].name == "nu" && (value <= 0.0 || value >= largest_nu)) return;   // of a specimen that is broken at half of its strength
    seen_[quantity].push_back({{x, seed, logarithmic ? std::log(value) : value}, at_least});
}

void Learner::correct(std::size_t quantity, double by) {
    for (Seen& seen : seen_[quantity]) seen.observation.y += quantities_[quantity].logarithmic ? std::log(by) : by;
}

bool Learner::learn() {
    for (std::size_t q = 0; q < quantities_.size(); ++q) {
        if (seen_[q].empty()) return false;
        processes_[q] = GaussianProcess(completed(q), processes_[q] ? &*processes_[q] : nullptr);
    }
    return true;
}

// What was seen, and in the place of what was seen to be no less than a bound what the rest says of it, unless that is below the bound.
std::vector<Observation> Learner::completed(std::size_t quantity) const {
    std::vector<Observation> all, bounds;
    for (const Seen& seen : seen_[quantity]) (seen.at_least ? bounds : all).push_back(seen.observation);
    if (bounds.empty()) return all;
    if (all.empty()) return bounds;
    const GaussianProcess rest(all, processes_[quantity] ? &*processes_[quantity] : nullptr);
    for (Observation& bound : bounds) {
        bound.y = std::max(bound.y, rest.at(bound.x).mean);
        all.push_back(std::move(bound));
    }
    return all;
}

std::vector<Belief> Learner::beliefs(const std::vector<double>& x) const {
    std::vector<Belief> all;
    for (std::size_t q = 0; q < quantities_.size(); ++q) {
        Belief belief = processes_[q]->at(x);
        if (quantities_[q].logarithmic) {   // of y = ln value, whose scatter lifts the arithmetic mean
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
    for (std::size_t q = 0; q < quantities_.size(); ++q) {   // by the slopes of the targets over the quantities
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

std::vector<double> Learner::shares(const std::vector<double>& x, const std::vector<double>& deviations) const {
    const std::vector<double> means = means_of(beliefs(x)), values = targets_by(means);
    std::vector<double> shares;
    for (std::size_t q = 0; q < quantities_.size(); ++q) {
        std::vector<double> moved = means;
        moved[q] += deviations[q];
        const std::vector<double> changed = targets_by(moved);
        double largest = 0.0;
        for (std::size_t t = 0; t < targets_.size(); ++t) largest = std::max(largest, std::abs(changed[t] - values[t]) / targets_[t].tolerance);
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
        const double deviation = std::sqrt(processes_[q]->packing_variance() / static_cast<double>(std::max<std::size_t>(1, packings(q))));
        deviations.push_back(quantities_[q].logarithmic ? believed[q].mean * deviation : deviation);
    }
    return shares(x, deviations);
}

void Learner::believe(const std::vector<double>& x) {
    for (auto& process : processes_) process->believe(x);
}

}  // namespace feldspar
