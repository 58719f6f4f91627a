// Cells of other programs: read, welded, fitted to an outline, cut, written, and read back with the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/cells_of_file.hpp"
#include "feldspar/specimen/fit_cells.hpp"
#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/tessellate_laguerre.hpp"
#include "feldspar/specimen/weld_cells.hpp"
#include "feldspar/specimen/write_cells.hpp"
#include "sample_specimens.hpp"

namespace feldspar {
namespace {

std::string data(const std::string& name) {
    std::ifstream stream(std::string(FELDSPAR_SOURCE_DIR) + "/tests/unit/specimen/data/" + name, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    EXPECT_FALSE(text.str().empty()) << name;
    return text.str();
}

GivenCellsSpec given(const std::string& contents, const std::string& file, double unit_m = 1.0, double tolerance = 1e-3) {
    GivenCellsSpec spec;
    spec.file = file;
    spec.unit_m = unit_m;
    spec.tolerance = tolerance;
    spec.hash = file;
    spec.cells = std::make_shared<const GivenCells>(weld_cells(read_cells(contents, file), unit_m, tolerance, file));
    return spec;
}

/// A specimen of the cells as they are, in their own outline.
SpecimenSpec of_cells(const GivenCellsSpec& cells) {
    SpecimenSpec spec;
    spec.given_cells = cells;
    spec.outline = outline_of_cells(*cells.cells, cells.tolerance);
    spec.merge_length_m = 0.0;
    return spec;
}

bool same_bits(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec2)) == 0;
}

std::vector<std::string> labels_of(const Specimen& specimen) {
    std::vector<std::string> labels;
    for (const Cell& cell : specimen.cells.cells)
        for (const int edge : cell.outline_edges) labels.push_back(edge < 0 ? "" : specimen.outline.edge_labels[edge]);
    return labels;
}

void expect_same_mesh(const Specimen& read, const Specimen& made) {
    ASSERT_EQ(read.cells.cells.size(), made.cells.cells.size());
    EXPECT_TRUE(same_bits(read.mesh.nodes, made.mesh.nodes));
    EXPECT_EQ(read.mesh.triangles, made.mesh.triangles);
    EXPECT_EQ(read.mesh.edge_triangle, made.mesh.edge_triangle);
    EXPECT_EQ(labels_of(read), labels_of(made));
    for (std::size_t g = 0; g < made.cells.cells.size(); ++g)
        EXPECT_EQ(read.cells.cells[g].neighbours, made.cells.cells[g].neighbours) << g;
}

/// The whole of what a specimen must be.
void expect_sound(const Specimen& specimen) {
    check_conforming(specimen.cells);
    EXPECT_LT(specimen.quality.area_error, 1e-9);
    for (int g = 0; g < std::ssize(specimen.cells.cells); ++g) EXPECT_GT(signed_area(corners_of_cell(specimen.cells, g)), 0.0);
    for (const Cell& cell : specimen.cells.cells)
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) EXPECT_EQ(cell.neighbours[k] < 0, cell.outline_edges[k] >= 0);
    EXPECT_EQ(specimen.packing.radii_m.size(), specimen.cells.cells.size());
}

TEST(CellsOfAFile, ComeBackWithTheSameBits) {
    for (const SpecimenSpec& spec : {rectangle(0.03, 0.04), disc(0.03), ell(), triangle(), split_sides()})
        for (const auto& [format, file] :
             {std::pair{CellFormat::tess, "cells.tess"}, {CellFormat::msh, "cells.msh"}, {CellFormat::csv, "cells.csv"}}) {
            SCOPED_TRACE(std::string(file) + " of shape " + std::to_string(static_cast<int>(spec.outline.shape)));
            const Specimen made = make_specimen(spec, 3);
            SpecimenSpec again = spec;
            again.given_cells = given(cells_as_text(made, format), file);
            again.merge_length_m = 0.0;  // what is left of short edges could not be merged, or would be merged once more
            const Specimen read = make_specimen(again, 99);  // the seed plays no part
            expect_sound(read);
            expect_same_mesh(read, made);
            if (format == CellFormat::tess) {
                EXPECT_TRUE(same_bits(read.cells.vertices, made.cells.vertices));
            }
            EXPECT_EQ(read.quality.moved, 0);
            EXPECT_EQ(read.quality.inserted, 0);
            // the outline, too, is found in the cells
            const OutlineSpec found = outline_of_cells(*again.given_cells.cells, 1e-3);
            const bool split =
                spec.outline.vertices_m.size() == 6 &&
                spec.outline.vertices_m[1].y == spec.outline.vertices_m[2].y;  // a rectangle but for corners on straight sides
            if (split) {
                EXPECT_EQ(found.shape, Shape::rectangle);
                continue;
            }
            EXPECT_EQ(found.shape, spec.outline.shape);
            EXPECT_EQ(found.width_m, spec.outline.width_m);
            EXPECT_EQ(found.height_m, spec.outline.height_m);
            EXPECT_EQ(found.diameter_m, spec.outline.diameter_m);
            again.outline = found;
            const Specimen by_itself = make_specimen(again, 1);
            expect_sound(by_itself);
            EXPECT_TRUE(same_bits(by_itself.mesh.nodes, made.mesh.nodes));
        }
}

