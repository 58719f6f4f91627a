// Specimens drawn at random: outlines, holes, notches, cuts, sizes of grains, fillings, minerals and joints. Each one is made and
// fills its outline, its cells name each other and its triangles stand upright; or it is refused with an InputError that says
// why.
//
//   FELDSPAR_CASES=2000 build/release/properties_test        more of them
//   FELDSPAR_CASE=17 build/release/properties_test           this one alone
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "../table7.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/model/texture.hpp"
#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {
namespace {

// Draws that are the same with every compiler and library.
class Draw {
public:
    explicit Draw(std::uint64_t number) : engine_(number) {}
    double uniform(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }
    int whole(int low, int high) { return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1)); }
    bool chance(double share) { return uniform(0.0, 1.0) < share; }
    Vec2 in_box(const Box& box) { return {uniform(box.lower.x, box.upper.x), uniform(box.lower.y, box.upper.y)}; }

private:
    std::mt19937_64 engine_;
};

// Corners at random distances around a middle: simple, but it may be concave, and thin as a needle.
std::vector<Vec2> star(Draw& draw, Vec2 middle, double size_m, int corners) {
    std::vector<double> angles(static_cast<std::size_t>(corners));
    for (double& angle : angles) angle = draw.uniform(0.0, 2.0 * std::numbers::pi);
    std::sort(angles.begin(), angles.end());
    std::vector<Vec2> polygon;
    for (const double angle : angles)
        polygon.push_back(middle + draw.uniform(0.15, 1.0) * size_m * Vec2{std::cos(angle), std::sin(angle)});
    if (draw.chance(0.3)) std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

OutlineSpec random_outline(Draw& draw) {
    OutlineSpec outline;
    outline.shape = static_cast<Shape>(draw.whole(0, 4));
    outline.width_m = draw.uniform(0.01, 0.04);
    outline.height_m = draw.uniform(0.01, 0.04);
    outline.diameter_m = draw.uniform(0.015, 0.04);
    outline.hole_diameter_m = draw.uniform(0.1, 0.8) * outline.diameter_m;
    if (outline.shape == Shape::disc && draw.chance(0.4)) outline.flat_angle_rad = draw.uniform(0.05, 1.5);
    if (outline.shape == Shape::polygon) {
        outline.vertices_m = star(draw, {draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0)}, 0.02, draw.whole(3, 12));
        if (draw.chance(0.3)) {
            const int edge = draw.whole(0, static_cast<int>(outline.vertices_m.size()) - 1);
            const Vec2 a = outline.vertices_m[static_cast<std::size_t>(edge)],
                       b = outline.vertices_m[static_cast<std::size_t>(edge + 1) % outline.vertices_m.size()];
            outline.arcs = {{edge, 0.5 * (a + b) + draw.uniform(-0.4, 0.4) * Vec2{a.y - b.y, b.x - a.x}}};
        }
    }
    return outline;
}

void add_random_cutouts(Draw& draw, const Box& around, OutlineSpec& outline) {
    const Vec2 middle = 0.5 * (around.lower + around.upper),
               half = (draw.chance(0.8) ? 0.3 : 0.6) * (around.upper - around.lower);  // most of them well inside
    const Box box{middle - half, middle + half};
    const double size = std::min(box.upper.x - box.lower.x, box.upper.y - box.lower.y);
    for (int holes = draw.chance(0.25) ? draw.whole(1, 2) : 0; holes > 0; --holes) {
        HoleSpec hole;
        if (draw.chance(0.6))
            hole = {draw.in_box(box), draw.uniform(0.2, 0.6) * size, {}, {}};
        else
            hole.vertices_m = star(draw, draw.in_box(box), draw.uniform(0.1, 0.3) * size, draw.whole(3, 7));
        outline.holes.push_back(hole);
    }
    for (int notches = draw.chance(0.25) ? draw.whole(1, 2) : 0; notches > 0; --notches) {
        NotchSpec notch{draw.in_box(box), draw.in_box(box), draw.chance(0.5) ? 0.0 : draw.uniform(0.0001, 0.003), {}, false};
        if (notch.width_m == 0.0) notch.joined = draw.chance(0.3);
        outline.notches.push_back(notch);
    }
}

GrainSizeSpec random_sizes(Draw& draw, double mean_m) {
    GrainSizeSpec sizes;
    sizes.kind = static_cast<GrainSizeKind>(draw.whole(0, 2));
    if (sizes.kind == GrainSizeKind::uniform) {
        const double half = draw.uniform(0.0, 0.7) * mean_m;
        sizes.minimum_m = mean_m - half;
        sizes.maximum_m = mean_m + half;
    } else if (sizes.kind == GrainSizeKind::log_normal) {
        sizes.median_m = mean_m;
        sizes.log_standard_deviation = draw.uniform(0.05, 0.6);
        sizes.minimum_m = draw.uniform(0.3, 0.8) * mean_m;
        sizes.maximum_m = draw.uniform(1.2, 3.0) * mean_m;
    } else {
        double diameter = draw.uniform(0.3, 0.9) * mean_m, passing = 0.0;
        sizes.sieve = {{diameter, 0.0}};
        for (int rows = draw.whole(1, 4); rows > 0; --rows) {
            diameter *= draw.uniform(1.05, 1.8);
            passing = rows == 1 ? 1.0 : draw.chance(0.2) ? passing : draw.uniform(passing, 1.0);
            sizes.sieve.push_back({diameter, passing});
        }
    }
    return sizes;
}

