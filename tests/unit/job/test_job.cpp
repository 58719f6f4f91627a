#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <vector>

#include "../../switched_on.hpp"
#include "../../table7.hpp"
#include "../../temporary_folder.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/job/job_template.hpp"
#include "feldspar/job/rock_files.hpp"
#include "feldspar/job/toml_reader.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/specimen/grain_sizes.hpp"
#include "sample_job.hpp"

namespace feldspar {
namespace {

void expect_table7(const ContactMaterial& contact) {
    const ContactMaterial table7 = fixtures::table7();
    EXPECT_EQ(contact.Kn_Pa_m, table7.Kn_Pa_m);
    EXPECT_EQ(contact.eta, table7.eta);
    EXPECT_EQ(contact.sigma_nt_Pa, table7.sigma_nt_Pa);
    EXPECT_EQ(contact.tau_Pa, table7.tau_Pa);
    EXPECT_EQ(contact.mu, table7.mu);
    EXPECT_EQ(contact.Gfn_J_m2, table7.Gfn_J_m2);
    EXPECT_EQ(contact.Gfs_J_m2, table7.Gfs_J_m2);
}

TEST(Job, ReadsTheGuidesCompleteJob) {
    const Job job = parse_job(sample_job, "somewhere/augig.toml");
    EXPECT_EQ(job.name, "augig");
    EXPECT_EQ(job.text, sample_job);
    EXPECT_EQ(job.specimen.outline.shape, Shape::rectangle);
    EXPECT_EQ(job.specimen.outline.width_m, 0.08);
    EXPECT_EQ(job.specimen.outline.height_m, 0.16);
    EXPECT_EQ(job.specimen.thickness_m, 0.08);
    EXPECT_EQ(job.specimen.grain_sizes.minimum_m, 0.002);
    EXPECT_EQ(job.specimen.grain_sizes.maximum_m, 0.004);
    EXPECT_EQ(job.specimen.porosity, 0.1);
    EXPECT_FALSE(job.specimen.merge_length_m.has_value());
    EXPECT_EQ(job.variants.front().grain.E_Pa, 25.8e9);
    EXPECT_EQ(job.variants.front().grain.nu, 0.23);
    EXPECT_EQ(job.variants.front().grain.density_kg_m3, 2650.0);
    EXPECT_EQ(job.variants.front().contact.law, ContactLaw::bilinear);
    expect_table7(job.variants.front().contact);
    EXPECT_EQ(job.variants.front().numerics.kind, NumericsKind::adaptive);
    EXPECT_EQ(job.variants.front().numerics.accuracy, 0.005);
    ASSERT_EQ(job.tests.size(), 1u);
    EXPECT_EQ(job.tests[0].kind, methods::uniaxial_compression);
    EXPECT_EQ(job.seeds, (std::vector<std::uint64_t>{1, 2, 3, 4, 5}));
    EXPECT_EQ(job.threads, 0);
    EXPECT_EQ(job.at_once, 0);
    EXPECT_EQ(job.laboratory.at("UCS"), 122.1e6);
}

TEST(Job, DefaultsAreThoseOfTheSpecs) {
    const Job job = parse_job(R"(
        specimen = { shape = "disc", diameter = "80 mm", grains = { diameter = { distribution = "uniform", minimum = "2 mm", maximum = "4 mm" } } }
        material.grain = { E = "25.8 GPa", nu = 0.23 }
        material.contact = { Kn = "18e4 GPa/m", kratio = 4, sigma_nt = "8.5 MPa", tau = "29.75 MPa", mu = 0, Gfn = "20 J/m2", Gfs = "800 J/m2" }
        test = [ { kind = "brazilian" } ]
    )",
                              "minimal");
    EXPECT_EQ(job.name, "minimal");
    EXPECT_EQ(job.variants.front().contact.eta, 0.25);
    EXPECT_EQ(job.specimen.porosity, SpecimenSpec{}.porosity);
    EXPECT_EQ(job.specimen.thickness_m, SpecimenSpec{}.thickness_m);
    EXPECT_EQ(job.variants.front().grain.density_kg_m3, GrainMaterial{}.density_kg_m3);
    EXPECT_EQ(job.variants.front().numerics.accuracy, NumericsSpec{}.accuracy);
    EXPECT_EQ(job.tests[0].stop_fraction, TestSpec{}.stop_fraction);
    EXPECT_EQ(job.seeds, (std::vector<std::uint64_t>{1}));
    ASSERT_TRUE(job.tests[0].specimen);
    EXPECT_EQ(job.tests[0].specimen->outline.shape, Shape::disc);
    EXPECT_EQ(job.tests[0].specimen->outline.diameter_m, 0.08);
}

TEST(Job, CompressionIsFollowedBehindThePeakUnlessTold) {
    const auto control = [](const std::string& text) { return parse_job(text, "job.toml").tests.front().control; };
    EXPECT_EQ(control(sample_job), LoadControl::dissipation);
    EXPECT_EQ(control(edited("kind = \"uniaxial-compression\"", "kind = \"direct-tension\"")), LoadControl::displacement);
    for (const LoadControl each : load_controls)
        EXPECT_EQ(control(edited("kind = \"uniaxial-compression\"",
                                 std::string("kind = \"uniaxial-compression\"\ncontrol = \"") + name(each) + "\"")),
                  each);
    EXPECT_EQ(control(edited("kind = \"adaptive\"\naccuracy = \"0.5 %\"", "kind = \"paper\"")), LoadControl::displacement)
        << "a fixed speed follows nothing";
}

TEST(Job, OwnSpecimensAreCheckedAsThoseOfJobs) {
    const auto problem = [](const std::string& test) {
        try {
            parse_job(edited("kind = \"uniaxial-compression\"", test), "job");
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(
        problem("kind = \"three-point-bend\"\nspecimen = { shape = \"disc\", diameter = \"80 mm\" }").find("a disc is no beam"),
        std::string::npos);
    EXPECT_NE(problem("kind = \"three-point-bend\"\nspecimen = { shape = \"rectangle\", width = \"220 mm\" }").find("height"),
              std::string::npos);
    EXPECT_NE(
        problem("kind = \"uniaxial-compression\"\nspecimen = { shape = \"rectangle\", width = \"5 mm\", height = \"10 mm\" }")
            .find("do not fit"),
        std::string::npos);
    EXPECT_NE(problem("kind = \"brazilian\"\nspecimen = { shape = \"disc\", diameter = \"50 mm\" }").find("cuts its own disc"),
              std::string::npos);
    EXPECT_NE(problem("kind = \"uniaxial-compression\"\nspecimen = { shape = \"rectangle\", width = \"40 mm\", height = \"80 "
                      "mm\", grain = 3 }")
                  .find("grain"),
              std::string::npos);
}

TEST(Job, BrazilianDiscHasTheSpecimensWidthUnlessTold) {
    const Job usual = parse_job(edited("kind = \"uniaxial-compression\"", "kind = \"brazilian\""), "job");
    EXPECT_EQ(usual.tests[0].specimen->outline.diameter_m, 0.08);
    EXPECT_EQ(usual.tests[0].specimen->grain_sizes.maximum_m, 0.004);
    const Job told =
        parse_job(edited("kind = \"uniaxial-compression\"", "kind = \"brazilian\"\ndiameter = \"50 mm\"\nplate_mu = 0.2"), "job");
    EXPECT_EQ(told.tests[0].specimen->outline.diameter_m, 0.05);
    EXPECT_EQ(told.tests[0].plate_mu, 0.2);
}

TEST(Job, AListOfSigma3IsAListOfTests) {
    const Job job = parse_job(
        edited("kind = \"uniaxial-compression\"", "kind = \"biaxial\"\nsigma3 = [\"4 MPa\", \"10 MPa\"]\nseeds = [2, 3]"), "job");
    ASSERT_EQ(job.tests.size(), 2u);
    EXPECT_EQ(job.tests[0].sigma3_Pa, 4e6);
    EXPECT_EQ(job.tests[1].sigma3_Pa, 10e6);
    EXPECT_EQ(job.tests[1].seeds, (std::vector<unsigned long long>{2, 3}));
}

TEST(Job, ReadsEverySizeDistributionAndOutline) {
    const std::string uniform = R"({ distribution = "uniform", minimum = "2 mm", maximum = "4 mm" })";
    const Job normal = parse_job(
        edited(
            uniform,
            R"({ distribution = "log-normal", median = "3 mm", log_standard_deviation = 0.2, minimum = "2 mm", maximum = "5 mm" })"),
        "job");
    EXPECT_EQ(normal.specimen.grain_sizes.kind, GrainSizeKind::log_normal);
    EXPECT_EQ(normal.specimen.grain_sizes.median_m, 0.003);
    const Job sieve = parse_job(
        edited(uniform, R"({ distribution = "sieve", curve = [["2 mm", 0], ["3 mm", "40 %"], ["4 mm", "100 %"]] })"), "job");
    ASSERT_EQ(sieve.specimen.grain_sizes.sieve.size(), 3u);
    EXPECT_EQ(sieve.specimen.grain_sizes.sieve[1].passing, 0.4);
    const Job polygon = parse_job(edited("shape = \"rectangle\"\nwidth = \"80 mm\"\nheight = \"160 mm\"",
                                         "shape = \"polygon\"\nvertices = [[\"0 mm\", \"0 mm\"], [\"80 mm\", \"0 mm\"], [\"80 "
                                         "mm\", \"160 mm\"], [\"0 mm\", \"160 mm\"]]\n"
                                         "edge_labels = [\"bottom\", \"right\", \"top\", \"left\"]"),
                                  "job");
    ASSERT_EQ(polygon.specimen.outline.vertices_m.size(), 4u);
    EXPECT_EQ(polygon.specimen.outline.vertices_m[2], (Vec2{0.08, 0.16}));
    EXPECT_EQ(polygon.specimen.outline.edge_labels[2], "top");
}

const char* const holed_and_notched =
    "height = \"160 mm\"\n"
    "holes = [{ centre = [\"40 mm\", \"80 mm\"], diameter = \"16 mm\" }, { vertices = [[\"10 mm\", \"20 mm\"], [\"20 mm\", \"20 "
    "mm\"], [\"15 mm\", \"31.7 mm\"]], label = \"a \\\"wedge\\\"\" }]\n"
    "notches = [{ from = [\"0 mm\", \"140 mm\"], to = [\"20 mm\", \"140 mm\"], width = \"2 mm\" }, { from = [\"48 mm\", \"80 "
    "mm\"], to = [\"60.3 mm\", \"85 mm\"], width = \"0 mm\", label = \"wing\" }]\n"
    "labels = [{ name = \"load\", at = [\"40 mm\", \"160 mm\"], within = \"3 mm\" }, { name = \"left-end\", box = [[\"0 mm\", "
    "\"0 mm\"], [\"1 mm\", \"80 mm\"]] }, "
    "{ name = \"base\", line = [[\"0 mm\", \"0 mm\"], [\"80 mm\", \"0 mm\"]] }]";

TEST(Job, HolesNotchesAndLabelsByPlace) {
    const OutlineSpec outline = parse_job(edited("height = \"160 mm\"", holed_and_notched), "job").specimen.outline;
    ASSERT_EQ(outline.holes.size(), 2U);
    EXPECT_EQ(outline.holes[0].centre_m, (Vec2{0.04, 0.08}));
    EXPECT_EQ(outline.holes[0].diameter_m, 0.016);
    EXPECT_EQ(outline.holes[1].vertices_m[2], (Vec2{0.015, 0.0317}));
    EXPECT_EQ(outline.holes[1].label, "a \"wedge\"");
    ASSERT_EQ(outline.notches.size(), 2U);
    EXPECT_EQ(outline.notches[0].to_m, (Vec2{0.02, 0.14}));
    EXPECT_EQ(outline.notches[0].width_m, 0.002);
    EXPECT_EQ(outline.notches[1].width_m, 0.0);
    EXPECT_EQ(outline.notches[1].label, "wing");
    ASSERT_EQ(outline.labels.size(), 3U);
    EXPECT_EQ(outline.labels[0].kind, PlaceKind::disc);
    EXPECT_EQ(outline.labels[0].within_m, 0.003);
    EXPECT_EQ(outline.labels[1].kind, PlaceKind::box);
    EXPECT_EQ(outline.labels[1].b_m, (Vec2{0.001, 0.08}));
    EXPECT_EQ(outline.labels[2].kind, PlaceKind::line);
    EXPECT_EQ(outline.labels[2].within_m, 1e-5);
}

TEST(Job, StagesAreReadAsTheyStandAndWrittenBack) {
    const std::string text = edited("kind = \"uniaxial-compression\"\n", custom_test_in_stages);
    const Job job = parse_job(text, "job");
    const std::vector<StageGroup>& groups = job.tests.front().stages;
    ASSERT_EQ(groups.size(), 10U);
    EXPECT_EQ(groups[0].stages.front(), (StageSpec{.kind = StageKind::load, .end = StageEnd::stress, .value = 2e6}));
    EXPECT_EQ(groups[1].stages.front().travel_times, 5.0);
    EXPECT_EQ(groups[2].stages.front().travel_times, std::nullopt);
    EXPECT_EQ(groups[3].stages.front().value, 1e3);
    EXPECT_EQ(groups[5].stages.front(), (StageSpec{.kind = StageKind::unload, .end = StageEnd::stress}));
    EXPECT_EQ(groups[6].stages.front().counts, StageValue::changed);
    EXPECT_EQ(groups[8].times, 3);
    EXPECT_EQ(groups[8].stages.front(),
              (StageSpec{
                  .kind = StageKind::load, .end = StageEnd::gauge, .value = 1e-5, .counts = StageValue::beyond, .gauge = "gap"}));
    EXPECT_EQ(groups[9].times, 0);
    EXPECT_EQ(parse_job(resolved_toml(job), "job").tests.front().stages, groups);
}

TEST(Job, APressureListIsOneMultiStageTest) {
    const Job job = parse_job(
        edited("kind = \"uniaxial-compression\"", "kind = \"multi-stage-biaxial\"\nsigma3 = [\"2 MPa\", \"5 MPa\", \"10 MPa\"]"),
        "job");
    ASSERT_EQ(job.tests.size(), 1U);
    EXPECT_EQ(job.tests.front().sigma3_Pa, 2e6);
    EXPECT_EQ(job.tests.front().later_sigma3_Pa, (std::vector<double>{5e6, 10e6}));
    EXPECT_EQ(stages_of(job.tests.front()).size(), 5U);
}

TEST(Job, MergeLengthIsAutoNoneOrALength) {
    EXPECT_EQ(parse_job(edited("merge_length = \"auto\"", "merge_length = \"none\""), "job").specimen.merge_length_m, 0.0);
    EXPECT_EQ(parse_job(edited("merge_length = \"auto\"", "merge_length = \"0.25 mm\""), "job").specimen.merge_length_m, 0.00025);
}

TEST(Job, EachNumericsHasItsOwnKeys) {
    const Job paper = parse_job(edited("kind = \"adaptive\"\naccuracy = \"0.5 %\"",
                                       "kind = \"paper\"\nspeed = \"6.25e-9 m\"\ndamping = 0.5\nmass_factor = 1.7"),
                                "job");
    EXPECT_EQ(paper.variants.front().numerics.speed_m, 6.25e-9);
    EXPECT_EQ(paper.variants.front().numerics.damping, 0.5);
    EXPECT_EQ(paper.variants.front().numerics.mass_factor, 1.7);
    const Job dynamic = parse_job(edited("kind = \"adaptive\"\naccuracy = \"0.5 %\"",
                                         "kind = \"dynamic\"\nspeed = \"50 mm/s\"\ntime_step = \"10 ns\"\nmaximum_steps = 1000"),
                                  "job");
    EXPECT_EQ(dynamic.variants.front().numerics.speed_m, 0.05);
    EXPECT_EQ(dynamic.variants.front().numerics.time_step_s, 1e-8);
    EXPECT_EQ(dynamic.variants.front().numerics.maximum_steps, 1000);
    const Job expert = parse_job(edited("accuracy = \"0.5 %\"", "residual_target = 0.003\nconfirm = true"), "job");
    EXPECT_EQ(expert.variants.front().numerics.residual_target, 0.003);
    EXPECT_TRUE(expert.variants.front().numerics.confirm);
    for (const char* accuracy : {"\"0.05 %\"", "\"10 %\"", "0.0005", "0.1"})
        EXPECT_NO_THROW(parse_job(edited("\"0.5 %\"", accuracy), "job")) << accuracy;
}

TEST(Job, LaboratoryValuesHaveOneNameInside) {
    const Job job =
        parse_job(edited("UCS = \"122.1 MPa\"", "E = \"25.8 GPa\"\nc = \"21 MPa\"\nphi = \"45 deg\"\nmi = 20"), "job");
    EXPECT_EQ(job.laboratory.at("cohesion"), 21e6);
    EXPECT_DOUBLE_EQ(job.laboratory.at("friction_angle"), std::numbers::pi / 4);
    EXPECT_EQ(job.laboratory.at("hoek_brown_mi"), 20.0);
}

TEST(Job, LaboratoryStrengthsUnderConfinement) {
    const Job job =
        parse_job(edited("UCS = \"122.1 MPa\"", "confined = [[\"4 MPa\", \"150 MPa\"], [\"10 MPa\", \"0.195 GPa\"]]"), "job");
    ASSERT_EQ(job.laboratory_confined.size(), 2u);
    EXPECT_EQ(job.laboratory_confined[0].sigma3_Pa, 4e6);
    EXPECT_EQ(job.laboratory_confined[1].sigma1_Pa, 195e6);
    const Job again = parse_job(resolved_toml(job), "again");
    ASSERT_EQ(again.laboratory_confined.size(), 2u);
    EXPECT_EQ(again.laboratory_confined[1].sigma3_Pa, 10e6);
}

TEST(Job, AByteOrderMarkAndWindowsLineEndsAreFine) {
    std::string text = "\xEF\xBB\xBF";
    for (char c : sample_job) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_EQ(parse_job(text, "job").variants.front().grain.E_Pa, 25.8e9);
}

void expect_same(const OutlineSpec& a, const OutlineSpec& b) {
    EXPECT_EQ(a.shape, b.shape);
    EXPECT_EQ(a.width_m, b.width_m);
    EXPECT_EQ(a.height_m, b.height_m);
    EXPECT_EQ(a.diameter_m, b.diameter_m);
    EXPECT_EQ(a.flat_angle_rad, b.flat_angle_rad);
    EXPECT_EQ(a.vertices_m, b.vertices_m);
    EXPECT_EQ(a.edge_labels, b.edge_labels);
    EXPECT_EQ(a.hole_diameter_m, b.hole_diameter_m);
    ASSERT_EQ(a.holes.size(), b.holes.size());
    for (std::size_t i = 0; i < a.holes.size(); ++i) {
        EXPECT_EQ(a.holes[i].centre_m, b.holes[i].centre_m);
        EXPECT_EQ(a.holes[i].diameter_m, b.holes[i].diameter_m);
        EXPECT_EQ(a.holes[i].vertices_m, b.holes[i].vertices_m);
        EXPECT_EQ(a.holes[i].label, b.holes[i].label);
    }
    ASSERT_EQ(a.notches.size(), b.notches.size());
    for (std::size_t i = 0; i < a.notches.size(); ++i) {
        EXPECT_EQ(a.notches[i].from_m, b.notches[i].from_m);
        EXPECT_EQ(a.notches[i].to_m, b.notches[i].to_m);
        EXPECT_EQ(a.notches[i].width_m, b.notches[i].width_m);
        EXPECT_EQ(a.notches[i].label, b.notches[i].label);
    }
    ASSERT_EQ(a.labels.size(), b.labels.size());
    for (std::size_t i = 0; i < a.labels.size(); ++i) {
        EXPECT_EQ(a.labels[i].name, b.labels[i].name);
        EXPECT_EQ(a.labels[i].kind, b.labels[i].kind);
        EXPECT_EQ(a.labels[i].a_m, b.labels[i].a_m);
        EXPECT_EQ(a.labels[i].b_m, b.labels[i].b_m);
        EXPECT_EQ(a.labels[i].within_m, b.labels[i].within_m);
    }
}

void expect_same(const SpecimenSpec& a, const SpecimenSpec& b) {
    expect_same(a.outline, b.outline);
    EXPECT_EQ(a.thickness_m, b.thickness_m);
    EXPECT_EQ(a.grain_sizes.kind, b.grain_sizes.kind);
    EXPECT_EQ(a.grain_sizes.minimum_m, b.grain_sizes.minimum_m);
    EXPECT_EQ(a.grain_sizes.maximum_m, b.grain_sizes.maximum_m);
    EXPECT_EQ(a.grain_sizes.median_m, b.grain_sizes.median_m);
    EXPECT_EQ(a.grain_sizes.log_standard_deviation, b.grain_sizes.log_standard_deviation);
    ASSERT_EQ(a.grain_sizes.sieve.size(), b.grain_sizes.sieve.size());
    for (std::size_t i = 0; i < a.grain_sizes.sieve.size(); ++i) {
        EXPECT_EQ(a.grain_sizes.sieve[i].diameter_m, b.grain_sizes.sieve[i].diameter_m);
        EXPECT_EQ(a.grain_sizes.sieve[i].passing, b.grain_sizes.sieve[i].passing);
    }
    EXPECT_EQ(a.porosity, b.porosity);
    EXPECT_EQ(a.merge_length_m, b.merge_length_m);
    EXPECT_EQ(a.triangles_per_grain, b.triangles_per_grain);
    EXPECT_EQ(a.particles_per_grain, b.particles_per_grain);
}

void expect_same(const Variant& a, const Variant& b) {
    SCOPED_TRACE(a.name);
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.stem, b.stem);
    EXPECT_EQ(a.seeds, b.seeds);
    EXPECT_EQ(a.tests, b.tests);

    EXPECT_EQ(a.model.kind, b.model.kind);
    EXPECT_EQ(a.model.normal, b.model.normal);
    EXPECT_EQ(a.model.contact, b.model.contact);
    EXPECT_EQ(a.model.plane, b.model.plane);
    EXPECT_EQ(a.grain.E_Pa, b.grain.E_Pa);
    EXPECT_EQ(a.grain.nu, b.grain.nu);
    EXPECT_EQ(a.grain.density_kg_m3, b.grain.density_kg_m3);
    EXPECT_EQ(a.contact.law, b.contact.law);
    EXPECT_EQ(a.contact.Kn_Pa_m, b.contact.Kn_Pa_m);
    EXPECT_EQ(a.contact.eta, b.contact.eta);
    EXPECT_EQ(a.contact.sigma_nt_Pa, b.contact.sigma_nt_Pa);
    EXPECT_EQ(a.contact.tau_Pa, b.contact.tau_Pa);
    EXPECT_EQ(a.contact.mu, b.contact.mu);
    EXPECT_EQ(a.contact.Gfn_J_m2, b.contact.Gfn_J_m2);
    EXPECT_EQ(a.contact.Gfs_J_m2, b.contact.Gfs_J_m2);
    EXPECT_EQ(a.contact.shear_measure, b.contact.shear_measure);
    EXPECT_EQ(a.contact.tension_unloading, b.contact.tension_unloading);
    EXPECT_EQ(a.numerics.kind, b.numerics.kind);
    EXPECT_EQ(a.numerics.accuracy, b.numerics.accuracy);
    EXPECT_EQ(a.numerics.residual_target, b.numerics.residual_target);
    EXPECT_EQ(a.numerics.damping, b.numerics.damping);
    EXPECT_EQ(a.numerics.speed_m, b.numerics.speed_m);
    EXPECT_EQ(a.numerics.mass_factor, b.numerics.mass_factor);
    EXPECT_EQ(a.numerics.time_step_s, b.numerics.time_step_s);
    EXPECT_EQ(a.numerics.maximum_steps, b.numerics.maximum_steps);
    EXPECT_EQ(a.numerics.confirm, b.numerics.confirm);
}

void expect_same(const Job& a, const Job& b) {
    EXPECT_EQ(a.name, b.name);
    expect_same(a.specimen, b.specimen);
    ASSERT_EQ(a.variants.size(), b.variants.size());
    for (std::size_t i = 0; i < a.variants.size(); ++i) expect_same(a.variants[i], b.variants[i]);
    ASSERT_EQ(a.tests.size(), b.tests.size());
    for (std::size_t i = 0; i < a.tests.size(); ++i) {
        EXPECT_EQ(a.tests[i].kind, b.tests[i].kind);
        EXPECT_EQ(a.tests[i].sigma3_Pa, b.tests[i].sigma3_Pa);
        EXPECT_EQ(a.tests[i].stop_fraction, b.tests[i].stop_fraction);
        EXPECT_EQ(a.tests[i].maximum_strain, b.tests[i].maximum_strain);
        EXPECT_EQ(a.tests[i].maximum_stress_Pa, b.tests[i].maximum_stress_Pa);
        EXPECT_EQ(a.tests[i].plate_stiffness_factor, b.tests[i].plate_stiffness_factor);
        EXPECT_EQ(a.tests[i].plate_Kn_Pa_m, b.tests[i].plate_Kn_Pa_m);
        EXPECT_EQ(a.tests[i].plates, b.tests[i].plates);
        EXPECT_EQ(a.tests[i].jaw_radius, b.tests[i].jaw_radius);
        EXPECT_EQ(a.tests[i].plate_mu, b.tests[i].plate_mu);
        EXPECT_EQ(a.tests[i].membrane_plates, b.tests[i].membrane_plates);
        EXPECT_EQ(a.tests[i].snapshots, b.tests[i].snapshots);
        EXPECT_EQ(a.tests[i].seeds, b.tests[i].seeds);
        EXPECT_EQ(a.tests[i].own, b.tests[i].own);
        ASSERT_EQ(a.tests[i].specimen.has_value(), b.tests[i].specimen.has_value());
        if (a.tests[i].specimen) expect_same(*a.tests[i].specimen, *b.tests[i].specimen);
    }
    EXPECT_EQ(a.seeds, b.seeds);
    EXPECT_EQ(a.threads, b.threads);
    EXPECT_EQ(a.at_once, b.at_once);
    EXPECT_EQ(a.laboratory, b.laboratory);
}

void expect_round_trip(const std::string& text, const std::string& name = "round trip") {
    const Job first = parse_job(text, name);
    const std::string written = resolved_toml(first);
    SCOPED_TRACE(written);
    Job second;
    ASSERT_NO_THROW(second = parse_job(written, "resolved"));
    expect_same(first, second);
    EXPECT_EQ(resolved_toml(second), written);
}

TEST(ResolvedJob, ReadsBackToTheSameBits) {
    expect_round_trip(sample_job);
    expect_round_trip(edited("width = \"80 mm\"", "width = \"3.1 in\""));
    expect_round_trip(
        edited("law = \"bilinear\"", "law = \"linear\"\nshear_measure = \"beyond-friction\"\ntension_unloading = \"secant\""));
    expect_round_trip(edited("eta = 0.28", "kratio = 3.7"));
    expect_round_trip(edited("merge_length = \"auto\"", "merge_length = \"none\"\ntriangles_per_grain = 40"));
    expect_round_trip(edited("merge_length = \"auto\"", "merge_length = \"0.123 mm\""));
    expect_round_trip(
        edited("kind = \"adaptive\"\naccuracy = \"0.5 %\"", "kind = \"paper\"\nspeed = \"6.25e-9 m\"\nmaximum_steps = 123456"));
    expect_round_trip(
        edited("kind = \"adaptive\"\naccuracy = \"0.5 %\"", "kind = \"dynamic\"\nspeed = \"0.07 m/s\"\ntime_step = \"9.9 ns\""));
    expect_round_trip(edited("accuracy = \"0.5 %\"", "residual_target = 3.3e-3"));
    expect_round_trip(
        edited("kind = \"uniaxial-compression\"",
               "kind = \"brazilian\"\ndiameter = \"51 mm\"\nplate_stiffness_factor = 0.1\nplate_mu = 0.33\n[[test]]\nkind = "
               "\"biaxial\"\nsigma3 = [\"4 MPa\", \"1234 psi\"]\nseeds = [7, 9]\nstop_fraction = \"65 %\"\nmaximum_stress = "
               "\"300 MPa\""));
    expect_round_trip(edited("kind = \"uniaxial-compression\"", "kind = \"brazilian\"\nplate_Kn = \"3.6e3 GPa/m\""));
    expect_round_trip(edited("kind = \"uniaxial-compression\"", "kind = \"brazilian\"\nplates = \"curved\"\njaw_radius = 1.25"));
    expect_round_trip(
        edited("kind = \"uniaxial-compression\"", "kind = \"brazilian\"\ndisc = \"flattened\"\nflat_angle = \"25 deg\""));
    expect_round_trip(edited("height = \"160 mm\"", holed_and_notched));
    expect_round_trip(edited("shape = \"rectangle\"\nwidth = \"80 mm\"\nheight = \"160 mm\"",
                             "shape = \"polygon\"\nvertices = [[\"0 mm\", \"0 mm\"], [\"80 mm\", \"0 mm\"], [\"80 mm\", \"160 "
                             "mm\"], [\"0 mm\", \"160 mm\"]]\n"
                             "edge_labels = [\"bottom\", \"right\", \"top\", \"left\"]\narcs = [{ edge = 1, through = [\"60 "
                             "mm\", \"80 mm\"] }, { edge = 3, through = [\"20 mm\", \"80 mm\"] }]"));
    expect_round_trip(edited("seeds = [1, 2, 3, 4, 5]", "seed = 9223372036854775807\nthreads = 3\nat_once = 2"));
    expect_round_trip(edited("UCS = \"122.1 MPa\"", "phi = \"53 deg\"\nmi = 21.5\nnu = 0.23\nE = \"25.8 GPa\""));
    expect_round_trip(edited("law = \"bilinear\"", "law = \"brittle\"", edited("Gfn = \"20 N/m\"\nGfs = \"800 N/m\"\n", "")));
    expect_round_trip(edited("shape = \"rectangle\"\nwidth = \"80 mm\"\nheight = \"160 mm\"",
                             "shape = \"polygon\"\nvertices = [[\"-1 mm\", \"0.3 mm\"], [\"80 mm\", \"0 mm\"], [\"80 mm\", "
                             "\"161.7 mm\"], [\"0 mm\", \"160 mm\"]]\n"
                             "edge_labels = [\"bottom\", \"say \\\"right\\\"\", \"top\", \"le\\\\ft\"]"));
    expect_round_trip(
        edited("{ distribution = \"uniform\", minimum = \"2 mm\", maximum = \"4 mm\" }",
               "{ distribution = \"sieve\", curve = [[\"2.1 mm\", 0], [\"3.3 mm\", \"41.7 %\"], [\"4 mm\", 1.0]] }"));
    expect_round_trip(edited("{ distribution = \"uniform\", minimum = \"2 mm\", maximum = \"4 mm\" }",
                             "{ distribution = \"log-normal\", median = \"3.14 mm\", log_standard_deviation = 0.217, minimum = "
                             "\"2 mm\", maximum = \"5 mm\" }"));
}

TEST(ResolvedJob, OfAnUnevenRockReadsBackToTheSameBits) {
    const std::string uneven = edited("[numerics]", uneven_material);
    expect_round_trip(uneven);
    expect_round_trip(edited("modulus = 1.6", "variation = \"40 %\"", uneven));
    const Job job = parse_job(uneven, "job.toml");
    const Heterogeneity& rock = job.variants.front().rock;
    ASSERT_EQ(rock.minerals.phases.size(), 2U);
    EXPECT_EQ(rock.minerals.phases[1].grain.E_Pa, 25.8e9);  // that of [material.grain]
    EXPECT_EQ(rock.minerals.phases[1].value, 7);
    EXPECT_EQ(rock.scatter[Scattered::strength].highest, 4.0);
    EXPECT_EQ(rock.scatter[Scattered::E].lowest, 0.05);
    EXPECT_FALSE(rock.scatter[Scattered::tau].scatters());
    ASSERT_EQ(rock.joints.size(), 2U);
    EXPECT_EQ(rock.joints[0].contact.tau_Pa, 0.0);
    EXPECT_EQ(rock.joints[0].contact.Kn_Pa_m, 18e13);
    EXPECT_NEAR(rock.joints[1].set->dip_rad, 0.5235987755982988, 1e-15);
    const double voigt = 0.6 * 94.5 + 0.4 * 25.8, reuss = 1.0 / (0.6 / 94.5 + 0.4 / 25.8);
    EXPECT_NEAR(job.variants.front().grain.E_Pa / 1e9, 0.5 * (voigt + reuss), 1e-9);  // what estimates reckon with
}

// Minerals with sizes of their own: those without take the specimen's, and the specimen knows all of them.
TEST(ResolvedJob, OfMineralsWithSizesReadsBackToTheSameBits) {
    const std::string quartz = "diameter = { distribution = \"uniform\", minimum = \"1 mm\", maximum = \"2 mm\" }\n";
    const std::string biotite =
        "diameter = { distribution = \"sieve\", curve = [[\"0.5 mm\", 0], [\"0.9 mm\", \"41.7 %\"], [\"1.3 mm\", 1.0]] }\n";
    std::string text = edited("cluster_length = \"7 mm\"\n", "", edited("[numerics]", uneven_material));
    text = edited("colour = \"#d9d4c7\"\n", "colour = \"#d9d4c7\"\n" + quartz, text);
    expect_round_trip(text);
    const Job some = parse_job(text, "job.toml");
    ASSERT_EQ(some.specimen.phase_sizes.size(), 2U);
    EXPECT_EQ(some.specimen.phase_sizes[0].sizes.minimum_m, 0.001);
    EXPECT_EQ(some.specimen.phase_sizes[0].share, 0.6);
    EXPECT_EQ(some.specimen.phase_sizes[1].sizes.maximum_m, 0.004) << "that of [specimen.grains]";
    text = edited("diameter = { distribution = \"uniform\", minimum = \"2 mm\", maximum = \"4 mm\" }\n", "",
                  edited("value = 7\n", "value = 7\n" + biotite, text));
    expect_round_trip(text);
    const Job all = parse_job(text, "job.toml");
    EXPECT_EQ(all.specimen.phase_sizes[1].sizes.sieve.size(), 3U);
    EXPECT_EQ(largest_of(all.specimen.grain_sizes), 0.002);
    expect_round_trip(edited("mu = 0.5\n", "phi = \"30 deg\"\ndilation = \"30 deg\"\ndilation_slip = \"0.7 mm\"\n", text));
}

TEST(ReadJob, VariantsThatShareAPackingHaveTheSameMineralsInIt) {
    const std::string quartz = "diameter = { distribution = \"uniform\", minimum = \"1 mm\", maximum = \"2 mm\" }\n";
    std::string text = edited("cluster_length = \"7 mm\"\n", "", edited("[numerics]", uneven_material));
    text = edited("colour = \"#d9d4c7\"\n", "colour = \"#d9d4c7\"\n" + quartz, text);
    const auto with = [&](const std::string& share, const std::string& rest) {
        return text +
               "\n[[variant]]\nname = \"as it is\"\n[[variant]]\nname = \"other\"\n[[variant.material.phase]]\nname = "
               "\"quartz\"\nshare = " +
               share + "\n" + quartz + "[[variant.material.phase]]\nname = \"biotite\"\nshare = " + rest + "\n";
    };
    EXPECT_EQ(parse_job(with("0.6", "0.4"), "job.toml").specimen.phase_sizes.size(), 2U);
    try {
        parse_job(with("0.3", "0.7"), "job.toml");
        ADD_FAILURE() << "is taken";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("differ in the minerals of which their packing is made"), std::string::npos)
            << error.what();
    }
}

TEST(ResolvedJob, OfARockFromFilesReadsBackToTheSameBits) {
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "traces.csv") << "x1,y1,x2,y2,set\n10,10,40,60,a\n# a remark\n5,5,9,9,b\n0,20,30,20,a\n";
    std::ofstream(folder.path() / "minerals.txt") << "quartz\nbiotite # dark\n\nquartz\n";
    std::ofstream(folder.path() / "job.toml")
        << edited("cluster_length = \"7 mm\"", "list = \"minerals.txt\"",
                  edited("trace = [[\"0 mm\", \"20 mm\"], [\"40 mm\", \"60 mm\"], [\"80 mm\", \"70 mm\"]]",
                         "file = \"traces.csv\"\nunit = \"mm\"\nlayer = \"a\"", edited("[numerics]", uneven_material)));
    const Job job = read_job(folder.path() / "job.toml");
    const Heterogeneity& rock = job.variants.front().rock;
    EXPECT_EQ(rock.minerals.list, (std::vector<int>{0, 1, 0}));
    ASSERT_EQ(rock.joints[0].lines_m.size(), 2U);
    EXPECT_EQ(rock.joints[0].lines_m[1], (std::vector<Vec2>{{0.0, 0.02}, {0.03, 0.02}}));
    ASSERT_EQ(rock.remarks.size(), 1U);  // the trace of the other set
    EXPECT_FALSE(rock.files.empty());
    EXPECT_EQ(resolved_toml(parse_job(resolved_toml(job), "resolved")), resolved_toml(job));
}

