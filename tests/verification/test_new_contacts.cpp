// Detachment and return: an open broken contact is dropped, and comes back as friction when the circles overlap.
#include <gtest/gtest.h>

#include <cmath>

#include "feldspar/base/error.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/fixtures.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/step/step.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

constexpr double kSide = 0.003, kSkin = 3e-4;

Assembly bar() {
    Assembly assembly = assemble(*fixtures::two_grain_bar(kSide), ModelSpec{}, fixtures::granite(), fixtures::table7());
    set_scaled_masses(assembly, MassBound::tensor, 1.0);
    return assembly;
}

void lift(Assembly& assembly, double by) {
    for (const int n : assembly.bodies[1].nodes()) assembly.nodes.displacement[n] = {0.0, by};
}

TEST(NewContacts, IntactContactsAreNeverDropped) {
    Assembly assembly = bar();
    ContactFinder finder(assembly, kSkin);
    lift(assembly, 10.0 * kSkin);
    EXPECT_EQ(finder.update(assembly, 1.0).dropped, 0);
}

TEST(NewContacts, APositionThatIsNotANumberIsAnErrorAndNeverSearched) {
    for (const double wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        Assembly assembly = bar();
        ContactFinder finder(assembly, kSkin);
        lift(assembly, wrong);
        EXPECT_THROW(finder.update(assembly, 1.0), NumericalError) << wrong;
        EXPECT_THROW(ContactFinder(assembly, kSkin), NumericalError) << wrong;
    }
}

TEST(NewContacts, ABrokenOpenContactIsDroppedAndReturnsAsFriction) {
    Assembly assembly = bar();
    ContactFinder finder(assembly, kSkin);
    std::fill(assembly.bonds.damage.begin(), assembly.bonds.damage.end(), 1.0);
    lift(assembly, 1.5 * kSkin);
    ContactFinder::Changes changes = finder.update(assembly, 1.0);
    EXPECT_EQ(changes.dropped, 1);
    EXPECT_EQ(changes.made, 0);
    lift(assembly, 1e-9);  // circles of radius kSide / 2 just apart
    EXPECT_EQ(finder.update(assembly, 1.0).made, 0);
    const Array<double> mass_before = assembly.nodes.mass;
    std::fill(assembly.nodes.velocity.begin(), assembly.nodes.velocity.end(), Vec2{3e-9, 4e-9});
    lift(assembly, -1e-8);
    changes = finder.update(assembly, 1.0);
    EXPECT_EQ(changes.made, 1);
    EXPECT_EQ(finder.update(assembly, 1.0).made, 0);  // only once
    ASSERT_EQ(assembly.contacts.size(), 2U);
    const ContactPoint& point = assembly.points.back();
    EXPECT_NEAR(assembly.bonds.at(point.state).un_m, -1e-8, 1e-12);
    EXPECT_NEAR(point.area_m2, kSide * 0.08, 1e-12);
    // The step stays stable: 0.25 (sum |N|)^2 kn = kn for a point on the edges, where |N| sums to 2; and what that costs is told.
    double added = 0.0;
    for (int n = 0; n < assembly.nodes.count(); ++n) added += assembly.nodes.mass[n] - mass_before[n];
    EXPECT_NEAR(added / (18e13 * point.area_m2), 1.0, 1e-4);  // the overlap shifts the point by 1e-8 of 3e-3 m
    EXPECT_NEAR(changes.kinetic_J / (0.5 * added * 25e-18), 1.0, 1e-9);
    std::fill(assembly.nodes.velocity.begin(), assembly.nodes.velocity.end(), Vec2{});
    Team team(1);
    evaluate_forces(assembly, team, Strength::real);
    EXPECT_NEAR(assembly.bonds.at(point.state).Fn_N / (18e13 * kSide * 0.08 * 1e-8), 1.0, 1e-3);
    EXPECT_EQ(assembly.bonds.at(point.state).Fs_N, 0.0);
}

TEST(NewContacts, PaperSizeSpecimenStartsWithoutAnyToMake) {
    Assembly assembly =
        assemble(*fixtures::make(fixtures::rectangle(0.08, 0.16)), ModelSpec{}, fixtures::granite(), fixtures::table7());
    ContactFinder finder(assembly, kSkin);
    EXPECT_EQ(finder.update(assembly, 1.0).made, 0);
}

}  // namespace
}  // namespace feldspar