SpecimenSpec random_specimen(Draw& draw) {
    SpecimenSpec spec;
    spec.outline = random_outline(draw);
    const Box box = bounding_box(spec.outline);
    add_random_cutouts(draw, box, spec.outline);
    const double area = (box.upper.x - box.lower.x) * (box.upper.y - box.lower.y);
    spec.grain_sizes = random_sizes(draw, std::sqrt(area / draw.uniform(30.0, 200.0)));
    spec.porosity = draw.uniform(0.05, 0.25);
    if (draw.chance(0.3)) spec.merge_length_m = draw.chance(0.3) ? 0.0 : draw.uniform(0.0, 0.3) * std::sqrt(area / 250.0);
    if (draw.chance(0.2)) spec.triangles_per_grain = draw.whole(4, 60);
    if (draw.chance(0.2)) spec.particles_per_grain = draw.uniform(8.0, 20.0);
    if (draw.chance(0.1)) spec.crystal_sizes = random_sizes(draw, std::sqrt(area / 15.0));
    return spec;
}

Heterogeneity random_rock(Draw& draw, const Specimen& specimen) {
    Heterogeneity rock;
    const Box box = bounding_box(specimen.outline);
    double rest = 1.0;
    for (int left = draw.whole(1, 4); left > 0 && draw.chance(0.9); --left) {
        const double share = left == 1 ? rest : draw.uniform(0.0, rest);
        rock.minerals.phases.push_back(
            {fmt::format("mineral-{}", left), share, {draw.uniform(10e9, 90e9), draw.uniform(0.05, 0.4), 2700.0}, 0, -1});
        rest -= share;
    }
    if (!rock.minerals.phases.empty())
        rock.minerals.phases.back().share += rest > 0.0 && rock.minerals.phases.back().share < rest ? rest : 0.0;
    double sum = 0.0;
    for (const Mineral& phase : rock.minerals.phases) sum += phase.share;
    for (Mineral& phase : rock.minerals.phases) phase.share /= sum;
    if (draw.chance(0.3)) rock.minerals.cluster_length_m = draw.uniform(0.001, 0.02);
    for (int joints = draw.whole(0, 2); joints > 0; --joints) {
        JointSpec joint;
        joint.name = fmt::format("joint-{}", joints);
        joint.contact = fixtures::table7();
        if (draw.chance(0.3)) {
            joint.set = JointSet{draw.uniform(-1.5, 1.5),
                                 draw.uniform(0.0, 0.3),
                                 draw.uniform(0.003, 0.02),
                                 draw.uniform(0.0, 1.0),
                                 draw.chance(0.5) ? 0.0 : draw.uniform(0.005, 0.02),
                                 0.2,
                                 draw.uniform(0.3, 1.0)};
        } else {
            joint.lines_m = {{draw.in_box(box), draw.in_box(box)}};
            if (draw.chance(0.4)) joint.lines_m.front().push_back(draw.in_box(box));
        }
        rock.joints.push_back(joint);
    }
    return rock;
}

// An edge of a cell that has a neighbour is an edge of the neighbour, the other way round, and this names the cell back.
void expect_neighbours_to_agree(const Tessellation& cells) {
    std::map<std::pair<int, int>, std::pair<int, int>> cell_and_neighbour;  // of a directed edge
    for (int c = 0; c < std::ssize(cells.cells); ++c) {
        const Cell& cell = cells.cells[static_cast<std::size_t>(c)];
        ASSERT_GE(cell.vertices.size(), 3U);
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            const int from = cell.vertices[k], to = cell.vertices[(k + 1) % cell.vertices.size()];
            EXPECT_TRUE(cell_and_neighbour.emplace(std::pair{from, to}, std::pair{c, cell.neighbours[k]}).second)
                << "two cells on one side of an edge";
            EXPECT_EQ(cell.neighbours[k] < 0, cell.outline_edges[k] >= 0)
                << "an edge of cell " << c << " lies neither inside nor on the outline";
        }
    }
    for (const auto& [edge, both] : cell_and_neighbour) {
        const auto [cell, neighbour] = both;
        const auto back = cell_and_neighbour.find({edge.second, edge.first});
        if (neighbour < 0) continue;
        ASSERT_NE(back, cell_and_neighbour.end()) << "cell " << cell << " names " << neighbour << ", which has no such edge";
        EXPECT_EQ(back->second, (std::pair{neighbour, cell}));
    }
}

