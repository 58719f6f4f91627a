#include <algorithm>
#include <cmath>
#include <numbers>

#include "feldspar/geometry/polygon.hpp"
#include "feldspar/job/job_sections.hpp"
#include "feldspar/specimen/grain_sizes.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

constexpr double largest_grain_count = 5e6;  // what fits a large workstation; beyond it a unit was probably mistaken
constexpr std::size_t largest_vertex_count = 10000;

constexpr double usual_particles_per_grain = 26.36;  // 42966 in 1630 grains, as in the paper

const Range particles_range{7.0, 500.0, true, true, "from 7 to 500"};
const Range porosity_range{0.0, 1.0, true, false, "0 or greater and less than 1"};

void read_rectangle(const TableReader& table, OutlineSpec& outline) {
    table.refuse({"diameter", "hole_diameter", "vertices", "edge_labels"}, "shape = \"rectangle\"", "width, height");
    table.require({"width", "height"});
    outline.width_m = table.quantity("width", Dimension::length, positive);
    outline.height_m = table.quantity("height", Dimension::length, positive);
}

void read_disc(const TableReader& table, OutlineSpec& outline, const std::string& setting) {
    table.refuse({"width", "height", "hole_diameter", "vertices", "edge_labels"}, setting, "diameter");
    outline.diameter_m = table.quantity("diameter", Dimension::length, positive);
}

void read_ring(const TableReader& table, OutlineSpec& outline) {
    table.refuse({"width", "height", "vertices", "edge_labels"}, "shape = \"ring\"", "diameter, hole_diameter");
    table.require({"diameter", "hole_diameter"});
    outline.diameter_m = table.quantity("diameter", Dimension::length, positive);
    outline.hole_diameter_m = table.quantity("hole_diameter", Dimension::length, positive);
    table.check({"diameter", "hole_diameter"}, [&] {
        if (outline.hole_diameter_m >= outline.diameter_m)
            table.fail("hole_diameter", shown(*table.find("hole_diameter")) + " is not less than the diameter, " + shown(*table.find("diameter")));
    });
}

void read_polygon(const TableReader& table, OutlineSpec& outline) {
    table.refuse({"width", "height", "diameter", "hole_diameter"}, "shape = \"polygon\"", "vertices, edge_labels");
    const toml::array& vertices = table.array("vertices");
    for (const toml::node& vertex : vertices)
        table.check({}, [&] {
            const toml::array* pair = vertex.as_array();
            if (pair == nullptr || pair->size() != 2)
                table.fail_at(vertex, "vertices", shown(vertex) + " is not a point", "points such as [\"0 mm\", \"80 mm\"]");
            outline.vertices_m.push_back({table.quantity_of(*pair->get(0), "vertices", Dimension::length, any_value),
                                          table.quantity_of(*pair->get(1), "vertices", Dimension::length, any_value)});
        });
    table.check({"vertices"}, [&] {
        if (outline.vertices_m.size() > largest_vertex_count) table.fail("vertices", "the outline has more than 10000 vertices");
        if (outline.vertices_m.size() < 3) table.fail("vertices", "an outline needs at least three vertices");
        if (!is_simple_polygon(outline.vertices_m))
            table.fail("vertices", "the outline crosses or touches itself", "a simple polygon: its edges meet at their ends only");
    });

    if (!table.has("edge_labels")) return;
    for (const toml::node& label : table.array("edge_labels"))
        table.check({}, [&] { outline.edge_labels.push_back(table.text_of(label, "edge_labels")); });
    table.check({"vertices", "edge_labels"}, [&] {
        if (outline.edge_labels.size() != outline.vertices_m.size())
            table.fail(
                "edge_labels",
                std::to_string(outline.edge_labels.size()) + " labels for " + std::to_string(outline.vertices_m.size()) + " edges",
                "one label an edge; edge i runs from vertex i to vertex i + 1");
        if (const auto fault = end_fault(outline))
            table.fail_at(*table.array("edge_labels").get(static_cast<std::size_t>(fault->edge)), "edge_labels", fault->problem, fault->allowed, fault->suggestion);
    });
}

