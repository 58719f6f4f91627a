// What is read on a specimen beside its load and its loading motion, as plain data.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// A point of the specimen whose displacement a gauge reads.
struct GaugePoint {
    Vec2 at;       ///< m, undeformed; the cell nearest to it carries the point
    Vec2 weight;   ///< of the displacement, component by component: a pure number, or 1/m for a strain
};

enum class GaugeKind {
    displacement,   ///< m: weighted displacements of points, such as the opening of a notch's mouth
    strain,         ///< a pure number: the same with weights per length
    force           ///< N: what a fixture feels of the specimen, along a direction
};

/// One gauge. Its value is zero in the unloaded specimen.
struct GaugeSpec {
    std::string name;                  ///< letters, digits, "_" and "-": "CMOD"
    std::string meaning;               ///< one sentence for the reader of a record
    GaugeKind kind = GaugeKind::displacement;
    std::vector<GaugePoint> points;    ///< displacement, strain: the value is the sum of weight . displacement
    std::string fixture;               ///< force: the fixture's name
    Vec2 direction{};                  ///< force: unit vector
};

/// The number of the gauge of this name, or -1.
inline int gauge_number(std::span<const GaugeSpec> gauges, std::string_view name) {
    for (std::size_t g = 0; g < gauges.size(); ++g)
        if (gauges[g].name == name) return static_cast<int>(g);
    return -1;
}

}  // namespace feldspar
