// A test method: everything that makes a uniaxial compression test what it is, and not a Brazilian one, as data. One file a
// method; the rest of the program reads these facts and asks for no method by name.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "feldspar/base/quantity_unit.hpp"
#include "feldspar/base/range.hpp"
#include "feldspar/methods/result.hpp"
#include "feldspar/methods/test_spec.hpp"
#include "feldspar/model/fixture_spec.hpp"
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

/// How a test is built: its fixtures, and what turns force and motion into stress and strain. Functions of the specimen and the
/// test alone.
struct MethodBuild {
    std::vector<FixtureSpec> (*fixtures)(const MethodInput&) = nullptr;
    double (*length_m)(const MethodInput&) = nullptr;    ///< strain = loading motion / length
    double (*section_m2)(const MethodInput&) = nullptr;  ///< stress = load / section
    std::vector<GaugeSpec> (*gauges)(const MethodInput&) =
        nullptr;                                 ///< none: no gauges but those of the strain in the specimen's middle
    std::span<const char* const> gauge_names{};  ///< that it may have
    void (*check)(const Outline&, double thickness_m, const TestSpec&) =
        nullptr;  ///< throws InputError if the specimen is none for the test; none: it stands between platens
    std::vector<StageGroup> (*stages)(const TestSpec&) =
        nullptr;  ///< of the loading; none: those that the job gives, if it gives any
};

/// What results and pages call things.
struct MethodWords {
    const char* title;   ///< "Uniaxial compression"
    const char* stress;  ///< what the stress is: "Axial stress"
    const char* strain;  ///< what the strain is: "Axial strain from the platens"
};

/// What is known of the elastic answer to the loading before it is computed.
struct MethodStart {
    bool strained_evenly = true;  ///< about the same strain everywhere: a first guess; else only the fixtures move at first
    bool stays_in_touch = true;   ///< the answer is in proportion to the loading; else contacts at plates close on the way
    bool time_of_mode = false;    ///< the time that rates are measured in is the loading mode's; else a wave's over the length
};

/// What is read from the record of a test, beside the properties that the method adds.
enum class Reading {
    column,  ///< moduli, Poisson's ratio, thresholds and the branch behind the peak of a specimen that is strained evenly
    disc,    ///< how a disc was split
    stages,  ///< the strength at each of the pressures that one specimen went through
    hole,    ///< stresses, cracks and breakouts at the edge of a round hole
    curve    ///< the largest load alone
};

enum class MethodKeyForm {
    quantity,  ///< text: a number with its unit
    number,    ///< a plain number
    share,     ///< a plain number, or text with a percent sign
    whole      ///< a whole number
};

/// A key that the method adds to [[test]].
struct MethodKey {
    std::string_view name;
    MethodKeyForm form = MethodKeyForm::quantity;
    Dimension dimension = Dimension::fraction;  ///< of a quantity
    Range range = positive;
    const char* usual = "";          ///< in words, what holds without it; or
    std::optional<double> value{};   ///< the value that holds then
    const char* meaning = "";        ///< one sentence in Markdown, without the full stop
    bool needed = false;             ///< the test must give it
    bool list = false;               ///< of quantities: one or a list
    std::string_view in_place_of{};  ///< another key of the method, which is refused beside it
};

/// The record of a test, and its largest load.
struct MethodReading {
    const TestResult& result;
    std::size_t peak_row = 0;  ///< in TestResult::history
    double peak_Pa = 0.0;      ///< > 0
    bool peak_reached = false;
};

/// A number that the method adds to those that every test has.
struct MethodProperty {
    std::string_view name;  ///< without unit: "K_Ic"; what two methods give the same name means the same
    QuantityUnit unit;
    std::string_view definition;  ///< "(P38)": where docs/theory/properties.md defines it; empty for what needs no formula
    double (*value)(const MethodReading&) = nullptr;  ///< as it is kept; not-a-number where the record does not define it
    const char* label = "";                           ///< "Fracture toughness, notched three-point bending"
    const char* symbol = "";  ///< of a property of the rock, which tables and reports show over the packings; empty: it is none
    std::string_view laboratory{};  ///< the key of a job's [laboratory] that it compares with; empty without one
    std::string_view of_rock{};     ///< its name as a property of the rock; empty: the same
};

/// The strength that a method measures, as a property of the rock.
struct MethodStrength {
    std::string_view name{};  ///< "UCS"; empty: its largest stress is no property of the rock
    const char* label = "";
    std::string_view symbol{};      ///< empty: the name
    std::string_view laboratory{};  ///< the key of a job's [laboratory] that it compares with; empty: the name
};

/// What `feldspar new` writes.
struct MethodTemplate {
    const char* title = "";              ///< "A Brazilian test."
    const char* gives = "";              ///< what stands beside its kind
    const char* keys = "";               ///< lines of its own, behind the kind; those of every test follow
    const char* tables = "";             ///< what stands behind its [[test]]
    const char* shape = "";              ///< the line of the specimen's shape, if not that of an upright specimen
    const char* width = "";              ///< the same of its width,
    const char* height = "";             ///< and of its height
    const TestMethod* behind = nullptr;  ///< another test that stands before it
};

/// What the specimen is, and what touches it.
struct MethodSpecimen {
    bool own_disc = false;  ///< a disc that the test cuts itself and presses between two plates; else the job's specimen, between
                            ///< platens at its ends
    bool confined = false;  ///< a pressure sigma3 on the sides (and first on all sides), which the job gives
    bool sheared = false;   ///< along a plane, under a normal stress that the job gives
    bool stands_free = false;  ///< confined, but a job may leave the pressure out
    bool glued = false;        ///< the ends are glued to the platens; else they may slide and come off
    double plate_mu = 0.0;     ///< friction of plates, unless the job gives another
    bool plates = false;       ///< plates or rollers load it whatever its grains are; else only rigid grains and inner particles
    bool fixtures_of_job = false;  ///< the job itself gives its fixtures, gauges and name
};