TEST(TraceFiles, OfDxfHaveLinesAndPolylines) {
    const std::string head = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
    const std::string line = "0\nLINE\n8\njoints\n10\n1.0\n20\n2.0\n11\n3.0\n21\n4.0\n";
    const std::string lwpolyline = "0\nLWPOLYLINE\n8\nfaults\n90\n3\n70\n1\n10\n0\n20\n0\n10\n5\n20\n0\n10\n5\n20\n5\n";
    const std::string polyline = "0\nPOLYLINE\n8\njoints\n70\n0\n0\nVERTEX\n10\n7\n20\n7\n0\nVERTEX\n10\n8\n20\n16\n0\nSEQEND\n";
    const std::string end = "0\nENDSEC\n0\nEOF\n";
    const TraceFile all =
        read_traces(head + line + lwpolyline + polyline + "0\nTEXT\n8\njoints\n1\nhello\n" + end, "a.dxf", "", "");
    ASSERT_EQ(all.lines_m.size(), 3U);
    EXPECT_EQ(all.lines_m[0], (std::vector<Vec2>{{0.001, 0.002}, {0.003, 0.004}}));
    EXPECT_EQ(all.lines_m[1].size(), 4U);  // closed
    EXPECT_EQ(all.lines_m[2], (std::vector<Vec2>{{0.007, 0.007}, {0.008, 0.016}}));
    EXPECT_EQ(all.remarks.size(), 1U);
    EXPECT_EQ(read_traces(head + line + lwpolyline + end, "a.dxf", "cm", "joints").lines_m,
              (std::vector<std::vector<Vec2>>{{{0.01, 0.02}, {0.03, 0.04}}}));
    EXPECT_THROW(read_traces("0\nSECTION\n2\nENTITIES\n" + line + end, "a.dxf", "", ""), InputError);  // no unit
    EXPECT_THROW(read_traces(head + end, "a.dxf", "", ""), InputError);                                // no trace
    EXPECT_THROW(read_traces("x1,y1,x2\n1,2,3\n", "a.csv", "", ""), InputError);
    EXPECT_THROW(read_traces("x1,y1,x2,y2\n1,2,3,four\n", "a.csv", "", ""), InputError);
    EXPECT_THROW(read_traces("", "a.txt", "", ""), InputError);
    EXPECT_THROW(read_traces("x1,x1,x1,y1,x2,y2\n0,1,2,3\n", "a.csv", "", ""), InputError);  // columns beyond the row
    EXPECT_THROW(read_traces("x1,y1,x2,y2\n0,0,1e308,0\n", "a.csv", "km", ""), InputError);  // no number of metres
    const std::string twice = "0\nLWPOLYLINE\n8\nfaults\n70\n1e300\n10\n0\n20\n0\n10\n0\n20\n0\n10\n5\n20\n5\n";
    EXPECT_EQ(read_traces(head + twice + end, "a.dxf", "", "").lines_m.front(), (std::vector<Vec2>{{0.0, 0.0}, {0.005, 0.005}}));
    EXPECT_THROW(read_traces(head + "0\nLINE\n10\n1\n20\n2\n11\n1\n21\n2\n" + end, "a.dxf", "", ""), InputError);  // a point
}

