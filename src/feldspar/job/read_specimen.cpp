#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "feldspar/base/units.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/job/job_sections.hpp"
#include "feldspar/job/words.hpp"
#include "feldspar/specimen/cells_of_file.hpp"
#include "feldspar/specimen/fit_cells.hpp"
#include "feldspar/specimen/grain_sizes.hpp"
#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/weld_cells.hpp"

namespace feldspar {
namespace {

constexpr double largest_grain_count = 5e6;  // what fits a large workstation; beyond it a unit was probably mistaken
constexpr std::size_t largest_vertex_count = 10000;

void read_rectangle(const JobTable& table, OutlineSpec& outline) {
    outline.width_m = table.quantity("width");
    outline.height_m = table.quantity("height");
}

void read_disc(const JobTable& table, OutlineSpec& outline) { outline.diameter_m = table.quantity("diameter"); }

void read_ring(const JobTable& table, OutlineSpec& outline) {
    outline.diameter_m = table.quantity("diameter");
    outline.hole_diameter_m = table.quantity("hole_diameter");
    table.check({"diameter", "hole_diameter"}, [&] {
        if (outline.hole_diameter_m >= outline.diameter_m)
            table.fail("hole_diameter",
                       shown(*table.find("hole_diameter")) + " is not less than the diameter, " + shown(*table.find("diameter")));
    });
}

void read_polygon(const JobTable& table, OutlineSpec& outline) {
    table.pairs("vertices", "a point", "points such as [\"0 mm\", \"80 mm\"]", [&](const toml::node& x, const toml::node& y) {
        outline.vertices_m.push_back({table.first_of(x, "vertices"), table.second_of(y, "vertices")});
    });
    table.check({"vertices"}, [&] {
        if (outline.vertices_m.size() > largest_vertex_count) table.fail("vertices", "the outline has more than 10000 vertices");
        if (outline.vertices_m.size() < 3) table.fail("vertices", "an outline needs at least three vertices");
        if (!is_simple_polygon(outline.vertices_m))
            table.fail("vertices", "the outline crosses or touches itself",
                       "a simple polygon: its edges meet at their ends only");
    });

    if (table.has("arcs"))
        for (const JobTable& one : table.tables("arcs", "an arc")) {
            one.require({"edge", "through"});
            outline.arcs.push_back({static_cast<int>(one.integer("edge")), one.point("through")});
        }
    if (!table.has("edge_labels")) return;
    for (const toml::node& label : table.array("edge_labels"))
        table.check({}, [&] { outline.edge_labels.push_back(table.text_of(label, "edge_labels")); });
    table.check({"vertices", "edge_labels"}, [&] {
        if (outline.edge_labels.size() != outline.vertices_m.size())
            table.fail("edge_labels",
                       std::to_string(outline.edge_labels.size()) + " labels for " + std::to_string(outline.vertices_m.size()) +
                           " edges",
                       "one label an edge; edge i runs from vertex i to vertex i + 1");
        if (const auto fault = end_fault(outline))
            table.fail_at(*table.array("edge_labels").get(static_cast<std::size_t>(fault->edge)), "edge_labels", fault->problem,
                          fault->allowed, fault->suggestion);
    });
}

// The shape is that of a file's cells.
bool is_from_file(const JobTable& table) {
    const toml::node* shape = table.find("shape");
    return shape != nullptr && shape->value<std::string>() == shape_from_file;
}

// @param cells  of the specimen's file; where there are none, or the outline cannot be theirs, that is a mistake
OutlineSpec read_outline(const JobTable& table, const GivenCellsSpec* cells) {
    OutlineSpec outline;
    if (is_from_file(table)) {
        table.suit("shape", shape_from_file);
        if (cells == nullptr) {
            table.check({"shape"}, [&] {
                table.fail("shape", "a test's own specimen has no file",
                           "a shape with its lengths: it is cut out of the cells of the job's file");
            });
        } else if (cells->file.empty()) {
            table.check({"shape", "grains"}, [&] {
                table.fail("shape", "no file says what the outline is", "file = \"cells.tess\" in [specimen.grains]");
            });
        } else if (cells->given()) {
            outline = outline_of_cells(*cells->cells, cells->tolerance);
        }
        return outline;
    }
    outline.shape = table.choice("shape", shapes);
    if (!table.sound({"shape"})) {  // what is there can be looked at nevertheless
        for (const char* key : {"width", "height", "diameter", "hole_diameter"}) table.quantity(key, 0.0);
        return outline;
    }
    table.suit("shape", name(outline.shape));
    switch (outline.shape) {
        case Shape::rectangle:
            read_rectangle(table, outline);
            break;
        case Shape::disc:
            read_disc(table, outline);
            break;
        case Shape::half_disc:
            read_disc(table, outline);
            break;
        case Shape::ring:
            read_ring(table, outline);
            break;
        case Shape::polygon:
            read_polygon(table, outline);
            break;
    }
    return outline;
}

void read_sieve(const JobTable& table, GrainSizeSpec& sizes) {
    const std::string allowed =
        "points such as [\"2 mm\", \"0 %\"], diameters increasing, shares from 0 % to 100 % that never fall";
    table.pairs("curve", "a point of a sieve curve", allowed, [&](const toml::node& diameter, const toml::node& passing) {
        const SievePoint point{table.first_of(diameter, "curve"), table.second_of(passing, "curve")};
        if (!sizes.sieve.empty() && point.diameter_m <= sizes.sieve.back().diameter_m)
            table.fail_at(diameter, "curve", shown(diameter) + " is not larger than the sieve before it", allowed);
        if (!sizes.sieve.empty() && point.passing < sizes.sieve.back().passing)
            table.fail_at(passing, "curve", shown(passing) + " is less than passes the sieve before it", allowed);
        sizes.sieve.push_back(point);
    });
    table.check({"curve"}, [&] {
        if (sizes.sieve.size() < 2) table.fail("curve", "a sieve curve needs at least two points", allowed);
        if (sizes.sieve.front().passing != 0.0) table.fail("curve", "nothing may pass the first sieve", allowed);
        if (sizes.sieve.back().passing != 1.0) table.fail("curve", "everything must pass the last sieve", allowed);
    });
}

// An upper estimate is enough here: the specimen counts exactly.
double rough_area_m2(const OutlineSpec& outline) {
    if (outline.shape == Shape::rectangle) return outline.width_m * outline.height_m;
    if (outline.shape != Shape::polygon) return 0.25 * std::numbers::pi * outline.diameter_m * outline.diameter_m;
    if (!outline.arcs.empty()) {
        try {
            return make_outline(outline).area_m2;
        } catch (const InputError&) {  // told with the arcs
            return 0.0;
        }
    }
    return std::abs(signed_area(outline.vertices_m));
}

}  // namespace

GrainSizeSpec read_grain_sizes(const JobTable& of, std::string_view key) {
    const JobTable table = of.table(key);
    GrainSizeSpec sizes;
    sizes.kind = table.choice("distribution", grain_size_kinds);
    if (!table.sound({"distribution"})) {
        for (const char* size : {"minimum", "maximum", "median"}) table.quantity(size, 0.0);
        return sizes;
    }
    table.suit("distribution", name(sizes.kind));
    if (sizes.kind == GrainSizeKind::sieve) {
        read_sieve(table, sizes);
        return sizes;
    }
    sizes.minimum_m = table.quantity("minimum");
    sizes.maximum_m = table.quantity("maximum");
    table.check({"minimum", "maximum"}, [&] {
        if (sizes.maximum_m < sizes.minimum_m)
            table.fail("maximum", shown(*table.find("maximum")) + " is less than the minimum, " + shown(*table.find("minimum")));
    });
    if (sizes.kind == GrainSizeKind::log_normal) {
        sizes.median_m = table.quantity("median");
        sizes.log_standard_deviation = table.number("log_standard_deviation");
        table.check({"minimum", "median", "maximum"}, [&] {
            if (!(sizes.minimum_m < sizes.median_m && sizes.median_m < sizes.maximum_m))
                table.fail("median", shown(*table.find("median")) + " does not lie between the minimum and the maximum");
        });
    }
    return sizes;
}

double largest_diameter_m(const GrainSizeSpec& sizes) {
    return sizes.kind == GrainSizeKind::sieve ? largest_of_sieve_m(sizes.sieve) : sizes.maximum_m;
}

double typical_diameter_m(const GrainSizeSpec& sizes) {
    if (sizes.kind == GrainSizeKind::log_normal) return sizes.median_m;
    if (sizes.kind == GrainSizeKind::uniform) return 0.5 * (sizes.minimum_m + sizes.maximum_m);
    return 0.5 * (sizes.sieve.front().diameter_m + sizes.sieve.back().diameter_m);
}

double smallest_extent_m(const OutlineSpec& outline) {
    if (outline.shape == Shape::rectangle) return std::min(outline.width_m, outline.height_m);
    if (outline.shape == Shape::disc) return outline.diameter_m;
    if (outline.shape == Shape::ring) return 0.5 * (outline.diameter_m - outline.hole_diameter_m);
    const Box box = outline.arcs.empty() ? bounding_box(outline)
                                         : bounding_box(outline.vertices_m);  // arcs may be wrong, which is told with them
    return std::min(box.upper.x - box.lower.x, box.upper.y - box.lower.y);
}

namespace {

// The length of a unit of the file: "mm", or "80 mm".
double read_unit(const JobTable& grains, double of_file_m) {
    if (!grains.has("unit")) {
        if (of_file_m == 0.0)
            grains.fail(
                "unit", "missing key: unit (the file has no unit of length)", grains.allowed("unit"),
                "Neper's domain is a square of side 1 unless it was told otherwise: unit = \"80 mm\" makes it 80 mm wide");
        return of_file_m;
    }
    const std::string given = grains.text("unit");
    if (of_file_m != 0.0) grains.fail("unit", "is given, but the head of the file says the unit too", "one of them");
    double unit_m = 0.0;
    try {
        const bool number =
            !given.empty() && (std::isdigit(static_cast<unsigned char>(given.front())) != 0 || given.front() == '.');
        unit_m = parse_quantity(number ? given : "1 " + given, Dimension::length);
    } catch (const std::exception&) {
        unit_m = 0.0;
    }
    if (!(unit_m > 0.0) || !std::isfinite(unit_m))
        grains.fail("unit", shown(*grains.find("unit")) + " is no length", grains.allowed("unit"));
    return unit_m;
}

// Cells of a file, and what they say of the grains' sizes.
void read_given_cells(const JobTable& grains, const std::filesystem::path& folder, SpecimenSpec& spec) {
    GivenCellsSpec& cells = spec.given_cells;
    cells.tolerance = grains.number("tolerance");
    if (!grains.has("file")) {
        grains.refuse({"unit", "tolerance"}, "grains that are packed", "only beside file");
        return;
    }
    cells.file = "cells";  // until it is known
    grains.refuse({"diameter", "porosity"}, "file, whose cells say it");
    grains.check({"file", "unit", "tolerance"}, [&] {
        const std::filesystem::path given = grains.text("file");
        if (given.empty()) return;
        cells.file = std::filesystem::absolute(given.is_absolute() ? given : folder / given).lexically_normal();
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(cells.file, ignored))
            grains.fail("file", "there is no file " + shown(*grains.find("file")), grains.allowed("file"));
        cell_format_of(cells.file);
        const std::string contents = read_cell_file(cells.file);
        const CellsOfFile read = read_cells(contents, cells.file);
        cells.unit_m = read_unit(grains, read.unit_m);
        cells.hash = fmt::format("{:016x}", XXH3_64bits(contents.data(), contents.size()));
        cells.cells = std::make_shared<const GivenCells>(weld_cells(read, cells.unit_m, cells.tolerance, cells.file));
        GrainSizeSpec& sizes = spec.grain_sizes;  // by which the job is judged; nothing is drawn from them
        sizes.kind = GrainSizeKind::log_normal;
        sizes.minimum_m = cells.cells->smallest_diameter_m;
        sizes.median_m = cells.cells->mean_diameter_m;
        sizes.maximum_m = cells.cells->largest_diameter_m;
    });
}

// What the grains' sizes and the outline must be to each other.
void check_sizes(const JobTable& grains, const SpecimenSpec& spec) {
    const double largest = largest_diameter_m(spec.grain_sizes);
    const double extent = smallest_extent_m(spec.outline);
    if (largest > 0.5 * extent)
        grains.fail("diameter",
                    "grains of up to " + format_exact(1000.0 * largest) + " mm do not fit: the specimen is " +
                        format_exact(1000.0 * extent) + " mm across",
                    "grains of at most half the specimen's smallest side");
    if (!grains.sound({"porosity"})) return;
    const double typical = typical_diameter_m(spec.grain_sizes);
    const double count = rough_area_m2(spec.outline) * (1.0 - spec.porosity) / (0.25 * std::numbers::pi * typical * typical);
    if (count > largest_grain_count)
        grains.fail("diameter",
                    "grains of this size make about " + std::to_string(static_cast<long long>(std::min(count, 1e18))) + " grains",
                    "at most " + std::to_string(static_cast<long long>(largest_grain_count)) + " grains");
}

void read_merge_length(const JobTable& grains, SpecimenSpec& spec) {
    const toml::node* merge = grains.find("merge_length");
    if (merge == nullptr) return;
    const toml::value<std::string>* word = merge->as_string();
    if (word != nullptr && word->get() == "none") {
        spec.merge_length_m = 0.0;
        return;
    }
    if (word != nullptr && word->get() == "auto") return;
    grains.check({"merge_length"}, [&] {
        if (word != nullptr && !word->get().empty() &&
            !std::any_of(word->get().begin(), word->get().end(), [](char c) { return c >= '0' && c <= '9'; }))
            grains.fail("merge_length", shown(*merge) + " is not a merge length",
                        "\"auto\" (mean diameter / 12), \"none\", or a length such as \"0.25 mm\"");
        spec.merge_length_m = grains.quantity("merge_length");
    });
    grains.check({"merge_length", spec.given_cells.file.empty() ? "diameter" : "file"}, [&] {
        if (*spec.merge_length_m >= 0.5 * typical_diameter_m(spec.grain_sizes))
            grains.fail("merge_length", shown(*merge) + " is half a grain or more: no cell would keep its shape",
                        "\"auto\" (mean diameter / 12), \"none\", or a length below half the mean diameter");
    });
}

}  // namespace