TEST(CellsOfAFile, AreTheSameInEveryFormat) {
    const Specimen tess = make_specimen(of_cells(given(data("honeycomb.tess"), "honeycomb.tess", 1e-3)), 1);
    expect_sound(tess);
    EXPECT_EQ(tess.spec.outline.shape, Shape::rectangle);
    EXPECT_EQ(tess.spec.outline.width_m, 6.0 * 1e-3);
    EXPECT_EQ(tess.quality.grains, 21);
    EXPECT_EQ(tess.quality.concave, 0);
    EXPECT_EQ(tess.quality.welded, 0);
    EXPECT_EQ(tess.spec.given_cells.cells->names.front(), "101");
    const Specimen csv = make_specimen(of_cells(given(data("honeycomb.csv"), "honeycomb.csv", 1e-3)), 1);
    const Specimen msh = make_specimen(of_cells(given(data("honeycomb.msh"), "honeycomb.msh", 1e-3)), 1);
    expect_sound(csv);
    expect_sound(msh);
    EXPECT_GT(csv.quality.welded, 50);  // each polygon has corners of its own
    EXPECT_EQ(msh.quality.welded, 0);
    for (const Specimen* other : {&csv, &msh}) {
        ASSERT_EQ(other->quality.grains, 21);
        EXPECT_EQ(other->quality.contacts, tess.quality.contacts);
        for (int g = 0; g < 21; ++g) {
            const double area = signed_area(corners_of_cell(tess.cells, g));
            EXPECT_NEAR(signed_area(corners_of_cell(other->cells, g)), area, 1e-12 * area)
                << g;  // to the bits of the mesh's middle nodes
        }
    }
}

// A wall of bricks, each a rectangle of four corners: where two meet on the long side of a third, it gets a corner.
TEST(CellsOfAFile, GetTheCornersOfNeighboursThatLieOnTheirEdges) {
    const std::string wall =
        "grain,x_mm,y_mm\n"
        "a,0,0\na,2,0\na,2,1\na,0,1\nb,2,0\nb,4,0\nb,4,1\nb,2,1\n"
        "c,0,1\nc,1,1\nc,1,2\nc,0,2\nd,1,1\nd,3.0000001,1\nd,3,2\nd,1,2\ne,3,1\ne,4,1\ne,4,2\ne,3,2\n";
    const Specimen specimen = make_specimen(of_cells(given(wall, "wall.csv", 1e-3)), 1);
    expect_sound(specimen);
    EXPECT_EQ(specimen.quality.inserted, 3);  // 1, 2 and 3 along the joint, into the sides of a, d and b
    EXPECT_EQ(specimen.quality.contacts, 1 + 2 + 4);
    EXPECT_EQ(specimen.quality.concave, 0);
    ASSERT_FALSE(specimen.quality.warnings.empty());
}