TEST(PhaseMaps, AreReadByColourOrByValue) {
    const auto png = [](const std::vector<png_byte>& pixels, std::uint32_t width, std::uint32_t height, std::uint32_t format) {
        png_image image{};
        image.version = PNG_IMAGE_VERSION;
        image.width = width;
        image.height = height;
        image.format = format;
        png_alloc_size_t size = 0;
        EXPECT_NE(png_image_write_to_memory(&image, nullptr, &size, 0, pixels.data(), 0, nullptr), 0);
        std::string text(size, '\0');
        EXPECT_NE(png_image_write_to_memory(&image, text.data(), &size, 0, pixels.data(), 0, nullptr), 0);
        return text;
    };
    std::vector<Mineral> minerals{{"a", 0.5, {}, 0x102030}, {"b", 0.5, {}, 0xff0000}};
    const std::string coloured = png({0x10, 0x20, 0x30, 0xff, 0, 0, 0, 0, 0, 0x10, 0x20, 0x30}, 2, 2, PNG_FORMAT_RGB);
    EXPECT_EQ(read_phase_map(coloured, "map.png", minerals)->phase, (std::vector<std::int8_t>{0, 1, -1, 0}));
    minerals[1].colour = 0x00ff00;
    EXPECT_THROW(read_phase_map(coloured, "map.png", minerals), InputError);  // a colour outside the legend
    minerals[0].value = 1;
    minerals[1].value = 2;
    EXPECT_EQ(read_phase_map(png({1, 2, 0, 2}, 2, 2, PNG_FORMAT_GRAY), "map.png", minerals)->phase,
              (std::vector<std::int8_t>{0, 1, -1, 1}));
    EXPECT_THROW(read_phase_map("no picture", "map.png", minerals), InputError);
    std::string claims_more = coloured;  // 20,000 x 20,000 pixels in some dozen bytes: refused before 1.2 GB are asked for
    for (const std::size_t at : {16U, 20U}) claims_more.replace(at, 4, std::string("\0\0\x4e\x20", 4));
    const std::uint32_t checksum =
        static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(claims_more.data()) + 12, 17));
    for (int i = 0; i < 4; ++i) claims_more[29 + static_cast<std::size_t>(i)] = static_cast<char>(checksum >> (24 - 8 * i));
    try {
        (void)read_phase_map(claims_more, "map.png", minerals);
        ADD_FAILURE() << "was read";
    } catch (const InputError& error) {
        EXPECT_NE(error.problem().find("cannot hold 20000 x 20000 pixels"), std::string::npos) << error.what();
    }
}

