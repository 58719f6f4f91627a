// States in which everything happens, of every kind of grain, test, law and option; and what a step leaves of them, compared. For
// whatever makes steps: the kernels of fast/, the devices of gpu/.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "feldspar/base/rng.hpp"
#include "feldspar/lab/experiment.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/step/step.hpp"
#include "fixtures.hpp"

namespace feldspar {

inline double size(double value) { return std::abs(value); }
inline double size(Vec2 value) { return norm(value); }

// Largest difference over the largest size.
template <class Quantity>
double difference(const Quantity& a, const Quantity& b) {
    double largest = 0.0, apart = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        largest = std::max(largest, size(b[i]));
        apart = std::max(apart, size(a[i] - b[i]));
    }
    return largest > 0.0 ? apart / largest : apart;
}

// Everything that a step writes.
inline void expect_same(const Assembly& a, const Assembly& b, double tolerance, const std::string& what) {
    EXPECT_LE(difference(a.nodes.displacement, b.nodes.displacement), tolerance) << what;
    EXPECT_LE(difference(a.nodes.velocity, b.nodes.velocity), tolerance) << what;
    EXPECT_LE(difference(a.nodes.force, b.nodes.force), tolerance) << what;
    const std::vector<std::pair<const char*, Array<double> Bonds::*>> quantities = {{"un", &Bonds::un_m},
                                                                                    {"us", &Bonds::us_m},
                                                                                    {"Fn", &Bonds::Fn_N},
                                                                                    {"Fs", &Bonds::Fs_N},
                                                                                    {"largest un", &Bonds::max_un_m},
                                                                                    {"largest us", &Bonds::max_us_m},
                                                                                    {"damage", &Bonds::damage},
                                                                                    {"slip", &Bonds::slip_m}};
    for (const auto& [name, quantity] : quantities)
        EXPECT_LE(difference(a.bonds.*quantity, b.bonds.*quantity), tolerance) << name << ", " << what;
    // What a point dissipates is a small difference of its works: relative to what it holds.
    double held = 0.0;
    for (std::size_t i = 0; i < b.bonds.un_m.size(); ++i) held = std::max(held, std::abs(b.bonds.Fn_N[i] * b.bonds.un_m[i]));
    for (std::size_t i = 0; i < b.bonds.un_m.size(); ++i) {
        EXPECT_NEAR(a.bonds.fracture_J[i], b.bonds.fracture_J[i], tolerance * held) << what;
        EXPECT_NEAR(a.bonds.friction_J[i], b.bonds.friction_J[i], tolerance * held) << what;
    }
    Array<double> damping_a, damping_b, pressure_a, pressure_b;
    for (std::size_t i = 0; i < a.body_work.size(); ++i) {
        damping_a.push_back(a.body_work[i].damping);
        damping_b.push_back(b.body_work[i].damping);
        pressure_a.push_back(a.body_work[i].pressure);
        pressure_b.push_back(b.body_work[i].pressure);
    }
    EXPECT_LE(difference(damping_a, damping_b), tolerance) << what;
    EXPECT_LE(difference(pressure_a, pressure_b), tolerance) << what;
    for (std::size_t p = 0; p < a.points.size(); ++p) {
        EXPECT_EQ(a.points[p].broken_step, b.points[p].broken_step) << what;
        EXPECT_EQ(a.points[p].broke_in_tension, b.points[p].broke_in_tension) << what;
        EXPECT_EQ(a.points[p].lost_compression, b.points[p].lost_compression) << what;
    }
}

