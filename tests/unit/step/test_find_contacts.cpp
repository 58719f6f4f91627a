// Contacts that begin where bodies come to overlap, and end where broken ones are open.
#include <gtest/gtest.h>

#include <algorithm>

#include "feldspar/model/assemble.hpp"
#include "fixtures.hpp"

using namespace feldspar;

namespace {

Assembly bar() {
    return assemble(*fixtures::two_grain_bar(0.01), fixtures::model(GrainKind::rigid), fixtures::granite(), fixtures::table7());
}

// The same grains without a contact.
Assembly loose_bar() {
    Assembly assembly = bar();
    for (Contact& contact : assembly.contacts) contact.dropped = true;
    return assembly;
}

void break_all(Assembly& assembly) {
    for (std::size_t p = 0; p < assembly.points.size(); ++p) {
        BondState bond = assembly.bond(static_cast<int>(p));
        bond.damage = 1.0;
        assembly.set_bond(static_cast<int>(p), bond);
        assembly.points[p].broken_step = 0;
    }
}

void lift_upper(Assembly& assembly, double by_m) { assembly.nodes.displacement[assembly.bodies[1].centre_node].y += by_m; }

}  // namespace

TEST(FindContacts, IntactBodiesGetNoneBeside) {
    Assembly assembly = bar();
    ContactFinder finder(assembly, 1e-3);
    lift_upper(assembly, -1e-4);
    const ContactFinder::Changes changes = finder.update(assembly, 0.0);
    EXPECT_EQ(changes.made, 0);
    EXPECT_EQ(changes.dropped, 0);
}

TEST(FindContacts, IntactOnesAreNeverDropped) {
    Assembly assembly = bar();
    ContactFinder finder(assembly, 1e-3);
    lift_upper(assembly, 0.01);
    EXPECT_EQ(finder.update(assembly, 0.0).dropped, 0);
}

// Bodies that overlap at the start without a contact, as discs of a packing may, begin one when they come nearer than they were.
TEST(FindContacts, OverlapsOfTheStartAreAtRest) {
    Assembly assembly = loose_bar();
    lift_upper(assembly, -1e-3);
    ContactFinder finder(assembly, 1e-2);
    lift_upper(assembly, 1e-4);
    EXPECT_EQ(finder.update(assembly, 0.0).made, 0) << "they still overlap, by less than at the start";
    lift_upper(assembly, -1e-4 - 1e-6);
    EXPECT_EQ(finder.update(assembly, 0.0).made, 1);
}

// Each of two bodies may move by half of the skin before pairs are looked for again, so those that the skin parts are candidates.
TEST(FindContacts, BodiesThatTheSkinPartsMeetHalfWay) {
    Assembly assembly = loose_bar();
    constexpr double kSkin = 1e-3;
    lift_upper(assembly, 0.97 * kSkin);
    ContactFinder finder(assembly, kSkin);
    lift_upper(assembly, -0.49 * kSkin);
    assembly.nodes.displacement[assembly.bodies[0].centre_node].y += 0.49 * kSkin;
    EXPECT_EQ(finder.update(assembly, 0.0).made, 1);
}

// What comes from beyond the skin is found once it has come half of it: bodies that were no candidates.
TEST(FindContacts, BodiesThatWereFarApartMeet) {
    Assembly assembly = loose_bar();
    constexpr double kSkin = 1e-3;
    lift_upper(assembly, 3.0 * kSkin);
    ContactFinder finder(assembly, kSkin);
    lift_upper(assembly, -2.0 * kSkin);
    EXPECT_EQ(finder.update(assembly, 0.0).made, 0) << "a gap of the skin is left";
    lift_upper(assembly, -1.1 * kSkin);
    EXPECT_EQ(finder.update(assembly, 0.0).made, 1);
}

// A broken contact that is open beyond its closing distance is dropped; when the grains meet again a frictional one begins, once.
TEST(FindContacts, BrokenOnesAreDroppedWhenOpenAndBeginAgainWithAnOverlap) {
    Assembly assembly = bar();
    ContactFinder finder(assembly, 1e-3);
    break_all(assembly);
    lift_upper(assembly, 0.01);
    for (Contact& contact : assembly.contacts)
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {  // as a step would leave it: open
            BondState bond = assembly.bond(p);
            bond.un_m = 0.01;
            bond.Fn_N = bond.Fs_N = 0.0;
            assembly.set_bond(p, bond);
        }
    EXPECT_EQ(finder.update(assembly, 0.0).dropped, 1);
    EXPECT_TRUE(assembly.contacts.front().dropped);
    lift_upper(assembly, -0.01 - 1e-4);
    EXPECT_EQ(finder.update(assembly, 0.0).made, 1);
    EXPECT_EQ(finder.update(assembly, 0.0).made, 0) << "one pair, one contact";
    const auto made = std::ranges::find(assembly.contacts, true, &Contact::new_contact);
    ASSERT_NE(made, assembly.contacts.end());
    EXPECT_EQ(assembly.bond(made->first_point).damage, 1.0) << "it carries friction only";
}
