// Rocks whose grains and contacts differ: layers of minerals, chains of contacts that scatter.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "feldspar/model/texture.hpp"
#include "feldspar/specimen/mesh_grains.hpp"
#include "feldspar/verify/bodies.hpp"
#include "feldspar/verify/topics.hpp"

namespace feldspar {
namespace {

using namespace bodies;

Heterogeneity two_phases() {
    Heterogeneity rock;
    rock.minerals.phases = {{"a", 0.5, {60e9, 0.2, 2650.0}}, {"b", 0.5, {20e9, 0.2, 2650.0}}};
    for (const auto& [p, Kn] : {std::pair{0, 3e14}, std::pair{1, 1e14}}) {
        PhasePair pair{p, p, {}};
        pair.changes.Kn_Pa_m = Kn;
        rock.minerals.pairs.push_back(pair);
    }
    rock.minerals.unlike = UnlikeRule::mean;
    return rock;
}

// Layers of two minerals along the load and across it: means of the moduli that specimens of one mineral have, contacts included.
CheckedValue layers(bool across) {
    constexpr int columns = 600, rows = 1200;
    TestSetup s = setup(make(rectangle(0.06, 0.12)), methods::uniaxial_compression);
    s.rock = two_phases();
    s.test.maximum_stress_Pa = 2e6;  // long before anything breaks
    double share_a = 0.0;
    const auto E_of = [&](auto phase_at) {
        PhaseMap map{columns, rows, {}};
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < columns; ++c) map.phase.push_back(static_cast<std::int8_t>(phase_at(c, r)));
        s.rock.minerals.map = std::make_shared<PhaseMap>(map);
        share_a = Texture(*s.specimen, s.grain, s.contact, s.rock).summary().area_shares[0];
        const TestProperties p = run_test(s, {}).properties;
        return across ? p.E_tangent_Pa : p.E_gauge_Pa;  // in series all layers count, and the gauge does not span them all
    };
    const double E_a = E_of([](int, int) { return 0; }), E_b = E_of([](int, int) { return 1; });
    const int n = across ? 4 : 2;  // as many along the load as its ends allow: each layer touches both
    const double E = E_of([&](int c, int r) { return across ? r * n / rows % 2 : c * n / columns % 2; });
    const double expected = across ? 1.0 / (share_a / E_a + (1.0 - share_a) / E_b) : share_a * E_a + (1.0 - share_a) * E_b;
    return {across ? "four layers across" : "two layers along", 1e-9 * expected, 1e-9 * E};
}

// A round phase in the middle of a pulled plate, about four of its diameters wide: mean stress along the load within 0.6 of its
// radius, over that of the load. Contacts are stiff, so that the minerals' own constants count.
CheckedValue inclusion(double ratio, const char* what) {
    constexpr double W = 0.12, radius = 0.015, nu1 = 0.2, nu2 = 0.25, E2 = 40e9;
    TestSetup s = setup(make(rectangle(W, W)), methods::direct_tension);
    s.contact.Kn_Pa_m *= 100.0;
    s.rock.minerals.phases = {{"round", 0.5, {ratio * E2, nu1, 2650.0}}, {"around", 0.5, {E2, nu2, 2650.0}}};
    constexpr int n = 600;
    PhaseMap map{n, n, {}};
    for (int r = 0; r < n; ++r)
        for (int c = 0; c < n; ++c)
            map.phase.push_back(
                static_cast<std::int8_t>(std::hypot((r + 0.5) / n - 0.5, (c + 0.5) / n - 0.5) * W < radius ? 0 : 1));
    s.rock.minerals.map = std::make_shared<PhaseMap>(map);
    Started started(s);
    GaugeSpec mean;
    mean.name = "mean";
    mean.kind = GaugeKind::mean_stress;
    mean.region = {{0.5 * W, 0.5 * W}, {}, 0.6 * radius};
    mean.direction = {0.0, 1.0};
    evaluate_forces(started.e.assembly, started.e.team, Strength::unlimited);
    const double inside = Gauges(started.e.assembly, *s.specimen, {mean}).read(started.e.assembly).front(),
                 load = std::abs(started.e.stress(reactions(started.e.assembly).loading));
    const double G1 = ratio / (1.0 + nu1), G2 = 1.0 / (1.0 + nu2), k1 = (3.0 - nu1) / (1.0 + nu1), k2 = (3.0 - nu2) / (1.0 + nu2),
                 even = G1 * (k2 + 1.0) / (2.0 * G1 + G2 * (k1 - 1.0)), shear = G1 * (k2 + 1.0) / (G2 + k2 * G1);
    return {what, 0.5 * (even + shear), std::abs(inside) / load};
}

constexpr double kModulus = 6.0;

Heterogeneity weibull_strengths() {
    Heterogeneity rock;
    rock.scatter[Scattered::strength] = {.kind = DistributionKind::weibull, .weibull_modulus = kModulus};
    return rock;
}

std::vector<CheckedValue> weakest_links() {
    constexpr int kColumns = 1500;
    const Heterogeneity rock = weibull_strengths();
    const ContactMaterial contact = table7();
    std::vector<CheckedValue> compared;
    for (const int links : {1, 4, 16}) {
        double sum = 0.0;
        for (std::uint64_t seed = 1; seed <= kColumns; ++seed) {
            Specimen only;  // links between the grains 0 and 1, 1 and 2, ...
            only.seed = seed;
            const Texture texture(only, granite(), contact, rock);
            double weakest = std::numeric_limits<double>::infinity();
            for (int i = 0; i < links; ++i) weakest = std::min(weakest, texture.contact(i, i + 1, {}, {}).material.sigma_nt_Pa);
            sum += weakest;
        }
        compared.push_back({std::to_string(links) + (links == 1 ? " link" : " links"), 8.5 * std::pow(links, -1.0 / kModulus),
                            1e-6 * sum / kColumns});
    }
    return compared;
}

// Grains on top of each other, one wide.
std::shared_ptr<const Specimen> column(int grains, std::uint64_t seed) {
    constexpr double h = 0.003;
    Specimen s;
    s.seed = seed;
    s.spec = rectangle(h, grains * h);
    s.outline.vertices = {{0, 0}, {h, 0}, {h, grains * h}, {0, grains * h}};
    s.outline.edge_labels = {"bottom", "right", "top", "left"};
    s.outline.area_m2 = h * h * grains;
    for (int i = 0; i <= grains; ++i) s.cells.vertices.insert(s.cells.vertices.end(), {{0, i * h}, {h, i * h}});
    for (int i = 0; i < grains; ++i) {
        s.packing.centres.push_back({0.5 * h, (i + 0.5) * h});
        s.packing.radii_m.push_back(0.5 * h);
        s.cells.cells.push_back({{2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2},
                                 {i - 1, -1, i + 1 < grains ? i + 1 : -1, -1},
                                 {i == 0 ? 0 : -1, 1, i + 1 < grains ? -1 : 2, 3}});
    }
    s.mesh = mesh_grains(s.cells, 0);
    return std::make_shared<const Specimen>(std::move(s));
}

struct Chain {
    double strength_MPa, weakest_MPa;
    int link, weakest_link;
};

const std::array<Chain, 3>& chains() {
    static const std::array<Chain, 3> all = [] {
        std::array<Chain, 3> list{};
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            const auto specimen = column(6, seed);
            TestSetup s = setup(specimen, methods::direct_tension);
            s.contact.law = ContactLaw::brittle;
            s.rock = weibull_strengths();
            const Texture texture(*specimen, s.grain, s.contact, s.rock);
            Chain& chain = list[seed - 1];
            chain.weakest_MPa = std::numeric_limits<double>::infinity();
            for (int i = 0; i < 5; ++i)
                if (const double strength = 1e-6 * texture.contact(i, i + 1, {}, {}).material.sigma_nt_Pa;
                    strength < chain.weakest_MPa) {
                    chain.weakest_MPa = strength;
                    chain.weakest_link = i;
                }
            const TestResult r = run_test(s, {});
            chain.strength_MPa = 1e-6 * r.properties.peak_stress_Pa;
            chain.link = r.cracks.empty() ? -1 : std::min(r.cracks.front().grain_a, r.cracks.front().grain_b);
        }
        return list;
    }();
    return all;
}

