// Strain gauges away from the platens: the least-squares linear displacement field of the grain centres in a window.
#pragma once

#include <span>
#include <vector>

#include "feldspar/model/assembly.hpp"
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

}  // namespace feldspar
