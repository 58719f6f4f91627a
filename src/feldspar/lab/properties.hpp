// From records to laboratory numbers: the properties of one test, and those of a set of tests on several packings.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// A stop_fraction that is enough where a strength is wanted and not the branch behind it: the peak counts as reached at 0.95
/// (P2).
inline constexpr double enough_fall = 0.94;

/// Reads E, nu, strengths, sigma_ci and sigma_cd from the history and the cracks of one test (definitions: docs/theory).
/// Values that the test does not define, or that the record does not reach, are not-a-number.
TestProperties measure(const TestResult& result);

/// Evidence from half the peak to the peak, the grade and the sentence that a user reads.
QuasiStaticEvidence judge(const TestResult& result);

/// Estimated error of a strength (L8) with which a test still has grade B.
inline constexpr double grade_b_error = 0.02;

/// What the true error of a strength exceeds in one test of ten, from its estimated error (L8); 0 or more, relative. On 64
/// strengths of eight rocks twice the estimate covered 59 errors (docs/validation, true strengths).
inline double error_bound(double error_estimate) { return 2.0 * error_estimate; }

/// Median and range over packings.
struct PropertyStatistics {
    double median = 0.0;  ///< SI (angles in degrees)
    double minimum = 0.0;
    double maximum = 0.0;
    std::vector<std::uint64_t> seeds;
    std::vector<double> values;  ///< of each of the seeds
};

/// One straight-line or Hoek-Brown fit on one packing.
struct EnvelopeFit {
    std::uint64_t seed = 0;
    double cohesion_Pa = 0.0;  ///< Mohr-Coulomb
    double friction_angle_deg = 0.0;
    double UCS_fitted_Pa = 0.0;      ///< intercept of the Mohr-Coulomb line
    double hoek_brown_mi = 0.0;      ///< not-a-number with fewer than two sigma_3
    double hoek_brown_UCS_Pa = 0.0;  ///< its sigma_ci
    double UCS_measured_Pa = 0.0;    ///< not-a-number if the packing has no uniaxial test
    std::vector<double> sigma3_Pa;   ///< the tests that are in
    std::vector<double> sigma1_Pa;
};

/// The strengths of a packing along a plane, and the straight lines through them.
struct ShearFit {
    std::uint64_t seed = 0;
    std::vector<double> normal_Pa, peak_Pa,
        residual_Pa;  ///< of each test: at the peak; residual not-a-number where a test did not go so far
    double cohesion_Pa = 0.0, friction_angle_deg = 0.0;  ///< of the peaks
    double residual_cohesion_Pa = 0.0,
           residual_friction_angle_deg = 0.0;  ///< of the residual strengths; not-a-number with fewer than two
};

/// Properties of the rock: a name (as in summary.json: "E_Pa", "nu", "UCS_Pa", "DTS_Pa", "BTS_Pa", "cohesion_Pa",
/// "friction_angle_deg", "hoek_brown_mi", ...) to its statistics.
struct PropertySummary {
    std::map<std::string, PropertyStatistics> values;
    std::vector<EnvelopeFit> fits;
    std::vector<ShearFit> shear_fits;
    std::string envelope_method;  ///< one sentence: which tests, which sigma_3 range, how fitted; empty without a fit
};

PropertySummary summarise(std::span<const TestResult> results);

}  // namespace feldspar
