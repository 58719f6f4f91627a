// Outline -> grain sizes -> packing -> Laguerre cells -> grain mesh, and what a user should know of the result.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "feldspar/base/error.hpp"
#include "feldspar/base/mean.hpp"
#include "feldspar/base/rng.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/crystals.hpp"
#include "feldspar/specimen/fill_grains.hpp"
#include "feldspar/specimen/fit_cells.hpp"
#include "feldspar/specimen/grain_sizes.hpp"
#include "feldspar/specimen/mesh_grains.hpp"
#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/pack_discs.hpp"
#include "feldspar/specimen/place_labels.hpp"
#include "feldspar/specimen/specimen.hpp"
#include "feldspar/specimen/tessellate_laguerre.hpp"

namespace feldspar {
namespace {

constexpr double most_grains = 1e7;
constexpr double most_slant_rad =
    8.0 * std::numbers::pi / 180.0;  // of contacts: even Voronoi cells have 1 degree, cells twice as long as wide 24

void check_numbers(const SpecimenSpec& spec) {
    if (!(spec.porosity >= 0.0 && spec.porosity < 1.0)) {
        throw InputError({"", 0, 0, "specimen.grains.porosity"}, fmt::format("{:g} is not allowed", spec.porosity),
                         "from 0 to below 1");
    }
    if (!(spec.thickness_m > 0.0) || !std::isfinite(spec.thickness_m)) {
        throw InputError({"", 0, 0, "specimen.thickness"}, fmt::format("{:g} m is not allowed", spec.thickness_m),
                         "a length greater than zero");
    }
    if (spec.merge_length_m && !(*spec.merge_length_m >= 0.0 && std::isfinite(*spec.merge_length_m))) {
        throw InputError({"", 0, 0, "specimen.grains.merge_length"}, fmt::format("{:g} m is not allowed", *spec.merge_length_m),
                         "a length, or 0 for never");
    }
    if (spec.triangles_per_grain < 0) {
        throw InputError({"", 0, 0, "specimen.grains.triangles_per_grain"},
                         fmt::format("{} is not allowed", spec.triangles_per_grain),
                         "0 for the fixed topology, or a number of triangles");
    }
    const double particles = spec.particles_per_grain;
    if (particles != 0.0 && !(particles >= 7.0 && particles <= 500.0)) {
        throw InputError({"", 0, 0, "specimen.grains.particles_per_grain"}, fmt::format("{:g} is not allowed", particles),
                         "0 for grains that are not filled, or from 7 to 500");
    }
}

double largest_diameter(const GrainSizeSpec& grains) {
    return grains.kind == GrainSizeKind::sieve ? largest_of_sieve_m(grains.sieve) : grains.maximum_m;
}

double mean_diameter(const Packing& packing) { return 2.0 * mean_of(packing.radii_m); }

double smaller_side(const Outline& outline) {
    const Box box = bounding_box(outline);
    return std::min(box.upper.x - box.lower.x, box.upper.y - box.lower.y);
}

/// The stages' way to threads and to the user.
class Making {
public:
    explicit Making(const SpecimenControl& control) : control_(control), team_(std::max(1, control.threads)) {}

    /// How many grains there will be; to be said before the first stage.
    void expect(std::size_t grains) { grains_ = static_cast<int>(grains); }

    /// Begins a stage. One of small pieces, each a matter of microseconds, is shared out only if it is long: otherwise the
    /// threads would wait for each other longer than they work.
    StageControl stage(std::string_view name, bool small_pieces) {
        tell(name, 0.0);
        StageControl stage;
        if (!small_pieces || grains_ >= fewest_to_share) stage.team = &team_;
        if (control_.progress) {
            stage.tell = [this, name](double share) {
                if (std::chrono::steady_clock::now() - last_told_ > std::chrono::milliseconds(100)) tell(name, share);
            };
        }
        return stage;
    }

private:
    static constexpr int fewest_to_share = 5000;

    void tell(std::string_view name, double share) {
        if (control_.progress) control_.progress({name, share, grains_});
        last_told_ = std::chrono::steady_clock::now();
    }

