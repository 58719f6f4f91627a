// Contacts that are far from where they began. What rigid motions and homogeneous strains do are checks of verify/triangles.cpp
// and contacts.cpp.
#include <gtest/gtest.h>

#include "feldspar/lab/body_energy.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/fixtures.hpp"
#include "feldspar/step/step.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

using fixtures::granite;
using fixtures::make;
using fixtures::rectangle;
using fixtures::table7;

Assembly small_body() { return assemble(*make(rectangle(0.02, 0.04)), ModelSpec{}, granite(), table7()); }

TEST(Kinematics, FallBackShapesAreUsedOnlyFarFromTheStartAndTheirMomentLossIsMeasured) {
    Assembly assembly = small_body();
    EXPECT_EQ(choose_shape_functions(assembly, 0.0).fallback_sides, 0);
    EXPECT_EQ(fallback_moment_loss(assembly), 0.0);
    const Contact& contact = assembly.contacts[0];
    for (const int n : assembly.bodies[contact.b.body].nodes())
        assembly.nodes.displacement[n] = {1.5e-3, 1.0e-3};  // half a grain away
    EXPECT_GT(choose_shape_functions(assembly, 0.0).fallback_sides, 0);
    ASSERT_TRUE(assembly.contacts[0].initial_shape);
    for (int n = 0; n < assembly.nodes.count(); ++n) assembly.nodes.velocity[n] = {1e-9 * (n % 7), -1e-9 * (n % 5)};
    contact_forces(assembly, {0, static_cast<int>(assembly.contacts.size())}, StepSettings{}, 0);
    EXPECT_GT(fallback_moment_loss(assembly), 0.0);
}

}  // namespace
}  // namespace feldspar
