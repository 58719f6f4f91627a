// Bodies that checks and tests share: the Augig granite's materials, small specimens, a bar of two grains, the kinds of grains.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "feldspar/lab/experiment.hpp"
#include "feldspar/lab/run_test.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/model/fixtures.hpp"
#include "feldspar/model/heterogeneity_spec.hpp"
#include "feldspar/specimen/fill_grains.hpp"
#include "feldspar/specimen/mesh_grains.hpp"
#include "feldspar/specimen/specimen.hpp"
#include "feldspar/step/step.hpp"
#include "feldspar/verify/table7.hpp"

namespace feldspar::bodies {

inline GrainMaterial granite() { return {25.8e9, 0.23, 2650.0}; }

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

/// Two grains of width h, one on top of the other: a square, and one of height `upper_m` (a square unless given).
inline std::shared_ptr<const Specimen> two_grain_bar(double h_m, double upper_m = 0.0, double particles_per_grain = 0.0) {
    if (upper_m == 0.0) upper_m = h_m;
    const double H = h_m + upper_m;
    Specimen s;
    s.spec = rectangle(h_m, H);
    s.outline.vertices = {{0, 0}, {h_m, 0}, {h_m, H}, {0, H}};
    s.outline.edge_labels = {"bottom", "right", "top", "left"};
    s.outline.area_m2 = h_m * H;
    s.packing.centres = {{0.5 * h_m, 0.5 * h_m}, {0.5 * h_m, h_m + 0.5 * upper_m}};
    s.packing.radii_m = {0.5 * h_m, 0.5 * upper_m};
    s.cells.vertices = {{0, 0}, {h_m, 0}, {h_m, h_m}, {0, h_m}, {h_m, H}, {0, H}};
    s.cells.cells = {{{0, 1, 2, 3}, {-1, -1, 1, -1}, {0, 1, -1, 3}}, {{3, 2, 4, 5}, {0, -1, -1, -1}, {-1, 1, 2, 3}}};
    s.mesh = mesh_grains(s.cells, 0);
    s.spec.particles_per_grain = particles_per_grain;
    if (particles_per_grain > 0.0) s.filling = fill_grains(s.cells, particles_per_grain, 1);
    return std::make_shared<const Specimen>(std::move(s));
}

inline TestSetup setup(std::shared_ptr<const Specimen> specimen, MethodId kind) {
    TestSetup s;
    s.specimen = std::move(specimen);
    s.grain = granite();
    s.contact = table7();
    s.test.kind = kind;
    return s;
}

/// The platens and sides of a compressed specimen of flexible grains. @param sigma3_Pa  on its sides; 0: none
inline std::vector<FixtureSpec> platen_rows(const Specimen& specimen, double sigma3_Pa = 0.0) {
    TestSpec test;
    test.kind = methods::biaxial;
    test.sigma3_Pa = sigma3_Pa;
    const ContactMaterial contact = table7();
    return method_of(test).build.fixtures({specimen, ModelSpec{}, granite(), contact, test});
}

/// Plates at both ends that touch like this.
inline std::vector<FixtureSpec> end_plates(const PlateContact& contact) {
    std::vector<FixtureSpec> plates(2);
    for (const bool top : {true, false}) {
        FixtureSpec& plate = plates[top ? 0 : 1];
        plate.name = plate.part.label = top ? "top" : "bottom";
        plate.kind = FixtureKind::plate;
        plate.normal = {0.0, top ? 1.0 : -1.0};
        plate.motion = {0.0, top ? -1.0 : 0.0};
        plate.contact = contact;
    }
    return plates;
}

/// Tables 1 and 2 of the paper: what rigid grains and inner particles have.
inline ContactMaterial table1(GrainKind grains, ContactLaw law = ContactLaw::bilinear) {
    ContactMaterial c;
    c.law = law;
    c.Kn_Pa_m = grains == GrainKind::rigid ? 1.08e13 : 4.9e13;
    c.eta = grains == GrainKind::rigid ? 0.28 : 0.30;
    const bool brittle = law == ContactLaw::brittle;
    c.sigma_nt_Pa = brittle ? 13.7e6 : 11.5e6;
    c.tau_Pa = brittle ? 48.8e6 : 33.25e6;
    c.mu = brittle ? 0.4 : 0.5;
    c.Gfn_J_m2 = 66.1;
    c.Gfs_J_m2 = 2078.6;
    return c;
}

inline ModelSpec model(GrainKind grains, ContactKind contact = ContactKind::lobatto3,
                       ContactNormal normal = ContactNormal::centres) {
    ModelSpec m;
    m.kind = grains;
    m.contact = grains == GrainKind::inner_particles ? ContactKind::point : contact;
    m.normal = normal;
    return m;
}

/// Every model whose bodies are rigid.
inline std::vector<ModelSpec> rigid_models() {
    return {model(GrainKind::rigid), model(GrainKind::rigid, ContactKind::point), model(GrainKind::inner_particles),
            model(GrainKind::inner_particles, ContactKind::point, ContactNormal::edge)};
}

inline ContactMaterial material(const ModelSpec& m, ContactLaw law = ContactLaw::bilinear) {
    return m.kind == GrainKind::flexible ? table7() : table1(m.kind, law);
}

/// With what the model needs: grains of inner particles are filled, about as the paper's.
inline SpecimenSpec filled_for(const ModelSpec& m, SpecimenSpec spec) {
    if (m.kind == GrainKind::inner_particles) spec.particles_per_grain = 26.36;
    return spec;
}

inline TestSetup setup(const SpecimenSpec& spec, MethodId kind, const ModelSpec& m, ContactLaw law = ContactLaw::bilinear,
                       std::uint64_t seed = 1) {
    TestSetup s = setup(make(filled_for(m, spec), seed), kind);
    s.model = m;
    s.contact = material(m, law);
    return s;
}

/// A specimen with a cut through its middle that rises by this angle, which a joint named "plane" may take.
inline SpecimenSpec with_joint(double width_m, double height_m, double dip_deg) {
    SpecimenSpec spec = rectangle(width_m, height_m);
    const double dip = dip_deg * std::numbers::pi / 180.0,
                 reach = 0.51 * std::min(width_m / std::cos(dip), height_m / std::max(std::sin(dip), 1e-9));
    const Vec2 centre{0.5 * width_m, 0.5 * height_m}, along{std::cos(dip), std::sin(dip)};
    spec.outline.notches = {{centre - reach * along, centre + reach * along, 0.0, "plane", true}};
    return spec;
}

/// The joint on that cut. @param tau_Pa  cohesion
inline JointSpec smooth_joint(const ContactMaterial& rock, double mu, double tau_Pa, double sigma_nt_Pa) {
    JointSpec joint;
    joint.name = "plane";
    joint.cut = "plane";
    joint.contact = rock;
    joint.contact.mu = mu;
    joint.contact.tau_Pa = tau_Pa;
    joint.contact.sigma_nt_Pa = sigma_nt_Pa;
    joint.contact.Gfn_J_m2 = 1.0;
    joint.contact.Gfs_J_m2 = 30.0;
    return joint;
}

/// Steps a vibrating body until `amplitude()` has changed its sign five times. @return the mean time between two of these
/// changes, half a period, with each placed between its two steps; nothing if it does not vibrate
template <class Amplitude>
std::optional<double> half_period(Assembly& assembly, Team& team, const StepSettings& settings, Amplitude amplitude) {
    PlatenWork work;
    double before = 0.0, first = 0.0, last = 0.0;
    int crossings = 0;
    for (int k = 0; crossings < 5 && k < 100000; ++k) {
        advance(assembly, team, settings, k, 1, work);
        const double now = amplitude();
        if (k > 0 && (before < 0.0) != (now < 0.0)) {
            last = (k + now / (before - now)) * settings.dt;
            if (crossings++ == 0) first = last;
        }
        before = now;
    }
    if (crossings < 5) return std::nullopt;
    return (last - first) / 4.0;
}

/// A test whose body is at the beginning of the loading: behind its elastic start.
struct Started {
    TestSetup setup;
    RunControl control;
    Experiment e;

