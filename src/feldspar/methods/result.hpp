// What a laboratory test leaves behind, as plain data: the history, the cracks, fields at chosen moments, the evidence.
// Sign convention of everything here: compression positive, as in rock mechanics; strengths are positive magnitudes.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "feldspar/base/vec2.hpp"
#include "feldspar/methods/acoustic_event.hpp"
#include "feldspar/methods/test_spec.hpp"
#include "feldspar/model/spec.hpp"
#include "feldspar/model/texture.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Where the energy is, and where it came from (J). Balance: external + elastic_start + rate_control =
/// elastic_grains + elastic_contacts + fracture + friction + damping + kinetic, up to the residual.
struct EnergyLedger {
    double external = 0.0;       ///< work of platens and lateral pressure since the start
    double elastic_start = 0.0;  ///< energy that the computed elastic start put into the body
    double rate_control = 0.0;   ///< put in by corrections: of the body-wide velocity when the rate changes, by new contacts
    double elastic_grains = 0.0;
    double elastic_contacts = 0.0;
    double fracture = 0.0;
    double friction = 0.0;
    double damping = 0.0;
    double kinetic = 0.0;

    double supplied() const { return external + elastic_start + rate_control; }
    double residual() const { return supplied() - (elastic_grains + elastic_contacts + fracture + friction + damping + kinetic); }
};

enum class Phase : int { consolidation = 0, elastic = 1, loading = 2 };

/// One row of the history.
struct HistoryRow {
    Phase phase = Phase::loading;  ///< elastic: passed over in closed form, linear between zero and the computed elastic start
    long long step = 0;
    double platen_displacement_m = 0.0;  ///< > 0 when the specimen is shortened (or the Brazilian plates approach)
    double axial_strain = 0.0;           ///< from the platens
    double axial_strain_gauge = 0.0;     ///< from the gauge: least squares over the central half of the specimen
    double lateral_strain_gauge = 0.0;   ///< the same, < 0 when the specimen widens
    double axial_stress_Pa =
        0.0;  ///< mean of both platens over the narrowest initial section; Brazilian: 2P / (pi D t), of a flattened disc times k
    double stress_top_Pa = 0.0;
    double stress_bottom_Pa = 0.0;
    double sigma3_Pa = 0.0;
    int cracks_tensile = 0;
    int cracks_shear = 0;
    double residual = 0.0;           ///< R*: sum of |F| over free degrees of freedom / platen force
    double residual_median = 0.0;    ///< the same with the median body's |F| times the number of bodies as sum
    double platen_speed = 0.0;       ///< m a step (dynamic: m/s)
    double kinetic_deviation = 0.0;  ///< J, of the motion that departs from the loading motion
    double contact_arc_top_deg =
        0.0;  ///< Brazilian: arc of the disc that presses on the plate, between the ends of its outermost pressed grain edges
    double contact_arc_bottom_deg = 0.0;
    int stage = 0;  ///< number of the stage, from 1 (TestResult::stages); 0 before the first, and in a test without stages
    std::vector<double> gauges;  ///< of the method or the user, in the order of TestResult::gauges, SI
    EnergyLedger energy;
};

enum class CrackMode : int { tensile = 0, shear = 1 };

/// A contact point whose bond broke.
struct Crack {
    long long step = 0;
    double axial_strain = 0.0;
    double axial_stress_Pa = 0.0;
    CrackMode mode = CrackMode::tensile;
    int grain_a = 0;
    int grain_b = 0;
    int contact = 0;  ///< number of the contact in the initial assembly
    int point = 0;    ///< contact point within the contact
    Vec2 place;       ///< m, undeformed
    Vec2 from, to;    ///< m, undeformed: the share of the grain edge that this point stands for
    double area_m2 = 0.0;
    double energy_J = 0.0;                 ///< dissipated at this point until it broke
    Vec2 normal;                           ///< from grain a to grain b, when it was recorded
    double opening_m = 0.0, slip_m = 0.0;  ///< of grain b against a, along the normal and across it (rot90), then
};

