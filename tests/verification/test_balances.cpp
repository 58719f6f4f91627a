// Energy of whole tests through failure, on small specimens: the cases that are no checks of verify/energy.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures.hpp"

namespace feldspar {
namespace {

struct Case {
    MethodId kind;
    NumericsKind numerics;
    ContactLaw law;
    GrainKind grains = GrainKind::flexible;
    ContactKind contact = ContactKind::lobatto3;
    ContactNormal normal = ContactNormal::centres;
};

std::string label(const testing::TestParamInfo<Case>& info) {
    std::string text = std::string(name(info.param.kind)) + "_" + name(info.param.numerics) + "_" + name(info.param.law);
    if (info.param.grains != GrainKind::flexible)
        text += "_" + fixtures::label(fixtures::model(info.param.grains, info.param.contact, info.param.normal));
    std::erase(text, '-');
    return text;
}

class EnergyBalance : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Tests, EnergyBalance,
                         testing::Values(Case{methods::uniaxial_compression, NumericsKind::paper, ContactLaw::bilinear},
                                         Case{methods::biaxial, NumericsKind::paper, ContactLaw::bilinear},
                                         Case{methods::direct_tension, NumericsKind::paper, ContactLaw::linear},
                                         Case{methods::brazilian, NumericsKind::adaptive, ContactLaw::bilinear},
                                         Case{methods::brazilian, NumericsKind::paper, ContactLaw::bilinear_literal}),
                         label);
INSTANTIATE_TEST_SUITE_P(RigidGrains, EnergyBalance, testing::ValuesIn([] {
                             using namespace methods;
                             using enum NumericsKind;
                             using enum ContactLaw;
                             constexpr GrainKind rigid = GrainKind::rigid;
                             std::vector<Case> cases;
                             for (const MethodId kind : std::initializer_list<MethodId>{uniaxial_compression, direct_tension})
                                 cases.push_back({kind, adaptive, brittle, rigid});
                             for (const MethodId kind : std::initializer_list<MethodId>{biaxial, methods::brazilian})
                                 cases.push_back({kind, adaptive, bilinear, rigid});
                             cases.push_back({uniaxial_compression, paper, bilinear, rigid});
                             cases.push_back({uniaxial_compression, dynamic, brittle, rigid});
                             cases.push_back({biaxial, paper, brittle, rigid});
                             cases.push_back({uniaxial_compression, adaptive, brittle, rigid, ContactKind::point});
                             return cases;
                         }()),
                         label);
INSTANTIATE_TEST_SUITE_P(
    InnerParticles, EnergyBalance, testing::ValuesIn([] {
        using namespace methods;
        constexpr NumericsKind adaptive = NumericsKind::adaptive;
        constexpr GrainKind inner = GrainKind::inner_particles;
        std::vector<Case> cases;
        for (const MethodId kind : std::initializer_list<MethodId>{uniaxial_compression, direct_tension, biaxial, brazilian})
            cases.push_back({kind, adaptive, kind == direct_tension ? ContactLaw::bilinear : ContactLaw::brittle, inner});
        cases.push_back({direct_tension, adaptive, ContactLaw::bilinear, inner, ContactKind::point, ContactNormal::edge});
        return cases;
    }()),
    label);

TEST_P(EnergyBalance, ClosesThroughFailure) {
    const Case c = GetParam();
    const bool disc = c.kind == methods::brazilian;
    const bool inner = c.grains == GrainKind::inner_particles;  // ten times as many bodies: a smaller specimen
    const SpecimenSpec spec = disc    ? fixtures::disc(inner ? 0.02 : 0.03)
                              : inner ? fixtures::rectangle(0.014, 0.028)
                                      : fixtures::rectangle(0.02, 0.04);
    TestSetup s = fixtures::setup(spec, c.kind, fixtures::model(c.grains, c.contact, c.normal), c.law);
    s.contact.law = c.law;
    s.test.membrane_plates = inner ? 4 : 8;
    s.numerics.kind = c.numerics;
    s.numerics.accuracy = 0.02;
    if (c.numerics == NumericsKind::paper) s.numerics.speed_m = 2e-8;
    if (c.numerics == NumericsKind::dynamic) s.numerics.speed_m = 0.5;
    if (c.kind == methods::direct_tension) s.test.stop_fraction = 0.3;  // softening alone reaches the usual 0.8
    if (c.kind == methods::biaxial) s.test.sigma3_Pa = 5e6;
    const TestResult r = run_test(s, fixtures::threads(c.grains == GrainKind::flexible ? 2 : 1));
    EXPECT_TRUE(r.properties.peak_reached) << r.stop_reason;
    EXPECT_GT(r.cracks.size(), 0U);
    EXPECT_LT(r.energy_residual, 5e-3);
    EXPECT_GT(r.energy_at_end.fracture, 0.0);
    EXPECT_GE(r.energy_at_end.friction, -1e-9 * r.energy_at_end.supplied());  // rounding of elastic points
    double strongest = 0.0;
    for (const HistoryRow& row : r.history) strongest = std::max(strongest, std::abs(row.axial_stress_Pa));
    EXPECT_GT(strongest, 1e6);
}

TEST(EnergyOfOneMoment, ClosesToRoundingErrorsOfTheLawWhateverTheSpeedDoes) {  // (L13)
    // Measured 1.6e-5 and 8.0e-5. With bodies that do not follow a change of speed, or with the works half a step ahead of the
    // energies, it is 2e-3: that the bound of the tests above lets pass.
    for (const GrainKind grains : {GrainKind::flexible, GrainKind::rigid}) {
        TestSetup s = fixtures::setup(fixtures::rectangle(0.02, 0.04), methods::uniaxial_compression, fixtures::model(grains));
        s.numerics.accuracy = 0.02;
        const TestResult r = run_test(s, fixtures::threads(1));
        EXPECT_TRUE(r.properties.peak_reached);
        EXPECT_LT(r.energy_residual, 3e-4) << name(grains);
    }
}

}  // namespace
}  // namespace feldspar