SpecimenSpec read_own_specimen(const JobTable& test, const SpecimenSpec& of_job, bool grains_known) {
    const JobTable table = test.table("specimen");
    table.require({"shape"});
    SpecimenSpec spec = of_job;
    spec.packing_file.clear();
    spec.outline = read_outline(table, nullptr);
    read_cutouts(table, spec.outline);
    if (!grains_known) return spec;
    if (spec.given_cells.given()) {
        spec.given_cells.cut = true;
        table.check({"shape", "width", "height", "diameter", "hole_diameter", "vertices"}, [&] {
            const Outline outline = make_outline(spec);
            if (!outline.is_disc && !is_convex_polygon(outline.vertices))
                table.fail("shape", "is cut out of the cells of a file, which is done with convex outlines only",
                           "a rectangle, a disc, a half disc, a ring, or a convex polygon");
        });
    }
    table.check({"shape", "width", "height", "diameter", "hole_diameter", "vertices"}, [&] {
        const double largest = largest_diameter_m(spec.grain_sizes), extent = smallest_extent_m(spec.outline);
        if (largest > 0.5 * extent)
            table.fail("shape",
                       fmt::format("grains of up to {} mm do not fit: the specimen is {} mm across", format_exact(1e3 * largest),
                                   format_exact(1e3 * extent)),
                       "a specimen at least twice as wide as its largest grain");
    });
    check_cutouts(table, spec);
    return spec;
}