/// Fields at one moment.
struct Snapshot {
    std::string label;  ///< "start", "first-crack", "peak", "end" or "load-<n>"
    long long step = 0;
    double axial_strain = 0.0;
    double axial_stress_Pa = 0.0;
    std::vector<Vec2> displacement_m;  ///< a node of the grain mesh
    std::vector<double> stress_xx_Pa;  ///< a triangle, Cauchy, compression positive
    std::vector<double> stress_yy_Pa;
    std::vector<double> stress_xy_Pa;
    std::vector<float> damage;            ///< a triangle: largest damage of the contact points on its grain edge, 0 ... 1
    int cracks = 0;                       ///< the first so many of TestResult::cracks exist at this moment
    std::vector<double> crack_opening_m;  ///< one for each of these cracks; > 0 open
    std::vector<float> contact_damage;    ///< one for each of TestResult::grain_contacts: the largest of its points, 0 ... 1
    std::vector<float> contact_normal_N;  ///< the same: sum over its points, > 0 compression
    std::vector<float> contact_shear_N;   ///< the same: on grain b, along the normal turned by a quarter to the left
};

/// Where two grains were bonded before the test.
struct ContactPlace {
    int grain_a = 0, grain_b = 0;
    Vec2 from, to;  ///< m, undeformed: the part of the grain edge that the contact stands for
};

/// Evidence that the run was quasi-static, from half the peak to the peak unless said, and the verdict in words.
struct QuasiStaticEvidence {
    double error_estimate =
        0.0;  ///< how much the loading rate may have changed the strength, relative; from the repeat if confirmed
    double residual_median = 0.0;  ///< mean of HistoryRow::residual_median from 0.9 of the peak to the peak
    double load_per_travel_time =
        0.0;  ///< growth of the platen displacement in a travel time of a wave, relative; mean from 0.9 of the peak on
    double imbalance_mean = 0.0;  ///< |top - bottom| / mean of both, mean from 0.9 of the peak to the peak
    double residual_mean = 0.0;
    double residual_at_peak = 0.0;
    double imbalance_max = 0.0;          ///< largest |top - bottom| / mean
    double kinetic_over_strain = 0.0;    ///< largest kinetic energy of the deviation / strain energy
    double damping_over_fracture = 0.0;  ///< damping work / fracture work at the peak
    char grade = 'C';                    ///< A: to about 0.5 %, B: to about 2 %, C: not shown
    std::string verdict;                 ///< one sentence for the user
    double peak_change_at_third =
        0.0;  ///< relative change of the peak at a third of the target (passages: at half of both limits or less), if confirmed
    bool confirmed = false;           ///< a slower repeat was run
    double balanced_stress_Pa = 0.0;  ///< the largest stress up to the peak that the typical body carried in balance (its part of
                                      ///< the error at most 2 %); not-a-number without one
    double other_damping = 0.0;       ///< local damping of a second repeat; 0: there was none
    double peak_change_at_other_damping = 0.0;  ///< relative change of the peak in it
};

/// How a disc failed in a Brazilian test (P26)-(P29). Places: distance from the centre over the radius; angle from the direction
/// of the loading plate, clockwise, -180 ... 180 degrees. Not-a-number where the record shows none.
struct BrazilianFailure {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    bool split = false;          ///< a connected path of cracks spans the disc
    bool valid = false;          ///< ISRM: the crack that split the disc began in the central part of the loaded diameter
    double first_dip_Pa = none;  ///< largest stress before the first fall of 5 %
    double largest_Pa = none;    ///< of the record
    double crack_span = none;    ///< extent of the longest connected path at the end, over the diameter
    double first_crack_radius = none;
    double first_crack_angle_deg = none;
    double first_crack_share = none;  ///< stress at it over the strength
    double splitting_radius = none;  ///< where the path that split the disc (without a split: the longest) has its earliest crack
    double splitting_angle_deg = none;
    double splitting_share = none;      ///< stress at it over the strength
    double contact_arc_top_deg = none;  ///< at the strength
    double contact_arc_bottom_deg = none;
    double flat_coefficient = none;  ///< of a flattened disc: k, by which all its stresses are 2P / (pi D t) (P31)
};

/// The branch behind the peak (P32)-(P34). Not-a-number where the record shows none.
struct PostPeak {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    double modulus_Pa = none;  ///< slope from 0.9 to 0.5 of the peak: < 0 class I, > 0 class II; only where the platens followed
                               ///< the branch (LoadControl)
    double brittleness =
        none;  ///< k1 of Tarasov and Potvin: energy of rupture over the elastic energy set free; > 1 class I, 0 ... 1 class II
    double fracture_share = none;  ///< of the energy dissipated between the peak and the end of the record: by fracture,
    double friction_share = none;  ///< by friction,
    double damping_share = none;   ///< and by damping, into which goes all that breaks in jumps
};