TEST(ResolvedJob, OfVariantsReadsBackToTheSameBits) {
    expect_round_trip(variant_job);
    expect_round_trip(edited("normal = \"edge\"", "normal = \"centres\"", variant_job));
    expect_round_trip(edited("maximum = \"4 mm\" }", "maximum = \"4 mm\" }\nparticles_per_grain = 13.7", variant_job));
    expect_round_trip(edited("kind = \"uniaxial-compression\"", pressed_test));
    expect_round_trip(edited(
        "kind = \"uniaxial-compression\"",
        "kind = \"direct-shear\"\nnormal_stress = [\"2 MPa\", \"5 MPa\"]\nnormal_stiffness = \"3 GPa/m\"\ngap = \"4 mm\""));
    expect_round_trip(
        edited("kind = \"uniaxial-compression\"", "kind = \"uniaxial-compression\"\nplate_mu = 0.2\nplate_Kn = \"50 GPa/m\""));
    expect_round_trip(edited("membrane_plates = 12", "plate_stiffness_factor = 0.3\nplate_mu = 0.1", variant_job));
    expect_round_trip(edited("[[test]]", "[[variant]]\nname = \"alone\"\n[[test]]"));
    expect_round_trip(edited("[material.grain]\nE = \"25.8 GPa\"\nnu = 0.23\n", "[material.grain]\n",
                             edited("kind = \"flexible\"", "kind = \"rigid\"")));
}

