#include "feldspar/calibration/gaussian_process.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlopt.hpp>

namespace feldspar {

namespace {

constexpr double level_scale = 10.0;  // of the trend's level: anything
constexpr double slope_scale =
    5.0;  // of its slopes: over the range of a parameter y may change by several of its standard deviations
constexpr double least_noise = 1e-3;

// Medians of the scales before anything is seen, and by which factor they may well be wrong.
constexpr double usual_amplitude = 0.5, usual_length = 1.0, usual_packings = 0.2, usual_changes = 0.1, usual_noise = 0.2;
constexpr double usual_spread = 1.0;  // of their logarithms

double matern(double distance) {
    const double r = std::sqrt(5.0) * distance;
    return (1.0 + r + r * r / 3.0) * std::exp(-r);
}

constexpr std::size_t common = 4;  // scales before the lengths

double squared(double x) { return x * x; }

}  // namespace

GaussianProcess::GaussianProcess(std::vector<Observation> observations, const GaussianProcess* before)
    : observations_(std::move(observations)) {
    double sum = 0.0;
    for (const Observation& o : observations_) sum += o.y;
    centre_ = sum / static_cast<double>(observations_.size());
    double squares = 0.0;
    for (const Observation& o : observations_) squares += squared(o.y - centre_);
    unit_ = std::sqrt(squares / static_cast<double>(observations_.size()));
    if (!(unit_ > 0.0)) unit_ = std::max(1e-3, std::abs(centre_));
    fit(before);
}

GaussianProcess::Scales GaussianProcess::scales_from(const std::vector<double>& logarithms) const {
    Scales scales;
    scales.amplitude = std::exp(logarithms[0]);
    scales.packings = std::exp(logarithms[1]);
    scales.changes = std::exp(logarithms[2]);
    scales.noise = std::exp(logarithms[3]) + least_noise;
    for (std::size_t i = common; i < logarithms.size(); ++i) scales.lengths.push_back(std::exp(logarithms[i]));
    return scales;
}

double GaussianProcess::kernel(const Scales& scales, const std::vector<double>& a, const std::vector<double>& b,
                               bool same_packing) const {
    double trend = squared(level_scale), distance = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        trend += squared(slope_scale) * (a[i] - 0.5) * (b[i] - 0.5);
        distance += squared((a[i] - b[i]) / scales.lengths[i]);
    }
    const double near = matern(std::sqrt(distance));
    const double mean = trend + squared(scales.amplitude) * near;
    return same_packing ? mean + squared(scales.packings) + squared(scales.changes) * near : mean;
}

Eigen::MatrixXd GaussianProcess::covariance(const Scales& scales) const {
    const auto n = static_cast<Eigen::Index>(observations_.size());
    Eigen::MatrixXd K(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j <= i; ++j) {
            const Observation &a = observations_[static_cast<std::size_t>(i)], &b = observations_[static_cast<std::size_t>(j)];
            const double own = i == j ? squared(scales.noise) + a.variance / squared(unit_) : 0.0;
            K(i, j) = K(j, i) = kernel(scales, a.x, b.x, a.seed == b.seed) + own;
        }
    return K;
}

double GaussianProcess::minus_log_posterior(const Scales& scales) const {
    const auto n = static_cast<Eigen::Index>(observations_.size());
    Eigen::VectorXd y(n);
    for (Eigen::Index i = 0; i < n; ++i) y[i] = (observations_[static_cast<std::size_t>(i)].y - centre_) / unit_;
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance(scales));
    if (factor.info() != Eigen::Success) return std::numeric_limits<double>::max();
    double value = 0.5 * y.dot(factor.solve(y)) + factor.matrixLLT().diagonal().array().log().sum();
    const auto prior = [](double scale, double usual) { return 0.5 * squared(std::log(scale / usual) / usual_spread); };
    value += prior(scales.amplitude, usual_amplitude) + prior(scales.packings, usual_packings) +
             prior(scales.changes, usual_changes) + prior(scales.noise, usual_noise);
    for (const double length : scales.lengths) value += prior(length, usual_length);
    return value;
}

