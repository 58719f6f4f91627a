// The weights of the strain gauge: those of the least-squares plane, at a cost in proportion to the grains.
#include "feldspar/lab/gauges.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "feldspar/base/rng.hpp"

namespace feldspar {
namespace {

std::vector<Vec2> scattered(int count, Vec2 corner, double width_m, double height_m) {
    RandomStream random(1, "gauge test");
    std::vector<Vec2> points;
    for (int i = 0; i < count; ++i) {
        const double x = random.uniform(corner.x, corner.x + width_m);
        points.push_back({x, random.uniform(corner.y, corner.y + height_m)});
    }
    return points;
}

TEST(Gauge, TheWeightsAreThoseOfThePseudoInverse) {
    const double height = 0.16;
    const std::vector<Vec2> points = scattered(50, {0.3, -0.2}, 0.08, height);
    Eigen::MatrixXd A(50, 3);  // value = c0 + c1 x + c2 y, lengths over the height
    for (int i = 0; i < 50; ++i) A.row(i) << 1.0, points[i].x / height, points[i].y / height;
    const Eigen::MatrixXd expected = A.completeOrthogonalDecomposition().pseudoInverse() / height;
    const SlopeWeights weights = slope_weights(points, height);
    for (int i = 0; i < 50; ++i) {  // weights are about 1 / (50 x 0.05 m); rounding of the decomposition
        EXPECT_NEAR(weights.x[i], expected(1, i), 1e-12);
        EXPECT_NEAR(weights.y[i], expected(2, i), 1e-12);
    }
}

TEST(Gauge, AMillionPointsOfAPlaneGiveItsSlopes) {  // through an N x N matrix, these would take 8 TB
    const std::vector<Vec2> points = scattered(1'000'000, {0.0, 0.0}, 1.0, 2.0);
    const SlopeWeights weights = slope_weights(points, 2.0);
    double along_x = 0.0, along_y = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double value = 7.0 + 2e-3 * points[i].x - 5e-3 * points[i].y;
        along_x += weights.x[i] * value;
        along_y += weights.y[i] * value;
    }
    EXPECT_NEAR(along_x, 2e-3, 1e-11);  // rounding of a million terms of 7e-6
    EXPECT_NEAR(along_y, -5e-3, 1e-11);
}

TEST(Gauge, PointsOnALineGiveTheSlopeAlongIt) {
    const std::vector<Vec2> points = {{0.0, 0.0}, {0.0, 0.1}, {0.0, 0.2}};
    const SlopeWeights weights = slope_weights(points, 0.2);
    EXPECT_NEAR(weights.y[2] - weights.y[0], 10.0, 1e-12);  // (0.1 - -0.1) / (0.1^2 + 0.1^2)
    for (const double w : weights.x) EXPECT_EQ(w, 0.0);
}

// Grains at these places, each a body with one node.
Assembly grains_at(const std::vector<Vec2>& places) {
    Assembly assembly;
    for (const Vec2 place : places) {
        Body body;
        body.centre_node = assembly.nodes.add(place, {1.0, 1.0});
        assembly.bodies.push_back(body);
    }
    return assembly;
}

// A disc that is strained in its middle only, and moves wildly from a quarter of its radius on; a plate from a quarter of its
// height on.
TEST(Gauge, LooksAtTheMiddleOfTheSpecimen) {
    const std::vector<Vec2> places = scattered(4000, {-0.04, -0.04}, 0.08, 0.08);
    for (const bool disc : {true, false}) {
        Specimen specimen;
        specimen.outline.is_disc = disc;
        specimen.outline.radius_m = 0.04;
        specimen.mesh.nodes = {{-0.04, -0.04}, {0.04, 0.04}};
        Assembly assembly = grains_at(places);
        const StrainGauge gauge(assembly, specimen);
        for (std::size_t g = 0; g < places.size(); ++g) {
            const bool middle = disc ? norm(places[g]) < 0.01 : std::abs(places[g].y) < 0.02;
            assembly.nodes.displacement[assembly.bodies[g].centre_node] =
                middle ? Vec2{3e-4 * places[g].x, -1e-3 * places[g].y} : Vec2{1.0, 1.0};
        }
        EXPECT_NEAR(gauge.axial(assembly), 1e-3, 1e-12);
        EXPECT_NEAR(gauge.lateral(assembly), -3e-4, 1e-12);
    }
}

}  // namespace
}  // namespace feldspar
