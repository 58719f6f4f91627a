// Specimens that several tests use.
#pragma once

#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Grains of 2-4 mm, uniform in diameter, in no outline yet.
inline SpecimenSpec two_to_four_millimetres() {
    SpecimenSpec spec;
    spec.grain_sizes.minimum_m = 0.002;
    spec.grain_sizes.maximum_m = 0.004;
    return spec;
}

inline SpecimenSpec rectangle(double width_m = 0.08, double height_m = 0.16) {
    SpecimenSpec spec = two_to_four_millimetres();
    spec.outline.width_m = width_m;
    spec.outline.height_m = height_m;
    return spec;
}

inline SpecimenSpec disc(double diameter_m = 0.08) {
    SpecimenSpec spec = two_to_four_millimetres();
    spec.outline.shape = Shape::disc;
    spec.outline.diameter_m = diameter_m;
    return spec;
}

/// A disc between two flats of so many degrees each, as the centre sees them.
inline SpecimenSpec flattened_disc(double diameter_m = 0.08, double flat_deg = 20.0) {
    SpecimenSpec spec = disc(diameter_m);
    spec.outline.flat_angle_rad = flat_deg * 3.14159265358979323846 / 180.0;
    return spec;
}

inline SpecimenSpec polygon(std::vector<Vec2> vertices_m) {
    SpecimenSpec spec = two_to_four_millimetres();
    spec.outline.shape = Shape::polygon;
    spec.outline.vertices_m = std::move(vertices_m);
    return spec;
}

/// An L of three squares of 20 mm.
inline SpecimenSpec ell() { return polygon({{0, 0}, {0.04, 0}, {0.04, 0.02}, {0.02, 0.02}, {0.02, 0.04}, {0, 0.04}}); }

/// A square of 40 mm with a slit 0.4 mm wide, thinner than any grain, from the top to the middle.
inline SpecimenSpec slit() {
    return polygon({{0, 0}, {0.04, 0}, {0.04, 0.04}, {0.0202, 0.04}, {0.0202, 0.02}, {0.0198, 0.02}, {0.0198, 0.04}, {0, 0.04}});
}

inline SpecimenSpec triangle() { return polygon({{0, 0}, {0.05, 0}, {0.01, 0.04}}); }

/// A square whose top and bottom have a vertex in the middle, so that half of each can be loaded.
inline SpecimenSpec split_sides() { return polygon({{0, 0}, {0.015, 0}, {0.03, 0}, {0.03, 0.03}, {0.015, 0.03}, {0, 0.03}}); }

/// A dog bone of 40 x 60 mm, whose left side comes in and whose right side bulges: both are arcs.
inline SpecimenSpec round_sides() {
    SpecimenSpec spec = polygon({{0, 0}, {0.04, 0}, {0.04, 0.06}, {0, 0.06}});
    spec.outline.arcs = {{1, {0.05, 0.03}}, {3, {0.008, 0.03}}};
    return spec;
}

/// A half disc with a notch from the middle of its flat, as for the semi-circular bend test.
inline SpecimenSpec half_disc(double diameter_m = 0.06, double notch_width_m = 0.001) {
    SpecimenSpec spec = disc(diameter_m);
    spec.outline.shape = Shape::half_disc;
    spec.outline.notches = {{{0.0, 0.0}, {0.0, 0.2 * diameter_m}, notch_width_m, {}}};
    return spec;
}

inline SpecimenSpec ring() {
    SpecimenSpec spec = disc(0.06);
    spec.outline.shape = Shape::ring;
    spec.outline.hole_diameter_m = 0.02;
    return spec;
}

/// A beam with a notch from the middle of its lower side.
inline SpecimenSpec notched_beam(double notch_width_m = 0.001) {
    SpecimenSpec spec = rectangle(0.06, 0.03);
    spec.outline.notches = {{{0.03, 0.0}, {0.03, 0.01}, notch_width_m, {}}};
    return spec;
}

/// A plate with two cracks inside, one of them oblique and without width.
inline SpecimenSpec cracked_plate() {
    SpecimenSpec spec = rectangle(0.05, 0.05);
    spec.outline.notches = {{{0.01, 0.012}, {0.022, 0.024}, 0.0, {}}, {{0.03, 0.035}, {0.042, 0.03}, 0.0005, {}}};
    return spec;
}

/// A plate with a round hole, from which a cut and a slit go, and a square one.
inline SpecimenSpec holed_plate() {
    SpecimenSpec spec = rectangle(0.05, 0.06);
    spec.outline.holes = {{{0.025, 0.025}, 0.012, {}, {}},
                          {{}, 0.0, {{0.008, 0.044}, {0.008, 0.052}, {0.016, 0.052}, {0.016, 0.044}}, "box"}};
    spec.outline.notches = {{{0.031, 0.025}, {0.04, 0.03}, 0.0, {}}, {{0.019, 0.025}, {0.01, 0.02}, 0.001, "wing"}};
    return spec;
}

}  // namespace feldspar
