// Half discs, rings, holes, notches and labels by place: properties over shapes and seeds.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>

#include "feldspar/base/error.hpp"
#include "feldspar/base/rng.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/cut_cells.hpp"
#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/tessellate_laguerre.hpp"
#include "sample_specimens.hpp"

namespace feldspar {
namespace {

double total_area(const Specimen& s) {
    double area = 0.0;
    for (int g = 0; g < s.quality.grains; ++g) area += signed_area(corners_of_cell(s.cells, g));
    return area;
}

SpecimenSpec notched_disc() {
    SpecimenSpec spec = disc(0.05);
    spec.outline.notches = {{{0.0, -0.01}, {0.0, 0.01}, 0.001, {}}};
    return spec;
}

SpecimenSpec notched_ell() {
    SpecimenSpec spec = ell();
    spec.outline.notches = {{{0.03, 0.02}, {0.03, 0.008}, 0.0, {}}, {{0.0, 0.03}, {0.01, 0.032}, 0.005, {}}};
    return spec;
}

struct Case {
    const char* name;
    SpecimenSpec spec;
};

class Cutouts : public testing::TestWithParam<std::tuple<Case, int>> {
protected:
    const SpecimenSpec& spec() const { return std::get<0>(GetParam()).spec; }
    const Specimen s = make_specimen(std::get<0>(GetParam()).spec, static_cast<std::uint64_t>(std::get<1>(GetParam())));

    Vec2 from(const Cell& cell, std::size_t k) const { return s.cells.vertices[cell.vertices[k]]; }
    Vec2 to(const Cell& cell, std::size_t k) const { return s.cells.vertices[cell.vertices[(k + 1) % cell.vertices.size()]]; }

    /// The ends of an edge of a cutout, by its number among the outline's edges; nothing for those of the outer boundary.
    std::optional<std::array<Vec2, 2>> cutout_edge(int edge) const {
        for (const Cutout& cutout : s.outline.cutouts) {
            const int k = edge - cutout.first_edge, n = static_cast<int>(cutout.vertices.size());
            if (k < 0 || k >= n) continue;
            if (cutout.is_cut()) return std::array{cutout.vertices[0], cutout.vertices[1]};
            return std::array{cutout.vertices[k], cutout.vertices[(k + 1) % n]};
        }
        return std::nullopt;
    }
};

TEST_P(Cutouts, CellsFillTheRockExactly) {
    EXPECT_NO_THROW(check_conforming(s.cells));
    EXPECT_LT(s.quality.area_error, 1e-9);
    if (!s.outline.is_disc) {
        EXPECT_NEAR(total_area(s) / s.outline.area_m2, 1.0, 1e-12);
    }
    for (int g = 0; g < s.quality.grains; ++g) {
        EXPECT_TRUE(is_simple_polygon(corners_of_cell(s.cells, g))) << "cell " << g;
        EXPECT_GT(signed_area(corners_of_cell(s.cells, g)), 0.0);
    }
}

TEST_P(Cutouts, APointLiesInOneCellOrInACutout) {
    const Box box = bounding_box(s.outline);
    RandomStream random(1, "probe");
    int in_rock = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const double x = random.uniform(box.lower.x, box.upper.x);
        const Vec2 p = {x, random.uniform(box.lower.y, box.upper.y)};
        int cells = 0;
        for (int g = 0; g < s.quality.grains; ++g) cells += contains(corners_of_cell(s.cells, g), p) ? 1 : 0;
        EXPECT_LE(cells, 1) << p.x << ", " << p.y;
        in_rock += cells;
        const bool cut_out = std::any_of(s.outline.cutouts.begin(), s.outline.cutouts.end(), [&](const Cutout& c) {
            return !c.is_cut() && contains(std::span<const Vec2>(c.vertices), p);
        });
        if (cut_out) {
            EXPECT_EQ(cells, 0) << p.x << ", " << p.y;
        }
    }
    EXPECT_GT(in_rock, 500);
}

TEST_P(Cutouts, TheirFacesLieOnTheEdgesTheyNameAndCoverThem) {
    std::map<int, double> length;
    for (const Cell& cell : s.cells.cells) {
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            if (cell.outline_edges[k] < 0) continue;
            const auto edge = cutout_edge(cell.outline_edges[k]);
            if (!edge) continue;
            length[cell.outline_edges[k]] += norm(to(cell, k) - from(cell, k));
            for (const Vec2 p : {from(cell, k), to(cell, k)})
                EXPECT_NEAR(distance_to_segment(p, (*edge)[0], (*edge)[1]), 0.0, 1e-14);
        }
    }
    for (const Cutout& cutout : s.outline.cutouts) {
        if (cutout.slit || cutout.is_cut()) continue;
        for (std::size_t k = 0; k < cutout.vertices.size(); ++k) {
            double open = 0.0;  // where a notch begins
            const Vec2 a = cutout.vertices[k], b = cutout.vertices[(k + 1) % cutout.vertices.size()];
            for (const Cutout& notch : s.outline.cutouts) {
                if (!notch.slit) continue;
                for (int i = 0; i < 1000; ++i)
                    open += contains(std::span<const Vec2>(notch.vertices), a + ((i + 0.5) / 1000) * (b - a)) ? norm(b - a) / 1000
                                                                                                              : 0.0;
            }
            EXPECT_NEAR(length[cutout.first_edge + static_cast<int>(k)], norm(b - a) - open, 2e-3 * norm(b - a))
                << cutout.name << ", edge " << k;
        }
    }
    for (std::size_t n = 0; n < spec().outline.notches.size(); ++n) {
        const NotchSpec& notch = spec().outline.notches[n];
        const Cutout& cutout = s.outline.cutouts[s.outline.cutouts.size() - spec().outline.notches.size() + n];
        const int left = cutout.is_cut() ? cutout.first_edge : cutout.first_edge + 2, right = cutout.first_edge;
        const double along = norm(notch.to_m - notch.from_m);
        EXPECT_NEAR(length[left], along, 0.15e-3 + (cutout.is_cut() ? 0.0 : 0.3 * notch.width_m))
            << "but for the slope of the boundary where it begins";
        EXPECT_NEAR(length[cutout.is_cut() ? left + 1 : right], along, 0.15e-3 + 0.3 * notch.width_m);
        for (int e = 0; e < 2; ++e) {
            if (cutout.slit && cutout.tips[e]) {
                EXPECT_NEAR(length[cutout.first_edge + (e == 0 ? 3 : 1)], notch.width_m, 1e-14) << "cut square";
            }
        }
    }
}

