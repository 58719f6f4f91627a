// Rocks whose grains and contacts differ, against closed forms: mixtures, the weakest link, sliding, and that an even rock
// written as an uneven one is itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "feldspar/base/regression.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

// From the gauge, or between the platens.
double modulus(TestSetup setup, bool between_platens = false) {
    setup.test.maximum_stress_Pa = 2e6;  // long before anything breaks
    const auto properties = run_test(setup, fixtures::threads(1)).properties;
    return between_platens ? properties.E_tangent_Pa : properties.E_gauge_Pa;
}

// One mineral given twice, a joint that is as strong as the rock: laws of their own for all contacts, and the same rock.
TEST(UnevenRock, OfEqualPartsIsTheEvenRock) {
    for (const GrainKind grains : {GrainKind::flexible, GrainKind::rigid, GrainKind::inner_particles}) {
        const ModelSpec model = fixtures::model(grains);
        TestSetup even = fixtures::setup(fixtures::rectangle(0.03, 0.06), methods::uniaxial_compression, model), uneven = even;
        uneven.rock.minerals.phases = {{"a", 0.4, even.grain}, {"b", 0.6, even.grain}};
        JointSpec joint;
        joint.name = "healed";
        joint.lines_m = {{{0.0, 0.02}, {0.03, 0.04}}};
        joint.contact = even.contact;
        uneven.rock.joints = {joint};
        EXPECT_NEAR(modulus(uneven) / modulus(even), 1.0, 1e-6) << name(grains);
        if (grains == GrainKind::inner_particles) continue;  // the same laws as of rigid grains, at ten times the cost
        const TestResult a = run_test(even, fixtures::threads(1)), b = run_test(uneven, fixtures::threads(1));
        EXPECT_NEAR(b.properties.first_crack_Pa / a.properties.first_crack_Pa, 1.0, 1e-2) << name(grains);
        EXPECT_NEAR(b.properties.peak_stress_Pa / a.properties.peak_stress_Pa, 1.0, 1e-2)
            << name(grains);  // rounding, and what grows of it
    }
}

// A gap that is open before the test gives way without force until it has closed: by opening / height per joint that the load
// crosses.
TEST(Joints, ThatAreOpenCloseFirst) {
    TestSetup setup = fixtures::setup(fixtures::make(fixtures::rectangle(0.03, 0.06)), methods::uniaxial_compression);
    JointSpec joint;
    joint.name = "open";
    joint.lines_m = {{{-0.01, 0.03}, {0.04, 0.03}}};
    joint.contact = setup.contact;
    joint.contact.sigma_nt_Pa = joint.contact.tau_Pa = 0.0;
    joint.opening_m = 3e-6;
    setup.rock.joints = {joint};
    setup.test.maximum_stress_Pa = 10e6;
    const TestResult open = run_test(setup, fixtures::threads(1));
    setup.rock.joints.front().opening_m = 0.0;
    const TestResult closed = run_test(setup, fixtures::threads(1));
    ASSERT_FALSE(open.history.empty());
    ASSERT_FALSE(closed.history.empty());
    const double more = open.history.back().axial_strain - closed.history.back().axial_strain;
    // Facets of the rough joint are inclined: along the load a gap is wider by 1 / cos of up to 60 degrees, and the flattest
    // close first.
    EXPECT_GT(more, 0.9 * joint.opening_m / 0.06);
    EXPECT_LT(more, 2.5 * joint.opening_m / 0.06);
}

// Where the normal of a smooth joint is less than phi from the load the rock has its own strength; else it slides on the joint
// (how strong it is then: joints.jaeger of verify/joints.cpp).
TEST(Joints, ThatAreSmoothSlideOrLeaveTheRockItsOwnStrength) {
    for (const double beta_deg : {30.0, 45.0, 75.0}) {
        TestSetup setup =
            fixtures::setup(fixtures::make(fixtures::with_joint(0.04, 0.08, beta_deg)), methods::uniaxial_compression);
        setup.rock.joints = {fixtures::smooth_joint(setup.contact, 0.57735, 5e6, 3e6)};
        const TestResult r = run_test(setup, fixtures::threads(1));
        if (beta_deg < 31.0) {
            EXPECT_GT(r.properties.peak_stress_Pa, 90e6);  // 118 MPa without a joint
            continue;
        }
        const double tan_beta = std::tan(beta_deg * std::numbers::pi / 180.0);
        for (const Crack& crack : r.cracks)  // of the joint alone until the strength
            if (crack.axial_stress_Pa > 0.5 * r.properties.peak_stress_Pa) {
                EXPECT_NEAR(((crack.place.y - 0.04) - tan_beta * (crack.place.x - 0.02)) / std::sqrt(1.0 + tan_beta * tan_beta),
                            0.0, 1e-6)
                    << beta_deg;
            }
    }
}