TEST(CellsOfAFile, MayMissTheOutlineByTheToleranceAndAreMovedOntoIt) {
    const Specimen made = make_specimen(rectangle(0.03, 0.04), 3);
    std::istringstream rows(cells_as_text(made, CellFormat::csv));
    std::string rounded = "grain,x_mm,y_mm\n", row;
    std::getline(rows, row);
    while (std::getline(rows, row)) {  // three digits behind the point, in mm, and somewhere else
        const std::size_t first = row.find(','), second = row.find(',', first + 1);
        char text[100];
        std::snprintf(text, sizeof text, "%s,%.3f,%.3f\n", row.substr(0, first).c_str(),
                      1e3 * std::stod(row.substr(first + 1)) + 100.0, 1e3 * std::stod(row.substr(second + 1)) - 7.0);
        rounded += text;
    }
    SpecimenSpec spec = rectangle(0.03, 0.04);
    spec.given_cells = given(rounded, "rounded.csv", 1e-3);
    const Specimen read = make_specimen(spec, 1);
    expect_sound(read);
    EXPECT_EQ(read.quality.grains, made.quality.grains);
    EXPECT_NEAR(read.quality.contacts, made.quality.contacts,
                0.02 * made.quality.contacts);  // edges that were hardly longer than the merge length are merged now
    bool told = false;
    for (const std::string& warning : read.quality.warnings)
        told = told || warning.find("moved by (-100, 7) mm") != std::string::npos;
    EXPECT_TRUE(told);
    for (const Cell& cell : read.cells.cells)
        for (std::size_t k = 0; k < cell.vertices.size(); ++k)
            if (cell.outline_edges[k] == 2) {
                EXPECT_EQ(read.cells.vertices[cell.vertices[k]].y, 0.04);
            }  // exactly on the top
}

TEST(CellsOfAFile, TakeHolesCrystalsAndInnerParticles) {
    const Specimen made = make_specimen(rectangle(0.05, 0.06), 3);
    SpecimenSpec spec = holed_plate();
    spec.given_cells = given(cells_as_text(made, CellFormat::tess), "cells.tess");
    const Specimen holed = make_specimen(spec, 1);
    check_conforming(holed.cells);
    EXPECT_GT(labels_of(holed).size(), 0U);
    const std::vector<std::string> labels = labels_of(holed);
    EXPECT_TRUE(std::find(labels.begin(), labels.end(), "hole-1") != labels.end());
    EXPECT_EQ(holed.packed.centres.size(), made.cells.cells.size());
    SpecimenSpec rich = rectangle(0.05, 0.06);
    rich.given_cells = spec.given_cells;
    rich.particles_per_grain = 20.0;
    rich.crystal_sizes = GrainSizeSpec{GrainSizeKind::uniform, 0.005, 0.007, 0.0, 0.0, {}};
    const Specimen filled = make_specimen(rich, 1);
    expect_sound(filled);
    EXPECT_GT(filled.quality.inner_particles, 15 * filled.quality.grains);
    EXPECT_GT(filled.quality.crystals, 5);
    EXPECT_LT(filled.quality.crystals, filled.quality.grains / 2);
    const std::string text = cells_as_text(filled, CellFormat::tess);  // crystals are written as groups
    EXPECT_NE(text.find("*group"), std::string::npos);
}

// The Brazilian test's disc, and other convex outlines, are cut out of the middle.
TEST(CellsOfAFile, AreCutToAnOutline) {
    const Specimen made = make_specimen(rectangle(0.04, 0.06), 3);
    for (const double flat_deg : {0.0, 20.0})
        for (const double diameter : {0.03, 0.04}) {  // the larger one touches the sides of the rectangle
            SCOPED_TRACE(std::to_string(diameter) + " m, " + std::to_string(flat_deg) + " degrees");
            SpecimenSpec spec = flattened_disc(diameter, flat_deg);
            spec.given_cells = given(cells_as_text(made, CellFormat::tess), "cells.tess");
            spec.given_cells.cut = true;
            const Specimen cut = make_specimen(spec, 1);
            expect_sound(cut);
            const Outline outline = make_outline(spec);
            double area = 0.0, least = 1.0;
            for (int g = 0; g < std::ssize(cut.cells.cells); ++g) {
                const double own = signed_area(corners_of_cell(cut.cells, g));
                area += own;
                least = std::min(least, own);
            }
            EXPECT_LT(area, outline.area_m2);
            EXPECT_GT(area, 0.985 * outline.area_m2);            // chords as long as a grain take 1 % off a disc of ten grains
            EXPECT_GT(least, 0.05 * area / cut.quality.grains);  // pieces too small for a grain went to neighbours
            for (const Cell& cell : cut.cells.cells)
                for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
                    if (cell.outline_edges[k] < 0) continue;
                    const Vec2 at = cut.cells.vertices[cell.vertices[k]];
                    if (cell.outline_edges[k] == 0) {
                        EXPECT_NEAR(norm(at), outline.radius_m, 2e-3 * cut.quality.mean_diameter_m);
                    } else {
                        EXPECT_NEAR(std::abs(at.y), outline.flat_height_m, 1e-12);
                    }
                }
        }
    SpecimenSpec spec = rectangle(0.02, 0.03);
    spec.given_cells = given(cells_as_text(made, CellFormat::tess), "cells.tess");
    spec.given_cells.cut = true;
    const Specimen cut = make_specimen(spec, 1);
    expect_sound(cut);
    const std::vector<std::string> all = labels_of(cut);
    for (const char* label : {"bottom", "right", "top", "left"}) EXPECT_GT(std::count(all.begin(), all.end(), label), 2) << label;
    spec.outline.width_m = 0.05;
    EXPECT_THROW(make_specimen(spec, 1), InputError);
}