    const SpecimenControl& control_;
    int grains_ = 0;
    Team team_;
    std::chrono::steady_clock::time_point last_told_;
};

Packing make_packing(const SpecimenSpec& spec, const Outline& outline, std::uint64_t seed, Making& making) {
    const int count = grain_count(spec);
    const double largest = largest_diameter(spec.grain_sizes);
    if (count < 1 || largest > smaller_side(outline)) {
        throw InputError({"", 0, 0, "specimen.grains.diameter"},
                         fmt::format("grains of up to {:.4g} mm do not fit into an outline {:.4g} mm across", 1e3 * largest,
                                     1e3 * smaller_side(outline)),
                         "grains several times smaller than the specimen");
    }
    making.expect(static_cast<std::size_t>(count));
    RandomStream sizes(seed, "grain sizes");
    RandomStream places(seed, "packing positions");
    PhasedDiameters sample;
    if (spec.phase_sizes.empty())
        sample.diameters_m = sample_diameters(spec.grain_sizes, count, sizes);
    else
        sample =
            sample_by_phase(spec.phase_sizes, grains_of_phases(spec.phase_sizes, packed_area_m2(outline), spec.porosity), sizes);
    const std::vector<double>& diameters = sample.diameters_m;
    try {
        Packing packing = pack_discs(outline, diameters, places, making.stage("packing", true), sample.phases);
        for (const PhaseSizes& phase : spec.phase_sizes) packing.phase_names.push_back(phase.name);
        return packing;
    } catch (const NumericalError& problem) {  // there is no other way out than another specimen
        throw InputError({"", 0, 0, "specimen.grains.diameter"}, fmt::format("these grains do not pack: {}", problem.what()),
                         fmt::format("sizes closer together (now {:.3g} to {:.3g} mm), or fewer grains by a porosity above {:g}",
                                     1e3 * *std::min_element(diameters.begin(), diameters.end()),
                                     1e3 * *std::max_element(diameters.begin(), diameters.end()), spec.porosity),
                         "raise the smallest diameter first: the finest grains hold little of the area; or try another seed");
    }
}

/// A loaded packing says which of its grains are of which mineral, if these have sizes of their own; its names become the numbers
/// that the spec gives them.
void number_phases(Packing& packing, const SpecimenSpec& spec, std::vector<std::string>& warnings) {
    if (spec.phase_sizes.empty()) {
        if (!packing.phases.empty())
            warnings.push_back(
                fmt::format("{} says of which mineral its grains are, which does not count: the minerals of this rock have no "
                            "sizes of their own, and are drawn anew",
                            spec.packing_file.filename().string()));
        packing.phases.clear();
        packing.phase_names.clear();
        return;
    }
    std::string names;
    for (const PhaseSizes& phase : spec.phase_sizes) names += (names.empty() ? "\"" : ", \"") + phase.name + "\"";
    const auto refuse = [&](const std::string& problem) {
        throw InputError({"", 0, 0, "specimen.packing"}, fmt::format("\"{}\" {}", spec.packing_file.string(), problem),
                         "a packing made for minerals of these sizes: " + names, "leave `packing` out to make one");
    };
    if (packing.phases.empty()) refuse("does not say of which mineral its grains are, but each mineral has sizes of its own");
    std::vector<int> number;
    for (const std::string& name : packing.phase_names) {
        const auto found = std::find_if(spec.phase_sizes.begin(), spec.phase_sizes.end(),
                                        [&](const PhaseSizes& phase) { return phase.name == name; });
        number.push_back(static_cast<int>(found - spec.phase_sizes.begin()));
        if (found == spec.phase_sizes.end()) refuse(fmt::format("has grains of \"{}\", which the rock does not have", name));
    }
    for (int& phase : packing.phases) phase = number[static_cast<std::size_t>(phase)];
    packing.phase_names.clear();
    for (const PhaseSizes& phase : spec.phase_sizes) packing.phase_names.push_back(phase.name);
}

/// Where cells were cut, `packing` gets one disc a grain. Discs of reshaped cells are at the centroid and have the share of the
/// cell that the discs have of the specimen, since the discs' circles are the frame of contacts.
void give_discs_to_pieces(Specimen& specimen) {
    const Tessellation& cells = specimen.cells;
    if (cells.disc_of_cell.empty()) return;
    specimen.packed = specimen.packing;
    const Packing& packed = specimen.packed;
    double discs = 0.0;
    for (const double r : packed.radii_m) discs += std::numbers::pi * r * r;
    const double share = discs / packed_area_m2(specimen.outline);
    specimen.packing.centres.clear();
    specimen.packing.radii_m.clear();
    for (int g = 0; g < std::ssize(cells.cells); ++g) {
        const std::size_t disc = static_cast<std::size_t>(cells.disc_of_cell[g]);
        const std::vector<Vec2> corners = corners_of_cell(cells, g);
        specimen.packing.centres.push_back(cells.reshaped[g] ? centroid(corners) : packed.centres[disc]);
        specimen.packing.radii_m.push_back(cells.reshaped[g] ? std::sqrt(share * signed_area(corners) / std::numbers::pi)
                                                             : packed.radii_m[disc]);
    }
    if (packed.phases.empty()) return;
    specimen.packing.phases.clear();
    for (const int disc : cells.disc_of_cell) specimen.packing.phases.push_back(packed.phases[static_cast<std::size_t>(disc)]);
}

/// Circles of the areas of polygons, at their centroids.
void add_circle(Packing& packing, const std::vector<Vec2>& corners) {
    packing.centres.push_back(centroid(corners));
    packing.radii_m.push_back(std::sqrt(signed_area(corners) / std::numbers::pi));
}

/// Cells of a file in the outline, in place of a packing and its Laguerre cells. Each has the circle of its area; where cells
/// were cut, those of the whole cells are kept besides.
void take_given_cells(Specimen& specimen) {
    const GivenCellsSpec& spec = specimen.spec.given_cells;
    const GivenCells& given = *spec.cells;
    FittedCells fitted = fit_cells(spec, specimen.outline, specimen.spec.outline.shape);
    const int joined = fitted.joined;
    specimen.cells = tessellation_of(std::move(fitted.graph), specimen.outline, given.mean_diameter_m,
                                     specimen.spec.merge_length_m.value_or(given.mean_diameter_m / 12.0));
    specimen.cells.joined_pieces += joined;
    if (!fitted.origin.empty()) {
        Tessellation& cells = specimen.cells;
        if (cells.disc_of_cell.empty()) {
            cells.disc_of_cell = std::move(fitted.origin);
            cells.reshaped = std::move(fitted.reshaped);
        } else {
            for (std::size_t g = 0; g < cells.disc_of_cell.size(); ++g) {
                const std::size_t face = static_cast<std::size_t>(cells.disc_of_cell[g]);
                cells.reshaped[g] = cells.reshaped[g] != 0 || fitted.reshaped[face] != 0 ? 1 : 0;
                cells.disc_of_cell[g] = fitted.origin[face];
            }
        }
    }
    for (int g = 0; g < std::ssize(specimen.cells.cells); ++g) add_circle(specimen.packing, corners_of_cell(specimen.cells, g));
    if (!specimen.cells.disc_of_cell.empty())
        for (const std::vector<int>& cell : given.cells) {
            std::vector<Vec2> corners;
            for (const int v : cell) corners.push_back(given.vertices[static_cast<std::size_t>(v)] + fitted.shift);
            add_circle(specimen.packed, corners);
        }
    SpecimenQuality& quality = specimen.quality;
    quality.welded = given.welded;
    quality.inserted = given.inserted;
    quality.concave = given.concave;
    quality.moved = fitted.moved;
    const std::string file = spec.file.filename().string();
    for (const std::string& remark : given.remarks) quality.warnings.push_back(fmt::format("{}: {}", file, remark));
    if (given.inserted > 0)
        quality.warnings.push_back(
            fmt::format("{}: {} corners lay on an edge of a neighbour and were put into it", file, given.inserted));
    if (fitted.moved > 0)
        quality.warnings.push_back(fmt::format("{}: {} corners on the boundary were moved onto the outline, by {:.2g} mm at most",
                                               file, fitted.moved, 1e3 * fitted.furthest_m));
    if (!spec.cut && fitted.shift != Vec2{})
        quality.warnings.push_back(fmt::format("{}: the cells were moved by ({:.6g}, {:.6g}) mm, to where the outline is", file,
                                               1e3 * fitted.shift.x, 1e3 * fitted.shift.y));
    if (given.concave > 0)
        quality.warnings.push_back(fmt::format("{}: {} of {} cells are not convex", file, given.concave, given.cells.size()));
}

/// The discs as they were packed.
const Packing& discs_of(const Specimen& specimen) { return specimen.packed.centres.empty() ? specimen.packing : specimen.packed; }

/// Twice the area between the boundary edges and the origin, which is the area of the outline, or of its chords on a disc.
double boundary_area(const Tessellation& cells) {
    double twice = 0.0;
    for (const Cell& cell : cells.cells) {
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            if (cell.neighbours[k] >= 0) continue;
            twice += cross(cells.vertices[cell.vertices[k]], cells.vertices[cell.vertices[(k + 1) % cell.vertices.size()]]);
        }
    }
    return 0.5 * twice;
}

void measure_cells(const Specimen& specimen, SpecimenQuality& quality) {
    quality.smallest_edge_m = std::numeric_limits<double>::infinity();
    double area = 0.0;
    long vertices = 0;
    for (int g = 0; g < std::ssize(specimen.cells.cells); ++g) {
        const Cell& cell = specimen.cells.cells[g];
        const std::vector<Vec2> corners = corners_of_cell(specimen.cells, g);
        area += signed_area(corners);
        vertices += std::ssize(corners);
        for (std::size_t k = 0; k < corners.size(); ++k) {
            quality.smallest_edge_m = std::min(quality.smallest_edge_m, norm(corners[(k + 1) % corners.size()] - corners[k]));
            if (cell.neighbours[k] > g) ++quality.contacts;
        }
    }
    quality.vertices_per_grain = static_cast<double>(vertices) / static_cast<double>(quality.grains);
    const double reference = specimen.outline.is_disc ? boundary_area(specimen.cells) : specimen.outline.area_m2;
    quality.area_error = std::abs(area - reference) / reference;
}

void measure_sizes(const Specimen& specimen, SpecimenQuality& quality) {
    std::vector<double> discs, cells;
    for (const double r : discs_of(specimen).radii_m) discs.push_back(2.0 * r);
    for (int g = 0; g < std::ssize(specimen.cells.cells); ++g)
        cells.push_back(2.0 * std::sqrt(signed_area(corners_of_cell(specimen.cells, g)) / std::numbers::pi));
    double squares = 0.0;
    for (const double d : discs) squares += (d - quality.mean_diameter_m) * (d - quality.mean_diameter_m);
    quality.size_spread = std::sqrt(squares / static_cast<double>(discs.size())) / quality.mean_diameter_m;
    quality.disc_sizes = summary_of(std::move(discs));
    quality.cell_sizes = summary_of(std::move(cells));
}

/// The bond-orientational order of six neighbours, each weighted by the length of the shared edge, which may be next to nothing
/// (Mickel et al., J. Chem. Phys. 138, 044501, 2013). Over grains that the outline does not touch.
double hexatic_order(const Specimen& specimen) {
    const std::vector<Vec2>& centres = specimen.packing.centres;
    double sum = 0.0;
    int inner = 0;
    for (std::size_t g = 0; g < specimen.cells.cells.size(); ++g) {
        const Cell& cell = specimen.cells.cells[g];
        if (std::any_of(cell.neighbours.begin(), cell.neighbours.end(), [](int other) { return other < 0; })) continue;
        Vec2 order;
        double weights = 0.0;
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            const double length = norm(specimen.cells.vertices[cell.vertices[(k + 1) % cell.vertices.size()]] -
                                       specimen.cells.vertices[cell.vertices[k]]);
            const Vec2 apart = centres[cell.neighbours[k]] - centres[g];
            const double angle = 6.0 * std::atan2(apart.y, apart.x);
            order += length * Vec2{std::cos(angle), std::sin(angle)};
            weights += length;
        }
        sum += norm(order) / weights;
        ++inner;
    }
    return inner > 0 ? sum / inner : 0.0;
}

