// Linear elasticity of a constant-strain triangle under large rotations, in the plane.
//
// Source: docs/theory/triangles.md. The displacement gradient G = F - I is split into its conformal part (a, b) and its
// anti-conformal part (p, q):
//     a = (Gxx + Gyy) / 2,  b = (Gyx - Gxy) / 2,   p = (Gxx - Gyy) / 2,  q = (Gxy + Gyx) / 2.
// The rotation of the polar decomposition is the direction of (1 + a, b), its length r is half the trace of the stretch U.
// With Biot's stress D (U - I) turned by the rotation,
//     P = (D11 + D12) (1 - 1/r) conf(F) + (D11 - D12) anti(F),
//     W = (D11 + D12) (r - 1)^2 + (D11 - D12) (p^2 + q^2),     P = dW/dF.
// r - 1 is computed as (r^2 - 1) / (r + 1) from G, so that small strains keep all their digits.
#pragma once

#include <cmath>

#include "feldspar/base/vec2.hpp"
#include "feldspar/model/spec.hpp"

namespace feldspar {

/// The two constants of isotropic elasticity in the plane, Pa: s_xx = D11 e_xx + D12 e_yy, s_xy = (D11 - D12) e_xy.
struct PlaneElasticity {
    double D11 = 0.0;
    double D12 = 0.0;
};

/// @param nu  Poisson's ratio, in (-1, 0.5)
inline PlaneElasticity plane_elasticity(double E_Pa, double nu, PlaneState plane) {
    if (plane == PlaneState::stress) {
        const double D11 = E_Pa / (1.0 - nu * nu);
        return {D11, nu * D11};
    }
    const double factor = E_Pa / ((1.0 + nu) * (1.0 - 2.0 * nu));
    return {factor * (1.0 - nu), factor * nu};
}

/// The parts of the displacement gradient that the law is made of.
struct PolarSplit {
    double a, b, p, q;
    double r;          ///< half the trace of the stretch
    double r_minus_1;

    explicit PolarSplit(const Mat2& G)
        : a(0.5 * (G.xx + G.yy)), b(0.5 * (G.yx - G.xy)), p(0.5 * (G.xx - G.yy)), q(0.5 * (G.xy + G.yx)) {
        const double r2_minus_1 = 2.0 * a + a * a + b * b;
        r = std::sqrt(1.0 + r2_minus_1);
        r_minus_1 = r2_minus_1 / (r + 1.0);
    }
};

/// First Piola-Kirchhoff stress, Pa, from the displacement gradient.
inline Mat2 first_piola_stress(const PlaneElasticity& D, const Mat2& G) {
    const PolarSplit s(G);
    const double volumetric = (D.D11 + D.D12) * s.r_minus_1 / s.r;
    const double deviatoric = D.D11 - D.D12;
    return {volumetric * (1.0 + s.a) + deviatoric * s.p, deviatoric * s.q - volumetric * s.b,
            deviatoric * s.q + volumetric * s.b, volumetric * (1.0 + s.a) - deviatoric * s.p};
}

/// Strain energy per undeformed volume, J/m3.
inline double strain_energy_density(const PlaneElasticity& D, const Mat2& G) {
    const PolarSplit s(G);
    return (D.D11 + D.D12) * s.r_minus_1 * s.r_minus_1 + (D.D11 - D.D12) * (s.p * s.p + s.q * s.q);
}

/// Cauchy stress, Pa, tension positive: P F^T / det F.
inline Mat2 cauchy_stress(const PlaneElasticity& D, const Mat2& G) {
    const Mat2 P = first_piola_stress(D, G);
    const double Fxx = 1.0 + G.xx, Fyy = 1.0 + G.yy;
    const double J = Fxx * Fyy - G.xy * G.yx;
    return {(P.xx * Fxx + P.xy * G.xy) / J, (P.xx * G.yx + P.xy * Fyy) / J, (P.yx * Fxx + P.yy * G.xy) / J,
            (P.yx * G.yx + P.yy * Fyy) / J};
}

}  // namespace feldspar
