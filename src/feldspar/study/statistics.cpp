#include "feldspar/study/statistics.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace feldspar {

double student_quantile(double degrees_of_freedom) {
    return boost::math::quantile(boost::math::students_t(degrees_of_freedom), 0.975);
}

MeanInterval mean_interval(std::span<const double> values) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const int count = static_cast<int>(values.size());
    MeanInterval result{count, nan, nan, nan, nan};
    if (count == 0) return result;
    double sum = 0.0;
    for (const double value : values) sum += value;
    result.mean = sum / count;
    if (count == 1) return result;
    double squares = 0.0;
    for (const double value : values) squares += (value - result.mean) * (value - result.mean);
    result.standard_deviation = std::sqrt(squares / (count - 1));
    const double half = student_quantile(count - 1) * result.standard_deviation / std::sqrt(static_cast<double>(count));
    result.low = result.mean - half;
    result.high = result.mean + half;
    return result;
}

PairedValues paired(const PropertyStatistics& first, const PropertyStatistics& second) {
    PairedValues pairs;
    for (std::size_t i = 0; i < first.seeds.size(); ++i)
        for (std::size_t j = 0; j < second.seeds.size(); ++j)
            if (first.seeds[i] == second.seeds[j]) {
                pairs.seeds.push_back(first.seeds[i]);
                pairs.first.push_back(first.values[i]);
                pairs.second.push_back(second.values[j]);
            }
    return pairs;
}

}  // namespace feldspar