OutlineSpec read_outline(const TableReader& table) {
    OutlineSpec outline;
    outline.shape =
        table.choice<Shape>("shape", {{"rectangle", Shape::rectangle},
                                      {"disc", Shape::disc},
                                      {"polygon", Shape::polygon},
                                      {"half-disc", Shape::half_disc},
                                      {"ring", Shape::ring}});
    if (!table.sound({"shape"})) {   // what is there can be looked at nevertheless
        for (const char* key : {"width", "height", "diameter", "hole_diameter"}) table.quantity(key, Dimension::length, positive, 0.0);
        return outline;
    }
    switch (outline.shape) {
        case Shape::rectangle:
            read_rectangle(table, outline);
            break;
        case Shape::disc:
            read_disc(table, outline, "shape = \"disc\"");
            break;
        case Shape::half_disc:
            read_disc(table, outline, "shape = \"half-disc\"");
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

void read_sieve(const TableReader& table, GrainSizeSpec& sizes) {
    table.refuse({"minimum", "maximum", "median", "log_standard_deviation"}, "distribution = \"sieve\"", "curve");
    const std::string allowed = "points such as [\"2 mm\", \"0 %\"], diameters increasing, shares from 0 % to 100 % that never fall";
    for (const toml::node& row : table.array("curve"))
        table.check({}, [&] {
            const toml::array* pair = row.as_array();
            if (pair == nullptr || pair->size() != 2)
                table.fail_at(row, "curve", shown(row) + " is not a point of a sieve curve", allowed);
            const SievePoint point{table.quantity_of(*pair->get(0), "curve", Dimension::length, positive),
                                   table.fraction_of(*pair->get(1), "curve", {0.0, 1.0, true, true, "from 0 % to 100 %"})};
            if (!sizes.sieve.empty() && point.diameter_m <= sizes.sieve.back().diameter_m)
                table.fail_at(*pair->get(0), "curve", shown(*pair->get(0)) + " is not larger than the sieve before it", allowed);
            if (!sizes.sieve.empty() && point.passing < sizes.sieve.back().passing)
                table.fail_at(*pair->get(1), "curve", shown(*pair->get(1)) + " is less than passes the sieve before it", allowed);
            sizes.sieve.push_back(point);
        });
    table.check({"curve"}, [&] {
        if (sizes.sieve.size() < 2) table.fail("curve", "a sieve curve needs at least two points", allowed);
        if (sizes.sieve.front().passing != 0.0) table.fail("curve", "nothing may pass the first sieve", allowed);
        if (sizes.sieve.back().passing != 1.0) table.fail("curve", "everything must pass the last sieve", allowed);
    });
}

GrainSizeSpec read_grain_sizes(const TableReader& grains) {
    const TableReader table =
        grains.table("diameter", {"distribution", "minimum", "maximum", "median", "log_standard_deviation", "curve"});
    GrainSizeSpec sizes;
    sizes.kind = table.choice<GrainSizeKind>(
        "distribution",
        {{"uniform", GrainSizeKind::uniform}, {"log-normal", GrainSizeKind::log_normal}, {"sieve", GrainSizeKind::sieve}});
    if (!table.sound({"distribution"})) {
        for (const char* key : {"minimum", "maximum", "median"}) table.quantity(key, Dimension::length, positive, 0.0);
        return sizes;
    }
    if (sizes.kind == GrainSizeKind::sieve) {
        read_sieve(table, sizes);
        return sizes;
    }
    if (sizes.kind == GrainSizeKind::uniform) {
        table.refuse({"median", "log_standard_deviation", "curve"}, "distribution = \"uniform\"", "minimum, maximum");
        table.require({"minimum", "maximum"});
    } else {
        table.refuse({"curve"}, "distribution = \"log-normal\"", "median, log_standard_deviation, minimum, maximum");
        table.require({"median", "log_standard_deviation", "minimum", "maximum"});
    }
    sizes.minimum_m = table.quantity("minimum", Dimension::length, positive);
    sizes.maximum_m = table.quantity("maximum", Dimension::length, positive);
    table.check({"minimum", "maximum"}, [&] {
        if (sizes.maximum_m < sizes.minimum_m)
            table.fail("maximum", shown(*table.find("maximum")) + " is less than the minimum, " + shown(*table.find("minimum")));
    });
    if (sizes.kind == GrainSizeKind::log_normal) {
        sizes.median_m = table.quantity("median", Dimension::length, positive);
        sizes.log_standard_deviation =
            table.number("log_standard_deviation", {0.0, 3.0, false, true, "greater than 0, at most 3"});
        table.check({"minimum", "median", "maximum"}, [&] {
            if (!(sizes.minimum_m < sizes.median_m && sizes.median_m < sizes.maximum_m))
                table.fail("median", shown(*table.find("median")) + " does not lie between the minimum and the maximum");
        });
    }
    return sizes;
}

// An upper estimate is enough here: the specimen counts exactly.
double rough_area_m2(const OutlineSpec& outline) {
    if (outline.shape == Shape::rectangle) return outline.width_m * outline.height_m;
    if (outline.shape != Shape::polygon) return 0.25 * std::numbers::pi * outline.diameter_m * outline.diameter_m;
    return std::abs(signed_area(outline.vertices_m));
}

}  // namespace

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
    const Box box = bounding_box(outline);
    return std::min(box.upper.x - box.lower.x, box.upper.y - box.lower.y);
}

