// What a rock with minerals, scatter, initial cracks and joints comes to on a specimen.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/base/rng.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/joints.hpp"
#include "feldspar/model/texture.hpp"
#include "feldspar/specimen/grain_sizes.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

const Specimen& plate() {
    static const auto specimen = fixtures::make(fixtures::rectangle(0.06, 0.12));
    return *specimen;
}

Texture texture(const Heterogeneity& rock, const Specimen& specimen = plate()) {
    return Texture(specimen, fixtures::granite(), fixtures::table7(), rock);
}

// The largest distance between the shares of a sample below its values and those of the distribution.
template <class Share>
double kolmogorov_smirnov(std::vector<double> sample, Share share, double parameter) {
    std::sort(sample.begin(), sample.end());
    double largest = 0.0;
    const double n = static_cast<double>(sample.size());
    for (std::size_t i = 0; i < sample.size(); ++i) {
        const double F = share(sample[i], parameter);
        largest = std::max({largest, std::abs(F - static_cast<double>(i) / n), std::abs(F - static_cast<double>(i + 1) / n)});
    }
    return largest;
}

// Factors of the strength of all contacts of a specimen.
std::vector<double> strengths(const Heterogeneity& rock, const Specimen& specimen = plate()) {
    const Texture t = texture(rock, specimen);
    std::vector<double> factors;
    const std::vector<Cell>& cells = specimen.cells.cells;
    for (int c = 0; c < std::ssize(cells); ++c)
        for (std::size_t k = 0; k < cells[c].vertices.size(); ++k) {
            if (cells[c].neighbours[k] <= c) continue;
            const Vec2 from = specimen.cells.vertices[cells[c].vertices[k]],
                       to = specimen.cells.vertices[cells[c].vertices[(k + 1) % cells[c].vertices.size()]];
            factors.push_back(t.contact(c, cells[c].neighbours[k], from, to).material.sigma_nt_Pa /
                              fixtures::table7().sigma_nt_Pa);
        }
    return factors;
}

TEST(Scatter, DrawsFollowTheirDistributions) {
    Heterogeneity rock;
    const double limit = 1.63 / std::sqrt(static_cast<double>(strengths(rock).size()));  // at 1 %
    rock.scatter[Scattered::strength] = {.kind = DistributionKind::weibull, .weibull_modulus = 2.5};
    EXPECT_LT(kolmogorov_smirnov(
                  strengths(rock),
                  [](double f, double m) { return 1.0 - std::exp(-std::pow(f * std::tgamma(1.0 + 1.0 / m), m)); }, 2.5),
              limit);
    rock.scatter[Scattered::strength] = {.kind = DistributionKind::log_normal, .variation = 0.4};
    EXPECT_LT(kolmogorov_smirnov(
                  strengths(rock),
                  [](double f, double v) {
                      const double s = std::sqrt(std::log1p(v * v));
                      return 0.5 * std::erfc(-(std::log(f) / s + 0.5 * s) / std::numbers::sqrt2);
                  },
                  0.4),
              limit);
    rock.scatter[Scattered::strength] = {.kind = DistributionKind::normal, .variation = 0.2};
    EXPECT_LT(kolmogorov_smirnov(
                  strengths(rock), [](double f, double v) { return 0.5 * std::erfc(-(f - 1.0) / v / std::numbers::sqrt2); }, 0.2),
              limit);
}

TEST(Scatter, AWeibullModulusIsFoundFromItsVariation) {
    for (const auto& [modulus, variation] : {std::pair{1.3, 0.776}, {2.0, 0.523}, {6.0, 0.194}})  // closed form
        EXPECT_NEAR(weibull_modulus_of(variation), modulus, 0.005 * modulus);  // of a variation given to three digits
}

TEST(Scatter, IsCutOffAtBothEnds) {
    Heterogeneity rock;
    rock.scatter[Scattered::strength] = {
        .kind = DistributionKind::weibull, .weibull_modulus = 1.5, .lowest = 0.3, .highest = 1.6};
    const std::vector<double> f = strengths(rock);
    EXPECT_GE(*std::min_element(f.begin(), f.end()), 0.3);
    EXPECT_LE(*std::max_element(f.begin(), f.end()), 1.6);
    EXPECT_LT(std::count(f.begin(), f.end(), 0.3), 3);  // cut off, not heaped up there
}

