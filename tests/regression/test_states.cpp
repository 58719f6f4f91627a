// The state of small specimens after the start, after 100 steps and with cracks, as hashes: a change that moves any bit of it is
// seen, and the case and the part of the state that moved say what it touched. The numbers are recorded (golden.hpp): they prove
// nothing else.
//
// How the cases were chosen: every pair of grains and test has its own boundary conditions and start, every law its own branches,
// every instruction set its own code, and each of the numerics its own damping, masses and start. So
//   portable kernels, adaptive     every grains x test x law
//   every other kernels, adaptive  every grains x test, the law changing from pair to pair, so that each kernels meet all laws
//   with each kind of grains paper, dynamic                 every grains x test, kernels and law changing from pair to pair one
//   case more                  for each option of model and material that has a branch of its own
//
// Nothing here depends on the processor. Packings are read from files, so that the way they are made does not matter here.
// Functions of the C library that come in variants for processors (pow, sin, ...) stay out: the target of the rate control is
// given, not computed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "../verification/fixtures.hpp"
#include "feldspar/fast/choose_kernels.hpp"
#include "feldspar/lab/experiment.hpp"
#include "feldspar/lab/recorder.hpp"
#include "feldspar/model/state_hash.hpp"
#include "golden.hpp"

namespace feldspar {
namespace {

struct Case {
    GrainKind grains = GrainKind::flexible;
    MethodId test = methods::uniaxial_compression;
    ContactLaw law = ContactLaw::bilinear;
    NumericsKind numerics = NumericsKind::adaptive;
    std::string kernels =
        "portable";           ///< or "readable": the loading by the readable stages, after a start by the portable kernels
    std::string option = "";  ///< what else is unusual

