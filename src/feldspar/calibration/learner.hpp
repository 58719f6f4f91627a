// What has been learned so far of every quantity, and what that says of the targets at any parameters.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "feldspar/calibration/calibration.hpp"
#include "feldspar/calibration/gaussian_process.hpp"

namespace feldspar {

/// What a value says of the quantity.
enum class Says {
    value,     ///< it is that, up to scatter and the test's own error
    at_least,  ///< the test ended before the strength was known
    at_most,   ///< the test went too fast to be quasi-static, and what goes too fast shows too much
};

/// What a test says of a quantity.
struct RunReading {
    double value = std::numeric_limits<double>::quiet_NaN();  ///< not-a-number where the test says nothing
    Says says = Says::value;
    double error = 0.0;  ///< standard deviation of what the test's own error adds, relative to the value
    char grade = '-';    ///< of the test: 'A', 'B', 'C'; '-' where none was given, 'x' if it failed

    bool is_value() const { return says == Says::value && value == value; }
};

/// Means over packings at some parameters, and how far to trust them.
struct Prediction {
    std::vector<double> values;      ///< of each target, in its unit
    std::vector<double> deviations;  ///< standard deviation of what is believed, the same unit
    std::vector<std::vector<double>>
        slopes;           ///< by quantity and target: what one standard deviation of the quantity adds to the target
    double misfit = 0.0;  ///< expected sum over targets of ((value - target) / tolerance)^2: of the predicted values, and of the
                          ///< doubt about them
};

/// What the mean of a target over some fresh packings will show, by what was learned.
struct Foresight {
    double value = 0.0;            ///< most likely, in the target's unit
    double doubt = 0.0;            ///< standard deviation of the prediction: how well the mean over all packings is known
    double scatter = 0.0;          ///< of the mean of so many packings about that
    double grade = 0.0;            ///< of that mean by the estimated errors of the tests
    double deviation = 0.0;        ///< of all three together
    double low = 0.0, high = 0.0;  ///< 95 % interval
    double probability = 0.0;      ///< that it lies within the tolerance
};

/// One surrogate for each quantity; targets follow from them.
class Learner {
public:
    Learner(std::vector<Observable> quantities, std::vector<Target> targets)
        : quantities_(std::move(quantities)),
          targets_(std::move(targets)),
          seen_(quantities_.size()),
          processes_(quantities_.size()) {}

    const std::vector<Observable>& quantities() const { return quantities_; }
    const std::vector<Target>& targets() const { return targets_; }

    /// A quantity seen on one packing. What is not a positive number of a logarithmic quantity teaches nothing, nor a nu that no
    /// solid has.
    void observe(std::size_t quantity, const std::vector<double>& x, std::uint64_t seed, const RunReading& reading);

    /// Multiplies (or, of a quantity that is not logarithmic, adds to) all that was seen of a quantity: when what it follows from
    /// besides x has changed.
    void correct(std::size_t quantity, double by);

    /// Other values of the same targets.
    void aim_at(std::vector<Target> targets) { targets_ = std::move(targets); }

    /// Learns from everything seen so far. @return false if some quantity was never seen: see unseen()
    bool learn();

    /// Quantities of which nothing was seen but upper bounds, or nothing at all.
    std::vector<std::size_t> unseen() const;

    /// What the means of the targets over so many packings that were not seen yet will be, at x.
    std::vector<Foresight> foresee(const std::vector<double>& x, std::size_t packings) const;

    Prediction at(const std::vector<double>& x) const;

    /// How well the belief in each quantity is, at x: mean and standard deviation of its value (arithmetic mean over packings).
    std::vector<Belief> beliefs(const std::vector<double>& x) const;

    /// The targets by given means of the quantities.
    std::vector<double> targets_by(const std::vector<double>& means) const;
    double misfit(const std::vector<double>& values) const;

    /// For each quantity: the largest share of a target's tolerance that the doubt about it makes, at x.
    std::vector<double> doubts(const std::vector<double>& x) const;

    /// The part of doubts() that stays however often these packings are used: the scatter of so many packings.
    std::vector<double> lasting_doubts(const std::vector<double>& x) const;

    /// From now on as if x had been seen, in the tests of these quantities.
    void believe(const std::vector<double>& x);

    const GaussianProcess& process(std::size_t quantity) const { return *processes_[quantity]; }
    std::size_t packings(std::size_t quantity) const;

private:
    struct Seen {
        Observation observation;
        Says says = Says::value;
    };
    std::vector<Observation> completed(std::size_t quantity) const;
    std::vector<double> shares(const std::vector<double>& x, const std::vector<double>& deviations) const;

    std::vector<Observable> quantities_;
    std::vector<Target> targets_;
    std::vector<std::vector<Seen>> seen_;  // by quantity
    std::vector<std::optional<GaussianProcess>> processes_;
};

}  // namespace feldspar
