// The account of the energy of whole tests, through failure.
#include <limits>

#include "feldspar/verify/bodies.hpp"
#include "feldspar/verify/topics.hpp"

namespace feldspar {
namespace {

using namespace bodies;

double residual(MethodId kind, NumericsKind numerics, ContactLaw law, GrainKind grains) {
    const SpecimenSpec spec = method_of(usual_test(kind)).specimen.own_disc ? disc(0.03) : rectangle(0.02, 0.04);
    TestSetup s = setup(spec, kind, model(grains), law);
    s.contact.law = law;
    s.test.membrane_plates = 8;
    s.numerics.kind = numerics;
    s.numerics.accuracy = 0.02;
    if (numerics == NumericsKind::dynamic) s.numerics.speed_m = 0.5;
    if (kind == methods::direct_tension) s.test.stop_fraction = 0.3;  // softening alone reaches the usual 0.8
    if (kind == methods::biaxial) s.test.sigma3_Pa = 5e6;
    const TestResult r = run_test(s, {});
    return r.properties.peak_reached && !r.cracks.empty() ? r.energy_residual : std::numeric_limits<double>::quiet_NaN();
}

std::vector<CheckedValue> flexible() {
    using enum ContactLaw;
    return {{"compression", 0.0, residual(methods::uniaxial_compression, NumericsKind::adaptive, bilinear, GrainKind::flexible)},
            {"compression, brittle", 0.0,
             residual(methods::uniaxial_compression, NumericsKind::adaptive, brittle, GrainKind::flexible)},
            {"compression in real time", 0.0,
             residual(methods::uniaxial_compression, NumericsKind::dynamic, bilinear, GrainKind::flexible)},
            {"biaxial", 0.0, residual(methods::biaxial, NumericsKind::adaptive, bilinear, GrainKind::flexible)},
            {"direct tension", 0.0, residual(methods::direct_tension, NumericsKind::adaptive, bilinear, GrainKind::flexible)}};
}

std::vector<CheckedValue> rigid() {
    using enum ContactLaw;
    return {{"compression", 0.0, residual(methods::uniaxial_compression, NumericsKind::adaptive, bilinear, GrainKind::rigid)},
            {"direct tension", 0.0, residual(methods::direct_tension, NumericsKind::adaptive, bilinear, GrainKind::rigid)},
            {"biaxial, brittle", 0.0, residual(methods::biaxial, NumericsKind::adaptive, brittle, GrainKind::rigid)},
            {"Brazilian, brittle", 0.0, residual(methods::brazilian, NumericsKind::adaptive, brittle, GrainKind::rigid)}};
}

}  // namespace

std::vector<Check> energy_checks() {
    constexpr const char* formula = "supplied - elastic - fracture - friction - damping - kinetic = 0";
    return {
        {.name = "energy.flexible",
         .sentence = "In tests of flexible grains through failure the account of the energy closes; what is missing over the "
                     "work supplied.",
         .formula = formula,
         .source = "(L13)",
         .bound = absolute(5e-3),
         .reason = "forces of the law within a step; measured 1e-5 to 1e-3",
         .compare = flexible},
        {.name = "energy.rigid",
         .sentence =
             "In tests of rigid grains through failure the account of the energy closes; what is missing over the work supplied.",
         .formula = formula,
         .source = "(L13)",
         .bound = absolute(5e-3),
         .reason = "forces of the law within a step; measured 1e-5 to 1e-3",
         .compare = rigid},
    };
}

}  // namespace feldspar