namespace {

// Sizes by mineral, and the mixture that they make, by which the job is judged.
void read_phase_sizes(const JobTable& grains, const std::vector<Mineral>& phases, SpecimenSpec& spec) {
    const bool all = std::all_of(phases.begin(), phases.end(), [](const Mineral& phase) { return phase.sizes.has_value(); });
    grains.check({"file"}, [&] {
        if (!spec.given_cells.file.empty())
            grains.fail("file", "brings its grains, but minerals have sizes of their own (diameter of [[material.phase]])",
                        "one of them", "`list` of [material.minerals] says the mineral of each cell of a file");
    });
    grains.check({"crystals"}, [&] {
        if (grains.has("crystals"))
            grains.fail("crystals", "have sizes, but minerals have sizes of their own too (diameter of [[material.phase]])",
                        "one of them");
    });
    GrainSizeSpec others;
    if (!all)
        others = read_grain_sizes(grains, "diameter");
    else if (grains.has("diameter"))
        grains.check({}, [&] {
            grains.fail("diameter", "is of no grain: each mineral has sizes of its own",
                        "diameter here for minerals without sizes of their own", "leave it out");
        });
    if (!spec.given_cells.file.empty()) return;
    for (const Mineral& phase : phases) spec.phase_sizes.push_back({phase.name, phase.share, phase.sizes.value_or(others)});
    try {
        grains_of_phases(spec.phase_sizes, 1e3 * rough_area_m2(spec.outline),
                         spec.porosity);  // of a larger specimen: that a mineral has less than a grain is told apart
        spec.grain_sizes = mixture_of(spec.phase_sizes, spec.porosity);
    } catch (const InputError&) {  // told where the sizes stand; here what fits in any case
        spec.phase_sizes.clear();
        spec.grain_sizes = GrainSizeSpec{};
        spec.grain_sizes.minimum_m = spec.grain_sizes.maximum_m = std::max(1e-6, smallest_extent_m(spec.outline) / 30.0);
    }
}

}  // namespace

