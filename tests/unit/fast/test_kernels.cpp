// The kernels against the readable stages: one step from the same state, every kind of grain, test, law and option. Longer runs
// cannot be compared so: round-off grows by orders of magnitude while a specimen breaks.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "feldspar/base/rng.hpp"
#include "feldspar/lab/experiment.hpp"
#include "feldspar/laws/damping.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/step/advance_packs.hpp"
#include "feldspar/step/step.hpp"
#include "fixtures.hpp"
#include "stirred.hpp"

namespace feldspar {
namespace {

std::vector<const Kernels*> kernels_here() {
    std::vector<const Kernels*> all;
    for (const Kernels* kernels : all_kernels())
        if (is_supported(*kernels)) all.push_back(kernels);
    return all;
}

class OneStep : public testing::TestWithParam<Case> {
protected:
    static TestSetup make() { return setup_of(GetParam()); }
};

TEST_P(OneStep, IsThatOfTheReadableStages) {
    const TestSetup setup = make();
    const RunControl control = fixtures::threads(1);
    Experiment e(setup, control);
    choose_step(e);
    if (GetParam().test == methods::biaxial) e.set_dead_loads(1.0);
    stir(e.assembly);
    mix_contacts(e.assembly);
    const Array<Vec2> weight = weights(e.assembly, {3e3, -5e3});  // some hundred times gravity: as large as forces of contacts
    for (const Damping damping : {Damping::viscous, Damping::local})
        for (const Strength strength : {Strength::real, Strength::unlimited}) {
            e.assembly.weight = damping == Damping::local ? weight : Array<Vec2>{};
            StepSettings settings = e.settings;
            settings.damping = damping;
            settings.viscous = 0.02;
            settings.speed = 1e-9;
            settings.strength = strength;
            Assembly readable = e.assembly;
            PlatenWork readable_work;
            settings.kernels = nullptr;
            advance(readable, e.team, settings, 7, 1, readable_work);
            const auto broke = [](const ContactPoint& point) { return point.broken_step == 7; };
            EXPECT_TRUE(strength == Strength::unlimited || std::any_of(readable.points.begin(), readable.points.end(), broke));
            for (const Kernels* kernels : kernels_here()) {
                Assembly fast = e.assembly;
                PlatenWork work;
                settings.kernels = kernels;
                advance(fast, e.team, settings, 7, 1, work);
                const std::string what = std::string(kernels->name) + (damping == Damping::local ? ", local damping" : "") +
                                         (strength == Strength::unlimited ? ", unlimited" : "");
                // Rounding: gaps of 1e-8 m from velocities of bodies centimetres apart, forces of stiff contacts that nearly
                // cancel.
                expect_same(fast, readable, 1e-9, what);
                EXPECT_NEAR(work.loading, readable_work.loading, 1e-9 * std::abs(readable_work.loading) + 1e-30) << what;
            }
        }
}

TEST_P(OneStep, HasTheSameBitsForAnyNumberOfThreadsAndStepsOfASweep) {
    const TestSetup setup = make();
    const RunControl control = fixtures::threads(1);
    Experiment e(setup, control);
    choose_step(e);
    stir(e.assembly);
    mix_contacts(e.assembly);
    e.assembly.weight = weights(e.assembly, {3e3, -5e3});
    StepSettings settings = e.settings;
    settings.viscous = 0.02;
    settings.speed = 1e-9;
    for (const Kernels* kernels : kernels_here()) {
        settings.kernels = kernels;
        settings.sweep_steps = 1;
        Assembly one = e.assembly;
        PlatenWork one_work;
        advance(one, e.team, settings, 0, 5, one_work);
        for (const auto& [threads, sweep_steps] :
             {std::pair{2, 1}, std::pair{3, 1}, std::pair{1, 2}, std::pair{1, 5}, std::pair{2, 5}, std::pair{3, 3}}) {
            settings.sweep_steps = sweep_steps;
            Assembly several = e.assembly;
            Team team(threads);
            PlatenWork work;
            advance(several, team, settings, 0, 5, work);
            expect_same(several, one, 0.0,
                        fmt::format("{} with {} threads, {} steps a sweep", kernels->name, threads, sweep_steps));
            EXPECT_EQ(work.loading, one_work.loading);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Kernels, OneStep, testing::ValuesIn(cases()), label);

TEST_P(OneStep, LeavesTheMotionOfTheReadableFormulas) {
    const TestSetup setup = make();
    const RunControl control = fixtures::threads(1);
    Experiment e(setup, control);
    choose_step(e);
    stir(e.assembly);
    for (const Damping damping : {Damping::viscous, Damping::local}) {
        StepSettings settings = e.settings;
        settings.damping = damping;
        settings.viscous = 0.02;
        settings.speed = 1e-9;
        Assembly before = e.assembly, after = e.assembly;
        PlatenWork work;
        advance(before, e.team, settings, 0, 4, work);
        advance(after, e.team, settings, 0, 5, work);  // the same bits, one step further
        const Nodes& nodes = after.nodes;
        double kinetic = 0.0, deviation = 0.0, damped = 0.0, size = 0.0;
        for (int n = 0; n < nodes.count(); ++n)
            for (double Vec2::*component : {&Vec2::x, &Vec2::y}) {
                if (nodes.inverse_mass[n].*component == 0.0) continue;
                const double V = nodes.velocity[n].*component, F = nodes.force[n].*component, m = nodes.mass[n];
                const double loading = settings.speed * (nodes.loading_mode[n].*component), w = V - loading;
                // Local damping is undone from the state after the step: exact unless the motion has just turned.
                const double V_before = damping == Damping::viscous
                                            ? before.nodes.velocity[n].*component
                                            : before_local_drag(V, loading, F, settings.dt / m, settings.alpha);
                kinetic += 0.5 * m * V * V_before;
                deviation += 0.5 * m * w * w;
                damped += 0.5 * V * (settings.dt * F - m * (V - V_before));
                size += 0.5 * std::abs(V * settings.dt * F);
            }
        Array<double> unbalanced(after.bodies.size(), 0.0);
        for (std::size_t b = 0; b < after.bodies.size(); ++b)
            for (const int n : after.bodies[b].nodes())
                for (double Vec2::*component : {&Vec2::x, &Vec2::y})
                    if (nodes.inverse_mass[n].*component != 0.0) unbalanced[b] += std::abs(nodes.force[n].*component);
        for (const Kernels* kernels : kernels_here()) {
            const NodeSums sums = kernels->node_sums(KernelArrays::to_read(after), kernel_step(settings));
            EXPECT_NEAR(sums.kinetic / kinetic, 1.0, 1e-9) << kernels->name;
            EXPECT_NEAR(sums.deviation / deviation, 1.0, 1e-12) << kernels->name;
            EXPECT_NEAR(sums.ahead_damping, damped, 1e-9 * size) << kernels->name;  // a small difference of large works
            Array<double> of_bodies(after.bodies.size(), 0.0);
            kernels->unbalanced(KernelArrays::to_read(after), of_bodies.data());
            for (std::size_t b = 0; b < of_bodies.size(); ++b) {
                if (after.packs.pack_of_body[b] < 0) continue;
                EXPECT_NEAR(of_bodies[b], unbalanced[b], 1e-12 * unbalanced[b]) << kernels->name;
            }
        }
    }
}

TEST(Packs, HoldTheEnergyOfTheReadableFormulas) {
    for (const auto& [unloading, uneven] :
         {std::pair{TensionUnloading::elastic, false}, std::pair{TensionUnloading::secant, false},
          std::pair{TensionUnloading::secant, true}}) {
        TestSetup setup = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04)), methods::uniaxial_compression);
        setup.contact.tension_unloading = unloading;
        if (uneven) setup.rock = fixtures::uneven_rock();
        const RunControl control = fixtures::threads(1);
        Experiment e(setup, control);
        choose_step(e);
        stir(e.assembly);
        const Assembly& a = e.assembly;
        PackEnergies expected;
        Array<Vec2> u = a.nodes.displacement;
        for (int n = 0; n < a.nodes.count(); ++n) u[n] -= 0.5 * a.nodes.velocity[n];
        for (int b = 0; b < std::ssize(a.bodies); ++b)
            for (int t = a.bodies[b].triangle_begin; t < a.bodies[b].triangle_end; ++t)
                expected.grains += a.triangles[t].volume_m3 *
                                   strain_energy_density(a.elasticity_of(b), displacement_gradient(u, a.triangles[t]));
        for (const Contact& contact : a.contacts)
            for (int p = contact.first_point; p < contact.first_point + contact.points; ++p)
                expected.contacts[contact.material] += elastic_energy(a.law_of(contact), a.points[p].area_m2, a.bond(p));
        for (const Kernels* kernels : kernels_here()) {
            const PackEnergies sums = kernels->energies(KernelArrays::to_read(a), 0.5);
            EXPECT_NEAR(sums.grains / expected.grains, 1.0, 1e-12)
                << kernels->name;  // sums of thousands of terms in another order
            for (std::size_t role = 0; role < sums.contacts.size(); ++role)
                EXPECT_NEAR(sums.contacts[role], expected.contacts[role], 1e-12 * expected.contacts[role]) << kernels->name;
        }
    }
}

TEST(Packs, HoldEveryGrainOfTheCommonTopologyOnce) {
    const auto specimen = fixtures::make(fixtures::rectangle(0.04, 0.08));
    const Assembly assembly = assemble(*specimen, fixtures::model(GrainKind::flexible), fixtures::granite(), fixtures::table7());
    std::vector<int> seen(assembly.bodies.size(), 0);
    for (const GrainPack& pack : assembly.packs.grains)
        for (int lane = 0; lane < pack.lanes; ++lane) {
            const Body& body = assembly.bodies[pack.grain[lane]];
            ++seen[pack.grain[lane]];
            EXPECT_EQ(body.node_count, pack.nodes());
            EXPECT_EQ(body.triangle_end - body.triangle_begin, pack.triangles());
            EXPECT_EQ(body.centre_node, body.node(pack.vertices));
        }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ssize(seen));
    EXPECT_TRUE(assembly.packs.loose_bodies.empty());
}

