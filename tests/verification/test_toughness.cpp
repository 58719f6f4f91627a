// Stress intensity at the tip of a notch, from the elastic stresses around it, against finite elements; the work of fracture against that of the contacts.
#include <cmath>

#include <gtest/gtest.h>

#include "feldspar/methods/notched.hpp"
#include "feldspar/lab/stress_fields.hpp"
#include "feldspar/methods/beam.hpp"
#include "feldspar/methods/half_disc.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

// K_I (Pa sqrt(m)) of the Williams series that fits the stresses of the triangles of all grains within a ring around the tip.
double K_I(const Experiment& e, Vec2 tip, Vec2 ahead, double inner_m, double outer_m) {
    const GrainMesh& mesh = e.setup.specimen->mesh;
    std::vector<StressSample> samples;
    for (int g = 0; g < std::ssize(mesh.vertex_count); ++g) {
        const double distance = norm(mesh.nodes[mesh.centre_node[g]] - tip);
        if (distance < inner_m || distance > outer_m) continue;
        for (int t = mesh.triangle_begin[g]; t < mesh.triangle_begin[g + 1]; ++t) {
            const Vec2 a = mesh.nodes[mesh.triangles[t][0]], b = mesh.nodes[mesh.triangles[t][1]], c = mesh.nodes[mesh.triangles[t][2]];
            for (const Vec2 middle : {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)}) samples.push_back({t, cross(b - a, c - a) / 6.0, middle - tip});
        }
    }
    const std::vector<StressField> fields = fields_around_tip(ahead, outer_m);
    std::vector<double> wanted(fields.size(), 0.0);
    wanted[0] = 1.0;
    double K = 0.0;
    for (const auto& [t, w] : fitted_value(samples, fields, wanted)) {
        const Mat2 s = cauchy_stress(e.assembly.elasticity, displacement_gradient(e.assembly.nodes.displacement, e.assembly.triangles[static_cast<std::size_t>(t)]));
        K += w.xx * s.xx + w.xy * s.xy + w.yx * s.yx + w.yy * s.yy;
    }
    return K;
}

constexpr double kGrain = 0.003;

TEST(Toughness, Explore) {
    const RunControl control = fixtures::threads(2);
    const auto run = [&](const char* what, TestSetup s, Vec2 tip, Vec2 ahead, double scale, auto expected) {
        Experiment e(s, control);
        choose_step(e);
        prepare(e);
        evaluate_forces(e.assembly, e.team, Strength::unlimited);
        const double load = reactions(e.assembly).loading;
        printf("%s grains %zu seed %d:", what, s.specimen->cells.cells.size(), (int)s.specimen->seed);
        for (const double inner : {0.8, 1.5})
            for (const double outer : {3.0, 4.0, 5.0, 6.0})
                if (outer * kGrain <= scale) printf("  %.1f-%.0f %+.1f", inner, outer, 100 * (K_I(e, tip, ahead, inner * kGrain, outer * kGrain) / expected(load) - 1));
        printf("\n"); fflush(stdout);
    };
    for (int seed = 1; seed <= 3; ++seed) {
        for (const auto& [x, Y] : {std::pair{0.3, 1.455}, {0.5, 1.940}}) {
            const double W = 16 * kGrain;
            SpecimenSpec spec = fixtures::rectangle(W, 4.5 * W);
            spec.outline.notches = {{{0.0, 2.25 * W}, {x * W, 2.25 * W}, 0.0, ""}};
            TestSetup s = fixtures::setup(fixtures::make(spec, seed), methods::direct_tension);
            run(x == 0.3 ? "edge .3" : "edge .5", s, {x * W, 2.25 * W}, {1, 0}, 0.9 * std::min(x, 1 - x) * W, [&](double P) { return Y * std::abs(P) / (W * 0.08) * std::sqrt(M_PI * x * W); });
        }
        for (const auto& [x, f] : {std::pair{0.3, 1.514}, {0.5, 2.644}}) {
            const double h = 16 * kGrain, S = 4 * h;
            SpecimenSpec spec = fixtures::rectangle(4.4 * h, h);
            spec.outline.notches = {{{2.2 * h, 0.0}, {2.2 * h, x * h}, 0.0, ""}};
            TestSetup s = fixtures::setup(fixtures::make(spec, seed), methods::three_point_bend);
            s.test.own["span"] = {S};
            run(x == 0.3 ? "bend .3" : "bend .5", s, {2.2 * h, x * h}, {0, 1}, 0.9 * std::min(x, 1 - x) * h, [&](double P) { return f * P * S / (0.08 * std::pow(h, 1.5)); });
        }
        for (const auto& [beta, Y] : {std::pair{0.4, 3.759}, {0.5, 4.583}}) {
            const double R = 20 * kGrain;
            SpecimenSpec spec = fixtures::rectangle(0, 0);
            spec.outline.shape = Shape::half_disc;
            spec.outline.diameter_m = 2 * R;
            spec.outline.notches = {{{0.0, 0.0}, {0.0, beta * R}, 0.0, ""}};
            TestSetup s = fixtures::setup(fixtures::make(spec, seed), methods::semi_circular_bend);
            s.test.own["span"] = {1.2 * R};
            run(beta == 0.4 ? "scb .4" : "scb .5", s, {0.0, beta * R}, {0, 1}, 0.9 * std::min(beta, 1 - beta) * R, [&](double P) { return Y * P * std::sqrt(M_PI * beta * R) / (2 * R * 0.08); });
        }
    }
}

}  // namespace
}  // namespace feldspar
