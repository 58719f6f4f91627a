// How a property changes from one point of a study to another, and how much of that the scatter of the packings allows to say.
#pragma once

#include <span>
#include <vector>

#include "feldspar/lab/properties.hpp"

namespace feldspar {

/// A relative change: 0.02 is 2 % more than at the base. Without two packings everything but count and mean is not-a-number.
struct Change {
    bool by_packing = false;  ///< formed on each packing (P24), else between the means of different packings (P25)
    int count = 0;            ///< packings that both have, else those of the smaller sample
    double mean = 0.0;
    double low = 0.0, high = 0.0;  ///< 95 % interval of the mean
    double deviation = 0.0;  ///< standard deviation: of the change on one packing; else of one packing at either point, relative
    double chance = 1.0;     ///< two-sided p-value: how often scatter alone shows a change as large

    /// The largest change, up or down, that the interval does not rule out.
    double bound() const;
};

/// The change on the packings that both points have.
Change change_by_packing(const PropertyStatistics& base, const PropertyStatistics& other);

/// The change between points whose packings have nothing in common but their seeds: Welch's interval.
Change change_between_means(const PropertyStatistics& base, const PropertyStatistics& other);

/// Packings that narrow the 95 % interval of such a change to +- `half_width`; at least 2, and 100000 if more are needed.
int packings_for_change(const Change& change, double half_width);

/// Packings after which the 95 % interval of a mean is +- `half_width`, if one packing scatters by `deviation` (same unit).
int packings_for_mean(double deviation, double half_width);

/// Which of the changes stand when all of them are looked at together: Holm's procedure at 5 %. A chance that is not a number
/// stands for no statement.
std::vector<bool> stand_together(std::span<const double> chances);

/// What a mean over so many of the packings would have told.
struct Subsample {
    int count = 0;            ///< packings
    double half_width = 0.0;  ///< 95 % interval of the mean, root mean square over the subsets, relative to the mean of all
    double lowest = 0.0, highest = 0.0;  ///< of the subsets' means, relative to the mean of all: 0.98, 1.03
};

/// For 2, 3, ... packings: over all subsets of this size; over 2000 of them, evenly spread, where there are more.
std::vector<Subsample> subsamples(std::span<const double> values);

}  // namespace feldspar