TEST_P(Cutouts, NothingJoinsTheFacesOfANotch) {
    for (const Cutout& cutout : s.outline.cutouts) {
        if (!cutout.is_cut()) continue;
        const Vec2 a = cutout.vertices[0], ab = cutout.vertices[1] - a;
        std::set<int> left, right, at_tip;  // a cell at a tip may have taken in a piece from ahead of it
        for (int g = 0; g < s.quality.grains; ++g) {
            for (const int edge : s.cells.cells[g].outline_edges) {
                if (edge == cutout.first_edge) left.insert(g);
                if (edge == cutout.first_edge + 1) right.insert(g);
            }
            for (const Vec2 p : corners_of_cell(s.cells, g)) {
                if ((cutout.tips[0] && p == cutout.vertices[0]) || (cutout.tips[1] && p == cutout.vertices[1])) at_tip.insert(g);
            }
        }
        ASSERT_FALSE(left.empty());
        ASSERT_FALSE(right.empty());
        for (const int g : left) {
            EXPECT_FALSE(right.contains(g));
            if (at_tip.contains(g)) continue;
            for (const Vec2 p : corners_of_cell(s.cells, g))
                EXPECT_GT(cross(ab, p - a) / norm(ab), -1e-12) << "wholly on its side";
            for (const int other : s.cells.cells[g].neighbours)
                EXPECT_FALSE(right.contains(other)) << "cells " << g << " and " << other;
        }
        for (const int g : right) {
            if (at_tip.contains(g)) continue;
            for (const Vec2 p : corners_of_cell(s.cells, g)) EXPECT_LT(cross(ab, p - a) / norm(ab), 1e-12);
        }
        for (int e = 0; e < 2; ++e) {
            const int there = static_cast<int>(std::count(s.cells.vertices.begin(), s.cells.vertices.end(), cutout.vertices[e]));
            EXPECT_EQ(there, cutout.tips[e] ? 1 : 0) << "one vertex at a tip, for both faces";
        }
    }
}

TEST_P(Cutouts, LeaveNoSlivers) {
    const double d = s.quality.mean_diameter_m;
    EXPECT_GT(s.quality.smallest_triangle_height_m, 0.004 * d);
    EXPECT_GT(s.quality.smallest_edge_m, 0.05 * d);
    const double mean = total_area(s) / s.quality.grains;
    for (int g = 0; g < s.quality.grains; ++g)
        EXPECT_GT(signed_area(corners_of_cell(s.cells, g)), least_piece * mean) << "cell " << g;
}

TEST_P(Cutouts, EveryGrainHasItsDisc) {
    ASSERT_EQ(s.packing.centres.size(), s.cells.cells.size());
    ASSERT_EQ(s.packing.radii_m.size(), s.cells.cells.size());
    ASSERT_EQ(s.cells.disc_of_cell.size(), s.cells.cells.size());
    EXPECT_TRUE(std::is_sorted(s.cells.disc_of_cell.begin(), s.cells.disc_of_cell.end()));
    EXPECT_EQ(s.quality.pieces, static_cast<int>(s.packing.centres.size()) - static_cast<int>(s.packed.centres.size()));
    for (int g = 0; g < s.quality.grains; ++g) {
        if (s.cells.reshaped[g])
            EXPECT_LE(std::numbers::pi * s.packing.radii_m[g] * s.packing.radii_m[g],
                      1.05 * signed_area(corners_of_cell(s.cells, g)));
        else
            EXPECT_EQ(s.packing.radii_m[g], s.packed.radii_m[s.cells.disc_of_cell[g]]);
    }
}

