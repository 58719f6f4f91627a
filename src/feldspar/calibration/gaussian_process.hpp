// A smooth function of a few parameters, learned from runs on random packings: Gaussian process regression with a straight-line
// trend, an effect of each packing, which may change with the parameters, and noise.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <vector>

namespace feldspar {

/// What was seen at one set of parameters on one packing.
struct Observation {
    std::vector<double> x;   ///< parameters, each from 0 to 1
    std::uint64_t seed = 0;  ///< of the packing
    double y = 0.0;
    double variance = 0.0;  ///< of y, beyond the noise that all have: of this observation alone
};

/// What is believed of the mean over all packings.
struct Belief {
    double mean = 0.0;
    double variance = 0.0;  ///< of that mean, by what was not seen
};

/// y = trend(x) + f(x) + a(packing) + g(packing, x) + noise; f and g by a Matern kernel of order 5/2 with a length for each
/// parameter. Scales, lengths and variances are the most probable ones (marginal likelihood and weak priors), those of packings
/// their mean. The same packings at all parameters make differences between parameters sure before their level is: that is what a
/// is for. A packing that is strong for one set of parameters need not be strong for another; near by it is: that is what g is
/// for. So the same packing seen again near by teaches little, and the mean over packings stays as unsure as so few packings are.
class GaussianProcess {
public:
    /// @param observations  at least one
    /// @param before        learned from fewer of them: where the search for the scales begins; may be null
    explicit GaussianProcess(std::vector<Observation> observations, const GaussianProcess* before = nullptr);

    /// Of the mean over packings at x.
    Belief at(const std::vector<double>& x) const;

    double packing_variance() const {
        return variance_of_packings_;
    }  ///< of y, from one packing to another at the same x: of a and g together
    double noise_variance() const { return variance_of_noise_; }            ///< of y, beyond parameters and packing
    const std::vector<double>& lengths() const { return scales_.lengths; }  ///< over which f changes, in units of x
    std::size_t count() const { return observations_.size(); }

    /// Adds what is believed at x as if it had been seen: for the choice of several points at once.
    void believe(const std::vector<double>& x);

private:
    struct Scales {              // of the standardised observations
        double amplitude = 0.5;  // of f
        std::vector<double> lengths;
        double packings = 0.1;  // of a
        double changes = 0.1;   // of g
        double noise = 0.1;
    };
    Eigen::MatrixXd covariance(const Scales& scales) const;
    double kernel(const Scales& scales, const std::vector<double>& a, const std::vector<double>& b, bool same_packing) const;
    double minus_log_posterior(const Scales& scales) const;
    Scales scales_from(const std::vector<double>& logarithms) const;
    void fit(const GaussianProcess* before);
    double mean_scale(std::size_t which) const;  // of packings (1) or changes (2)
    void solve();

    std::vector<Observation> observations_;
    double centre_ = 0.0, unit_ = 1.0;  // y = centre + unit * standardised
    std::vector<double> logarithms_;    // of the scales
    Scales scales_;
    double variance_of_packings_ = 0.0, variance_of_noise_ = 0.0;
    Eigen::LLT<Eigen::MatrixXd> factor_;
    Eigen::VectorXd weights_;
};

}  // namespace feldspar
