// A test that is ended and goes on from its kept state leaves the bits of one that was never disturbed: every method, kind of
// grain and numerics, on other numbers of threads.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cctype>
#include <cmath>
#include <string>
#include <vector>

#include "../verification/fixtures.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/gpu/device.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/job/job_template.hpp"
#include "feldspar/lab/keep_test.hpp"
#include "kept_in_memory.hpp"

namespace feldspar {
namespace {

TestResult run_in_pieces(const TestSetup& setup, const std::vector<int>& moments, int* pieces = nullptr,
                         const std::function<std::unique_ptr<StepDevice>()>& device = {}) {
    Memory memory;
    int threads = 1;
    for (std::size_t piece = 0;; ++piece) {
        memory.end_at(piece < moments.size() ? moments[piece] : 0);
        RunControl control = fixtures::threads(threads);
        control.stop = &memory.stop;
        control.keeper = &memory;
        control.device = device;
        TestResult result = run_test(setup, control);
        EXPECT_TRUE(memory.refused.empty()) << memory.refused.front();
        if (pieces != nullptr) *pieces = static_cast<int>(piece) + 1;
        if (!result.interrupted) return result;
        threads = threads % 3 + 1;
    }
}

struct Case {
    MethodId method;
    GrainKind grains;
    NumericsKind numerics;
};

std::vector<Case> all_cases() {
    std::vector<Case> cases;
    for (const MethodId method : test_methods())
        for (const GrainKind grains : grain_kinds)
            for (const NumericsKind numerics : {NumericsKind::adaptive, NumericsKind::paper, NumericsKind::dynamic}) {
                const TestMethod& definition = method.definition();
                if (numerics != NumericsKind::adaptive && definition.build.stages != nullptr) continue;  // refused
                cases.push_back({method, grains, numerics});
            }
    return cases;
}

// The template of the method, with few grains.
TestSetup setup_of(const Case& one) {
    Job job = parse_job(job_template(name(one.method)), "template.toml");
    TestSpec test = *std::find_if(job.tests.begin(), job.tests.end(), [&](const TestSpec& t) { return t.kind == one.method; });
    SpecimenSpec specimen = test.specimen ? *test.specimen : job.specimen;
    specimen.grain_sizes = {};
    specimen.grain_sizes.minimum_m = 0.006;
    specimen.grain_sizes.maximum_m = 0.010;
    if (one.grains == GrainKind::inner_particles) specimen.particles_per_grain = 9.0;
    if (test.specimen) test.specimen = specimen;
    TestSetup setup = fixtures::setup(fixtures::make(specimen, 3), one.method);
    setup.model = fixtures::model(one.grains);
    setup.contact = fixtures::material(setup.model);
    setup.test = test;
    setup.test.snapshots = 3;
    setup.test.membrane_plates = 6;
    setup.numerics.kind = one.numerics;
    setup.numerics.accuracy = 0.05;
    setup.numerics.maximum_steps = one.numerics == NumericsKind::adaptive ? 800 : 600;
    if (one.numerics == NumericsKind::paper) setup.numerics.speed_m = 5e-8;
    if (one.numerics == NumericsKind::dynamic) setup.numerics.speed_m = 0.2;
    return setup;
}

class GoingOn : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Tests, GoingOn, testing::ValuesIn(all_cases()), [](const auto& tested) {
    std::string text = fmt::format("{}_{}_{}", name(tested.param.method), name(tested.param.grains), name(tested.param.numerics));
    std::erase(text, '-');
    return text;
});

TEST_P(GoingOn, LeavesTheBitsOfAnUndisturbedTest) {
    const TestSetup setup = setup_of(GetParam());
    std::string whole;
    try {
        const TestResult result = run_test(setup, fixtures::threads(1));
        EXPECT_GT(result.history.size(), 8U);
        whole = bytes_of(result);
    } catch (const InputError& refused) {
        GTEST_SKIP() << "this test does not take these grains or numerics: " << refused.what();
    } catch (const NumericalError& failed) {
        GTEST_SKIP() << "no result to compare with: " << failed.what();
    }
    int pieces = 0;
    EXPECT_TRUE(bytes_of(run_in_pieces(setup, {1, 5, 8}, &pieces)) == whole);
    EXPECT_GT(pieces, 2);
}

// Through several passages of the strength, with the states to which it goes back, and the repeats that confirm it.
TEST(GoingOn, GoesBackBeforeTheStrengthAndRepeatsAsIfUndisturbed) {
    TestSetup setup = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04), 11), methods::uniaxial_compression);
    setup.numerics.accuracy = 0.02;
    setup.numerics.confirm = true;
    const TestResult undisturbed = run_test(setup, fixtures::threads(1));
    ASSERT_GT(undisturbed.passages, 1) << "it never went back: choose another packing";
    std::vector<int> moments;
    for (int k = 0; k < 40; ++k) moments.push_back(20 + 37 * k % 90);
    int pieces = 0;
    const TestResult result = run_in_pieces(setup, moments, &pieces);
    EXPECT_GT(pieces, 10);
    EXPECT_TRUE(bytes_of(result) == bytes_of(undisturbed));
}

