// What it takes to make a specimen and to get it ready for the first step, stage by stage: the paper's rectangle (1630 grains)
// and one of 100,000 grains of the same sizes and shape.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "benchmarks/granite_material.hpp"
#include "feldspar/lab/stability.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/fixtures.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/specimen/clip_cells.hpp"
#include "feldspar/specimen/fill_grains.hpp"
#include "feldspar/specimen/grain_sizes.hpp"
#include "feldspar/specimen/merge_edges.hpp"
#include "feldspar/specimen/mesh_grains.hpp"
#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/pack_discs.hpp"
#include "feldspar/specimen/specimen.hpp"
#include "feldspar/specimen/tessellate_laguerre.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {
namespace {

constexpr int kPaper = 1630, kLarge = 100000;
constexpr double kMergeLength = 0.003 / 12.0;

// Grains of 2 to 4 mm in a rectangle twice as high as wide that holds `grains` of them.
SpecimenSpec rectangle_of(std::int64_t grains) {
    SpecimenSpec spec;
    spec.outline.width_m = 0.08 * std::sqrt(static_cast<double>(grains) / kPaper);
    spec.outline.height_m = 2.0 * spec.outline.width_m;
    spec.grain_sizes.minimum_m = benchmarks::kSmallestGrain;
    spec.grain_sizes.maximum_m = benchmarks::kLargestGrain;
    return spec;
}

// Made once for each size and shared by the stages that start from it.
const Specimen& specimen_of(std::int64_t grains) {
    static const Specimen paper = make_specimen(rectangle_of(kPaper), 1);
    if (grains == kPaper) return paper;
    static const Specimen large = make_specimen(rectangle_of(kLarge), 1);
    return large;
}

Packing pack(const SpecimenSpec& spec, const Outline& outline, Team& team) {
    RandomStream sizes(1, "grain sizes"), places(1, "packing positions");
    return pack_discs(outline, sample_diameters(spec.grain_sizes, grain_count(spec), sizes), places, {.team = &team, .tell = {}});
}

CellGraph cells_of(const Specimen& specimen) {
    std::vector<double> weights;
    for (const double r : specimen.packing.radii_m) weights.push_back(r * r);
    return clip_cells(specimen.packing.centres, weights, specimen.outline);
}

Assembly granite(std::int64_t grains) {
    return assemble(specimen_of(grains), ModelSpec{}, benchmarks::kGranite, benchmarks::granite_contact(GrainKind::flexible));
}

void packing(benchmark::State& state) {
    const SpecimenSpec spec = rectangle_of(state.range(0));
    const Outline outline = make_outline(spec.outline);
    Packing made;
    Team team(static_cast<int>(state.range(1)));
    for (auto _ : state) made = pack(spec, outline, team);
    state.counters["steps"] = made.relaxation_steps;
    state.counters["residual"] = made.residual;
}

void clipping(benchmark::State& state) {
    const Specimen& specimen = specimen_of(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(cells_of(specimen));
}

void merging(benchmark::State& state) {
    const CellGraph cells = cells_of(specimen_of(state.range(0)));
    for (auto _ : state) {
        state.PauseTiming();
        CellGraph graph = cells;
        state.ResumeTiming();
        benchmark::DoNotOptimize(merge_short_edges(graph, specimen_of(state.range(0)).outline, kMergeLength));
    }
}

void tessellation(benchmark::State& state) {
    const Specimen& specimen = specimen_of(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(tessellate_laguerre(specimen.packing, specimen.outline, kMergeLength));
}

void meshing(benchmark::State& state) {
    const Specimen& specimen = specimen_of(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(mesh_grains(specimen.cells, 0));
}

void filling(benchmark::State& state) {
    const Specimen& specimen = specimen_of(state.range(0));
    Team team(static_cast<int>(state.range(1)));
    for (auto _ : state) benchmark::DoNotOptimize(fill_grains(specimen.cells, 26.36, 1, {.team = &team, .tell = {}}));
}

void whole_specimen(benchmark::State& state) {
    const SpecimenSpec spec = rectangle_of(state.range(0));
    for (auto _ : state)
        benchmark::DoNotOptimize(make_specimen(spec, 1, {.threads = static_cast<int>(state.range(1)), .progress = {}}));
}

void assembling(benchmark::State& state) {
    (void)specimen_of(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(granite(state.range(0)));
}

void masses(benchmark::State& state) {
    Assembly assembly = granite(state.range(0));
    for (auto _ : state) set_scaled_masses(assembly, MassBound::tensor, 1.0);
}

void stability(benchmark::State& state) {
    Assembly assembly = granite(state.range(0));
    const ContactMaterial contact = benchmarks::granite_contact(GrainKind::flexible);
    attach(assembly, specimen_of(state.range(0)),
           method_of(methods::uniaxial_compression)
               .build.fixtures({specimen_of(state.range(0)), {}, benchmarks::kGranite, contact, {}}));
    set_scaled_masses(assembly, MassBound::tensor, 1.0);
    Team team(static_cast<int>(state.range(1)));
    for (auto _ : state) benchmark::DoNotOptimize(largest_omega2(assembly, team));
}

void contact_finder(benchmark::State& state) {
    const Assembly assembly = granite(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(ContactFinder(assembly, 3e-4));
}

#define FELDSPAR_SETUP(stage) \
    BENCHMARK(stage)->Arg(kPaper)->Arg(kLarge)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime()
// With one thread and, where it pays, with two.
#define FELDSPAR_SETUP_THREADS(stage)   \
    BENCHMARK(stage)                    \
        ->Args({kPaper, 1})             \
        ->Args({kLarge, 1})             \
        ->Args({kLarge, 2})             \
        ->Unit(benchmark::kMillisecond) \
        ->UseRealTime()                 \
        ->MeasureProcessCPUTime()

FELDSPAR_SETUP_THREADS(packing);
FELDSPAR_SETUP(clipping);
FELDSPAR_SETUP(merging);
FELDSPAR_SETUP(tessellation);
FELDSPAR_SETUP(meshing);
FELDSPAR_SETUP_THREADS(filling)->Args({kPaper, 2});
FELDSPAR_SETUP_THREADS(whole_specimen);
FELDSPAR_SETUP(assembling);
FELDSPAR_SETUP(masses);
FELDSPAR_SETUP_THREADS(stability);
FELDSPAR_SETUP(contact_finder);

}  // namespace
}  // namespace feldspar