const auto shapes =
    testing::Values(Case{"half_disc", half_disc()}, Case{"half_disc_cut", half_disc(0.06, 0.0)}, Case{"ring", ring()},
                    Case{"beam", notched_beam()}, Case{"beam_cut", notched_beam(0.0)}, Case{"beam_wide", notched_beam(0.005)},
                    Case{"cracked_plate", cracked_plate()}, Case{"holed_plate", holed_plate()},
                    Case{"notched_disc", notched_disc()}, Case{"notched_ell", notched_ell()});

INSTANTIATE_TEST_SUITE_P(Shapes, Cutouts, testing::Combine(shapes, testing::Range(1, 4)), [](const auto& parameter) {
    return fmt::format("{}_{}", std::get<0>(parameter.param).name, std::get<1>(parameter.param));
});

class FilledCutouts : public testing::TestWithParam<Case> {};

TEST_P(FilledCutouts, HaveParticlesInEveryGrain) {
    SpecimenSpec spec = GetParam().spec;
    spec.particles_per_grain = 26.0;
    const Specimen s = make_specimen(spec, 1);
    ASSERT_EQ(s.filling.particle_begin.size(), s.cells.cells.size() + 1);
    for (std::size_t g = 0; g < s.cells.cells.size(); ++g)
        EXPECT_GE(s.filling.particle_begin[g + 1] - s.filling.particle_begin[g], 3);
    for (const AcrossContact& c : s.filling.across) EXPECT_EQ(s.cells.cells[c.cell_a].neighbours[c.edge_a], c.cell_b);
    for (const OutlineShare& share : s.filling.outline) EXPECT_LT(s.cells.cells[share.cell].neighbours[share.edge], 0);
}

