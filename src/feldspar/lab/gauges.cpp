#include "feldspar/lab/gauges.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/overlap.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/lab/grain_fields.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {

// About the mean point the constant drops out of the normal equations, and a symmetric 2 x 2 matrix is left. Its pseudo-inverse
// leaves out directions along which the points have no extent.
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
        if (extent2 > 1e-12 * static_cast<double>(points.size()))
            inverse += solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose() / extent2;
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
    if (centre_nodes_.size() < 3) {  // a very coarse specimen: all of it
        centre_nodes_.clear();
        for (const Body& grain : assembly.bodies) centre_nodes_.push_back(grain.centre_node);
    }
    std::vector<Vec2> points;
    for (const int node : centre_nodes_) points.push_back(assembly.nodes.reference[node]);
    weights_ = slope_weights(points, height);
}

double StrainGauge::fit(const Assembly& assembly, const std::vector<double>& weights, double Vec2::*component) const {
    double strain = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i)
        strain += weights[i] * assembly.nodes.displacement[centre_nodes_[i]].*component;
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
        const std::array<double, 3> share = {cross(b - point, c - point) / area, cross(c - point, a - point) / area,
                                             cross(a - point, b - point) / area};
        const bool inside = std::all_of(share.begin(), share.end(), [](double s) { return s >= 0.0; });
        const double distance = inside ? 0.0
                                       : std::min({distance_to_segment(point, a, b), distance_to_segment(point, b, c),
                                                   distance_to_segment(point, c, a)});
        if (distance < best.distance_m) best = {t, distance, share};
        if (inside) break;
    }
    return best;
}

int grain_of_triangle(const GrainMesh& mesh, int triangle) {
    const auto behind = std::upper_bound(mesh.triangle_begin.begin(), mesh.triangle_begin.end(), triangle);
    return static_cast<int>(behind - mesh.triangle_begin.begin()) - 1;
}

// The region as a polygon: a circle has the area of its polygon, 0.1 % less with as many corners.
std::vector<Vec2> corners_of(const GaugeRegion& region) {
    if (region.radius_m == 0.0) {
        const Box box = bounding_box(std::array{region.a, region.b});
        return {box.lower, {box.upper.x, box.lower.y}, box.upper, {box.lower.x, box.upper.y}};
    }
    constexpr int corners = 96;
    std::vector<Vec2> circle;
    for (int k = 0; k < corners; ++k) circle.push_back(region.a + turned({region.radius_m, 0.0}, 2.0 * M_PI * k / corners));
    return circle;
}

bool contains(const GaugeRegion& region, Vec2 place) {
    if (region.radius_m > 0.0) return norm(place - region.a) <= region.radius_m;
    const Box box = bounding_box(std::array{region.a, region.b});
    return place.x >= box.lower.x && place.x <= box.upper.x && place.y >= box.lower.y && place.y <= box.upper.y;
}

std::array<Vec2, 3> corners_of(const GrainMesh& mesh, int triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return {mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]};
}

// Flexible grains have a stress in every triangle, others one a grain.
bool has_triangles(const Assembly& assembly) { return !assembly.node_of_mesh.empty(); }

Vec2 normal_of(const GaugeSpec& gauge) { return gauge.normal == Vec2{} ? gauge.direction : gauge.normal; }

double value_of(EnergyTerm term, const EnergyLedger& energy) {
    switch (term) {
        case EnergyTerm::supplied:
            return energy.supplied();
        case EnergyTerm::elastic:
            return energy.elastic_grains + energy.elastic_contacts;
        case EnergyTerm::fracture:
            return energy.fracture;
        case EnergyTerm::friction:
            return energy.friction;
        case EnergyTerm::damping:
            return energy.damping;
        case EnergyTerm::kinetic:
            return energy.kinetic;
    }
    return 0.0;
}

[[noreturn]] void too_little_rock(const GaugeSpec& gauge, const char* what, const char* allowed) {
    throw InputError({.key = "gauge"}, fmt::format("the region of the gauge \"{}\" {}", gauge.name, what), allowed);
}

}  // namespace

