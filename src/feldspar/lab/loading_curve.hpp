// A history made ready for reading properties: one sign, one origin, the rows up to the peak (docs/theory/properties.md).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// Where a history has its strength (P1), (P2).
struct Peak {
    std::size_t row = 0;     ///< into TestResult::history
    double stress_Pa = 0.0;  ///< magnitude, total axial stress
    bool reached = false;    ///< the stress fell to 0.95 of it or below afterwards; Brazilian: the disc was split
};

/// The strength of a history; for a Brazilian test the largest stress until the disc is split. Empty without a single loaded row.
std::optional<Peak> find_peak(const TestResult& result);

/// The largest stress before the first fall to 0.95 of it (P27): of a Brazilian test often a grain that settles under a plate.
std::optional<Peak> first_dip(const TestResult& result);

/// Whether the row is of a stage that loads; every row of a test without stages is. What falls in other stages has not failed.
bool of_loading_stage(const TestResult& result, const HistoryRow& row);

/// The crack with the earliest step, the first of these in the record; null without cracks.
const Crack* first_crack(const TestResult& result);

/// Largest stress of all rows of the loading, a positive magnitude; 0 without one.
double largest_stress(const TestResult& result);

/// One moment of loading, measured from the unloaded (biaxial: consolidated) state; all values positive in the sense of
/// the loading, so that tension and compression read alike.
struct CurvePoint {
    double stress_Pa = 0.0;      ///< axial stress; biaxial: the deviator sigma_1 - sigma_3
    double strain = 0.0;         ///< axial, from the platens
    double strain_gauge = 0.0;   ///< axial, from the gauge
    double lateral_gauge = 0.0;  ///< lateral, from the gauge: < 0 while a compressed specimen widens
    std::size_t row = 0;         ///< into TestResult::history
};

/// The pre-peak curve; of a test with stages that part of each loading which goes beyond all before it, so that loops are left
/// out.
struct LoadingCurve {
    std::vector<CurvePoint> points;  ///< from the origin to the peak, both included; empty when there is nothing to read
    double stress_offset_Pa = 0.0;   ///< what to add for the total axial stress (biaxial: sigma_3)

    double peak_Pa() const { return points.back().stress_Pa; }
};

/// @param peak  from find_peak() of the same result
LoadingCurve loading_curve(const TestResult& result, const Peak& peak);

/// The point where the curve first reaches `stress_Pa`, interpolated; empty if it never does.
std::optional<CurvePoint> at_stress(const LoadingCurve& curve, double stress_Pa);

/// The part of the curve between two stresses: the rows inside and both ends interpolated. Empty if it does not reach them.
std::vector<CurvePoint> window(const LoadingCurve& curve, double low_Pa, double high_Pa);

}  // namespace feldspar
