// The steps of a device. Their emulation on the processor against the readable stages; then, on machines that have one, a card
// against the emulation, bit by bit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/gpu/device.hpp"
#include "feldspar/model/state_hash.hpp"
#include "stirred.hpp"

namespace feldspar {
namespace {

class OneStepOfADevice : public testing::TestWithParam<Case> {};

TEST_P(OneStepOfADevice, IsThatOfTheReadableStages) {
    const TestSetup setup = setup_of(GetParam());
    const RunControl control = fixtures::threads(1);
    Experiment e(setup, control);
    choose_step(e);
    if (GetParam().test == methods::biaxial) e.set_dead_loads(1.0);
    stir(e.assembly);
    mix_contacts(e.assembly);
    const Array<Vec2> weight = weights(e.assembly, {3e3, -5e3});
    const std::unique_ptr<StepDevice> device =
        open_emulation();  // one for all: what one state leaves behind must not show in the next
    for (const Damping damping : {Damping::viscous, Damping::local})
        for (const Strength strength : {Strength::real, Strength::unlimited}) {
            e.assembly.weight = damping == Damping::local ? weight : Array<Vec2>{};
            StepSettings settings = e.settings;
            settings.damping = damping;
            settings.viscous = 0.02;
            settings.speed = 1e-9;
            settings.strength = strength;
            settings.kernels = nullptr;
            Assembly readable = e.assembly, there = e.assembly;
            PlatenWork readable_work, work;
            advance(readable, e.team, settings, 7, 1, readable_work);
            settings.device = device.get();
            advance(there, e.team, settings, 7, 1, work);
            const std::string what = std::string(damping == Damping::local ? "local" : "viscous") + " damping" +
                                     (strength == Strength::unlimited ? ", unlimited" : "");
            expect_same(there, readable, 1e-9, what);  // rounding, as of the kernels
            EXPECT_NEAR(work.loading, readable_work.loading, 1e-9 * std::abs(readable_work.loading) + 1e-30) << what;
            for (std::size_t p = 0; p < there.points.size(); ++p) {
                // Of what was dissipated: a small difference of works, as in expect_same().
                EXPECT_NEAR(there.points[p].broken_J, readable.points[p].broken_J,
                            1e-6 * std::abs(readable.points[p].broken_J) + 1e-16)
                    << what;
            }
        }
}

INSTANTIATE_TEST_SUITE_P(Emulation, OneStepOfADevice, testing::ValuesIn(cases()), label);

std::vector<TestSetup> setups() {
    const ModelSpec flexible = fixtures::model(GrainKind::flexible), rigid = fixtures::model(GrainKind::rigid),
                    particles = fixtures::model(GrainKind::inner_particles);
    return {
        setup_of({methods::uniaxial_compression, flexible, ContactLaw::bilinear}),
        setup_of({methods::biaxial, flexible, ContactLaw::linear, ShearMeasure::beyond_friction, TensionUnloading::secant, true}),
        setup_of({methods::brazilian, flexible, ContactLaw::bilinear}),
        setup_of({methods::uniaxial_compression, rigid, ContactLaw::bilinear}),
        setup_of({methods::biaxial, particles, ContactLaw::bilinear})};
}

TEST(Device, StaysByTheProcessorForSomeSteps) {
    for (const TestSetup& setup : setups()) {
        Stirred stirred(setup);
        const auto device = open_emulation();
        Assembly here = stirred.e.assembly;
        PlatenWork work;
        double work_J = 0.0;
        advance(here, stirred.e.team, stirred.settings, 0, 20, work);
        const Assembly there = stirred.after(*device, 2, 10, work_J);
        // Rounding grows while points break: a thousandth of this is seen, and another order of sums in a step would make no
        // more.
        EXPECT_LE(difference(there.nodes.displacement, here.nodes.displacement), 1e-9) << name(setup.test.kind);
        EXPECT_LE(difference(there.bonds.damage, here.bonds.damage), 1e-9) << name(setup.test.kind);
        EXPECT_NEAR(work_J, work.loading, 1e-9 * std::abs(work.loading)) << name(setup.test.kind);
    }
}

TEST(Device, HasTheSameBitsInOneCallAndInMany) {
    for (const TestSetup& setup : setups()) {
        Stirred stirred(setup);
        const auto one = open_emulation(), many = open_emulation();
        double one_J = 0.0, many_J = 0.0;
        const Assembly at_once = stirred.after(*one, 1, 60, one_J), in_calls = stirred.after(*many, 12, 5, many_J);
        expect_same(in_calls, at_once, 0.0, name(setup.test.kind));
        EXPECT_EQ(one_J, many_J);
    }
}

TEST(Device, GoesBackToAnEarlierState) {
    for (const TestSetup& setup : setups()) {
        Stirred stirred(setup);
        const auto used = open_emulation(), fresh = open_emulation();
        double work_J = 0.0;
        stirred.after(*used, 2, 20, work_J);
        for (Contact& contact : stirred.e.assembly.contacts) contact.initial_shape = false;  // another way for some
        const Assembly again = stirred.after(*used, 1, 10, work_J), first = stirred.after(*fresh, 1, 10, work_J);
        expect_same(again, first, 0.0, name(setup.test.kind));
    }
}

std::string text_of(const StateHash& hash) {
    return fmt::format("{:016x} {:016x} {:016x} {:016x}", hash.motion, hash.bonds, hash.breaks, hash.work);
}

// What a card has to reproduce, wherever it is: motion, bonds, breaks and work after 200 steps, through tens to hundreds of
// broken points.
const std::vector<std::string> recorded_bits{"d889669ce72051ae e3ada188b8225106 9423c327f68164fc 84a5769df61643b8",
                                             "036a0fe4d852aef8 53caa44864c3e6b8 6f781d7e11a229a2 165bea44b8738dee",
                                             "e0c3a4fa0e1e4e5f eaea8a2e8a2ab187 bf6dcf91e6806a3e b3b2c4686b015b51",
                                             "445199d92520f4e3 c3af4e5455538e99 402aa0cfdd41384b f7be3801de66ec5e",
                                             "24c61412ed841e86 c78d0e1dcef47009 cf48eade2a12f725 364a098702ffd127"};

TEST(Device, HasTheRecordedBits) {
    const std::vector<TestSetup> all = setups();
    for (std::size_t i = 0; i < all.size(); ++i) {
        Stirred stirred(all[i]);
        const auto device = open_emulation();
        double work_J = 0.0;
        const Assembly after = stirred.after(*device, 20, 10, work_J);
        EXPECT_GT(std::count_if(after.points.begin(), after.points.end(),
                                [](const ContactPoint& point) { return point.broken_step >= 0; }),
                  50)
            << name(all[i].test.kind);
        EXPECT_EQ(text_of(hash_state(after)), recorded_bits[i]) << name(all[i].test.kind);
    }
}

// A whole test: preparation, records, rate control, new contacts. In specimens as small as these rounding alone moves the
// strength, by up to 0.7 % between the instruction sets of a processor.
TEST(Device, ShowsTheStrengthsOfTheProcessor) {
    const ModelSpec flexible = fixtures::model(GrainKind::flexible), rigid = fixtures::model(GrainKind::rigid);
    for (const Case& c :
         {Case{methods::uniaxial_compression, flexible, ContactLaw::bilinear},
          Case{methods::direct_tension, flexible, ContactLaw::bilinear}, Case{methods::brazilian, flexible, ContactLaw::bilinear},
          Case{methods::biaxial, rigid, ContactLaw::bilinear}}) {
        const TestSetup setup = setup_of(c);
        RunControl control = fixtures::threads(1);
        const TestResult here = run_test(setup, control);
        control.device = open_emulation;
        const TestResult there = run_test(setup, control);
        EXPECT_NEAR(there.properties.peak_stress_Pa / here.properties.peak_stress_Pa, 1.0, 0.01) << name(c.test);
        if (std::isfinite(here.properties.E_initial_Pa)) {
            EXPECT_NEAR(there.properties.E_initial_Pa / here.properties.E_initial_Pa, 1.0, 1e-3)
                << name(c.test);  // before anything breaks
        }
        EXPECT_LT(std::abs(there.energy_residual), 2.0 * std::abs(here.energy_residual) + 1e-6) << name(c.test);
    }
}

// Through hundreds of cracks; a kernel a stage, and a block of steps in one kernel.
class Card : public testing::TestWithParam<const char*> {};

TEST_P(Card, HasTheBitsOfTheEmulation) {
    setenv("FELDSPAR_CARD_KERNELS", GetParam(), 1);
    std::unique_ptr<StepDevice> card;
    try {
        card = open_card();
    } catch (const InputError& error) {
        GTEST_SKIP() << error.what();
    }
    for (const TestSetup& setup : setups()) {
        Stirred stirred(setup);
        const auto emulation = open_emulation();
        double card_J = 0.0, emulation_J = 0.0;
        const Assembly here = stirred.after(*emulation, 20, 10, emulation_J), there = stirred.after(*card, 20, 10, card_J);
        EXPECT_EQ(text_of(hash_state(there)), text_of(hash_state(here))) << name(setup.test.kind);
        EXPECT_EQ(card_J, emulation_J) << name(setup.test.kind);
        expect_same(there, here, 0.0, name(setup.test.kind));
    }
}

TEST_P(Card, HasTheSameBitsWhateverElseRunsOnIt) {
    setenv("FELDSPAR_CARD_KERNELS", GetParam(), 1);
    std::vector<std::unique_ptr<StepDevice>> cards;
    try {
        for (int i = 0; i < 6; ++i) cards.push_back(open_card());
    } catch (const InputError& error) {
        GTEST_SKIP() << error.what();
    }
    const TestSetup setup = setups().front();
    std::vector<std::string> hashes(cards.size());
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < cards.size(); ++i)
        threads.emplace_back([&, i] {
            Stirred stirred(setup);
            double work_J = 0.0;
            hashes[i] = text_of(hash_state(stirred.after(*cards[i], 10, 20, work_J)));
        });
    for (std::thread& thread : threads) thread.join();
    for (const std::string& hash : hashes) EXPECT_EQ(hash, hashes.front());
}

INSTANTIATE_TEST_SUITE_P(Kernels, Card, testing::Values("stages", "one"),
                         [](const auto& kernels) { return std::string(kernels.param); });

TEST(Device, RefusesWhatItDoesNotKnow) {
    SpecimenSpec spec = fixtures::rectangle(0.02, 0.04);
    spec.triangles_per_grain = 40;
    const TestSetup setup = fixtures::setup(fixtures::make(spec), methods::uniaxial_compression);
    const RunControl control = fixtures::threads(1);
    Experiment e(setup, control);
    choose_step(e);
    EXPECT_NE(not_ported(e.assembly).find("meshed more finely"), std::string::npos);
    const auto device = open_emulation();
    e.settings.device = device.get();
    EXPECT_THROW(e.run(1), InputError);
}

}  // namespace
}  // namespace feldspar
