// Records with known answers, written by formula instead of by a simulation.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "feldspar/lab/properties.hpp"

namespace feldspar::synthetic {

constexpr double E = 25e9, nu = 0.25;

inline TestResult record(MethodId kind) {
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
    h.residual_median = 1.5e-3;
    h.platen_displacement_m = 0.16 * strain;
    h.platen_speed = 1e-5 * std::abs(h.platen_displacement_m);
    h.kinetic_deviation = 1e-5;
    h.energy.elastic_grains = 0.9;
    h.energy.elastic_contacts = 0.1;
    h.energy.fracture = 0.02;
    h.energy.damping = 0.005;
    return h;
}

inline Crack crack(long long step, double stress_Pa) {
    Crack c;
    c.step = step;
    c.axial_stress_Pa = stress_Pa;
    return c;
}

constexpr double disc_radius = 0.040, disc_grain = 0.003;  // m

/// A disc of 80 mm with grains of 3 mm, as far as reading a record goes.
inline std::shared_ptr<const Specimen> disc_specimen() {
    auto specimen = std::make_shared<Specimen>();
    specimen->outline.is_disc = true;
    specimen->outline.radius_m = disc_radius;
    specimen->outline.area_m2 = std::acos(-1.0) * disc_radius * disc_radius;
    specimen->quality.mean_diameter_m = disc_grain;
    return specimen;
}

/// Cracks of 1.5 mm along a line through the given corners (m), one a step from `step` on.
inline std::vector<Crack> path(const std::vector<Vec2>& corners, long long step) {
    std::vector<Crack> cracks;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        const Vec2 along = corners[i + 1] - corners[i];
        const int pieces = std::max(1, static_cast<int>(std::round(norm(along) / 0.0015)));
        for (int k = 0; k < pieces; ++k) {
            Crack c = crack(step++, 0.0);
            c.from = corners[i] + (static_cast<double>(k) / pieces) * along;
            c.to = corners[i] + (static_cast<double>(k + 1) / pieces) * along;
            c.place = 0.5 * (c.from + c.to);
            cracks.push_back(c);
        }
    }
    return cracks;
}

/// Linear elastic up to `peak_Pa` in `rows` loading rows, then three rows down to 0.7 of it. `sign` -1 pulls. A disc splits
/// behind its peak.
inline TestResult linear(MethodId kind, double peak_Pa, int rows = 100, double sign = 1.0) {
    TestResult r = record(kind);
    for (int i = 1; i <= rows; ++i) {
        const double stress = sign * peak_Pa * i / rows;
        r.history.push_back(row(Phase::loading, 10 * i, stress / E, stress));
    }
    for (int i = 1; i <= 3; ++i) {
        r.history.push_back(
            row(Phase::loading, 10 * (rows + i), sign * peak_Pa / E * (1.0 + 0.01 * i), sign * peak_Pa * (1.0 - 0.1 * i)));
    }
    if (kind == methods::brazilian) {
        r.specimen = disc_specimen();
        r.cracks = path({{0.0, -0.025}, {0.0, 0.025}}, 0);
        for (Crack& c : r.cracks) c.step = 10 * rows + 1;
    }
    r.properties = measure(r);
    return r;
}

/// A record of a disc with these stresses in rows at steps 10, 20, ...
inline TestResult disc_record(const std::vector<double>& stresses_Pa) {
    TestResult r = record(methods::brazilian);
    r.specimen = disc_specimen();
    long long step = 0;
    for (const double stress : stresses_Pa) {
        step += 10;
        r.history.push_back(row(Phase::loading, step, 1e-6 * static_cast<double>(step), stress));
    }
    return r;
}

}  // namespace feldspar::synthetic
