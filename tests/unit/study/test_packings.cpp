// Specimens are made once for all who ask, and told apart by everything that defines them.
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "../../small_study.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/study/packings.hpp"

namespace feldspar {
namespace {

SpecimenSpec small_rectangle() {
    SpecimenSpec spec;
    spec.outline.width_m = 0.01;
    spec.outline.height_m = 0.02;
    spec.grain_sizes.minimum_m = 0.002;
    spec.grain_sizes.maximum_m = 0.004;
    return spec;
}

TEST(IdentityOfASpecimen, FollowsFromEverythingThatDefinesIt) {
    using Change = std::function<void(SpecimenSpec&)>;
    const std::vector<Change> changes{
        [](SpecimenSpec&) {},
        [](SpecimenSpec& s) { s.outline.shape = Shape::disc; },
        [](SpecimenSpec& s) { s.outline.width_m = 0.011; },
        [](SpecimenSpec& s) { s.outline.height_m = 0.02000000000000001; },
        [](SpecimenSpec& s) { s.outline.diameter_m = 0.02; },
        [](SpecimenSpec& s) { s.outline.flat_angle_rad = 0.3; },
        [](SpecimenSpec& s) {
            s.outline.vertices_m = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
        },
        [](SpecimenSpec& s) {
            s.outline.vertices_m = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}};
        },
        [](SpecimenSpec& s) { s.outline.edge_labels = {"top"}; },
        [](SpecimenSpec& s) {
            s.outline.edge_labels = {"to", "p"};
        },
        [](SpecimenSpec& s) { s.thickness_m = 0.1; },
        [](SpecimenSpec& s) { s.grain_sizes.kind = GrainSizeKind::log_normal; },
        [](SpecimenSpec& s) { s.grain_sizes.minimum_m = 0.0021; },
        [](SpecimenSpec& s) { s.grain_sizes.maximum_m = 0.0041; },
        [](SpecimenSpec& s) { s.grain_sizes.median_m = 0.003; },
        [](SpecimenSpec& s) { s.grain_sizes.log_standard_deviation = 0.2; },
        [](SpecimenSpec& s) {
            s.grain_sizes.sieve = {{0.002, 0.0}, {0.004, 1.0}};
        },
        [](SpecimenSpec& s) {
            s.grain_sizes.sieve = {{0.002, 0.0}, {0.003, 1.0}};
        },
        [](SpecimenSpec& s) { s.porosity = 0.11; },
        [](SpecimenSpec& s) { s.merge_length_m = 0.0; },
        [](SpecimenSpec& s) { s.merge_length_m = 0.0001; },
        [](SpecimenSpec& s) { s.triangles_per_grain = 24; },
        [](SpecimenSpec& s) { s.packing_file = "rock.packing"; },
        [](SpecimenSpec& s) { s.particles_per_grain = 20.0; },
        [](SpecimenSpec& s) { s.given_cells = {"cells.tess", 1e-3, 1e-3, false, "0123", std::make_shared<GivenCells>()}; },
        [](SpecimenSpec& s) { s.given_cells = {"cells.tess", 1e-3, 1e-3, false, "0124", std::make_shared<GivenCells>()}; },
        [](SpecimenSpec& s) { s.given_cells = {"cells.tess", 2e-3, 1e-3, false, "0123", std::make_shared<GivenCells>()}; },
        [](SpecimenSpec& s) { s.given_cells = {"cells.tess", 1e-3, 2e-3, false, "0123", std::make_shared<GivenCells>()}; },
        [](SpecimenSpec& s) { s.given_cells = {"cells.tess", 1e-3, 1e-3, true, "0123", std::make_shared<GivenCells>()}; },
    };
    std::set<std::string> identities{identity_of(small_rectangle(), 2)};
    for (const Change& change : changes) {
        SpecimenSpec spec = small_rectangle();
        change(spec);
        EXPECT_EQ(identity_of(spec, 1), identity_of(spec, 1));
        EXPECT_EQ(identity_of(spec, 1).size(), 32u);
        identities.insert(identity_of(spec, 1));
    }
    EXPECT_EQ(identities.size(), changes.size() + 1);
}

TEST(PackingsOfRuns, EachIsMadeOnceForAllWhoAsk) {
    Packings packings(4, nullptr);
    std::atomic<int> made{0};
    const auto tell = [&](const SpecimenProgress& progress) {
        if (progress.stage == "mesh") ++made;  // told at least at the beginning of every stage
    };
    std::vector<std::shared_ptr<const Specimen>> got(8);
    {
        std::vector<std::jthread> askers;
        for (std::size_t i = 0; i < got.size(); ++i)
            askers.emplace_back([&, i] { got[i] = packings.get(small_rectangle(), 1 + i % 2, 1, tell); });
    }
    for (std::size_t i = 0; i < got.size(); ++i) {
        EXPECT_EQ(got[i], got[i % 2]);
        EXPECT_EQ(got[i]->seed, 1 + i % 2);
    }
    EXPECT_NE(got[0], got[1]);
    const int once = made;
    EXPECT_GE(once, 2);
    EXPECT_EQ(packings.get(small_rectangle(), 1, 1, tell), got[0]);
    EXPECT_EQ(made, once);
}

TEST(PackingsOfRuns, KeepsThoseUsedLast) {
    Packings packings(2, nullptr);
    const auto first = packings.get(small_rectangle(), 1, 1);
    const auto second = packings.get(small_rectangle(), 2, 1);
    EXPECT_EQ(packings.get(small_rectangle(), 1, 1), first);
    (void)packings.get(small_rectangle(), 3, 1);  // the second was used longest ago
    EXPECT_EQ(packings.get(small_rectangle(), 1, 1), first);
    EXPECT_NE(packings.get(small_rectangle(), 2, 1), second);
}

TEST(PackingsOfRuns, WhoeverAsksHearsOfTheMistake) {
    SpecimenSpec impossible = small_rectangle();
    impossible.grain_sizes.minimum_m = impossible.grain_sizes.maximum_m = 1.0;  // grains larger than the specimen
    Packings packings(2, nullptr);
    for (int time = 0; time < 2; ++time) EXPECT_THROW((void)packings.get(impossible, 1, 1), InputError);
    const std::atomic<bool> stop{true};
    Packings stopped(2, &stop);
    EXPECT_THROW((void)stopped.get(small_rectangle(), 1, 1), Interrupted);
}

TEST(PackingsOfRuns, WholeAndFlattenedDiscsAreDifferentSpecimens) {
    Packings packings(4, nullptr);
    const auto specimen = [&](const std::string& keys) {
        std::string text = small_job;
        const std::string tests = "[[test]]\nkind = \"uniaxial-compression\"\n[[test]]\nkind = \"direct-tension\"\n";
        text.replace(text.find(tests), tests.size(), "[[test]]\nkind = \"brazilian\"\ndiameter = \"30 mm\"\n" + keys);
        const Job job = parse_job(text, "job.toml");
        return packings.get(specimen_of(job, job.tests.front()), 1, 1);
    };
    const auto whole = specimen("");
    EXPECT_FALSE(whole->outline.flattened());
    EXPECT_TRUE(specimen("disc = \"flattened\"\n")->outline.flattened());
    EXPECT_NE(specimen("disc = \"flattened\"\n"), specimen("disc = \"flattened\"\nflat_angle = \"25 deg\"\n"));
    EXPECT_EQ(specimen("disc = \"whole\"\nplate_mu = 0.1\n"), whole) << "made once";
}

}  // namespace
}  // namespace feldspar
