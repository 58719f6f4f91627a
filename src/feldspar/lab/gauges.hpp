// Strain gauges away from the platens: the least-squares linear displacement field of the grain centres in a window. And the gauges of a method or a
// user: displacements of points, strains between them, forces of fixtures.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "feldspar/model/assembly.hpp"
#include "feldspar/model/gauge_spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// What each value of a field contributes to the slopes of the least-squares plane through all of them.
struct SlopeWeights {
    std::vector<double> x, y;   ///< 1/m; sum of weight times value = slope along x, along y
};

/// Weights of a plane fitted to values at `points` (m). Costs time and memory in proportion to the points. Where the points determine no
/// plane (all in one place or on one line), the plane that is flat across what they leave open.
/// @param length_m  about the extent of the points (> 0), for scaling
SlopeWeights slope_weights(std::span<const Vec2> points, double length_m);

/// The window is the central half of the height (rows of nodes as platens), or the central circle of a quarter of the
/// disc's radius. All grains whose centre lies in it take part with equal weight.
class StrainGauge {
public:
    StrainGauge(const Assembly& assembly, const Specimen& specimen);

    /// Strain along y, compression positive.
    double axial(const Assembly& assembly) const { return -fit(assembly, weights_.y, &Vec2::y); }
    /// Strain along x, compression positive.
    double lateral(const Assembly& assembly) const { return -fit(assembly, weights_.x, &Vec2::x); }

private:
    double fit(const Assembly& assembly, const std::vector<double>& weights, double Vec2::*component) const;

    std::vector<int> centre_nodes_;
    SlopeWeights weights_;
};

/// Gauges that a method or a user has asked for, ready to be read.
class Gauges {
public:
    Gauges() = default;
    /// @throws InputError  if a point lies outside the specimen by more than a grain, or a fixture is not there
    Gauges(const Assembly& assembly, const Specimen& specimen, std::vector<GaugeSpec> specs);

    const std::vector<GaugeSpec>& specs() const { return specs_; }
    int find(std::string_view name) const { return gauge_number(specs_, name); }
    /// Of all gauges, SI.
    std::vector<double> read(const Assembly& assembly) const;

private:
    struct Term {   // of a gauge's sum: weight . displacement of a node
        std::int32_t node;
        Vec2 weight;
    };
    void add_point(const Assembly& assembly, const Specimen& specimen, const GaugeSpec& gauge, const GaugePoint& point);

    std::vector<GaugeSpec> specs_;
    std::vector<Term> terms_;
    std::vector<std::size_t> ends_;       // into terms_: behind those of each gauge
    std::vector<int> fixture_of_;         // force: into Assembly::fixtures; else -1
};

}  // namespace feldspar
