// Variants and presets: which table's value counts, and what each kind of grain asks for.
#include <gtest/gtest.h>

#include "feldspar/base/error.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/job/presets.hpp"
#include "sample_job.hpp"

namespace feldspar {
namespace {

std::string of_kind(const std::string& kind) {
    return edited("[material.grain]\nE = \"25.8 GPa\"\nnu = 0.23\ndensity = \"2650 kg/m3\"\n", "",
                  edited("kind = \"flexible\"\ncontact = \"lobatto3\"", "kind = \"" + kind + "\""));
}

TEST(Kinds, RigidGrainsAndInnerParticlesNeedNoGrainMaterial) {
    const Variant rigid = parse_job(of_kind("rigid"), "job").variants.front();
    EXPECT_EQ(rigid.model.kind, GrainKind::rigid);
    EXPECT_EQ(rigid.model.contact, ContactKind::lobatto3);
    EXPECT_EQ(rigid.grain.density_kg_m3, 2650.0);
    EXPECT_EQ(rigid.grain.E_Pa, 0.0);
    const Job inner = parse_job(of_kind("inner-particles"), "job");
    EXPECT_EQ(inner.variants.front().model.kind, GrainKind::inner_particles);
    EXPECT_EQ(inner.variants.front().model.contact, ContactKind::point);
    EXPECT_EQ(inner.specimen.particles_per_grain, 26.36);
    EXPECT_EQ(parse_job(of_kind("rigid"), "job").specimen.particles_per_grain, 0.0);
    const Job edge = parse_job(edited("\"centres\"", "\"edge\"", of_kind("inner-particles")), "job");
    EXPECT_EQ(edge.variants.front().model.normal, ContactNormal::edge);
}

TEST(Kinds, PlatesHaveFrictionInTheBrazilianTestOnly) {
    const auto test_of = [](const std::string& kind, const std::string& test) {
        return parse_job(edited("kind = \"uniaxial-compression\"", test, kind == "flexible" ? sample_job : of_kind(kind)), "job")
            .tests[0];
    };
    EXPECT_EQ(test_of("flexible", "kind = \"brazilian\"").plate_mu, 0.4);
    EXPECT_EQ(test_of("rigid", "kind = \"brazilian\"").plate_mu, 0.4);
    EXPECT_EQ(test_of("rigid", "kind = \"uniaxial-compression\"").plate_mu, 0.0);
    EXPECT_EQ(test_of("rigid", "kind = \"uniaxial-compression\"\nplate_mu = 0.2").plate_mu, 0.2);
    EXPECT_FALSE(test_of("flexible", "kind = \"uniaxial-compression\"").plate_mu.has_value());
    EXPECT_FALSE(test_of("rigid", "kind = \"direct-tension\"").plate_mu.has_value());
    EXPECT_EQ(test_of("rigid", "kind = \"direct-tension\"\nplate_stiffness_factor = 2").plate_stiffness_factor, 2.0);
    EXPECT_EQ(test_of("flexible", "kind = \"brazilian\"\nplate_Kn = \"3600 GPa/m\"").plate_Kn_Pa_m, 3.6e12);
    EXPECT_EQ(test_of("inner-particles", "kind = \"biaxial\"\nsigma3 = \"4 MPa\"").membrane_plates, 16);
    EXPECT_EQ(test_of("inner-particles", "kind = \"biaxial\"\nsigma3 = \"4 MPa\"\nmembrane_plates = 7").membrane_plates, 7);
}

// Tables 1, 2 and 7 of the paper.
TEST(Presets, HoldTheTablesOfThePaper) {
    const auto material = [](const std::string& kind, const std::string& elastic, const std::string& strength) {
        const std::string text = edited(
            "[material.grain]\nE = \"25.8 GPa\"\nnu = 0.23\ndensity = \"2650 kg/m3\"\n[material.contact]\nlaw = \"bilinear\"\nKn "
            "= "
            "\"18.00e4 GPa/m\"\neta = 0.28\nsigma_nt = \"8.5 MPa\"\ntau = \"29.75 MPa\"\nmu = 0.40\nGfn = \"20 N/m\"\nGfs = "
            "\"800 "
            "N/m\"\n",
            "[material]\nelastic_preset = \"" + elastic + "\"\nstrength_preset = \"" + strength + "\"\n",
            edited("kind = \"flexible\"\ncontact = \"lobatto3\"", "kind = \"" + kind + "\""));
        return parse_job(text, "job").variants.front();
    };
    const Variant rigid = material("rigid", "augig-rigid", "augig-table2-brittle");
    EXPECT_EQ(rigid.contact.Kn_Pa_m, 1.08e13);
    EXPECT_EQ(rigid.contact.eta, 0.28);
    EXPECT_EQ(rigid.contact.law, ContactLaw::brittle);
    EXPECT_EQ(rigid.contact.sigma_nt_Pa, 13.7e6);
    EXPECT_EQ(rigid.contact.tau_Pa, 48.8e6);
    EXPECT_EQ(rigid.contact.mu, 0.4);
    const Variant inner = material("inner-particles", "augig-inner-particles", "augig-table2-bilinear");
    EXPECT_EQ(inner.contact.Kn_Pa_m, 4.9e13);
    EXPECT_EQ(inner.contact.eta, 0.3);
    EXPECT_EQ(inner.contact.law, ContactLaw::bilinear);
    EXPECT_EQ(inner.contact.sigma_nt_Pa, 11.5e6);
    EXPECT_EQ(inner.contact.tau_Pa, 33.25e6);
    EXPECT_EQ(inner.contact.mu, 0.5);
    EXPECT_EQ(inner.contact.Gfn_J_m2, 66.1);
    EXPECT_EQ(inner.contact.Gfs_J_m2, 2078.6);
    const Variant stiff = material("flexible", "augig-flexible-51.6", "augig-table7");
    EXPECT_EQ(stiff.grain.E_Pa, 51.6e9);
    EXPECT_EQ(stiff.contact.Kn_Pa_m, 2.06e13);
    EXPECT_EQ(stiff.contact.sigma_nt_Pa, 8.5e6);
    EXPECT_EQ(stiff.contact.tau_Pa, 29.75e6);
    EXPECT_EQ(stiff.contact.Gfn_J_m2, 20.0);
    EXPECT_EQ(stiff.contact.Gfs_J_m2, 800.0);
    const Variant flexible = material("flexible", "augig-flexible", "augig-table7");
    EXPECT_EQ(flexible.grain.E_Pa, 25.8e9);
    EXPECT_EQ(flexible.grain.nu, 0.23);
    EXPECT_EQ(flexible.contact.Kn_Pa_m, 18e13);
}

TEST(Presets, AreAllInTheOverview) {
    const std::string text = preset_overview();
    for (const Preset& preset : elastic_presets()) EXPECT_NE(text.find(preset.name), std::string::npos);
    for (const Preset& preset : strength_presets()) EXPECT_NE(text.find(preset.name), std::string::npos);
}

TEST(Presets, GiveWayToExplicitKeys) {
    const std::string text = edited("[material.grain]\nE = \"25.8 GPa\"\nnu = 0.23\n",
                                    "[material]\nelastic_preset = "
                                    "\"augig-flexible-51.6\"\n[material.grain]\nnu = 0.3\n");
    const Variant variant = parse_job(text, "job").variants.front();
    EXPECT_EQ(variant.grain.E_Pa, 51.6e9);
    EXPECT_EQ(variant.grain.nu, 0.3);
    EXPECT_EQ(variant.contact.Kn_Pa_m, 18e13);  // given beside the preset
}

TEST(Variants, LieOverTheJobsOwnTables) {
    const Job job = parse_job(variant_job, "job");
    ASSERT_EQ(job.variants.size(), 3u);
    const Variant &rigid = job.variants[0], &flexible = job.variants[1], &inner = job.variants[2];
    EXPECT_EQ(rigid.name, "Rigid, bilinear");
    EXPECT_EQ(rigid.stem, "rigid-bilinear");
    EXPECT_EQ(rigid.model.kind, GrainKind::rigid);
    EXPECT_EQ(rigid.contact.Kn_Pa_m, 1.08e13);
    EXPECT_EQ(rigid.contact.law, ContactLaw::bilinear);
    EXPECT_EQ(rigid.numerics.accuracy, 0.01);
    EXPECT_EQ(flexible.stem, "flexible-25.8");
    EXPECT_EQ(flexible.grain.E_Pa, 25.8e9);
    EXPECT_EQ(flexible.grain.nu, 0.25);
    EXPECT_EQ(flexible.contact.Kn_Pa_m, 18e13);
    EXPECT_EQ(flexible.contact.sigma_nt_Pa, 11.5e6);         // the job's preset still holds
    EXPECT_EQ(flexible.numerics.kind, NumericsKind::paper);  // and has put the job's accuracy aside
    EXPECT_EQ(flexible.numerics.accuracy, NumericsSpec{}.accuracy);
    EXPECT_EQ(flexible.seeds, (std::vector<std::uint64_t>{2}));
    EXPECT_TRUE(flexible.runs(methods::biaxial));
    EXPECT_FALSE(flexible.runs(methods::direct_tension));
    EXPECT_EQ(inner.model.normal, ContactNormal::edge);
    EXPECT_EQ(inner.contact.law, ContactLaw::brittle);
    EXPECT_EQ(inner.contact.mu, 0.45);
    EXPECT_EQ(inner.contact.eta, 0.3);
    EXPECT_EQ(job.specimen.particles_per_grain, 26.36);
    EXPECT_EQ(job.tests[2].membrane_plates, 12);
}

TEST(Variants, PutAsideWhatTheirKindDoesNotKnow) {
    const std::string list =
        "[[variant]]\nname = \"flexible\"\n[[variant]]\nname = \"rigid\"\n[variant.model]\nkind = \"rigid\"\n"
        "[[variant]]\nname = \"filled\"\n[variant.model]\nkind = \"inner-particles\"\n"
        "[[variant]]\nname = \"brittle\"\n[variant.material.contact]\nlaw = \"brittle\"\n"
        "[[variant]]\nname = \"inverse\"\n[variant.material.contact]\nkratio = 4\n[[test]]";
    const Job job = parse_job(edited("[[test]]", list, edited("\"stress\"", "\"strain\"")), "job");
    ASSERT_EQ(job.variants.size(), 5u);
    EXPECT_EQ(job.variants[0].model.plane, PlaneState::strain);
    EXPECT_EQ(job.variants[1].model.plane, PlaneState::stress);
    EXPECT_EQ(job.variants[1].grain.E_Pa, 0.0);
    EXPECT_EQ(job.variants[2].model.contact, ContactKind::point);
    EXPECT_EQ(job.variants[3].contact.Gfn_J_m2, 0.0);
    EXPECT_EQ(job.variants[4].contact.eta, 0.25);
}

TEST(Variants, AJobWithoutThemHasOneWithoutAName) {
    const Job job = parse_job(sample_job, "job");
    ASSERT_EQ(job.variants.size(), 1u);
    EXPECT_TRUE(job.variants.front().name.empty());
    EXPECT_FALSE(job.has_variants());
    EXPECT_TRUE(parse_job(variant_job, "job").has_variants());
}

TEST(Variants, StemsAreFitForFiles) {
    EXPECT_EQ(variant_stem("Rigid, brittle"), "rigid-brittle");
    EXPECT_EQ(variant_stem("flexible 51.6 (bilinear)"), "flexible-51.6-bilinear");
    EXPECT_EQ(variant_stem("Kn +10 %"), "kn-10-pc");
    EXPECT_EQ(variant_stem("..hidden."), "hidden");
    EXPECT_EQ(variant_stem(" - "), "");
}

}  // namespace
}  // namespace feldspar
