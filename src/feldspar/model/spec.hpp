// What the user asks of the physics: the particle model, the materials and the numerics, as plain data in SI. The test:
// methods/test_spec.hpp.
#pragma once

#include <array>
#include <optional>

namespace feldspar {

enum class GrainKind { flexible, rigid, inner_particles };
enum class ContactKind { lobatto3, point };  ///< three Lobatto points, or one (PCM); inner particles always have one
enum class ContactNormal {
    centres,
    edge
};  ///< centre to centre, or the Laguerre edge's normal (inner particles, between grains)
enum class PlaneState { stress, strain };
enum class ContactLaw { bilinear, bilinear_literal, linear, brittle };
enum class ShearMeasure { total, beyond_friction };  ///< |us|, or |us| - mu max(Fn, 0) / ks
enum class TensionUnloading { elastic, secant };     ///< slope kn from the current point, or to the origin

struct ModelSpec {
    GrainKind kind = GrainKind::flexible;
    ContactKind contact = ContactKind::lobatto3;
    ContactNormal normal = ContactNormal::centres;
    PlaneState plane = PlaneState::stress;
};

/// Linear elastic grain. Rigid grains and grains of inner particles have no elastic constants of their own.
struct GrainMaterial {
    double E_Pa = 0.0;  ///< flexible grains only
    double nu = 0.0;    ///< flexible grains only
    double density_kg_m3 = 2650.0;
};

/// Cohesive contact between grains.
struct ContactMaterial {
    ContactLaw law = ContactLaw::bilinear;
    double Kn_Pa_m = 0.0;      ///< normal stiffness per area
    double eta = 0.0;          ///< ks / kn
    double sigma_nt_Pa = 0.0;  ///< tensile strength
    double tau_Pa = 0.0;       ///< cohesion
    double mu = 0.0;           ///< friction coefficient
    double Gfn_J_m2 = 0.0;     ///< fracture energy in tension (not used by the brittle law)
    double Gfs_J_m2 = 0.0;     ///< fracture energy in shear
    ShearMeasure shear_measure = ShearMeasure::total;
    TensionUnloading tension_unloading = TensionUnloading::elastic;
};

enum class NumericsKind { adaptive, paper, dynamic };

struct NumericsSpec {
    NumericsKind kind = NumericsKind::adaptive;
    double accuracy = 0.01;                 ///< adaptive: relative accuracy wanted of a strength (0.0005 ... 0.1)
    std::optional<double> residual_target;  ///< adaptive, for experts: R* itself; overrides accuracy
    double damping =
        0.7;  ///< local non-viscous damping alpha, 0 <= alpha < 1; adaptive: of the deviation from the loading motion
    std::optional<double> speed_m;      ///< paper: platen speed in metres a step (default 6.25e-9); dynamic: m/s (must be given)
    std::optional<double> mass_factor;  ///< adaptive and paper: m = factor x 0.25 K; default 1 + alpha
    std::optional<double> time_step_s;  ///< dynamic; default: 0.8 of the stability limit
    std::optional<long long> maximum_steps;  ///< stop with what there is
    bool confirm =
        false;  ///< repeat each test at a third of the target (or speed), and at another damping, and report the changes
};

// All values of each, in the order in which users are told; name() is how files call them.
inline constexpr std::array grain_kinds{GrainKind::flexible, GrainKind::rigid, GrainKind::inner_particles};
inline constexpr std::array contact_kinds{ContactKind::lobatto3, ContactKind::point};
inline constexpr std::array contact_normals{ContactNormal::centres, ContactNormal::edge};
inline constexpr std::array plane_states{PlaneState::stress, PlaneState::strain};
inline constexpr std::array contact_laws{ContactLaw::bilinear, ContactLaw::bilinear_literal, ContactLaw::linear,
                                         ContactLaw::brittle};
inline constexpr std::array numerics_kinds{NumericsKind::adaptive, NumericsKind::paper, NumericsKind::dynamic};

inline const char* name(NumericsKind kind) {
    switch (kind) {
        case NumericsKind::adaptive:
            return "adaptive";
        case NumericsKind::paper:
            return "paper";
        case NumericsKind::dynamic:
            return "dynamic";
    }
    return "?";
}
inline const char* name(ContactLaw law) {
    switch (law) {
        case ContactLaw::bilinear:
            return "bilinear";
        case ContactLaw::bilinear_literal:
            return "bilinear-literal";
        case ContactLaw::linear:
            return "linear";
        case ContactLaw::brittle:
            return "brittle";
    }
    return "?";
}
inline const char* name(ContactKind kind) { return kind == ContactKind::lobatto3 ? "lobatto3" : "point"; }
inline const char* name(PlaneState plane) { return plane == PlaneState::stress ? "stress" : "strain"; }
inline const char* name(GrainKind kind) {
    switch (kind) {
        case GrainKind::flexible:
            return "flexible";
        case GrainKind::rigid:
            return "rigid";
        case GrainKind::inner_particles:
            return "inner-particles";
    }
    return "?";
}
inline const char* name(ContactNormal normal) { return normal == ContactNormal::centres ? "centres" : "edge"; }

}  // namespace feldspar
