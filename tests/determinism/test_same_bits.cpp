// Same job, same seed: same bits, for any number of threads and every time.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>

#include "../verification/fixtures.hpp"

namespace feldspar {
namespace {

// FNV-1a over everything that a test leaves: histories, cracks and the last fields.
std::uint64_t hash(const TestResult& r) {
    std::uint64_t h = 14695981039346656037ULL;
    const auto add = [&](const auto& value) {
        unsigned char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        for (const unsigned char b : bytes) h = (h ^ b) * 1099511628211ULL;
    };
    for (const HistoryRow& row : r.history) {
        add(row.step);
        add(row.stage);
        add(row.axial_strain);
        add(row.axial_stress_Pa);
        add(row.stress_top_Pa);
        add(row.lateral_strain_gauge);
        add(row.residual);
        add(row.residual_median);
        add(row.platen_speed);
        add(row.stress_bottom_Pa);
        add(row.energy.external);  // the platens' work is summed by one thread while the others wait
        add(row.energy.kinetic);
        add(row.energy.friction);
        add(row.energy.fracture);
        add(row.energy.damping);
        add(row.energy.elastic_grains);
    }
    for (const Crack& crack : r.cracks) {
        add(crack.step);
        add(crack.contact);
        add(crack.point);
        add(crack.energy_J);
    }
    for (const Vec2 u : r.snapshots.back().displacement_m) add(u);
    return h;
}

struct Case {
    MethodId kind;
    ModelSpec model;
};

class SameBits : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Tests, SameBits,
                         testing::Values(Case{methods::uniaxial_compression, {}}, Case{methods::biaxial, {}},
                                         Case{methods::brazilian, {}}, Case{methods::cyclic_compression, {}},
                                         Case{methods::biaxial, fixtures::model(GrainKind::rigid)},
                                         Case{methods::brazilian, fixtures::model(GrainKind::rigid, ContactKind::point)},
                                         Case{methods::uniaxial_compression, fixtures::model(GrainKind::inner_particles)},
                                         Case{methods::direct_tension, fixtures::model(GrainKind::inner_particles,
                                                                                       ContactKind::point, ContactNormal::edge)}),
                         [](const auto& tested) {
                             std::string text = name(tested.param.kind);
                             std::erase(text, '-');
                             return text + "_" + fixtures::label(tested.param.model);
                         });

TEST_P(SameBits, ForAnyNumberOfThreadsAndEveryTime) {
    const auto [kind, model] = GetParam();
    const bool inner = model.kind == GrainKind::inner_particles;  // ten times as many bodies: a smaller specimen
    const SpecimenSpec spec = kind == methods::brazilian ? fixtures::disc(0.03)
                              : inner                    ? fixtures::rectangle(0.014, 0.028)
                                                         : fixtures::rectangle(0.02, 0.04);
    TestSetup s = fixtures::setup(spec, kind, model, ContactLaw::bilinear, 11);
    s.numerics.accuracy = 0.02;
    s.test.membrane_plates = 8;
    if (inner && kind == methods::uniaxial_compression) s.numerics.maximum_steps = 3000;  // beyond the first cracks
    if (kind == methods::cyclic_compression) s.numerics.maximum_steps = 5000;             // three cycles
    if (kind == methods::biaxial) s.test.sigma3_Pa = 4e6;
    if (kind == methods::direct_tension) s.test.stop_fraction = 0.3;  // softening alone reaches the usual 0.8, without a crack
    const TestResult first = run_test(s, fixtures::threads(1));
    if (kind == methods::cyclic_compression) {
        EXPECT_GT(first.stages.size(), 4U);
    } else {
        EXPECT_GT(first.cracks.size(), 0U);
    }
    const std::uint64_t one = hash(first);
    EXPECT_EQ(hash(run_test(s, fixtures::threads(1))), one);
    EXPECT_EQ(hash(run_test(s, fixtures::threads(2))), one);
    EXPECT_EQ(hash(run_test(s, fixtures::threads(3))), one);
    // more threads on the way, as tests get them when others have ended
    std::atomic<int> more{1};
    RunControl growing = fixtures::threads(1);
    growing.more_threads = &more;
    growing.progress = [&](const TestProgress& now) { more = now.stage == "loading" ? 3 : 2; };
    const TestResult grown = run_test(s, growing);
    EXPECT_EQ(hash(grown), one);
    EXPECT_EQ(grown.threads, 3);
    s.specimen = fixtures::make(fixtures::filled_for(model, spec), 12);
    EXPECT_NE(hash(run_test(s, fixtures::threads(1))), one);  // another packing is another rock
}

}  // namespace
}  // namespace feldspar
