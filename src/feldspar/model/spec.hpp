// What the user asks of the physics: the particle model, the materials, the numerics and the test, as plain data in SI.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "feldspar/model/fixture_spec.hpp"
#include "feldspar/model/gauge_spec.hpp"

namespace feldspar {

enum class GrainKind { flexible, rigid, inner_particles };
enum class ContactKind { lobatto3, point };            ///< three Lobatto points, or one (PCM); inner particles always have one
enum class ContactNormal { centres, edge };            ///< centre to centre, or the Laguerre edge's normal (inner particles, between grains)
enum class PlaneState { stress, strain };
enum class ContactLaw { bilinear, bilinear_literal, linear, brittle };
enum class ShearMeasure { total, beyond_friction };    ///< |us|, or |us| - mu max(Fn, 0) / ks
enum class TensionUnloading { elastic, secant };       ///< slope kn from the current point, or to the origin

struct ModelSpec {
    GrainKind kind = GrainKind::flexible;
    ContactKind contact = ContactKind::lobatto3;
    ContactNormal normal = ContactNormal::centres;
    PlaneState plane = PlaneState::stress;
};

/// Linear elastic grain. Rigid grains and grains of inner particles have no elastic constants of their own.
struct GrainMaterial {
    double E_Pa = 0.0;                  ///< flexible grains only
    double nu = 0.0;                    ///< flexible grains only
    double density_kg_m3 = 2650.0;
};

/// Cohesive contact between grains.
struct ContactMaterial {
    ContactLaw law = ContactLaw::bilinear;
    double Kn_Pa_m = 0.0;        ///< normal stiffness per area
    double eta = 0.0;            ///< ks / kn
    double sigma_nt_Pa = 0.0;    ///< tensile strength
    double tau_Pa = 0.0;         ///< cohesion
    double mu = 0.0;             ///< friction coefficient
    double Gfn_J_m2 = 0.0;       ///< fracture energy in tension (not used by the brittle law)
    double Gfs_J_m2 = 0.0;       ///< fracture energy in shear
    ShearMeasure shear_measure = ShearMeasure::total;
    TensionUnloading tension_unloading = TensionUnloading::elastic;
};

enum class NumericsKind { adaptive, paper, dynamic };

struct NumericsSpec {
    NumericsKind kind = NumericsKind::adaptive;
    double accuracy = 0.01;                         ///< adaptive: relative accuracy wanted of a strength (0.0005 ... 0.1)
    std::optional<double> residual_target;          ///< adaptive, for experts: R* itself; overrides accuracy
    double damping = 0.7;                           ///< local non-viscous damping alpha, 0 <= alpha < 1; adaptive: of the deviation from the loading motion
    std::optional<double> speed_m;                  ///< paper: platen speed in metres a step (default 6.25e-9); dynamic: m/s (must be given)
    std::optional<double> mass_factor;              ///< adaptive and paper: m = factor x 0.25 K; default 1 + alpha
    std::optional<double> time_step_s;              ///< dynamic; default: 0.8 of the stability limit
    std::optional<long long> maximum_steps;         ///< stop with what there is
    bool confirm = false;                           ///< repeat each test at a third of the target (or speed), and at another damping, and report the changes
};

enum class PlateShape { flat, curved };   ///< of the plates of a Brazilian test; curved: the jaws of ISRM

enum class TestKind { uniaxial_compression, direct_tension, biaxial, brazilian, three_point_bend, semi_circular_bend, hole_compression, custom };

/// What the loading keeps constant behind the strength: its own speed, the growth of the lateral strain, of the dissipated energy, or of a gauge.
enum class LoadControl { displacement, lateral_strain, dissipation, gauge };

/// A test of the user's own: what loads and holds the specimen, and what is read.
struct CustomTest {
    std::string name;                      ///< names its results, as a test method's name does
    std::vector<FixtureSpec> fixtures;     ///< plates with a stiffness of 0 have that of the test
    std::vector<GaugeSpec> gauges;
    std::optional<double> length_m;        ///< strain = loading motion / length; default: the extent of the specimen along the loading
    std::optional<double> width_m;         ///< stress = load / (width x thickness); default: its extent across
};

/// Ends a test when a gauge has reached a value, upwards or downwards.
struct GaugeStop {
    std::string gauge;
    double value = 0.0;                    ///< SI
};

struct TestSpec {
    TestKind kind = TestKind::uniaxial_compression;
    double sigma3_Pa = 0.0;              ///< tests with a pressure on the sides only
    double stop_fraction = 0.8;          ///< the test ends when the stress has fallen to this fraction of the peak
    LoadControl control = LoadControl::displacement;   ///< behind the strength; jobs: that of the method unless said; lateral strain: compression only
    double maximum_strain = 0.05;        ///< ... or at this axial strain (Brazilian: platen displacement / diameter)
    std::optional<double> maximum_stress_Pa; ///< ... or when the stress has reached this, a positive magnitude (biaxial: sigma1)
    PlateShape plates = PlateShape::flat;    ///< Brazilian only
    double jaw_radius = 1.5;             ///< of curved plates, over the radius of the disc; more than 1
    double plate_stiffness_factor = 1.0; ///< plates: their Kn as a multiple of the contacts' Kn
    std::optional<double> plate_Kn_Pa_m; ///< plates: their Kn itself, as of a bearing strip; in place of the factor
    std::optional<double> plate_mu;      ///< plates: friction; default 0.4 in the Brazilian test, else 0
    int membrane_plates = 16;            ///< biaxial, rigid and inner particles: plates of the membrane on each side
    int snapshots = 8;                   ///< fields kept between the first crack and the end, besides start, peak and end
    std::vector<unsigned long long> seeds;  ///< the seeds of this test; empty = those of the run
    std::optional<double> span_m;        ///< bending: between the supports; default: of the method
    std::optional<double> roller_radius_m;  ///< bending: default: of the method
    std::string control_gauge;           ///< LoadControl::gauge: the gauge that controls
    std::optional<GaugeStop> stop_gauge; ///< ends the test
    CustomTest custom;                   ///< custom only
};

// All values of each, in the order in which users are told; name() is how files call them.
inline constexpr std::array grain_kinds{GrainKind::flexible, GrainKind::rigid, GrainKind::inner_particles};
inline constexpr std::array contact_kinds{ContactKind::lobatto3, ContactKind::point};
inline constexpr std::array contact_normals{ContactNormal::centres, ContactNormal::edge};
inline constexpr std::array plane_states{PlaneState::stress, PlaneState::strain};
inline constexpr std::array contact_laws{ContactLaw::bilinear, ContactLaw::bilinear_literal, ContactLaw::linear, ContactLaw::brittle};
inline constexpr std::array numerics_kinds{NumericsKind::adaptive, NumericsKind::paper, NumericsKind::dynamic};
inline constexpr std::array plate_shapes{PlateShape::flat, PlateShape::curved};
inline constexpr std::array load_controls{LoadControl::displacement, LoadControl::lateral_strain, LoadControl::dissipation};   // and gauges, by their names
inline constexpr std::array test_kinds{TestKind::uniaxial_compression, TestKind::direct_tension, TestKind::biaxial, TestKind::brazilian,
                                       TestKind::three_point_bend, TestKind::semi_circular_bend, TestKind::hole_compression, TestKind::custom};

inline const char* name(TestKind kind) {
    switch (kind) {
        case TestKind::uniaxial_compression: return "uniaxial-compression";
        case TestKind::direct_tension: return "direct-tension";
        case TestKind::biaxial: return "biaxial";
        case TestKind::brazilian: return "brazilian";
        case TestKind::three_point_bend: return "three-point-bend";
        case TestKind::semi_circular_bend: return "semi-circular-bend";
        case TestKind::hole_compression: return "hole-compression";
        case TestKind::custom: return "custom";
    }
    return "?";
}
inline const char* name(NumericsKind kind) {
    switch (kind) {
        case NumericsKind::adaptive: return "adaptive";
        case NumericsKind::paper: return "paper";
        case NumericsKind::dynamic: return "dynamic";
    }
    return "?";
}
inline const char* name(ContactLaw law) {
    switch (law) {
        case ContactLaw::bilinear: return "bilinear";
        case ContactLaw::bilinear_literal: return "bilinear-literal";
        case ContactLaw::linear: return "linear";
        case ContactLaw::brittle: return "brittle";
    }
    return "?";
}
inline const char* name(ContactKind kind) { return kind == ContactKind::lobatto3 ? "lobatto3" : "point"; }
inline const char* name(PlaneState plane) { return plane == PlaneState::stress ? "stress" : "strain"; }
inline const char* name(GrainKind kind) {
    switch (kind) {
        case GrainKind::flexible: return "flexible";
        case GrainKind::rigid: return "rigid";
        case GrainKind::inner_particles: return "inner-particles";
    }
    return "?";
}
inline const char* name(LoadControl control) {
    switch (control) {
        case LoadControl::displacement: return "displacement";
        case LoadControl::lateral_strain: return "lateral-strain";
        case LoadControl::dissipation: return "dissipation";
        case LoadControl::gauge: return "gauge";
    }
    return "?";
}
inline const char* name(PlateShape shape) { return shape == PlateShape::flat ? "flat" : "curved"; }
inline const char* name(ContactNormal normal) { return normal == ContactNormal::centres ? "centres" : "edge"; }

}  // namespace feldspar