std::vector<CheckedValue> chain_strengths() {
    std::vector<CheckedValue> compared;
    for (std::size_t i = 0; i < 3; ++i)
        compared.push_back({"chain " + std::to_string(i + 1), chains()[i].weakest_MPa, chains()[i].strength_MPa});
    return compared;
}

std::vector<CheckedValue> chain_places() {
    std::vector<CheckedValue> compared;
    for (std::size_t i = 0; i < 3; ++i)
        compared.push_back({"chain " + std::to_string(i + 1), 1.0 + chains()[i].weakest_link, 1.0 + chains()[i].link});
    return compared;
}

struct Moments {
    double mean = 0.0, variation = 0.0;
};

Moments moments(const Distribution& d) {
    Moments m;
    double square = 0.0;
    constexpr int kPoints = 200000;
    for (int i = 0; i < kPoints; ++i) {
        const double f = factor_at(d, (i + 0.5) / kPoints);
        m.mean += f / kPoints;
        square += f * f / kPoints;
    }
    m.variation = std::sqrt(square - m.mean * m.mean);
    return m;
}

std::vector<CheckedValue> weibull() {
    std::vector<CheckedValue> compared;
    for (const double m : {1.3, 2.0, 6.0, 20.0}) {
        const Distribution d{.kind = DistributionKind::weibull, .weibull_modulus = m};
        const double one = std::tgamma(1.0 + 1.0 / m), two = std::tgamma(1.0 + 2.0 / m);
        const Moments found = moments(d);
        const std::string what = "m = " + std::to_string(m).substr(0, m < 10.0 ? 3 : 2);
        compared.push_back({what + ", mean", 1.0, found.mean});
        compared.push_back({what + ", coefficient of variation", std::sqrt(two / (one * one) - 1.0), found.variation});
        compared.push_back({what + ", median", std::pow(std::log(2.0), 1.0 / m) / one, factor_at(d, 0.5)});
    }
    return compared;
}