Gauges::Gauges(const Assembly& assembly, const Specimen& specimen, std::vector<GaugeSpec> specs)
    : specs_(std::move(specs)), mesh_(&specimen.mesh) {
    for (const GaugeSpec& gauge : specs_) {
        int fixture = -1;
        const bool of_fixture = gauge.kind == GaugeKind::displacement && gauge.points.empty();
        if (gauge.kind == GaugeKind::force || of_fixture) {
            const auto found = std::find_if(assembly.fixtures.begin(), assembly.fixtures.end(),
                                            [&](const Fixture& f) { return f.name == gauge.fixture; });
            if (found == assembly.fixtures.end())
                throw InputError({.key = "gauge"},
                                 fmt::format("the gauge \"{}\" reads the fixture \"{}\", which the test does not have",
                                             gauge.name, gauge.fixture));
            if (of_fixture && found->plate < 0)
                throw InputError({.key = "gauge"},
                                 fmt::format("the gauge \"{}\" reads the way of the fixture \"{}\", which is no plate",
                                             gauge.name, gauge.fixture),
                                 "a plate, roller or jaw; or a point of the specimen");
            if (of_fixture)
                terms_.push_back({found->nodes.front(), gauge.direction});
            else
                fixture = static_cast<int>(found - assembly.fixtures.begin());
        }
        switch (gauge.kind) {
            case GaugeKind::displacement:
            case GaugeKind::strain:
                for (const GaugePoint& point : gauge.points) add_point(assembly, specimen, gauge, point);
                break;
            case GaugeKind::mean_stress:
                add_mean_stress(assembly, specimen.mesh, gauge);
                break;
            case GaugeKind::mean_strain:
                add_mean_strain(assembly, gauge);
                break;
            case GaugeKind::hole_stress:
                add_hole_stress(assembly, specimen.mesh, gauge);
                break;
            case GaugeKind::force:
            case GaugeKind::energy:
                break;
        }
        fixture_of_.push_back(fixture);
        ends_.push_back(terms_.size());
        stress_ends_.push_back(stress_terms_.size());
    }
}

