// What a specimen is: the products of outline -> packing -> tessellation -> grain mesh, as plain data.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

enum class Shape { rectangle, disc, polygon, half_disc, ring };

/// A hole: round, or a simple polygon of either orientation if it has vertices.
struct HoleSpec {
    Vec2 centre_m;                 ///< round
    double diameter_m = 0.0;       ///< round
    std::vector<Vec2> vertices_m;  ///< polygon
    std::string label;             ///< of its boundary; empty = "hole-1", "hole-2", ... in the order of the holes

    bool operator==(const HoleSpec&) const = default;
};

/// A sawn slit with square ends. Where it begins or ends on a boundary or outside of the rock it is open; an end in the rock is a
/// tip.
struct NotchSpec {
    Vec2 from_m, to_m;     ///< the ends of its axis
    double width_m = 0.0;  ///< 0 = a cut that takes no rock away: its two faces touch, and nothing joins them
    std::string label;     ///< of its faces; empty = "notch-1", "notch-2", ... in the order of the notches
    bool joined = false;   ///< of a cut: its faces stay in contact, a smooth joint; it may go through the specimen

    bool operator==(const NotchSpec&) const = default;
};

enum class PlaceKind { disc, box, line };

/// Another label for those edges of cells on the boundary whose middle lies at a place.
struct PlaceLabelSpec {
    std::string name;
    PlaceKind kind = PlaceKind::disc;
    Vec2 a_m, b_m;          ///< disc: its centre and nothing; box: two opposite corners; line: its ends
    double within_m = 0.0;  ///< disc: its radius; line: how far from it at most

    bool operator==(const PlaceLabelSpec&) const = default;
};

/// A round edge of a polygon: the arc of a circle from the edge's first vertex through a point to its second.
struct ArcSpec {
    int edge = 0;    ///< from vertex `edge` to the next
    Vec2 through_m;  ///< not on the straight line between them

    bool operator==(const ArcSpec&) const = default;
};

/// The outline as the user describes it. A rectangle spans [0, width] x [0, height]; a disc and a ring are centred at (0, 0); a
/// half disc stands on y = 0 with the middle of its flat at (0, 0).
struct OutlineSpec {
    Shape shape = Shape::rectangle;
    double width_m = 0.0;                  ///< rectangle
    double height_m = 0.0;                 ///< rectangle
    double diameter_m = 0.0;               ///< disc, half disc; ring: the outer one
    double hole_diameter_m = 0.0;          ///< ring
    std::vector<Vec2> vertices_m;          ///< polygon: simple, either orientation
    std::vector<std::string> edge_labels;  ///< polygon: label of the edge from vertex i to i + 1; empty = "edge-0", "edge-1", ...
    std::vector<ArcSpec> arcs;             ///< polygon: its round edges, one an edge at most
    double flat_angle_rad = 0.0;           ///< disc: angle of each of two flats across y, seen from the centre; 0 = a whole disc
    std::vector<HoleSpec> holes;           ///< in any outline
    std::vector<NotchSpec> notches;        ///< in any outline
    std::vector<PlaceLabelSpec> labels;    ///< of two that catch the same edge the later one counts

    /// Holes or notches are cut out of it.
    bool is_cut() const { return shape == Shape::ring || !holes.empty() || !notches.empty(); }

    bool operator==(const OutlineSpec&) const = default;
};

enum class GrainSizeKind { uniform, log_normal, sieve };

/// One row of a sieve curve: the mass (in the plane: area) fraction of grains finer than `diameter_m`.
struct SievePoint {
    double diameter_m = 0.0;
    double passing = 0.0;  ///< 0 ... 1, increasing
};

/// Distribution of grain diameters.
struct GrainSizeSpec {
    GrainSizeKind kind = GrainSizeKind::uniform;
    double minimum_m = 0.0;               ///< uniform: lower bound; log-normal: truncation
    double maximum_m = 0.0;               ///< uniform: upper bound; log-normal: truncation
    double median_m = 0.0;                ///< log-normal
    double log_standard_deviation = 0.0;  ///< log-normal: standard deviation of ln(diameter)
    std::vector<SievePoint> sieve;        ///< sieve: at least two points, from passing 0 to passing 1
};

/// The sizes that the grains of one mineral have.
struct PhaseSizes {
    std::string name;    ///< of the mineral
    double share = 0.0;  ///< of the area; all add up to 1
    GrainSizeSpec sizes;
};