INSTANTIATE_TEST_SUITE_P(Shapes, FilledCutouts, shapes, [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(HalfDisc, StandsOnItsFlat) {
    const Outline o = make_outline(half_disc(0.1));
    EXPECT_EQ(o.vertices[0], (Vec2{-0.05, 0.0}));
    EXPECT_EQ(o.vertices[1], (Vec2{0.05, 0.0}));
    EXPECT_EQ(o.edge_labels[0], "flat");
    const std::size_t n = o.vertices.size();
    EXPECT_EQ((n - 1) % 2, 1U) << "an edge across the top";
    for (std::size_t k = 1; k < n; ++k) {
        EXPECT_EQ(o.edge_labels[k], "arc");
        EXPECT_NEAR(norm(o.vertices[k]), 0.05, 1e-16);
        EXPECT_NEAR(norm(o.vertices[(k + 1) % n] - o.vertices[k]), std::numbers::pi * 0.05 / static_cast<double>(n - 1), 2e-5);
    }
    EXPECT_LE(std::numbers::pi * 0.05 / static_cast<double>(n - 1), 0.003) << "no longer than a mean grain";
    EXPECT_NEAR(o.area_m2 + o.cutouts[0].area_m2, 0.5 * std::numbers::pi * 0.0025, 3e-3 * 0.5 * std::numbers::pi * 0.0025);
    EXPECT_NEAR(o.cutouts[0].area_m2, 0.001 * 0.02, 1e-15);
}

TEST(Ring, HasTheAreaOfItsCircles) {
    const Outline o = make_outline(ring());
    EXPECT_NEAR(o.area_m2, std::numbers::pi * (0.03 * 0.03 - 0.01 * 0.01), 1e-15);
    EXPECT_EQ(o.edge_labels.front(), "circle");
    EXPECT_EQ(o.edge_labels.back(), "hole");
    EXPECT_FALSE(contains(o, {0.0, 0.005}));
    EXPECT_TRUE(contains(o, {0.0, 0.015}));
    EXPECT_NEAR(distance_to_boundary(o, {0.0, 0.0201}), 0.0099, 1e-4);
}

TEST(Holes, AreasLabelsAndSections) {
    const Outline o = make_outline(holed_plate());
    const double slit = o.cutouts[3].area_m2;
    EXPECT_NEAR(slit, 0.001 * std::hypot(0.009, 0.005), 0.0005e-3) << "from the hole's edge on";
    EXPECT_NEAR(o.area_m2, 0.05 * 0.06 - std::numbers::pi * 0.006 * 0.006 - 0.008 * 0.008 - slit, 1e-15);
    std::set<std::string> labels(o.edge_labels.begin(), o.edge_labels.end());
    EXPECT_EQ(labels, (std::set<std::string>{"bottom", "right", "top", "left", "hole-1", "box", "notch-1", "wing"}));
    SpecimenSpec square = rectangle(0.05, 0.06);
    square.outline.holes = {{{}, 0.0, {{0.02, 0.02}, {0.03, 0.02}, {0.03, 0.04}, {0.02, 0.04}}, {}}};
    const SectionWidths widths = section_widths(make_outline(square));
    EXPECT_NEAR(widths.narrowest, 0.04, 1e-15);
    EXPECT_NEAR(widths.widest, 0.05, 1e-15);
    SpecimenSpec cut = rectangle(0.05, 0.06);
    cut.outline.notches = {{{0.0, 0.03}, {0.015, 0.03}, 0.0, {}}};
    EXPECT_NEAR(section_widths(make_outline(cut)).narrowest, 0.05, 1e-15) << "which carries pressure";
    cut.outline.notches[0].width_m = 0.001;
    EXPECT_NEAR(section_widths(make_outline(cut)).narrowest, 0.035, 1e-15);
}

TEST(Notches, NarrowOnesAreNotPackedAround) {
    const Specimen whole = make_specimen(rectangle(0.06, 0.03), 5);
    for (const double width : {0.0, 0.001}) {
        const Specimen notched = make_specimen(notched_beam(width), 5);
        EXPECT_EQ(notched.packed.centres, whole.packing.centres) << "the same grains, sawn";
        EXPECT_EQ(notched.packed.radii_m, whole.packing.radii_m);
    }
    const Specimen wide = make_specimen(notched_beam(0.005), 5);
    for (std::size_t i = 0; i < wide.packed.centres.size(); ++i) {
        const Vec2 c = wide.packed.centres[i];
        EXPECT_FALSE(std::abs(c.x - 0.03) < 0.0025 && c.y < 0.01);
    }
    EXPECT_LT(wide.packed.centres.size(), whole.packing.centres.size());
}

TEST(Notches, OpenEndsGoNoFartherThanTheHoleTheyBeginIn) {
    SpecimenSpec spec = ring();
    spec.outline.notches = {{{0.0, -0.035}, {0.0, 0.0095}, 0.0, {}}, {{0.005, 0.0}, {0.02, 0.0}, 0.001, {}}};
    const Specimen s = make_specimen(spec, 1);
    EXPECT_NO_THROW(check_conforming(s.cells));
    for (const Cell& cell : s.cells.cells) {
        for (const int v : cell.vertices)
            EXPECT_FALSE(s.cells.vertices[v].x == 0.0 && s.cells.vertices[v].y > 0.0) << "nothing is cut beyond the hole";
    }
    EXPECT_EQ(s.outline.cutouts[1].tips, (std::array{false, false})) << "from outside to the hole: a ring that is open";
    EXPECT_EQ(s.outline.cutouts[2].tips, (std::array{false, true}));
}

TEST(Cutting, DoesNotDependOnThreads) {
    const Specimen one = make_specimen(holed_plate(), 2, {.threads = 1, .progress = {}}),
                   three = make_specimen(holed_plate(), 2, {.threads = 3, .progress = {}});
    EXPECT_EQ(one.mesh.nodes, three.mesh.nodes);
    EXPECT_EQ(one.mesh.triangles, three.mesh.triangles);
}

TEST(Cutting, AlongEdgesAndThroughVerticesOfCells) {
    // a lattice of squares, cut along one of its lines from a vertex to a vertex, and through the middle of cells
    std::vector<Vec2> centres;
    for (int i = 0; i < 10; ++i) {
        for (int j = 0; j < 10; ++j) centres.push_back({0.1 * i + 0.05, 0.1 * j + 0.05});
    }
    Packing packing;
    packing.centres = centres;
    packing.radii_m.assign(100, 0.05);
    OutlineSpec spec;
    spec.width_m = spec.height_m = 1.0;
    spec.notches = {{{0.5, 0.0}, {0.5, 0.3}, 0.0, {}}};
    Tessellation t = tessellate_laguerre(packing, make_outline(spec, {0.1, 0.1}), 0.0);
    EXPECT_EQ(t.cells.size(), 100U) << "no cell is cut";
    const auto free_edges = [](const Tessellation& cells) {
        int count = 0;
        for (const Cell& cell : cells.cells)
            count += static_cast<int>(std::count(cell.neighbours.begin(), cell.neighbours.end(), -1));
        return count;
    };
    EXPECT_EQ(free_edges(t), 40 + 6);
    spec.notches = {{{0.55, 0.0}, {0.55, 0.35}, 0.0, {}}};
    t = tessellate_laguerre(packing, make_outline(spec, {0.1, 0.1}), 0.0);
    EXPECT_EQ(t.cells.size(), 100U + 3U + 2U) << "three in two, and the one of the tip in three";
    EXPECT_EQ(free_edges(t), 41 + 8);
    spec.notches = {};
    spec.holes = {{{}, 0.0, {{0.3, 0.3}, {0.6, 0.3}, {0.6, 0.6}, {0.3, 0.6}}, {}}};
    t = tessellate_laguerre(packing, make_outline(spec, {0.1, 0.1}), 0.0);
    EXPECT_EQ(t.cells.size(), 91U);
    EXPECT_EQ(free_edges(t), 40 + 12);
}

TEST(CutoutPackings, ComeBackAndFitTheirHoles) {
    const std::filesystem::path file = std::filesystem::temp_directory_path() / "feldspar_packing_cutouts.txt";
    const auto load = [&](SpecimenSpec spec) {
        spec.packing_file = file;
        return make_specimen(spec, 99);
    };
    for (const SpecimenSpec& spec : {holed_plate(), notched_beam(), notched_beam(0.005), ring(), half_disc()}) {
        const Specimen made = make_specimen(spec, 1);
        save_packing(made, file);
        const Specimen loaded = load(spec);
        EXPECT_EQ(loaded.mesh.nodes, made.mesh.nodes);
        EXPECT_EQ(loaded.packing.radii_m, made.packing.radii_m);
        EXPECT_EQ(loaded.packed.centres, made.packed.centres);
    }
    save_packing(make_specimen(rectangle(0.06, 0.03), 1), file);
    EXPECT_EQ(load(notched_beam()).packed.centres, load(rectangle(0.06, 0.03)).packing.centres)
        << "a whole beam's packing is sawn";
    EXPECT_THROW(load(notched_beam(0.005)), InputError) << "made without the wide notch";
    save_packing(make_specimen(notched_beam(0.005), 1), file);
    EXPECT_THROW(load(rectangle(0.06, 0.03)), InputError) << "made around a notch";
    EXPECT_THROW(load(notched_beam(0.006)), InputError) << "made around another notch";
    save_packing(make_specimen(ring(), 1), file);
    EXPECT_THROW(load(disc(0.06)), InputError);
    SpecimenSpec other = ring();
    other.outline.hole_diameter_m = 0.021;
    EXPECT_THROW(load(other), InputError);
    std::filesystem::remove(file);
}

/// What is said against the specimen; "" if nothing is.
std::string complaint(const SpecimenSpec& spec) {
    try {
        make_specimen(spec, 1);
    } catch (const InputError& error) {
        EXPECT_FALSE(error.allowed().empty()) << error.what();
        EXPECT_NE(error.place().key, "") << error.what();
        return error.what();
    }
    return "";
}

TEST(Cutouts, ImpossibleOnesAreRefused) {
    const auto with_hole = [](HoleSpec hole) {
        SpecimenSpec spec = rectangle(0.05, 0.05);
        spec.outline.holes = {{{0.03, 0.03}, 0.01, {}, {}}, std::move(hole)};
        return complaint(spec);
    };
    const auto expect = [](const std::string& message, const char* words) {
        EXPECT_NE(message.find(words), std::string::npos) << message;
    };
    EXPECT_EQ(with_hole({{0.01, 0.01}, 0.01, {}, {}}), "");
    expect(with_hole({{0.01, 0.01}, 0.003, {}, {}}), "smaller than a grain of 4 mm");
    expect(with_hole({{0.004, 0.02}, 0.01, {}, {}}), "touches or crosses the boundary");
    expect(with_hole({{0.2, 0.2}, 0.01, {}, {}}), "touches or crosses the boundary");
    expect(with_hole({{0.006, 0.02}, 0.01, {}, {}}), "bridge of 1.0");
    expect(with_hole({{0.022, 0.03}, 0.01, {}, {}}), "hole 1 and hole 2 touch or overlap");
    expect(with_hole({{0.03, 0.03}, 0.004, {}, {}}), "touch or overlap");
    expect(with_hole({{0.0195, 0.03}, 0.01, {}, {}}), "leave a bridge of 0.5");
    expect(with_hole({{}, 0.0, {{0.01, 0.01}, {0.02, 0.02}, {0.02, 0.01}, {0.01, 0.02}}, {}}), "crosses or touches itself");
    const auto with_notch = [](Vec2 from, Vec2 to, double width = 0.0, SpecimenSpec spec = rectangle(0.05, 0.05)) {
        spec.outline.notches.push_back({from, to, width, {}});
        return complaint(spec);
    };
    EXPECT_EQ(with_notch({0.02, 0.0}, {0.02, 0.01}), "");
    expect(with_notch({0.02, 0.0}, {0.02, 0.003}), "3 mm long in the rock, shorter than a grain");
    expect(with_notch({0.02, -0.02}, {0.02, 0.003}), "3 mm long in the rock, shorter than a grain");
    expect(with_notch({0.06, 0.0}, {0.06, 0.02}), "lies outside the rock");
    expect(with_notch({0.02, 0.0}, {0.02, 0.05}), "cuts the specimen in two");
    expect(with_notch({0.02, 0.0}, {0.02, 0.049}), "bridge of 1 mm");
    expect(with_notch({0.02, 0.0}, {0.02, 0.006}, 0.008), "less than its width");
    expect(with_notch({0.02, 0.0495}, {0.045, 0.0482}), "leaves a bridge to the boundary");
    SpecimenSpec crossing = rectangle(0.05, 0.05);
    crossing.outline.notches = {{{0.01, 0.02}, {0.03, 0.02}, 0.0, {}}};
    expect(with_notch({0.02, 0.01}, {0.02, 0.03}, 0.0, crossing), "notch 1 and notch 2 touch");
    // each is fine, together with the hole they cut a corner off
    SpecimenSpec corner = rectangle(0.05, 0.05);
    corner.outline.holes = {{{0.02, 0.02}, 0.01, {}, {}}};
    corner.outline.notches = {{{0.0, 0.02}, {0.015, 0.02}, 0.0, {}}};
    EXPECT_EQ(complaint(corner), "");
    expect(with_notch({0.02, 0.0}, {0.02, 0.015}, 0.0, corner), "cut the specimen into 2 parts");
    SpecimenSpec narrow = ring();
    narrow.outline.hole_diameter_m = 0.06;
    expect(complaint(narrow), "not smaller than the ring");
}

TEST(PlaceLabels, AreGivenToEdgesOfCells) {
    SpecimenSpec spec = notched_beam();
    spec.outline.labels = {{"load", PlaceKind::disc, {0.03, 0.03}, {}, 0.003},
                           {"left-end", PlaceKind::box, {0.0, 0.0}, {0.001, 0.03}, 0.0},
                           {"base", PlaceKind::line, {0.0, 0.0}, {0.06, 0.0}, 1e-5},
                           {"support", PlaceKind::disc, {0.01, 0.0}, {}, 0.003}};
    const Specimen s = make_specimen(spec, 1);
    std::map<std::string, double> length;
    for (const Cell& cell : s.cells.cells) {
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            if (cell.outline_edges[k] < 0) continue;
            const std::string& label = s.outline.edge_labels.at(static_cast<std::size_t>(cell.outline_edges[k]));
            const Vec2 a = s.cells.vertices[cell.vertices[k]],
                       b = s.cells.vertices[cell.vertices[(k + 1) % cell.vertices.size()]], middle = 0.5 * (a + b);
            length[label] += norm(b - a);
            if (label == "load") {
                EXPECT_LE(norm(middle - Vec2{0.03, 0.03}), 0.003);
            }
            if (label == "top") {
                EXPECT_GT(norm(middle - Vec2{0.03, 0.03}), 0.003);
            }
            if (label == "left-end") {
                EXPECT_LE(middle.x, 0.001);
            }
            if (label == "support") {
                EXPECT_LE(norm(middle - Vec2{0.01, 0.0}), 0.003);
            }
        }
    }
    EXPECT_FALSE(length.contains("bottom"));
    EXPECT_FALSE(length.contains("left"));
    EXPECT_GT(length["load"], 0.002);
    EXPECT_GT(length["support"], 0.002) << "the later label overrides";
    EXPECT_NEAR(length["base"] + length["support"] + (length["left-end"] - 0.03), 0.059, 1e-12)
        << "all of the bottom but the notch";
    spec.outline.labels.push_back({"nowhere", PlaceKind::disc, {0.03, 0.015}, {}, 0.001});
    const std::string message = complaint(spec);
    EXPECT_NE(message.find("the label \"nowhere\" catches no edge"), std::string::npos) << message;
    EXPECT_NE(message.find("labelled \"notch-1\""), std::string::npos) << message;
}

TEST(OutlineSpec, IsScaledWithAllThatIsInIt) {
    OutlineSpec spec = holed_plate().outline;
    spec.labels = {{"load", PlaceKind::disc, {0.03, 0.03}, {}, 0.003}};
    const Outline once = make_outline(spec, {0.003, 0.004}), twice = make_outline(scaled(spec, 2.0), {0.006, 0.008});
    EXPECT_NEAR(twice.area_m2, 4.0 * once.area_m2, 1e-15);
    EXPECT_EQ(scaled(spec, 2.0).labels[0].within_m, 0.006);
    EXPECT_EQ(scaled(spec, 2.0).notches[1].width_m, 0.002);
}

// A cut whose faces stay in contact: cells meet on its line exactly, the area is whole, and each of its edges is between a cell
// to the left and one to the right.
TEST(JoinedCuts, DivideCellsOnAStraightLineAndLeaveThemNeighbours) {
    for (const bool through : {true, false}) {
        SpecimenSpec spec;
        spec.outline.width_m = 0.04;
        spec.outline.height_m = 0.06;
        spec.grain_sizes.minimum_m = 0.002;
        spec.grain_sizes.maximum_m = 0.004;
        const Vec2 from = through ? Vec2{-0.005, 0.015} : Vec2{0.008, 0.022},
                   to = through ? Vec2{0.045, 0.045} : Vec2{0.032, 0.036};
        spec.outline.notches = {{from, to, 0.0, "fault", true}};
        for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
            const Specimen s = make_specimen(spec, seed);
            EXPECT_LT(s.quality.area_error, 1e-9);
            const Vec2 along = (1.0 / norm(to - from)) * (to - from);
            double length = 0.0;
            int edges = 0;
            for (int c = 0; c < std::ssize(s.cells.cells); ++c) {
                const Cell& cell = s.cells.cells[c];
                ASSERT_EQ(cell.seams.size(), cell.vertices.size());
                const std::vector<Vec2> corners = corners_of_cell(s.cells, c);
                EXPECT_GT(signed_area(corners), 0.0);
                for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
                    EXPECT_FALSE(cell.outline_edges[k] >= 4) << "an edge of the cut is left open";
                    if (cell.seams[k] < 0) continue;
                    ++edges;
                    ASSERT_GE(cell.neighbours[k], 0);
                    const Vec2 a = corners[k], b = corners[(k + 1) % corners.size()];
                    EXPECT_NEAR(cross(along, a - from), 0.0, 1e-12);
                    EXPECT_NEAR(cross(along, b - from), 0.0, 1e-12);
                    length += 0.5 * norm(b - a);
                    const double here = cross(along, centroid(corners) - from),
                                 there = cross(along, centroid(corners_of_cell(s.cells, cell.neighbours[k])) - from);
                    EXPECT_LT(here * there, 0.0);
                }
            }
            EXPECT_EQ(edges % 2, 0);
            EXPECT_NEAR(length, through ? 0.04 * norm(to - from) / (to - from).x : norm(to - from), 1e-9) << seed;
        }
    }
}

