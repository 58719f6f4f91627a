// Results by formula: what a study would have found of a rock that follows a known law.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "feldspar/study/point_results.hpp"

namespace feldspar {

inline constexpr double in_MPa = 1e6;  // Pa

inline TestResult synthetic_test(MethodId kind, std::uint64_t seed, double strength_MPa, double sigma3_MPa = 0.0) {
    TestResult result;
    result.test.kind = kind;
    result.test.sigma3_Pa = sigma3_MPa * in_MPa;
    result.seed = seed;
    const double nan = std::nan("");
    result.properties = {nan, true, nan, nan, nan, nan, nan, nan, nan, nan, nan, nan, nan, nan, nan, nan, {}};
    result.properties.peak_stress_Pa = strength_MPa * in_MPa;
    result.evidence.grade = 'A';
    result.evidence.verdict = "quasi-static to about 0.5 %";
    return result;
}

/// A uniaxial test and biaxial tests at these sigma_3 (MPa) on each packing; `law` gives sigma_1 (MPa) of seed and sigma_3.
inline std::vector<TestResult> synthetic_series(const std::vector<std::uint64_t>& seeds, const std::vector<double>& sigma3_MPa,
                                                const std::function<double(std::uint64_t, double)>& law) {
    std::vector<TestResult> results;
    for (const std::uint64_t seed : seeds) {
        results.push_back(synthetic_test(methods::uniaxial_compression, seed, law(seed, 0.0)));
        for (const double sigma3 : sigma3_MPa)
            results.push_back(synthetic_test(methods::biaxial, seed, law(seed, sigma3), sigma3));
    }
    return results;
}

inline PropertyStatistics statistics_from(const std::vector<double>& values, std::uint64_t first_seed = 1) {
    PropertyStatistics statistics;
    for (const double value : values) {
        statistics.seeds.push_back(first_seed + statistics.seeds.size());
        statistics.values.push_back(value);
    }
    return statistics;
}

inline PointResults point_from(std::vector<AxisValue> values, std::vector<TestResult> results) {
    PointResults point;
    point.values = std::move(values);
    point.properties = summarise(results);
    point.results = std::move(results);
    return point;
}

}  // namespace feldspar