// What a body waits for, and what a contact waits for, lies where model/bands.hpp says.
void expect_narrow_bands(const Assembly& assembly) {
    const std::vector<PackRanges>& bands = assembly.packs.bands.ranges;
    const auto band_of = [&](IndexRange PackRanges::*range, int i) {
        const auto at = std::find_if(bands.begin(), bands.end(),
                                     [&](const PackRanges& band) { return (band.*range).begin <= i && i < (band.*range).end; });
        EXPECT_NE(at, bands.end());
        return static_cast<int>(at - bands.begin());
    };
    const auto band_of_body = [&](int body) {
        if (assembly.bodies[body].kind == BodyKind::rigid) return band_of(&PackRanges::rigid, body);
        if (assembly.packs.pack_of_body[body] >= 0) return band_of(&PackRanges::grains, assembly.packs.pack_of_body[body]);
        const auto& loose = assembly.packs.loose_bodies;
        return band_of(&PackRanges::loose_bodies, static_cast<int>(std::find(loose.begin(), loose.end(), body) - loose.begin()));
    };
    int seen = 0;
    for (int p = 0; p < std::ssize(assembly.packs.contacts); ++p) {
        const ContactPack& pack = assembly.packs.contacts[p];
        const int band = band_of(&PackRanges::contacts, p);
        for (int c = pack.first_contact; c < pack.first_contact + pack.lanes; ++c, ++seen)
            for (const ContactSide& side : {assembly.contacts[c].a, assembly.contacts[c].b}) {
                const int of_body = band_of_body(side.body);
                EXPECT_TRUE(of_body == band || of_body == band - 1)
                    << "contact " << c << " in band " << band << ", body in " << of_body;
            }
    }
    EXPECT_EQ(seen, std::ssize(assembly.contacts));
}