    std::string label() const {
        return fmt::format("{} {} {} {} {}{}{}", name(grains), name(test), name(law), name(numerics), kernels,
                           option.empty() ? "" : " ", option);
    }
    const Kernels* set() const {
        for (const Kernels* each : all_kernels())
            if (kernels == each->name || (kernels == "readable" && std::string("portable") == each->name)) return each;
        return nullptr;
    }
};

const std::vector<std::string> all_sets{"readable", "portable", "avx2", "avx512"};

std::vector<Case> all_cases() {
    std::vector<Case> cases;
    std::size_t pair = 0;
    for (const GrainKind grains : grain_kinds)
        for (const MethodId test :
             std::initializer_list<MethodId>{methods::uniaxial_compression, methods::direct_tension, methods::biaxial,
                                             methods::brazilian}) {  // beams need a longer specimen: tests/verification has them
            for (const ContactLaw law : contact_laws) cases.push_back({grains, test, law, NumericsKind::adaptive, "portable"});
            for (std::size_t k : {0, 2, 3})
                cases.push_back({grains, test, contact_laws[(pair + k) % 4], NumericsKind::adaptive, all_sets[k]});
            cases.push_back({grains, test, contact_laws[(pair + 1) % 4], NumericsKind::paper, all_sets[(pair + pair / 4) % 4]});
            cases.push_back(
                {grains, test, contact_laws[(pair + 2) % 4], NumericsKind::dynamic, all_sets[(pair + pair / 4 + 2) % 4]});
            ++pair;
        }
    for (const char* kernels : {"readable", "portable", "avx2", "avx512"}) {
        const Case usual{.kernels = kernels};
        const auto with = [&](GrainKind grains, MethodId test, const char* option) {
            Case one = usual;
            one.grains = grains;
            one.test = test;
            one.option = option;
            cases.push_back(one);
        };
        with(GrainKind::flexible, methods::uniaxial_compression, "beyond-friction");
        with(GrainKind::rigid, methods::direct_tension, "secant");
        with(GrainKind::rigid, methods::uniaxial_compression, "point");
        with(GrainKind::inner_particles, methods::brazilian, "edge-normal");
        with(GrainKind::flexible, methods::biaxial, "plane-strain");
        with(GrainKind::flexible, methods::direct_tension, "fine-mesh");
    }
    return cases;
}

// Loading steps after which the state is taken; by the last one every case has cracks.
std::array<long long, 3> moments(const Case& one) {
    const bool slowly = one.test == methods::direct_tension || one.numerics == NumericsKind::adaptive ||
                        (one.numerics == NumericsKind::paper && one.grains == GrainKind::inner_particles);
    return {0, 100, slowly ? 4000 : 1500};
}

std::string key(const Case& one, long long step) { return fmt::format("{} {:4}", one.label(), step); }

golden::File& recorded() {
    static golden::File file("states.csv", golden::File::Kind::table, "damaged,cracks,stress_Pa,motion,bonds,breaks,work");
    return file;
}

std::shared_ptr<const Specimen> specimen_of(const Case& one) {
    static std::map<std::string, std::shared_ptr<const Specimen>> made;
    const bool disc = one.test == methods::brazilian, filled = one.grains == GrainKind::inner_particles,
               fine = one.option == "fine-mesh";
    std::shared_ptr<const Specimen>& specimen = made[fmt::format("{} {} {}", disc, filled, fine)];
    if (!specimen) {
        SpecimenSpec spec = disc ? fixtures::disc(0.016) : fixtures::rectangle(0.010, 0.020);
        spec.packing_file = golden::folder() / (disc ? "disc.packing" : "rectangle.packing");
        if (filled) spec.particles_per_grain = 16.0;
        if (fine) spec.triangles_per_grain = 40;
        specimen = fixtures::make(spec);
    }
    return specimen;
}

TestSetup setup_of(const Case& one) {
    TestSetup s = fixtures::setup(specimen_of(one), one.test);
    s.model = fixtures::model(one.grains, one.option == "point" ? ContactKind::point : ContactKind::lobatto3,
                              one.option == "edge-normal" ? ContactNormal::edge : ContactNormal::centres);
    s.contact = fixtures::material(s.model);
    s.contact.law = one.law;
    if (one.option == "plane-strain") s.model.plane = PlaneState::strain;
    if (one.option == "beyond-friction") s.contact.shear_measure = ShearMeasure::beyond_friction;
    if (one.option == "secant") s.contact.tension_unloading = TensionUnloading::secant;
    if (one.test == methods::biaxial) s.test.sigma3_Pa = 4e6;
    s.test.membrane_plates = 6;
    s.test.stop_fraction = 0.0;  // to the last step, whatever breaks
    s.test.maximum_strain = 1.0;
    s.test.snapshots = 0;
    s.numerics.kind = one.numerics;
    s.numerics.residual_target = 0.02;
    if (one.numerics == NumericsKind::paper) s.numerics.speed_m = 1e-7;
    if (one.numerics == NumericsKind::dynamic) s.numerics.speed_m = 2.0;
    return s;
}

// What the case's line holds after so many loading steps.
std::string state_after(const Case& one, long long steps, int threads = 1) {
    use_kernels(*one.set());
    TestSetup setup = setup_of(one);
    setup.numerics.maximum_steps = steps;
    const RunControl control = fixtures::threads(threads);
    TestResult result;  // as run_test() has it
    result.test = setup.test;
    result.model = setup.model;
    result.contact = setup.contact;
    result.specimen = setup.specimen;
    Experiment e(setup, control);
    if (one.kernels == "readable") e.settings.kernels = nullptr;
    choose_step(e);
    Recorder recorder(e, result);
    prepare(e);
    if (steps > 0) load(e, recorder, result);
    const StateHash hash = hash_state(e.assembly);
    const Reactions reactions = feldspar::reactions(e.assembly);
    int damaged = 0;
    for (int p = 0; p < static_cast<int>(e.assembly.points.size()); ++p) damaged += e.assembly.bond(p).damage > 0.0 ? 1 : 0;
    EXPECT_TRUE(steps < moments(one).back() || !result.cracks.empty() ||
                result.passages > 1)  // one that went back has passed its peak
        << one.label() << ": a case without a crack shows too little";
    return fmt::format("{},{},{:.5g},{:016x},{:016x},{:016x},{:016x}", damaged, result.cracks.size(),
                       e.stress(0.5 * (reactions.loading + reactions.rest)), hash.motion, hash.bonds, hash.breaks, hash.work);
}

class States : public testing::TestWithParam<std::tuple<std::string, GrainKind>> {};
INSTANTIATE_TEST_SUITE_P(Regression, States, testing::Combine(testing::ValuesIn(all_sets), testing::ValuesIn(grain_kinds)),
                         [](const auto& tested) {
                             std::string text = fmt::format("{}_{}", std::get<0>(tested.param), name(std::get<1>(tested.param)));
                             std::replace(text.begin(), text.end(), '-', '_');
                             return text;
                         });

TEST_P(States, AreThoseRecorded) {
    const auto& [kernels, grains] = GetParam();
#ifdef FELDSPAR_FUSES_OTHERWISE
    if (kernels == "avx2" || kernels == "avx512")
        GTEST_SKIP() << "under a sanitizer the compiler fuses other products and sums of these kernels than in a usual build";
#endif
    for (const Case& one : all_cases()) {
        if (one.kernels != kernels || one.grains != grains) continue;
        if (one.set() == nullptr || !is_supported(*one.set()))
            GTEST_SKIP() << "this processor does not know the instructions of the " << kernels
                         << " kernels: what is recorded of them stays as it is";
        for (const long long step : moments(one)) recorded().expect(key(one, step), state_after(one, step));
    }
}

TEST(StatesRecorded, AreThoseOfTheCases) {
    std::set<std::string> keys;
    for (const Case& one : all_cases())
        for (const long long step : moments(one)) EXPECT_TRUE(keys.insert(key(one, step)).second) << key(one, step);
    recorded().expect_only(keys);
}

TEST(StatesRecorded, AreThoseOfTwoThreadsToo) {
    for (const Case& one : all_cases()) {
        if (one.test != methods::biaxial || one.law != ContactLaw::bilinear || one.numerics != NumericsKind::adaptive ||
            one.kernels != "portable")
            continue;
        EXPECT_EQ(state_after(one, moments(one).back(), 2), state_after(one, moments(one).back())) << one.label();
    }
}

}  // namespace
}  // namespace feldspar
