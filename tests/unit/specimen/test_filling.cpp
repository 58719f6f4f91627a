// Small discs inside the grains: counts, places, contacts inside and across, and shares of the edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <numeric>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/fill_grains.hpp"
#include "sample_specimens.hpp"

namespace feldspar {
namespace {

constexpr double published_particles_per_grain = 26.36;

SpecimenSpec filled(SpecimenSpec spec, double particles_per_grain = published_particles_per_grain) {
    spec.particles_per_grain = particles_per_grain;
    return spec;
}

std::vector<Vec2> corners_of(const Tessellation& cells, int g) {
    std::vector<Vec2> corners;
    for (const int v : cells.cells[g].vertices) corners.push_back(cells.vertices[v]);
    return corners;
}

/// First and second vertex of edge k of cell g.
std::pair<Vec2, Vec2> edge_of(const Tessellation& cells, int g, int k) {
    const Cell& cell = cells.cells[g];
    return {cells.vertices[cell.vertices[k]], cells.vertices[cell.vertices[(k + 1) % cell.vertices.size()]]};
}

std::vector<int> grain_of_particle(const Filling& f) {
    std::vector<int> grain;
    for (int g = 0; g + 1 < std::ssize(f.particle_begin); ++g) {
        for (int p = f.particle_begin[g]; p < f.particle_begin[g + 1]; ++p) grain.push_back(g);
    }
    return grain;
}

double largest_diameter(const Filling& f) { return 2.0 * *std::max_element(f.radii_m.begin(), f.radii_m.end()); }

/// Cells given by their vertices; edges with the same two vertices are shared.
Tessellation cells_of(std::vector<Vec2> vertices, const std::vector<std::vector<int>>& cells) {
    Tessellation t;
    t.vertices = std::move(vertices);
    std::map<std::pair<int, int>, int> owner;
    for (int g = 0; g < std::ssize(cells); ++g) {
        for (std::size_t k = 0; k < cells[g].size(); ++k) owner[{cells[g][k], cells[g][(k + 1) % cells[g].size()]}] = g;
    }
    for (const auto& corners : cells) {
        Cell cell;
        cell.vertices = corners;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const auto other = owner.find({corners[(k + 1) % corners.size()], corners[k]});
            cell.neighbours.push_back(other == owner.end() ? -1 : other->second);
            cell.outline_edges.push_back(other == owner.end() ? 0 : -1);
        }
        t.cells.push_back(cell);
    }
    return t;
}

Tessellation one_cell(const std::vector<Vec2>& vertices) {
    std::vector<int> numbers(vertices.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    return cells_of(vertices, {numbers});
}

void expect_discs_inside_their_cells(const Tessellation& cells, const Filling& f) {
    for (int g = 0; g < std::ssize(cells.cells); ++g) {
        const std::vector<Vec2> corners = corners_of(cells, g);
        for (int p = f.particle_begin[g]; p < f.particle_begin[g + 1]; ++p) {
            EXPECT_TRUE(contains(corners, f.centres[p])) << "grain " << g;
            EXPECT_GE(distance_to_boundary(corners, f.centres[p]), f.radii_m[p] * (1.0 - 1e-9)) << "grain " << g;
        }
    }
}

/// 15 % is what the discs may overlap at most, and what their diameters may differ by from the common one.
void expect_small_overlaps(const Filling& f, double largest_mean) {
    double sum = 0.0;
    const double diameter = largest_diameter(f) / 1.15;
    for (int g = 0; g + 1 < std::ssize(f.particle_begin); ++g) {
        for (int i = f.particle_begin[g]; i < f.particle_begin[g + 1]; ++i) {
            for (int j = i + 1; j < f.particle_begin[g + 1]; ++j) {
                const double overlap = f.radii_m[i] + f.radii_m[j] - norm(f.centres[j] - f.centres[i]);
                EXPECT_LE(overlap, 0.15 * diameter) << "grain " << g;
                sum += std::max(0.0, overlap);
            }
        }
    }
    EXPECT_LE(sum / static_cast<double>(f.inside.size()), largest_mean * diameter);
}

/// The shares run along the edge without a gap: each begins, bit for bit, where the last one ended.
template <class Share>
void expect_shares_to_add_up(const std::vector<const Share*>& shares, std::pair<Vec2, Vec2> edge) {
    const double length = norm(edge.second - edge.first);
    double sum = 0.0;
    Vec2 end = edge.first;
    for (const Share* share : shares) {
        EXPECT_EQ(share->from, end);
        end = share->to;
        const double part = norm(share->to - share->from);
        EXPECT_GT(part, 0.99e-3 * length);
        EXPECT_GT(dot(share->to - share->from, edge.second - edge.first), 0.0);
        sum += part;
    }
    EXPECT_EQ(end, edge.second);
    EXPECT_NEAR(sum, length, 1e-12 * length);
}

void expect_every_edge_covered(const Tessellation& cells, const Filling& f) {
    std::map<std::pair<int, int>, std::vector<const AcrossContact*>> across;
    std::map<std::pair<int, int>, std::vector<const OutlineShare*>> outline;
    for (const AcrossContact& c : f.across) across[{c.cell_a, c.edge_a}].push_back(&c);
    for (const OutlineShare& s : f.outline) outline[{s.cell, s.edge}].push_back(&s);
    for (int g = 0; g < std::ssize(cells.cells); ++g) {
        for (int k = 0; k < std::ssize(cells.cells[g].neighbours); ++k) {
            const int other = cells.cells[g].neighbours[k];
            if (other >= 0 && other < g) continue;
            ASSERT_EQ(across.count({g, k}), other >= 0 ? 1U : 0U);
            ASSERT_EQ(outline.count({g, k}), other < 0 ? 1U : 0U);
            if (other >= 0) expect_shares_to_add_up(across[{g, k}], edge_of(cells, g, k));
            if (other < 0) expect_shares_to_add_up(outline[{g, k}], edge_of(cells, g, k));
        }
    }
}

void expect_across_contacts_to_face_each_other(const Tessellation& cells, const Filling& f) {
    const std::vector<int> grain = grain_of_particle(f);
    for (const AcrossContact& c : f.across) {
        EXPECT_EQ(grain[c.a], c.cell_a);
        EXPECT_EQ(grain[c.b], c.cell_b);
        EXPECT_LT(c.cell_a, c.cell_b);
        EXPECT_EQ(cells.cells[c.cell_a].neighbours[c.edge_a], c.cell_b);
        EXPECT_EQ(cells.cells[c.cell_b].neighbours[c.edge_b], c.cell_a);
        const auto [from, to] = edge_of(cells, c.cell_a, c.edge_a);
        EXPECT_EQ(edge_of(cells, c.cell_b, c.edge_b), std::make_pair(to, from));
        EXPECT_GT(cross(to - from, f.centres[c.a] - from), 0.0);
        EXPECT_LT(cross(to - from, f.centres[c.b] - from), 0.0);
    }
}

/// Rank of the conditions that each contact of a grain pins its two discs together: 3 n - 3 if only the grain as a whole moves.
int rank_of_pins(const Filling& f, int g) {
    const int first = f.particle_begin[g], columns = 3 * (f.particle_begin[g + 1] - first);
    std::vector<std::vector<double>> rows;
    for (const InsideContact& c : f.inside) {
        if (c.a < first || c.a >= f.particle_begin[g + 1]) continue;
        const Vec2 arm = (0.5 / f.radii_m[first]) * (f.centres[c.b] - f.centres[c.a]);
        std::vector<double> x(static_cast<std::size_t>(columns)), y = x;
        const int a = 3 * (c.a - first), b = 3 * (c.b - first);
        x[a] = 1.0, x[a + 2] = -arm.y, x[b] = -1.0, x[b + 2] = -arm.y;
        y[a + 1] = 1.0, y[a + 2] = arm.x, y[b + 1] = -1.0, y[b + 2] = arm.x;
        rows.push_back(x), rows.push_back(y);
    }
    int rank = 0;
    for (int c = 0; c < columns && rank < std::ssize(rows); ++c) {
        const auto larger = [c](const auto& p, const auto& q) { return std::abs(p[c]) < std::abs(q[c]); };
        const auto pivot = std::max_element(rows.begin() + rank, rows.end(), larger);
        if (std::abs((*pivot)[c]) < 1e-9) continue;
        std::swap(*pivot, rows[rank]);
        for (int r = rank + 1; r < std::ssize(rows); ++r) {
            const double factor = rows[r][c] / rows[rank][c];
            if (factor == 0.0) continue;
            for (int k = c; k < columns; ++k) rows[r][k] -= factor * rows[rank][k];
        }
        ++rank;
    }
    return rank;
}

void expect_rigid_grains(const Filling& f) {
    const std::vector<int> grain = grain_of_particle(f);
    std::vector<int> contacts(f.centres.size());
    for (const InsideContact& c : f.inside) {
        EXPECT_LT(c.a, c.b);
        EXPECT_EQ(grain[c.a], grain[c.b]);
        ++contacts[c.a], ++contacts[c.b];
    }
    EXPECT_GE(*std::min_element(contacts.begin(), contacts.end()), 2);
    for (int g = 0; g + 1 < std::ssize(f.particle_begin); ++g) {
        EXPECT_EQ(rank_of_pins(f, g), 3 * (f.particle_begin[g + 1] - f.particle_begin[g]) - 3) << "grain " << g;
    }
}

void expect_sound(const Tessellation& cells, const Filling& f) {
    ASSERT_EQ(f.particle_begin.size(), cells.cells.size() + 1);
    ASSERT_EQ(f.particle_begin.back(), std::ssize(f.centres));
    ASSERT_EQ(f.radii_m.size(), f.centres.size());
    ASSERT_EQ(f.places.size(), f.centres.size());
    expect_discs_inside_their_cells(cells, f);
    expect_every_edge_covered(cells, f);
    expect_across_contacts_to_face_each_other(cells, f);
    expect_rigid_grains(f);
}

class PublishedFilling : public testing::TestWithParam<std::uint64_t> {};

/// The number of particles follows from the number asked for. Contacts across come out 2.5 to 4 % above the published ones,
/// whose own rule is not known.
TEST_P(PublishedFilling, RectangleHasThePublishedCounts) {
    const Specimen s = make_specimen(filled(rectangle()), GetParam());
    EXPECT_NEAR(s.quality.inner_particles, 42966, 0.001 * 42966);
    EXPECT_NEAR(s.quality.across_contacts, 23977, 0.05 * 23977);
    const double radii = std::accumulate(s.filling.radii_m.begin(), s.filling.radii_m.end(), 0.0);
    EXPECT_NEAR(2.0 * radii / s.quality.inner_particles, 0.6e-3, 0.06e-3);
}

TEST_P(PublishedFilling, DiscHasThePublishedCounts) {
    const Specimen s = make_specimen(filled(disc()), GetParam());
    EXPECT_NEAR(s.quality.inner_particles, 16873, 0.001 * 16873);
    EXPECT_NEAR(s.quality.across_contacts, 9438, 0.05 * 9438);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PublishedFilling, testing::Values(1, 2, 3));

class FillingOf : public testing::TestWithParam<double> {};

TEST_P(FillingOf, IsSoundInEveryOutline) {
    for (const SpecimenSpec& outline :
         {rectangle(0.03, 0.03), disc(0.03), flattened_disc(0.03, 30.0), ell(), slit(), triangle(), split_sides()}) {
        const Specimen s = make_specimen(filled(outline, GetParam()), 2);
        expect_sound(s.cells, s.filling);
        // Coarse fillings have whole discs too many or too few, so that a larger share of the grains is tight.
        expect_small_overlaps(s.filling, 0.02);
        EXPECT_NEAR(s.quality.inner_particles, GetParam() * s.quality.grains,
                    std::max(1.0, 0.01 * GetParam() * s.quality.grains));
    }
}

INSTANTIATE_TEST_SUITE_P(Numbers, FillingOf, testing::Values(7.0, published_particles_per_grain, 60.0));

TEST(Filling, HasAHundredParticlesAGrain) {
    const Specimen s = make_specimen(filled(rectangle(0.02, 0.02), 100.0), 1);
    expect_sound(s.cells, s.filling);
    EXPECT_NEAR(s.quality.inner_particles, 100 * s.quality.grains, 1.0);
}

TEST(Filling, ReportCountsWhatIsThere) {
    const Specimen s = make_specimen(filled(rectangle(0.02, 0.02)), 1);
    EXPECT_EQ(s.quality.inner_particles, std::ssize(s.filling.centres));
    EXPECT_EQ(s.quality.inside_contacts, std::ssize(s.filling.inside));
    EXPECT_EQ(s.quality.across_contacts, std::ssize(s.filling.across));
}

TEST(Filling, IsEmptyUnlessAskedFor) {
    const Specimen s = make_specimen(rectangle(0.02, 0.02), 1);
    EXPECT_TRUE(s.filling.particle_begin.empty());
    EXPECT_TRUE(s.filling.centres.empty());
    EXPECT_EQ(s.quality.inner_particles, 0);
    EXPECT_EQ(s.quality.across_contacts, 0);
}

TEST(Filling, ChangesNothingElseInTheSpecimen) {
    const Specimen a = make_specimen(rectangle(0.02, 0.02), 1), b = make_specimen(filled(rectangle(0.02, 0.02)), 1);
    EXPECT_EQ(a.mesh.nodes, b.mesh.nodes);
    EXPECT_EQ(a.cells.vertices, b.cells.vertices);
}

TEST(Filling, RefusesImpossibleNumbers) {
    for (const double number : {-1.0, 1.0, 6.9, 501.0, std::nan("")}) {
        EXPECT_THROW(make_specimen(filled(rectangle(0.02, 0.02), number), 1), InputError) << number;
    }
}

TEST(Filling, SameSeedSameBits) {
    const Specimen s = make_specimen(rectangle(0.03, 0.03), 7);
    const Filling a = fill_grains(s.cells, 26.0, 7), b = fill_grains(s.cells, 26.0, 7), c = fill_grains(s.cells, 26.0, 8);
    ASSERT_EQ(a.centres.size(), b.centres.size());
    EXPECT_EQ(std::memcmp(a.centres.data(), b.centres.data(), a.centres.size() * sizeof(Vec2)), 0);
    EXPECT_EQ(a.radii_m, b.radii_m);
    EXPECT_EQ(a.across.size(), b.across.size());
    EXPECT_NE(a.centres, c.centres);
}

/// Enough grains that some put a particle elsewhere, which the grains after them must hear of.
TEST(Filling, SameBitsForAnyNumberOfThreads) {
    const Specimen s = make_specimen(rectangle(0.04, 0.06), 1);
    const Filling alone = fill_grains(s.cells, 26.0, 7);
    for (const int threads : {2, 3}) {
        Team team(threads);
        std::vector<double> shares;
        const Filling together =
            fill_grains(s.cells, 26.0, 7, {.team = &team, .tell = [&](double share) { shares.push_back(share); }});
        EXPECT_EQ(together.centres, alone.centres);
        EXPECT_EQ(together.radii_m, alone.radii_m);
        EXPECT_EQ(together.particle_begin, alone.particle_begin);
        EXPECT_EQ(together.inside.size(), alone.inside.size());
        EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
        EXPECT_EQ(shares.back(), 1.0);
    }
}

/// A grain of twice the area has about twice as many: the ring's discs are whole, so single grains scatter by two or three.
TEST(Filling, CountGoesWithTheArea) {
    const Specimen s = make_specimen(filled(rectangle(0.04, 0.06)), 1);
    double squares = 0.0;
    const double per_area = published_particles_per_grain * s.quality.grains / s.outline.area_m2;
    for (int g = 0; g < s.quality.grains; ++g) {
        const double expected = per_area * signed_area(corners_of(s.cells, g));
        squares += std::pow(s.filling.particle_begin[g + 1] - s.filling.particle_begin[g] - expected, 2);
    }
    EXPECT_LT(std::sqrt(squares / s.quality.grains), 2.5);
}

/// Mean of n n over the contacts: half the unit tensor, to 2 %, if no direction is preferred. The scatter of independent
/// directions is sqrt(1 / (8 N)), here 0.2 %; those of one grain hang together.
TEST(Filling, PrefersNoDirection) {
    const Specimen s = make_specimen(filled(rectangle()), 1);
    const auto expect_isotropic = [&](const auto& contacts) {
        double xx = 0.0, xy = 0.0;
        for (const auto& c : contacts) {
            const Vec2 apart = s.filling.centres[c.b] - s.filling.centres[c.a];
            xx += apart.x * apart.x / dot(apart, apart);
            xy += apart.x * apart.y / dot(apart, apart);
        }
        EXPECT_NEAR(xx / static_cast<double>(contacts.size()), 0.5, 0.01);
        EXPECT_NEAR(xy / static_cast<double>(contacts.size()), 0.0, 0.01);
    };
    expect_isotropic(s.filling.inside);
    expect_isotropic(s.filling.across);
}

/// Boundaries are rough, but lean neither way: the mean sine of the angle between the line of centres and the edge's normal
/// is zero, with a scatter of 0.4 / sqrt(N) = 0.3 %; the mean of its size is that of a zigzag.
TEST(Filling, BoundariesAreRoughWithoutLeaning) {
    const Specimen s = make_specimen(filled(rectangle()), 2);
    double lean = 0.0, roughness = 0.0;
    for (const AcrossContact& c : s.filling.across) {
        const auto [from, to] = edge_of(s.cells, c.cell_a, c.edge_a);
        const Vec2 apart = s.filling.centres[c.b] - s.filling.centres[c.a];
        const double sine = dot(apart, to - from) / (norm(apart) * norm(to - from));
        lean += sine;
        roughness += std::abs(sine);
    }
    const double count = static_cast<double>(s.filling.across.size());
    EXPECT_NEAR(lean / count, 0.0, 0.015);
    EXPECT_GT(roughness / count, 0.25);
}

/// In the interior of a grain, away from the looser ring: six in a full triangulation, of which (S9) leaves out the long ones.
TEST(Filling, InnerParticlesHaveFiveToSixContacts) {
    const Specimen s = make_specimen(filled(rectangle(0.04, 0.06)), 1);
    double ends = 0.0;
    for (const InsideContact& c : s.filling.inside) {
        ends += s.filling.places[c.a] == ParticlePlace::interior ? 1.0 : 0.0;
        ends += s.filling.places[c.b] == ParticlePlace::interior ? 1.0 : 0.0;
    }
    const auto inner = std::count(s.filling.places.begin(), s.filling.places.end(), ParticlePlace::interior);
    EXPECT_GT(ends / static_cast<double>(inner), 5.0);
    EXPECT_LT(ends / static_cast<double>(inner), 6.0);
}

TEST(Filling, RowsTouchTheirEdge) {
    const Specimen s = make_specimen(filled(rectangle(0.03, 0.03)), 1);
    for (const OutlineShare& share : s.filling.outline) {
        if (s.filling.places[share.particle] != ParticlePlace::edge) continue;
        const auto [from, to] = edge_of(s.cells, share.cell, share.edge);
        const double height = cross(to - from, s.filling.centres[share.particle] - from) / norm(to - from);
        EXPECT_NEAR(height, s.filling.radii_m[share.particle], 1e-9 * s.filling.radii_m[share.particle]);
    }
}

TEST(Filling, FillsSingleCellsOfAnyShape) {
    const std::vector<std::vector<Vec2>> shapes = {
        {{0, 0}, {1, 0}, {0.5, 0.866}},                    // triangle
        {{0, 0}, {3, 0}, {0.1, 0.5}},                      // with a narrow corner
        {{0, 0}, {5, 0}, {5, 1}, {0, 1}},                  // strip, narrower than two discs of seven
        {{0, 0}, {1, 0}, {1.01, 0.01}, {1, 1}, {0, 1}},    // with an edge too short for a disc
        {{0, 0}, {0.5, 0}, {1, 0}, {1, 1}, {0, 1}},        // with a straight corner
        {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},  // bends around a corner
    };
    for (const auto& shape : shapes) {
        for (const double number : {7.0, 26.0, 100.0}) {
            const Tessellation cells = one_cell(shape);
            const Filling f = fill_grains(cells, number, 1);
            expect_sound(cells, f);
            // Seven have no room where the cell is narrow: the discs become smaller, and more.
            if (number > 7.0) {
                EXPECT_NEAR(static_cast<double>(f.centres.size()), number, 0.1 * number);
            }
            EXPECT_TRUE(f.across.empty());
        }
    }
}

/// A sliver of a tenth of its neighbour's width is too small for the common disc: it gets smaller ones.
TEST(Filling, GrainsTooSmallForTheCommonDiscGetSmallerOnes) {
    const Tessellation cells = cells_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {1.1, 0}, {1.1, 1}}, {{0, 1, 2, 3}, {1, 4, 5, 2}});
    const Filling f = fill_grains(cells, 10.0, 1);
    expect_sound(cells, f);
    EXPECT_LT(f.radii_m.back(), 0.6 * f.radii_m.front());
    EXPECT_GE(f.particle_begin[2] - f.particle_begin[1], 3);
}

}  // namespace
}  // namespace feldspar
