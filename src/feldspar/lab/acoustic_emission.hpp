// Acoustic emission: cracks gathered into events, with energy, magnitude, moment and statistics (docs/theory/properties.md, section on acoustic emission).
#pragma once

#include <limits>
#include <vector>

#include "feldspar/base/vec2.hpp"
#include "feldspar/methods/result.hpp"

namespace feldspar {

/// Cracks that are near to each other in place and time (P64).
struct AcousticEvent {
    long long first_step = 0, last_step = 0;
    double axial_strain = 0.0, axial_stress_Pa = 0.0;   ///< at the first crack
    Vec2 place{};               ///< m, undeformed: mean of its cracks
    int cracks = 0, shear_cracks = 0;
    double energy_J = 0.0;      ///< dissipated by its cracks until they broke
    double magnitude = std::numeric_limits<double>::quiet_NaN();   ///< of the energy (P65)
    Mat2 moment_Nm{};           ///< moment tensor of what opened and slid (P66), opening positive
    double moment_magnitude = std::numeric_limits<double>::quiet_NaN();   ///< (P67)
    double isotropy = std::numeric_limits<double>::quiet_NaN();           ///< R (P68), -100 ... 100: above 30 tensile, below -30 implosive, between shear
};

/// Slope of the magnitudes' distribution (P69).
struct BValue {
    double b = std::numeric_limits<double>::quiet_NaN();
    double error = std::numeric_limits<double>::quiet_NaN();   ///< standard error
    double completeness = std::numeric_limits<double>::quiet_NaN();   ///< M_c: magnitudes from here on count
    int events = 0;             ///< that count
};

struct AcousticEmission {
    double radius_m = 0.0;      ///< within which a crack joins an event
    double window_steps = 0.0;  ///< and the time since its last crack
    std::vector<AcousticEvent> events;
    BValue b_value;             ///< not a number below 50 events
    double fractal_dimension = std::numeric_limits<double>::quiet_NaN();   ///< of the places (P70)
};

/// The fewest events of which a b-value is told.
inline constexpr int fewest_events = 50;
/// Radius of an event over the mean grain diameter, unless told otherwise; and those with which the count is told, too.
inline constexpr double usual_event_radius = 5.0;

/// Of all cracks of a test. @param radius_grains  radius of an event, in mean grain diameters
AcousticEmission acoustic_emission(const TestResult& result, double radius_grains = usual_event_radius);

/// Maximum likelihood for magnitudes from `completeness` on. @param bin  width in which they are given; 0: continuous
/// (Tinti and Mulargia 1987, and Aki 1965; error by Shi and Bolt 1982)
BValue b_value(std::vector<double> magnitudes, double completeness, double bin = 0.0);

/// The magnitude at the peak of the histogram (bins of 0.1) plus 0.2. Not a number without magnitudes.
double magnitude_of_completeness(const std::vector<double>& magnitudes);

/// Slope of the logarithm of the correlation integral between 5 and 30 % of its largest distance (P70); of more than 2000 places evenly chosen ones decide.
double correlation_dimension(const std::vector<Vec2>& places);

}  // namespace feldspar