void GaussianProcess::fit(const GaussianProcess* before) {
    const std::size_t parameters = observations_.front().x.size(), unknowns = common + parameters;
    const auto start = [&](double amplitude, double noise, double length) {
        std::vector<double> logarithms{std::log(amplitude), std::log(usual_packings), std::log(usual_changes), std::log(noise)};
        logarithms.resize(unknowns, std::log(length));
        return logarithms;
    };
    std::vector<std::vector<double>> starts{start(usual_amplitude, usual_noise, usual_length), start(1.0, 0.05, 0.5)};
    if (before != nullptr) starts = {before->logarithms_};
    double best = std::numeric_limits<double>::max();
    for (std::vector<double>& logarithms : starts) {
        nlopt::opt search(nlopt::LN_SBPLX, static_cast<unsigned>(unknowns));
        search.set_lower_bounds(std::log(1e-3));
        search.set_upper_bounds(std::log(20.0));
        search.set_xtol_abs(1e-2);  // of the logarithms: a percent of a scale changes no decision
        search.set_maxeval(150 * static_cast<int>(unknowns));
        search.set_min_objective(
            [](const std::vector<double>& x, std::vector<double>&, void* self) {
                const auto* process = static_cast<const GaussianProcess*>(self);
                return process->minus_log_posterior(process->scales_from(x));
            },
            this);
        double value = 0.0;
        try {
            search.optimize(logarithms, value);
        } catch (const nlopt::roundoff_limited&) {  // as good as it gets
            value = minus_log_posterior(scales_from(logarithms));
        }
        if (value >= best) continue;
        best = value;
        logarithms_ = logarithms;
    }
    if (logarithms_.empty()) logarithms_ = start(usual_amplitude, usual_noise, usual_length);
    scales_ = scales_from(logarithms_);
    scales_.packings = mean_scale(1);
    scales_.changes = mean_scale(2);
    variance_of_packings_ = squared(unit_) * (squared(scales_.packings) + squared(scales_.changes));
    variance_of_noise_ = squared(unit_ * scales_.noise);
    solve();
}

// Few packings leave the scatter between packings open: the most probable one is too small in the mean, and an interval by it too
// narrow. So its variance is averaged over what is possible, the other scales as they are.
double GaussianProcess::mean_scale(std::size_t which) const {
    constexpr int steps = 8;       // to either side
    constexpr double step = 0.25;  // of the logarithm
    const double most_probable = minus_log_posterior(scales_from(logarithms_));
    double weights = 0.0, variance = 0.0;
    for (int k = -steps; k <= steps; ++k) {
        std::vector<double> moved = logarithms_;
        moved[which] += k * step;
        const double weight = std::exp(most_probable - minus_log_posterior(scales_from(moved)));
        weights += weight;
        variance += weight * std::exp(2.0 * moved[which]);
    }
    return std::isfinite(variance) && weights > 0.0 ? std::sqrt(variance / weights) : std::exp(logarithms_[which]);
}

void GaussianProcess::solve() {
    const auto n = static_cast<Eigen::Index>(observations_.size());
    Eigen::VectorXd y(n);
    for (Eigen::Index i = 0; i < n; ++i) y[i] = (observations_[static_cast<std::size_t>(i)].y - centre_) / unit_;
    factor_.compute(covariance(scales_));
    weights_ = factor_.solve(y);
}

Belief GaussianProcess::at(const std::vector<double>& x) const {
    const auto n = static_cast<Eigen::Index>(observations_.size());
    Eigen::VectorXd k(n);
    for (Eigen::Index i = 0; i < n; ++i) k[i] = kernel(scales_, x, observations_[static_cast<std::size_t>(i)].x, false);
    const double mean = centre_ + unit_ * k.dot(weights_);
    factor_.matrixL().solveInPlace(k);
    const double variance = kernel(scales_, x, x, false) - k.squaredNorm();
    return {mean, squared(unit_) * std::max(0.0, variance)};
}

void GaussianProcess::believe(const std::vector<double>& x) {
    // on a packing that was not seen yet: what one run there would teach
    std::uint64_t seed = 0;
    for (const Observation& o : observations_) seed = std::max(seed, o.seed + 1);
    observations_.push_back({x, seed, at(x).mean});
    solve();
}

}  // namespace feldspar
