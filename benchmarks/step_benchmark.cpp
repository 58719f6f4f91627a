// What a step costs, stage by stage, on the paper's specimens (1630 grains; 640 for the Brazilian disc).
#include <memory>

#include <benchmark/benchmark.h>

#include "feldspar/lab/body_energy.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/model/platens.hpp"
#include "feldspar/specimen/specimen.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {
namespace {

// The Augig granite with the elastic constants of Table 1 and the strengths of Table 7 of the paper, under a strain of 1e-4.
Assembly granite(GrainKind grains, bool disc) {
    SpecimenSpec spec;
    spec.outline.shape = disc ? Shape::disc : Shape::rectangle;
    spec.outline.width_m = 0.08;
    spec.outline.height_m = 0.16;
    spec.outline.diameter_m = 0.08;
    spec.grain_sizes.minimum_m = 0.002;
    spec.grain_sizes.maximum_m = 0.004;
    if (grains == GrainKind::inner_particles) spec.particles_per_grain = 26.36;
    ContactMaterial contact;
    contact.Kn_Pa_m = grains == GrainKind::flexible ? 18e13 : grains == GrainKind::rigid ? 1.08e13 : 4.9e13;
    contact.eta = grains == GrainKind::inner_particles ? 0.30 : 0.28;
    contact.sigma_nt_Pa = 8.5e6;
    contact.tau_Pa = 29.75e6;
    contact.mu = 0.4;
    contact.Gfn_J_m2 = 20.0;
    contact.Gfs_J_m2 = 800.0;
    ModelSpec model;
    model.kind = grains;
    Assembly assembly = assemble(make_specimen(spec, 1), model, {25.8e9, 0.23, 2650.0}, contact);
    set_scaled_masses(assembly, MassBound::tensor, 1.0);
    for (const Body& body : assembly.bodies) {
        const bool rigid = body.kind == BodyKind::rigid;   // rigid bodies do not turn
        for (const int n : body.nodes())
            if (!rigid || n == body.centre_node) assembly.nodes.displacement[n] = 1e-4 * assembly.nodes.reference[n];
    }
    return assembly;
}

void label(benchmark::State& state, const Assembly& assembly) {
    const double steps = static_cast<double>(state.iterations());
    using Counter = benchmark::Counter;
    const auto per = [&](std::size_t count) { return Counter(steps * static_cast<double>(count), Counter::kIsRate | Counter::kInvert); };
    if (!assembly.triangles.empty()) state.counters["s/triangle"] = per(assembly.triangles.size());
    state.counters["s/point"] = per(assembly.points.size());
    state.counters["B/grain"] = assembly.memory_bytes() / static_cast<double>(assembly.bodies.size());
}

constexpr GrainKind kFlexible = GrainKind::flexible, kRigid = GrainKind::rigid, kInner = GrainKind::inner_particles;

void contact_stage(benchmark::State& state, GrainKind grains) {
    Assembly assembly = granite(grains, false);
    for (auto _ : state) contact_forces(assembly, {0, static_cast<int>(assembly.contacts.size())}, StepSettings{}, 0);
    label(state, assembly);
}

void body_stage(benchmark::State& state, GrainKind grains) {
    Assembly assembly = granite(grains, false);
    StepSettings settings;
    settings.dt = 0.0;   // the same state every time
    for (auto _ : state) body_forces(assembly, {0, static_cast<int>(assembly.bodies.size())}, settings);
    label(state, assembly);
}

// Ten steps; the ratio of the models on the same packing is Table 4 of the paper.
void ten_steps(benchmark::State& state, GrainKind grains, bool disc) {
    Assembly assembly = granite(grains, disc);
    Team team(static_cast<int>(state.range(0)));
    StepSettings settings;
    settings.viscous = 0.01;
    settings.strength = Strength::unlimited;
    PlatenWork work;
    for (auto _ : state) advance(assembly, team, settings, 0, 10, work);
    state.SetItemsProcessed(state.iterations() * 10);   // steps
    label(state, assembly);
}

void energy_sums(benchmark::State& state) {
    const Assembly assembly = granite(kFlexible, false);
    for (auto _ : state) benchmark::DoNotOptimize(stored_energy(assembly, 0.0));
}

#define FELDSPAR_STAGES(model, grains)                                                                                     \
    BENCHMARK_CAPTURE(contact_stage, model, grains)->Unit(benchmark::kMicrosecond);                                       \
    BENCHMARK_CAPTURE(body_stage, model, grains)->Unit(benchmark::kMicrosecond);                                          \
    BENCHMARK_CAPTURE(ten_steps, model##_uniaxial, grains, false)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond)->UseRealTime(); \
    BENCHMARK_CAPTURE(ten_steps, model##_brazilian, grains, true)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond)->UseRealTime()

FELDSPAR_STAGES(flexible, kFlexible);
FELDSPAR_STAGES(rigid, kRigid);
FELDSPAR_STAGES(inner_particles, kInner);
BENCHMARK(energy_sums)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace feldspar