// A notched beam in which only a smooth joint over the ligament can break: the work of fracture is the joint's fracture energy
// times the length of its path.
TEST(Joints, OverTheLigamentOfABeamTakeTheirFractureEnergy) {
    SpecimenSpec spec = fixtures::rectangle(
        0.176, 0.04);  // a smaller one snaps back more, and the branch behind its strength is then less quasi-static
    const double middle = 0.088, notch = 0.02;
    spec.outline.notches = {{{middle, 0.0}, {middle, notch}, 0.0, ""}, {{middle, notch}, {middle, 0.041}, 0.0, "ligament", true}};
    TestSetup setup = fixtures::setup(fixtures::make(spec), methods::three_point_bend);
    setup.test = usual_test(methods::three_point_bend);
    const ContactMaterial weak = setup.contact;
    setup.contact.sigma_nt_Pa *= 10.0;
    setup.contact.tau_Pa *= 10.0;
    setup.contact.Gfn_J_m2 *= 100.0;
    setup.contact.Gfs_J_m2 *= 100.0;
    JointSpec joint;
    joint.name = joint.cut = "ligament";
    joint.contact = weak;
    setup.rock.joints = {joint};
    setup.test.stop_fraction = 0.02;
    const TestResult r = run_test(setup, fixtures::threads(2));
    const std::span<const MethodProperty> own = method_of(setup.test).properties;
    double work = std::nan("");
    for (std::size_t i = 0; i < own.size(); ++i)
        if (own[i].name == std::string_view("work_of_fracture")) work = r.properties.of_method.at(i);
    EXPECT_NEAR(work / weak.Gfn_J_m2, 1.0, 0.05) << r.stop_reason;  // path and ligament are of one length
    // At a fiftieth of the load the last grains before the upper side have not opened to the end.
    EXPECT_NEAR(r.energy_at_end.fracture / (weak.Gfn_J_m2 * (spec.outline.height_m - notch) * 0.08), 0.95, 0.05);
}

// A smooth joint that dilates in direct shear: the upper half rises by tan psi of the slip until the limit, under the friction of
// the whole angle; behind a spring the normal stress grows by what the spring gives for the rise. Rigid grains: nothing else
// gives way.
TEST(Joints, ThatDilateRiseByTheTangentOfTheirAngleUntilTheirLimit) {
    constexpr double kTanPsi = 0.2;
    for (const GrainKind grains : {GrainKind::flexible}) {  // rigid ones: verify/joints.cpp
        constexpr double kLimit = 5e-5;
        const TestResult r = fixtures::sheared_joint(grains, 0.5, kTanPsi, kLimit, 0.0, 45.0 * kLimit);
        std::vector<double> u, v;  // while it dilates
        double along = 0.0, across = 0.0, highest = 0.0, at_end = 0.0;
        const auto first =
            std::find_if(r.history.begin(), r.history.end(), [](const HistoryRow& row) { return row.phase == Phase::loading; });
        ASSERT_NE(first, r.history.end());
        for (const HistoryRow& row : r.history) {
            if (row.phase != Phase::loading) continue;
            const double slip = row.axial_strain * r.length_m;
            if (slip > 0.3 * kLimit && slip < 0.9 * kLimit) {
                u.push_back(slip);
                v.push_back(row.gauges[0]);
            }
            if (slip > 0.3 * kLimit) {
                along += row.axial_stress_Pa * r.section_m2;
                across += row.gauges[1];
            }
            at_end = row.gauges[0] - first->gauges[0];  // the normal stress had pushed the plate down before
            highest = std::max(highest, at_end);
        }
        ASSERT_GT(u.size(), 10U) << name(grains);
        // The joint of flexible grains tilts with their edges.
        EXPECT_NEAR(regression_line(u, v).slope / kTanPsi, 1.0, 2e-2) << name(grains);
        EXPECT_NEAR(along / across / 0.5, 1.0, 1e-2) << name(grains);
        EXPECT_NEAR(highest / (kTanPsi * kLimit), 1.0, 5e-2)
            << name(grains);  // before it slides the specimen is sheared, which lifts the plate a little
        EXPECT_NEAR(at_end / highest, 1.0, 2e-2) << name(grains) << ": beyond the limit it slides on";
        EXPECT_LT(r.energy_residual, 0.01) << name(grains);
    }
}

// Every crack dissipates, and the events hold all of it.
TEST(Cracks, DissipateEnergyAndEventsHoldAllOfIt) {
    TestSetup setup = fixtures::setup(fixtures::make(fixtures::rectangle(0.04, 0.08)), methods::uniaxial_compression);
    setup.rock.scatter[Scattered::strength] = {.kind = DistributionKind::weibull, .weibull_modulus = 1.6, .lowest = 0.1};
    const TestResult r = run_test(setup, fixtures::threads(2));
    ASSERT_GT(r.cracks.size(), 200U);
    double cracks = 0.0, largest = 0.0, least = 0.0, events = 0.0;
    for (const Crack& crack : r.cracks) {
        cracks += crack.energy_J;
        largest = std::max(largest, crack.energy_J);
        least = std::min(least, crack.energy_J);
    }
    for (const AcousticEvent& event : r.emission.events) events += event.energy_J;
    EXPECT_NEAR(events / cracks, 1.0, 1e-12);
    EXPECT_GE(least, -1e-6 * largest);  // rounding of sums over thousands of steps
}

// States, cracks and draws do not depend on the number of threads.
TEST(UnevenRock, HasTheSameBitsForAnyNumberOfThreads) {
    TestSetup setup = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04)), methods::uniaxial_compression);
    setup.rock = fixtures::uneven_rock();
    setup.numerics.maximum_steps = 3000;
    const TestResult one = run_test(setup, fixtures::threads(1)), three = run_test(setup, fixtures::threads(3));
    EXPECT_EQ(one.properties.peak_stress_Pa, three.properties.peak_stress_Pa);
    ASSERT_EQ(one.cracks.size(), three.cracks.size());
    for (std::size_t c = 0; c < one.cracks.size(); ++c) EXPECT_EQ(one.cracks[c].energy_J, three.cracks[c].energy_J);
    EXPECT_LT(one.energy_residual, 0.01);
}

}  // namespace
}  // namespace feldspar
