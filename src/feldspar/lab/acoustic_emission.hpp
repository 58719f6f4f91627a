// Acoustic emission: cracks gathered into events, with energy, magnitude, moment and statistics (docs/theory/properties.md,
// section on acoustic emission).
#pragma once

#include <vector>

#include "feldspar/base/vec2.hpp"
#include "feldspar/methods/acoustic_event.hpp"
#include "feldspar/methods/result.hpp"

namespace feldspar {

/// The fewest events of which a b-value is told.
inline constexpr int fewest_events = 50;
/// Radius of an event over the mean grain diameter.
inline constexpr double usual_event_radius = 5.0;
/// Radii for which the count of events is told, rising.
inline constexpr double counted_event_radii[] = {2.0, 3.0, usual_event_radius};

/// Gathers all cracks of a test, without the fractal dimension of the events. @param radius_grains  radius of an event, in mean
/// grain diameters
AcousticEmission events_of_cracks(const TestResult& result, double radius_grains);

/// The same with it. @param radius_grains  radius of an event, in mean grain diameters
AcousticEmission gather_events(const TestResult& result, double radius_grains);

/// The acoustic emission of a test: events at the usual radius, and counts at others. What files, summary and report tell is
/// TestResult::emission, gathered by this once.
AcousticEmission acoustic_emission(const TestResult& result);

/// Maximum likelihood for magnitudes from `completeness` on. @param bin  width in which they are given; 0: continuous
/// (Tinti and Mulargia 1987, and Aki 1965; error by Shi and Bolt 1982)
BValue b_value(std::vector<double> magnitudes, double completeness, double bin = 0.0);

/// The magnitude at the peak of the histogram (bins of 0.1) plus 0.2. Not a number without magnitudes.
double magnitude_of_completeness(const std::vector<double>& magnitudes);

/// Slope of the logarithm of the correlation integral between 5 and 30 % of its largest distance (P70); of more than 2000 places
/// evenly chosen ones decide.
double correlation_dimension(const std::vector<Vec2>& places);

}  // namespace feldspar