/// Cells that another program made, checked and on one shared vertex graph (weld_cells.hpp), where its file has them.
struct GivenCells {
    std::vector<Vec2> vertices;           ///< m
    std::vector<std::vector<int>> cells;  ///< a cell: its corners, counter-clockwise
    std::vector<std::vector<int>>
        neighbours;                  ///< an edge, from corner k to k + 1: the cell on the other side, or -1 on the boundary
    std::vector<std::string> names;  ///< of the cells, as the file calls them
    std::vector<int> boundary;       ///< the vertices around all cells, counter-clockwise
    double mean_diameter_m = 0.0;    ///< of circles of the cells' areas
    double largest_diameter_m = 0.0;
    double smallest_diameter_m = 0.0;
    int welded = 0;                    ///< vertices that were put onto another one
    int inserted = 0;                  ///< vertices that were put into an edge of a neighbour, on which they lay
    int concave = 0;                   ///< cells that are not convex
    std::vector<std::string> remarks;  ///< what was left out of the file, in sentences
};

/// Cells of a file in place of those of a packing.
struct GivenCellsSpec {
    std::filesystem::path file;               ///< empty: the grains are packed
    double unit_m = 0.0;                      ///< the file's unit of length
    double tolerance = 1e-3;                  ///< / mean grain diameter: how far cells may miss each other and the outline
    bool cut = false;                         ///< the outline is cut out of the cells; otherwise they must fill it
    std::string hash;                         ///< of what is in the file
    std::shared_ptr<const GivenCells> cells;  ///< what is in it

    bool given() const { return cells != nullptr; }
};

/// Everything that determines a specimen besides the seed.
struct SpecimenSpec {
    OutlineSpec outline;
    double thickness_m = 0.08;
    GrainSizeSpec grain_sizes;
    double porosity = 0.10;                ///< sets the number of grains only; the cells fill the plane
    std::optional<double> merge_length_m;  ///< shorter cell edges are merged; absent = mean diameter / 12; 0 = never
    int triangles_per_grain = 0;           ///< 0 = the fixed topology; otherwise a finer mesh of about so many
    std::filesystem::path packing_file;    ///< if not empty: load this packing instead of making one
    double particles_per_grain = 0.0;      ///< inner particles in a grain of mean area; 0 = grains are not filled
    std::optional<GrainSizeSpec>
        crystal_sizes;  ///< crystals of several grains each, which can break between these; absent = each grain is one
    GivenCellsSpec
        given_cells;  ///< if given: these cells, whatever the seed; of the sizes only what they say of themselves counts
    std::vector<PhaseSizes> phase_sizes;  ///< if given: each mineral has sizes of its own, and the packing says which grain is of
                                          ///< which; `grain_sizes` is then their mixture
};

/// What is cut out of the cells: a hole, a slit, or a cut without width.
struct Cutout {
    std::vector<Vec2> vertices;  ///< m, counter-clockwise; an open end of a slit reaches beyond the rock. A cut: its two ends
    int first_edge = 0;  ///< into Outline::edge_labels: of the edge from vertex 0; the others follow. A cut has two: its left
                         ///< face and its right one, seen from its first end
    bool slit = false;   ///< edges 0 and 2 run along it, edge 1 is its end at `to`, edge 3 that at `from`
    std::array<bool, 2> tips{};  ///< slit or cut: whether its end at `from`, at `to` lies in the rock
    bool joined = false;         ///< of a cut: its faces stay in contact
    std::array<int, 2> ends_on{
        -1, -1};  ///< of a joined cut: the number, among all cutouts, of the joined cut on which its end lies; -1: none
    bool packed_around = true;  ///< the discs keep clear of it; otherwise they are packed as if it were not there
    double area_m2 = 0.0;       ///< of the rock that it takes away
    std::string name;           ///< for messages: "notch 1"

    bool is_cut() const { return vertices.size() == 2; }
};

/// The outline made ready: a counter-clockwise polygon with a label on each edge, and what is cut out of it. A disc keeps its
/// circle: cells on it get one chord each, all of them labelled "circle". A flattened disc has two straight edges besides, "top"
/// and "bottom".
struct Outline {
    bool is_disc = false;
    Vec2 centre;                 ///< disc, half disc
    double radius_m = 0.0;       ///< disc; half disc: of its arc, on which the corners of the polygon lie
    double flat_height_m = 0.0;  ///< flattened disc: of its flats from the centre, less than the radius; else 0
    std::vector<Vec2> vertices;  ///< polygon only, counter-clockwise
    std::vector<std::string>
        edge_labels;       ///< polygon: one an edge; rectangle: "bottom", "right", "top", "left"; disc: {"circle"}, and "top",
                           ///< "bottom" if flattened; then those of the cutouts, and at last those given by place
    double area_m2 = 0.0;  ///< without the cutouts
    std::vector<Cutout> cutouts;

    bool flattened() const { return flat_height_m > 0.0; }
};