/// The angle (rad) between an edge's normal and the line of the centroids of its two cells, mean over the length of all edges
/// inside. Contacts take that line for their normal.
double mean_slant(const Specimen& specimen) {
    double sum = 0.0, lengths = 0.0;
    for (int g = 0; g < std::ssize(specimen.cells.cells); ++g) {
        const Cell& cell = specimen.cells.cells[g];
        for (std::size_t k = 0; k < cell.vertices.size(); ++k) {
            if (cell.neighbours[k] <= g) continue;
            const Vec2 along = specimen.cells.vertices[cell.vertices[(k + 1) % cell.vertices.size()]] -
                               specimen.cells.vertices[cell.vertices[k]];
            const Vec2 apart = specimen.packing.centres[cell.neighbours[k]] - specimen.packing.centres[g];
            sum += norm(along) * std::atan2(std::abs(dot(along, apart)), std::abs(cross(along, apart)));
            lengths += norm(along);
        }
    }
    return lengths > 0.0 ? sum / lengths : 0.0;
}

void measure_mesh(const GrainMesh& mesh, SpecimenQuality& quality) {
    quality.nodes = static_cast<int>(mesh.nodes.size());
    quality.triangles = static_cast<int>(mesh.triangles.size());
    quality.smallest_triangle_m2 = std::numeric_limits<double>::infinity();
    quality.smallest_triangle_height_m = std::numeric_limits<double>::infinity();
    for (const auto& t : mesh.triangles) {
        const Vec2 a = mesh.nodes[t[0]], b = mesh.nodes[t[1]], c = mesh.nodes[t[2]];
        const double area = 0.5 * cross(b - a, c - a);
        const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
        quality.smallest_triangle_m2 = std::min(quality.smallest_triangle_m2, area);
        quality.smallest_triangle_height_m = std::min(quality.smallest_triangle_height_m, 2.0 * area / longest);
    }
}

