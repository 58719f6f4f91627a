#include "feldspar/lab/gauges.hpp"

#include <cmath>

#include <Eigen/Dense>

#include "feldspar/geometry/polygon.hpp"

namespace feldspar {

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
    const auto count = static_cast<Eigen::Index>(centre_nodes_.size());
    Eigen::MatrixXd A(count, 3);   // u = c0 + c1 x + c2 y, lengths over the height
    for (Eigen::Index i = 0; i < count; ++i) {
        const Vec2 x = assembly.nodes.reference[centre_nodes_[static_cast<std::size_t>(i)]];
        A.row(i) << 1.0, (x.x - box.lower.x) / height, (x.y - box.lower.y) / height;
    }
    const Eigen::MatrixXd weights = A.completeOrthogonalDecomposition().pseudoInverse() / height;
    for (Eigen::Index i = 0; i < count; ++i) {
        lateral_weights_.push_back(weights(1, i));
        axial_weights_.push_back(weights(2, i));
    }
}

double StrainGauge::fit(const Assembly& assembly, const std::vector<double>& weights, double Vec2::*component) const {
    double strain = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) strain += weights[i] * assembly.nodes.displacement[centre_nodes_[i]].*component;
    return strain;
}

}  // namespace feldspar