// Triangles stand upright and add up to their cells; cells add up to the rock.
void expect_to_fill(const Specimen& specimen) {
    double all = 0.0;
    for (int c = 0; c < std::ssize(specimen.cells.cells); ++c) {
        const std::vector<Vec2> corners = corners_of_cell(specimen.cells, c);
        EXPECT_TRUE(is_simple_polygon(corners)) << "cell " << c;
        const double area = signed_area(corners);
        EXPECT_GT(area, 0.0) << "cell " << c;
        all += area;
        double triangles = 0.0;
        for (int t = specimen.mesh.triangle_begin[static_cast<std::size_t>(c)];
             t < specimen.mesh.triangle_begin[static_cast<std::size_t>(c) + 1]; ++t) {
            std::vector<Vec2> triangle;
            for (const int node : specimen.mesh.triangles[static_cast<std::size_t>(t)])
                triangle.push_back(specimen.mesh.nodes[static_cast<std::size_t>(node)]);
            EXPECT_GT(signed_area(triangle), 0.0) << "triangle " << t << " of cell " << c;
            triangles += signed_area(triangle);
        }
        EXPECT_NEAR(triangles / area, 1.0, 1e-9) << "cell " << c;
    }
    EXPECT_LT(specimen.quality.area_error, 1e-9);
    if (!specimen.outline.is_disc) {  // of a disc chords stand for the circle
        EXPECT_NEAR(all / specimen.outline.area_m2, 1.0, 1e-9);
    }
}

void expect_rock_to_fit(const Specimen& specimen, const Heterogeneity& rock) {
    const Texture texture(specimen, {25.8e9, 0.23, 2650.0}, fixtures::table7(), rock);
    if (!rock.minerals.phases.empty()) {
        ASSERT_EQ(texture.phases().size(), specimen.cells.cells.size());
        for (const int phase : texture.phases()) {
            EXPECT_GE(phase, 0);
            EXPECT_LT(phase, std::ssize(rock.minerals.phases));
        }
        double shares = 0.0;
        for (const double share : texture.summary().area_shares) shares += share;
        EXPECT_NEAR(shares, 1.0, 1e-9);
    }
    for (int a = 0; a < std::ssize(specimen.cells.cells); ++a) {
        EXPECT_GT(texture.grain(a).E_Pa, 0.0);
        const Cell& cell = specimen.cells.cells[static_cast<std::size_t>(a)];
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            const int b = cell.neighbours[k];
            if (b < 0) continue;
            const Vec2 from = specimen.cells.vertices[static_cast<std::size_t>(cell.vertices[k])],
                       to = specimen.cells.vertices[static_cast<std::size_t>(cell.vertices[(k + 1) % cell.vertices.size()])];
            const GrainContact there = texture.contact(a, b, from, to), back = texture.contact(b, a, to, from);
            EXPECT_EQ(there.joint, back.joint) << "a joint has one face only";
            EXPECT_EQ(there.material.sigma_nt_Pa, back.material.sigma_nt_Pa);
            EXPECT_GT(there.material.Kn_Pa_m, 0.0);
        }
    }
}

int number_of(const char* variable, int otherwise) {
    const char* text = std::getenv(variable);
    return text == nullptr ? otherwise : std::atoi(text);
}

TEST(RandomSpecimens, AreMadeWholeOrRefused) {
    const int only = number_of("FELDSPAR_CASE", -1), count = number_of("FELDSPAR_CASES", 250);
    int made = 0, refused = 0;
    std::map<std::string, int> reasons;
    for (int number = only < 0 ? 0 : only; number < (only < 0 ? count : only + 1); ++number) {
        SCOPED_TRACE(fmt::format("FELDSPAR_CASE={}", number));
        Draw draw(static_cast<std::uint64_t>(number) + 1);
        try {
            const SpecimenSpec spec = random_specimen(draw);
            const Specimen specimen = make_specimen(spec, static_cast<std::uint64_t>(number));
            ++made;
            expect_neighbours_to_agree(specimen.cells);
            expect_to_fill(specimen);
            try {
                expect_rock_to_fit(specimen, random_rock(draw, specimen));
            } catch (const InputError& error) {
                EXPECT_FALSE(error.problem().empty());
                ++reasons[error.problem()];
            }
        } catch (const InputError& error) {
            EXPECT_FALSE(error.problem().empty());
            ++refused;
            ++reasons[error.problem()];
        } catch (const std::exception& error) {
            ADD_FAILURE() << "neither made nor refused: " << error.what();
        }
    }
    if (std::getenv("FELDSPAR_CASES") != nullptr || only >= 0) {
        fmt::print("{} made, {} refused\n", made, refused);
        for (const auto& [reason, times] : reasons) fmt::print("  {:4} x {}\n", times, reason);
    }
    if (only < 0) {
        EXPECT_GT(made, count / 3) << "the draws ask for too much to show anything";
    }
}

}  // namespace
}  // namespace feldspar
