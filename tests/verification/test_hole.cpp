// A plate with a round hole against finite elements of the elastic plate.
#include <cmath>

#include <gtest/gtest.h>

#include "feldspar/methods/round_hole.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

// A plate 2 W wide and 4 W high with a hole of this radius, in mean grains of 3 mm.
SpecimenSpec plate(double radius_in_grains, double radius_over_half_width) {
    constexpr double grain_m = 0.003;
    const double radius = radius_in_grains * grain_m, W = radius / radius_over_half_width;
    SpecimenSpec spec = fixtures::rectangle(2.0 * W, 4.0 * W);
    spec.outline.holes = {{{W, 2.0 * W}, 2.0 * radius, {}, ""}};
    return spec;
}

struct Elastic {
    double side, pole;   // stress along the edge over the axial stress of the whole plate
};

Elastic elastic(const SpecimenSpec& spec, const ModelSpec& model = {}, double sigma3_Pa = 0.0, std::uint64_t seed = 1) {
    TestSetup s = fixtures::setup(fixtures::make(fixtures::filled_for(model, spec), seed), methods::hole_compression);
    s.model = model;
    s.contact = fixtures::material(model);
    s.test.sigma3_Pa = sigma3_Pa;
    const RunControl control = fixtures::threads(2);
    Experiment e(s, control);
    choose_step(e);
    prepare(e);
    evaluate_forces(e.assembly, e.team, Strength::unlimited);
    const std::vector<double> read = e.gauges.read(e.assembly);
    const double axial = e.stress(reactions(e.assembly).loading);
    printf("grains %zu nodes steps %lld axial %g\n", s.specimen->cells.cells.size(), e.preparation_steps, axial);
    return {read[0] / axial, read[1] / axial};
}

TEST(Hole, Explore) {
    const int threads = 2; (void)threads;
    for (const auto& [ratio, side, pole] : {std::tuple{0.25, 3.251, -1.189}, {1.0/3, 3.488, -1.327}, {0.5, 4.370, -1.688}})
        for (const double a : {3.0, 4.5, 6.0})
            for (int seed = 1; seed <= 2; ++seed) {
                const Elastic e = elastic(plate(a, ratio), {}, 0.0, seed);
                printf("a/W %.3f a/d %.1f seed %d side %.3f (%+.1f %%) pole %.3f (%+.1f %%)\n", ratio, a, seed, e.side, 100 * (e.side / side - 1), e.pole, 100 * (e.pole / pole - 1));
                fflush(stdout);
            }
}

}  // namespace
}  // namespace feldspar
