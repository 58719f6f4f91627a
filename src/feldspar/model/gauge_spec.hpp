// What is read on a specimen beside its load and its loading motion, as plain data.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// A point of the specimen whose displacement a gauge reads.
struct GaugePoint {
    Vec2 at;      ///< m, undeformed; the cell nearest to it carries the point
    Vec2 weight;  ///< of the displacement, component by component: a pure number, or 1/m for a strain
};

enum class GaugeKind {
    displacement,  ///< m: weighted displacements of points, such as the opening of a notch's mouth
    strain,        ///< a pure number: the same with weights per length
    force,         ///< N: what a fixture feels of the specimen, along a direction
    mean_stress,   ///< Pa: a component of the stress, mean over the rock in a region; compression positive
    mean_strain,   ///< a pure number: a component of the strain in a region, openings of contacts included; compression positive
    hole_stress,   ///< Pa: along the edge of a round hole, from the elastic field around it; compression positive
    energy         ///< J: a term of the test's energy balance
};

/// A part of the plane: a box with two opposite corners, or a circle.
struct GaugeRegion {
    Vec2 a, b;              ///< m, undeformed: box: its corners; circle: its centre and nothing
    double radius_m = 0.0;  ///< of a circle; 0: a box

    bool operator==(const GaugeRegion&) const = default;
};

/// Terms of the energy balance (theory/loading.md, (L6)).
enum class EnergyTerm { supplied, elastic, fracture, friction, damping, kinetic };

/// One gauge. Its value is zero in the unloaded specimen.
struct GaugeSpec {
    std::string name;     ///< letters, digits, "_" and "-": "CMOD"
    std::string meaning;  ///< one sentence for the reader of a record
    GaugeKind kind = GaugeKind::displacement;
    std::vector<GaugePoint> points;  ///< displacement, strain: the value is the sum of weight . displacement; hole stress: where
                                     ///< on the edge, the mean of all, weights do not count
    std::string fixture;             ///< force: the fixture's name; displacement without points: that of this fixture, a plate
    Vec2 direction{};                ///< force, displacement of a fixture, mean stress and strain: unit vector
    Vec2 normal{};  ///< mean stress and strain: unit normal of the plane on which the component along `direction` is read; zero:
                    ///< `direction`
    GaugeRegion region{};                   ///< mean stress and strain; hole stress: the hole, a circle
    EnergyTerm term = EnergyTerm::elastic;  ///< energy
};

inline constexpr std::array energy_terms{EnergyTerm::supplied, EnergyTerm::elastic, EnergyTerm::fracture,
                                         EnergyTerm::friction, EnergyTerm::damping, EnergyTerm::kinetic};
inline const char* name(EnergyTerm term) {
    switch (term) {
        case EnergyTerm::supplied:
            return "supplied";
        case EnergyTerm::elastic:
            return "elastic";
        case EnergyTerm::fracture:
            return "fracture";
        case EnergyTerm::friction:
            return "friction";
        case EnergyTerm::damping:
            return "damping";
        case EnergyTerm::kinetic:
            return "kinetic";
    }
    return "?";
}

/// The number of the gauge of this name, or -1.
inline int gauge_number(std::span<const GaugeSpec> gauges, std::string_view name) {
    for (std::size_t g = 0; g < gauges.size(); ++g)
        if (gauges[g].name == name) return static_cast<int>(g);
    return -1;
}

}  // namespace feldspar