namespace {

// What the grains' sizes and the outline must be to each other.
void check_sizes(const TableReader& grains, const SpecimenSpec& spec) {
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

void read_merge_length(const TableReader& grains, SpecimenSpec& spec) {
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
        spec.merge_length_m = grains.quantity("merge_length", Dimension::length, not_negative);
    });
    grains.check({"merge_length", "diameter"}, [&] {
        if (*spec.merge_length_m >= 0.5 * typical_diameter_m(spec.grain_sizes))
            grains.fail("merge_length", shown(*merge) + " is half a grain or more: no cell would keep its shape",
                        "\"auto\" (mean diameter / 12), \"none\", or a length below half the mean diameter");
    });
}

}  // namespace

SpecimenSpec read_specimen(const TableReader& root, const std::filesystem::path& folder, std::optional<bool> filled) {
    const TableReader table = root.table("specimen", specimen_keys);
    table.require({"shape", "grains"});
    SpecimenSpec spec;
    spec.outline = read_outline(table);
    read_cutouts(table, spec.outline);
    spec.thickness_m = table.quantity("thickness", Dimension::length, positive, spec.thickness_m);

    const TableReader grains =
        table.table("grains", {"diameter", "porosity", "merge_length", "triangles_per_grain", "particles_per_grain"});
    spec.grain_sizes = read_grain_sizes(grains);
    spec.porosity = grains.number("porosity", porosity_range, spec.porosity);
    spec.triangles_per_grain = static_cast<int>(grains.integer("triangles_per_grain", 0, 10000, 0));
    if (!filled)
        grains.number("particles_per_grain", particles_range, usual_particles_per_grain);
    else if (*filled)
        spec.particles_per_grain = grains.number("particles_per_grain", particles_range, usual_particles_per_grain);
    else
        grains.refuse({"particles_per_grain"}, "grains that are not filled", "only with kind = \"inner-particles\"");
    if (table.sound({"shape", "width", "height", "diameter", "hole_diameter", "vertices"})) grains.check({"diameter"}, [&] { check_sizes(grains, spec); });
    check_cutouts(table, spec);
    read_merge_length(grains, spec);

    if (table.has("packing")) {
        const std::filesystem::path given = table.text("packing");
        spec.packing_file = given.is_absolute() ? given : folder / given;
        table.check({"packing"}, [&] {
            std::error_code ignored;
            if (!std::filesystem::is_regular_file(spec.packing_file, ignored))
                table.fail("packing", "there is no file " + shown(*table.find("packing")),
                           "a packing saved by an earlier run, its path relative to the job file");
        });
    }
    return spec;
}

}  // namespace feldspar
