// A broken joint that dilates, under a constant normal stress and behind a spring.
#include "feldspar/verify/dilating_point.hpp"
#include "feldspar/verify/topics.hpp"

namespace feldspar {
namespace {

using namespace bodies;

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