// What is left between the ends has the distribution's own shape.
TEST(Scatter, ThatIsCutOffKeepsItsShapeBetween) {
    const auto cut = [](auto share, double low, double high) {
        return [=](double f, double parameter) {
            return (share(f, parameter) - share(low, parameter)) / (share(high, parameter) - share(low, parameter));
        };
    };
    Heterogeneity rock;
    const double limit = 1.63 / std::sqrt(static_cast<double>(strengths(rock).size()));  // at 1 %
    rock.scatter[Scattered::strength] = {
        .kind = DistributionKind::weibull, .weibull_modulus = 1.5, .lowest = 0.3, .highest = 1.6};
    const auto weibull = [](double f, double m) { return 1.0 - std::exp(-std::pow(f * std::tgamma(1.0 + 1.0 / m), m)); };
    EXPECT_LT(kolmogorov_smirnov(strengths(rock), cut(weibull, 0.3, 1.6), 1.5), limit);
    rock.scatter[Scattered::strength] = {.kind = DistributionKind::log_normal, .variation = 0.6, .lowest = 0.8, .highest = 2.0};
    const auto log_normal = [](double f, double v) {
        const double s = std::sqrt(std::log1p(v * v));
        return 0.5 * std::erfc(-(std::log(f) / s + 0.5 * s) / std::numbers::sqrt2);
    };
    EXPECT_LT(kolmogorov_smirnov(strengths(rock), cut(log_normal, 0.8, 2.0), 0.6), limit);
}

TEST(Scatter, IsDrawnByTheGrainsThatAContactJoins) {
    Heterogeneity rock;
    rock.scatter[Scattered::strength] = {.kind = DistributionKind::weibull, .weibull_modulus = 2.0};
    const Texture t = texture(rock);
    const Cell& cell = plate().cells.cells[50];
    const auto inside = std::find_if(cell.neighbours.begin(), cell.neighbours.end(), [](int n) { return n >= 0; });
    ASSERT_NE(inside, cell.neighbours.end());
    const double f = t.contact(50, *inside, {}, {}).material.sigma_nt_Pa;
    EXPECT_EQ(t.contact(*inside, 50, {1.0, 2.0}, {3.0, 4.0}).material.sigma_nt_Pa, f);  // whatever the order and the place
    const ContactMaterial m = t.contact(50, *inside, {}, {}).material;  // strengths move together, energies by the square
    const double factor = f / fixtures::table7().sigma_nt_Pa;
    EXPECT_DOUBLE_EQ(m.tau_Pa / fixtures::table7().tau_Pa, factor);
    EXPECT_NEAR(m.Gfn_J_m2 / fixtures::table7().Gfn_J_m2, factor * factor, 1e-12);
    EXPECT_EQ(m.Kn_Pa_m, fixtures::table7().Kn_Pa_m);
    EXPECT_NE(strengths(rock, *fixtures::make(fixtures::rectangle(0.06, 0.12), 2)),
              strengths(rock));  // another packing, other draws
}

// Over many pairs of contacts a given distance apart, the normal scores of their draws have the covariance exp(-r^2 / (2 l^2)).
TEST(Scatter, OfARandomFieldIsCorrelatedOverItsLength) {
    Heterogeneity rock;
    constexpr double kLength = 0.006;
    rock.scatter[Scattered::strength] = {.kind = DistributionKind::log_normal, .variation = 0.3, .correlation_length_m = kLength};
    const double s = std::sqrt(std::log1p(0.09));
    double product = 0.0, square = 0.0;
    int pairs = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {  // of fields, not of packings
        Specimen specimen;
        specimen.seed = seed;
        specimen.spec = plate().spec;
        const Texture t(specimen, fixtures::granite(), fixtures::table7(), rock);
        for (int i = 0; i < 5; ++i) {
            const Vec2 x = {0.02 * i, 0.01};
            const auto score = [&](Vec2 at) {
                return std::log(t.contact(0, 1, at, at).material.sigma_nt_Pa / fixtures::table7().sigma_nt_Pa) / s + 0.5 * s;
            };
            const double a = score(x), b = score({x.x, x.y + kLength});
            product += a * b;
            square += a * a;
            ++pairs;
        }
    }
    EXPECT_NEAR(square / pairs, 1.0, 0.12);  // three standard errors of 1500 draws
    EXPECT_NEAR(product / pairs, std::exp(-0.5), 0.09);
}

