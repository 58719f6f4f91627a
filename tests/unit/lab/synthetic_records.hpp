// Records with known answers, written by formula instead of by a simulation.
#pragma once

#include <cmath>
#include <cstdint>

#include "feldspar/lab/properties.hpp"

namespace feldspar::synthetic {

constexpr double E = 25e9, nu = 0.25;

inline TestResult record(TestKind kind) {
    TestResult r;
    r.test.kind = kind;
    r.seed = 1;
    r.travel_time = 400.0;
    return r;
}

/// One row with platens that agree, a small residual and plausible energies.
inline HistoryRow row(Phase phase, long long step, double strain, double stress_Pa) {
    HistoryRow h;
    h.phase = phase;
    h.step = step;
    h.axial_strain = h.axial_strain_gauge = strain;
    h.lateral_strain_gauge = -nu * strain;
    h.axial_stress_Pa = h.stress_top_Pa = h.stress_bottom_Pa = stress_Pa;
    h.residual = 5e-3;
    h.residual_median = 3e-3;
    h.platen_displacement_m = 0.16 * strain;
    h.platen_speed = 1e-5 * std::abs(h.platen_displacement_m);
    h.kinetic_deviation = 1e-5;
    h.energy.elastic_grains = 0.9;
    h.energy.elastic_contacts = 0.1;
    h.energy.fracture = 0.02;
    h.energy.damping = 0.005;
    return h;
}

/// Linear elastic up to `peak_Pa` in `rows` loading rows, then three rows down to 0.7 of it. `sign` -1 pulls.
inline TestResult linear(TestKind kind, double peak_Pa, int rows = 100, double sign = 1.0) {
    TestResult r = record(kind);
    for (int i = 1; i <= rows; ++i) {
        const double stress = sign * peak_Pa * i / rows;
        r.history.push_back(row(Phase::loading, 10 * i, stress / E, stress));
    }
    for (int i = 1; i <= 3; ++i) {
        r.history.push_back(row(Phase::loading, 10 * (rows + i), sign * peak_Pa / E * (1.0 + 0.01 * i), sign * peak_Pa * (1.0 - 0.1 * i)));
    }
    r.properties = measure(r);
    return r;
}

inline Crack crack(long long step, double stress_Pa) {
    Crack c;
    c.step = step;
    c.axial_stress_Pa = stress_Pa;
    return c;
}

}  // namespace feldspar::synthetic