    /// @throws InputError for an unstable setting
    explicit Started(TestSetup given) : setup(std::move(given)), control(), e(setup, control) {
        choose_step(e);
        prepare(e);
    }
};

/// Turns all rigid bodies about the origin to `angle` as a step would: displacements, arcs, and the velocities that lead there.
inline void turn_to(Assembly& assembly, double angle) {
    Nodes& nodes = assembly.nodes;
    for (const Body& body : assembly.bodies) {
        const int centre = body.centre_node, turn = centre + 1;
        const Vec2 X = nodes.reference[centre];
        const Vec2 after = turned(X, angle) - X, arc = {angle * body.radius_m, 0.0};
        nodes.velocity[centre] = after - nodes.displacement[centre];
        nodes.velocity[turn] = arc - nodes.displacement[turn];
        nodes.displacement[centre] = after;
        nodes.displacement[turn] = arc;
    }
}

/// Largest opening and sliding when rigid bodies turn by 0.3 rad as a whole.
inline Vec2 gaps_of_a_rotation(Assembly assembly, int steps) {
    for (int k = 1; k <= steps; ++k) {
        turn_to(assembly, 0.3 * k / steps);
        contact_forces(assembly, {0, static_cast<int>(assembly.contacts.size())}, StepSettings{}, k);
    }
    Vec2 largest;
    for (const ContactPoint& point : assembly.points) {
        largest.x = std::max(largest.x, std::abs(assembly.bonds.at(point.state).un_m));
        largest.y = std::max(largest.y, std::abs(assembly.bonds.at(point.state).us_m));
    }
    return largest;
}

/// A smooth joint in direct shear under 2 MPa, or behind a spring from there on. @param limit_m  0: it does not dilate
inline TestResult sheared_joint(GrainKind grains, double mu, double tan_psi, double limit_m, double stiffness_Pa_m,
                                double strain) {
    TestSetup s = setup(with_joint(0.04, 0.02, 0.0), methods::direct_shear, model(grains));
    s.test = usual_test(methods::direct_shear);
    JointSpec joint = smooth_joint(s.contact, mu, 0.0, 0.0);
    if (limit_m > 0.0) {
        joint.dilation = tan_psi;
        joint.dilation_slip_m = limit_m;
    }
    s.rock.joints = {joint};
    s.test.sigma3_Pa = 2e6;
    s.test.maximum_strain = strain;
    s.test.stop_fraction = 0.5;
    if (stiffness_Pa_m > 0.0) s.test.own["normal_stiffness"] = {stiffness_Pa_m};
    return run_test(s, {});
}

}  // namespace feldspar::bodies