SpecimenSpec read_specimen(const JobTable& root, const std::filesystem::path& folder, std::optional<bool> filled,
                           const std::vector<Mineral>& phases) {
    const JobTable table = root.table("specimen");
    table.require({"shape", "grains"});
    SpecimenSpec spec;
    const JobTable grains = table.table("grains");
    read_given_cells(grains, folder, spec);
    spec.outline = read_outline(table, &spec.given_cells);
    read_cutouts(table, spec.outline);
    spec.thickness_m = table.quantity("thickness");

    const bool of_file = !spec.given_cells.file.empty();
    if (!of_file && phases.empty()) spec.grain_sizes = read_grain_sizes(grains, "diameter");
    if (grains.has("crystals")) spec.crystal_sizes = read_grain_sizes(grains, "crystals");
    spec.porosity = grains.number("porosity");
    if (!phases.empty()) read_phase_sizes(grains, phases, spec);
    if (!spec.phase_sizes.empty() && table.sound({"shape", "width", "height", "diameter", "vertices"}) &&
        grains.sound({"porosity"}))
        root.check({}, [&] {
            try {
                grains_of_phases(spec.phase_sizes, rough_area_m2(spec.outline), spec.porosity);
            } catch (const InputError& problem) {
                root.fail("material", problem.problem(), problem.allowed(), problem.suggestion());
            }
        });
    spec.triangles_per_grain = static_cast<int>(grains.integer("triangles_per_grain"));
    if (!filled)
        grains.number("particles_per_grain");
    else if (*filled)
        spec.particles_per_grain = grains.number("particles_per_grain");
    else
        grains.refuse({"particles_per_grain"}, "grains that are not filled",
                      "only with " + condition_text(grains.rows().key("particles_per_grain")));
    const std::string_view sizes = of_file ? "file" : "diameter";
    if (table.sound({"shape", "width", "height", "diameter", "hole_diameter", "vertices"}) && !of_file)
        grains.check({"diameter"}, [&] { check_sizes(grains, spec); });
    grains.check({sizes, "crystals"}, [&] {
        if (spec.crystal_sizes && typical_diameter_m(*spec.crystal_sizes) < 1.5 * typical_diameter_m(spec.grain_sizes))
            grains.fail("crystals", "crystals are hardly larger than the grains that they consist of",
                        "a mean diameter of at least 1.5 times that of the grains; 3 times makes about ten grains a crystal");
    });
    if (!of_file || spec.given_cells.given()) check_cutouts(table, spec);
    read_merge_length(grains, spec);

    if (of_file)
        table.refuse({"packing"}, "file in [specimen.grains]", "one of them");
    else if (table.has("packing")) {
        const std::filesystem::path given = table.text("packing");
        spec.packing_file = given.is_absolute() ? given : folder / given;
        table.check({"packing"}, [&] {
            std::error_code ignored;
            if (!std::filesystem::is_regular_file(spec.packing_file, ignored))
                table.fail("packing", "there is no file " + shown(*table.find("packing")), table.allowed("packing"));
        });
    }
    return spec;
}

}  // namespace feldspar