Heterogeneity granite_of_four() {
    Heterogeneity rock;
    rock.minerals.phases = {{"quartz", 0.31, {94.5e9, 0.08, 2650.0}},
                            {"K-feldspar", 0.27, {69.8e9, 0.28, 2560.0}},
                            {"plagioclase", 0.38, {88.1e9, 0.26, 2630.0}},
                            {"biotite", 0.04, {33.8e9, 0.36, 3050.0}}};
    return rock;
}

TEST(Minerals, HaveTheirSharesOfTheArea) {
    Heterogeneity rock = granite_of_four();
    const double grain = 1.0 / static_cast<double>(plate().cells.cells.size());
    for (const double length : {0.0, 0.01}) {
        rock.minerals.cluster_length_m = length;
        const TextureSummary summary = texture(rock).summary();
        for (std::size_t p = 0; p < 4; ++p)
            EXPECT_NEAR(summary.area_shares[p], rock.minerals.phases[p].share, 2.0 * grain) << length;  // two grains
        EXPECT_EQ(std::accumulate(summary.grains.begin(), summary.grains.end(), 0), std::ssize(plate().cells.cells));
    }
}

// Contacts between like grains, over what independent grains would have.
TEST(Minerals, LieInClustersOnRequest) {
    Heterogeneity rock = granite_of_four();
    const auto like = [&] {
        const TextureSummary summary = texture(rock).summary();
        double same = 0.0, all = 0.0;
        for (const auto& [pair, count] : summary.contacts) {
            all += count;
            if (pair.first == pair.second) same += count;
        }
        return same / all;
    };
    const double independent = 0.31 * 0.31 + 0.27 * 0.27 + 0.38 * 0.38 + 0.04 * 0.04;
    EXPECT_NEAR(like(), independent, 0.04);
    rock.minerals.cluster_length_m = 0.01;
    EXPECT_GT(like(), 1.6 * independent);
}

TEST(Minerals, ComeFromAListOrAMap) {
    Heterogeneity rock = granite_of_four();
    rock.minerals.list.assign(plate().packing.centres.size(), 2);
    rock.minerals.list[7] = 3;
    EXPECT_EQ(texture(rock).phases()[7], 3);
    EXPECT_EQ(texture(rock).summary().grains[2], std::ssize(plate().cells.cells) - 1);
    rock.minerals.list.pop_back();
    EXPECT_THROW(texture(rock), InputError);

    rock.minerals.list.clear();
    PhaseMap map{60, 120, std::vector<std::int8_t>(60 * 120, 0)};  // the upper half biotite
    std::fill(map.phase.begin(), map.phase.begin() + 60 * 60, std::int8_t{3});
    rock.minerals.map = std::make_shared<PhaseMap>(map);
    const Texture t = texture(rock);
    for (std::size_t c = 0; c < t.phases().size(); ++c) {
        const double y = plate().mesh.nodes[plate().mesh.centre_node[c]].y;
        if (std::abs(y - 0.06) < 0.003) continue;  // a grain away from the border
        EXPECT_EQ(t.phases()[c], y > 0.06 ? 3 : 0);
    }
    map.height = 100;
    map.phase.resize(60 * 100);
    rock.minerals.map = std::make_shared<PhaseMap>(map);
    EXPECT_THROW(texture(rock), InputError);  // another shape than the specimen
}

// A map finer than the grains: each grain is of the mineral with most pixels in it, not of the one in its middle.
TEST(Minerals, OfAFineMapAreThoseOfMostPixels) {
    Heterogeneity rock = granite_of_four();
    PhaseMap map{120, 240, {}};  // 0.5 mm a pixel
    RandomStream random(5, "pixels");
    for (int pixel = 0; pixel < 120 * 240; ++pixel) map.phase.push_back(static_cast<std::int8_t>(random.uniform() < 0.5 ? 0 : 3));
    rock.minerals.map = std::make_shared<PhaseMap>(map);
    const Texture t = texture(rock);
    for (int c = 0; c < std::ssize(plate().cells.cells); ++c) {
        const std::vector<Vec2> corners = corners_of_cell(plate().cells, c);
        std::array<int, 4> votes{};
        for (int row = 0; row < 240; ++row)
            for (int column = 0; column < 120; ++column)
                if (contains(corners, {(column + 0.5) * 0.5e-3, 0.12 - (row + 0.5) * 0.5e-3}))
                    ++votes[static_cast<std::size_t>(map.phase[static_cast<std::size_t>(row) * 120 + column])];
        if (votes[0] != votes[3]) {
            EXPECT_EQ(t.phases()[c], votes[0] > votes[3] ? 0 : 3) << c;
        }
    }
}

