// Study files: which points and runs they make, and what is said of mistakes in them.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "../../small_study.hpp"
#include "../../switched_on.hpp"
#include "../job/broken_lines.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/job/job_template.hpp"
#include "feldspar/job/mistakes.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {
namespace {

class ReadStudy : public ::testing::Test {
protected:
    Study read(const std::string& text) const { return parse_study("job = \"job.toml\"\n" + text, folder_ / "study.toml"); }

    // What is said of a mistake.
    InputError mistake(const std::string& text) const {
        try {
            (void)read(text);
        } catch (const InputError& error) {
            return error;
        }
        ADD_FAILURE() << "no error for\n" << text;
        return InputError({}, "");
    }

    std::vector<InputError> mistakes(const std::string& text) const {
        try {
            (void)read(text);
        } catch (const InputError& error) {
            return each_mistake(error);
        }
        return {};
    }
    static std::string edited(std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    }

    static const ContactMaterial& contact(const Study& study, std::size_t point) {
        return study.points[point].job.variants.front().contact;
    }

    StudyFolder folder_;
};

TEST_F(ReadStudy, WithoutAxesIsTheJobItself) {
    const Study study = read("");
    EXPECT_EQ(study.name, "study");
    EXPECT_EQ(study.results, std::filesystem::path("results/study"));
    ASSERT_EQ(study.points.size(), 1u);
    ASSERT_EQ(study.runs.size(), 4u);  // packing by packing
    EXPECT_EQ(study.runs[0].seed(), 1u);
    EXPECT_EQ(study.runs[0].test().kind, methods::uniaxial_compression);
    EXPECT_EQ(study.runs[1].test().kind, methods::direct_tension);
    EXPECT_EQ(study.runs[2].seed(), 2u);
}

TEST_F(ReadStudy, AxesMakeAllCombinationsTheLastFirst) {
    const Study study = read(R"(
seeds = [7]
tests = ["direct-tension"]
[[axis]]
name = "mu"
key = "material.contact.mu"
values = [0.2, 0.5]
[[axis]]
name = "Gfn"
key = "material.contact.Gfn"
values = ["20 N/m", "40 N/m", "80 J/m2"]
coupled = { material.contact.Gfs = 31.5 }
)");
    ASSERT_EQ(study.points.size(), 6u);
    EXPECT_EQ(study.runs.size(), 6u);
    EXPECT_EQ(study.points[1].values[0].label, "0.2");
    EXPECT_EQ(study.points[1].values[1].label, "40 N/m");
    EXPECT_DOUBLE_EQ(study.points[1].values[1].number, 40.0);
    EXPECT_DOUBLE_EQ(contact(study, 1).mu, 0.2);
    EXPECT_DOUBLE_EQ(contact(study, 1).Gfs_J_m2, 31.5 * 40.0);
    EXPECT_DOUBLE_EQ(contact(study, 5).mu, 0.5);
    EXPECT_DOUBLE_EQ(contact(study, 5).Gfs_J_m2, 31.5 * 80.0);
}

TEST_F(ReadStudy, MultiplesFollowTheirKeyPresetsAndOtherAxesIncluded) {
    const Study study = read(R"(
[[axis]]
name = "tau/sigma_nt"
key = "material.contact.tau"
times = "material.contact.sigma_nt"
values = [2, 3]
[[axis]]
name = "Kn factor"
key = "material.contact.Kn"
times = "material.contact.Kn"
values = [0.5]
[[axis]]
name = "rock"
[[axis.value]]
label = "table 7"
[[axis.value]]
label = "rigid, table 2"
set = { model.kind = "rigid", material.elastic_preset = "augig-rigid", material.strength_preset = "augig-table2-bilinear" }
)");
    ASSERT_EQ(study.points.size(), 4u);
    EXPECT_DOUBLE_EQ(contact(study, 0).tau_Pa, 17e6);
    EXPECT_DOUBLE_EQ(contact(study, 1).tau_Pa, 23e6);
    EXPECT_DOUBLE_EQ(contact(study, 2).tau_Pa, 25.5e6);
    EXPECT_DOUBLE_EQ(contact(study, 0).Kn_Pa_m, 0.5 * 18e13);
    EXPECT_DOUBLE_EQ(contact(study, 1).Kn_Pa_m, 0.5 * 1.08e13);
    EXPECT_EQ(study.points[1].job.variants.front().model.kind, GrainKind::rigid);
}

TEST_F(ReadStudy, PiecesReachSpecimenNumericsAndTests) {
    const Study study = read(R"(
[set]
specimen.width = "15 mm"
numerics.accuracy = "2 %"
test.stop_fraction = 0.9
test.direct-tension.stop_fraction = 0.7
[[axis]]
name = "grains"
[[axis.value]]
label = "fine"
set = { specimen.grains.diameter = { distribution = "uniform", minimum = "1 mm", maximum = "2 mm" } }
[[axis.value]]
label = "sieve"
set = { specimen.grains.diameter = { distribution = "sieve", curve = [["1 mm", 0.0], ["2 mm", 1.0]] } }
)");
    const Job& job = study.points[0].job;
    EXPECT_DOUBLE_EQ(job.specimen.outline.width_m, 0.015);
    EXPECT_DOUBLE_EQ(job.specimen.grain_sizes.maximum_m, 0.002);
    EXPECT_DOUBLE_EQ(job.variants.front().numerics.accuracy, 0.02);
    EXPECT_DOUBLE_EQ(job.tests[0].stop_fraction, 0.9);
    EXPECT_DOUBLE_EQ(job.tests[1].stop_fraction, 0.7);  // keys for one kind go before those for all
    EXPECT_EQ(study.points[1].job.specimen.grain_sizes.kind, GrainSizeKind::sieve);
}

TEST_F(ReadStudy, ValuesMayHaveTheirOwnSeedsAndTests) {
    const Study study = read(R"(
seeds = [1, 2, 3]
[[axis]]
name = "grains"
[[axis.value]]
label = "flexible"
[[axis.value]]
label = "costly"
seeds = [2]
tests = ["direct-tension"]
set = { numerics.accuracy = "1 %" }
)");
    EXPECT_EQ(study.runs.size(), 7u);
    std::size_t costly = 0;
    for (const auto& run : study.runs) {
        if (run.point != 1) continue;
        ++costly;
        EXPECT_EQ(run.seed(), 2u);
        EXPECT_EQ(run.test().kind, methods::direct_tension);
    }
    EXPECT_EQ(costly, 1u);
}

TEST_F(ReadStudy, VariantsOfTheJobAreAnAxis) {
    folder_.write("variants.toml", small_job + R"(
[[variant]]
name = "soft"
[variant.material.contact]
mu = 0.1
[[variant]]
name = "rigid"
tests = ["direct-tension"]
seeds = [1]
[variant.model]
kind = "rigid"
[variant.material]
elastic_preset = "augig-rigid"
)");
    const Study study = parse_study("job = \"variants.toml\"\n", folder_ / "study.toml");
    ASSERT_EQ(study.axes, std::vector<std::string>{"variant"});
    ASSERT_EQ(study.points.size(), 2u);
    EXPECT_DOUBLE_EQ(contact(study, 0).mu, 0.1);
    EXPECT_EQ(study.runs.size(), 5u);
    // and the same runs as those of the job without a study
    std::set<std::string> here, there;
    for (const auto& run : study.runs) here.insert(run.id);
    for (const auto& run : study_of(read_job(folder_ / "variants.toml"), "x", "y").runs) there.insert(run.id);
    EXPECT_EQ(here, there);
}

TEST_F(ReadStudy, ARunIsKnownByWhatChangesItsResult) {
    const std::string id = read("seeds = [1]\n").runs.front().id;
    EXPECT_EQ(id.size(), 32u);
    const auto with = [&](const std::string& text) { return read("seeds = [1]\n" + text).runs.front().id; };
    EXPECT_EQ(with("name = \"other\"\nkeep = \"all\"\n"), id);
    EXPECT_EQ(with("[set]\ntest.snapshots = 2\n"), id);
    EXPECT_EQ(with("[set]\nmaterial.contact.sigma_nt = \"8500 kPa\"\n"), id);  // what the preset says, in other words
    EXPECT_EQ(with("[set]\nmodel.plane = \"stress\"\n"), id);                  // a default
    EXPECT_NE(with("[set]\nmaterial.contact.mu = 0.41\n"), id);
    EXPECT_NE(with("[set]\nnumerics.accuracy = \"4 %\"\n"), id);
    EXPECT_NE(with("[set]\nspecimen.width = \"13 mm\"\n"), id);
    EXPECT_NE(read("seeds = [2]\n").runs.front().id, id);
    EXPECT_NE(read("seeds = [1]\n").runs.back().id, id);  // another test
}

TEST_F(ReadStudy, TheResolvedJobOfARunMakesTheSameRun) {
    const Study study = read("seeds = [1]\n[set]\nmodel.kind = \"rigid\"\nmaterial.elastic_preset = \"augig-rigid\"\n");
    for (const auto& run : study.runs) {
        const Job again = parse_job(resolved_toml(run.job), "again.toml");
        EXPECT_EQ(make_run(again, again.variants.front(), again.tests.front(), again.seeds.front()).id, run.id);
    }
}

TEST_F(ReadStudy, MistakesAreSaidWithPlaceAndSuggestion) {
    const InputError unknown = mistake("[[axis]]\nname = \"mu\"\nkey = \"material.contact.muu\"\nvalues = [1, 2]\n");
    EXPECT_EQ(unknown.place().key, "material.contact.muu");
    EXPECT_EQ(unknown.place().line, 5);
    EXPECT_NE(unknown.suggestion().find("mu"), std::string::npos);
    EXPECT_NE(unknown.problem().find("with mu = 1"), std::string::npos);

    const InputError bad = mistake("[set]\nmaterial.contact.tau = \"25 MPa/m\"\n");
    EXPECT_EQ(bad.place().line, 3);
    EXPECT_NE(bad.allowed().find("stress"), std::string::npos);

    EXPECT_NE(mistake("axes = 1\n").suggestion().find("axis"), std::string::npos);
    EXPECT_NE(mistake("[set]\nlaboratory.UCS = \"1 MPa\"\n").allowed().find("material"), std::string::npos);
    EXPECT_NE(mistake("[set]\ntest.brazilian.plate_mu = 0.1\n").allowed().find("direct-tension"),
              std::string::npos);  // the job has no such test
    EXPECT_EQ(mistake("[set]\ntest.direct-tension = 1\n").place().key, "test.direct-tension");
    EXPECT_EQ(mistake("tests = [\"brazilian\"]\n").place().line, 2);
    EXPECT_EQ(mistake("seeds = [1, 1]\n").place().line, 2);
    EXPECT_EQ(mistake("[[axis]]\nname = \"a\"\nkey = \"material.contact.mu\"\nvalues = []\n").place().key, "axis[1].values");
    EXPECT_NE(mistake("[[axis]]\nname = \"a\"\nkey = \"material.contact.mu\"\nvalues = [1, 1]\n").problem().find("twice"),
              std::string::npos);
    EXPECT_NE(mistake("[[axis]]\nname = \"a\"\nkey = \"mu\"\nvalues = [1]\n").allowed().find("dotted"), std::string::npos);
    EXPECT_EQ(
        mistake("[[axis]]\nname = \"a\"\nkey = \"material.contact.mu\"\ntimes = \"material.contact.nothing\"\nvalues = [1]\n")
            .place()
            .key,
        "material.contact.nothing");
    EXPECT_NE(mistake("results = \"../away\"\n").allowed().find("letters"), std::string::npos);
    EXPECT_NE(
        mistake("[[axis]]\nname = \"a\"\n[[axis.value]]\nlabel = \"x\"\nseeds = [9]\n").problem().find("nothing is left to run"),
        std::string::npos);
}

const std::string whole_study = R"(name = "trial"
title = "A trial"
results = "trial"
keep = "histories"
seeds = [1, 2]
tests = ["direct-tension"]
[set]
material.contact.eta = 0.3
test.stop_fraction = 0.9
[[axis]]
name = "mu"
key = "material.contact.mu"
values = [0.2, 0.5]
[[axis]]
name = "tau"
key = "material.contact.tau"
times = "material.contact.sigma_nt"
values = [2, 3]
[[axis]]
name = "grains"
[[axis.value]]
label = "stiff"
set = { material.grain.E = "50 GPa" }
[[axis.value]]
label = "soft"
seeds = [2]
)";