std::vector<std::string> warnings_about(const SpecimenQuality& quality, bool given) {
    std::vector<std::string> warnings;
    if (quality.width_over_largest_grain < 10.0) {
        warnings.push_back(
            fmt::format("the specimen is only {:.1f} times as wide as its largest grain; ISRM suggests at least 10",
                        quality.width_over_largest_grain));
    }
    if (quality.area_error > 1e-9) {
        warnings.push_back(fmt::format("the cells miss the outline's area by a share of {:.1e}", quality.area_error));
    }
    if (quality.overlap_mean > 0.15) {
        warnings.push_back(
            fmt::format("the discs overlap by {:.0f} % of the mean diameter on average: the grain sizes will differ from the "
                        "distribution; a larger porosity gives fewer grains",
                        100.0 * quality.overlap_mean));
    }
    if (!given && quality.overlap_mean < 1e-5 && quality.grains > 1) {
        warnings.push_back(
            "the packing is loose: cells are larger than their discs, and grain sizes differ from the distribution");
    }
    if (!given && quality.size_spread < least_size_spread && quality.grains > 20) {
        warnings.push_back(fmt::format(
            "the grains are of nearly one size (coefficient of variation {:.1f} %): equal discs crystallise in rows, along which "
            "the rock is anisotropic (hexatic order {:.2f}; 0.5 at a coefficient of variation of 20 %); "
            "a coefficient of variation of {:.0f} % or more avoids it",
            100.0 * quality.size_spread, quality.hexatic_order, 100.0 * least_size_spread));
    }
    if (quality.smallest_triangle_height_m < 0.005 * quality.mean_diameter_m) {
        warnings.push_back(
            fmt::format("the flattest triangle is only {:.2g} mm high, which slows explicit steps; a larger merge length helps",
                        1e3 * quality.smallest_triangle_height_m));
    }
    return warnings;
}

}  // namespace

