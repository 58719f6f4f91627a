// Specimens as arrays.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/model/texture.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/specimen/write_cells.hpp"
#include "feldspar/study/packings.hpp"
#include "types.hpp"

namespace feldspar::python {
namespace {

using S = const PySpecimen&;

py::list polygons(S s) {
    py::list list;
    const Tessellation& cells = s.specimen->cells;
    for (int c = 0; c < static_cast<int>(cells.cells.size()); ++c) {
        const std::vector<Vec2> corners = corners_of_cell(cells, c);
        py::array_t<double> polygon({static_cast<py::ssize_t>(corners.size()), py::ssize_t{2}});
        auto at = polygon.mutable_unchecked<2>();
        for (py::ssize_t k = 0; k < at.shape(0); ++k) {
            at(k, 0) = corners[static_cast<std::size_t>(k)].x;
            at(k, 1) = corners[static_cast<std::size_t>(k)].y;
        }
        list.append(polygon);
    }
    return list;
}

py::array_t<double> areas(S s) {
    const Tessellation& cells = s.specimen->cells;
    std::vector<double> values;
    for (int c = 0; c < static_cast<int>(cells.cells.size()); ++c) values.push_back(signed_area(corners_of_cell(cells, c)));
    return copied(values);
}

py::array_t<double> points_array(const std::vector<Vec2>& points) {
    py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{2}});
    auto at = array.mutable_unchecked<2>();
    for (py::ssize_t i = 0; i < at.shape(0); ++i) {
        at(i, 0) = points[static_cast<std::size_t>(i)].x;
        at(i, 1) = points[static_cast<std::size_t>(i)].y;
    }
    return array;
}

py::array_t<double> centroids(S s) {
    const Tessellation& cells = s.specimen->cells;
    std::vector<Vec2> points;
    for (int c = 0; c < static_cast<int>(cells.cells.size()); ++c) points.push_back(centroid(corners_of_cell(cells, c)));
    return points_array(points);
}

py::list of_each_cell(S s, const std::vector<int> Cell::*member) {
    const py::capsule owner = keeper(s.specimen);
    py::list list;
    for (const Cell& cell : s.specimen->cells.cells) list.append(view(cell.*member, owner));
    return list;
}

py::array_t<double> outline(S s) {
    const Outline& outline = s.specimen->outline;
    if (!outline.vertices.empty() || !outline.is_disc) return points_array(outline.vertices);
    constexpr int kCorners = 360;
    std::vector<Vec2> circle;
    for (int k = 0; k < kCorners; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kCorners;
        Vec2 at = outline.centre + outline.radius_m * Vec2{std::cos(angle), std::sin(angle)};
        if (outline.flattened())
            at.y = std::clamp(at.y, outline.centre.y - outline.flat_height_m, outline.centre.y + outline.flat_height_m);
        circle.push_back(at);
    }
    return points_array(circle);
}

py::array triangle_cells(S s) {
    const GrainMesh& mesh = s.specimen->mesh;
    std::vector<int> cells(mesh.triangles.size());
    for (std::size_t g = 0; g + 1 < mesh.triangle_begin.size(); ++g)
        std::fill(cells.begin() + mesh.triangle_begin[g], cells.begin() + mesh.triangle_begin[g + 1], static_cast<int>(g));
    return copied(cells);
}

py::array contacts(S s) {
    std::vector<int> pairs;
    const auto& cells = s.specimen->cells.cells;
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (const int other : cells[c].neighbours)
            if (other > static_cast<int>(c)) pairs.insert(pairs.end(), {static_cast<int>(c), other});
    return copied(pairs).reshape({static_cast<py::ssize_t>(pairs.size() / 2), py::ssize_t{2}});
}