// A state in which everything happens: moved, turned and strained bodies; bonds intact, softened, broken, pressed, sliding, and
// about to break.
inline void stir(Assembly& assembly) {
    RandomStream random(5, "stirred");
    for (const Body& body : assembly.bodies) {
        const Vec2 push = {1e-7 * random.normal(), 1e-7 * random.normal()};
        for (const int n : body.nodes()) {
            const bool turn = body.kind == BodyKind::rigid && n != body.centre_node;
            const Vec2 noise = {2e-8 * random.normal(), turn ? 0.0 : 2e-8 * random.normal()},
                       free = {assembly.nodes.inverse_mass[n].x != 0.0 ? 1.0 : 0.0,
                               assembly.nodes.inverse_mass[n].y != 0.0 ? 1.0 : 0.0};
            const Vec2 u = (turn ? Vec2{} : push) + noise;
            assembly.nodes.displacement[n] += {free.x * u.x, free.y * u.y};
            assembly.nodes.velocity[n] += {1e-2 * free.x * noise.x, 1e-2 * free.y * noise.y};
        }
    }
    for (const Contact& contact : assembly.contacts) {
        const BondLaw law = assembly.law_of(contact);
        if (!std::isfinite(law.normal.x0) || contact.plate) continue;
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
            const double area = assembly.points[p].area_m2, kind = random.uniform();
            BondState bond;
            bond.un_m = law.normal.x0 * (2.4 * random.uniform() - 1.4);
            bond.us_m = law.shear.x0 * (2.4 * random.uniform() - 1.2);
            if (kind < 0.4) {  // intact
                bond.un_m = std::min(bond.un_m, 0.999 * law.normal.x0);
                bond.us_m *= 0.8;
                bond.Fn_N = -(law.Kn_Pa_m * area) * bond.un_m;
                bond.Fs_N = -(law.Ks_Pa_m * area) * bond.us_m;
            } else if (kind < 0.8) {  // softened
                bond.max_un_m = law.normal.x0 + random.uniform() * (law.normal.x_f - law.normal.x0);
                bond.max_us_m = std::abs(bond.us_m);
                bond.damage = std::min(0.999, std::max(1e-3, law.normal.damage(bond.max_un_m)));
                bond.Fn_N = std::max(-(law.Kn_Pa_m * area) * bond.un_m, -(1.0 - bond.damage) * law.sigma_nt_Pa * area);
                bond.Fs_N = 0.3 * (1.0 - bond.damage) * law.tau_Pa * area;
            } else if (kind < 0.9) {  // on the brink: it breaks whatever it does, by more than rounding
                bond.un_m = bond.max_un_m = law.normal.x_f * (1.0 + 1e-12);
                bond.max_us_m = std::abs(bond.us_m);
                bond.damage = 1.0 - 1e-9;
            } else {
                bond.damage = 1.0;
                bond.Fn_N = bond.un_m < 0.0 ? -(law.Kn_Pa_m * area) * bond.un_m : 0.0;
                bond.Fs_N = 0.999 * law.mu * bond.Fn_N;
            }
            assembly.set_bond(p, bond);
        }
    }
}

// Contacts on the fall-back shape functions, dropped ones, and new ones on edges that have a contact already.
inline void mix_contacts(Assembly& assembly) {
    const int contacts = static_cast<int>(assembly.contacts.size());
    for (int c = 0; c < contacts; ++c) {
        Contact& contact = assembly.contacts[c];
        if (contact.plate) continue;
        if (c % 7 == 3) contact.dropped = true;
        if (contact.flexible && c % 11 == 5) contact.initial_shape = true;
        if (c % 13 != 1) continue;
        const int a = contact.a.body, b = contact.b.body;  // `contact` goes with the old array
        const double radii = assembly.bodies[a].radius_m + assembly.bodies[b].radius_m;
        add_new_contact(assembly, a, b, std::min(0.0, radii - norm(assembly.centre(b) - assembly.centre(a)) - 1e-8), radii);
    }
    index_contacts(assembly);
}

struct Case {
    MethodId test;
    ModelSpec model;
    ContactLaw law;
    ShearMeasure measure = ShearMeasure::total;
    TensionUnloading unloading = TensionUnloading::elastic;
    bool uneven = false;   // a rock of two minerals whose contacts scatter
    bool dilates = false;  // and whose joint dilates, until it has slipped a little
};