TEST(Packs, StandInBandsThatWaitOnlyForTheNext) {
    for (const MethodId test :
         std::initializer_list<MethodId>{methods::uniaxial_compression, methods::biaxial, methods::brazilian})
        for (const ModelSpec& model : {fixtures::model(GrainKind::flexible), fixtures::model(GrainKind::rigid),
                                       fixtures::model(GrainKind::inner_particles)}) {
            const SpecimenSpec spec = test == methods::brazilian ? fixtures::disc(0.04) : fixtures::rectangle(0.02, 0.08);
            TestSetup setup = fixtures::setup(spec, test, model);
            setup.test.sigma3_Pa = test == methods::biaxial ? 2e6 : 0.0;
            setup.test.membrane_plates = 16;
            const RunControl control = fixtures::threads(1);
            Experiment e(setup, control);
            expect_narrow_bands(e.assembly);
            EXPECT_GT(e.assembly.packs.bands.ranges.size(), model.kind == GrainKind::flexible ? 2U : 6U)
                << name(test) << ", " << name(model.kind);
            EXPECT_EQ(e.assembly.packs.bands.steps(2), 1);  // it fits into the shared cache
            mix_contacts(e.assembly);
            expect_narrow_bands(e.assembly);
        }
}

TEST(Packs, OfInnerParticlesStandInStripsWhateverGrainTheyAreOf) {
    TestSetup setup = fixtures::setup(fixtures::rectangle(0.04, 0.08), methods::uniaxial_compression,
                                      fixtures::model(GrainKind::inner_particles));
    const RunControl control = fixtures::threads(1);
    Experiment e(setup, control);
    const Filling& filling = e.setup.specimen->filling;
    ASSERT_EQ(e.assembly.body_of_particle.size(), filling.centres.size());
    std::vector<int> bodies_of_grain(filling.particle_begin.size() - 1, 0);
    for (std::size_t p = 0; p < filling.centres.size(); ++p) {
        const Body& body = e.assembly.bodies[e.assembly.body_of_particle[p]];
        EXPECT_EQ(e.assembly.nodes.reference[body.centre_node], filling.centres[p]);
        EXPECT_EQ(body.radius_m, filling.radii_m[p]);
        ++bodies_of_grain[body.grain];
    }
    for (std::size_t g = 0; g < bodies_of_grain.size(); ++g)
        EXPECT_EQ(bodies_of_grain[g], filling.particle_begin[g + 1] - filling.particle_begin[g]);
    expect_narrow_bands(e.assembly);
    const Bands& bands = e.assembly.packs.bands;
    EXPECT_GT(bands.ranges.size(), 40U);  // of less than 2 mm, the radius of a large grain
    EXPECT_GT(bands.bytes, kOwnCacheBytes);
    EXPECT_GT(bands.steps(1), 1);
}