// Where minerals have sizes of their own the packing says which cell is of which, and the summary what they came to.
TEST(Minerals, WithSizesOfTheirOwnAreThoseOfThePacking) {
    SpecimenSpec spec = fixtures::rectangle(0.04, 0.06);
    GrainSizeSpec fine = spec.grain_sizes, coarse = spec.grain_sizes;
    fine.minimum_m = 0.0015;
    fine.maximum_m = 0.002;
    coarse.minimum_m = 0.003;
    coarse.maximum_m = 0.005;
    spec.phase_sizes = {{"fine", 0.4, fine}, {"coarse", 0.6, coarse}};
    spec.grain_sizes = mixture_of(spec.phase_sizes, spec.porosity);
    const auto specimen = fixtures::make(spec);
    Heterogeneity rock;
    rock.minerals.phases = {{"fine", 0.4, fixtures::granite()}, {"coarse", 0.6, {60e9, 0.1, 2700.0}}};
    const Texture t = texture(rock, *specimen);
    EXPECT_EQ(t.phases(), specimen->packing.phases);
    const TextureSummary summary = t.summary();
    ASSERT_EQ(summary.disc_sizes.size(), 2U);
    EXPECT_GE(summary.disc_sizes[0].minimum_m, 0.0015);
    EXPECT_LE(summary.disc_sizes[0].maximum_m, 0.002);
    EXPECT_GE(summary.disc_sizes[1].minimum_m, 0.003);
    EXPECT_GT(summary.sizes[1].mean_m, summary.disc_sizes[1].mean_m) << "cells fill the pores too";
    EXPECT_NEAR(summary.area_shares[0], 0.4, 0.01);
    EXPECT_EQ(t.grain(0).E_Pa, specimen->packing.phases[0] == 0 ? fixtures::granite().E_Pa : 60e9);
    rock.minerals.phases.pop_back();
    EXPECT_THROW(texture(rock, *specimen), InputError) << "the packing has two minerals";
}

TEST(Minerals, UnlikeContactsFollowTheRule) {
    Heterogeneity rock = granite_of_four();
    PhasePair quartz{0, 0, {}}, mica{3, 3, {}}, both{0, 2, {}};
    quartz.changes.sigma_nt_Pa = 12e6;
    quartz.changes.Kn_Pa_m = 2e14;
    mica.changes.sigma_nt_Pa = 4e6;
    mica.changes.Kn_Pa_m = 1e14;
    both.changes.tau_Pa = 1e6;
    rock.minerals.pairs = {quartz, mica, both};
    EXPECT_EQ(texture(rock).between(0, 3).sigma_nt_Pa, 4e6);
    EXPECT_EQ(texture(rock).between(3, 0).Kn_Pa_m, 1e14);
    EXPECT_EQ(texture(rock).between(2, 0).tau_Pa, 1e6);  // given
    EXPECT_EQ(texture(rock).between(2, 0).sigma_nt_Pa, fixtures::table7().sigma_nt_Pa);
    EXPECT_EQ(texture(rock).between(1, 1).sigma_nt_Pa, fixtures::table7().sigma_nt_Pa);
    rock.minerals.unlike = UnlikeRule::mean;
    rock.minerals.unlike_strength = 0.5;
    EXPECT_DOUBLE_EQ(texture(rock).between(0, 3).sigma_nt_Pa, 0.5 * 8e6);
    EXPECT_DOUBLE_EQ(texture(rock).between(0, 3).Kn_Pa_m, 2.0 / (1.0 / 2e14 + 1.0 / 1e14));
    EXPECT_EQ(texture(rock).between(0, 0).sigma_nt_Pa, 12e6);  // like: as given
}

TEST(Minerals, MeanIsThatOfHill) {
    const GrainMaterial mean = mean_grain(granite_of_four().minerals, fixtures::granite());
    EXPECT_NEAR(mean.E_Pa / 1e9, 0.5 * (82.97 + 79.12), 0.05);  // Voigt 83.0, Reuss 79.1 GPa
    EXPECT_NEAR(mean.density_kg_m3, 0.31 * 2650 + 0.27 * 2560 + 0.38 * 2630 + 0.04 * 3050, 1e-9);
}

