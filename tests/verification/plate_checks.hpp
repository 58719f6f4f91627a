// What holds for the plates of a Brazilian test whatever the grains are.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "fixtures.hpp"

namespace feldspar {

/// Contacts of a plate.
inline std::vector<const Contact*> contacts_of(const Assembly& assembly, int plate) {
    std::vector<const Contact*> found;
    for (const Contact& contact : assembly.contacts)
        if (contact.plate && contact.b.body == plate) found.push_back(&contact);
    return found;
}

/// The plates on a small disc have the stiffness and friction that are asked for, act over the diameters of the bodies, each of
/// which they touch once, and start where the first is touched.
inline void expect_plates_on_a_disc(const ModelSpec& model) {
    TestSetup s = fixtures::setup(fixtures::disc(0.03), methods::brazilian, model);
    s.test.plate_stiffness_factor = 0.5;
    s.test.plate_mu = 0.25;
    const RunControl control = fixtures::threads(1);
    const Experiment e(s, control);
    const BondLaw& law = e.assembly.laws.at(at_plates);
    EXPECT_DOUBLE_EQ(law.Kn_Pa_m, 0.5 * s.contact.Kn_Pa_m);
    EXPECT_DOUBLE_EQ(law.Ks_Pa_m, s.contact.eta * 0.5 * s.contact.Kn_Pa_m);
    EXPECT_DOUBLE_EQ(law.mu, 0.25);
    for (const Fixture& platen : e.assembly.fixtures) {
        double smallest = INFINITY;
        std::map<int, int> touched;
        for (const Contact* contact : contacts_of(e.assembly, platen.plate)) {
            ASSERT_EQ(contact->points, 1);
            const ContactPoint& point = e.assembly.points[contact->first_point];
            const double diameter = 2.0 * e.assembly.bodies[contact->a.body].radius_m;
            EXPECT_DOUBLE_EQ(point.area_m2, diameter * e.assembly.thickness_m);
            EXPECT_EQ(e.assembly.bonds.at(point.state).damage, 1.0);
            EXPECT_EQ(++touched[contact->a.body], 1);  // a body touches once
            smallest = std::min(smallest, e.assembly.bonds.at(point.state).un_m);
        }
        EXPECT_NEAR(smallest, 0.0, 1e-15);
        EXPECT_GE(touched.size(), 3U);
    }
}

}  // namespace feldspar
