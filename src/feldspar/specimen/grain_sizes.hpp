// Distributions of grain diameters: moments and random samples.
#pragma once

#include <vector>

#include "feldspar/base/rng.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Moments of the distribution by NUMBER of grains.
struct DiameterMoments {
    double mean_m = 0.0;          ///< E[d]
    double mean_square_m2 = 0.0;  ///< E[d^2]
};

/// @throws InputError naming the key, for bounds that are not positive or not ordered, a standard deviation that is not
///         positive, a truncation that leaves nothing, or a sieve curve that does not rise from 0 to 1
void check_grain_sizes(const GrainSizeSpec& spec);

/// Moments in closed form.
///   uniform     E[d] = (a + b) / 2, E[d^2] = (a^2 + a b + b^2) / 3
///   log-normal  truncated to [a, b]: E[d^k] = m^k exp(k^2 s^2 / 2) (Phi(B - k s) - Phi(A - k s)) / (Phi(B) - Phi(A)), with
///               median m, s the standard deviation of ln d, A = ln(a/m)/s, B = ln(b/m)/s
///   sieve       passing (area fraction) is linear in ln d between points, so the number density in an interval is
///               proportional to d^-3
DiameterMoments diameter_moments(const GrainSizeSpec& spec);

/// The diameter that the number of grains N = (1 - porosity) A / (pi d^2 / 4) is counted with: the mean for a uniform
/// distribution (so the published specimens have exactly 1630 and 640 grains), else the root mean square, with which the
/// area of the discs is (1 - porosity) A on average.
double counting_diameter(const GrainSizeSpec& spec);

/// The smallest diameter that all grains of a sieve curve pass (m): points behind it hold no grains.
double largest_of_sieve_m(const std::vector<SievePoint>& sieve);

/// Draws `count` diameters (m) in the stream's order, by inversion of the distribution function: one uniform number each.
/// Sieve fractions are of area: the share of the area in grains finer than d follows the curve.
/// Of a wide distribution a few large grains decide the area. Where the sample's area misses that of the distribution by more
/// than a tenth, another is taken: one grain of each of `count` equal parts of the distribution.
std::vector<double> sample_diameters(const GrainSizeSpec& spec, int count, RandomStream& random);

/// The smallest and the largest diameter (m) of a distribution.
double smallest_of(const GrainSizeSpec& spec);
double largest_of(const GrainSizeSpec& spec);

/// Sizes of circles, from their diameters; of none all are 0.
SizeSummary summary_of(std::vector<double> diameters);

/// Grains of minerals that have sizes of their own.
struct PhasedDiameters {
    std::vector<double> diameters_m;
    std::vector<int> phases;  ///< of each
};

/// How many grains each mineral has in a packing of this area (docs/theory/heterogeneity.md, H7 and H8). The cells fill the
/// plane: each has, beside its disc, a film around it, which is wider around small grains. The counts are such that the cells,
/// not the discs, have the shares.
/// @throws InputError  shares that do not add up to 1; what check_grain_sizes refuses
std::vector<int> grains_of_phases(const std::vector<PhaseSizes>& phases, double area_m2, double porosity);

/// One grain of each of `count` equal parts of the distribution, for each mineral: so the area of a mineral does not depend on a
/// few large grains.
PhasedDiameters sample_by_phase(const std::vector<PhaseSizes>& phases, const std::vector<int>& counts, RandomStream& random);

/// What the grains of a mineral with sizes of its own have come to.
struct PhaseFill {
    int grains = 0;
    double area_share = 0.0;   ///< of the cells
    SizeSummary discs, cells;  ///< as they were packed; diameters of circles of the cells' areas
};

/// Of each mineral; none where sizes belong to no mineral.
std::vector<PhaseFill> fill_of_phases(const Specimen& specimen);

/// The distribution of all grains together, as a sieve curve of discs by area: by which grains are judged that are not drawn from
/// it. To a percent.
GrainSizeSpec mixture_of(const std::vector<PhaseSizes>& phases, double porosity);

}  // namespace feldspar