py::dict quality(S s) {
    const SpecimenQuality& q = s.specimen->quality;
    py::dict d;
    d["grains"] = q.grains;
    d["contacts"] = q.contacts;
    d["nodes"] = q.nodes;
    d["triangles"] = q.triangles;
    d["merged_edges"] = q.merged_edges;
    d["vertices_per_grain"] = q.vertices_per_grain;
    d["overlap_mean"] = q.overlap_mean;
    d["overlap_max"] = q.overlap_max;
    d["smallest_edge_mm"] = 1e3 * q.smallest_edge_m;
    d["smallest_triangle_height_mm"] = 1e3 * q.smallest_triangle_height_m;
    d["mean_diameter_mm"] = 1e3 * q.mean_diameter_m;
    d["cell_D50_mm"] = 1e3 * q.cell_sizes.D50_m;
    d["size_spread"] = q.size_spread;
    d["hexatic_order"] = q.hexatic_order;
    d["width_over_largest_grain"] = q.width_over_largest_grain;
    d["area_error"] = q.area_error;
    d["crystals"] = q.crystals;
    d["inner_particles"] = q.inner_particles;
    d["warnings"] = q.warnings;
    return d;
}

void save(S s, const std::string& file) {
    const std::filesystem::path path(file);
    if (path.extension() == ".txt") {
        save_packing(*s.specimen, path);
        return;
    }
    const std::string text = cells_as_text(*s.specimen, cell_format_of(path));
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (!std::filesystem::is_directory(folder))
        throw OutputError(fmt::format("'{}' cannot be written: there is no directory '{}'", file, folder.string()));
    RunDirectory::open(folder).write_text(path.filename().string(), text);
}

}  // namespace

PySpecimen with_phases(std::shared_ptr<const Specimen> specimen, const GrainMaterial& grain, const ContactMaterial& contact,
                       const Heterogeneity& rock) {
    PySpecimen s{std::move(specimen), {}, {}};
    if (!rock.minerals.phases.empty()) {
        s.phases = Texture(*s.specimen, grain, contact, rock).phases();
        for (const Mineral& mineral : rock.minerals.phases) s.phase_names.push_back(mineral.name);
    }
    if (s.phases.empty()) s.phases.assign(s.specimen->cells.cells.size(), 0);
    if (s.phase_names.empty()) s.phase_names.emplace_back("rock");
    return s;
}