void Gauges::add_point(const Assembly& assembly, const Specimen& specimen, const GaugeSpec& gauge, const GaugePoint& point) {
    const GrainMesh& mesh = specimen.mesh;
    const Place place = place_of(mesh, point.at);
    if (!(place.distance_m <= specimen.quality.mean_diameter_m))
        throw InputError({.key = "gauge"},
                         fmt::format("the point ({:.4g}, {:.4g}) mm of the gauge \"{}\" lies {:.3g} mm outside the specimen",
                                     1e3 * point.at.x, 1e3 * point.at.y, gauge.name, 1e3 * place.distance_m),
                         "points of the specimen");
    if (!assembly.node_of_mesh.empty()) {  // flexible grains: by the triangle's corners
        for (std::size_t k = 0; k < 3; ++k)
            terms_.push_back({assembly.node_of_mesh[mesh.triangles[place.triangle][k]], place.share[k] * point.weight});
        return;
    }
    int body = grain_of_triangle(mesh, place.triangle);
    if (!assembly.body_of_particle.empty()) {  // the nearest of the grain's particles
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
    const Body& rigid = assembly.bodies[body];  // u + turn / radius x arm: the turn is an arc on the contact circle
    const Vec2 arm = point.at - assembly.nodes.reference[rigid.centre_node];
    terms_.push_back({rigid.centre_node, point.weight});
    terms_.push_back({rigid.centre_node + 1, {dot(point.weight, rot90(arm)) / rigid.radius_m, 0.0}});
}

// (P41): every triangle counts with the part of it that lies in the region.
void Gauges::add_mean_stress(const Assembly& assembly, const GrainMesh& mesh, const GaugeSpec& gauge) {
    const std::vector<Vec2> region = corners_of(gauge.region);
    const Box box = bounding_box(region);
    std::vector<StressTerm> terms;
    double area = 0.0;
    for (int t = 0; t < std::ssize(mesh.triangles); ++t) {
        const std::array<Vec2, 3> triangle = corners_of(mesh, t);
        const Box around = bounding_box(triangle);
        if (around.lower.x > box.upper.x || around.upper.x < box.lower.x || around.lower.y > box.upper.y ||
            around.upper.y < box.lower.y)
            continue;
        const double part = overlap_area(triangle, region);
        if (!(part > 0.0)) continue;
        area += part;
        const Vec2 d = gauge.direction, n = normal_of(gauge);
        const double mixed = 0.5 * part * (d.x * n.y + d.y * n.x);
        terms.push_back(
            {has_triangles(assembly) ? t : grain_of_triangle(mesh, t), {part * d.x * n.x, mixed, mixed, part * d.y * n.y}});
    }
    if (!(area > 0.0)) too_little_rock(gauge, "has no rock in it", "a region that lies in the specimen, at least in part");
    for (StressTerm& term : terms)
        term.weight = {term.weight.xx / area, term.weight.xy / area, term.weight.yx / area, term.weight.yy / area};
    add_stress(assembly, mesh, std::move(terms));
}

// (P46): of the linear field of displacements that fits the centres of the grains, or inner particles, in the region.
void Gauges::add_mean_strain(const Assembly& assembly, const GaugeSpec& gauge) {
    std::vector<int> nodes;
    std::vector<Vec2> points;
    for (const Body& body : assembly.bodies) {
        const Vec2 centre = assembly.nodes.reference[body.centre_node];
        if (body.kind == BodyKind::plate || !contains(gauge.region, centre)) continue;
        nodes.push_back(body.centre_node);
        points.push_back(centre);
    }
    constexpr std::size_t least = 3;
    if (points.size() < least) too_little_rock(gauge, "has fewer than three grains in it", "a region over several grains");
    const Box box = bounding_box(points);
    const SlopeWeights slopes = slope_weights(points, norm(box.upper - box.lower));
    const Vec2 d = gauge.direction, n = normal_of(gauge);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Vec2 slope = {slopes.x[i], slopes.y[i]};
        terms_.push_back({nodes[i], -0.5 * (dot(slope, n) * d + dot(slope, d) * n)});
    }
}

// (P43), (P44): of the elastic fields around the hole that fit the stresses near it.
void Gauges::add_hole_stress(const Assembly& assembly, const GrainMesh& mesh, const GaugeSpec& gauge) {
    constexpr double kReach = 1.6;  // of the rock that is looked at, over the radius: farther out near boundaries add fields that
                                    // grow faster than these
    constexpr std::size_t kEnough = 40;  // grains that determine all fields; the uniform ones alone take fewer
    const Vec2 centre = gauge.region.a;
    const double radius = gauge.region.radius_m;
    std::vector<StressSample> samples;
    std::size_t grains = 0;
    for (int g = 0; g < std::ssize(mesh.vertex_count); ++g) {
        const double distance = norm(mesh.nodes[mesh.centre_node[g]] - centre);
        if (distance <= 0.9 * radius || distance > kReach * radius) continue;
        ++grains;
        for (int t = mesh.triangle_begin[g]; t < mesh.triangle_begin[g + 1]; ++t) {
            const auto [a, b, c] = corners_of(mesh, t);
            const double third = cross(b - a, c - a) / 6.0;
            for (const Vec2 middle : {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)}) {
                Vec2 place = middle - centre;
                if (norm(place) < radius) place = (radius / norm(place)) * place;  // chords cut into the circle
                samples.push_back({has_triangles(assembly) ? t : g, third, place});
            }
        }
    }
    const std::vector<StressField> fields = fields_around_hole(radius, grains < kEnough);
    std::vector<double> wanted;
    for (const StressField& field : fields) {
        double mean = 0.0;
        for (const GaugePoint& point : gauge.points) {
            const Vec2 out = (1.0 / norm(point.at - centre)) * (point.at - centre), along = rot90(out);
            mean += dot(along, field(radius * out) * along) / static_cast<double>(gauge.points.size());
        }
        wanted.push_back(mean);
    }
    std::vector<StressTerm> terms = fitted_value(samples, fields, wanted);
    if (terms.empty())
        too_little_rock(gauge, "has too few grains around it", "a round hole of the specimen, of several grains' diameter");
    add_stress(assembly, mesh, std::move(terms));
}

