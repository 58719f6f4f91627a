// Strain gauges away from the platens: the least-squares linear displacement field of the grain centres in a window. And the
// gauges of a method or a user: displacements of points, strains between them, forces of fixtures, means of stress and strain
// over a region, energies.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "feldspar/lab/stress_fields.hpp"
#include "feldspar/methods/result.hpp"
#include "feldspar/model/assembly.hpp"
#include "feldspar/model/gauge_spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// What each value of a field contributes to the slopes of the least-squares plane through all of them.
struct SlopeWeights {
    std::vector<double> x, y;  ///< 1/m; sum of weight times value = slope along x, along y
};

/// Weights of a plane fitted to values at `points` (m). Costs time and memory in proportion to the points. Where the points
/// determine no plane (all in one place or on one line), the plane that is flat across what they leave open.
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
    /// @param specimen  which must outlive the gauges
    /// @throws InputError  if a point lies outside the specimen by more than a grain, a fixture is not there, or a region has too
    /// little rock
    Gauges(const Assembly& assembly, const Specimen& specimen, std::vector<GaugeSpec> specs);

    const std::vector<GaugeSpec>& specs() const { return specs_; }
    int find(std::string_view name) const { return gauge_number(specs_, name); }
    /// Of all gauges, SI. @param energy  of the same moment, which gauges of energies read
    std::vector<double> read(const Assembly& assembly, const EnergyLedger& energy = {}) const;
    /// Sets the readings of energies alone.
    void read_energies(const EnergyLedger& energy, std::span<double> values) const;

private:
    struct Term {  // of a gauge's sum: weight . displacement of a node
        std::int32_t node;
        Vec2 weight;
    };
    void add_point(const Assembly& assembly, const Specimen& specimen, const GaugeSpec& gauge, const GaugePoint& point);
    void add_mean_stress(const Assembly& assembly, const GrainMesh& mesh, const GaugeSpec& gauge);
    void add_mean_strain(const Assembly& assembly, const GaugeSpec& gauge);
    void add_hole_stress(const Assembly& assembly, const GrainMesh& mesh, const GaugeSpec& gauge);
    void add_stress(const Assembly& assembly, const GrainMesh& mesh, std::vector<StressTerm> terms);
    double stress_sum(const Assembly& assembly, std::size_t begin, std::size_t end, std::span<const Mat2> of_grains) const;

    std::vector<GaugeSpec> specs_;
    std::vector<Term> terms_;
    std::vector<StressTerm> stress_terms_;  // of triangles; of other grains than flexible ones, of the sums of (P42)
    std::vector<std::size_t> ends_;         // into terms_: behind those of each gauge
    std::vector<std::size_t> stress_ends_;  // likewise into stress_terms_
    std::vector<int> fixture_of_;           // force: into Assembly::fixtures; else -1
    const GrainMesh* mesh_ = nullptr;
};

}  // namespace feldspar