void bind_specimens(py::module_& m) {
    py::class_<PySpecimen>(m, "Specimen",
                           R"(A specimen: cells on one shared vertex graph, and the triangles in them. Lengths in metres.

Arrays are read-only views of the specimen's own memory where that is possible; what has to be put together (polygons, areas, centroids) is a new array each time.
Made by :meth:`Job.specimen` or :func:`feldspar.specimen`.)")
        .def_property_readonly(
            "seed", [](S s) { return s.specimen->seed; }, "Seed of the packing.")
        .def_property_readonly(
            "thickness", [](S s) { return s.specimen->spec.thickness_m; }, "Thickness, m.")
        .def_property_readonly("outline", &outline,
                               "The outline as a polygon, counter-clockwise: shape (n, 2), m. Of a disc 360 points of its "
                               "circle. Holes and notches are not in it.")
        .def_property_readonly(
            "outline_labels", [](S s) { return s.specimen->outline.edge_labels; },
            "Labels of the outline's edges, then those of holes and notches, then those that were given by place.")
        .def_property_readonly(
            "area", [](S s) { return s.specimen->outline.area_m2; }, "Area of the outline without holes and notches, m2.")
        .def_property_readonly(
            "vertices", [](S s) { return view_points(s.specimen->cells.vertices, keeper(s.specimen)); },
            "Vertices that the cells share: view, shape (n, 2), m.")
        .def_property_readonly(
            "cells", [](S s) { return of_each_cell(s, &Cell::vertices); },
            "Of each cell the numbers of its vertices, counter-clockwise: a list of views.")
        .def_property_readonly(
            "neighbours", [](S s) { return of_each_cell(s, &Cell::neighbours); },
            "Of each cell, edge by edge (from corner k to k + 1), the cell on the other side, or -1 on the boundary: a list of "
            "views.")
        .def_property_readonly(
            "boundary_edges", [](S s) { return of_each_cell(s, &Cell::outline_edges); },
            "Of each cell, edge by edge, the number of its label in outline_labels, or -1 inside: a list of views.")
        .def_property_readonly("polygons", &polygons,
                               "Of each cell its corners, counter-clockwise: a list of arrays of shape (n, 2), m.")
        .def_property_readonly("areas", &areas, "Areas of the cells, m2.")
        .def_property_readonly("centroids", &centroids, "Centroids of the cells: shape (n, 2), m.")
        .def_property_readonly("contacts", &contacts,
                               "Pairs of neighbouring cells, a row a common edge: shape (n, 2), the smaller number first.")
        .def_property_readonly(
            "nodes", [](S s) { return view_points(s.specimen->mesh.nodes, keeper(s.specimen)); },
            "Nodes of the grain mesh: view, shape (n, 2), m. They belong to one grain each.")
        .def_property_readonly(
            "triangles",
            [](S s) {
                const auto& triangles = s.specimen->mesh.triangles;
                return view(triangles.empty() ? nullptr : triangles.front().data(),
                            {static_cast<py::ssize_t>(triangles.size()), 3}, {sizeof(triangles[0]), sizeof(int)},
                            keeper(s.specimen));
            },
            "Triangles of the grain mesh by their nodes, counter-clockwise: view, shape (n, 3).")
        .def_property_readonly("triangle_cells", &triangle_cells, "The cell of each triangle.")
        .def_property_readonly(
            "phases", [](S s) { return copied(s.phases); }, "The mineral of each cell, as a number of phase_names.")
        .def_property_readonly(
            "phase_names", [](S s) { return s.phase_names; }, "Names of the minerals; [\"rock\"] of a rock of one mineral.")
        .def_property_readonly(
            "crystals", [](S s) { return view(s.specimen->crystal_of_cell, keeper(s.specimen)); },
            "The crystal of each cell: view; empty if each cell is one.")
        .def_property_readonly(
            "disc_centres", [](S s) { return view_points(s.specimen->packing.centres, keeper(s.specimen)); },
            "Centres of the packed discs: view, shape (n, 2), m.")
        .def_property_readonly(
            "disc_radii", [](S s) { return view(s.specimen->packing.radii_m, keeper(s.specimen)); },
            "Radii of the packed discs: view, m.")
        .def_property_readonly(
            "particle_centres", [](S s) { return view_points(s.specimen->filling.centres, keeper(s.specimen)); },
            "Centres of inner particles: view, shape (n, 2), m; empty if the grains are not filled.")
        .def_property_readonly(
            "particle_radii", [](S s) { return view(s.specimen->filling.radii_m, keeper(s.specimen)); },
            "Radii of inner particles: view, m.")
        .def_property_readonly(
            "quality", &quality,
            "What one should know of the specimen before trusting it: counts, sizes in mm, and warnings in sentences.")
        .def("save", &save, py::arg("file"),
             "Writes the cells as .tess (Neper), .msh (gmsh) or .csv, or the packing as .txt, to be read by a job again. Raises "
             "InputError for another ending, OutputError.")
        .def("__len__", [](S s) { return s.specimen->cells.cells.size(); })
        .def("__repr__", [](S s) {
            return fmt::format("<feldspar.Specimen: {} grains, seed {}>", s.specimen->cells.cells.size(), s.specimen->seed);
        });

    m.def(
        "make_specimen",
        [](const std::string& text, const std::string& name, std::uint64_t seed, int threads) {
            const SpecimenSpec spec = parse_specimen(text, name);
            std::shared_ptr<const Specimen> made;
            const int count = threads_of(threads);
            OnCaller caller;
            std::atomic<bool> stop{false};
            caller.run([&] { made = Packings(1, &stop).get(spec, seed, count); }, [&] { stop = true; });
            if (caller.interrupted()) raise_interrupted(py::none());
            return with_phases(made, {}, {}, {});
        },
        py::arg("text"), py::arg("name"), py::arg("seed") = 1, py::arg("threads") = 0,
        "Makes a specimen from TOML text with a table [specimen]; feldspar.specimen() is the convenient form. Raises InputError, "
        "NumericalError.");
}

}  // namespace feldspar::python