TEST(ReadJob, AGapGradedCurveIsTaken) {
    const Job job = parse_job(
        edited("{ distribution = \"uniform\", minimum = \"2 mm\", maximum = \"4 mm\" }",
               R"({ distribution = "sieve", curve = [["1 mm", "0 %"], ["2 mm", "40 %"], ["4 mm", "40 %"], ["5 mm", "100 %"]] })"),
        "job");
    ASSERT_EQ(job.specimen.grain_sizes.sieve.size(), 4u);
    EXPECT_EQ(job.specimen.grain_sizes.sieve[1].passing, job.specimen.grain_sizes.sieve[2].passing);
}

TEST(ReadJob, ASlenderColumnIsWarnedOf) {
    const auto column = [](const char* height) {
        return warnings(parse_job(edited("height = \"160 mm\"", std::string("height = \"") + height + " mm\""), "job"));
    };
    EXPECT_TRUE(column("240").empty()) << "three times as high as wide";
    EXPECT_TRUE(column("640").empty()) << "eight times";
    // E 25.8 GPa, UCS of the laboratory 122.1 MPa: pi sqrt(25800 / (12 x 122.1)) = 13.2; Euler's stress at 20: pi^2 25800 / (12 x
    // 400) = 53.05
    const auto sentences = column("1600");
    ASSERT_EQ(sentences.size(), 1u);
    for (const char* part :
         {"20 times as high as wide", "bends aside at 53 MPa", "strength of 122 MPa", "above height / width of 13.2"})
        EXPECT_NE(sentences.front().find(part), std::string::npos) << part << " in " << sentences.front();
}