TEST_F(ReadStudy, FiveMistakesAreToldInTheOrderOfLinesEachAsIfAlone) {
    const std::vector<std::pair<std::string, std::string>> edits{{"keep = \"histories\"", "keep = \"some\""},
                                                                 {"seeds = [1, 2]", "seeds = [1, 1]"},
                                                                 {"material.contact.eta = 0.3", "material.contact.eta = -0.3"},
                                                                 {"key = \"material.contact.mu\"", "key = \"mu\""},
                                                                 {"label = \"soft\"", "label = \"stiff\""}};
    std::string text = whole_study;
    std::vector<std::string> wanted;
    for (const auto& [from, to] : edits) {
        text = edited(text, from, to);
        const std::vector<InputError> alone = mistakes(edited(whole_study, from, to));
        ASSERT_EQ(alone.size(), 1u) << to;
        wanted.push_back(alone.front().what());
    }
    const std::vector<InputError> told = mistakes(text);
    ASSERT_EQ(told.size(), wanted.size());
    for (std::size_t i = 0; i < told.size(); ++i) {
        // with broken axes there are no points, so the point that shows a mistake in [set] is not named
        const std::string message = told[i].what();
        EXPECT_EQ(message.substr(0, message.find('\n')),
                  wanted[i].substr(0, std::min(wanted[i].find('\n'), wanted[i].find(", with mu"))))
            << i;
        if (i > 0) {
            EXPECT_GT(told[i].place().line, told[i - 1].place().line);
        }
    }
}

