// What makes the grains and contacts of a rock differ from each other: minerals, scatter, discontinuities. Plain data in SI, a
// part of what the user asks.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "feldspar/base/vec2.hpp"
#include "feldspar/model/spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

// ----------------------------------------------------------------------------------------------------------------------- scatter

enum class DistributionKind { none, weibull, log_normal, normal };

inline constexpr std::array distribution_kinds{DistributionKind::weibull, DistributionKind::log_normal, DistributionKind::normal};

inline const char* name(DistributionKind kind) {
    switch (kind) {
        case DistributionKind::none:
            return "none";
        case DistributionKind::weibull:
            return "weibull";
        case DistributionKind::log_normal:
            return "log-normal";
        case DistributionKind::normal:
            return "normal";
    }
    return "?";
}

/// Distribution of a factor whose mean is 1 before its ends are cut off.
struct Distribution {
    DistributionKind kind = DistributionKind::none;
    double weibull_modulus = 0.0;                              ///< weibull
    double variation = 0.0;                                    ///< log-normal, normal: coefficient of variation
    double lowest = 0.0;                                       ///< factors lie from here ...
    double highest = std::numeric_limits<double>::infinity();  ///< ... to there: the distribution is cut off at both ends
    double correlation_length_m = 0.0;  ///< 0: independent; else draws this far apart are correlated by exp(-1/2)

    bool scatters() const { return kind != DistributionKind::none; }
    bool operator==(const Distribution&) const = default;
};

/// What may scatter. Strength and stiffness stand for two quantities that move together.
enum class Scattered { strength, sigma_nt, tau, stiffness, Kn, Ks, mu, Gfn, Gfs, E };

inline constexpr std::array scattered_quantities{Scattered::strength, Scattered::sigma_nt, Scattered::tau, Scattered::stiffness,
                                                 Scattered::Kn,       Scattered::Ks,       Scattered::mu,  Scattered::Gfn,
                                                 Scattered::Gfs,      Scattered::E};

inline const char* name(Scattered quantity) {
    switch (quantity) {
        case Scattered::strength:
            return "strength";
        case Scattered::sigma_nt:
            return "sigma_nt";
        case Scattered::tau:
            return "tau";
        case Scattered::stiffness:
            return "stiffness";
        case Scattered::Kn:
            return "Kn";
        case Scattered::Ks:
            return "Ks";
        case Scattered::mu:
            return "mu";
        case Scattered::Gfn:
            return "Gfn";
        case Scattered::Gfs:
            return "Gfs";
        case Scattered::E:
            return "E";
    }
    return "?";
}

struct ScatterSpec {
    std::array<Distribution, scattered_quantities.size()> of{};  ///< of each quantity, in the order of scattered_quantities
    double energy_power = 2.0;  ///< a fracture energy goes with the factor of its strength to this power

    Distribution& operator[](Scattered quantity) { return of[static_cast<std::size_t>(quantity)]; }
    const Distribution& operator[](Scattered quantity) const { return of[static_cast<std::size_t>(quantity)]; }
    bool any() const {
        for (const Distribution& one : of)
            if (one.scatters()) return true;
        return false;
    }
};

// ---------------------------------------------------------------------------------------------------------------------- minerals

/// A mineral.
struct Mineral {
    std::string name;
    double share = 0.0;  ///< of the area, 0 ... 1; all add up to 1
    GrainMaterial grain;
    std::uint32_t colour = 0;  ///< 0xRRGGBB, in pictures and in a map
    int value = -1;            ///< of its pixels in a grey map, 0 ... 255; -1: they have its colour
    std::optional<GrainSizeSpec>
        sizes{};  ///< of its grains, as given; absent: those of [specimen.grains]. What counts is SpecimenSpec::phase_sizes
};

/// What of a contact material a pair of phases has of its own.
struct ContactChanges {
    std::optional<double> Kn_Pa_m, eta, sigma_nt_Pa, tau_Pa, mu, Gfn_J_m2, Gfs_J_m2;

    bool any() const { return Kn_Pa_m || eta || sigma_nt_Pa || tau_Pa || mu || Gfn_J_m2 || Gfs_J_m2; }
    /// The material with these changes.
    ContactMaterial over(ContactMaterial material) const;
};

struct PhasePair {
    int a = 0, b = 0;        ///< phases
    ContactChanges changes;  ///< of [material.contact]; inside crystals on top of Heterogeneity::crystal
    bool inside = false;     ///< inside crystals of phase a
};

/// The contact of two unlike phases that have no law of their own as a pair, by those of the like ones.
enum class UnlikeRule { weaker, mean, given };

inline constexpr std::array unlike_rules{UnlikeRule::weaker, UnlikeRule::mean, UnlikeRule::given};