TEST(Job, FrictionMayBeGivenByItsAngle) {
    EXPECT_NEAR(parse_job(edited("mu = 0.40", "phi = \"30 deg\""), "job").variants.front().contact.mu, 0.5773502691896258, 1e-15);
    EXPECT_NEAR(parse_job(edited("mu = 0.5\n", "phi = \"45 deg\"\n", edited("[numerics]", uneven_material)), "job")
                    .variants.front()
                    .rock.joints[0]
                    .contact.mu,
                1.0, 1e-15);
}

TEST(Warnings, NameWhatNoRockHas) {
    const auto told = [](const std::string& text, const char* key) {
        const std::vector<std::string> all = warnings(parse_job(text, "job"));
        return std::any_of(all.begin(), all.end(),
                           [&](const std::string& sentence) { return sentence.find(key) != std::string::npos; });
    };
    EXPECT_TRUE(warnings(parse_job(sample_job, "job")).empty());
    EXPECT_TRUE(told(edited("mu = 0.40", "mu = 30"), "mu = 30"));
    EXPECT_TRUE(told(edited("eta = 0.28", "eta = 3"), "eta = 3"));
    EXPECT_TRUE(told(edited("Gfn = \"20 N/m\"", "Gfn = \"5000 N/m\""), "Gfn = 5000 N/m"));
    EXPECT_TRUE(told(edited("[numerics]", "[material.scatter]\nstrength = { modulus = 1.3 }\n[numerics]"), "cut-off"));
    EXPECT_FALSE(
        told(edited("[numerics]", "[material.scatter]\nstrength = { modulus = 1.3, lowest = 0.1 }\n[numerics]"), "cut-off"));
}

TEST(Warnings, NameADirectionThatDoesNotSoften) {
    EXPECT_TRUE(warnings(parse_job(sample_job, "job")).empty());
    const auto said = [](const std::vector<std::string>& sentences, const char* what) {
        return std::any_of(sentences.begin(), sentences.end(),
                           [&](const std::string& s) { return s.find(what) != std::string::npos; });
    };
    const auto soft = warnings(parse_job(edited("Kn = \"18.00e4 GPa/m\"", "Kn = \"1 GPa/m\""), "job"));  // sigma_nt / Kn = 8.5 mm
    EXPECT_TRUE(said(soft, "sigma_nt / Kn"));
    EXPECT_TRUE(said(soft, "tau / (eta Kn)"));
    EXPECT_FALSE(said(soft, "sigma_nt d / E"));
    // 8.5^2 / (2 x 18e4) MPa^2 m/GPa = 0.2007 N/m; 29.75^2 / (2 x 0.28 x 18e4) = 8.78 N/m
    EXPECT_TRUE(
        warnings(
            parse_job(edited("Gfn = \"20 N/m\"", "Gfn = \"0.202 N/m\"", edited("Gfs = \"800 N/m\"", "Gfs = \"8.8 N/m\"")), "job"))
            .empty());
    const auto tension = warnings(parse_job(edited("Gfn = \"20 N/m\"", "Gfn = \"0.2 N/m\""), "job"));
    ASSERT_EQ(tension.size(), 1u);
    EXPECT_NE(tension[0].find("Gfn = 0.2 N/m"), std::string::npos) << tension[0];
    const auto shear = warnings(parse_job(edited("Gfs = \"800 N/m\"", "Gfs = \"8.7 N/m\""), "job"));
    ASSERT_EQ(shear.size(), 1u);
    EXPECT_NE(shear[0].find("8.78 N/m"), std::string::npos) << shear[0];
    EXPECT_TRUE(
        warnings(parse_job(edited("law = \"bilinear\"", "law = \"brittle\"", edited("Gfn = \"20 N/m\"\nGfs = \"800 N/m\"\n", "")),
                           "job"))
            .empty());
}