/// What a test did in one of its stages. The rows [first_row, last_row] are those of its loading: it begins in the state of the
/// first.
struct StageRecord {
    StageKind kind = StageKind::load;
    int group = 0;                            ///< of the test's groups of stages, from 0
    int pass = 0;                             ///< repetition of the group, from 0
    std::size_t first_row = 0, last_row = 0;  ///< of the history
    std::string ended;                        ///< why, in words; empty if the test ended before
};

/// Loading and the unloading behind it, of a test that has such stages (P52)-(P54). Stresses are total ones; not-a-number where
/// the record defines none.
struct CycleProperties {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    int first_stage = 0, last_stage = 0;  ///< numbers from 1
    double sigma3_Pa = 0.0;               ///< at the largest stress
    double peak_stress_Pa = none;         ///< largest stress of its loading
    double peak_strain = none;            ///< axial strain at it
    double reloading_modulus_Pa = none;   ///< slope of its loading where that begins from a load: (P52); not of the first cycle
    double unloading_modulus_Pa = none;   ///< (P52); not of a last cycle without unloading
    double permanent_axial_strain =
        none;  ///< left when it is unloaded, since the unloaded specimen before the test (P53); lateral: < 0 wider
    double permanent_lateral_strain = none;
    double permanent_volumetric_strain = none;
    double damage = none;          ///< omega (P54): 0 and growing as the specimen dilates
    double first_crack_Pa = none;  ///< stress at its first crack
    double sigma_ci_Pa = none;     ///< by the crack volumetric strain (P9) of its loading
    double sigma_cd_Pa = none;     ///< reversal of the volumetric strain (P8) in its loading
    double work_J = 0.0;           ///< supplied
    double dissipated_J = 0.0;     ///< by fracture, friction and damping
    int cracks = 0;                ///< in its course
};

/// A strength envelope from one specimen under rising pressures (P55), (P56). Not-a-number where the test defines none.
struct MultiStageProperties {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> sigma3_Pa;     ///< of the stages that loaded, in order
    std::vector<double> reversal_Pa;   ///< sigma1 at which the volumetric strain turned
    std::vector<double> strength_Pa;   ///< sigma1: of the last stage measured, of the others estimated (P55)
    double peak_over_reversal = none;  ///< of the deviator in the last stage
    double cohesion_Pa = none;         ///< (P12) of these strengths
    double friction_angle_deg = none;
};

/// How a plate with a round hole fails (P49)-(P51). Stresses along the axis are those of the whole plate. Not-a-number where the
/// record shows none.
struct HoleProperties {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    double radius_m = none;
    double radius_over_grain = none;  ///< over the mean diameter of the grains
    double side_factor = none;  ///< stress along the edge at the sides over the axial stress, elastic; of a plate with free sides
    double pole_factor = none;  ///< likewise at the poles
    double pole_crack_Pa = none;            ///< axial stress at the first tensile crack at a pole
    double side_crack_Pa = none;            ///< axial stress at the first crack at a side
    double breakout_Pa = none;              ///< axial stress at which a breakout at a side has become one grain deep
    double breakout_side_stress_Pa = none;  ///< stress along the edge at the sides then, from the elastic field around the hole
    double depth_at_peak_m = none;          ///< of the deeper breakout
    double depth_at_end_m = none;
};