inline std::vector<Case> cases() {
    std::vector<Case> all;
    std::vector<ModelSpec> models = fixtures::rigid_models();
    models.push_back(fixtures::model(GrainKind::flexible));
    models.push_back(fixtures::model(GrainKind::flexible, ContactKind::point));
    for (const ModelSpec& model : models)
        for (const MethodId test : std::initializer_list<MethodId>{methods::uniaxial_compression, methods::direct_tension,
                                                                   methods::biaxial, methods::brazilian})
            all.push_back({test, model, ContactLaw::bilinear});
    for (const ContactLaw law : {ContactLaw::bilinear, ContactLaw::bilinear_literal, ContactLaw::linear, ContactLaw::brittle})
        for (const ShearMeasure measure : {ShearMeasure::total, ShearMeasure::beyond_friction})
            for (const TensionUnloading unloading : {TensionUnloading::elastic, TensionUnloading::secant})
                all.push_back({methods::uniaxial_compression, fixtures::model(GrainKind::flexible), law, measure, unloading});
    for (const ModelSpec& model : models)
        all.push_back(
            {methods::uniaxial_compression, model, ContactLaw::bilinear, ShearMeasure::total, TensionUnloading::elastic, true});
    for (const ModelSpec& model : models)
        all.push_back({methods::uniaxial_compression, model, ContactLaw::bilinear, ShearMeasure::total, TensionUnloading::elastic,
                       true, true});
    for (const ContactLaw law : {ContactLaw::bilinear_literal, ContactLaw::linear, ContactLaw::brittle})
        for (const TensionUnloading unloading : {TensionUnloading::elastic, TensionUnloading::secant})
            all.push_back({methods::direct_tension, fixtures::model(GrainKind::flexible), law, ShearMeasure::beyond_friction,
                           unloading, true});
    return all;
}

inline std::string label(const testing::TestParamInfo<Case>& info) {
    std::string text = std::string(name(info.param.test)) + "_" + fixtures::label(info.param.model) + "_" + name(info.param.law);
    if (info.param.measure == ShearMeasure::beyond_friction) text += "_beyond_friction";
    if (info.param.unloading == TensionUnloading::secant) text += "_secant";
    if (info.param.uneven) text += "_uneven";
    if (info.param.dilates) text += "_dilates";
    std::erase(text, '-');
    return text + "_" + std::to_string(info.index);
}

inline void PrintTo(const Case& c, std::ostream* out) {
    *out << name(c.test) << ", " << name(c.model.kind) << ", " << name(c.law);
}

inline TestSetup setup_of(const Case& c) {
    const SpecimenSpec spec = c.test == methods::brazilian ? fixtures::disc(0.03) : fixtures::rectangle(0.02, 0.04);
    TestSetup s = fixtures::setup(spec, c.test, c.model, c.law);
    s.contact.shear_measure = c.measure;
    s.contact.tension_unloading = c.unloading;
    if (c.uneven) s.rock = fixtures::uneven_rock();
    if (c.dilates) {
        s.rock.joints.front().dilation = 0.2;
        s.rock.joints.front().dilation_slip_m = 1e-9;
    }
    if (c.test == methods::biaxial) s.test.sigma3_Pa = 2e6;
    s.test.membrane_plates = 4;
    return s;
}

/// A state in which everything happens, and the settings of a fast loading.
struct Stirred {
    TestSetup setup;
    RunControl control;
    Experiment e;
    StepSettings settings;

    explicit Stirred(const TestSetup& s, int threads = 1) : setup(s), control(fixtures::threads(threads)), e(setup, control) {
        choose_step(e);
        if (setup.test.kind == methods::biaxial) e.set_dead_loads(1.0);
        stir(e.assembly);
        if (setup.test.kind != methods::uniaxial_compression) mix_contacts(e.assembly);  // there a mixed specimen would fly apart
        settings = e.settings;
        settings.speed = 1e-8;
    }
    /// Goes on by `calls` calls of `count` steps. @return the work of the loading, J
    double go_on(int calls, int count) {
        PlatenWork work;
        for (int i = 0; i < calls; ++i) advance(e.assembly, e.team, settings, i * count, count, work);
        return work.loading;
    }
    /// The state after that by a device; this one stays.
    Assembly after(StepDevice& device, int calls, int count, double& loading_J) {
        Assembly assembly = e.assembly;
        PlatenWork work;
        settings.device = &device;
        for (int i = 0; i < calls; ++i) advance(assembly, e.team, settings, i * count, count, work);
        loading_J = work.loading;
        return assembly;
    }
};

}  // namespace feldspar