TEST(Packs, HoldContactsWithANormalOfTheirOwnHoweverFarBodiesHaveTurned) {
    const ModelSpec model = fixtures::model(GrainKind::inner_particles, ContactKind::point, ContactNormal::edge);
    TestSetup setup = fixtures::setup(fixtures::rectangle(0.02, 0.04), methods::uniaxial_compression, model);
    const RunControl control = fixtures::threads(1);
    Experiment e(setup, control);
    choose_step(e);
    stir(e.assembly);
    RandomStream random(7, "turned");
    for (const Body& body : e.assembly.bodies)  // a quarter of a radian parts the series from the rest
        if (body.kind == BodyKind::rigid)
            e.assembly.nodes.displacement[body.centre_node + 1].x = body.radius_m * 3.0 * (random.uniform() - 0.5);
    StepSettings settings = e.settings;
    settings.speed = 1e-9;
    settings.kernels = nullptr;
    Assembly readable = e.assembly;
    PlatenWork work;
    advance(readable, e.team, settings, 0, 1, work);
    for (const Kernels* kernels : kernels_here()) {
        settings.kernels = kernels;
        Assembly fast = e.assembly;
        advance(fast, e.team, settings, 0, 1, work);
        expect_same(fast, readable, 1e-9, kernels->name);
        for (const int c : fast.packs.loose_contacts) EXPECT_TRUE(fast.contacts[c].plate);
    }
}

TEST(StepSequence, GoesOnWhereItsLastCallEnded) {
    const TestSetup setup = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04)), methods::uniaxial_compression);
    const RunControl control = fixtures::threads(1);
    Experiment e(setup, control);
    choose_step(e);
    stir(e.assembly);
    for (const Kernels* kernels : kernels_here()) {
        StepSettings settings = e.settings;
        settings.kernels = kernels;
        settings.speed = 1e-9;
        Assembly at_once = e.assembly, in_calls = e.assembly;
        PlatenWork work, work_in_calls;
        advance(at_once, e.team, settings, 0, 6, work);
        StepSequence steps(in_calls, e.team);
        for (int k = 0; k < 6; k += 2) steps.advance(settings, k, 2, work_in_calls);
        expect_same(in_calls, at_once, 0.0, kernels->name);
        EXPECT_EQ(work.loading, work_in_calls.loading);
    }
}

TEST(Packs, LeaveFinelyMeshedGrainsLooseAndAgreeWithTheReadableStages) {
    SpecimenSpec spec = fixtures::rectangle(0.02, 0.04);
    spec.triangles_per_grain = 40;
    TestSetup setup = fixtures::setup(fixtures::make(spec), methods::uniaxial_compression);
    const RunControl control = fixtures::threads(1);
    Experiment e(setup, control);
    choose_step(e);
    EXPECT_GT(e.assembly.packs.loose_bodies.size(), 20U);
    stir(e.assembly);
    StepSettings settings = e.settings;
    settings.speed = 1e-9;
    settings.kernels = nullptr;
    Assembly readable = e.assembly;
    PlatenWork work;
    advance(readable, e.team, settings, 0, 3, work);
    for (const Kernels* kernels : kernels_here()) {
        settings.kernels = kernels;
        Assembly fast = e.assembly;
        advance(fast, e.team, settings, 0, 3, work);
        expect_same(fast, readable, 1e-8, kernels->name);  // three steps: rounding has grown
    }
}

}  // namespace
}  // namespace feldspar
