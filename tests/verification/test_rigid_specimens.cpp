// Elastic constants of whole specimens of rigid grains and inner particles, which no closed form says.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures.hpp"

namespace feldspar {
namespace {

struct Elastic {
    double E_Pa = 0.0, nu = 0.0;  // from the gauge
    double top_over_bottom = 0.0;
};

Elastic elastic(const TestSetup& setup) {
    const RunControl control = fixtures::threads(1);
    Experiment e(setup, control);
    choose_step(e);
    prepare(e);
    const Reactions reactions = feldspar::reactions(e.assembly);
    const double stress = e.stress(0.5 * (reactions.loading + reactions.rest));
    return {stress / e.gauge.axial(e.assembly), -e.gauge.lateral(e.assembly) / e.gauge.axial(e.assembly),
            reactions.loading / reactions.rest};
}

TEST(ElasticSpecimensOfPaperSize, RigidGrainsHaveTheConstantsThatWereMeasured) {  // golden: no closed form says them
    double E = 0.0, nu = 0.0;
    for (const std::uint64_t seed : {1, 2, 3}) {
        const TestSetup s = fixtures::setup(fixtures::rectangle(0.08, 0.16), methods::uniaxial_compression,
                                            fixtures::model(GrainKind::rigid), ContactLaw::bilinear, seed);
        const Elastic e = elastic(s);
        E += e.E_Pa / 3.0;
        nu += e.nu / 3.0;
        EXPECT_NEAR(e.top_over_bottom, 1.0, 2e-3);
    }
    EXPECT_NEAR(E, 25.6e9, 0.02 * 25.6e9);
    EXPECT_NEAR(nu, 0.2335, 0.01);  // seeds scatter by 0.006
}

TEST(ElasticSpecimensOfHalfThePapersSize, InnerParticlesHaveTheConstantsThatWereMeasured) {  // golden, too
    const TestSetup s = fixtures::setup(fixtures::rectangle(0.04, 0.08), methods::uniaxial_compression,
                                        fixtures::model(GrainKind::inner_particles));
    const Elastic e = elastic(s);
    EXPECT_NEAR(e.E_Pa, 26.2e9, 0.03 * 26.2e9);
    EXPECT_NEAR(e.nu, 0.22, 0.02);
    EXPECT_NEAR(e.top_over_bottom, 1.0, 2e-3);
}

}  // namespace
}  // namespace feldspar
