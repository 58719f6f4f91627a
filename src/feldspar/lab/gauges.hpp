// Strain gauges away from the platens: the least-squares linear displacement field of the grain centres in a window.
#pragma once

#include <vector>

#include "feldspar/model/assembly.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// The window is the central half of the height (rows of nodes as platens), or the central circle of a quarter of the
/// disc's radius. All grains whose centre lies in it take part with equal weight.
class StrainGauge {
public:
    StrainGauge(const Assembly& assembly, const Specimen& specimen);

    /// Strain along y, compression positive.
    double axial(const Assembly& assembly) const { return -fit(assembly, axial_weights_, &Vec2::y); }
    /// Strain along x, compression positive.
    double lateral(const Assembly& assembly) const { return -fit(assembly, lateral_weights_, &Vec2::x); }

private:
    double fit(const Assembly& assembly, const std::vector<double>& weights, double Vec2::*component) const;

    std::vector<int> centre_nodes_;
    std::vector<double> axial_weights_;
    std::vector<double> lateral_weights_;
};

}  // namespace feldspar
