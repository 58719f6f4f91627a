// A test method: everything that makes a uniaxial compression test what it is, and not a Brazilian one, as data. One file a method; the rest
// of the program reads these facts and asks for no method by name.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "feldspar/model/fixture_spec.hpp"
#include "feldspar/model/spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// What a method may look at when it says how a test is built.
struct MethodInput {
    const Specimen& specimen;
    const ModelSpec& model;
    const GrainMaterial& grain;
    const ContactMaterial& contact;
    const TestSpec& test;
};

/// How a test is built: its fixtures, and what turns force and motion into stress and strain. Functions of the specimen and the test alone.
struct MethodBuild {
    std::vector<FixtureSpec> (*fixtures)(const MethodInput&) = nullptr;
    double (*length_m)(const MethodInput&) = nullptr;    ///< strain = loading motion / length
    double (*section_m2)(const MethodInput&) = nullptr;  ///< stress = load / section
    std::vector<GaugeSpec> (*gauges)(const MethodInput&) = nullptr;   ///< none: no gauges but those of the strain in the specimen's middle
    std::vector<const char*> gauge_names{};   ///< that it may have
    void (*check)(const Outline&, double thickness_m, const TestSpec&) = nullptr;   ///< throws InputError if the specimen is none for the test; none: it stands between platens
};

/// What results and pages call things.
struct MethodWords {
    const char* title;     ///< "Uniaxial compression"
    const char* stress;    ///< what the stress is: "Axial stress"
    const char* strain;    ///< what the strain is: "Axial strain from the platens"
};

/// What is known of the elastic answer to the loading before it is computed.
struct MethodStart {
    bool strained_evenly = true;    ///< about the same strain everywhere: a first guess; else only the fixtures move at first
    bool stays_in_touch = true;     ///< the answer is in proportion to the loading; else contacts at plates close on the way
    bool time_of_mode = false;      ///< the time that rates are measured in is the loading mode's; else a wave's over the length
};

/// What is read from the record of a test.
enum class Reading {
    column,   ///< moduli, Poisson's ratio, thresholds and the branch behind the peak of a specimen that is strained evenly
    disc,     ///< how a disc was split
    beam,     ///< flexural strength, modulus and toughness
    half_disc,   ///< toughness of a notched half disc
    hole,     ///< stresses, cracks and breakouts at the edge of a round hole
    curve     ///< the largest load alone
};

/// What the specimen is, and what touches it.
struct MethodSpecimen {
    bool own_disc = false;     ///< a disc that the test cuts itself and presses between two plates; else the job's specimen, between platens at its ends
    bool confined = false;     ///< a pressure sigma3 on the sides (and first on all sides), which the job gives
    bool stands_free = false;  ///< confined, but a job may leave the pressure out
    bool glued = false;        ///< the ends are glued to the platens; else they may slide and come off
    double plate_mu = 0.0;     ///< friction of plates, unless the job gives another
    bool plates = false;       ///< plates or rollers load it whatever its grains are; else only rigid grains and inner particles
};

/// How it is loaded, and what is then known of it.
struct MethodLoading {
    double sign = 1.0;         ///< of the axial stress that loads: 1 compression, -1 tension
    LoadControl control = LoadControl::displacement;   ///< behind the strength, unless the job gives another
    double stop_fraction = 0.8; ///< of the peak, at which the test ends unless the job gives another
    bool widens = false;       ///< the specimen widens as it fails: the lateral strain can control the test, and tells of damage
    bool bends = false;        ///< a column that may bend aside before it breaks (Euler)
    bool tensile = false;      ///< the strength is a tensile one
    /// Principal stresses at the strength, where they are known: sigma3 and sigma1 as multiples of it, and sigma3 with the confining pressure.
    std::optional<std::array<double, 2>> failure_state{};
};

/// Constants of the adaptive numerics, measured (docs/validation, true strengths).
struct MethodRate {
    double residual_target = 1.0;   ///< R* with which the strength is first looked for, over the wanted accuracy
    double residual_share = 2.0;    ///< error of the strength over R* of the typical body, w of (L8)
    double travel_times = 60.0;     ///< that a test usually takes at the usual accuracy, in times of a wave
    double seconds = 4.0;           ///< that it takes with 1000 flexible grains, on a slow core
    double fixed_speed_strain = 6e-3;   ///< to which a test at a fixed speed usually goes
};

/// What the verdict allows (L9), relative.
struct MethodVerdict {
    double error_a = 5e-3;                          ///< estimated error of the strength, grade A; grade B: grade_b_error
    double imbalance_a = 1e-2, imbalance_b = 2e-2;  ///< mean difference of the platens over their mean
};

struct TestMethod {
    TestKind kind;
    const char* purpose;   ///< one sentence
    MethodWords words;
    MethodBuild build;
    MethodStart start;
    Reading reading;
    MethodSpecimen specimen;
    MethodLoading loading;
    MethodRate rate;
    MethodVerdict verdict;
};

/// One definition a file, named as jobs name the method.
namespace methods {
extern const TestMethod uniaxial_compression, direct_tension, biaxial, brazilian, three_point_bend, semi_circular_bend, hole_compression, custom;
}

/// The facts of a method.
const TestMethod& method_of(TestKind kind);
inline const TestMethod& method_of(const TestSpec& test) { return method_of(test.kind); }

/// What files call the test: the method, or the name that the user gave his own.
inline std::string test_name(const TestSpec& test) { return test.custom.name.empty() ? name(test.kind) : test.custom.name; }

/// Whether a pressure acts on the sides of the specimen.
inline bool is_confined(const TestSpec& test) { return method_of(test).specimen.confined && test.sigma3_Pa > 0.0; }

/// Whether names of results and tables tell the pressure: of every test that must have one, and of others that have.
inline bool tells_pressure(const TestSpec& test) { return method_of(test).specimen.confined && (test.sigma3_Pa > 0.0 || !method_of(test).specimen.stands_free); }

/// What the platens do behind the strength unless the job says otherwise. @param adaptive  the numerics can change the speed at all
inline LoadControl usual_control(TestKind kind, bool adaptive) { return adaptive ? method_of(kind).loading.control : LoadControl::displacement; }

/// A test of this kind as a job has it that says nothing more, but for the control, which depends on the numerics (usual_control()).
/// @param flattened  the disc has flats, on which flat plates press
TestSpec usual_test(TestKind kind, bool flattened = false);

}  // namespace feldspar