TEST_F(ReadStudy, MistakesOfTheJobComeBehindThoseOfTheStudy) {
    folder_.write("job.toml", edited(edited(small_job, "12 mm", "12 mn"), "5 %", "50 %"));
    const std::vector<InputError> told =
        mistakes("keep = \"some\"\ntests = [\"direct\"]\n[[axis]]\nname = \"mu\"\nkey = \"material.contact.mu\"\nvalues = []\n");
    ASSERT_EQ(told.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(told[i].place().file, (folder_ / (i < 3 ? "study.toml" : "job.toml")).string());
}

TEST_F(ReadStudy, OneBrokenLineIsOneMistake) {
    EXPECT_TRUE(mistakes(whole_study).empty());
    for (const BrokenLine& broken : broken_lines(whole_study)) {
        const std::vector<InputError> found = mistakes(broken.text);
        ASSERT_EQ(found.size(), 1u) << broken.written << "\n" << found.front().what() << "\n" << found.back().what();
    }
}

TEST_F(ReadStudy, AMistakeInAllPointsIsToldOnce) {
    const std::vector<InputError> found = mistakes(
        "[[axis]]\nname = \"mu\"\nkey = \"material.contact.mu\"\nvalues = [0.1, -0.2, 0.3, -0.4]\n"
        "[[axis]]\nname = \"width\"\nkey = \"specimen.width\"\nvalues = [\"12 mm\", \"13 mn\"]\n");
    ASSERT_EQ(found.size(), 3u);  // two values of mu and one width, whatever the other axis has
    EXPECT_NE(found.front().problem().find("with mu = -0.2, width = 12 mm"), std::string::npos);
}

TEST(ReadStudyFile, WithoutItsJobSaysWhereItLooked) {
    const StudyFolder folder;
    try {
        (void)parse_study("job = \"nowhere.toml\"\n", folder / "study.toml");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(error.problem().find((folder / "nowhere.toml").string()), std::string::npos);
        EXPECT_EQ(error.place().line, 1);
    }
}

TEST(ExamplesOfStudies, Read) {
    struct Example {
        const char* name;
        std::size_t runs;  // as its first lines say
    };
    for (const auto& [name, runs] : {Example{"studies/brazilian/plates.toml", 80}, Example{"studies/softening/border.toml", 120},
                                     Example{"studies/twins/hidden.toml", 120}, Example{"studies/twins/hidden-inner.toml", 20}})
        EXPECT_EQ(read_study(std::filesystem::path(FELDSPAR_SOURCE_DIR) / name).runs.size(), runs) << name;
}

TEST(StudyTemplate, ReadsBesideAJob) {
    const TemporaryFolder folder;
    folder.write("rock.toml", job_template("laboratory"));
    const Study study = parse_study(study_template(), folder / "study.toml");
    EXPECT_EQ(study.points.size(), 6u);
    EXPECT_EQ(study.runs.size(), 18u);
    EXPECT_EQ(parse_study(switched_on(study_template()), folder / "study.toml").points.size(), 24u);
}

// What a command line sets.
class SetInStudy : public ReadStudy {
protected:
    Study read(const std::string& text, std::vector<std::string> settings) const {
        return parse_study("job = \"job.toml\"\n" + text, folder_ / "study.toml", settings);
    }
    InputError mistake(const std::string& text, std::vector<std::string> settings) const {
        try {
            (void)read(text, std::move(settings));
        } catch (const InputError& error) {
            return error;
        }
        ADD_FAILURE() << "no error";
        return InputError({}, "");
    }
};

const std::string kTwoStrengths =
    "[[axis]]\nname = \"strength\"\nkey = \"material.contact.sigma_nt\"\nvalues = [\"7 MPa\", \"9 MPa\"]\n";

TEST_F(SetInStudy, GoesOverTheJobAndItsPiecesInAllPoints) {
    const std::string text = "[set]\nmaterial.contact.tau = \"20 MPa\"\nnumerics.accuracy = \"4 %\"\n" + kTwoStrengths;
    const Study plain = read(text, {});
    const Study set = read(text, {"material.contact.tau=31 MPa", "specimen.width=14mm", "test.UCS.plate_mu=0.3"});
    ASSERT_EQ(set.points.size(), 2u);
    ASSERT_EQ(set.runs.size(), plain.runs.size());
    for (const Point& point : set.points) {
        EXPECT_DOUBLE_EQ(point.job.variants.front().contact.tau_Pa, 31e6) << "also over [set]";
        EXPECT_DOUBLE_EQ(point.job.variants.front().numerics.accuracy, 0.04) << "the rest of [set] stays";
        EXPECT_DOUBLE_EQ(point.job.specimen.outline.width_m, 0.014);
        EXPECT_DOUBLE_EQ(point.job.tests[0].plate_mu.value(), 0.3);
        EXPECT_FALSE(point.job.tests[1].plate_mu) << "the setting is for the other kind of test";
    }
    EXPECT_DOUBLE_EQ(contact(set, 0).sigma_nt_Pa, 7e6);
    for (std::size_t i = 0; i < set.runs.size(); ++i) EXPECT_NE(set.runs[i].id, plain.runs[i].id) << "other runs";
    EXPECT_NE(set.text.find("# --set material.contact.tau=31 MPa"), std::string::npos) << set.text;
    EXPECT_EQ(plain.text.find("--set"), std::string::npos);
}

TEST_F(SetInStudy, IsTheSameRunAsThatOfAJobWithTheSameKey) {
    const Study set = read("", {"material.contact.tau=31 MPa"});
    const Job job = read_job(folder_ / "job.toml", std::vector<std::string>{"material.contact.tau=31 MPa"});
    EXPECT_EQ(set.runs[0].id, make_run(job, job.variants.front(), job.tests.front(), 1).id);
}

TEST_F(SetInStudy, AKeyThatAnAxisVariesIsRefused) {
    for (const char* setting : {"material.contact.sigma_nt=8 MPa", "material.contact={ sigma_nt = \"8 MPa\" }"}) {
        const std::string said = mistake(kTwoStrengths, {setting}).what();
        EXPECT_NE(said.find("--set"), std::string::npos) << said;
        EXPECT_NE(said.find("the axis 'strength' varies this key"), std::string::npos) << said;
    }
    const std::string coupled =
        "[[axis]]\nname = \"G\"\nkey = \"material.contact.Gfn\"\nvalues = [\"20 N/m\"]\n"
        "coupled = { material.contact.Gfs = 40 }\n";
    EXPECT_NE(std::string(mistake(coupled, {"material.contact.Gfs=900 N/m"}).what()).find("the axis 'G'"), std::string::npos);
    const std::string plates = "[[axis]]\nname = \"mu\"\nkey = \"test.uniaxial-compression.plate_mu\"\nvalues = [0.1, 0.2]\n";
    EXPECT_NE(std::string(mistake(plates, {"test.plate_mu=0.3"}).what()).find("the axis 'mu'"), std::string::npos);
    EXPECT_NE(std::string(mistake(plates, {"test.UCS.plate_mu=0.3"}).what()).find("the axis 'mu'"), std::string::npos);
    EXPECT_EQ(read(plates, {"test.DTS.stop_fraction=0.9"}).points.size(), 2u);
}

TEST_F(SetInStudy, VariantsOfTheJobAreSetByName) {
    folder_.write("job.toml", small_job +
                                  "[[variant]]\nname = \"weak\"\nmaterial.contact.tau = \"10 MPa\"\n"
                                  "[[variant]]\nname = \"strong\"\nmaterial.contact.tau = \"40 MPa\"\n");
    const Study study = read("", {"variant.weak.material.contact.tau=12 MPa"});
    EXPECT_DOUBLE_EQ(contact(study, 0).tau_Pa, 12e6);
    EXPECT_DOUBLE_EQ(contact(study, 1).tau_Pa, 40e6);
    const std::string said = mistake("", {"material.contact.tau=12 MPa"}).what();
    EXPECT_NE(said.find("a variant of the job has this key, too"), std::string::npos) << said;
    EXPECT_NE(said.find("variant.<name>.<key>"), std::string::npos) << said;
}

TEST_F(SetInStudy, WhatCannotBeSetHereIsRefusedWithWhatCan) {
    const std::string seeds = mistake("", {"run.seeds=[3]"}).what();
    EXPECT_NE(seeds.find("--set 'run.seeds=[3]'"), std::string::npos) << seeds;
    EXPECT_NE(seeds.find("material"), std::string::npos) << seeds;
    const std::string value = mistake(kTwoStrengths, {"material.contact.tau=-1 MPa"}).what();
    EXPECT_NE(value.find("--set 'material.contact.tau=-1 MPa'"), std::string::npos) << value;
    const std::string key = mistake("", {"material.contact.taw=1 MPa"}).what();
    EXPECT_NE(key.find("tau"), std::string::npos) << key;
}

}  // namespace
}  // namespace feldspar
