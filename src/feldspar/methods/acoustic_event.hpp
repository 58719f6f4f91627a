// Acoustic emission of a test as plain data: cracks gathered into events, and their statistics (docs/theory/properties.md,
// section on acoustic emission). lab/acoustic_emission.hpp gathers them.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// Cracks that are near to each other in place and time (P64).
struct AcousticEvent {
    long long first_step = 0, last_step = 0;
    double axial_strain = 0.0, axial_stress_Pa = 0.0;  ///< at the first crack
    Vec2 place{};                                      ///< m, undeformed: mean of its cracks
    int cracks = 0, shear_cracks = 0;
    double energy_J = 0.0;                                        ///< dissipated by its cracks until they broke
    double magnitude = std::numeric_limits<double>::quiet_NaN();  ///< of the energy (P65)
    Mat2 moment_Nm{};  ///< moment tensor of what opened and slid (P66), opening positive
    double moment_magnitude = std::numeric_limits<double>::quiet_NaN();  ///< (P67)
    double isotropy = std::numeric_limits<double>::quiet_NaN();          ///< R (P68), -100 ... 100: above 30 tensile, below -30
                                                                         ///< implosive, between shear
};

/// Slope of the magnitudes' distribution (P69).
struct BValue {
    double b = std::numeric_limits<double>::quiet_NaN();
    double error = std::numeric_limits<double>::quiet_NaN();         ///< standard error
    double completeness = std::numeric_limits<double>::quiet_NaN();  ///< M_c: magnitudes from here on count
    int events = 0;                                                  ///< that count
};

/// How many events there are, and of what slope, if cracks join within another radius.
struct AcousticCount {
    double radius_grains = 0.0;  ///< in mean grain diameters
    std::size_t events = 0;
    BValue b_value;  ///< not a number below 50 events
};

struct AcousticEmission {
    double radius_m = 0.0;      ///< within which a crack joins an event
    double window_steps = 0.0;  ///< and the time since its last crack
    std::vector<AcousticEvent> events;
    BValue b_value;                                                       ///< not a number below 50 events
    double fractal_dimension = std::numeric_limits<double>::quiet_NaN();  ///< of the places (P70)
    std::vector<AcousticCount> counts{};  ///< for several radii, this one among them, rising; empty without events
};

}  // namespace feldspar
