// Same job, same seed: same bits, for any number of threads and every time.
#include <cstring>

#include <gtest/gtest.h>

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
        add(row.axial_strain);
        add(row.axial_stress_Pa);
        add(row.stress_top_Pa);
        add(row.lateral_strain_gauge);
        add(row.residual);
        add(row.platen_speed);
        add(row.stress_bottom_Pa);
        add(row.energy.external);   // the platens' work is summed by one thread while the others wait
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

class SameBits : public testing::TestWithParam<TestKind> {};
INSTANTIATE_TEST_SUITE_P(Tests, SameBits, testing::Values(TestKind::uniaxial_compression, TestKind::biaxial, TestKind::brazilian),
                         [](const auto& tested) {
                             std::string text = name(tested.param);
                             std::erase(text, '-');
                             return text;
                         });

TEST_P(SameBits, ForAnyNumberOfThreadsAndEveryTime) {
    const bool disc = GetParam() == TestKind::brazilian;
    TestSetup s = fixtures::setup(fixtures::make(disc ? fixtures::disc(0.03) : fixtures::rectangle(0.02, 0.04), 11), GetParam());
    s.numerics.accuracy = 0.02;
    if (GetParam() == TestKind::biaxial) s.test.sigma3_Pa = 4e6;
    const std::uint64_t one = hash(run_test(s, fixtures::threads(1)));
    EXPECT_EQ(hash(run_test(s, fixtures::threads(1))), one);
    EXPECT_EQ(hash(run_test(s, fixtures::threads(2))), one);
    EXPECT_EQ(hash(run_test(s, fixtures::threads(3))), one);
    s.specimen = fixtures::make(disc ? fixtures::disc(0.03) : fixtures::rectangle(0.02, 0.04), 12);
    EXPECT_NE(hash(run_test(s, fixtures::threads(1))), one);   // another packing is another rock
}

}  // namespace
}  // namespace feldspar
