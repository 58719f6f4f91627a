// The Laguerre cells: a partition of the outline on one vertex graph, and the right one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "feldspar/base/error.hpp"
#include "feldspar/base/rng.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/tessellate_laguerre.hpp"
#include "sample_specimens.hpp"

namespace feldspar {
namespace {

std::vector<Vec2> corners_of(const Tessellation& t, const Cell& cell) {
    std::vector<Vec2> corners;
    for (const int v : cell.vertices) corners.push_back(t.vertices[v]);
    return corners;
}

double total_area(const Tessellation& t) {
    double area = 0.0;
    for (const Cell& cell : t.cells) area += signed_area(corners_of(t, cell));
    return area;
}

Packing packing_of(std::vector<Vec2> centres, std::vector<double> radii) {
    Packing packing;
    packing.centres = std::move(centres);
    packing.radii_m = std::move(radii);
    return packing;
}

struct Case {
    const char* name;
    SpecimenSpec spec;
};

class Cells : public testing::TestWithParam<Case> {
protected:
    const Specimen s = make_specimen(GetParam().spec, 3);
};

TEST_P(Cells, ShareTheirEdgesExactly) {
    std::map<std::pair<int, int>, int> owner;
    for (int i = 0; i < std::ssize(s.cells.cells); ++i) {
        const Cell& cell = s.cells.cells[i];
        const std::size_t n = cell.vertices.size();
        ASSERT_EQ(cell.neighbours.size(), n);
        ASSERT_EQ(cell.outline_edges.size(), n);
        for (std::size_t k = 0; k < n; ++k) {
            EXPECT_TRUE(owner.emplace(std::pair(cell.vertices[k], cell.vertices[(k + 1) % n]), i).second)
                << "an edge named twice";
            EXPECT_NE(cell.neighbours[k] < 0, cell.outline_edges[k] < 0) << "either a neighbour or an outline edge";
        }
    }
    for (int i = 0; i < std::ssize(s.cells.cells); ++i) {
        const Cell& cell = s.cells.cells[i];
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            const auto other = owner.find({cell.vertices[(k + 1) % cell.vertices.size()], cell.vertices[k]});
            EXPECT_EQ(other == owner.end() ? -1 : other->second, cell.neighbours[k]) << "edge " << k << " of cell " << i;
        }
    }
}

TEST_P(Cells, FillTheOutline) {
    if (s.outline.is_disc) {
        std::vector<Vec2> rim;  // the vertices on the circle, by angle: the polygon of the chords
        for (const Vec2 v : s.cells.vertices) {
            if (std::abs(norm(v) - s.outline.radius_m) < 1e-12 ||
                (s.outline.flattened() && std::abs(v.y) == s.outline.flat_height_m))
                rim.push_back(v);
        }
        std::sort(rim.begin(), rim.end(), [](Vec2 a, Vec2 b) { return std::atan2(a.y, a.x) < std::atan2(b.y, b.x); });
        EXPECT_NEAR(total_area(s.cells) / signed_area(rim), 1.0, 1e-12);
        EXPECT_LT(total_area(s.cells), s.outline.area_m2);
    } else {
        EXPECT_NEAR(total_area(s.cells) / s.outline.area_m2, 1.0, 1e-12);
    }
    EXPECT_LT(s.quality.area_error, 1e-9);
}

TEST_P(Cells, HaveNoUnusedVertexAndStandInThePackingsOrder) {
    std::set<int> used;
    ASSERT_EQ(s.cells.cells.size(), s.packing.centres.size());
    for (std::size_t i = 0; i < s.cells.cells.size(); ++i) {
        used.insert(s.cells.cells[i].vertices.begin(), s.cells.cells[i].vertices.end());
        EXPECT_GT(signed_area(corners_of(s.cells, s.cells.cells[i])), 0.0);
        EXPECT_LT(distance_to_boundary(corners_of(s.cells, s.cells.cells[i]), s.packing.centres[i]), 0.004);
    }
    EXPECT_EQ(used.size(), s.cells.vertices.size());
}

TEST_P(Cells, OutlineEdgesLieOnTheOutlineTheyName) {
    std::map<int, double> length;
    for (const Cell& cell : s.cells.cells) {
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            const int edge = cell.outline_edges[k];
            if (edge < 0) continue;
            const Vec2 a = s.cells.vertices[cell.vertices[k]],
                       b = s.cells.vertices[cell.vertices[(k + 1) % cell.vertices.size()]];
            length[edge] += norm(b - a);
            for (const Vec2 p : {a, b}) {
                const double off = s.outline.is_disc && edge != circle_edge ? std::abs(p.y) - s.outline.flat_height_m
                                   : s.outline.is_disc
                                       ? norm(p) - s.outline.radius_m
                                       : distance_to_segment(p, s.outline.vertices[edge],
                                                             s.outline.vertices[(edge + 1) % s.outline.vertices.size()]);
                EXPECT_NEAR(off, 0.0, 1e-15);
                if (s.outline.is_disc) continue;
                const Vec2 from = s.outline.vertices[edge], to = s.outline.vertices[(edge + 1) % s.outline.vertices.size()];
                EXPECT_TRUE(from.x != to.x || p.x == from.x) << "exactly on an upright side";
                EXPECT_TRUE(from.y != to.y || p.y == from.y) << "exactly on a level side";
            }
        }
    }
    EXPECT_EQ(length.size(), s.outline.edge_labels.size());
    if (s.outline.flattened()) {
        const auto corners = flat_corners(s.outline);
        EXPECT_NEAR(length.at(top_flat), norm(corners[1] - corners[0]), 1e-12);
        EXPECT_NEAR(length.at(bottom_flat), norm(corners[3] - corners[2]), 1e-12);
    }
    for (const auto& [edge, sum] : length) {
        if (s.outline.is_disc) continue;
        EXPECT_NEAR(sum, norm(s.outline.vertices[(edge + 1) % s.outline.vertices.size()] - s.outline.vertices[edge]), 1e-12);
    }
}

