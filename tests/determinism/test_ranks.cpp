// A test that ranks make together leaves the bits of one that a single program makes: whole tests, through cracks, new contacts,
// states that are gone back to, and states that another number of ranks has kept.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <string>
#include <vector>

#include "../verification/fixtures.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/study/ranked_job.hpp"
#include "kept_in_memory.hpp"

namespace feldspar {
namespace {

struct Case {
    MethodId method;
    GrainKind grains;
};

class Ranks : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Tests, Ranks,
    testing::Values(Case{methods::uniaxial_compression, GrainKind::flexible}, Case{methods::direct_tension, GrainKind::flexible},
                    Case{methods::biaxial, GrainKind::flexible}, Case{methods::brazilian, GrainKind::flexible},
                    Case{methods::uniaxial_compression, GrainKind::rigid}, Case{methods::biaxial, GrainKind::rigid},
                    Case{methods::brazilian, GrainKind::rigid}, Case{methods::uniaxial_compression, GrainKind::inner_particles}),
    [](const auto& tested) {
        std::string text = fmt::format("{}_{}", name(tested.param.method), name(tested.param.grains));
        std::erase(text, '-');
        return text;
    });

TestSetup setup_of(const Case& one) {
    const ModelSpec model = fixtures::model(one.grains);
    const bool inner = one.grains == GrainKind::inner_particles;
    const SpecimenSpec spec = one.method == methods::brazilian ? fixtures::disc(0.03)
                              : inner                          ? fixtures::rectangle(0.014, 0.028)
                                                               : fixtures::rectangle(0.02, 0.04);
    TestSetup setup = fixtures::setup(spec, one.method, model, ContactLaw::bilinear, 11);
    setup.numerics.accuracy = 0.1;
    setup.test.membrane_plates = 8;
    setup.test.snapshots = 3;
    if (one.method == methods::biaxial) {
        setup.test.sigma3_Pa = 4e6;
        setup.test.stop_fraction = 0.1;  // far behind the strength grains slide onto new neighbours
    }
    if (one.method == methods::direct_tension) setup.test.stop_fraction = 0.3;
    if (inner) setup.numerics.maximum_steps = 2000;
    return setup;
}

// What each of so many ranks has in the end.
std::vector<TestResult> run(const TestSetup& setup, int ranks, int threads, StateKeeper* keeper = nullptr,
                            const std::atomic<bool>* stop = nullptr) {
    std::vector<TestResult> results(static_cast<std::size_t>(ranks));
    in_one_process(ranks, [&](Communicator& own) {
        RunControl control = fixtures::threads(threads);
        if (own.first()) {
            control.keeper = keeper;
            control.stop = stop;
        }
        results[static_cast<std::size_t>(own.rank())] = run_ranked(own, setup, control);
    });
    return results;
}

TEST_P(Ranks, HaveTheBitsOfOneProgram) {
    const TestSetup setup = setup_of(GetParam());
    const TestResult alone = run_test(setup, fixtures::threads(1));
    EXPECT_GT(alone.cracks.size(), 0U);
    const std::string bytes = bytes_of(alone);
    std::vector<std::pair<int, int>> company{{2, 1}, {4, 1}};  // ranks, and threads of each
    if (GetParam().method == methods::direct_tension) company = {{1, 1}, {1, 2}, {2, 2}, {3, 1}};
    if (GetParam().grains == GrainKind::rigid) company = {{2, 1}, {3, 1}};
    for (const auto& [ranks, threads] : company)
        for (const TestResult& result : run(setup, ranks, threads))
            EXPECT_TRUE(bytes_of(result) == bytes) << ranks << " ranks, " << threads << " threads";
}

// What the bits above are compared for.
TEST(RanksTogether, GoBackToStatesAndMakeNewContacts) {
    int passages = 0;
    long long fallbacks = 0, made = 0;
    for (const GrainKind grains : {GrainKind::flexible, GrainKind::rigid}) {
        const TestResult result = run_test(setup_of({methods::biaxial, grains}), fixtures::threads(1));
        passages += result.passages;
        fallbacks += result.shape_fallbacks;
        made += result.new_contacts;
    }
    EXPECT_GT(passages, 2);
    EXPECT_GT(fallbacks, 0);
    EXPECT_GT(made, 0);
}

TEST(RanksTogether, GoOnWithAnotherNumberOfThem) {
    for (const Case& one : {Case{methods::uniaxial_compression, GrainKind::flexible}, Case{methods::biaxial, GrainKind::rigid}}) {
        const TestSetup setup = setup_of(one);
        const TestResult alone = run_test(setup, fixtures::threads(1));
        Memory memory;
        const auto go_on = [&](int ranks, int end_at) {
            memory.end_at(end_at);
            const std::vector<TestResult> results = run(setup, ranks, 1, &memory, &memory.stop);
            EXPECT_TRUE(memory.refused.empty()) << memory.refused.front();
            for (const TestResult& result : results) EXPECT_EQ(result.interrupted, end_at > 0);
            return results.front();
        };
        (void)go_on(3, 40);
        const std::vector<char> of_three = memory.state;
        EXPECT_FALSE(of_three.empty());
        EXPECT_TRUE(bytes_of(go_on(2, 0)) == bytes_of(alone));
        memory.state = of_three;
        (void)go_on(1, 30);
        RunControl control = fixtures::threads(1);  // no ranks at all
        memory.end_at(0);
        control.keeper = &memory;
        EXPECT_TRUE(bytes_of(run_test(setup, control)) == bytes_of(alone));
    }
}

TEST(RanksTogether, EndAllWhenTheFirstIsAskedTo) {
    const TestSetup setup = setup_of({methods::uniaxial_compression, GrainKind::rigid});
    const std::atomic<bool> stop{true};
    for (const TestResult& result : run(setup, 3, 1, nullptr, &stop)) EXPECT_TRUE(result.interrupted);
}

// What ranks say of themselves before they run a job.
std::string refusal(int ranks, const std::function<Job(int)>& read, const std::function<std::string(int)>& version) {
    try {
        in_one_process(ranks, [&](Communicator& own) {
            Provenance provenance;
            provenance.version = version(own.rank());
            (void)read_together(
                own, [&] { return read(own.rank()); }, provenance);
        });
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

TEST(RanksTogether, AreRefusedUnlessTheyHaveTheSameJobAndProgram) {
    const std::string text = R"([specimen]
shape = "rectangle"
width = "12 mm"
height = "24 mm"
[specimen.grains]
diameter = { distribution = "uniform", minimum = "2 mm", maximum = "4 mm" }
[material]
elastic_preset = "augig-flexible"
strength_preset = "augig-table7"
[[test]]
kind = "uniaxial-compression"
)";
    const auto same = [&](int) { return parse_job(text, "job.toml"); };
    const auto one = [](int) { return std::string("1"); };
    EXPECT_EQ(refusal(3, same, one), "");
    EXPECT_NE(refusal(3, same, [](int rank) { return std::to_string(rank / 2); }).find("rank 2"), std::string::npos);
    const auto other_seed = [&](int rank) { return parse_job(rank == 1 ? text + "[run]\nseeds = [2]\n" : text, "job.toml"); };
    EXPECT_NE(refusal(3, other_seed, one).find("another job"), std::string::npos);
    const auto not_there = [&](int rank) {
        if (rank == 2) throw InputError({"job.toml"}, "there is no such file");
        return same(rank);
    };
    EXPECT_NE(refusal(3, not_there, one).find("no such file"), std::string::npos);
}

}  // namespace
}  // namespace feldspar