inline const char* name(UnlikeRule rule) {
    switch (rule) {
        case UnlikeRule::weaker:
            return "weaker";
        case UnlikeRule::mean:
            return "mean";
        case UnlikeRule::given:
            return "given";
    }
    return "?";
}

/// Which grain is of which phase, given.
struct PhaseMap {
    int width = 0, height = 0;       ///< pixels
    std::vector<std::int8_t> phase;  ///< row by row from the top, left to right; -1: none
};

struct MineralSpec {
    std::vector<Mineral> phases;  ///< empty: one mineral
    std::vector<PhasePair> pairs;
    UnlikeRule unlike = UnlikeRule::weaker;
    double unlike_strength = 1.0;         ///< multiplies strengths and fracture energies of unlike pairs that follow the rule
    double cluster_length_m = 0.0;        ///< grains of a phase lie together over this length; 0: at random
    std::shared_ptr<const PhaseMap> map;  ///< none: not given
    std::string map_file;                 ///< absolute, where it came from
    std::vector<int> list;                ///< phase of each packed disc; empty: not given
    std::string list_file;                ///< absolute, where it came from
};

// --------------------------------------------------------------------------------------------------------------------------- all

/// A part of the contacts that is not whole before the test.
struct InitialCracks {
    double broken = 0.0;             ///< share of the contacts that have no strength, by number
    double opening_m = 0.0;          ///< of these: their faces meet when the gap has closed by it
    double weakened = 0.0;           ///< share of the contacts whose strengths are multiplied ...
    double weakened_strength = 1.0;  ///< ... by this, and their fracture energies by its power (ScatterSpec)

    bool any() const { return broken > 0.0 || weakened > 0.0; }
};

/// Parallel traces that are drawn from the seed.
struct JointSet {
    double dip_rad = 0.0;            ///< from x, counter-clockwise
    double dip_deviation_rad = 0.0;  ///< standard deviation from trace to trace
    double spacing_m = 0.0;          ///< mean distance of neighbouring traces
    double spacing_variation = 0.0;  ///< coefficient of variation of the spacings, 0 ... 1 (negative exponential: 1)
    double length_m = 0.0;           ///< mean length of a trace; 0: through the whole specimen
    double length_variation = 0.0;   ///< coefficient of variation of the lengths
    double persistence = 1.0;        ///< share of its line that traces take up
};

/// A discontinuity: joint, bedding plane, crack.
struct JointSpec {
    std::string name;
    std::vector<std::vector<Vec2>> lines_m;  ///< polylines; empty: a set
    std::string file, unit, layer;           ///< absolute, where they came from; empty: from the job
    std::string cut;                         ///< label of a joined cut, whose faces it is; empty: it runs along grain edges
    std::optional<JointSet> set;
    ContactMaterial contact;       ///< of the joint; no strength: it is open to sliding from the start
    double opening_m = 0.0;        ///< its faces meet when the gap has closed by it
    double dilation = 0.0;         ///< tan psi: it opens by so much of its slip ...
    double dilation_slip_m = 0.0;  ///< ... until it has slipped so far

    bool without_strength() const { return contact.sigma_nt_Pa == 0.0 && contact.tau_Pa == 0.0; }
};

struct Heterogeneity {
    MineralSpec minerals;
    ContactChanges crystal;  ///< contacts inside crystals, against the others
    ScatterSpec scatter;
    InitialCracks initial_cracks;
    std::vector<JointSpec> joints;
    std::string files;                 ///< hashes of all files that were read, for the identity of a run
    std::vector<std::string> remarks;  ///< on what was read, in sentences: what a file has that no joint takes

    /// Contacts differ from each other.
    bool contacts_differ() const;
    /// Grains have elastic constants that differ.
    bool grains_differ() const { return !minerals.phases.empty() || scatter[Scattered::E].scatters(); }
    bool any() const { return contacts_differ() || grains_differ(); }
};

inline bool Heterogeneity::contacts_differ() const {
    for (const Scattered quantity : scattered_quantities)
        if (quantity != Scattered::E && scatter[quantity].scatters()) return true;
    return !minerals.phases.empty() || crystal.any() || initial_cracks.any() || !joints.empty();
}

inline ContactMaterial ContactChanges::over(ContactMaterial m) const {
    m.Kn_Pa_m = Kn_Pa_m.value_or(m.Kn_Pa_m);
    m.eta = eta.value_or(m.eta);
    m.sigma_nt_Pa = sigma_nt_Pa.value_or(m.sigma_nt_Pa);
    m.tau_Pa = tau_Pa.value_or(m.tau_Pa);
    m.mu = mu.value_or(m.mu);
    m.Gfn_J_m2 = Gfn_J_m2.value_or(m.Gfn_J_m2);
    m.Gfs_J_m2 = Gfs_J_m2.value_or(m.Gfs_J_m2);
    return m;
}

}  // namespace feldspar
