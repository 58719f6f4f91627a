// What several packings say together: means with the interval in which the true mean lies with a confidence of 95 %.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "feldspar/lab/properties.hpp"

namespace feldspar {

/// How many standard errors an interval of 95 % reaches to each side. @param degrees_of_freedom  above 0
double student_quantile(double degrees_of_freedom);

/// The mean of a sample and its 95 % interval by Student's distribution. Without two values the interval is not-a-number.
struct MeanInterval {
    int count = 0;
    double mean = 0.0;
    double standard_deviation = 0.0;  ///< of one value, n - 1
    double low = 0.0, high = 0.0;     ///< 95 % interval of the mean

    double half_width() const { return 0.5 * (high - low); }
};

/// Of no values everything but the count is not-a-number.
MeanInterval mean_interval(std::span<const double> values);

/// The values of two properties on the packings that both have, by seed.
struct PairedValues {
    std::vector<std::uint64_t> seeds;
    std::vector<double> first, second;
};

PairedValues paired(const PropertyStatistics& first, const PropertyStatistics& second);

}  // namespace feldspar
