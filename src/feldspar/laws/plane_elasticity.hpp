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
// The text is written over a number type: double in the readable stages, a vector of triangles in the kernels of fast/.
#pragma once

#include "feldspar/base/vec2.hpp"
#include "feldspar/laws/number.hpp"
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

/// The parts of the displacement gradient that the law is made of. @tparam Real  double, or a vector of triangles
template <class Real>
struct PolarSplit {
    Real a{}, b{}, p{}, q{};
    Real r2_minus_1{};  ///< r: half the trace of the stretch

    FELDSPAR_LAW PolarSplit(Real a_, Real b_, Real p_, Real q_)
        : a(a_), b(b_), p(p_), q(q_), r2_minus_1(2.0 * a + (a * a + b * b)) {}
    FELDSPAR_LAW Real r_minus_1() const { return r2_minus_1 / (1.0 + NumberOf<Real>::square_root(1.0 + r2_minus_1)); }
};

/// @param G  the displacement gradient
inline PolarSplit<double> polar_split(const Mat2& G) {
    return {0.5 * (G.xx + G.yy), 0.5 * (G.yx - G.xy), 0.5 * (G.xx - G.yy), 0.5 * (G.xy + G.yx)};
}

/// 1 - 1/r from x = r^2 - 1: the binomial series, whose next term is below 1e-17 of the result for |x| < 1/128. A compression of
/// 150 MPa makes x about 1/200 in a grain of 25 GPa.
template <class Real>
FELDSPAR_LAW Real one_minus_inverse_root(Real x) {
    constexpr double kLargest = 1.0 / 128.0;
    if (NumberOf<Real>::any(NumberOf<Real>::absolute(x) >= kLargest)) [[unlikely]] {
        const Real r = NumberOf<Real>::square_root(1.0 + x);
        return x / (r * (r + 1.0));
    }
    Real sum = number<Real>(-6435.0 / 32768.0);
    sum = sum * x + 429.0 / 2048.0;
    sum = sum * x - 231.0 / 1024.0;
    sum = sum * x + 63.0 / 256.0;
    sum = sum * x - 35.0 / 128.0;
    sum = sum * x + 5.0 / 16.0;
    sum = sum * x - 3.0 / 8.0;
    sum = sum * x + 0.5;
    return x * sum;
}

/// Components of a stress.
template <class Real>
struct PlaneStress {
    Real xx{}, xy{}, yx{}, yy{};
};

/// First Piola-Kirchhoff stress. @param volumetric  D11 + D12, times what the stress is wanted in @param deviatoric  D11 - D12,
/// likewise
template <class Real>
FELDSPAR_LAW PlaneStress<Real> first_piola_stress(Real volumetric, Real deviatoric, const PolarSplit<Real>& s) {
    const Real v = volumetric * one_minus_inverse_root(s.r2_minus_1);
    const Real c = v + v * s.a, vb = v * s.b, dp = deviatoric * s.p, dq = deviatoric * s.q;
    return {c + dp, dq - vb, dq + vb, c - dp};
}

/// Strain energy per undeformed volume, with the same constants.
template <class Real>
FELDSPAR_LAW Real strain_energy_density(Real volumetric, Real deviatoric, const PolarSplit<Real>& s) {
    const Real r_minus_1 = s.r_minus_1();
    return volumetric * r_minus_1 * r_minus_1 + deviatoric * (s.p * s.p + s.q * s.q);
}

/// First Piola-Kirchhoff stress, Pa, from the displacement gradient.
inline Mat2 first_piola_stress(const PlaneElasticity& D, const Mat2& G) {
    const auto [xx, xy, yx, yy] = first_piola_stress(D.D11 + D.D12, D.D11 - D.D12, polar_split(G));
    return {xx, xy, yx, yy};
}

/// Strain energy per undeformed volume, J/m3.
inline double strain_energy_density(const PlaneElasticity& D, const Mat2& G) {
    return strain_energy_density(D.D11 + D.D12, D.D11 - D.D12, polar_split(G));
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
