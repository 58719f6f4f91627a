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

}  // namespace feldspar
