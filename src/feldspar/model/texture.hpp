// The rock on one specimen: which grain is of which mineral, and what each grain and contact is made of after all draws. Theory:
// docs/theory/heterogeneity.md.
//
// Draws depend on the seed of the specimen and on the packed discs that a contact joins, not on its number: another test on the
// same packing finds the same weak and strong places.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "feldspar/model/heterogeneity_spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// What joins two grains.
struct GrainContact {
    ContactMaterial material;
    bool inside = false;      ///< inside a crystal
    bool broken = false;      ///< it has no strength from the start
    bool weakened = false;    ///< of the initial cracks; not of broken ones
    double opening_m = 0.0;   ///< of a broken one: its faces meet when the gap has closed by it
    std::int32_t joint = -1;  ///< of the rock's joints; -1: none
};

/// Draws of a quantity, as they came out.
struct DrawSummary {
    Scattered quantity = Scattered::strength;
    int count = 0;
    double mean = 0.0, variation = 0.0, lowest = 0.0, highest = 0.0;  ///< of the factors
};

/// What a rock came to on a specimen.
struct TextureSummary {
    std::vector<int> phase_of_grain;               ///< empty: one mineral
    std::vector<std::array<Vec2, 2>> joint_edges;  ///< m, the grain edges of all joints
    std::vector<int> grains;                       ///< of each phase
    std::vector<double> area_shares;               ///< of each phase
    std::vector<SizeSummary> sizes;                ///< of the cells of each phase: diameters of circles of their areas
    std::vector<SizeSummary> disc_sizes;  ///< of the packed discs of each phase; empty unless each phase has sizes of its own
    std::vector<std::pair<std::pair<int, int>, int>> contacts;  ///< number of contacts of each pair of phases that occurs
    std::vector<DrawSummary> draws;
    int contacts_in_all = 0, inside = 0, broken = 0, weakened = 0;  ///< inside: crystals
    std::vector<int> joint_contacts;                                ///< of each joint
    std::vector<double> joint_lengths_m;                            ///< of the grain edges of each joint
};

class Texture {
public:
    /// @throws InputError  a list of phases that is not one a grain; a map that is not of the specimen's shape
    Texture(const Specimen& specimen, const GrainMaterial& grain, const ContactMaterial& contact, const Heterogeneity& rock);
    ~Texture();
    Texture(Texture&&) noexcept;

    /// Of each cell; empty: one mineral.
    const std::vector<int>& phases() const { return phases_; }
    /// With its draw.
    GrainMaterial grain(int cell) const;
    /// Of the contact on the edge between two cells.
    GrainContact contact(int cell_a, int cell_b, Vec2 from, Vec2 to) const;
    /// Contact material between two phases, or of the phase with itself, without draws.
    ContactMaterial between(int phase_a, int phase_b) const;
    /// Contact material inside a crystal of this phase; -1: of a rock of one mineral.
    ContactMaterial inside(int phase) const;
    TextureSummary summary() const;

private:
    struct Fields;

    double factor(Scattered quantity, std::uint64_t key, Vec2 place) const;
    std::uint64_t key_of(int cell_a, int cell_b) const;
    int disc_of(int cell) const;
    int unit_of(int cell) const;  // its crystal, else its disc
    void give_phases();

    const Specimen* specimen_;
    GrainMaterial grain_;
    ContactMaterial contact_;
    const Heterogeneity* rock_;
    std::vector<int> phases_;
    std::unique_ptr<Fields> fields_;  // random fields and traces of joints
};

/// Elastic constants, density and contact of a rock in the mean, by which estimates reckon: Hill's mean of the minerals.
GrainMaterial mean_grain(const MineralSpec& minerals, const GrainMaterial& without_minerals);

/// The factor at a probability u in (0, 1): inverse of the distribution function, between its cut-offs.
double factor_at(const Distribution& distribution, double u);

/// The Weibull modulus of a coefficient of variation.
double weibull_modulus_of(double variation);

}  // namespace feldspar
