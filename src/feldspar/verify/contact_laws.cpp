// One point of a contact: pulled, sheared, pressed.
#include <algorithm>
#include <cmath>

#include "feldspar/laws/bond.hpp"
#include "feldspar/verify/table7.hpp"
#include "feldspar/verify/topics.hpp"

namespace feldspar {
namespace {

constexpr double kArea = 8e-5;
constexpr ContactLaw kLaws[] = {ContactLaw::bilinear, ContactLaw::bilinear_literal, ContactLaw::linear, ContactLaw::brittle};

ContactMaterial material(ContactLaw law) {
    ContactMaterial m = bodies::table7();
    m.law = law;
    return m;
}

struct Pulled {
    double work_J_m2 = 0.0;  // done on the point, over its area
    double peak_Pa = 0.0;
};

// Opens (or shears) a point to `reach` in equal steps.
Pulled pull(const ContactMaterial& m, double reach_m, bool shear, int steps) {
    const BondLaw law = BondLaw::make(m);
    BondState state;
    Pulled p;
    const double dx = reach_m / steps;
    for (int k = 0; k < steps; ++k) {
        const double before = shear ? state.Fs_N : state.Fn_N;
        update_bond(law, kArea, shear ? 0.0 : dx, shear ? dx : 0.0, state);
        const double after = shear ? state.Fs_N : state.Fn_N;
        p.work_J_m2 -= 0.5 * (before + after) * dx / kArea;
        p.peak_Pa = std::max(p.peak_Pa, -after / kArea);
    }
    return p;
}

// The brittle law only releases what it stored; the literal one has more than its fracture energy.
double expected_work_J_m2(ContactLaw law, double strength, double stiffness, double Gf) {
    const double x0 = strength / stiffness, x_fl = 2.0 * Gf / strength;
    if (law == ContactLaw::brittle) return 0.5 * strength * x0;
    if (law == ContactLaw::bilinear_literal) return Gf * (1.0 + 0.25 * (1.0 - x0 / x_fl));
    return Gf;
}

std::vector<CheckedValue> works(bool shear, bool brittle) {
    std::vector<CheckedValue> compared;
    for (const ContactLaw law : kLaws) {
        if ((law == ContactLaw::brittle) != brittle) continue;
        const ContactMaterial m = material(law);
        const double expected = shear ? expected_work_J_m2(law, m.tau_Pa, m.eta * m.Kn_Pa_m, m.Gfs_J_m2)
                                      : expected_work_J_m2(law, m.sigma_nt_Pa, m.Kn_Pa_m, m.Gfn_J_m2);
        compared.push_back({name(law), expected, pull(m, shear ? 2e-4 : 2e-5, shear, 40000).work_J_m2});
    }
    return compared;
}

std::vector<CheckedValue> peaks(bool shear) {
    std::vector<CheckedValue> compared;
    for (const ContactLaw law : kLaws) {
        const ContactMaterial m = material(law);
        compared.push_back(
            {name(law), 1e-6 * (shear ? m.tau_Pa : m.sigma_nt_Pa), 1e-6 * pull(m, shear ? 1e-6 : 1e-7, shear, 100000).peak_Pa});
    }
    return compared;
}

// (C9): half of 0.75 from each direction.
std::vector<CheckedValue> damage_of_both_directions() {
    const BondLaw law = BondLaw::make(material(ContactLaw::bilinear));
    BondState s;
    const double un = 0.5 * (law.normal.x0 + law.normal.x_y), us = 0.5 * (law.shear.x0 + law.shear.x_y);
    for (int k = 0; k < 1000; ++k) update_bond(law, kArea, 1e-3 * un, 0.0, s);
    const double pulled = s.damage;
    for (int k = 0; k < 1000; ++k) update_bond(law, kArea, 0.0, 1e-3 * us, s);
    return {{"pulled", 0.375, pulled}, {"and sheared", 0.75, s.damage}};
}

std::vector<CheckedValue> break_points() {
    std::vector<CheckedValue> compared;
    for (const ContactLaw law : {ContactLaw::bilinear, ContactLaw::bilinear_literal, ContactLaw::linear}) {
        const SofteningEnvelope e = SofteningEnvelope::make(law, 8.5e6, 18e13, 20.0);
        compared.push_back({std::string(name(law)) + ", break point", 0.75, e.damage(e.x_y)});
        compared.push_back({std::string(name(law)) + ", end", 1.0, e.damage(e.x_f)});
    }
    return compared;
}

constexpr double kPressure = 54e6;

std::vector<CheckedValue> brittle_strength_under_pressure() {
    const ContactMaterial m = material(ContactLaw::brittle);
    const BondLaw law = BondLaw::make(m);
    const double limit = m.tau_Pa + m.mu * kPressure, dus = 1e-4 * limit / law.Ks_Pa_m;  // 10000 steps to the limit
    BondState s;
    update_bond(law, kArea, -kPressure / law.Kn_Pa_m, 0.0, s);
    double largest = 0.0;
    for (int k = 0; k < 10100; ++k)
        if (update_bond(law, kArea, 0.0, dus, s) == BondEvent::none && s.damage < 1.0)
            largest = std::max(largest, std::abs(s.Fs_N) / kArea);
    return {{"before it breaks", 1e-6 * limit, 1e-6 * largest},
            {"after", 1e-6 * m.mu * kPressure, 1e-6 * std::abs(s.Fs_N) / kArea}};
}

std::vector<CheckedValue> friction_and_fracture(bool fracture) {
    std::vector<CheckedValue> compared;
    for (const ContactLaw law_name : kLaws) {
        const ContactMaterial m = material(law_name);
        const BondLaw law = BondLaw::make(m);
        const double ks = law.Ks_Pa_m * kArea, reach = 2e-4;
        constexpr int kSteps = 40000;
        BondState s;
        update_bond(law, kArea, -kPressure / law.Kn_Pa_m, 0.0, s);
        double work = 0.0;
        for (int k = 0; k < kSteps; ++k) {
            const double before = s.Fs_N;
            update_bond(law, kArea, 0.0, reach / kSteps, s);
            work -= 0.5 * (before + s.Fs_N) * reach / kSteps;
        }
        const double force = m.mu * kPressure * kArea;
        // The brittle law loses its cohesion within the step after which it is broken, so that under pressure this loss is
        // friction by (C16).
        double friction = force * (reach - force / ks);
        if (law_name == ContactLaw::brittle) friction += 0.5 * m.tau_Pa * m.tau_Pa * kArea / law.Ks_Pa_m;
        if (!fracture)
            compared.push_back({name(law_name), 1.0, s.friction_J / friction});
        else
            compared.push_back({name(law_name), (work - 0.5 * force * force / ks - friction) / work, s.fracture_J / work});
    }
    return compared;
}

std::vector<CheckedValue> unloading_slopes() {
    std::vector<CheckedValue> compared;
    for (const TensionUnloading option : {TensionUnloading::elastic, TensionUnloading::secant}) {
        ContactMaterial m = material(ContactLaw::bilinear);
        m.tension_unloading = option;
        const BondLaw law = BondLaw::make(m);
        BondState s;
        for (int k = 0; k < 1000; ++k) update_bond(law, kArea, 1e-9, 0.0, s);  // well into softening
        const double force = s.Fn_N, opening = s.un_m;
        update_bond(law, kArea, -1e-9, 0.0, s);
        const double expected = option == TensionUnloading::elastic ? law.Kn_Pa_m : -force / kArea / opening;
        compared.push_back({option == TensionUnloading::elastic ? "elastic" : "secant", 1e-12 * expected,
                            1e-12 * (s.Fn_N - force) / 1e-9 / kArea});
    }
    return compared;
}

std::vector<CheckedValue> broken_point() {
    std::vector<CheckedValue> compared;
    const BondLaw law = BondLaw::make(material(ContactLaw::bilinear));
    BondState s;
    s.damage = 1.0;
    update_bond(law, kArea, -1e-8, 0.0, s);
    compared.push_back({"pressed", 1e-3 * law.Kn_Pa_m * kArea * 1e-8, 1e-3 * s.Fn_N});
    update_bond(law, kArea, 0.0, 1e-6, s);
    compared.push_back({"sheared", 1e-3 * -law.mu * law.Kn_Pa_m * kArea * 1e-8, 1e-3 * s.Fs_N});
    update_bond(law, kArea, 2e-8, 0.0, s);
    compared.push_back({"open", 0.0, 1e-3 * s.Fn_N});
    compared.push_back({"open, shear", 0.0, 1e-3 * s.Fs_N});
    return compared;
}

}  // namespace

std::vector<Check> contact_law_checks() {
    return {
        {.name = "laws.strength-in-tension",
         .sentence = "A point of a contact that is pulled bears its tensile strength and no more.",
         .formula = "max -Fn / A = sigma_nt",
         .source = "(C8); Table 7 of the paper",
         .unit = "MPa",
         .bound = relative(1e-4),
         .reason = "the steps of the pulling",
         .compare = [] { return peaks(false); }},
        {.name = "laws.strength-in-shear",
         .sentence = "A point of a contact that is sheared without pressure bears its cohesion and no more.",
         .formula = "max |Fs| / A = tau",
         .source = "(C8); Table 7 of the paper",
         .unit = "MPa",
         .bound = relative(1e-4),
         .reason = "the steps of the shearing",
         .compare = [] { return peaks(true); }},
        {.name = "laws.work-in-tension",
         .sentence = "Pulling a point apart takes the area under its envelope: the fracture energy, or as much more as the "
                     "literal reading has.",
         .formula = "W / A = Gf; literal: Gf (1 + 0.25 (1 - x0 / x_fl))",
         .source = "(C10), (C11)",
         .unit = "J/m2",
         .bound = relative(1e-3),
         .reason = "40000 steps cut the corners of the envelope by less than that",
         .compare = [] { return works(false, false); }},
        {.name = "laws.work-in-shear",
         .sentence = "Shearing a point off takes the area under its envelope.",
         .formula = "W / A = Gf; literal: Gf (1 + 0.25 (1 - x0 / x_fl))",
         .source = "(C10), (C11)",
         .unit = "J/m2",
         .bound = relative(1e-3),
         .reason = "40000 steps cut the corners of the envelope by less than that",
         .compare = [] { return works(true, false); }},
        {.name = "laws.work-of-a-brittle-point",
         .sentence = "A brittle point takes what it has stored at its strength.",
         .formula = "W / A = F^2 / (2 k)",
         .source = "(C10)",
         .unit = "J/m2",
         .bound = relative(2e-2),
         .reason = "the drop happens within one step, 1 % of the elastic limit, whose square counts",
         .compare =
             [] {
                 std::vector<CheckedValue> both = works(false, true);
                 for (const CheckedValue& c : works(true, true)) both.push_back(c);
                 both[0].what = "pulled";
                 both[1].what = "sheared";
                 return both;
             }},
        {.name = "laws.damage-adds-up",
         .sentence = "The damage of a point is the sum of those of opening and of sliding, not the larger of the two.",
         .formula = "D = Dn + Ds",
         .source = "(C9)",
         .bound = absolute(1e-9),
         .reason = "rounding of a thousand steps",
         .compare = damage_of_both_directions},
        {.name = "laws.break-point",
         .sentence = "At the break point of the envelope a quarter of the strength is left, and at its end nothing.",
         .formula = "D(x_y) = 0.75, D(x_f) = 1",
         .source = "(C9), (C11)",
         .bound = absolute(1e-12),
         .reason = "rounding",
         .compare = break_points},
        {.name = "laws.strength-under-pressure",
         .sentence = "A brittle point under pressure holds cohesion and friction, and friction alone once it is broken.",
         .formula = "|Fs| / A = tau + mu sigma_n, then mu sigma_n",
         .source = "(C8), (C13)",
         .unit = "MPa",
         .bound = relative(1.1e-4),
         .reason = "it breaks within the step that passes the limit, of which there are 10000",
         .compare = brittle_strength_under_pressure},
        {.name = "laws.friction-under-pressure",
         .sentence = "Of the work on a point that slides under pressure, friction takes the friction force times the sliding.",
         .formula = "friction = mu Fn (u - mu Fn / ks); given over itself",
         .source = "(C15), (C16)",
         .bound = relative(2e-3),
         .reason = "40000 steps through the envelope",
         .compare = [] { return friction_and_fracture(false); }},
        {.name = "laws.fracture-under-pressure",
         .sentence = "The rest of that work is fracture.",
         .formula = "fracture / W = 1 - (friction + stored) / W",
         .source = "(C14)-(C16)",
         .bound = absolute(1e-3),
         .reason = "40000 steps through the envelope",
         .compare = [] { return friction_and_fracture(true); }},
        {.name = "laws.unloading",
         .sentence = "A softened point unloads with the elastic slope, or by option towards the origin.",
         .formula = "dFn / (A du) = -Kn, or Fn / (A u)",
         .source = "(C12)",
         .unit = "GPa/mm",
         .bound = relative(1e-6),
         .reason = "rounding of forces over a step of 1 nm",
         .compare = unloading_slopes},
        {.name = "laws.broken-point",
         .sentence =
             "A broken point is Coulomb friction: it bears pressure and mu times that in shear, and nothing when it is open.",
         .formula = "Fn = Kn A max(-u, 0), |Fs| <= mu Fn",
         .source = "(C13)",
         .unit = "kN",
         .bound = absolute(1e-12),
         .reason = "rounding of 0.14 kN",
         .compare = broken_point},
    };
}

}  // namespace feldspar
