#include "benchmarks/granite.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "benchmarks/granite_material.hpp"
#include "feldspar/lab/body_energy.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/fixtures.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/specimen/specimen.hpp"
#include "feldspar/step/advance_packs.hpp"

namespace feldspar::benchmarks {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr double kStrain = 1e-4;      // compression along y
constexpr double kShortStep = 1e-12;  // of the unit of time; not 0, which a step might treat apart

SpecimenSpec specimen_spec(GrainKind grains, Load load, double length_scale) {
    SpecimenSpec spec;
    spec.outline.shape = load == Load::brazilian ? Shape::disc : Shape::rectangle;
    spec.outline.width_m = 0.08 * length_scale;
    spec.outline.height_m = 0.16 * length_scale;
    spec.outline.diameter_m = 0.08 * length_scale;
    spec.grain_sizes.minimum_m = kSmallestGrain;
    spec.grain_sizes.maximum_m = kLargestGrain;
    if (grains == GrainKind::inner_particles) spec.particles_per_grain = 26.36;
    return spec;
}

// All models and all programs that share the folder run on the same packing. Written aside, so that an interrupted run leaves
// none.
Specimen make_or_load(SpecimenSpec spec, const std::filesystem::path& packings) {
    if (packings.empty()) return make_specimen(spec, kSeed);
    const bool disc = spec.outline.shape == Shape::disc;
    const std::filesystem::path file =
        packings / fmt::format("{}-{}-grains.txt", disc ? "disc" : "rectangle", feldspar::grain_count(spec));
    if (std::filesystem::exists(file)) {
        spec.packing_file = file;
        return make_specimen(spec, kSeed);
    }
    Specimen specimen = make_specimen(spec, kSeed);
    std::filesystem::create_directories(packings);
    const std::filesystem::path aside = file.string() + ".part";
    save_packing(specimen, aside);
    std::filesystem::rename(aside, file);
    return specimen;
}

Assembly make_assembly(GrainKind grains, Load load, const Specimen& specimen) {
    ModelSpec model;
    model.kind = grains;
    const ContactMaterial contact = granite_contact(grains);
    Assembly assembly = assemble(specimen, model, kGranite, contact);
    TestSpec test;
    test.kind = load == Load::brazilian ? methods::brazilian : methods::uniaxial_compression;
    attach(assembly, specimen, method_of(test).build.fixtures({specimen, model, kGranite, contact, test}));
    set_scaled_masses(assembly, MassBound::tensor, 1.0);
    Nodes& nodes = assembly.nodes;
    for (const Body& body : assembly.bodies) {
        for (const int n : body.nodes()) {
            if (body.kind == BodyKind::rigid && n != body.centre_node) continue;  // rigid bodies do not turn
            const double y = nodes.reference[n].y;
            nodes.displacement[n] = {0.0, -kStrain * y};
            nodes.velocity[n] = {0.0, -1e-8 * y};
            nodes.loading_mode[n] = {0.0, -y / 0.16};
        }
    }
    return assembly;
}

// Scattered over the points like chance, and the same on every machine (the finaliser of MurmurHash3).
double share_of(std::uint32_t number) {
    std::uint32_t h = number + 1;
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
    return static_cast<double>(h ^ (h >> 16)) / 4294967296.0;
}

enum class Bond { intact, softened, broken_closed, broken_open };

Bond bond_of(State state, std::uint32_t point) {
    if (state != State::breaking) return Bond::intact;
    const double share = share_of(point);
    if (share < 0.30) return Bond::softened;
    if (share < 0.35) return Bond::broken_closed;
    return share < 0.40 ? Bond::broken_open : Bond::intact;
}

// As the law would have left it: softened in tension to a tenth of the way to the break point; broken and pressed together by
// 10 nm; broken and wide open.
BondState bond_state(Bond bond, const BondLaw& law, double area_m2) {
    BondState s;
    if (bond == Bond::softened) {
        s.un_m = s.max_un_m = law.normal.x0 + 0.1 * (law.normal.x_y - law.normal.x0);
        s.damage = law.normal.damage(s.max_un_m);
        s.Fn_N = -(1.0 - s.damage) * law.sigma_nt_Pa * area_m2;
    } else if (bond != Bond::intact) {
        s.max_un_m = 1.1 * law.normal.x_f;
        s.damage = 1.0;
        s.un_m = bond == Bond::broken_open ? s.max_un_m : -1e-8;
        s.Fn_N = bond == Bond::broken_open ? 0.0 : law.Kn_Pa_m * area_m2 * 1e-8;
    }
    return s;
}

}  // namespace

struct Granite::Parts {
    Assembly assembly;
    StepSettings settings;
    long long grains = 0;
};

