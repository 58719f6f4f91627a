// A bar of two grains pulled apart, flexible and rigid: every number is known beforehand.
#include <algorithm>
#include <cmath>

#include "feldspar/model/assemble.hpp"
#include "feldspar/verify/bodies.hpp"
#include "feldspar/verify/topics.hpp"

namespace feldspar {
namespace {

using namespace bodies;

constexpr double kSide = 0.003, kArea = kSide * 0.08;

TestSetup bar(MethodId kind) {
    TestSetup s = setup(two_grain_bar(kSide), kind);
    s.grain.nu = 0.0;  // the ends slide freely, so the bar is in uniaxial stress for any nu; 0 makes it homogeneous too
    s.test.stop_fraction = -1.0;  // to the end of the envelope and beyond
    s.test.maximum_strain = 0.0025;
    s.numerics.residual_target = 2e-4;
    return s;
}

const TestResult& pulled() {
    static const TestResult result = run_test(bar(methods::direct_tension), {});
    return result;
}

const TestResult& pulled_at_one_point() {
    static const TestResult result = [] {
        TestSetup s = bar(methods::direct_tension);
        s.model.contact = ContactKind::point;
        return run_test(s, {});
    }();
    return result;
}

std::vector<CheckedValue> stiffness() {
    const TestSetup s = bar(methods::direct_tension);
    for (const HistoryRow& row : pulled().history)
        if (row.phase == Phase::elastic && row.platen_displacement_m != 0.0)
            return {{"", 1e-12 / (2.0 * kSide / s.grain.E_Pa + 1.0 / s.contact.Kn_Pa_m),
                     1e-12 * row.axial_stress_Pa / row.platen_displacement_m}};
    return {};
}

std::vector<CheckedValue> strengths() {
    TestSetup brittle = bar(methods::direct_tension);
    brittle.contact.law = ContactLaw::brittle;
    return {{"three points", 8.5, 1e-6 * pulled().properties.peak_stress_Pa},
            {"one point", 8.5, 1e-6 * pulled_at_one_point().properties.peak_stress_Pa},
            {"three points, brittle", 8.5, 1e-6 * run_test(brittle, {}).properties.peak_stress_Pa}};
}

std::vector<CheckedValue> energies() {
    const EnergyLedger &three = pulled().energy_at_end, &one = pulled_at_one_point().energy_at_end;
    return {{"three points, work", 20.0, three.supplied() / kArea},
            {"three points, fracture", 20.0, three.fracture / kArea},
            {"one point, work", 20.0, one.supplied() / kArea},
            {"one point, fracture", 20.0, one.fracture / kArea}};
}

std::vector<CheckedValue> compression() {
    TestSetup s = bar(methods::uniaxial_compression);
    s.numerics.kind = NumericsKind::paper;
    s.numerics.speed_m = 3e-10;  // many travel times of a wave over 6 mm
    s.test.maximum_strain = 0.0001;
    const TestResult r = run_test(s, {});
    return {{"", 1e-9 / (1.0 / s.grain.E_Pa + 1.0 / s.contact.Kn_Pa_m / (2.0 * kSide)),
             1e-9 * r.history.back().axial_stress_Pa / r.history.back().axial_strain}};
}

struct Torn {
    double work_J_m2 = 0.0, fracture_J_m2 = 0.0, peak_MPa = 0.0;
};

// The upper of two rigid grains moves in equal steps, along the normal or across it, and the contact tears.
Torn tear(ContactKind kind, bool shear) {
    Assembly assembly = assemble(*two_grain_bar(kSide), model(GrainKind::rigid, kind), granite(), table1(GrainKind::rigid));
    const int centre = assembly.bodies[1].centre_node;
    constexpr int kSteps = 300000;
    const double travel_m = shear ? 4e-4 : 4e-5;  // x_f = 3.0e-4 m, whose way turns the normal by a tenth, and 2.7e-5 m
    Torn torn;
    Vec2 before{};
    for (int k = 0; k < kSteps; ++k) {
        const Vec2 n = contact_frame(assembly, assembly.contacts[0]).n, move = (travel_m / kSteps) * (shear ? rot90(n) : n);
        assembly.nodes.velocity[centre] = move;
        assembly.nodes.displacement[centre] += move;
        contact_forces(assembly, {0, 1}, StepSettings{}, k);
        const Vec2 force = assembly.slots[1].force;
        torn.work_J_m2 -= 0.5 * dot(before + force, move) / kArea;
        torn.peak_MPa = std::max(torn.peak_MPa, 1e-6 * norm(force) / kArea);
        before = force;
    }
    for (int p = 0; p < std::ssize(assembly.points); ++p) torn.fracture_J_m2 += assembly.bond(p).fracture_J / kArea;
    return torn;
}

const Torn& torn(ContactKind kind, bool shear) {
    static const Torn all[2][2] = {{tear(ContactKind::point, false), tear(ContactKind::point, true)},
                                   {tear(ContactKind::lobatto3, false), tear(ContactKind::lobatto3, true)}};
    return all[kind == ContactKind::lobatto3 ? 1 : 0][shear ? 1 : 0];
}

std::vector<CheckedValue> torn_energies() {
    std::vector<CheckedValue> compared;
    for (const ContactKind kind : {ContactKind::lobatto3, ContactKind::point})
        for (const bool shear : {false, true}) {
            const std::string what = std::string(name(kind)) + (shear ? ", sheared off" : ", torn apart");
            const double expected = shear ? 2078.6 : 66.1;
            compared.push_back({what + ", work", expected, torn(kind, shear).work_J_m2});
            compared.push_back({what + ", fracture", expected, torn(kind, shear).fracture_J_m2});
        }
    return compared;
}

std::vector<CheckedValue> torn_strengths() {
    std::vector<CheckedValue> compared;
    for (const ContactKind kind : {ContactKind::lobatto3, ContactKind::point})
        for (const bool shear : {false, true})
            compared.push_back({std::string(name(kind)) + (shear ? ", sheared off" : ", torn apart"), shear ? 33.25 : 11.5,
                                torn(kind, shear).peak_MPa});
    return compared;
}

TestSetup rigid_bar(MethodId kind, ContactKind contact) {
    TestSetup s = setup(two_grain_bar(kSide), kind);
    s.model = model(GrainKind::rigid, contact);
    s.contact = table1(GrainKind::rigid);
    s.test.stop_fraction = -1.0;
    s.test.maximum_strain = 0.006;  // 3.6e-5 m, beyond x_f = 2.7e-5 m
    s.numerics.residual_target = 2e-4;
    return s;
}

// One point knows no turning, and tears for the whole fracture energy.
const TestResult& rigid_pulled() {
    static const TestResult result = run_test(rigid_bar(methods::direct_tension, ContactKind::point), {});
    return result;
}

std::vector<CheckedValue> contacts_in_series() {
    const double expected = 1e-12 * 1.08e13 / 3.0;
    for (const HistoryRow& row : rigid_pulled().history)
        if (row.phase == Phase::elastic && row.platen_displacement_m != 0.0)
            return {{"", expected, 1e-12 * row.axial_stress_Pa / row.platen_displacement_m}};
    return {};
}

std::vector<CheckedValue> pressed_in_series() {
    TestSetup s = rigid_bar(methods::uniaxial_compression, ContactKind::lobatto3);
    s.numerics.kind = NumericsKind::paper;
    s.numerics.speed_m = 3e-10;  // many travel times of a wave over 6 mm
    s.test.maximum_strain = 0.0001;
    const HistoryRow end = run_test(s, {}).history.back();
    return {{"", 1e-12 * 1.08e13 / 3.0, 1e-12 * end.axial_stress_Pa / end.platen_displacement_m}};
}

}  // namespace

std::vector<Check> two_grain_checks() {
    return {
        {.name = "two-grains.stiffness",
         .sentence = "A bar of two flexible grains is as stiff as its grains and its contact in series.",
         .formula = "K = 1 / (H / E + 1 / Kn)",
         .source = "(C7); springs in series",
         .unit = "MPa/um",
         .bound = relative(5e-3),
         .reason = "what the elastic start leaves moving",
         .compare = stiffness,
         .run = "two-grains"},
        {.name = "two-grains.strength",
         .sentence = "Pulled apart a bar of two flexible grains bears the tensile strength of its contact.",
         .formula = "max sigma = sigma_nt",
         .source = "(C8); Table 7 of the paper",
         .unit = "MPa",
         .bound = relative(5e-3),
         .reason = "the accuracy of the test",
         .compare = strengths,
         .run = "two-grains"},
        {.name = "two-grains.fracture-energy",
         .sentence = "Pulling a bar of two flexible grains apart takes the fracture energy of its contact.",
         .formula = "W / A = Gf",
         .source = "(C10), (C11); Table 7 of the paper",
         .unit = "J/m2",
         .bound = relative(5e-3),
         .reason = "the accuracy of the test",
         .compare = energies,
         .run = "two-grains"},
        {.name = "two-grains.compression",
         .sentence = "A bar of two flexible grains is pressed with the same stiffness as it is pulled.",
         .formula = "E = 1 / (1 / E_grain + 1 / (Kn H))",
         .source = "(C7); springs in series",
         .unit = "GPa",
         .bound = relative(1e-2),
         .reason = "waves that are left at the speed of the paper's numerics",
         .compare = compression},
        {.name = "two-grains.rigid-stiffness",
         .sentence = "Two rigid grains between plates have three contacts in series.",
         .formula = "K = Kn / 3",
         .source = "(C7), (C19); springs in series",
         .unit = "MPa/um",
         .bound = relative(1e-3),
         .reason = "what the elastic start leaves moving",
         .compare = contacts_in_series,
         .run = "two-rigid-grains"},
        {.name = "two-grains.rigid-compression",
         .sentence = "They are pressed with the same stiffness as they are pulled.",
         .formula = "K = Kn / 3",
         .source = "(C7), (C19); springs in series",
         .unit = "MPa/um",
         .bound = relative(1e-2),
         .reason = "waves that are left at the speed of the paper's numerics",
         .compare = pressed_in_series},
        {.name = "two-grains.rigid-strength-and-energy",
         .sentence =
             "Between plates two rigid grains are torn at the strength of their contact, for its fracture energy; over these.",
         .formula = "max sigma / sigma_nt = W / (Gf A) = 1",
         .source = "(C8), (C10); Table 1 of the paper",
         .bound = relative(5e-3),
         .reason = "the accuracy of the test",
         .compare =
             [] {
                 const TestResult& r = rigid_pulled();
                 return std::vector<CheckedValue>{{"strength", 1.0, 1e-6 * r.properties.peak_stress_Pa / 11.5},
                                                  {"work", 1.0, r.energy_at_end.supplied() / (66.1 * kArea)},
                                                  {"fracture", 1.0, r.energy_at_end.fracture / (66.1 * kArea)}};
             },
         .run = "two-rigid-grains"},
        {.name = "two-grains.torn-energy",
         .sentence = "Tearing one rigid grain off another takes the fracture energy of their contact, in tension and in shear.",
         .formula = "W / A = Gf",
         .source = "(C10), (C11); Table 1 of the paper",
         .unit = "J/m2",
         .bound = relative(1e-3),
         .reason = "the steps of the tearing",
         .compare = torn_energies,
         .run = "torn-grains"},
        {.name = "two-grains.torn-strength",
         .sentence = "One rigid grain is torn off another at the strength of their contact, in tension and in shear.",
         .formula = "max F / A = sigma_nt, tau",
         .source = "(C8); Table 1 of the paper",
         .unit = "MPa",
         .bound = relative(1e-4),
         .reason = "the steps of the tearing",
         .compare = torn_strengths,
         .run = "torn-grains"},
    };
}

}  // namespace feldspar