TEST(CellsOfAFile, AreWrittenAsTheFormatsSay) {
    for (const SpecimenSpec& spec : {rectangle(0.03, 0.04), disc(0.03), ell(), holed_plate()}) {
        const Specimen made = make_specimen(spec, 3);
        // .tess: numbers from 1 on, closed faces by signed edges, a domain whose edges are those of the boundary
        std::istringstream in(cells_as_text(made, CellFormat::tess));
        std::string word;
        const auto find = [&](const std::string& section) {
            while (in >> word)
                if (word == section) return true;
            return false;
        };
        ASSERT_TRUE(find("**cell"));
        int cells = 0, vertices = 0, edges = 0, faces = 0, id = 0;
        in >> cells;
        EXPECT_EQ(cells, made.quality.grains);
        ASSERT_TRUE(find("**vertex"));
        in >> vertices;
        ASSERT_TRUE(find("**edge"));
        in >> edges;
        std::vector<std::pair<int, int>> ends;
        for (int e = 1; e <= edges; ++e) {
            int a = 0, b = 0, state = 0;
            in >> id >> a >> b >> state;
            ASSERT_EQ(id, e);
            ASSERT_TRUE(a >= 1 && a <= vertices && b >= 1 && b <= vertices && a != b);
            ends.emplace_back(a, b);
        }
        ASSERT_TRUE(find("**face"));
        in >> faces;
        EXPECT_EQ(faces, cells);
        std::vector<int> uses(ends.size(), 0);
        for (int f = 1; f <= faces; ++f) {
            int count = 0, again = 0;
            in >> id >> count;
            ASSERT_EQ(id, f);
            std::vector<int> around(static_cast<std::size_t>(count)), signs(static_cast<std::size_t>(count));
            for (int& v : around) in >> v;
            in >> again;
            ASSERT_EQ(again, count);
            for (int& e : signs) in >> e;
            for (int k = 0; k < count; ++k) {
                auto [a, b] = ends[std::abs(signs[k]) - 1];
                if (signs[k] < 0) std::swap(a, b);
                EXPECT_EQ(a, around[k]);
                EXPECT_EQ(b, around[(k + 1) % count]);
                ++uses[std::abs(signs[k]) - 1];
            }
            for (int k = 0; k < 9; ++k) in >> word;
        }
        std::set<int> boundary;
        for (int e = 0; e < edges; ++e) {
            EXPECT_TRUE(uses[e] == 1 || uses[e] == 2);
            if (uses[e] == 1) boundary.insert(e + 1);
        }
        ASSERT_TRUE(find("**domain"));
        ASSERT_TRUE(find("*edge"));
        int sides = 0;
        in >> sides;
        std::set<int> named;
        for (int s = 1; s <= sides; ++s) {
            int two = 0, a = 0, b = 0, none = 0, count = 0;
            in >> id >> two >> a >> b >> word >> none >> word >> count;
            ASSERT_EQ(id, s);
            EXPECT_EQ(two, 2);
            EXPECT_EQ(b, a % sides + 1);
            for (int k = 0; k < count; ++k) {
                int e = 0;
                in >> e;
                EXPECT_TRUE(boundary.contains(e));
                EXPECT_TRUE(named.insert(e).second);
            }
        }
        if (made.outline.cutouts.empty()) {
            EXPECT_EQ(named, boundary);
        }  // else the edges of holes are in no domain edge
        EXPECT_TRUE(find("***end"));

        // .msh: every element names nodes that are there; the triangles fill the cells
        std::istringstream mesh(cells_as_text(made, CellFormat::msh));
        const auto section = [&](const std::string& name) {
            while (mesh >> word)
                if (word == name) return true;
            return false;
        };
        ASSERT_TRUE(section("$Nodes"));
        long blocks = 0, all = 0, low = 0, high = 0;
        mesh >> blocks >> all >> low >> high;
        std::map<long, Vec2> nodes;
        for (long b = 0; b < blocks; ++b) {
            long dimension = 0, tag = 0, parametric = 0, count = 0;
            mesh >> dimension >> tag >> parametric >> count;
            EXPECT_EQ(parametric, 0);
            std::vector<long> tags(static_cast<std::size_t>(count));
            for (long& t : tags) {
                mesh >> t;
                EXPECT_TRUE(t >= low && t <= high);
            }
            for (const long t : tags) {
                double x = 0, y = 0, z = 0;
                mesh >> x >> y >> z;
                EXPECT_TRUE(nodes.emplace(t, Vec2{x, y}).second);
            }
        }
        EXPECT_EQ(static_cast<long>(nodes.size()), all);
        ASSERT_TRUE(section("$Elements"));
        long elements = 0;
        mesh >> blocks >> elements >> low >> high;
        long read = 0, triangles = 0;
        double area = 0.0, of_cells_m2 = 0.0;
        for (long b = 0; b < blocks; ++b) {
            long dimension = 0, tag = 0, type = 0, count = 0;
            mesh >> dimension >> tag >> type >> count;
            for (long k = 0; k < count; ++k, ++read) {
                std::vector<Vec2> corners;
                mesh >> tag;
                for (int i = 0; i < (type == 2 ? 3 : 2); ++i) {
                    long node = 0;
                    mesh >> node;
                    ASSERT_TRUE(nodes.contains(node));
                    corners.push_back(nodes.at(node));
                }
                if (type == 2) area += signed_area(corners), ++triangles;
            }
        }
        EXPECT_EQ(read, elements);
        EXPECT_EQ(triangles, made.quality.triangles);
        for (int g = 0; g < cells; ++g) of_cells_m2 += signed_area(corners_of_cell(made.cells, g));
        EXPECT_NEAR(area, of_cells_m2, 1e-12 * of_cells_m2);
        EXPECT_TRUE(section("$EndElements"));
    }
}

