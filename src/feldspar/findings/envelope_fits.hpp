// Strength envelopes through the tests of several packings: fits, what the packings say of their constants, and how well a line
// or a parabola goes through the strengths (docs/theory/properties.md, sections 5 and 7).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "feldspar/lab/properties.hpp"
#include "feldspar/study/statistics.hpp"

namespace feldspar {

/// How far strengths lie from a curve.
struct Goodness {
    double rms_Pa = 0.0;  ///< root mean square of sigma_1 - curve (P20); not-a-number where the points just determine the curve
    double R2 = 0.0;      ///< (P20)
};

/// Both curves through one set of strengths.
struct CurvePair {
    EnvelopeFit fit;
    double N = 0.0;                        ///< slope of the Mohr-Coulomb line
    double mohr_coulomb_tension_Pa = 0.0;  ///< where the line meets sigma_1 = 0, a positive magnitude (P19)
    double hoek_brown_tension_Pa = 0.0;    ///< where the parabola does (P19)
    Goodness mohr_coulomb, hoek_brown;

    double mohr_coulomb_at(double sigma3_Pa) const;  ///< sigma_1 of the line
    double hoek_brown_at(double sigma3_Pa) const;    ///< sigma_1 of the parabola; not-a-number left of its end
};

/// One strength of one packing: sigma_1 over sigma_3.
struct StrengthPoint {
    std::uint64_t seed = 0;
    double sigma3_Pa = 0.0;
    double sigma1_Pa = 0.0;
};

/// Fits both curves (P12), (P13) to all points, whatever their packings; Hoek-Brown's takes the points (-DTS, 0) in as well
/// (P18). The seed of the fit is that of the first point.
CurvePair fit_curves(std::span<const StrengthPoint> points, const std::vector<double>& DTS_Pa = {});

/// The strengths of all packings at one confining stress.
struct StrengthAt {
    double sigma3_Pa = 0.0;
    MeanInterval sigma1_Pa;
};

/// A constant of the curves: what the packings say, and the joint fit's value.
struct EnvelopeConstant {
    std::string property;   ///< as in PropertySummary: "cohesion_Pa", "friction_angle_deg", "mohr_coulomb_N", ...
    MeanInterval packings;  ///< of the fits of each packing
    double joint = 0.0;     ///< of the fit to all points together
};

/// A tensile strength that another test has measured.
struct TensileStrength {
    std::string property;   ///< "DTS_Pa", "BTS_Pa"
    MeanInterval measured;  ///< Pa
};

/// Whether a curve goes through the mean strengths.
struct CurveJudgement {
    double misfit_Pa = 0.0;  ///< root mean square distance of the mean strengths from the joint curve
    int through = 0;         ///< mean strengths whose 95 % interval holds the curve
    int judged = 0;          ///< mean strengths that have an interval
};

/// Everything that a series of tests says of the envelope.
struct EnvelopeFits {
    std::vector<StrengthPoint>
        points;  ///< by packing, then sigma_3: uniaxial (sigma_3 = 0) and biaxial tests whose peak was reached
    std::vector<StrengthAt> strengths;  ///< by growing sigma_3
    std::vector<CurvePair> packings;    ///< of each packing with two different sigma_3
    CurvePair joint;                    ///< of all points together
    std::vector<EnvelopeConstant> constants;
    MeanInterval UCS_measured;             ///< Pa, over the packings that have a uniaxial test
    std::vector<TensileStrength> tension;  ///< what was measured of DTS and BTS
    CurveJudgement mohr_coulomb, hoek_brown;
    double scatter_Pa = 0.0;  ///< standard deviation of the packings about their mean, pooled over sigma_3
    bool with_tension = false;
    std::string method;   ///< which tests, which sigma_3, how fitted: sentences
    std::string verdict;  ///< line or parabola? sentences
};

/// @param with_tension  Hoek-Brown's parabola also goes through (-DTS, 0) of each packing
EnvelopeFits fit_series(std::span<const TestResult> results, bool with_tension);

}  // namespace feldspar
