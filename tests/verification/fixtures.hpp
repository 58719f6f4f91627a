// Bodies that the proofs share: the Augig granite's materials, small specimens, a bar of two grains.
#pragma once

#include <memory>

#include "feldspar/lab/experiment.hpp"
#include "feldspar/lab/run_test.hpp"
#include "feldspar/specimen/mesh_grains.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar::fixtures {

inline GrainMaterial granite() { return {25.8e9, 0.23, 2650.0}; }

/// Table 7 of the paper.
inline ContactMaterial table7() {
    ContactMaterial c;
    c.Kn_Pa_m = 18e13;
    c.eta = 0.28;
    c.sigma_nt_Pa = 8.5e6;
    c.tau_Pa = 29.75e6;
    c.mu = 0.40;
    c.Gfn_J_m2 = 20.0;
    c.Gfs_J_m2 = 800.0;
    return c;
}

inline SpecimenSpec rectangle(double width_m, double height_m) {
    SpecimenSpec spec;
    spec.outline.width_m = width_m;
    spec.outline.height_m = height_m;
    spec.thickness_m = 0.08;
    spec.grain_sizes.minimum_m = 0.002;
    spec.grain_sizes.maximum_m = 0.004;
    return spec;
}

inline SpecimenSpec disc(double diameter_m) {
    SpecimenSpec spec = rectangle(0.0, 0.0);
    spec.outline.shape = Shape::disc;
    spec.outline.diameter_m = diameter_m;
    return spec;
}

inline std::shared_ptr<const Specimen> make(const SpecimenSpec& spec, std::uint64_t seed = 1) {
    return std::make_shared<const Specimen>(make_specimen(spec, seed));
}

/// Two square grains of side h, one on top of the other.
inline std::shared_ptr<const Specimen> two_grain_bar(double h_m) {
    Specimen s;
    s.spec = rectangle(h_m, 2.0 * h_m);
    s.outline.vertices = {{0, 0}, {h_m, 0}, {h_m, 2 * h_m}, {0, 2 * h_m}};
    s.outline.edge_labels = {"bottom", "right", "top", "left"};
    s.outline.area_m2 = 2 * h_m * h_m;
    s.packing.centres = {{0.5 * h_m, 0.5 * h_m}, {0.5 * h_m, 1.5 * h_m}};
    s.packing.radii_m = {0.5 * h_m, 0.5 * h_m};
    s.cells.vertices = {{0, 0}, {h_m, 0}, {h_m, h_m}, {0, h_m}, {h_m, 2 * h_m}, {0, 2 * h_m}};
    s.cells.cells = {{{0, 1, 2, 3}, {-1, -1, 1, -1}, {0, 1, -1, 3}}, {{3, 2, 4, 5}, {0, -1, -1, -1}, {-1, 1, 2, 3}}};
    s.mesh = mesh_grains(s.cells, 0);
    return std::make_shared<const Specimen>(std::move(s));
}

inline TestSetup setup(std::shared_ptr<const Specimen> specimen, TestKind kind) {
    TestSetup s;
    s.specimen = std::move(specimen);
    s.grain = granite();
    s.contact = table7();
    s.test.kind = kind;
    return s;
}

inline RunControl threads(int count) {
    RunControl control;
    control.threads = count;
    return control;
}

}  // namespace feldspar::fixtures