TEST(InitialCracks, AreAShareOfTheContacts) {
    Heterogeneity rock;
    rock.initial_cracks = {.broken = 0.2, .opening_m = 1e-6, .weakened = 0.3, .weakened_strength = 0.4};
    const TextureSummary summary = texture(rock).summary();
    const double n = summary.contacts_in_all;
    EXPECT_NEAR(summary.broken / n, 0.2, 3.0 * std::sqrt(0.2 * 0.8 / n));  // three standard deviations
    EXPECT_NEAR(summary.weakened / n, 0.3, 3.0 * std::sqrt(0.3 * 0.7 / n));
    const Assembly a = assemble(plate(), fixtures::model(GrainKind::flexible), fixtures::granite(), fixtures::table7(), rock);
    int open = 0, weak = 0;
    for (const Contact& contact : a.contacts) {
        const BondState bond = a.bond(contact.first_point);
        open += bond.damage == 1.0 && bond.un_m == 1e-6;
        weak += std::abs(a.law_of(contact).sigma_nt_Pa / (0.4 * fixtures::table7().sigma_nt_Pa) - 1.0) < 1e-12;
    }
    EXPECT_EQ(open, summary.broken);
    EXPECT_EQ(weak, summary.weakened);
}

JointSpec joint(std::vector<Vec2> trace) {
    JointSpec spec;
    spec.name = "joint";
    spec.lines_m = {std::move(trace)};
    spec.contact = fixtures::table7();
    spec.contact.sigma_nt_Pa = spec.contact.tau_Pa = 0.0;
    return spec;
}

// A joint through the whole specimen leaves no way from one side to the other but through its own edges.
TEST(Joints, DivideTheSpecimenAlongTheirTrace) {
    Heterogeneity rock;
    rock.joints = {joint({{-0.01, 0.03}, {0.03, 0.05}, {0.07, 0.09}})};
    const JointEdges edges(plate(), rock.joints.front());
    const std::vector<Cell>& cells = plate().cells.cells;
    std::vector<int> side(cells.size(), -1);
    int sides = 0;
    for (std::size_t start = 0; start < cells.size(); ++start) {
        if (side[start] >= 0) continue;
        std::vector<int> waiting{static_cast<int>(start)};
        side[start] = sides;
        while (!waiting.empty()) {
            const int c = waiting.back();
            waiting.pop_back();
            for (const int other : cells[c].neighbours)
                if (other >= 0 && side[other] < 0 && !edges.holds(c, other)) {
                    side[other] = sides;
                    waiting.push_back(other);
                }
        }
        ++sides;
    }
    EXPECT_EQ(sides, 2);
    const TextureSummary summary = texture(rock).summary();
    const double trace = norm(Vec2{0.03, 0.05} - Vec2{0.0, 0.035}) + norm(Vec2{0.06, 0.08} - Vec2{0.03, 0.05});
    EXPECT_GT(summary.joint_lengths_m[0], trace);
    EXPECT_LT(summary.joint_lengths_m[0], 1.6 * trace);  // a way along the edges of a honeycomb is 4/3 as long
}

TEST(Joints, OutsideOfTheBodyOrAroundAGrainAreRefused) {
    Heterogeneity rock;
    rock.joints = {joint({{0.2, 0.0}, {0.2, 0.1}})};
    EXPECT_THROW(texture(rock), InputError);
    const Vec2 grain = plate().mesh.nodes[plate().mesh.centre_node[200]];
    rock.joints.clear();
    for (const double y : {-0.0016, 0.0016}) {
        rock.joints.push_back(joint({grain + Vec2{-0.02, y}, grain + Vec2{0.02, y}}));
        rock.joints.back().name += y > 0.0 ? "-above" : "-below";
        rock.joints.push_back(joint({grain + Vec2{y, -0.02}, grain + Vec2{y, 0.02}}));
        rock.joints.back().name += y > 0.0 ? "-right" : "-left";
    }
    try {
        texture(rock);
        FAIL() << "a grain hangs on nothing";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("cut the grain"), std::string::npos) << error.what();
    }
}