// A device that has seen all of a test, also the way back to earlier states, and a new one for every piece.
TEST(GoingOn, OnADeviceToo) {
    for (const MethodId method : std::initializer_list<MethodId>{methods::uniaxial_compression, methods::biaxial}) {
        TestSetup setup = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04), 11), method);
        setup.numerics.accuracy = 0.02;
        if (method == methods::biaxial) setup.test.sigma3_Pa = 2e6;
        RunControl control = fixtures::threads(1);
        control.device = open_emulation;
        const TestResult undisturbed = run_test(setup, control);
        EXPECT_TRUE(method != methods::uniaxial_compression || undisturbed.passages > 1)
            << "it never went back: choose another packing";
        std::vector<int> moments;
        for (int k = 0; k < 12; ++k) moments.push_back(20 + 37 * k % 90);
        const TestResult result = run_in_pieces(setup, moments, nullptr, open_emulation);
        EXPECT_TRUE(bytes_of(result) == bytes_of(undisturbed)) << name(method);
    }
}

TEST(GoingOn, AnUnevenRockGoesOn) {
    TestSetup setup = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04), 5), methods::uniaxial_compression);
    setup.rock = fixtures::uneven_rock();
    setup.numerics.accuracy = 0.05;
    setup.numerics.maximum_steps = 4000;
    const std::string whole = bytes_of(run_test(setup, fixtures::threads(1)));
    EXPECT_TRUE(bytes_of(run_in_pieces(setup, {3, 50, 70})) == whole);
}

class OtherStates : public testing::Test {
protected:
    OtherStates() {
        setup_.numerics.accuracy = 0.05;
        setup_.numerics.maximum_steps = 1000;
        whole_ = bytes_of(run_test(setup_, fixtures::threads(1)));
        run(30);
    }
    TestResult run(int moment, const TestSetup& setup) {
        memory_.end_at(moment);
        RunControl control = fixtures::threads(1);
        control.stop = &memory_.stop;
        control.keeper = &memory_;
        return run_test(setup, control);
    }
    TestResult run(int moment) { return run(moment, setup_); }

    TestSetup setup_ = fixtures::setup(fixtures::make(fixtures::rectangle(0.02, 0.04), 1), methods::uniaxial_compression);
    std::string whole_;
    Memory memory_;
};

TEST_F(OtherStates, OfAnotherPackingAreRefused) {
    ASSERT_FALSE(memory_.state.empty());
    TestSetup other = setup_;
    other.specimen = fixtures::make(fixtures::rectangle(0.02, 0.04), 2);
    const TestResult result = run(0, other);
    EXPECT_EQ(memory_.refused.size(), 1U);
    EXPECT_TRUE(bytes_of(result) == bytes_of(run_test(other, fixtures::threads(1))));
}

TEST_F(OtherStates, OfAnotherMaterialAreRefused) {
    TestSetup other = setup_;
    other.contact.sigma_nt_Pa *= 1.5;
    (void)run(0, other);
    EXPECT_EQ(memory_.refused.size(), 1U);
}

TEST_F(OtherStates, CutShortOrLengthenedAreRefused) {
    const std::vector<char> good = memory_.state;
    for (const std::size_t size : {good.size() - 1, good.size() / 2, std::size_t{9}, std::size_t{3}}) {
        memory_.state.assign(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_TRUE(bytes_of(run(0)) == whole_);
    }
    memory_.state = good;
    memory_.state.push_back(0);
    EXPECT_TRUE(bytes_of(run(0)) == whole_);
    EXPECT_EQ(memory_.refused.size(), 5U);
}

}  // namespace
}  // namespace feldspar