/// The relaxed discs.
struct Packing {
    std::vector<Vec2> centres;  ///< m
    std::vector<double> radii_m;
    std::vector<int> phases;  ///< a disc: the mineral whose size it has, into phase_names; empty: sizes belong to no mineral
    std::vector<std::string> phase_names;
    double overlap_mean = 0.0;  ///< mean overlap of touching pairs / mean diameter, after relaxation
    double overlap_max = 0.0;
    double residual = 0.0;  ///< unbalanced force of the relaxation / mean contact force at the stop
    int relaxation_steps = 0;
};

/// One Laguerre cell: `vertices[k]` to `vertices[k + 1]` is its edge k, counter-clockwise.
struct Cell {
    std::vector<int> vertices;       ///< into Tessellation::vertices
    std::vector<int> neighbours;     ///< an edge: the cell on the other side, or -1 on the outline
    std::vector<int> outline_edges;  ///< an edge: the outline's edge (label index), or -1 inside
    std::vector<int> seams{};  ///< an edge: the joined cut that it lies on, by its number among the outline's cutouts, or -1;
                               ///< empty: none of them

    bool on_seam(int edge) const { return !seams.empty() && seams[static_cast<std::size_t>(edge)] >= 0; }
};

/// The cells on one shared vertex graph: two neighbours name the same two vertices, so no gap and no overlap is possible.
struct Tessellation {
    std::vector<Vec2> vertices;     ///< m
    std::vector<Cell> cells;        ///< one a grain, in the order of the packing; pieces of one cell follow each other
    int merged_edges = 0;           ///< short edges that were merged
    std::vector<int> disc_of_cell;  ///< a cell: the packed disc that it is of; empty if nothing was cut out: cell i is of disc i
    std::vector<char> reshaped;     ///< a cell: a piece of its disc's cell, or one that has taken a piece in: the disc does not
                                    ///< stand for it; empty likewise
    int joined_pieces = 0;          ///< pieces that were too small for a grain and went to a neighbour
    int crossings = 0;              ///< points where joined cuts cross, or one ends on another
};

/// The places (m) of the vertices of cell `cell`, counter-clockwise, in the cell's order.
std::vector<Vec2> corners_of_cell(const Tessellation& cells, int cell);

/// Nodes and triangles inside the cells. Nodes belong to one grain each and are contiguous by grain: first the cell's
/// vertices in the cell's order, then the centroid, then the inner ring.
struct GrainMesh {
    std::vector<Vec2> nodes;                    ///< m
    std::vector<int> node_begin;                ///< grains + 1 offsets into nodes
    std::vector<std::array<int, 3>> triangles;  ///< global node numbers, counter-clockwise, contiguous by grain
    std::vector<int> triangle_begin;            ///< grains + 1 offsets into triangles
    std::vector<int> vertex_count;              ///< a grain: number of polygon vertices, the same as its number of edges
    std::vector<int> centre_node;               ///< a grain: the global number of the node at the centroid
    std::vector<int> edge_begin;                ///< grains + 1 offsets into edge_triangle
    std::vector<int> edge_triangle;             ///< the triangle that owns edge k of grain g: [edge_begin[g] + k]
};

/// Where an inner particle lies in its cell.
enum class ParticlePlace : std::uint8_t { interior, edge, vertex };

/// Two touching particles of one grain.
struct InsideContact {
    int a = 0, b = 0;  ///< particles
};

/// Two particles of different grains that face each other across a cell edge, with their share of it.
struct AcrossContact {
    int a = 0, b = 0;            ///< particles; a lies in cell_a, b in the neighbour
    int cell_a = 0, edge_a = 0;  ///< the cell edge, seen from a's cell ...
    int cell_b = 0, edge_b = 0;  ///< ... and from b's
    Vec2 from, to;               ///< m, the share of the edge, along a's edge; the shares of an edge add up to the edge
};

/// A particle that lies along the outline, with its share of the cell edge there: platens and membranes press on these.
struct OutlineShare {
    int particle = 0;
    int cell = 0, edge = 0;
    Vec2 from, to;  ///< m
};

/// Small discs inside the cells, for grains that are filled with inner particles. Contiguous by grain.
struct Filling {
    std::vector<int> particle_begin;  ///< grains + 1 offsets; empty if the grains are not filled
    std::vector<Vec2> centres;        ///< m
    std::vector<double> radii_m;
    std::vector<ParticlePlace> places;
    std::vector<InsideContact> inside;  ///< in the order of their grains
    std::vector<AcrossContact> across;
    std::vector<OutlineShare> outline;
};