TEST(Joints, OfASetHaveItsSpacingAndPersistence) {
    JointSpec set;
    set.name = "bedding";
    set.set = JointSet{.dip_rad = 0.4,
                       .spacing_m = 0.004,
                       .spacing_variation = 0.3,
                       .length_m = 0.01,
                       .length_variation = 0.2,
                       .persistence = 0.6};
    const Box box = bounding_box(plate().mesh.nodes);
    const double reach = 0.5 * norm(box.upper - box.lower);
    double length = 0.0, inside = 0.0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        Specimen specimen;
        specimen.seed = seed;
        specimen.mesh.nodes = plate().mesh.nodes;
        const Vec2 centre = 0.5 * (box.lower + box.upper), along{std::cos(0.4), std::sin(0.4)};
        for (const std::vector<Vec2>& trace : traces_of(set, specimen)) {
            EXPECT_NEAR(cross(along, trace[1] - trace[0]), 0.0, 1e-12);
            const double from = std::clamp(dot(trace[0] - centre, along), -reach, reach),
                         to = std::clamp(dot(trace[1] - centre, along), -reach, reach);
            if (std::abs(cross(along, trace[0] - centre)) < reach) length += to - from;
        }
        inside += 4.0 * reach * reach;
    }
    EXPECT_NEAR(length / inside, 0.6 / 0.004,
                0.05 * 0.6 / 0.004);  // length of traces per area: persistence over spacing; 40 draws
}

// Crystals: each one mineral, one draw a boundary, contacts inside of a class of their own.
TEST(Crystals, HaveOneMineralAndContactsOfTheirOwnInside) {
    SpecimenSpec spec = fixtures::rectangle(0.04, 0.08);
    spec.grain_sizes.minimum_m = 0.0013;
    spec.grain_sizes.maximum_m = 0.0023;
    spec.crystal_sizes = spec.grain_sizes;
    spec.crystal_sizes->minimum_m = 0.004;
    spec.crystal_sizes->maximum_m = 0.0074;
    const auto specimen = fixtures::make(spec);
    const std::vector<int>& crystal = specimen->crystal_of_cell;
    ASSERT_EQ(crystal.size(), specimen->cells.cells.size());
    EXPECT_EQ(*std::max_element(crystal.begin(), crystal.end()) + 1, specimen->quality.crystals);
    EXPECT_NEAR(static_cast<double>(crystal.size()) / specimen->quality.crystals, 10.0, 2.0);  // (5.7 / 1.8)^2

    Heterogeneity rock;
    rock.minerals.phases = {{"a", 0.5, fixtures::granite()}, {"b", 0.5, fixtures::granite()}};
    rock.crystal.sigma_nt_Pa = 30e6;
    PhasePair inside{1, 1, {}, true};
    inside.changes.sigma_nt_Pa = 40e6;
    rock.minerals.pairs = {inside};
    rock.scatter[Scattered::strength] = {.kind = DistributionKind::weibull, .weibull_modulus = 2.0};
    const Texture t(*specimen, fixtures::granite(), fixtures::table7(), rock);
    std::map<std::pair<int, int>, double> drawn;  // of each boundary between crystals
    int inner = 0, outer = 0;
    for (int c = 0; c < std::ssize(specimen->cells.cells); ++c)
        for (const int other : specimen->cells.cells[c].neighbours) {
            if (other <= c) continue;
            const GrainContact contact = t.contact(c, other, {}, {});
            if (crystal[c] == crystal[other]) {
                ++inner;
                EXPECT_TRUE(contact.inside);
                EXPECT_EQ(t.phases()[c], t.phases()[other]);
                EXPECT_EQ(contact.material.sigma_nt_Pa, t.phases()[c] == 1 ? 40e6 : 30e6);
            } else {
                ++outer;
                EXPECT_FALSE(contact.inside);
                const auto pair = std::minmax({crystal[c], crystal[other]});
                const auto [place, fresh] = drawn.emplace(pair, contact.material.sigma_nt_Pa);
                EXPECT_EQ(place->second, contact.material.sigma_nt_Pa);
            }
        }
    const TextureSummary summary = t.summary();
    EXPECT_EQ(summary.inside, inner);
    EXPECT_EQ(summary.contacts_in_all, inner + outer);
    EXPECT_GT(outer, std::ssize(drawn));  // several edges a boundary
}

}  // namespace
}  // namespace feldspar
