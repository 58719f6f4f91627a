// Vibrating bars, and the largest step that is stable.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "feldspar/base/rng.hpp"
#include "feldspar/lab/stability.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/verify/bodies.hpp"
#include "feldspar/verify/topics.hpp"

namespace feldspar {
namespace {

using namespace bodies;

constexpr double kHeight = 0.04, kDensity = 2650.0, pi = std::numbers::pi;

StepSettings elastic_steps(Assembly& assembly, Team& team) {
    StepSettings settings;
    settings.dt = 0.8 * 2.0 / std::sqrt(largest_omega2(assembly, team));
    settings.strength = Strength::unlimited;
    return settings;
}

double nothing() { return std::numeric_limits<double>::quiet_NaN(); }

// Fixed below, free above.
std::vector<CheckedValue> fixed_bar() {
    const auto specimen = make(rectangle(0.02, kHeight));
    Assembly assembly = assemble(*specimen, ModelSpec{}, granite(), table7());
    attach(assembly, *specimen, platen_rows(*specimen));
    for (const int node : assembly.fixtures[0].nodes) assembly.nodes.inverse_mass[node].y = 1.0;  // let the top go
    set_real_masses(assembly);
    Team team(1);
    const StepSettings settings = elastic_steps(assembly, team);
    for (int n = 0; n < assembly.nodes.count(); ++n)
        assembly.nodes.velocity[n].y = 1e-6 * std::sin(0.5 * pi * assembly.nodes.reference[n].y / kHeight);
    for (const int node : assembly.fixtures[1].nodes) assembly.nodes.velocity[node] = {};
    const auto mean_top = [&] {
        double sum = 0.0;
        for (const int node : assembly.fixtures[0].nodes) sum += assembly.nodes.displacement[node].y;
        return sum;
    };
    const double expected = 2.0 * kHeight / std::sqrt(24.3e9 / kDensity);
    return {{"", 1e6 * expected, 1e6 * half_period(assembly, team, settings, mean_top).value_or(nothing())}};
}

// A free bar, struck along its axis.
std::vector<CheckedValue> free_bars() {
    std::vector<CheckedValue> compared;
    for (const GrainKind grains : {GrainKind::rigid, GrainKind::inner_particles}) {
        const TestSetup given = setup(rectangle(0.02, kHeight), methods::uniaxial_compression, model(grains));
        Started s(given);
        const Reactions r = reactions(s.e.assembly);
        const double E = s.e.stress(0.5 * (r.loading + r.rest)) / s.e.gauge.axial(s.e.assembly);
        Assembly assembly = assemble(*given.specimen, given.model, given.grain, given.contact);
        set_real_masses(assembly);
        Team team(1);
        const StepSettings settings = elastic_steps(assembly, team);
        const auto shape = [&](const Body& body) {
            return std::cos(pi * assembly.nodes.reference[body.centre_node].y / kHeight);
        };
        for (const Body& body : assembly.bodies) assembly.nodes.velocity[body.centre_node].y = 1e-6 * shape(body);
        const auto amplitude = [&] {
            double sum = 0.0;
            for (const Body& body : assembly.bodies)
                sum += assembly.nodes.mass[body.centre_node] * shape(body) * assembly.nodes.displacement[body.centre_node].y;
            return sum;
        };
        compared.push_back({name(grains), 1e6 * kHeight / std::sqrt(E / kDensity),
                            1e6 * half_period(assembly, team, settings, amplitude).value_or(nothing())});
    }
    return compared;
}

// All stiffness of two rigid grains lies in one direction, where the bound behind the masses is exact.
std::vector<CheckedValue> margin() {
    std::vector<CheckedValue> compared;
    for (const NumericsKind kind : {NumericsKind::adaptive, NumericsKind::paper}) {
        TestSetup s = setup(two_grain_bar(0.003), methods::direct_tension);
        s.model = model(GrainKind::rigid, ContactKind::point);
        s.contact = table1(GrainKind::rigid);
        s.test.stop_fraction = -1.0;
        s.numerics.kind = kind;
        const TestPreview preview = preview_test(s, {});
        compared.push_back({name(kind), 0.99, preview.omega2 / preview.omega2_limit});
    }
    return compared;
}

// Largest velocity after free vibration from a tiny disturbance, as a power of ten over the largest before.
double growth(Assembly assembly, int steps) {
    Team team(1);
    RandomStream random(5, "disturbance");
    for (Vec2& v : assembly.nodes.velocity) v = {1e-15 * random.normal(), 1e-15 * random.normal()};
    StepSettings settings;
    settings.damping = Damping::viscous;
    settings.strength = Strength::unlimited;
    PlatenWork work;
    advance(assembly, team, settings, 0, steps, work);
    double largest = 0.0;
    for (const Vec2 v : assembly.nodes.velocity) largest = std::isfinite(norm(v)) ? std::max(largest, norm(v)) : HUGE_VAL;
    return std::log10(std::min(largest / 5e-15, 1e300));
}

// Mass at which motion begins to grow over that at which the largest omega^2 dt^2 is 4.
std::vector<CheckedValue> limit() {
    Assembly assembly = assemble(*make(rectangle(0.014, 0.028)), ModelSpec{}, granite(), table7());
    Team team(1);
    set_scaled_masses(assembly, MassBound::tensor, 1.0);
    const double exact = largest_omega2(assembly, team) / 4.0;
    double low = 0.95, high = 1.05;  // grows; does not
    for (int i = 0; i < 5; ++i) {
        const double middle = 0.5 * (low + high);
        set_scaled_masses(assembly, MassBound::tensor, exact * middle);
        (growth(assembly, 1500) > 4.0 ? low : high) = middle;
    }
    return {{"", 1.0, 0.5 * (low + high)}};
}

}  // namespace

std::vector<Check> wave_checks() {
    return {
        {.name = "waves.fixed-bar",
         .sentence = "A bar that is fixed below and free above rings with a quarter of a wave; half its period.",
         .formula = "T / 2 = 2 H / sqrt(E / rho)",
         .source = "(M4); wave equation of a bar",
         .unit = "us",
         .bound = relative(3e-2),
         .reason = "the small bar's own E differs by 2 % from the large specimen's that is put in",
         .compare = fixed_bar},
        {.name = "waves.free-bar",
         .sentence = "A free bar of rigid grains or inner particles rings with half a wave; half its period.",
         .formula = "T / 2 = H / sqrt(E / rho)",
         .source = "wave equation of a bar",
         .unit = "us",
         .bound = relative(3e-2),
         .reason = "lateral inertia, 0.5 %, and E, which is measured in the middle half of the bar",
         .compare = free_bars},
        {.name = "stability.limit",
         .sentence = "Motion grows where the largest frequency passes the limit of central differences, and not before; mass "
                     "over that of the limit.",
         .formula = "omega^2 dt^2 = 4",
         .source = "(M1); central differences",
         .bound = absolute(1e-2),
         .reason = "1500 steps see growth from half a per cent beyond the limit on",
         .compare = limit},
        {.name = "stability.margin",
         .sentence = "The masses of a body whose stiffness is known exactly leave the margin that is meant.",
         .formula = "omega^2 dt^2 / limit = 0.99",
         .source = "docs/theory/motion-and-mass.md",
         .bound = absolute(1e-6),
         .reason = "the iteration of the largest frequency",
         .compare = margin},
    };
}

}  // namespace feldspar
