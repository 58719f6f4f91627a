// The relaxed packing: criterion, balance of forces, everybody inside.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "feldspar/base/error.hpp"
#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/pack_discs.hpp"
#include "sample_specimens.hpp"

namespace feldspar {
namespace {

/// Mean unbalanced / mean contact force, by all pairs and independent of the code under test. Convex outlines.
double residual_of(const Packing& packing, const Outline& outline) {
    std::vector<Vec2> force(packing.centres.size());
    double sum = 0.0;
    int touching = 0;
    const auto wall = [&](std::size_t i, Vec2 inward, double gap) {
        if (gap >= 0.0) return;
        force[i] += -gap * inward;
        sum -= gap;
        ++touching;
    };
    for (std::size_t i = 0; i < force.size(); ++i) {
        const Vec2 c = packing.centres[i];
        for (std::size_t j = 0; j < i; ++j) {
            const Vec2 apart = c - packing.centres[j];
            const double overlap = packing.radii_m[i] + packing.radii_m[j] - norm(apart);
            if (overlap <= 0.0) continue;
            force[i] += overlap / norm(apart) * apart;
            force[j] -= overlap / norm(apart) * apart;
            sum += overlap;
            ++touching;
        }
        if (outline.flattened()) {
            wall(i, {0.0, -1.0}, outline.flat_height_m - c.y - packing.radii_m[i]);
            wall(i, {0.0, 1.0}, outline.flat_height_m + c.y - packing.radii_m[i]);
        }
        if (outline.is_disc) wall(i, (-1.0 / norm(c)) * c, outline.radius_m - norm(c) - packing.radii_m[i]);
        for (std::size_t k = 0; k < outline.vertices.size(); ++k) {
            const Vec2 a = outline.vertices[k], b = outline.vertices[(k + 1) % outline.vertices.size()];
            const Vec2 along = (1.0 / norm(b - a)) * (b - a);
            wall(i, rot90(along), cross(along, c - a) - packing.radii_m[i]);
        }
    }
    double unbalanced = 0.0;
    for (const Vec2 f : force) unbalanced += norm(f);
    return (unbalanced / static_cast<double>(force.size())) / (sum / touching);
}

class RelaxedPacking : public testing::TestWithParam<SpecimenSpec> {};

TEST_P(RelaxedPacking, MeetsTheCriterionInside) {
    const Specimen s = make_specimen(GetParam(), 1);
    EXPECT_LE(s.packing.residual, RelaxationCriterion{}.residual);
    EXPECT_NEAR(residual_of(s.packing, s.outline), s.packing.residual, 1e-6);
    EXPECT_GT(s.packing.overlap_mean, 0.01);
    EXPECT_LT(s.packing.overlap_mean, 0.08);
    EXPECT_LT(s.packing.overlap_max, 0.3);
    for (const Vec2 c : s.packing.centres) EXPECT_TRUE(contains(s.outline, c));
}

INSTANTIATE_TEST_SUITE_P(Outlines, RelaxedPacking, testing::Values(rectangle(), disc(), flattened_disc(), triangle()));

TEST(Packing, OverlapIsSpreadEvenly) {
    // Before relaxation the upper half holds as many discs as the lower half only by chance; afterwards the pressure is even.
    const Specimen s = make_specimen(rectangle(), 1);
    double area[2] = {0.0, 0.0};
    for (std::size_t i = 0; i < s.packing.centres.size(); ++i) {
        area[s.packing.centres[i].y > 0.08 ? 1 : 0] += s.packing.radii_m[i] * s.packing.radii_m[i];
    }
    EXPECT_NEAR(area[0] / area[1], 1.0, 0.02);
}

/// The packing's discs thrown about by a third of their radius and relaxed again.
Packing shaken(const Specimen& s, const StageControl& control) {
    Packing packing = s.packing;
    RandomStream random(1, "shaking");
    for (std::size_t i = 0; i < packing.centres.size(); ++i) {
        const double r = packing.radii_m[i] / 3.0, x = random.uniform(-r, r);
        packing.centres[i] += {x, random.uniform(-r, r)};
    }
    relax_discs(packing, s.outline, {}, control);
    return packing;
}

TEST(Packing, SameBitsForAnyNumberOfThreads) {
    for (const SpecimenSpec& spec : {rectangle(), disc(), ell()}) {
        const Specimen s = make_specimen(spec, 1);
        const Packing alone = shaken(s, {});
        for (const int threads : {2, 5}) {
            Team team(threads);
            const Packing together = shaken(s, {.team = &team, .tell = {}});
            EXPECT_EQ(together.centres, alone.centres);
            EXPECT_EQ(together.overlap_mean, alone.overlap_mean);
            EXPECT_EQ(together.overlap_max, alone.overlap_max);
            EXPECT_EQ(together.residual, alone.residual);
        }
    }
}

TEST(Packing, TellsAShareThatNeverFalls) {
    const Specimen s = make_specimen(rectangle(), 1);
    std::vector<double> shares;
    shaken(s, {.team = nullptr, .tell = [&](double share) { shares.push_back(share); }});
    ASSERT_GT(shares.size(), 5u);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_GE(shares.front(), 0.0);
    EXPECT_GT(shares.back(), 0.8);
    EXPECT_LE(shares.back(), 1.0);
}

TEST(Packing, TwoDiscsInABoxComeToRestSideBySide) {
    const Outline outline = make_outline(rectangle(0.004, 0.002).outline);
    Packing packing;
    packing.radii_m = {0.0011, 0.0011};
    packing.centres = {{0.0015, 0.001}, {0.0023, 0.001}};
    relax_discs(packing, outline, {.residual = 1e-9});
    // Each overlaps its neighbour and its wall equally: 2 (r + r) - 0.004 = 0.0004 over three contacts of one stiffness.
    EXPECT_NEAR(packing.centres[0].x, 0.0011 - 0.0004 / 3.0, 1e-9);
    EXPECT_NEAR(packing.centres[1].x, 0.0029 + 0.0004 / 3.0, 1e-9);
    EXPECT_NEAR(packing.centres[0].y, 0.001, 1e-9);
}

TEST(Packing, LoosePackingEndsWithoutOverlap) {
    SpecimenSpec spec = rectangle(0.03, 0.03);
    spec.porosity = 0.4;
    const Specimen s = make_specimen(spec, 1);
    EXPECT_LE(s.packing.overlap_mean, RelaxationCriterion{}.loose_overlap);
    EXPECT_NEAR(s.quality.area_error, 0.0, 1e-9);
}

TEST(Packing, RelaxationThatDoesNotArriveIsANumericalError) {
    Specimen s = make_specimen(rectangle(0.03, 0.03), 1);
    for (double& r : s.packing.radii_m) r *= 1.1;
    EXPECT_THROW(relax_discs(s.packing, s.outline, {.residual = 1e-12, .loose_overlap = 0.0, .most_steps = 20}), NumericalError);
}

TEST(Packing, WideMixtureIsPacked) {
    SpecimenSpec spec = rectangle(0.03, 0.03);
    spec.grain_sizes.kind = GrainSizeKind::sieve;
    spec.grain_sizes.sieve = {{0.0005, 0.0}, {0.005, 1.0}};
    const Specimen s = make_specimen(spec, 1);
    EXPECT_LE(s.packing.residual, RelaxationCriterion{}.residual);
    const auto [least, largest] = std::minmax_element(s.packing.radii_m.begin(), s.packing.radii_m.end());
    EXPECT_GT(*largest / *least, 4.0);
}

TEST(Packing, GrainsThatFindNoRoomAreRefused) {
    EXPECT_THROW(make_specimen(rectangle(0.003, 0.5), 1), InputError);  // narrower than the largest grain
    EXPECT_THROW(make_specimen(rectangle(0.001, 0.001), 1), InputError);
    EXPECT_THROW(make_specimen(polygon({{0, 0}, {0.1, 0.1}, {0.1, 0.1007}}), 1), InputError);  // a needle along a diagonal
}

SpecimenSpec wide_sieve() {  // 0.5 to 16 mm
    SpecimenSpec spec = rectangle(0.05, 0.10);
    spec.grain_sizes = {.kind = GrainSizeKind::sieve,
                        .sieve = {{0.0005, 0.0}, {0.0016, 0.1}, {0.003, 0.3}, {0.008, 0.7}, {0.016, 1.0}}};
    return spec;
}

SpecimenSpec wide_log_normal(double deviation) {
    SpecimenSpec spec = disc(0.05);
    spec.grain_sizes = {.kind = GrainSizeKind::log_normal,
                        .minimum_m = 0.0003,
                        .maximum_m = 0.012,
                        .median_m = 0.002,
                        .log_standard_deviation = deviation,
                        .sieve = {}};
    return spec;
}

TEST(Packing, WideDistributionsPack) {
    for (const SpecimenSpec& spec : {wide_sieve(), wide_log_normal(0.65), wide_log_normal(0.8), wide_log_normal(1.0)}) {
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            const Specimen s = make_specimen(spec, seed);
            EXPECT_TRUE(s.packing.residual <= RelaxationCriterion{}.residual ||
                        s.packing.overlap_mean <= RelaxationCriterion{}.loose_overlap)
                << seed;
            for (const Vec2 c : s.packing.centres) EXPECT_TRUE(contains(s.outline, c));
            EXPECT_LT(s.packing.overlap_mean, 0.08);
            EXPECT_LT(s.quality.area_error, 1e-9);
        }
    }
}

TEST(Packing, AWidePackingHasTheSameBitsForAnyNumberOfThreads) {
    const Specimen alone = make_specimen(wide_sieve(), 1);
    Packing packing = alone.packing;
    Team team(3);
    for (Vec2& c : packing.centres) c += Vec2{1e-5, -2e-5};
    Packing other = packing;
    relax_discs(packing, alone.outline, {}, {});
    relax_discs(other, alone.outline, {}, {.team = &team, .tell = {}});
    EXPECT_EQ(packing.centres, other.centres);
}

}  // namespace
}  // namespace feldspar