TEST(JobTemplate, EveryKindIsAJob) {
    for (std::string_view kind : job_template_kinds()) {
        SCOPED_TRACE(kind);
        expect_round_trip(job_template(kind));
    }
    EXPECT_EQ(parse_job(job_template("laboratory"), "job").tests.size(), 5u);
    EXPECT_THROW(job_template("triaxial"), InputError);
}

TEST(Examples, AreJobs) {
    int found = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::filesystem::path(FELDSPAR_SOURCE_DIR) / "examples")) {
        if (entry.path().extension() != ".toml") continue;
        SCOPED_TRACE(entry.path().filename().string());
        if (parse_toml(read_toml_file(entry.path(), "job"), entry.path().string()).contains("targets"))
            continue;  // a calibration: tests/unit/calibration
        ++found;
        Job job;
        ASSERT_NO_THROW(job = read_job(entry.path()));
        expect_round_trip(job.text, entry.path().string());
    }
    EXPECT_GE(found, 5);
}

TEST(Examples, TheAugigGraniteIsTable7) {
    const std::filesystem::path folder = std::filesystem::path(FELDSPAR_SOURCE_DIR) / "examples/augig";
    for (const char* file : {"job.toml", "short.toml"}) {
        const Job job = read_job(folder / file);
        expect_table7(job.variants.front().contact);
        EXPECT_EQ(job.laboratory.at("UCS"), 122.1e6);
    }
    EXPECT_EQ(read_job(folder / "job.toml").seeds.size(), 5u);
    EXPECT_EQ(read_job(folder / "job.toml").tests.size(), 5u);
    EXPECT_EQ(read_job(folder / "short.toml").tests.size(), 5u);
}

TEST(JobTemplate, TheCommentedDefaultsAreTheDefaults) {
    // every line that begins "# key = value" is switched on, save those that show alternatives
    const std::string text = job_template("laboratory");
    const std::string on = switched_on(text, [](const std::string& line) {
        return line.find("distribution") != std::string::npos || line.starts_with("# DTS") || line.starts_with("# hoek") ||
               line.starts_with("# maximum_steps") || line.starts_with("# maximum_stress") || line.starts_with("# seeds");
    });
    EXPECT_NE(on, text);
    expect_same(parse_job(on, "job"), parse_job(text, "job"));
}

TEST(Job, RelativePackingsCountFromTheJobsFolder) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "feldspar-packing-test";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "p.txt") << "a packing\n";
    std::ofstream(folder / "job.toml") << edited("thickness = \"80 mm\"", "packing = \"p.txt\"",
                                                 edited("[1, 2, 3, 4, 5]", "[1]"));
    EXPECT_EQ(read_job(folder / "job.toml").specimen.packing_file, folder / "p.txt");
    std::ofstream(folder / "several.toml") << edited("thickness = \"80 mm\"", "packing = \"p.txt\"");
    EXPECT_THROW(read_job(folder / "several.toml"), InputError);
    std::filesystem::remove_all(folder);
}

// A file of cells beside the job: what it says of the specimen, and what goes wrong with it.
class CellsOfAFileInAJob : public testing::Test {
protected:
    CellsOfAFileInAJob() {
        folder_.write("cells.csv",
                      "grain,x,y\na,0,0\na,1,0\na,1,1\na,0,1\nb,1,0\nb,2,0\nb,2,1\nb,1,1\nc,0,1\nc,2,1\nc,2,2\nc,0,2\n");
        folder_.write("units.csv",
                      "grain,x_mm,y_mm\na,0,0\na,10,0\na,10,10\na,0,10\nb,10,0\nb,20,0\nb,20,10\nb,10,10\nc,0,10\nc,20,10\nc,20,"
                      "20\nc,0,20\n");
    }
    /// sample_job with this in place of its outline and grains.
    static std::string with(const std::string& outline, const std::string& grains) {
        return edited(
            "diameter = { distribution = \"uniform\", minimum = \"2 mm\", maximum = \"4 mm\" }\nporosity = 0.10\nmerge_length = "
            "\"auto\"\n",
            grains + "\n", edited("shape = \"rectangle\"\nwidth = \"80 mm\"\nheight = \"160 mm\"", outline));
    }
    Job read(const std::string& text) {
        folder_.write("job.toml", text);
        return read_job(folder_ / "job.toml");
    }
    std::string refusal(const std::string& text) {
        try {
            read(text);
        } catch (const std::exception& error) {
            return error.what();
        }
        return "was taken";
    }
    TemporaryFolder folder_;
};

TEST_F(CellsOfAFileInAJob, MakeItsSpecimen) {
    const Job job = read(with("shape = \"from-file\"", "file = \"cells.csv\"\nunit = \"40 mm\""));
    EXPECT_EQ(job.specimen.outline.shape, Shape::rectangle);
    EXPECT_EQ(job.specimen.outline.width_m, 0.08);
    EXPECT_EQ(job.specimen.given_cells.cells->cells.size(), 3u);
    EXPECT_EQ(job.specimen.given_cells.cells->inserted, 1);
    EXPECT_NEAR(job.specimen.grain_sizes.maximum_m, 2.0 * std::sqrt(0.0032 / 3.14159265358979323846), 1e-12);
    const std::string resolved = resolved_toml(job);
    EXPECT_EQ(resolved_toml(parse_job(resolved, "job")), resolved);
    EXPECT_NE(resolved.find("shape = \"rectangle\""), std::string::npos);
    const auto said = warnings(job);
    EXPECT_TRUE(std::any_of(said.begin(), said.end(),
                            [](const std::string& s) { return s.find("the 5 seeds repeat one specimen") != std::string::npos; }));
    const Job given =
        read(with("shape = \"rectangle\"\nwidth = \"20 mm\"\nheight = \"20 mm\"", "file = \"units.csv\"\ntolerance = 0.01"));
    EXPECT_EQ(given.specimen.given_cells.unit_m, 1e-3);
    EXPECT_EQ(given.specimen.given_cells.tolerance, 0.01);
}

TEST_F(CellsOfAFileInAJob, AreCutToSpecimensOfTests) {
    const std::string file = FELDSPAR_SOURCE_DIR "/tests/unit/specimen/data/honeycomb.tess";
    const Job job = read(edited("kind = \"uniaxial-compression\"", "kind = \"brazilian\"\ndiameter = \"5 m\"",
                                with("shape = \"from-file\"", "file = \"" + file + "\"\nunit = \"1 m\"")));
    EXPECT_FALSE(job.specimen.given_cells.cut);
    EXPECT_TRUE(job.tests[0].specimen->given_cells.cut);
    EXPECT_EQ(job.tests[0].specimen->outline.shape, Shape::disc);
    EXPECT_NE(
        refusal(edited("kind = \"uniaxial-compression\"", "kind = \"uniaxial-compression\"\nspecimen = { shape = \"from-file\" }",
                       with("shape = \"from-file\"", "file = \"cells.csv\"\nunit = \"1 m\"")))
            .find("own specimen has no file"),
        std::string::npos);
    EXPECT_NE(refusal(edited("kind = \"uniaxial-compression\"",
                             "kind = \"uniaxial-compression\"\nspecimen = { shape = \"polygon\", vertices = [[\"0 m\", \"0 m\"], "
                             "[\"2 m\", \"0 m\"], [\"1.5 m\", \"1 m\"], [\"2 m\", \"2 m\"], [\"0 m\", \"2 m\"]], edge_labels = "
                             "[\"bottom\", \"a\", \"b\", \"top\", \"c\"] }",
                             with("shape = \"from-file\"", "file = \"cells.csv\"\nunit = \"1 m\"")))
                  .find("convex outlines only"),
              std::string::npos);
}