std::vector<CheckedValue> log_normal() {
    std::vector<CheckedValue> compared;
    for (const double v : {0.1, 0.4}) {
        const Distribution d{.kind = DistributionKind::log_normal, .variation = v};
        const Moments found = moments(d);
        const std::string what = v < 0.2 ? "variation 0.1" : "variation 0.4";
        compared.push_back({what + ", mean", 1.0, found.mean});
        compared.push_back({what + ", variation", v, found.variation});
        compared.push_back({what + ", median", 1.0 / std::sqrt(1.0 + v * v), factor_at(d, 0.5)});
    }
    return compared;
}

}  // namespace

std::vector<Check> mixture_checks() {
    return {
        {.name = "minerals.layers-along",
         .sentence = "Layers of two minerals along the load have the mean of the moduli that rocks of one mineral have.",
         .formula = "E = sum f E (Voigt)",
         .source = "mixtures",
         .unit = "GPa",
         .bound = relative(1e-2),
         .reason = "the border of the layers follows the grains",
         .compare = [] { return std::vector<CheckedValue>{layers(false)}; }},
        {.name = "minerals.layers-across",
         .sentence = "Layers of two minerals across the load have the harmonic mean of these moduli.",
         .formula = "1 / E = sum f / E (Reuss)",
         .source = "mixtures",
         .unit = "GPa",
         .bound = relative(1e-2),
         .reason = "the border of the layers follows the grains",
         .compare = [] { return std::vector<CheckedValue>{layers(true)}; }},
        {.name = "minerals.round-phase",
         .sentence = "A round mineral in the middle of a plate bears the uniform stress of an elastic inclusion; along the load, "
                     "over the load's.",
         .formula = "G1 (k2 + 1) / 2 [1 / (2 G1 + G2 (k1 - 1)) + 1 / (G2 + k2 G1)], k = (3 - nu) / (1 + nu)",
         .source = "plane elasticity of a round inclusion; plane stress",
         .bound = relative(4e-2),
         .reason = "its border follows the grains, ten in its diameter; the plate is eight radii wide",
         .compare =
             [] {
                 return std::vector<CheckedValue>{inclusion(0.38, "0.38 times as stiff"), inclusion(2.0, "twice as stiff")};
             }},
        {.name = "scatter.weibull",
         .sentence = "Weibull factors have the mean 1, and the variation and median of their modulus.",
         .formula = "v^2 = Gamma(1 + 2/m) / Gamma(1 + 1/m)^2 - 1, median = ln(2)^(1/m) / Gamma(1 + 1/m)",
         .source = "docs/theory/heterogeneity.md; Weibull 1951",
         .bound = absolute(2e-3),
         .reason = "the tail of a sum over 200000 probabilities",
         .compare = weibull},
        {.name = "scatter.log-normal",
         .sentence = "Log-normal factors have the mean 1, and the variation and median that are asked for.",
         .formula = "median = 1 / sqrt(1 + v^2)",
         .source = "docs/theory/heterogeneity.md",
         .bound = absolute(2e-3),
         .reason = "the tail of a sum over 200000 probabilities",
         .compare = log_normal},
        {.name = "chains.mean-of-the-weakest",
         .sentence = "The mean strength of the weakest of n contacts falls with n as Weibull's law says; over 1500 draws.",
         .formula = "mean = sigma_nt n^(-1/m), m = 6",
         .source = "Weibull 1951",
         .unit = "MPa",
         .bound = relative(2e-2),
         .reason = "the mean of 1500 draws with a variation of 0.19 is known to 0.5 %: four standard errors",
         .compare = weakest_links},
        {.name = "chains.strength",
         .sentence = "A column of six grains, one wide, bears the strength of its weakest contact.",
         .formula = "max sigma = min sigma_nt",
         .source = "weakest link",
         .unit = "MPa",
         .bound = relative(1e-2),
         .reason = "the accuracy that is asked for",
         .compare = chain_strengths,
         .run = "chains"},
        {.name = "chains.place",
         .sentence = "And breaks there: number of the contact.",
         .formula = "argmin sigma_nt",
         .source = "weakest link",
         .bound = absolute(0.5),
         .reason = "a whole number",
         .compare = chain_places,
         .run = "chains"},
    };
}

}  // namespace feldspar