struct BadFile {
    std::string what, contents, file;
    int line;
    std::vector<std::string> words;
};

std::string edited(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(CellsOfAFile, AreRefusedWithTheLineAndTheReason) {
    const std::string tess = data("honeycomb.tess"), msh = data("honeycomb.msh"), head = "grain,x,y\n",
                      square = "a,0,0\na,1,0\na,1,1\na,0,1\n";
    const std::vector<BadFile> files{
        {"empty", "", "a.tess", 0, {"is empty"}},
        {"another kind", tess, "a.vtk", 0, {".tess", ".msh", ".csv"}},
        {"no tessellation", "hello\n", "a.tess", 1, {"hello", "***tess"}},
        {"a raster", "***tesr\n", "a.tess", 1, {"raster"}},
        {"three-dimensional", edited(tess, "2 standard", "3 standard"), "a.tess", 5, {"three-dimensional", "plane"}},
        {"an old format", edited(tess, "3.5", "1.10"), "a.tess", 3, {"1.10", "2.0 to 3.5"}},
        {"truncated", tess.substr(0, tess.find("**face")), "a.tess", -1, {"ends too early"}},
        {"no end", edited(tess, "***end", ""), "a.tess", -1, {"ends too early", "***end"}},
        {"unknown section", edited(tess, " **domain", " **region"), "a.tess", -1, {"**region", "**domain"}},
        {"missing section",
         edited(edited(tess, " **edge\n", " **scale\n"), "  *edge\n", "  *edges\n"),
         "a.tess",
         0,
         {"**edge is missing"}},
        {"more cells than faces",
         edited(tess, " **cell\n  21\n  *id\n   101", " **cell\n  22\n  *id\n   100 101"),
         "a.tess",
         -1,
         {"21 faces for 22 cells"}},
        {"a vertex that is not there",
         edited(tess, "   1 5 1 2 3 4 5\n", "   1 5 1 2 3 4 77\n"),
         "a.tess",
         -1,
         {"vertex 77", "1 to 44"}},
        {"an edge that is not there",
         edited(tess, "     5 1 2 3 4 5\n", "     5 1 2 3 4 99\n"),
         "a.tess",
         -1,
         {"edge 99", "1 to 64"}},
        {"an edge of another face",
         edited(tess, "     5 1 2 3 4 5\n", "     5 1 2 3 4 60\n"),
         "a.tess",
         -1,
         {"edge 60 of face 1"}},
        {"two corners",
         edited(tess, "   1 5 1 2 3 4 5\n     5 1 2 3 4 5\n", "   1 2 1 2\n     2 1 2\n"),
         "a.tess",
         -1,
         {"2 vertices", "three"}},
        {"not a number", edited(tess, "2.0 1.7", "2.0 1.7x"), "a.tess", -1, {"'1.7x' is not a number"}},
        {"not finite", edited(tess, "2.0 1.7", "2.0 nan"), "a.tess", -1, {"'nan'"}},
        {"infinite", edited(tess, "2.0 1.7", "2.0 1e999"), "a.tess", -1, {"'1e999'"}},
        {"out of the plane", edited(tess, "2.0 1.7 0.0", "2.0 1.7 0.5"), "a.tess", -1, {"z = 0.5"}},
        {"vertices out of order", edited(tess, "   2  2.0 0.0", "   3  2.0 0.0"), "a.tess", -1, {"number 2 should be"}},
        {"a huge count", edited(tess, " **vertex\n  44", " **vertex\n  44000000000"), "a.tess", -1, {"44000000000"}},
        {"a large count", edited(tess, " **vertex\n  44", " **vertex\n  40000000"), "a.tess", -1, {"not a whole number"}},
        {"a negative count", edited(tess, " **face\n  21", " **face\n  -1"), "a.tess", -1, {"-1"}},
        {"a vertex inside a neighbour",
         edited(tess, "  15  2.0 4.3", "  15  2.0 1.3"),
         "a.tess",
         -1,
         {"cell 105 crosses or touches itself"}},
        {"binary mesh", "$MeshFormat\n4.1 1 8\n", "a.msh", 2, {"binary"}},
        {"another version", edited(msh, "2.2", "4.0"), "a.msh", 2, {"4.0", "4.1 or 2.2"}},
        {"a solid", edited(msh, "3 2 2 101 1 1 46 45\n", "3 4 2 101 1 1 46 45 2\n"), "a.msh", -1, {"solid"}},
        {"a node that is not there", edited(msh, "3 2 2 101 1 1 ", "3 2 2 101 1 4711 "), "a.msh", -1, {"node 4711"}},
        {"a node twice", edited(msh, "\n2 2 0 0\n", "\n1 2 0 0\n"), "a.msh", -1, {"node 1 is there twice"}},
        {"an element of two grains", edited(msh, "101 1 ", "102 1 "), "a.msh", -1, {}},
        {"no elements", edited(msh, "$Elements", "$Something"), "a.msh", -1, {}},
        {"truncated mesh", msh.substr(0, msh.size() - 200), "a.msh", -1, {"ends too early"}},
        {"no head", square, "a.csv", 1, {"column 'grain'", "grain,x,y"}},
        {"nothing behind the head", head, "a.csv", 1, {"no rows"}},
        {"a short row", head + square + "b,1\n", "a.csv", 6, {"2 values"}},
        {"a word", head + "a,0,zero\n", "a.csv", 2, {"'zero' is not a number"}},
        {"again later", head + square + "b,1,0\nb,2,0\nb,2,1\nb,1,1\na,5,5\n", "a.csv", 10, {"grain a goes on"}},
        {"two corners in rows", head + square + "b,1,0\nb,2,0\n", "a.csv", 6, {"cell b has 2 different corners"}},
        {"on a line", head + "a,0,0\na,1,0\na,2,0\n", "a.csv", 2, {"no area"}},
        {"crossing itself", head + "a,0,0\na,1,1\na,1,0\na,0,1.5\n", "a.csv", 2, {"crosses or touches itself"}},
        {"overlap",
         head + square + "b,0.8,0\nb,2,0\nb,2,1\nb,0.8,1\n",
         "a.csv",
         6,
         {"cells a and b overlap by 0.2", "around (0.9, 0.5)"}},
        {"apart", head + square + "b,1.2,0\nb,2,0\nb,2,1\nb,1.2,1\n", "a.csv", 0, {"2 parts", "(0.5, 0.5)"}},
        {"a gap",
         head +
             "a,0,0\na,3,0\na,3,1\na,0,1\nb,0,1\nb,1,1\nb,1,2\nb,0,2\nc,2,1\nc,3,1\nc,3,2\nc,2,2\nd,0,2\nd,3,2\nd,3,3\nd,0,3\n",
         "a.csv",
         -1,
         {"a gap of 1 ", "around (1.5, 1.5)"}},
        {"by a point", head + square + "b,1,1\nb,2,1\nb,2,2\nb,1,2\n", "a.csv", -1, {"point"}},
        {"turns in",
         head + "a,0,0\na,5,0\na,5,5\na,4,5\na,4,1\na,1,1\na,1,5\na,0,5\n",
         "a.csv",
         2,
         {"no point of it sees", "turns in by 90 degrees"}},
    };
    for (const BadFile& bad : files) {
        SCOPED_TRACE(bad.what);
        try {
            const GivenCellsSpec cells = given(bad.contents, bad.file);
            make_specimen(of_cells(cells), 1);
            FAIL() << "was taken";
        } catch (const InputError& error) {
            if (bad.line >= 0) {
                EXPECT_EQ(error.place().line, bad.line) << error.what();
            } else {
                EXPECT_GE(error.place().line, 0);
            }
            for (const std::string& word : bad.words)
                EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << word << "\n" << error.what();
        }
    }
}

TEST(CellsOfAFile, MustFillTheOutline) {
    SpecimenSpec spec = rectangle(0.006, 0.0125);
    spec.given_cells = given(data("honeycomb.tess"), "honeycomb.tess", 1e-3);
    try {
        make_specimen(spec, 1);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("lies 0.5 mm"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("unit"), std::string::npos) << error.what();
    }
    SpecimenSpec round = disc(0.006);
    round.given_cells = spec.given_cells;
    EXPECT_THROW(make_specimen(round, 1), InputError);
}

// Bytes changed at random: each file is refused, or gives a whole specimen.
TEST(CellsOfAFile, OfAnyBytesAreRefusedOrSound) {
    std::mt19937 random(20240817);
    int refused = 0, taken = 0;
    for (const char* file : {"honeycomb.tess", "honeycomb.msh", "honeycomb.csv"}) {
        const std::string whole = data(file);
        for (int trial = 0; trial < 300; ++trial) {
            std::string text = whole;
            const int changes = 1 + static_cast<int>(random() % 3);
            for (int c = 0; c < changes; ++c) {
                const std::size_t at = random() % text.size();
                switch (random() % 5) {
                    case 0:
                        text[at] = static_cast<char>(random() % 256);
                        break;
                    case 1:
                        text[at] = static_cast<char>('0' + random() % 10);
                        break;
                    case 2:
                        text.erase(at, 1 + random() % 8);
                        break;
                    case 3:
                        text.insert(at, text.substr(random() % text.size(), random() % 12));
                        break;
                    default:
                        text[at] = " \n-.,e*$"[random() % 8];
                        break;
                }
                if (text.empty()) text = " ";
            }
            if (trial % 25 == 0) text.resize(random() % text.size());
            try {
                const Specimen specimen = make_specimen(of_cells(given(text, file, 1e-3)), 1);
                expect_sound(specimen);
                ++taken;
            } catch (const InputError&) {
                ++refused;
            }
            if (HasFailure()) {
                ADD_FAILURE() << file << ", trial " << trial;
                return;
            }
        }
    }
    EXPECT_GT(refused, 400);
    EXPECT_GT(taken, 50);  // changes of what is not read, or of digits within the tolerance
}

}  // namespace
}  // namespace feldspar