TEST_F(CellsOfAFileInAJob, AreRefusedWithTheKey) {
    const std::string from_file = "shape = \"from-file\"",
                      rectangle = "shape = \"rectangle\"\nwidth = \"80 mm\"\nheight = \"160 mm\"";
    const std::string diameter = "diameter = { distribution = \"uniform\", minimum = \"2 mm\", maximum = \"4 mm\" }";
    struct Bad {
        std::string outline, grains, word;
    };
    for (const Bad& bad :
         {Bad{from_file, "file = \"cells.csv\"", "missing key: unit"},
          Bad{from_file, "file = \"units.csv\"\nunit = \"mm\"", "head of the file says the unit"},
          Bad{from_file, "file = \"cells.csv\"\nunit = \"kg\"", "is no length"},
          Bad{from_file, "file = \"cells.csv\"\nunit = \"-1 mm\"", "is no length"},
          Bad{from_file, "file = \"cells.csv\"\nunit = \"\"", "unit"},
          Bad{from_file, "file = \"none.csv\"\nunit = \"mm\"", "there is no file"},
          Bad{from_file, "file = \"job.toml\"\nunit = \"mm\"", ".tess"},
          Bad{from_file, "file = \"cells.csv\"\nunit = \"mm\"\n" + diameter, "diameter"},
          Bad{from_file, diameter, "no file says what the outline is"}, Bad{rectangle, diameter + "\nunit = \"mm\"", "unit"},
          Bad{rectangle, diameter + "\ntolerance = 0.01", "tolerance"},
          Bad{from_file + "\nwidth = \"80 mm\"", "file = \"cells.csv\"\nunit = \"mm\"", "width"},
          Bad{from_file, "file = \"cells.csv\"\nunit = \"mm\"\ntolerance = 0.5", "from 0 to 0.1"},
          Bad{from_file + "\npacking = \"cells.csv\"", "file = \"cells.csv\"\nunit = \"mm\"", "packing"},
          Bad{from_file, "file = \"cells.csv\"\nunit = \"40 mm\"\nmerge_length = \"30 mm\"", "half a grain"},
          Bad{rectangle, "porosity = 0.1", "missing key: diameter"}}) {
        const std::string said = refusal(with(bad.outline, bad.grains));
        EXPECT_NE(said.find(bad.word), std::string::npos) << bad.grains << "\n" << said;
    }
    folder_.write("cells.csv", "grain,x,y\na,0,0\na,1,0\na,one,1\n");
    const std::string said = refusal(with(from_file, "file = \"cells.csv\"\nunit = \"mm\""));
    EXPECT_NE(said.find("cells.csv:4"), std::string::npos) << said;
    EXPECT_NE(said.find("'one' is not a number"), std::string::npos) << said;
}

TEST(FlattenedDiscs, AreCutFromTheBrazilianSpecimenAlone) {
    const Job job = parse_job(edited("kind = \"uniaxial-compression\"", "kind = \"brazilian\"\ndisc = \"flattened\""), "job");
    EXPECT_NEAR(job.tests[0].specimen->outline.flat_angle_rad * 180.0 / 3.14159265358979323846, 20.0, 1e-12) << "unless given";
    EXPECT_EQ(job.specimen.outline.flat_angle_rad, 0.0);
    EXPECT_TRUE(warnings(job).empty());
    const Job whole = parse_job(edited("kind = \"uniaxial-compression\"", "kind = \"brazilian\"\ndisc = \"whole\""), "job");
    EXPECT_EQ(whole.tests[0].specimen->outline.flat_angle_rad, 0.0);
    EXPECT_EQ(resolved_toml(whole).find("disc ="), std::string::npos) << "identities of runs stay as they were";
}

TEST(FlattenedDiscs, WithNarrowFlatsAreWarnedOf) {
    const auto said = warnings(parse_job(
        edited("kind = \"uniaxial-compression\"", "kind = \"brazilian\"\ndisc = \"flattened\"\nflat_angle = \"15 deg\""), "job"));
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("15 degrees: from 20 degrees on"), std::string::npos) << said[0];
}

TEST(Toml, CharactersBeyondAsciiStandInQuotesOrComments) {
    const auto at = [](std::string_view text) { return beyond_ascii_outside_quotes(text); };
    EXPECT_FALSE(at("a = \"\xC2\xB5m\" # \xC2\xB5\nb = '\xC2\xB5'\n"));
    EXPECT_FALSE(at("a = \"quote \\\" \xC2\xB5\"\nb = 'no escape \\'\n")) << "an escaped quote does not end a text";
    EXPECT_FALSE(at("a = \"\"\"\nlines \"of\" \xC2\xB5\n\"\"\"\nb = \'\'\'\xC2\xB5\n\xC2\xB5\'\'\'\n"));
    EXPECT_FALSE(
        at("\xEF\xBB\xBF"
           "a = 1\n"))
        << "a byte order mark";
    EXPECT_EQ(at("a = \"x\" \xC2\xB5"), 8u);
    EXPECT_EQ(at("a = 'no escape \\' \xC2\xB5"), 18u);
    EXPECT_EQ(at("a = \"missing\n\xC2\xB5 = 1"), 13u) << "a text ends with its line";
    EXPECT_EQ(at("a = \"\"\"x\"\"\"\n\xC2\xB5"), 12u);
    EXPECT_FALSE(at("a = \"\"\"never closed \xC2\xB5"));
    EXPECT_FALSE(at("# only a comment"));
    EXPECT_FALSE(
        at("[\"\xC2\xB5\".'\xC2\xB5']\na.\"\xC2\xB5\" = { b.'\xC2\xB5' = [\"\xC2\xB5\",\n'\xC2\xB5'], \"\xC2\xB5\" = 1 }\n"));
    EXPECT_EQ(at("a = \"\"\"x \\\n  \xC2\xB5\"\"\""), 13u) << "a line end behind a backslash";
    EXPECT_EQ(at("a = \"\\\xC2\xB5\""), 6u);
    EXPECT_FALSE(at("a = \"\"\"x \\\n  \"\"\"\nb = '\\\xC2\xB5'"));
    // no text begins behind another character
    EXPECT_EQ(at("a = 99'\xC2\xB5'"), 7u);
    EXPECT_EQ(at("a = 9.'\xC2\xB5'"), 7u);
    EXPECT_EQ(at("a = 'b''\xC2\xB5'"), 8u);
}

}  // namespace

// One rock, several specimens: a beam beside the upright specimen, of the same grains.
TEST(Job, ATestMayBringItsOwnSpecimen) {
    const std::string beam =
        "kind = \"three-point-bend\"\nspecimen = { shape = \"rectangle\", width = \"220 mm\", height = \"50 mm\", notches = [{ "
        "from = [\"110 mm\", \"0 mm\"], to = "
        "[\"110 mm\", \"15 mm\"], width = \"1 mm\" }] }\n\n[[test]]\nkind = \"uniaxial-compression\"";
    const Job job = parse_job(edited("kind = \"uniaxial-compression\"", beam), "job");
    ASSERT_EQ(job.tests.size(), 2u);
    ASSERT_TRUE(job.tests[0].specimen);
    EXPECT_FALSE(job.tests[1].specimen);
    EXPECT_EQ(&specimen_of(job, job.tests[1]), &job.specimen);
    const SpecimenSpec& own = specimen_of(job, job.tests[0]);
    EXPECT_EQ(own.outline.width_m, 0.22);
    EXPECT_EQ(own.outline.notches.size(), 1u);
    EXPECT_EQ(own.grain_sizes.maximum_m, job.specimen.grain_sizes.maximum_m);
    EXPECT_EQ(own.thickness_m, job.specimen.thickness_m);
    expect_same(parse_job(resolved_toml(job), "job"), job);
}
// ISRM's jaws and tape unless said; what is said counts, and a resolved job says it all.
TEST(BrazilianPlates, AreCurvedJawsOnTapeUnlessTheJobSaysOtherwise) {
    const auto plates_of = [](const std::string& keys) {
        const Job job = parse_job(edited("kind = \"uniaxial-compression\"", "kind = \"brazilian\"" + keys), "job.toml");
        return job.tests.front();
    };
    const TestSpec usual = plates_of("");
    EXPECT_EQ(usual.plates, PlateShape::curved);
    EXPECT_EQ(usual.jaw_radius, 1.5);
    EXPECT_EQ(usual.plate_Kn_Pa_m, 1.6e12);
    EXPECT_EQ(plates_of("\nplate_Kn = \"900 GPa/m\"").plate_Kn_Pa_m, 9e11);
    EXPECT_EQ(plates_of("\nplate_stiffness_factor = 0.5").plate_Kn_Pa_m, std::nullopt);
    for (const std::string flat : {"\nplates = \"flat\"", "\ndisc = \"flattened\""}) {
        const TestSpec test = plates_of(flat);
        EXPECT_EQ(test.plates, PlateShape::flat) << flat;
        EXPECT_EQ(test.plate_Kn_Pa_m, std::nullopt) << flat;
        EXPECT_EQ(test.plate_stiffness_factor, 1.0) << flat;
    }
}

}  // namespace feldspar
