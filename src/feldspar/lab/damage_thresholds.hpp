// Crack initiation and crack damage stress of one test, each method under its own name (docs/theory/properties.md).
#pragma once

#include "feldspar/lab/loading_curve.hpp"

namespace feldspar {

/// Stresses at which cracking starts and becomes unstable: total axial stress, not-a-number where the curve shows none.
struct DamageThresholds {
    double crack_volume_Pa;    ///< sigma_ci: the crack volumetric strain turns (P9)
    double lateral_strain_Pa;  ///< sigma_ci: lateral strain response (P10)
    double reversal_Pa;        ///< sigma_cd: the volumetric strain turns (P8)
};

/// @param first_crack_Pa  total axial stress at the first crack; not-a-number without one
DamageThresholds damage_thresholds(const LoadingCurve& curve, double first_crack_Pa);

/// sigma_ci by crack count (P7), a magnitude; not-a-number without a crack up to the peak.
double crack_count_threshold(const TestResult& result, const Peak& peak);

}  // namespace feldspar
