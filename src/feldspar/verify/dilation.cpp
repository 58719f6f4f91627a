// A broken joint that dilates, under a constant normal stress and behind a spring.
#include "feldspar/laws/dilation.hpp"

#include "feldspar/verify/table7.hpp"
#include "feldspar/verify/topics.hpp"

namespace feldspar {
namespace {

constexpr double kArea = 8e-5, kStress = 5e6, kMu = 0.5, kTanPsi = 0.2, kLimit = 1e-4;
constexpr Dilation kDilation{kTanPsi, kLimit};

struct Sheared {
    double opening_m = 0.0, shear_N = 0.0, normal_N = 0.0, work_J = 0.0, slip_m = 0.0, stored_J = 0.0;
    BondState state;
};

// A broken joint under a normal stress, sheared by `reach`. @param stiffness_Pa_m  of what presses it: 0, a constant stress
Sheared shear(double reach_m, double stiffness_Pa_m, int steps = 4000) {
    ContactMaterial m = bodies::table7();
    m.sigma_nt_Pa = m.tau_Pa = 0.0;
    m.mu = kMu;
    const BondLaw law = BondLaw::make(m);
    const double kn = law.Kn_Pa_m * kArea, K = stiffness_Pa_m * kArea;
    Sheared r;
    r.state.damage = 1.0;
    r.state.un_m = -kStress * kArea / kn;
    r.state.Fn_N = kStress * kArea;
    const double stored = elastic_energy(law, kArea, r.state);
    double un = 0.0;  // since then
    for (int k = 0; k < steps; ++k) {
        const double du = reach_m / steps, Fn_before = r.state.Fn_N, Fs_before = r.state.Fs_N;
        // The opening at which what presses it and the joint are in balance: both forces fall or grow with it.
        double low = -1e-5, high = 1e-5;
        BondState after;
        double slip = 0.0, dun = 0.0;
        for (int i = 0; i < 80; ++i) {
            dun = 0.5 * (low + high);
            after = r.state;
            slip = r.slip_m;
            slide_with_dilation(law, kDilation, kArea, dun, du, after, slip);
            (after.Fn_N > kStress * kArea + K * (un + dun) ? low : high) = dun;
        }
        un += dun;
        r.state = after;
        r.slip_m = slip;
        r.work_J -= 0.5 * (Fn_before + after.Fn_N) * dun + 0.5 * (Fs_before + after.Fs_N) * du;
    }
    r.opening_m = un;
    r.shear_N = -r.state.Fs_N;
    r.normal_N = r.state.Fn_N;
    r.stored_J = elastic_energy(law, kArea, r.state) - stored;
    return r;
}

}  // namespace

std::vector<Check> dilation_checks() {
    return {
        {.name = "dilation.angle",
         .sentence = "A joint that slides under a constant normal stress opens by the tangent of its dilation angle.",
         .formula = "dv / du = tan psi",
         .source = "(H9)-(H11) of the theory of heterogeneity",
         .bound = relative(1e-3),
         .reason = "the shear spring, which is stretched before it slides",
         .compare =
             [] {
                 return std::vector<CheckedValue>{
                     {"", kTanPsi, (shear(0.7 * kLimit, 0.0).opening_m - shear(0.5 * kLimit, 0.0).opening_m) / (0.2 * kLimit)}};
             }},
        {.name = "dilation.limit",
         .sentence = "Beyond the slip at which its dilation ends a joint opens no further, whatever the size of the steps.",
         .formula = "v = L tan psi",
         .source = "(H9)-(H11) of the theory of heterogeneity",
         .unit = "um",
         .bound = relative(1e-3),
         .reason = "the closure of the joint under its normal stress, which stays",
         .compare =
             [] {
                 const double expected = 1e6 * kTanPsi * kLimit;
                 return std::vector<CheckedValue>{{"slip 2 L", expected, 1e6 * shear(2.0 * kLimit, 0.0).opening_m},
                                                  {"slip 2.5 L", expected, 1e6 * shear(2.5 * kLimit, 0.0).opening_m},
                                                  {"slip 3 L in 7 steps", expected, 1e6 * shear(3.0 * kLimit, 0.0, 7).opening_m}};
             }},
        {.name = "dilation.strength",
         .sentence = "While it dilates the strength of a joint is that of its whole friction, under a constant stress and behind "
                     "a spring.",
         .formula = "Fs / Fn = mu",
         .source = "(H9)-(H11) of the theory of heterogeneity",
         .bound = relative(1e-9),
         .reason = "rounding",
         .compare =
             [] {
                 std::vector<CheckedValue> compared;
                 for (const double K : {0.0, 2e9}) {
                     const Sheared r = shear(0.7 * kLimit, K);
                     compared.push_back({K == 0.0 ? "constant stress" : "spring", kMu, r.shear_N / r.normal_N});
                 }
                 return compared;
             }},
        {.name = "dilation.spring",
         .sentence = "Behind a spring the normal stress of a dilating joint grows with its slip.",
         .formula = "d sigma_n / du = K tan psi",
         .source = "(H9)-(H11) of the theory of heterogeneity",
         .unit = "MPa/mm",
         .bound = relative(1e-3),
         .reason = "the shear spring of the joint; its normal spring adds 1e-5",
         .compare =
             [] {
                 constexpr double K = 2e9;
                 const double grown = (shear(0.7 * kLimit, K).normal_N - shear(0.3 * kLimit, K).normal_N) / kArea;
                 return std::vector<CheckedValue>{{"", 1e-9 * K * kTanPsi, 1e-9 * grown / (0.4 * kLimit)}};
             }},
        {.name = "dilation.work",
         .sentence = "What is done on a dilating joint is stored or dissipated, and nothing is lost.",
         .formula = "(W - stored) / (friction + fracture) = 1",
         .source = "(C14)-(C16)",
         .bound = relative(1e-9),
         .reason = "rounding of 4000 steps",
         .compare =
             [] {
                 std::vector<CheckedValue> compared;
                 for (const double K : {0.0, 2e9, 2e12}) {
                     const Sheared r = shear(1.5 * kLimit, K);
                     compared.push_back({K == 0.0   ? "constant stress"
                                         : K < 1e10 ? "2 GPa/m"
                                                    : "2000 GPa/m",
                                         1.0, (r.work_J - r.stored_J) / (r.state.friction_J + r.state.fracture_J)});
                 }
                 return compared;
             }},
        {.name = "dilation.friction",
         .sentence = "Friction takes what the shear force does not use to lift the normal force.",
         .formula = "friction = (mu - tan psi) Fn l",
         .source = "(H9)-(H11) of the theory of heterogeneity",
         .unit = "J/m2",
         .bound = relative(1e-3),
         .reason = "the closure of the joint under its normal stress",
         .compare =
             [] {
                 const Sheared r = shear(0.9 * kLimit, 0.0);
                 return std::vector<CheckedValue>{{"", (kMu - kTanPsi) * kStress * r.slip_m, r.state.friction_J / kArea}};
             }},
    };
}

}  // namespace feldspar
