// What the user asks of a test, as plain data in SI.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "feldspar/model/fixture_spec.hpp"
#include "feldspar/model/gauge_spec.hpp"
#include "feldspar/model/spec.hpp"
#include "feldspar/model/stage_spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

enum class PlateShape { flat, curved };  ///< of the plates of a Brazilian test; curved: the jaws of ISRM

/// What the loading keeps constant behind the strength: its own speed, the growth of the lateral strain, of the dissipated
/// energy, or of a gauge.
enum class LoadControl { displacement, lateral_strain, dissipation, gauge };

/// A test of the user's own: what loads and holds the specimen, and what is read.
struct CustomTest {
    std::string name;                   ///< names its results, as a test method's name does
    std::vector<FixtureSpec> fixtures;  ///< plates with a stiffness of 0 have that of the test
    std::vector<GaugeSpec> gauges;
    std::optional<double> length_m;  ///< strain = loading motion / length; default: the extent of the specimen along the loading
    std::optional<double> width_m;   ///< stress = load / (width x thickness); default: its extent across
    Vec2 gravity_m_s2{};             ///< acceleration of all grains before and during the loading
};

/// Ends a test when a gauge has reached a value, upwards or downwards.
struct GaugeStop {
    std::string gauge;
    double value = 0.0;  ///< SI
};

struct TestMethod;

/// Which test method a test follows: one of the list (test_methods(), method.hpp). Copied freely; ordered as the list is.
class MethodId {
public:
    MethodId(const TestMethod& method) : method_(&method) {}  // a definition names itself: `MethodId kind = methods::brazilian`
    const TestMethod& definition() const { return *method_; }

    friend bool operator==(MethodId a, MethodId b) { return a.method_ == b.method_; }
    friend std::strong_ordering operator<=>(MethodId a, MethodId b) { return place(a) <=> place(b); }

private:
    static std::size_t place(MethodId id);  // in the list

    const TestMethod* method_;
};

/// What files call the method: "uniaxial-compression".
const char* name(MethodId method);

/// One definition a file, named as jobs name the method.
namespace methods {
#define FELDSPAR_METHOD(definition) extern const TestMethod definition;
#include "feldspar/methods/list.inc"
#undef FELDSPAR_METHOD
}  // namespace methods

struct TestSpec {
    MethodId kind = methods::uniaxial_compression;
    double sigma3_Pa = 0.0;                           ///< pressure on the sides; direct shear: the normal stress
    double stop_fraction = 0.8;                       ///< the test ends when the stress has fallen to this fraction of the peak
    LoadControl control = LoadControl::displacement;  ///< behind the strength; jobs: that of the method unless said; lateral
                                                      ///< strain: compression only
    double maximum_strain = 0.05;                     ///< ... or at this axial strain (Brazilian: platen displacement / diameter)
    std::optional<double> maximum_stress_Pa;  ///< ... or when the stress has reached this, a positive magnitude (biaxial: sigma1)
    PlateShape plates = PlateShape::flat;     ///< Brazilian only
    double jaw_radius = 1.5;                  ///< of curved plates, over the radius of the disc; more than 1
    double plate_stiffness_factor = 1.0;      ///< plates: their Kn as a multiple of the contacts' Kn
    std::optional<double> plate_Kn_Pa_m;      ///< plates: their Kn itself, as of a bearing strip; in place of the factor
    std::optional<double> plate_mu;           ///< plates: friction; default 0.4 in the Brazilian test, else 0
    int membrane_plates = 16;                 ///< biaxial, rigid and inner particles: plates of the membrane on each side
    int snapshots = 8;                        ///< fields kept between the first crack and the end, besides start, peak and end
    std::vector<unsigned long long> seeds;    ///< the seeds of this test; empty = those of the run
    std::map<std::string, std::vector<double>, std::less<>>
        own;                    ///< values of keys that the method adds (MethodKey), SI; a job has those with a default too
    std::string control_gauge;  ///< LoadControl::gauge: the gauge that controls
    std::optional<GaugeStop> stop_gauge;  ///< ends the test
    std::optional<SpecimenSpec>
        specimen;  ///< its own, of the same grains: a disc that the method cuts, or what the job gives; else the job's
    std::vector<StageGroup>
        stages;  ///< custom only: what the loading does, in order; empty: it loads until the test ends. All methods': stages_of()
    std::vector<double> later_sigma3_Pa;  ///< multi-stage: the pressures after sigma3_Pa, each larger than the one before
    CustomTest custom;                    ///< of methods whose fixtures the job gives

    /// The value of a key of the method's own, if the job gives it.
    std::optional<double> own_value(std::string_view key) const {
        const auto found = own.find(key);
        return found == own.end() || found->second.empty() ? std::nullopt : std::optional(found->second.front());
    }
};

// All values of each, in the order in which users are told; name() is how files call them.
inline constexpr std::array plate_shapes{PlateShape::flat, PlateShape::curved};
inline constexpr std::array load_controls{LoadControl::displacement, LoadControl::lateral_strain,
                                          LoadControl::dissipation};  // and gauges, by their names

inline const char* name(LoadControl control) {
    switch (control) {
        case LoadControl::displacement:
            return "displacement";
        case LoadControl::lateral_strain:
            return "lateral-strain";
        case LoadControl::dissipation:
            return "dissipation";
        case LoadControl::gauge:
            return "gauge";
    }
    return "?";
}
inline const char* name(PlateShape shape) { return shape == PlateShape::flat ? "flat" : "curved"; }

}  // namespace feldspar
