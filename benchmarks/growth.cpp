#include "benchmarks/growth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "benchmarks/granite_material.hpp"
#include "feldspar/base/mean.hpp"
#include "feldspar/base/state_archive.hpp"
#include "feldspar/lab/acoustic_emission.hpp"
#include "feldspar/lab/keep_test.hpp"
#include "feldspar/lab/memory.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/specimen/clip_cells.hpp"
#include "feldspar/specimen/grain_sizes.hpp"
#include "feldspar/specimen/mesh_grains.hpp"
#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/pack_discs.hpp"
#include "feldspar/specimen/tessellate_laguerre.hpp"

namespace feldspar::benchmarks {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr int kSteps = 20;        // that are looked at
constexpr double kStrain = 1e-4;  // compression along y

SpecimenSpec rectangle_of(int grains) {
    SpecimenSpec spec;
    spec.outline.width_m = 0.08 * std::sqrt(grains / 1630.0);
    spec.outline.height_m = 2.0 * spec.outline.width_m;
    spec.grain_sizes.minimum_m = kSmallestGrain;
    spec.grain_sizes.maximum_m = kLargestGrain;
    return spec;
}

// The work is done once, and counts as one.
template <class Work>
std::function<double()> once(Work work) {
    return [work] {
        work();
        return 1.0;
    };
}

double mean_cell_diameter(const Tessellation& cells) {
    double sum = 0.0;
    for (int c = 0; c < std::ssize(cells.cells); ++c)
        sum += 2.0 * std::sqrt(signed_area(corners_of_cell(cells, c)) / std::numbers::pi);
    return sum / static_cast<double>(cells.cells.size());
}

}  // namespace

GrowingTest::GrowingTest(int grains, int threads, const StageWatch& watch) {
    control_.threads = threads;
    Team team(threads);
    const StageControl shared{.team = &team, .tell = {}};
    Specimen& s = *specimen_;
    s.spec = rectangle_of(grains);
    s.seed = kSeed;
    s.outline = make_outline(s.spec.outline);
    RandomStream sizes(kSeed, "grain sizes"), places(kSeed, "packing positions");
    const std::vector<double> diameters = sample_diameters(s.spec.grain_sizes, grain_count(s.spec), sizes);
    watch("places of the discs", once([&] { s.packing = place_discs(s.outline, diameters, places); }));
    watch("relaxation, a step", [&] {
        relax_discs(s.packing, s.outline, {}, shared);
        return static_cast<double>(s.packing.relaxation_steps);
    });
    const double mean = 2.0 * mean_of(s.packing.radii_m);
    {
        std::vector<double> weights;
        for (const double r : s.packing.radii_m) weights.push_back(r * r);
        CellGraph graph;
        watch("clipping", once([&] { graph = clip_cells(s.packing.centres, weights, s.outline, shared); }));
        watch("merging, cells", once([&] { s.cells = tessellation_of(std::move(graph), s.outline, mean, mean / 12.0); }));
    }
    watch("meshing", once([&] { s.mesh = mesh_grains(s.cells, 0, shared); }));
    s.quality.grains = this->grains();
    s.quality.mean_diameter_m = mean;
    s.quality.cell_sizes.mean_m = mean_cell_diameter(s.cells);
    setup_ = {specimen_, {}, kGranite, granite_contact(GrainKind::flexible), {}, {}, {}};
}

void GrowingTest::set_up(const StageWatch& watch) {
    watch("assembly", once([&] { experiment_ = std::make_unique<Experiment>(setup_, control_); }));
    watch("masses, largest eigenvalue", once([&] { choose_step(*experiment_); }));
}

void GrowingTest::test(const StageWatch& watch) {
    Experiment& e = *experiment_;
    result_.test = setup_.test;
    result_.model = setup_.model;
    result_.contact = setup_.contact;
    result_.grain = setup_.grain;
    result_.numerics = setup_.numerics;
    result_.seed = kSeed;
    result_.specimen = specimen_;
    result_.gauges = e.gauges.specs();
    result_.length_m = e.length_m;
    result_.section_m2 = e.section_m2;
    result_.travel_time = result_.travel_steps = e.travel_time;
    recorder_ = std::make_unique<Recorder>(e, result_);
    StateBase base;
    watch("base state", once([&] { base = StateBase::of(e.state()); }));

    Nodes& nodes = e.assembly.nodes;
    for (int n = 0; n < nodes.count(); ++n) {
        nodes.displacement[n] = {0.0, -kStrain * nodes.reference[n].y};
        nodes.velocity[n] = {0.0, -1e-8 * nodes.reference[n].y};
        nodes.loading_mode[n] = {0.0, -nodes.reference[n].y / e.length_m};
    }
    watch("elastic start, a step", [&] {
        const long long steps = relax(e.assembly, e.team, Strength::unlimited, 0.0, kSteps, [] { return false; }).steps;
        return static_cast<double>(steps);
    });
    watch("a step", [&] {
        e.run(kSteps);
        return static_cast<double>(kSteps);
    });
    watch("first record", once([&] { recorder_->record(Phase::loading); }));
    look_at_contacts(watch);
    for (std::size_t p = 0; p < e.assembly.points.size(); p += 50) {  // evenly over the specimen
        BondState bond = e.assembly.bond(static_cast<int>(p));
        bond.damage = 1.0;
        bond.un_m = 1e-6;
        e.assembly.set_bond(static_cast<int>(p), bond);
        ContactPoint& point = e.assembly.points[p];
        point.broken_step = e.step + static_cast<long long>(p % 1009);  // not all at once
        point.broken_J = 1e-4;
        point.broke_in_tension = true;
    }
    watch("a record with cracks", once([&] { recorder_->record(Phase::loading); }));
    watch("acoustic events", once([&] { result_.emission = events_of_cracks(result_, usual_event_radius); }));
    watch("state kept", once([&] {
              std::size_t bytes = 0;
              StateWriter writer([&](const void*, std::size_t count) { bytes += count; }, base);
              writer.write(e.state());
          }));
    watch("fields made ready", once([&] { recorder_->finish(); }));
}

void GrowingTest::look_at_contacts(const StageWatch& watch) {
    Experiment& e = *experiment_;
    std::optional<ContactFinder> finder;
    std::optional<ShapeWatch> shapes;
    watch("search for contacts", once([&] {
              finder.emplace(e.assembly, 0.1 * mean_body_diameter(e.assembly));
              shapes.emplace(e.assembly);
          }));
    watch("a look at contacts", once([&] {
              finder->update(e.assembly, e.mass_factor);
              shapes->look(e.assembly, e.mass_factor);
          }));
    watch("contacts sorted anew", once([&] { index_contacts(e.assembly); }));
}

double GrowingTest::specimen_bytes() const { return memory_of(*specimen_); }

}  // namespace feldspar::benchmarks