// Cuts that cross, and cuts that end on another: the body is filled, cells name each other, and each edge on a line belongs to
// the cut of that line.
struct Lines {
    const char* name;
    std::vector<NotchSpec> cuts;
    int crossings;
    std::vector<double> lengths_m;  // of each cut in the rock
};

class JoinedCutsThatMeet : public testing::TestWithParam<Lines> {};

NotchSpec joined(Vec2 from, Vec2 to, const char* label) { return {from, to, 0.0, label, true}; }

INSTANTIATE_TEST_SUITE_P(
    Lines, JoinedCutsThatMeet,
    testing::Values(Lines{"TwoThatCross",
                          {joined({-0.005, 0.015}, {0.045, 0.045}, "a"), joined({-0.005, 0.05}, {0.045, 0.02}, "b")},
                          1,
                          {0.04 * std::hypot(1.0, 0.6), 0.04 * std::hypot(1.0, 0.6)}},
                    Lines{"OneEndsOnAnother",
                          {joined({0.012, 0.03}, {0.045, 0.045}, "stem"), joined({0.010, -0.001}, {0.015, 0.061}, "bar")},
                          1,
                          {}},
                    Lines{"TheSameTheOtherWayRound",
                          {joined({0.010, -0.001}, {0.015, 0.061}, "bar"), joined({0.045, 0.045}, {0.0125, 0.031}, "stem")},
                          1,
                          {}},
                    Lines{"OneAcrossTheTip",
                          {joined({0.02, -0.001}, {0.02, 0.04}, "a"), joined({-0.001, 0.02}, {0.03, 0.03}, "b")},
                          1,
                          {0.04, std::hypot(0.03, 0.03 * 10.0 / 31.0)}},
                    Lines{"TwoSets",
                          {joined({-0.002, 0.005}, {0.042, 0.025}, "a"), joined({-0.002, 0.018}, {0.042, 0.038}, "a"),
                           joined({-0.002, 0.031}, {0.042, 0.051}, "a"), joined({0.002, -0.002}, {0.012, 0.062}, "b"),
                           joined({0.015, -0.002}, {0.025, 0.062}, "b"), joined({0.028, -0.002}, {0.038, 0.062}, "b")},
                          9,
                          {}}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(JoinedCutsThatMeet, FillTheBodyAndKeepTheirLaws) {
    SpecimenSpec spec = two_to_four_millimetres();
    spec.outline.width_m = 0.04;
    spec.outline.height_m = 0.06;
    spec.outline.notches = GetParam().cuts;
    for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
        const Specimen s = make_specimen(spec, seed);
        EXPECT_NO_THROW(check_conforming(s.cells));
        EXPECT_LT(s.quality.area_error, 1e-9) << seed;
        EXPECT_EQ(s.quality.crossings, GetParam().crossings) << seed;
        EXPECT_GT(s.quality.joined_pieces, 0) << "slivers go to a neighbour";
        std::vector<double> length(spec.outline.notches.size(), 0.0);
        for (int c = 0; c < std::ssize(s.cells.cells); ++c) {
            const Cell& cell = s.cells.cells[c];
            const std::vector<Vec2> corners = corners_of_cell(s.cells, c);
            EXPECT_GT(signed_area(corners), 0.2e-6) << seed;  // no sliver is left: grains have 3 to 12 mm2
            for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
                EXPECT_FALSE(cell.outline_edges[k] >= 4) << "an edge of a cut is left open";
                if (cell.neighbours[k] < 0) continue;
                const Vec2 a = corners[k], b = corners[(k + 1) % corners.size()];
                const auto on = [&](const Cutout& cut) {
                    const Vec2 from = cut.vertices[0], along = (1.0 / norm(cut.vertices[1] - from)) * (cut.vertices[1] - from);
                    const double s0 = dot(a - from, along), s1 = dot(b - from, along), reach = norm(cut.vertices[1] - from);
                    return std::abs(cross(along, a - from)) < 1e-9 && std::abs(cross(along, b - from)) < 1e-9 &&
                           std::min(s0, s1) > -1e-9 && std::max(s0, s1) < reach + 1e-9;
                };
                for (int n = 0; n < std::ssize(s.outline.cutouts); ++n)
                    if (on(s.outline.cutouts[n])) {
                        EXPECT_EQ(cell.seams[k], n) << seed;
                        length[n] += 0.5 * norm(b - a);
                    }
                if (cell.seams[k] < 0) continue;
                const Cutout& cut = s.outline.cutouts[cell.seams[k]];
                if (!on(cut)) {  // two cells that meet on the line and beyond its tip have one contact law: that of the line
                    EXPECT_TRUE(cut.tips[0] || cut.tips[1]);
                    bool elsewhere = false;
                    for (std::size_t m = 0; m < cell.vertices.size(); ++m)
                        elsewhere = elsewhere || (m != k && cell.neighbours[m] == cell.neighbours[k]);
                    EXPECT_TRUE(elsewhere) << seed << ": an edge that is not on the line has its law";
                    continue;
                }
                const Vec2 along = cut.vertices[1] - cut.vertices[0];
                const double here = cross(along, centroid(corners) - cut.vertices[0]),
                             there = cross(along, centroid(corners_of_cell(s.cells, cell.neighbours[k])) - cut.vertices[0]);
                EXPECT_LT(here * there, 0.0) << seed;
            }
        }
        for (std::size_t n = 0; n < GetParam().lengths_m.size(); ++n)
            EXPECT_NEAR(length[n], GetParam().lengths_m[n], 1e-9) << seed;
    }
}