/// How it is loaded, and what is then known of it.
struct MethodLoading {
    double sign = 1.0;                                ///< of the axial stress that loads: 1 compression, -1 tension
    LoadControl control = LoadControl::displacement;  ///< behind the strength, unless the job gives another
    double stop_fraction = 0.8;                       ///< of the peak, at which the test ends unless the job gives another
    bool widens = false;       ///< the specimen widens as it fails: the lateral strain can control the test, and tells of damage
    bool bends = false;        ///< a column that may bend aside before it breaks (Euler)
    bool tensile = false;      ///< the strength is a tensile one
    bool on_envelope = false;  ///< the strength is a point of the strength envelope, at the confining pressure of the test
    /// Principal stresses at the strength, where they are known: sigma3 and sigma1 as multiples of it, and sigma3 with the
    /// confining pressure.
    std::optional<std::array<double, 2>> failure_state{};
};

/// Constants of the adaptive numerics, measured (docs/validation, true strengths).
struct MethodRate {
    double residual_target = 1.0;      ///< R* with which the strength is first looked for, over the wanted accuracy
    double residual_share = 2.0;       ///< error of the strength over R* of the typical body, w of (L8)
    double travel_times = 60.0;        ///< that a test usually takes at the usual accuracy, in times of a wave
    double seconds = 4.0;              ///< that it takes with 1000 flexible grains, on a slow core
    double fixed_speed_strain = 6e-3;  ///< to which a test at a fixed speed usually goes
};

/// What the verdict allows (L9), relative.
struct MethodVerdict {
    double error_a = 5e-3;                          ///< estimated error of the strength, grade A; grade B: grade_b_error
    double imbalance_a = 1e-2, imbalance_b = 2e-2;  ///< mean difference of the platens over their mean
};

struct TestMethod {
    const char* name;     ///< as jobs and files call it: "uniaxial-compression"
    const char* purpose;  ///< one sentence
    MethodWords words;
    MethodBuild build;
    MethodStart start;
    Reading reading;
    MethodSpecimen specimen;
    MethodLoading loading;
    MethodRate rate;
    MethodVerdict verdict;
    MethodStrength strength{};
    const char* properties_table = "";  ///< what summary.json calls the table of these:
    std::span<const MethodProperty> properties{};
    std::vector<std::string> (*remarks)(const MethodReading&) = nullptr;  ///< sentences that a reader of the numbers must know
    std::span<const MethodKey> keys{};
    MethodTemplate job{};

    struct OnlyOne {  // a definition is one object, known by its address
        OnlyOne() = default;
        OnlyOne(const OnlyOne&) = delete;
    } only_one{};
};

/// All methods, in the order in which users are told.
std::span<const MethodId> test_methods();

/// The method that files call so; none if there is no such method.
std::optional<MethodId> find_method(std::string_view name);

/// The same by its name or by the short name of the strength that it gives, such as UCS, DTS or BTS, in capitals or not: what
/// people type on a command line.
std::optional<MethodId> find_method_called(std::string_view word);
/// All short names, in the order of the methods.
std::vector<std::string_view> short_method_names();

/// The method that measures the strength of this name ("UCS"), which must exist.
MethodId method_of_strength(std::string_view name);

/// The method that gives the points of the strength envelope under a confining pressure.
MethodId method_of_confined_strength();

/// The facts of a method.
inline const TestMethod& method_of(MethodId id) { return id.definition(); }
inline const TestMethod& method_of(const TestSpec& test) { return test.kind.definition(); }

/// What files call the test: the method, or the name that the user gave his own.
inline std::string test_name(const TestSpec& test) { return test.custom.name.empty() ? name(test.kind) : test.custom.name; }

/// The stages that a test goes through; empty: it loads until its stop rule ends it.
std::vector<StageGroup> stages_of(const TestSpec& test);

/// Whether a pressure acts on the sides of the specimen.
inline bool is_confined(const TestSpec& test) { return method_of(test).specimen.confined && test.sigma3_Pa > 0.0; }

/// Whether names of results and tables tell the pressure: of every test that must have one, and of others that have.
inline bool tells_pressure(const TestSpec& test) {
    const MethodSpecimen& specimen = method_of(test).specimen;
    return specimen.sheared || (specimen.confined && (test.sigma3_Pa > 0.0 || !specimen.stands_free));
}

/// The key of [[test]] that gives this pressure, of a method that has one.
inline const char* pressure_key(const TestMethod& method) { return method.specimen.sheared ? "normal_stress" : "sigma3"; }

/// The same as people write it.
inline const char* pressure_symbol(const TestMethod& method) {
    return method.specimen.sheared ? "\u03c3n" : method.specimen.confined ? "\u03c3\u2083" : "";
}

/// What the platens do behind the strength unless the job says otherwise. @param adaptive  the numerics can change the speed at
/// all
inline LoadControl usual_control(MethodId kind, bool adaptive) {
    return adaptive ? method_of(kind).loading.control : LoadControl::displacement;
}

/// A test of this kind as a job has it that says nothing more, but for the control, which depends on the numerics
/// (usual_control()).
/// @param flattened  the disc has flats, on which flat plates press
TestSpec usual_test(MethodId kind, bool flattened = false);

}  // namespace feldspar
