// From the values of the packings to a decision: what the interval of a mean says of a limit, which of many findings hold
// together, when a difference is none, and how many packings a decision would take. docs/claims.md has the rules in words.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "feldspar/study/statistics.hpp"

namespace feldspar {

/// What is said of a mean: that it lies above or below a limit, or inside or outside of -limit ... limit.
struct MeanLimit {
    enum class Kind { above, below, inside, outside } kind = Kind::above;
    double limit = 0.0;
};

/// What an interval says of a target.
enum class Decision { yes, no, open };

/// Yes, if the whole 95 % interval lies where the target says, no, if all of it lies on the other side, else open.
Decision decide(const MeanInterval& interval, const MeanLimit& target);

/// The probability to see a mean so far on the other side of the target though the true one is not there: Student's distribution,
/// one side. decide() says no where it is below 0.025. @return 1 without a standard deviation
double chance_of_no(const MeanInterval& interval, const MeanLimit& target);

/// Which of several findings hold together: Holm's procedure. With the probability 1 - `level` none of those that hold is due to
/// chance, however many there are.
/// @param chances  of each finding by itself
std::vector<bool> hold_together(std::span<const double> chances, double level);

/// Whether the true mean lies inside -size ... size: two one-sided tests, each at 5 %.
bool is_nothing(const MeanInterval& interval, double size);

/// The largest number of packings that packings_to_decide() looks at.
constexpr int most_packings = 1000;

/// How many packings would decide a target (or find that the mean is nothing, inside -size ... size) with a probability of 80 %,
/// if mean and scatter stay as they are.
/// @param size  below which the mean is nothing; not-a-number: it never is
/// @return empty if it takes more than most_packings, or if there is no scatter to go by
std::optional<int> packings_to_decide(const MeanInterval& interval, const MeanLimit& target, double size);

}  // namespace feldspar
