// What the outline means for the numbers of a test: section, uniform strain, buckling.
#include "feldspar/lab/specimen_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "feldspar/lab/experiment.hpp"
#include "feldspar/methods/platens.hpp"
#include "feldspar/specimen/outline.hpp"
#include "synthetic_records.hpp"

using namespace feldspar;
using namespace feldspar::synthetic;

namespace {

OutlineSpec bar(double width_m, double height_m) {
    OutlineSpec spec;
    spec.width_m = width_m;
    spec.height_m = height_m;
    return spec;
}

OutlineSpec labelled(std::vector<Vec2> vertices, std::vector<std::string> labels) {
    OutlineSpec spec;
    spec.shape = Shape::polygon;
    spec.vertices_m = std::move(vertices);
    spec.edge_labels = std::move(labels);
    return spec;
}

/// 20 mm wide with a waist of 8 mm; `waist` is its height, about the middle of 50 mm, with shoulders of 4 mm.
OutlineSpec bone(double waist_m) {
    const double a = 0.025 - 0.5 * waist_m, b = 0.025 + 0.5 * waist_m;
    return labelled({{0, 0},
                     {0.020, 0},
                     {0.020, a - 0.004},
                     {0.014, a},
                     {0.014, b},
                     {0.020, b + 0.004},
                     {0.020, 0.050},
                     {0, 0.050},
                     {0, b + 0.004},
                     {0.006, b},
                     {0.006, a},
                     {0, a - 0.004}},
                    {"bottom", "a", "b", "c", "d", "e", "top", "f", "g", "h", "i", "j"});
}

TestResult on(const OutlineSpec& outline, MethodId kind, double peak_Pa) {
    TestResult result = linear(kind, peak_Pa, 100, kind == methods::direct_tension ? -1.0 : 1.0);
    auto specimen = std::make_shared<Specimen>();
    specimen->outline = make_outline(outline);
    result.specimen = specimen;
    result.properties = measure(result);
    result.evidence = judge(result);
    return result;
}

}  // namespace

TEST(SpecimenShape, ARectangleKeepsItsNumbers) {
    const TestResult with = on(bar(0.08, 0.16), methods::uniaxial_compression, 100e6),
                     without = linear(methods::uniaxial_compression, 100e6);
    EXPECT_EQ(with.properties.E_secant_Pa, without.properties.E_secant_Pa);
    EXPECT_EQ(with.properties.nu, without.properties.nu);
    EXPECT_DOUBLE_EQ(with.properties.section_width_m, 0.08);
    EXPECT_TRUE(with.properties.remarks.empty());
    EXPECT_EQ(with.evidence.grade, 'A');
    EXPECT_EQ(section_width_m(make_outline(bar(0.08, 0.16)), 0.0800000000000001), 0.0800000000000001) << "bit for bit";
}

TEST(SpecimenShape, AWaistIsTheSectionAndLeavesNoModulus) {
    const TestProperties p = on(bone(0.018), methods::direct_tension, 8e6).properties;
    EXPECT_NEAR(p.section_width_m, 0.008, 1e-15);
    EXPECT_NEAR(p.peak_stress_Pa, 8e6, 1.0);
    EXPECT_TRUE(p.peak_reached);
    for (const double value :
         {p.E_secant_Pa, p.E_tangent_Pa, p.E_average_Pa, p.E_gauge_Pa, p.E_initial_Pa, p.nu, p.nu_tangent, p.nu_initial})
        EXPECT_TRUE(std::isnan(value));
    ASSERT_EQ(p.remarks.size(), 1u);
    EXPECT_NE(p.remarks.front().find("8 mm wide"), std::string::npos) << p.remarks.front();
    EXPECT_NE(p.remarks.front().find("strain gauge"), std::string::npos);
}

TEST(SpecimenShape, AWaistAsLongAsTheGaugeKeepsWhatTheGaugeReads) {
    const TestProperties p = on(bone(0.026), methods::uniaxial_compression, 100e6).properties;
    EXPECT_TRUE(std::isnan(p.E_secant_Pa));
    EXPECT_NEAR(p.E_gauge_Pa, E, 1e-6 * E);
    EXPECT_NEAR(p.nu, nu, 1e-9);
    EXPECT_EQ(p.remarks.size(), 1u);
}

TEST(SpecimenShape, ATaperOfTwoPercentIsUniformAndOneOfThreeIsNot) {
    const auto taper = [](double share) {
        return labelled({{0, 0}, {0.02 * (1.0 + share), 0}, {0.02, 0.04}, {0, 0.04}}, {"bottom", "right", "top", "left"});
    };
    EXPECT_TRUE(std::isfinite(on(taper(0.019), methods::uniaxial_compression, 100e6).properties.E_secant_Pa));
    EXPECT_TRUE(std::isnan(on(taper(0.03), methods::uniaxial_compression, 100e6).properties.E_secant_Pa));
}

TEST(SpecimenShape, EulersStressIsThatOfPlatensThatSlide) {
    EXPECT_NEAR(euler_stress_Pa(22.38e9, 0.005, 0.200), 11.5e6, 0.05e6);  // pi^2 22.38e9 / (12 x 40^2)
    EXPECT_NEAR(slenderest(22.38e9, 128e6), 11.99, 0.01);
    EXPECT_NEAR(euler_stress_Pa(22.38e9, 1.0, slenderest(22.38e9, 128e6)), 128e6, 1.0) << "one is the other's inverse";
}

TEST(SpecimenShape, AColumnThatWouldBendGetsGradeC) {
    // E 25 GPa, strength 100 MPa: pi sqrt(25000 / 1200) = 14.34
    EXPECT_EQ(on(bar(0.01, 0.142), methods::uniaxial_compression, 100e6).evidence.grade, 'A');
    const QuasiStaticEvidence e = on(bar(0.01, 0.145), methods::uniaxial_compression, 100e6).evidence;
    EXPECT_EQ(e.grade, 'C');
    EXPECT_NE(e.verdict.find("would bend aside at 97.8 MPa"), std::string::npos) << e.verdict;  // pi^2 25000 / (12 x 14.5^2)
    EXPECT_NE(e.verdict.find("below 14.3"), std::string::npos) << e.verdict;
    EXPECT_EQ(on(bar(0.01, 0.4), methods::direct_tension, 100e6).evidence.grade, 'A') << "what is pulled does not bend";
}

TEST(SpecimenShape, ATestOfABoneTakesItsStressOverTheWaist) {
    SpecimenSpec spec;
    spec.grain_sizes.minimum_m = 0.0015;
    spec.grain_sizes.maximum_m = 0.0025;
    spec.outline = bone(0.018);
    spec.thickness_m = 0.03;
    TestSetup setup;
    setup.specimen = std::make_shared<Specimen>(make_specimen(spec, 1));
    setup.grain = {.E_Pa = 25e9, .nu = 0.2, .density_kg_m3 = 2650.0};
    setup.contact.Kn_Pa_m = 1e14;
    setup.contact.eta = 0.3;
    setup.contact.sigma_nt_Pa = 10e6;
    setup.contact.tau_Pa = 30e6;
    setup.contact.Gfn_J_m2 = 20.0;
    setup.contact.Gfs_J_m2 = 800.0;
    setup.test.kind = methods::direct_tension;
    const RunControl control;
    EXPECT_NEAR(Experiment(setup, control).section_m2, 0.008 * 0.03, 1e-12);
}