// Of grains without triangles the terms of a grain are put together, for the sums of (P42).
void Gauges::add_stress(const Assembly& assembly, const GrainMesh& mesh, std::vector<StressTerm> terms) {
    if (has_triangles(assembly)) {
        stress_terms_.insert(stress_terms_.end(), terms.begin(), terms.end());
        return;
    }
    std::size_t first = stress_terms_.size();
    for (const StressTerm& term : terms) {
        if (stress_terms_.size() == first || stress_terms_.back().cell != term.cell) stress_terms_.push_back({term.cell, {}});
        Mat2& sum = stress_terms_.back().weight;
        sum = {sum.xx + term.weight.xx, sum.xy + term.weight.xy, sum.yx + term.weight.yx, sum.yy + term.weight.yy};
    }
    for (; first < stress_terms_.size(); ++first) {
        StressTerm& term = stress_terms_[first];
        const std::span corners(mesh.nodes.begin() + mesh.node_begin[term.cell],
                                static_cast<std::size_t>(mesh.vertex_count[term.cell]));
        const double volume = signed_area(corners) * assembly.thickness_m;
        term.weight = {term.weight.xx / volume, term.weight.xy / volume, term.weight.yx / volume, term.weight.yy / volume};
    }
}

namespace {

Mat2 stress_of_triangle(const Assembly& assembly, int triangle) {
    int body = 0;
    if (assembly.elasticity.size() > 1) {
        const auto behind = std::upper_bound(assembly.bodies.begin(), assembly.bodies.begin() + std::ssize(assembly.elasticity),
                                             triangle, [](int t, const Body& b) { return t < b.triangle_begin; });
        body = static_cast<int>(behind - assembly.bodies.begin()) - 1;
    }
    return cauchy_stress(assembly.elasticity_of(body),
                         displacement_gradient(assembly.nodes.displacement, assembly.triangles[triangle]));
}

}  // namespace

double Gauges::stress_sum(const Assembly& assembly, std::size_t begin, std::size_t end, std::span<const Mat2> of_grains) const {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
        const auto& [cell, w] = stress_terms_[i];
        const Mat2 s = of_grains.empty() ? stress_of_triangle(assembly, cell) : of_grains[cell];
        sum += w.xx * s.xx + w.xy * s.xy + w.yx * s.yx + w.yy * s.yy;
    }
    return sum;
}

std::vector<double> Gauges::read(const Assembly& assembly, const EnergyLedger& energy) const {
    std::vector<double> values;
    values.reserve(specs_.size());
    std::vector<Mat2> of_grains;
    if (!stress_terms_.empty() && !has_triangles(assembly)) {
        of_grains.resize(mesh_->vertex_count.size());
        sum_grain_moments(assembly, *mesh_, of_grains);
    }
    std::size_t term = 0, stress = 0;
    for (std::size_t g = 0; g < specs_.size(); ++g) {
        double sum = fixture_of_[g] >= 0 ? dot(felt_by(assembly, assembly.fixtures[fixture_of_[g]]), specs_[g].direction) : 0.0;
        for (; term < ends_[g]; ++term) sum += dot(terms_[term].weight, assembly.nodes.displacement[terms_[term].node]);
        if (stress < stress_ends_[g]) sum -= stress_sum(assembly, stress, stress_ends_[g], of_grains);  // compression positive
        stress = stress_ends_[g];
        values.push_back(sum);
    }
    read_energies(energy, values);
    return values;
}

void Gauges::read_energies(const EnergyLedger& energy, std::span<double> values) const {
    for (std::size_t g = 0; g < specs_.size(); ++g)
        if (specs_[g].kind == GaugeKind::energy) values[g] = value_of(specs_[g].term, energy);
}

}  // namespace feldspar
