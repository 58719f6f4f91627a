#include "feldspar/lab/gauges.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

#include "feldspar/geometry/polygon.hpp"

namespace feldspar {

// About the mean point the constant drops out of the normal equations, and a symmetric 2 x 2 matrix is left. Its pseudo-inverse leaves out
// directions along which the points have no extent.
SlopeWeights slope_weights(std::span<const Vec2> points, double length_m) {
    Vec2 mean;
    for (const Vec2 p : points) mean += p;
    mean *= 1.0 / static_cast<double>(points.size());
    Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
    for (const Vec2 p : points) {
        const Eigen::Vector2d d((p.x - mean.x) / length_m, (p.y - mean.y) / length_m);
        moments += d * d.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
    solver.computeDirect(moments);
    Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();
    for (int k = 0; k < 2; ++k) {
        const double extent2 = solver.eigenvalues()(k);
        if (extent2 > 1e-12 * static_cast<double>(points.size())) inverse += solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose() / extent2;
    }
    SlopeWeights weights;
    for (const Vec2 p : points) {
        const Eigen::Vector2d d((p.x - mean.x) / length_m, (p.y - mean.y) / length_m);
        const Eigen::Vector2d weight = inverse * d / length_m;
        weights.x.push_back(weight(0));
        weights.y.push_back(weight(1));
    }
    return weights;
}

StrainGauge::StrainGauge(const Assembly& assembly, const Specimen& specimen) {
    std::vector<Vec2> X;
    for (const Body& grain : assembly.bodies) X.push_back(assembly.nodes.reference[grain.centre_node]);
    const Box box = bounding_box(specimen.mesh.nodes);
    const double height = box.upper.y - box.lower.y;
    for (std::size_t g = 0; g < X.size(); ++g) {
        const bool inside = specimen.outline.is_disc ? norm(X[g] - specimen.outline.centre) < 0.25 * specimen.outline.radius_m
                                                     : std::abs(X[g].y - 0.5 * (box.lower.y + box.upper.y)) < 0.25 * height;
        if (inside) centre_nodes_.push_back(assembly.bodies[g].centre_node);
    }
    if (centre_nodes_.size() < 3) {   // a very coarse specimen: all of it
        centre_nodes_.clear();
        for (const Body& grain : assembly.bodies) centre_nodes_.push_back(grain.centre_node);
    }
    std::vector<Vec2> points;
    for (const int node : centre_nodes_) points.push_back(assembly.nodes.reference[node]);
    weights_ = slope_weights(points, height);
}

double StrainGauge::fit(const Assembly& assembly, const std::vector<double>& weights, double Vec2::*component) const {
    double strain = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) strain += weights[i] * assembly.nodes.displacement[centre_nodes_[i]].*component;
    return strain;
}

}  // namespace feldspar
