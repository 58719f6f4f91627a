// From the user's outline to one that is ready for use: counter-clockwise, labelled, checked.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "feldspar/geometry/polygon.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// What the grains say of an outline: how finely its arcs are divided, what discs are packed around, and what is too small.
struct GrainScale {
    double mean_m =
        0.0;  ///< diameter; 0 = not known: arcs are divided by the least number of edges, and everything is packed around
    double largest_m = 0.0;  ///< diameter
};

/// Checks the spec and makes the outline. Rectangle: [0, width] x [0, height], edges bottom, right, top, left. Disc: centre
/// (0, 0), flats at y = R cos(angle / 2) and below. Polygon: turned counter-clockwise where needed, each label staying with its
/// edge; round edges divided, each piece with the label of its edge. Half disc: a polygon, its corners on the arc, edges "flat"
/// and then "arc", with one of these in the middle of the arc. Ring: a disc with a round hole, "hole". Arcs of polygons and of
/// the half disc and round holes are polygons of arc_edges() edges a circle; that of a hole has the area of the circle.
/// @throws InputError for lengths that are not positive, flats of no angle below 180 degrees, a polygon that crosses or touches
/// itself, a wrong number of labels,
///                    holes that are smaller than a grain, touch the boundary or each other, notches that are shorter than a
///                    grain, lie outside, touch each other or leave a bridge thinner than a grain
Outline make_outline(const OutlineSpec& spec, const GrainScale& grains = {});

/// The same with the scale of the specimen's grains.
Outline make_outline(const SpecimenSpec& spec);

/// Edges of a polygon for a circle of this radius (m): as long as a mean grain, which is how long chords of cells on a circle
/// are, so that finer ones would only add corners to cells; and at least 24, which stay within 0.9 % of the radius and, on the
/// smallest hole allowed, are longer than merged edges.
int arc_edges(double radius_m, double mean_grain_m);

/// The area that discs are packed in (m2): the outline's and that of the cutouts that are not packed around.
double packed_area_m2(const Outline& outline);

/// The outline with all its lengths and places times `factor`.
OutlineSpec scaled(const OutlineSpec& spec, double factor);

/// Smallest box around the outline.
Box bounding_box(const OutlineSpec& spec);

/// The labels of the edges that platens press on and hold.
inline constexpr const char* top_label = "top";
inline constexpr const char* bottom_label = "bottom";

/// What is wrong with the edges labelled "top" and "bottom", in words for the user.
struct EndFault {
    int edge = 0;  ///< into the spec's edge labels
    std::string problem, allowed, suggestion;
};

/// Edges labelled "top" must face up and those labelled "bottom" down, within ten degrees, the former above the latter. Says what
/// is against that; empty if nothing is, or if only one of the labels or none is there. Either orientation of the polygon.
std::optional<EndFault> end_fault(const OutlineSpec& spec);

/// Widths of the sections across the load, which acts along y (m). Of a section that the outline, holes or slits cut into pieces,
/// their sum. A cut without width takes nothing of it: it carries pressure.
struct SectionWidths {
    double narrowest = 0.0;  ///< between the ends
    double widest = 0.0;
    double gauge_narrowest = 0.0;  ///< in the central half of the height, where the strain gauge is
    double gauge_widest = 0.0;
};

/// Sections of an outline with ends between the highest point of its bottom and the lowest of its top. A disc has zeros.
SectionWidths section_widths(const Outline& outline);

/// The edges of a flattened disc, into Outline::edge_labels.
inline constexpr int circle_edge = 0, top_flat = 1, bottom_flat = 2;

/// Corners of a flattened disc (m): left and right of the top, left and right of the bottom.
std::array<Vec2, 4> flat_corners(const Outline& outline);

/// Smallest box around the outline.
Box bounding_box(const Outline& outline);

/// True if `point` lies inside, where discs are packed: cutouts that are not packed around do not count. On the boundary either.
bool contains(const Outline& outline, Vec2 point);

/// Distance from `point` to the boundary (m), that of the cutouts that are packed around included; never negative.
double distance_to_boundary(const Outline& outline, Vec2 point);

}  // namespace feldspar
