#include "feldspar/lab/gauges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/step/step.hpp"

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

namespace {

// The triangle of the grain mesh in which a point lies, or the nearest one, and the shares of its corners there.
struct Place {
    int triangle = -1;
    double distance_m = std::numeric_limits<double>::infinity();
    std::array<double, 3> share{};
};

Place place_of(const GrainMesh& mesh, Vec2 point) {
    Place best;
    for (int t = 0; t < std::ssize(mesh.triangles); ++t) {
        const auto& corners = mesh.triangles[t];
        const Vec2 a = mesh.nodes[corners[0]], b = mesh.nodes[corners[1]], c = mesh.nodes[corners[2]];
        const double area = cross(b - a, c - a);
        const std::array<double, 3> share = {cross(b - point, c - point) / area, cross(c - point, a - point) / area, cross(a - point, b - point) / area};
        const bool inside = std::all_of(share.begin(), share.end(), [](double s) { return s >= 0.0; });
        const double distance = inside ? 0.0 : std::min({distance_to_segment(point, a, b), distance_to_segment(point, b, c), distance_to_segment(point, c, a)});
        if (distance < best.distance_m) best = {t, distance, share};
        if (inside) break;
    }
    return best;
}

int grain_of_triangle(const GrainMesh& mesh, int triangle) {
    const auto behind = std::upper_bound(mesh.triangle_begin.begin(), mesh.triangle_begin.end(), triangle);
    return static_cast<int>(behind - mesh.triangle_begin.begin()) - 1;
}

}  // namespace

Gauges::Gauges(const Assembly& assembly, const Specimen& specimen, std::vector<GaugeSpec> specs) : specs_(std::move(specs)) {
    for (const GaugeSpec& gauge : specs_) {
        int fixture = -1;
        if (gauge.kind == GaugeKind::force) {
            const auto found = std::find_if(assembly.fixtures.begin(), assembly.fixtures.end(), [&](const Fixture& f) { return f.name == gauge.fixture; });
            if (found == assembly.fixtures.end())
                throw InputError({.key = "gauge"}, fmt::format("the gauge \"{}\" reads the fixture \"{}\", which the test does not have", gauge.name, gauge.fixture));
            fixture = static_cast<int>(found - assembly.fixtures.begin());
        }
        for (const GaugePoint& point : gauge.points) add_point(assembly, specimen, gauge, point);
        fixture_of_.push_back(fixture);
        ends_.push_back(terms_.size());
    }
}

void Gauges::add_point(const Assembly& assembly, const Specimen& specimen, const GaugeSpec& gauge, const GaugePoint& point) {
    const GrainMesh& mesh = specimen.mesh;
    const Place place = place_of(mesh, point.at);
    if (!(place.distance_m <= specimen.quality.mean_diameter_m))
        throw InputError({.key = "gauge"}, fmt::format("the point ({:.4g}, {:.4g}) mm of the gauge \"{}\" lies {:.3g} mm outside the specimen", 1e3 * point.at.x, 1e3 * point.at.y, gauge.name, 1e3 * place.distance_m),
                         "points of the specimen");
    if (!assembly.node_of_mesh.empty()) {   // flexible grains: by the triangle's corners
        for (std::size_t k = 0; k < 3; ++k) terms_.push_back({assembly.node_of_mesh[mesh.triangles[place.triangle][k]], place.share[k] * point.weight});
        return;
    }
    int body = grain_of_triangle(mesh, place.triangle);
    if (!assembly.body_of_particle.empty()) {   // the nearest of the grain's particles
        double nearest = std::numeric_limits<double>::infinity();
        const int grain = body;
        for (const std::int32_t particle : assembly.body_of_particle) {
            const double distance = norm(assembly.centre(particle) - point.at);
            if (assembly.bodies[particle].grain == grain && distance < nearest) {
                nearest = distance;
                body = particle;
            }
        }
    }
    const Body& rigid = assembly.bodies[body];   // u + turn / radius x arm: the turn is an arc on the contact circle
    const Vec2 arm = point.at - assembly.nodes.reference[rigid.centre_node];
    terms_.push_back({rigid.centre_node, point.weight});
    terms_.push_back({rigid.centre_node + 1, {dot(point.weight, rot90(arm)) / rigid.radius_m, 0.0}});
}

std::vector<double> Gauges::read(const Assembly& assembly) const {
    std::vector<double> values;
    values.reserve(specs_.size());
    std::size_t term = 0;
    for (std::size_t g = 0; g < specs_.size(); ++g) {
        double sum = fixture_of_[g] >= 0 ? dot(reaction(assembly, assembly.fixtures[fixture_of_[g]]), specs_[g].direction) : 0.0;
        for (; term < ends_[g]; ++term) sum += dot(terms_[term].weight, assembly.nodes.displacement[terms_[term].node]);
        values.push_back(sum);
    }
    return values;
}

}  // namespace feldspar