TEST_P(Cells, OutlineCornersNeverMove) {
    std::vector<Vec2> corners = s.outline.vertices;
    if (s.outline.flattened()) {
        const auto flats = flat_corners(s.outline);
        corners.assign(flats.begin(), flats.end());
    }
    for (const Vec2 corner : corners) {
        EXPECT_EQ(std::count(s.cells.vertices.begin(), s.cells.vertices.end(), corner), 1) << corner.x << ", " << corner.y;
    }
}

TEST_P(Cells, ShortestEdgeIsTheLast) {
    for (const Cell& cell : s.cells.cells) {
        const auto c = corners_of(s.cells, cell);
        const double last = norm(c.front() - c.back());
        for (std::size_t k = 0; k + 1 < c.size(); ++k) EXPECT_GE(norm(c[k + 1] - c[k]), last);
    }
}

INSTANTIATE_TEST_SUITE_P(Outlines, Cells,
                         testing::Values(Case{"rectangle", rectangle(0.04, 0.06)}, Case{"disc", disc(0.05)},
                                         Case{"flattened_disc", flattened_disc(0.05)},
                                         Case{"wide_flats", flattened_disc(0.05, 40.0)}, Case{"triangle", triangle()},
                                         Case{"round_sides", round_sides()}, Case{"ell", ell()}, Case{"slit", slit()},
                                         Case{"split_sides", split_sides()}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

/// Without merging, a point lies in the cell of the disc to which its power is least.
void expect_least_power(const SpecimenSpec& base) {
    SpecimenSpec spec = base;
    spec.merge_length_m = 0.0;
    const Specimen s = make_specimen(spec, 2);
    const Box box = bounding_box(s.outline);
    RandomStream random(1, "probe");
    int tested = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const double x = random.uniform(box.lower.x, box.upper.x);
        const Vec2 p = {x, random.uniform(box.lower.y, box.upper.y)};
        std::size_t best = 0;
        const auto power = [&](std::size_t i) {
            const Vec2 d = p - s.packing.centres[i];
            return dot(d, d) - s.packing.radii_m[i] * s.packing.radii_m[i];
        };
        for (std::size_t i = 0; i < s.packing.centres.size(); ++i) best = power(i) < power(best) ? i : best;
        bool any = false;
        for (const Cell& cell : s.cells.cells) any = any || contains(corners_of(s.cells, cell), p);
        if (!any) continue;
        ++tested;
        EXPECT_TRUE(contains(corners_of(s.cells, s.cells.cells[best]), p)) << p.x << ", " << p.y;
    }
    EXPECT_GT(tested, 900);
}

TEST(Laguerre, RectanglePointsBelongToTheDiscOfLeastPower) { expect_least_power(rectangle(0.03, 0.04)); }
TEST(Laguerre, DiscPointsBelongToTheDiscOfLeastPower) { expect_least_power(disc(0.03)); }
TEST(Laguerre, EllPointsBelongToTheDiscOfLeastPower) { expect_least_power(ell()); }

TEST(Laguerre, TwoGrainsMeetOnTheirPowerLine) {
    const Outline outline = make_outline(rectangle(0.004, 0.002).outline);
    const auto t = tessellate_laguerre(packing_of({{0.001, 0.001}, {0.003, 0.001}}, {0.0012, 0.0008}), outline, 0.0);
    ASSERT_EQ(t.cells.size(), 2U);
    EXPECT_EQ(t.vertices.size(), 6U);
    // |x - c_0|^2 - R_0^2 = |x - c_1|^2 - R_1^2 at x = 0.002 + (R_0^2 - R_1^2) / (2 * 0.002).
    EXPECT_NEAR(signed_area(corners_of(t, t.cells[0])), 0.0022 * 0.002, 1e-18);
}

TEST(Laguerre, OneGrainIsTheWholeOutline) {
    const Outline outline = make_outline(ell().outline);
    const auto t = tessellate_laguerre(packing_of({{0.01, 0.01}}, {0.01}), outline, 0.0);
    ASSERT_EQ(t.cells.size(), 1U);
    EXPECT_EQ(t.cells[0].vertices.size(), 6U);
    EXPECT_NEAR(total_area(t), outline.area_m2, 1e-18);
}

TEST(Laguerre, SquareLatticeHasFourFoldVertices) {
    // Four cells meet in each inner vertex; the diagonal that the triangulation had to choose leaves an edge of no length.
    std::vector<Vec2> centres;
    for (int i = 0; i < 10; ++i) {
        for (int j = 0; j < 10; ++j) centres.push_back({0.1 * i + 0.05, 0.1 * j + 0.05});
    }
    const Outline outline = make_outline(rectangle(1.0, 1.0).outline);
    const auto t = tessellate_laguerre(packing_of(centres, std::vector<double>(100, 0.05)), outline, 0.0);
    EXPECT_EQ(t.vertices.size(), 121U);
    EXPECT_EQ(t.merged_edges, 81);
    for (const Cell& cell : t.cells) {
        EXPECT_EQ(cell.vertices.size(), 4U);
        EXPECT_NEAR(signed_area(corners_of(t, cell)), 0.01, 1e-14);
    }
}

TEST(Laguerre, TriangularLatticeIsHexagons) {
    std::vector<Vec2> centres;
    const double row = std::sqrt(0.75);
    for (int j = 0; j < 9; ++j) {
        for (int i = 0; i < 9; ++i) centres.push_back({i + 0.75 + (j % 2 == 0 ? 0.0 : -0.5), row * (j + 0.5)});
    }
    const Outline outline = make_outline(rectangle(9.5, 9 * row).outline);
    const auto t = tessellate_laguerre(packing_of(centres, std::vector<double>(81, 0.5)), outline, 0.0);
    EXPECT_NEAR(total_area(t), 9.5 * 9 * row, 1e-12);
    const Cell& inner = t.cells[4 * 9 + 4];
    EXPECT_EQ(inner.vertices.size(), 6U);
    EXPECT_NEAR(signed_area(corners_of(t, inner)), row, 1e-13);
}

TEST(Laguerre, EqualDiscsAreRefused) {
    const Outline outline = make_outline(rectangle(1.0, 1.0).outline);
    const auto twice = packing_of({{0.2, 0.2}, {0.7, 0.7}, {0.2, 0.2}}, {0.1, 0.1, 0.1});
    try {
        tessellate_laguerre(twice, outline, 0.0);
        FAIL() << "equal discs were accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("discs 0 and 2 have the same centre"), std::string::npos) << error.what();
    }
}

TEST(Laguerre, HiddenAndOutsideDiscsAreRefused) {
    const Outline outline = make_outline(rectangle(1.0, 1.0).outline);
    const auto hidden = packing_of({{0.5, 0.5}, {0.3, 0.5}, {0.7, 0.5}, {0.5, 0.3}, {0.5, 0.7}}, {0.01, 0.3, 0.3, 0.3, 0.3});
    EXPECT_THROW(tessellate_laguerre(hidden, outline, 0.0), InputError);
    const auto outside = packing_of({{0.5, 0.5}, {5.0, 0.5}}, {0.3, 0.3});
    EXPECT_THROW(tessellate_laguerre(outside, outline, 0.0), InputError);
}

TEST(MergedEdges, NoneShorterIsLeftAndAreasAreKept) {
    SpecimenSpec spec = rectangle();
    const Specimen merged = make_specimen(spec, 1);
    spec.merge_length_m = 0.0;
    const Specimen whole = make_specimen(spec, 1);
    EXPECT_EQ(whole.quality.merged_edges, 0);
    EXPECT_GT(merged.quality.merged_edges, 20);
    EXPECT_EQ(whole.cells.vertices.size() - merged.cells.vertices.size(), static_cast<std::size_t>(merged.quality.merged_edges));
    EXPECT_LT(whole.quality.smallest_edge_m, 1e-4);
    EXPECT_GE(merged.quality.smallest_edge_m, merged.quality.mean_diameter_m / 12.0);
    EXPECT_NEAR(total_area(merged.cells), total_area(whole.cells), 1e-16);
}

TEST(MergedEdges, AbsurdMergeLengthStillGivesAPartition) {
    SpecimenSpec spec = rectangle(0.04, 0.04);
    spec.merge_length_m = 0.002;
    const Specimen s = make_specimen(spec, 1);
    EXPECT_NO_THROW(check_conforming(s.cells));
    EXPECT_LT(s.quality.area_error, 1e-12);
    for (const Cell& cell : s.cells.cells) EXPECT_GE(cell.vertices.size(), 3U);
}

TEST(Conforming, DamageIsFound) {
    const Specimen s = make_specimen(rectangle(0.03, 0.03), 1);
    EXPECT_NO_THROW(check_conforming(s.cells));
    Tessellation wrong_neighbour = s.cells;
    auto& neighbours = wrong_neighbour.cells[20].neighbours;
    *std::find_if(neighbours.begin(), neighbours.end(), [](int n) { return n >= 0; }) = 21 + 30;
    EXPECT_THROW(check_conforming(wrong_neighbour), NumericalError);
    Tessellation hanging = s.cells;  // a vertex of its own instead of the shared one: a T-junction
    hanging.vertices.push_back(hanging.vertices[hanging.cells[20].vertices[0]]);
    hanging.cells[20].vertices[0] = static_cast<int>(hanging.vertices.size()) - 1;
    EXPECT_THROW(check_conforming(hanging), NumericalError);
}

}  // namespace
}  // namespace feldspar