TEST(JoinedCuts, ThatLeaveNoRoomForGrainsWhereTheyMeetAreRefused) {
    SpecimenSpec spec = two_to_four_millimetres();
    spec.outline.width_m = 0.04;
    spec.outline.height_m = 0.06;
    const auto with = [&](std::vector<NotchSpec> cuts) {
        spec.outline.notches = std::move(cuts);
        return complaint(spec);
    };
    EXPECT_NE(with({joined({-0.005, 0.025}, {0.045, 0.03}, "a"), joined({-0.005, 0.03}, {0.045, 0.025}, "b")})
                  .find("cross at 11.4 degrees"),
              std::string::npos);
    EXPECT_NE(with({joined({-0.005, 0.02}, {0.045, 0.02}, "a"), joined({0.02, -0.001}, {0.02, 0.021}, "b")})
                  .find("before one of them ends"),
              std::string::npos);
    EXPECT_NE(with({joined({-0.005, 0.02}, {0.045, 0.02}, "a"), joined({0.02, -0.001}, {0.02, 0.061}, "b"),
                    joined({0.005, 0.005}, {0.0355, 0.035}, "c")})
                  .find("from where others do"),
              std::string::npos);
    EXPECT_NE(
        with({joined({-0.005, 0.02}, {0.045, 0.02}, "a"), {{0.02, -0.001}, {0.02, 0.03}, 0.0, "b", false}}).find("touch, cross"),
        std::string::npos)
        << "only faces that stay in contact cross";
    EXPECT_NE(with({joined({0.008, 0.02}, {0.03, 0.02}, "a"), joined({0.03, 0.012}, {0.03, 0.04}, "b"),
                    joined({0.036, 0.04}, {0.012, 0.04}, "c"), joined({0.012, 0.048}, {0.012, 0.02}, "d")})
                  .find("in a ring"),
              std::string::npos);
}

}  // namespace
}  // namespace feldspar