Granite::Granite(GrainKind grains, Load load, double length_scale, const std::filesystem::path& packings)
    : parts_(std::make_unique<Parts>()) {
    const Specimen specimen = make_or_load(specimen_spec(grains, load, length_scale), packings);
    parts_->grains = specimen.quality.grains;
    parts_->assembly = make_assembly(grains, load, specimen);
    parts_->settings.dt = kShortStep;
    parts_->settings.viscous = 0.01;
    parts_->settings.speed = 1e-8;
    set(State::elastic);
}

Granite::~Granite() = default;

void Granite::set(State state) {
    Assembly& assembly = parts_->assembly;
    parts_->settings.damping = state == State::relaxing ? Damping::viscous : Damping::local;
    for (const Contact& contact : assembly.contacts) {
        if (contact.plate || contact.material == inside_grains) continue;  // plates only touch; inside a grain nothing breaks
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
            const Bond bond = bond_of(state, static_cast<std::uint32_t>(p));
            assembly.set_bond(p, bond_state(bond, assembly.laws[contact.material], assembly.points[p].area_m2));
        }
    }
}

void Granite::run(Stage stage, Team& team, int steps) {
    Assembly& assembly = parts_->assembly;
    const StepSettings& settings = parts_->settings;
    const Kernels& kernels = *settings.kernels;
    const Packs& packs = assembly.packs;
    const auto on_all_threads = [&](auto one_step) {
        sort_out_packs(assembly);
        const KernelArrays arrays(assembly);
        const KernelStep step = kernel_step(settings);
        team.run([&](int thread) {
            for (int k = 0; k < steps; ++k) {
                one_step(arrays, step, thread);
                team.barrier();
            }
        });
    };
    const auto share = [&](const auto& all, int thread) { return team.share(static_cast<int>(std::ssize(all)), thread); };
    switch (stage) {
        case Stage::contacts:  // forces take the place of motions in the lines, so these are written anew: it counts with the
                               // stage
            return on_all_threads([&](const KernelArrays& arrays, const KernelStep& step, int thread) {
                const IndexRange grains = share(packs.grains, thread), contacts = share(packs.contacts, thread),
                                 rigid = team.share(packs.rigid_end, thread);
                kernels.grain_lines(arrays, grains.begin, grains.end);
                kernels.rigid_lines(arrays, rigid.begin, rigid.end);
                team.barrier();
                kernels.contacts(arrays, step, contacts.begin, contacts.end);
            });
        case Stage::bodies:
            return on_all_threads([&](const KernelArrays& arrays, const KernelStep& step, int thread) {
                const IndexRange grains = share(packs.grains, thread), rigid = team.share(packs.rigid_end, thread);
                kernels.grains(arrays, step, grains.begin, grains.end);
                kernels.rigid(arrays, step, rigid.begin, rigid.end);
            });
        case Stage::step: {
            PlatenWork work;
            constexpr int kBlock = 10;  // as a test does
            for (int k = 0; k < steps; k += kBlock) advance(assembly, team, settings, k, std::min(kBlock, steps - k), work);
            return;
        }
        case Stage::energies: {
            double sum = 0.0;
            for (int k = 0; k < steps; ++k) sum += stored_energy(assembly, 0.0).contacts_J;
            volatile double kept = sum;  // the results are used
            static_cast<void>(kept);
            return;
        }
    }
}

Assembly& Granite::assembly() { return parts_->assembly; }
const StepSettings& Granite::settings() const { return parts_->settings; }

Counts Granite::counts() const {
    const Assembly& assembly = parts_->assembly;
    Counts counts;
    counts.grains = parts_->grains;
    counts.bodies = std::ssize(assembly.bodies);
    counts.nodes = assembly.nodes.count();
    counts.triangles = std::ssize(assembly.triangles);
    counts.contacts = std::ssize(assembly.contacts);
    counts.points = std::ssize(assembly.points);
    counts.memory_bytes = assembly.memory_bytes();
    return counts;
}

Granite::Damage Granite::damage() const {
    Damage damage;
    const Assembly& assembly = parts_->assembly;
    for (const Contact& contact : assembly.contacts) {
        if (contact.plate) continue;  // broken from the start
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
            const double D = assembly.bond(p).damage;
            if (D >= 1.0)
                ++damage.broken;
            else if (D > 0.0)
                ++damage.softened;
        }
    }
    return damage;
}

bool Granite::forces_are_sound() const {
    double sum = 0.0;
    for (const Vec2 f : parts_->assembly.nodes.force) sum += std::abs(f.x) + std::abs(f.y);
    return std::isfinite(sum) && sum > 0.0;
}

}  // namespace feldspar::benchmarks
