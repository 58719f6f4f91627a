// Triangles inside the grains: counts, areas, topology, and one triangle for each outer edge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/mesh_grains.hpp"
#include "sample_specimens.hpp"

namespace feldspar {
namespace {

double area_of(const GrainMesh& mesh, const std::array<int, 3>& t) {
    return 0.5 * cross(mesh.nodes[t[1]] - mesh.nodes[t[0]], mesh.nodes[t[2]] - mesh.nodes[t[0]]);
}

/// A single cell.
Tessellation one_cell(std::vector<Vec2> vertices) {
    Tessellation t;
    t.vertices = std::move(vertices);
    Cell cell;
    for (int k = 0; k < std::ssize(t.vertices); ++k) {
        cell.vertices.push_back(k);
        cell.neighbours.push_back(-1);
        cell.outline_edges.push_back(k);
    }
    t.cells.push_back(cell);
    return t;
}

Tessellation regular_cell(int corners) {
    std::vector<Vec2> vertices;
    for (int k = 0; k < corners; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / corners;
        vertices.push_back({std::cos(angle), std::sin(angle)});
    }
    return one_cell(std::move(vertices));
}

class MeshOf : public testing::TestWithParam<int> {};

TEST_P(MeshOf, TilesEveryGrainAndOwnsEveryEdgeOnce) {
    for (const SpecimenSpec& outline : {rectangle(0.04, 0.06), disc(0.05), ell()}) {
        SpecimenSpec spec = outline;
        spec.triangles_per_grain = GetParam();
        const Specimen s = make_specimen(spec, 1);
        const GrainMesh& mesh = s.mesh;
        ASSERT_EQ(mesh.node_begin.size(), s.cells.cells.size() + 1);
        ASSERT_EQ(mesh.triangle_begin.back(), std::ssize(mesh.triangles));
        for (int g = 0; g < std::ssize(s.cells.cells); ++g) {
            const Cell& cell = s.cells.cells[g];
            const int n = static_cast<int>(cell.vertices.size());
            const int first = mesh.node_begin[g];
            std::vector<Vec2> corners;
            for (const int v : cell.vertices) corners.push_back(s.cells.vertices[v]);
            ASSERT_EQ(mesh.vertex_count[g], n);
            ASSERT_EQ(mesh.centre_node[g], first + n);
            for (int k = 0; k < n; ++k) EXPECT_EQ(mesh.nodes[first + k], corners[k]);

            double area = 0.0;
            for (int t = mesh.triangle_begin[g]; t < mesh.triangle_begin[g + 1]; ++t) {
                EXPECT_GT(area_of(mesh, mesh.triangles[t]), 0.0);
                area += area_of(mesh, mesh.triangles[t]);
                for (const int node : mesh.triangles[t]) {
                    EXPECT_GE(node, first);
                    EXPECT_LT(node, mesh.node_begin[g + 1]);
                }
            }
            EXPECT_NEAR(area / signed_area(corners), 1.0, 1e-12);
            for (int k = 0; k < n; ++k) {
                const auto& t = mesh.triangles[mesh.edge_triangle[mesh.edge_begin[g] + k]];
                int times = 0;
                for (int e = 0; e < 3; ++e) times += t[e] == first + k && t[(e + 1) % 3] == first + (k + 1) % n ? 1 : 0;
                EXPECT_EQ(times, 1) << "grain " << g << " edge " << k;
            }
            for (int node = first + n; node < mesh.node_begin[g + 1]; ++node) {
                EXPECT_GT(distance_to_boundary(corners, mesh.nodes[node]), 0.0) << "a node on an edge";
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(TrianglesPerGrain, MeshOf, testing::Values(0, 10, 40, 100));

TEST(FixedTopology, CountsFollowFromTheVertexNumberAndTheCollapse) {
    const Specimen s = make_specimen(rectangle(), 1);
    int collapsed = 0;
    for (int g = 0; g < s.quality.grains; ++g) {
        const int n = s.mesh.vertex_count[g];
        const int nodes = s.mesh.node_begin[g + 1] - s.mesh.node_begin[g];
        const int triangles = s.mesh.triangle_begin[g + 1] - s.mesh.triangle_begin[g];
        const bool whole = nodes == 2 * n + 1 && triangles == 3 * n;
        const bool shortened = nodes == 2 * n && triangles == 3 * n - 2;
        EXPECT_TRUE(whole || shortened) << "grain " << g;
        EXPECT_TRUE(n > 3 || whole) << "grain " << g;
        collapsed += shortened ? 1 : 0;
    }
    EXPECT_GT(collapsed, s.quality.grains * 9 / 10);
}

TEST(FixedTopology, GrainsOfOneKindHaveTheSameTriangles) {
    const Specimen s = make_specimen(rectangle(), 1);
    std::map<std::pair<int, int>, std::vector<std::array<int, 3>>> pattern;
    for (int g = 0; g < s.quality.grains; ++g) {
        std::vector<std::array<int, 3>> local;
        for (int t = s.mesh.triangle_begin[g]; t < s.mesh.triangle_begin[g + 1]; ++t) {
            local.push_back(s.mesh.triangles[t]);
            for (int& node : local.back()) node -= s.mesh.node_begin[g];
        }
        const std::pair kind(s.mesh.vertex_count[g], static_cast<int>(local.size()));
        const auto known = pattern.emplace(kind, local).first;
        EXPECT_EQ(known->second, local) << "grain " << g << " of " << kind.first << " vertices";
    }
    EXPECT_GT(pattern.size(), 4U);
}

TEST(FixedTopology, CollapsedRingEdgeIsItsMidpoint) {
    const Tessellation cell = one_cell({{0, 0}, {2, 0}, {2.2, 1}, {1, 2}, {0, 1}, {-0.1, 0.5}});  // the last two edges are equal
    const GrainMesh mesh = mesh_grains(cell, 0);
    ASSERT_EQ(mesh.nodes.size(), 12U);
    ASSERT_EQ(mesh.triangles.size(), 16U);
    const Vec2 c = mesh.nodes[6];
    const Vec2 expected = centroid(cell.vertices);
    EXPECT_NEAR(norm(c - expected), 0.0, 1e-15);
    const Vec2 midpoint = c + 0.5 * (0.5 * (cell.vertices[5] + cell.vertices[0]) - c);
    EXPECT_NEAR(norm(mesh.nodes[7] - midpoint), 0.0, 1e-15);
    EXPECT_NEAR(norm(mesh.nodes[8] - (c + 0.5 * (cell.vertices[1] - c))), 0.0, 1e-15);
    EXPECT_EQ(mesh.triangles.back(), (std::array<int, 3>{5, 0, 7})) << "of the collapsed edge only its own triangle is left";
}

TEST(FixedTopology, TrianglesAndFlatFansKeepTheWholeRing) {
    const GrainMesh three = mesh_grains(regular_cell(3), 0);
    EXPECT_EQ(three.nodes.size(), 7U);
    EXPECT_EQ(three.triangles.size(), 9U);
    const GrainMesh six = mesh_grains(regular_cell(6), 0);
    EXPECT_EQ(six.nodes.size(), 12U);
    // A triangle with a vertex in the middle of its left side. The shortest edge collapsed, the line from the opposite corner
    // to its midpoint is a median, on which the centroid lies: a triangle without area.
    const GrainMesh almost_three = mesh_grains(one_cell({{0, 2}, {-0.01, 0}, {0, -2}, {1.2, 1.5}}), 0);
    EXPECT_EQ(almost_three.nodes.size(), 9U);
    EXPECT_EQ(almost_three.triangles.size(), 12U);
}

TEST(FixedTopology, CentreOfACellThatBendsSeesAllOfIt) {
    // An arrowhead around a re-entrant corner: the centroid lies outside its kernel.
    const Tessellation bent = one_cell({{0, 0}, {4, 0}, {4, 0.5}, {0.5, 0.5}, {0.5, 4}, {0, 4}});
    const GrainMesh mesh = mesh_grains(bent, 0);
    double area = 0.0;
    for (const auto& t : mesh.triangles) {
        EXPECT_GT(area_of(mesh, t), 0.0);
        area += area_of(mesh, t);
    }
    EXPECT_NEAR(area, signed_area(bent.vertices), 1e-14);
    const Tessellation zigzag =
        one_cell({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}});  // a U sees itself from nowhere
    EXPECT_THROW(mesh_grains(zigzag, 0), InputError);
}

TEST(FineMesh, ComesNearTheNumberAskedFor) {
    for (const int wanted : {20, 50, 200}) {
        const GrainMesh mesh = mesh_grains(regular_cell(6), wanted);
        EXPECT_NEAR(static_cast<double>(mesh.triangles.size()), wanted, 0.35 * wanted) << wanted;
    }
}

TEST(FineMesh, IsTheFixedOneWhereAVertexLiesInAStraightSide) {
    // the grain ahead of a notch whose end is the fifth vertex
    const GrainMesh mesh = mesh_grains(one_cell({{0.0082476775103451014, 0.020973099798594099},
                                                 {0.0086720805297596619, 0.018303988357690783},
                                                 {0.011009132445100749, 0.018130005928428481},
                                                 {0.011464111623434373, 0.018568696851776572},
                                                 {0.0088338053366169324, 0.02080921856686473},
                                                 {0.0084120875993093248, 0.021168442035557719}}),
                                       30);
    for (const auto& t : mesh.triangles) EXPECT_GT(area_of(mesh, t), 1e-9 * 5e-6);
}

}  // namespace
}  // namespace feldspar