/// Properties read from one test. Not-a-number where the test does not define one.
struct TestProperties {
    double peak_stress_Pa;      ///< strength, a positive magnitude; Brazilian: the largest until the disc is split
    bool peak_reached = false;  ///< Brazilian: the disc was split
    double first_crack_Pa;
    double E_secant_Pa;                 ///< at 50 % of the peak, from the platens
    double E_tangent_Pa;                ///< at 50 % of the peak (40 ... 60 %), from the platens
    double E_average_Pa;                ///< 30 ... 70 % of the peak, from the platens
    double E_gauge_Pa;                  ///< tangent at 50 % of the peak, from the gauge
    double nu;                          ///< secant at 50 % of the peak, from the gauges: the same stress window as E_secant
    double nu_tangent;                  ///< 40 ... 60 % of the peak, from the gauges: grows as cracks begin to open
    double E_initial_Pa;                ///< slope up to 10 % of the peak, from the gauge: before damage
    double nu_initial;                  ///< the same, from the gauges
    double sigma_ci_crack_count_Pa;     ///< 1 % of the cracks at the peak
    double sigma_ci_crack_volume_Pa;    ///< reversal of the crack volumetric strain
    double sigma_ci_lateral_strain_Pa;  ///< lateral strain response
    double sigma_cd_Pa;                 ///< reversal of the volumetric strain
    double section_width_m;             ///< of the section that the stresses are taken over: the narrowest one across the load
    std::vector<std::string> remarks;   ///< sentences that a reader of the numbers must know
    BrazilianFailure brazilian{};       ///< Brazilian test only
    PostPeak post_peak{};               ///< not of a Brazilian test; modulus and brittleness not of a test with stages
    std::vector<double> of_method{};    ///< those that the method adds (MethodProperty), in its order
    std::vector<CycleProperties> cycles{};                           ///< of a test with stages that unload
    double damage_omega = std::numeric_limits<double>::quiet_NaN();  ///< (P54) after the last cycle that was unloaded
    MultiStageProperties multi_stage{};                              ///< of a multi-stage test only
    HoleProperties hole{};                                           ///< of a plate with a hole only
};

/// The whole contact that was nearest to breaking when the test ended, read from the state that it left. Not-a-number without a
/// whole one.
struct NearestToFailure {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    double share = none;      ///< traction over strength: of the mode that is nearer, 1 where softening has begun
    bool in_tension = false;  ///< that mode; else shear
    double damage = 0.0;      ///< the largest of contact points that are not broken, 0 ... 1
    Vec2 place;               ///< m, undeformed: the middle of its edge
};

struct TestResult {
    std::string variant;  ///< which of the job's variants this is; empty if the job has none
    TestSpec test;
    ModelSpec model;
    ContactMaterial contact;
    GrainMaterial grain;
    Heterogeneity rock{};      ///< what of grains and contacts differs from these
    TextureSummary texture{};  ///< what it came to on this specimen
    NumericsSpec numerics;
    std::uint64_t seed = 0;
    std::shared_ptr<const Specimen> specimen;
    std::vector<HistoryRow> history;
    std::vector<Crack> cracks;
    std::vector<Snapshot> snapshots;
    std::vector<ContactPlace> grain_contacts;  ///< of the initial assembly, for the fields of snapshots; empty without snapshots
    std::vector<StageRecord> stages;           ///< of a test that has stages, in order
    std::vector<GaugeSpec> gauges;             ///< that the rows of the history have, beside those of the strain in the middle
    double length_m = std::numeric_limits<double>::quiet_NaN();    ///< strain = loading motion / length
    double section_m2 = std::numeric_limits<double>::quiet_NaN();  ///< stress = load / section
    EnergyLedger energy_at_end;
    double energy_residual = 0.0;  ///< largest |residual| of the ledger / supplied work
    QuasiStaticEvidence evidence;
    TestProperties properties{};
    AcousticEmission emission{};  ///< of its cracks
    NearestToFailure nearest{};   ///< at the end
    std::string stop_reason;      ///< in words
    bool interrupted = false;
    long long steps = 0;          ///< all steps of the loading, those of earlier passages too
    long long steps_to_peak = 0;  ///< loading steps up to the peak, those of earlier passages too
    int passages = 1;             ///< how often the strength was passed: again, more slowly, where the first time was too fast
    long long preparation_steps = 0;  ///< steps of the elastic start and the consolidation
    double wall_s = 0.0;
    double ms_per_step = 0.0;
    int threads = 1;                      ///< at the end: a test may get more while it runs
    long long shape_fallbacks = 0;        ///< contact sides that used the initial shape functions, summed over steps
    double angular_momentum_loss = 0.0;   ///< moment lost by them, relative to the contact moments
    long long vanished_compressions = 0;  ///< points whose compression vanished at damage 1 (model, section 5)
    int new_contacts = 0;                 ///< frictional contacts made after detachment
    double travel_steps = 0.0;            ///< of a wave over the height, in steps
    double travel_time = 0.0;             ///< of a wave over the height, steps (dynamic: s)
    double stable_omega2 = 0.0;           ///< largest omega^2 dt^2 of the initial state
    double stable_limit = 0.0;            ///< its bound for this damping
};

}  // namespace feldspar