/// Grain sizes in four numbers.
struct SizeSummary {
    double mean_m = 0.0;
    double minimum_m = 0.0;
    double maximum_m = 0.0;
    double D50_m = 0.0;  ///< half of the area is in grains of this diameter or smaller
};

/// What a user should know of the specimen before trusting it.
struct SpecimenQuality {
    int grains = 0;
    int contacts = 0;  ///< interior cell edges
    int nodes = 0;
    int triangles = 0;
    int merged_edges = 0;
    int pieces = 0;  ///< grains more than discs, because holes or notches have cut cells in two; negative if whole grains went
    int joined_pieces = 0;  ///< pieces that were too small for a grain and went to a neighbour
    int crossings = 0;      ///< points where cuts cross, or one ends on another, whose faces stay in contact
    double vertices_per_grain = 0.0;
    double overlap_mean = 0.0;  ///< / mean diameter
    double overlap_max = 0.0;
    double relaxation_residual = 0.0;
    double smallest_edge_m = 0.0;
    double smallest_triangle_m2 = 0.0;
    double smallest_triangle_height_m = 0.0;
    double mean_diameter_m = 0.0;
    SizeSummary disc_sizes;    ///< of the packed discs: the sizes that were asked for
    SizeSummary cell_sizes;    ///< of the cells: diameters of circles of the cells' areas. These are the grains of the model
    double size_spread = 0.0;  ///< coefficient of variation of the discs' diameters
    double hexatic_order =
        0.0;  ///< |mean of exp(6 i angle)| over the neighbours of a grain, mean over the inner grains: 1 for a honeycomb
    double width_over_largest_grain = 0.0;
    double area_error = 0.0;  ///< |sum of the cells - outline| / outline
    int crystals = 0;         ///< of several grains each; 0: each grain is one
    int inner_particles = 0;  ///< small discs in all grains, if these are filled
    int inside_contacts = 0;  ///< between particles of one grain
    int across_contacts = 0;  ///< between particles of neighbouring grains
    int welded = 0;           ///< vertices of a file's cells that were put onto another one
    int inserted = 0;         ///< vertices of a file's cells that were put into an edge of a neighbour
    int moved = 0;            ///< vertices of a file's cells that were moved onto the outline
    int concave = 0;          ///< cells of a file that are not convex
    std::vector<std::string> warnings;
};

/// A specimen, ready to be bonded and loaded. Never changed once it is built.
struct Specimen {
    SpecimenSpec spec;
    std::uint64_t seed = 0;
    Outline outline;
    Packing packing;  ///< one disc a grain, of a file's cell a circle of its area at its centroid; that of a reshaped cell is at
                      ///< its centroid and takes up the same share of it as all discs of the specimen
    Packing packed;   ///< the discs as they were packed, where grains were cut; otherwise empty
    Tessellation cells;
    GrainMesh mesh;
    Filling filling;                   ///< empty unless the spec asks for inner particles
    std::vector<int> crystal_of_cell;  ///< a cell: the crystal that it is a part of; empty if each is one
    SpecimenQuality quality;
};

/// What the making of a specimen tells about itself, at most ten times a second but at the beginning of every stage.
struct SpecimenProgress {
    std::string_view stage;  ///< "packing", "cells", "mesh", "filling"
    double share = 0.0;      ///< of the stage that is done, 0 to 1: an estimate
    int grains = 0;
};

/// What the caller decides about the making itself; none of it changes a specimen.
struct SpecimenControl {
    int threads = 1;                                        ///< at least 1
    std::function<void(const SpecimenProgress&)> progress;  ///< may be empty; may throw, which ends the making
};

/// Packs, tessellates and meshes. Deterministic: the same spec and seed give the same bits, for any number of threads.
/// @throws InputError     for impossible specs (grains larger than the specimen, a self-crossing outline, ...)
/// @throws NumericalError when the relaxation cannot reach its criterion
Specimen make_specimen(const SpecimenSpec& spec, std::uint64_t seed, const SpecimenControl& control = {});

/// Coefficient of variation of the grain diameters below which discs arrange themselves in rows like a crystal
/// (docs/theory/specimen.md, section 2).
inline constexpr double least_size_spread = 0.10;

/// Number of grains that the porosity asks for: round((1 - porosity) A / (pi dmean^2 / 4)).
int grain_count(const SpecimenSpec& spec);

/// Saves the packing (outline, what it was packed around, seed, discs as they were packed) as a text file with 17 digits, so that
/// loading gives the same bits.
void save_packing(const Specimen& specimen, const std::filesystem::path& file);

/// Loads a packing saved by save_packing. @throws InputError if the file is missing, damaged or does not fit the outline.
Packing load_packing(const std::filesystem::path& file, const Outline& outline);

}  // namespace feldspar
