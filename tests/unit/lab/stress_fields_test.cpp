// The stress fields around holes and tips are in equilibrium, compatible and free of traction where they should be; a fit finds
// the factors that it is given.
#include "feldspar/lab/stress_fields.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "feldspar/base/rng.hpp"

namespace feldspar {
namespace {

// Central differences over a thousandth of the place's scale: an error of about 1e-6 of the stress over that scale.
struct Checked {
    double divergence, compatibility, size;
};

Checked checked(const StressField& field, Vec2 at, double scale) {
    const double h = 1e-3 * scale;
    const Mat2 c = field(at), e = field(at + Vec2{h, 0.0}), w = field(at - Vec2{h, 0.0}), n = field(at + Vec2{0.0, h}),
               s = field(at - Vec2{0.0, h});
    const auto trace = [](const Mat2& m) { return m.xx + m.yy; };
    const double size = norm({norm({c.xx, c.yy}), c.xy});
    const Vec2 divergence = {(e.xx - w.xx + n.xy - s.xy) / (2.0 * h), (e.xy - w.xy + n.yy - s.yy) / (2.0 * h)};
    const double laplacian = (trace(e) + trace(w) + trace(n) + trace(s) - 4.0 * trace(c)) / (h * h);
    return {norm(divergence) * scale, std::abs(laplacian) * scale * scale, size};
}

TEST(StressFields, AroundAHoleAreElasticAndFreeOfTractionAtItsEdge) {
    const double radius = 6e-3;
    for (const StressField& field : fields_around_hole(radius))
        for (const double angle : {0.3, 1.4, 2.9, 4.1}) {
            const Vec2 out = turned({1.0, 0.0}, angle);
            const Checked c = checked(field, 1.6 * radius * out, radius);
            EXPECT_NEAR(c.divergence, 0.0, 2e-3 * c.size);
            EXPECT_NEAR(c.compatibility, 0.0, 2e-3 * c.size);
            const Mat2 edge = field(radius * out);
            EXPECT_NEAR(norm(edge * out), 0.0, 1e-12);
        }
}

TEST(StressFields, AroundATipAreElasticAndFreeOfTractionOnItsFaces) {
    const double extent = 5e-3;
    const Vec2 ahead = turned({1.0, 0.0}, 0.7);
    for (const StressField& field : fields_around_tip(ahead, extent)) {
        for (const double angle : {-2.8, -0.9, 0.4, 2.2}) {
            const Checked c = checked(field, 0.8 * extent * turned(ahead, angle), extent);
            EXPECT_NEAR(c.divergence, 0.0, 2e-3 * (c.size + 1.0));
            EXPECT_NEAR(c.compatibility, 0.0, 2e-3 * (c.size + 1.0));
        }
        for (const double side : {1.0, -1.0}) {
            const Mat2 face = field(-0.5 * extent * ahead + side * 1e-12 * rot90(ahead));
            EXPECT_NEAR(norm(face * rot90(ahead)), 0.0, 1e-6);
        }
    }
    const double r = 1e-3, expected = 1.0 / std::sqrt(2.0 * M_PI * r);  // K over sqrt(2 pi r) ahead of the tip
    const std::vector<StressField> fields = fields_around_tip({0.0, 1.0}, extent);
    EXPECT_NEAR(fields[0]({0.0, r}).xx, expected, 1e-9 * expected);
    EXPECT_NEAR(std::abs(fields[1]({0.0, r}).xy), expected, 1e-9 * expected);
}

TEST(StressFields, AFitFindsTheFactors) {
    const double radius = 5e-3;
    const std::vector<StressField> fields = fields_around_hole(radius);
    std::vector<double> factors, wanted(fields.size(), 0.0);
    for (std::size_t k = 0; k < fields.size(); ++k) factors.push_back(std::cos(3.0 * static_cast<double>(k)));
    RandomStream random(1, "stress fields");
    std::vector<StressSample> samples;
    std::vector<Mat2> stresses;
    for (int cell = 0; cell < 60; ++cell) {
        const Vec2 at = random.uniform(1.05, 2.0) * radius * turned({1.0, 0.0}, random.uniform(0.0, 2.0 * M_PI));
        samples.push_back({cell, 1e-6 * random.uniform(0.5, 1.5), at});
        Mat2 sum;
        for (std::size_t k = 0; k < fields.size(); ++k) {
            const Mat2 s = fields[k](at);
            sum = {sum.xx + factors[k] * s.xx, sum.xy + factors[k] * s.xy, sum.yx + factors[k] * s.yx,
                   sum.yy + factors[k] * s.yy};
        }
        stresses.push_back(sum);
    }
    for (std::size_t k = 0; k < fields.size(); ++k) {
        std::ranges::fill(wanted, 0.0);
        wanted[k] = 1.0;
        double value = 0.0;
        for (const auto& [cell, w] : fitted_value(samples, fields, wanted)) {
            const Mat2& s = stresses[static_cast<std::size_t>(cell)];
            value += w.xx * s.xx + w.xy * s.xy + w.yx * s.yx + w.yy * s.yy;
        }
        EXPECT_NEAR(value, factors[k], 1e-7) << k;  // the condition of the fit is some 1e5
    }
    EXPECT_TRUE(fitted_value(std::span(samples).first(3), fields, wanted).empty());  // nine numbers for eleven factors
}

}  // namespace
}  // namespace feldspar