int grain_count(const SpecimenSpec& spec) {
    check_numbers(spec);
    if (spec.given_cells.given()) return static_cast<int>(spec.given_cells.cells->cells.size());
    if (!spec.phase_sizes.empty()) {
        const std::vector<int> counts = grains_of_phases(spec.phase_sizes, packed_area_m2(make_outline(spec)), spec.porosity);
        return std::accumulate(counts.begin(), counts.end(), 0);
    }
    const double d = counting_diameter(spec.grain_sizes);
    const double count =
        std::round((1.0 - spec.porosity) * packed_area_m2(make_outline(spec)) / (0.25 * std::numbers::pi * d * d));
    if (count > most_grains) {
        throw InputError({"", 0, 0, "specimen.grains.diameter"}, fmt::format("these grain sizes ask for {:.3g} grains", count),
                         fmt::format("at most {:.0e}", most_grains));
    }
    return static_cast<int>(count);
}

Specimen make_specimen(const SpecimenSpec& spec, std::uint64_t seed, const SpecimenControl& control) {
    check_numbers(spec);
    Specimen specimen;
    specimen.spec = spec;
    specimen.seed = seed;
    specimen.outline = make_outline(spec);
    Making making(control);
    SpecimenQuality& quality = specimen.quality;
    const bool given = spec.given_cells.given();
    if (given) {
        making.expect(spec.given_cells.cells->cells.size());
        making.stage("cells", true);
        take_given_cells(specimen);
        quality.mean_diameter_m = mean_diameter(specimen.packing);
    } else {
        specimen.packing = spec.packing_file.empty() ? make_packing(spec, specimen.outline, seed, making)
                                                     : load_packing(spec.packing_file, specimen.outline);
        if (!spec.packing_file.empty()) number_phases(specimen.packing, spec, quality.warnings);
        making.expect(specimen.packing.centres.size());
        quality.mean_diameter_m = mean_diameter(specimen.packing);
        const double merge_length = spec.merge_length_m.value_or(quality.mean_diameter_m / 12.0);
        specimen.cells = tessellate_laguerre(specimen.packing, specimen.outline, merge_length, making.stage("cells", true));
        give_discs_to_pieces(specimen);
    }
    if (spec.crystal_sizes) {
        SpecimenSpec crystals = spec;
        crystals.grain_sizes = *spec.crystal_sizes;
        crystals.phase_sizes.clear();
        crystals.given_cells = {};  // their discs are packed, whatever the grains are
        constexpr std::uint64_t kOthers =
            0x9E3779B97F4A7C15;  // the streams of another seed: crystals and grains have nothing to do with each other
        specimen.crystal_of_cell =
            group_into_crystals(specimen.cells, make_packing(crystals, specimen.outline, seed ^ kOthers, making));
        quality.crystals = 1 + *std::max_element(specimen.crystal_of_cell.begin(), specimen.crystal_of_cell.end());
    }
    label_by_place(specimen.outline, specimen.cells, spec.outline);
    specimen.mesh = mesh_grains(specimen.cells, spec.triangles_per_grain, making.stage("mesh", true));
    if (spec.particles_per_grain > 0.0) {
        specimen.filling = fill_grains(specimen.cells, spec.particles_per_grain, seed, making.stage("filling", false));
    }

    quality.grains = static_cast<int>(specimen.packing.centres.size());
    quality.pieces = quality.grains - static_cast<int>(discs_of(specimen).centres.size());
    quality.joined_pieces = specimen.cells.joined_pieces;
    quality.crossings = specimen.cells.crossings;
    quality.merged_edges = specimen.cells.merged_edges;
    quality.overlap_mean = specimen.packing.overlap_mean;
    quality.overlap_max = specimen.packing.overlap_max;
    quality.relaxation_residual = specimen.packing.residual;
    quality.width_over_largest_grain = smaller_side(specimen.outline) / (2.0 * *std::max_element(specimen.packing.radii_m.begin(),
                                                                                                 specimen.packing.radii_m.end()));
    measure_cells(specimen, quality);
    measure_sizes(specimen, quality);
    quality.hexatic_order = hexatic_order(specimen);
    measure_mesh(specimen.mesh, quality);
    quality.inner_particles = static_cast<int>(specimen.filling.centres.size());
    quality.inside_contacts = static_cast<int>(specimen.filling.inside.size());
    quality.across_contacts = static_cast<int>(specimen.filling.across.size());
    if (const double slant = mean_slant(specimen); given && slant > most_slant_rad) {
        quality.warnings.push_back(
            fmt::format("the lines between the centres of neighbours are {:.0f} degrees from the normals of their edges on "
                        "average: contacts of flexible and rigid grains take these lines for their normals, and "
                        "cells that are longer than wide then have strengths in compression that depend on their direction more "
                        "than a rock's (docs/theory/specimen.md, section 7)",
                        slant * 180.0 / std::numbers::pi));
    }
    for (std::string& warning : warnings_about(quality, given)) quality.warnings.push_back(std::move(warning));
    return specimen;
}

}  // namespace feldspar
