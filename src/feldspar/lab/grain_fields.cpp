#include "feldspar/lab/grain_fields.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "feldspar/geometry/polygon.hpp"

namespace feldspar {
namespace {

// Bodies come grain by grain: the first of each grain, and the end.
std::vector<int> first_bodies(const Assembly& assembly, int grains) {
    std::vector<int> first(static_cast<std::size_t>(grains) + 1, 0);
    for (const Body& body : assembly.bodies)
        if (body.grain >= 0) ++first[body.grain + 1];
    for (int g = 0; g < grains; ++g) first[g + 1] += first[g];
    return first;
}

// x -> u0 + G (x - x0), by least squares through the centres of the grain's particles.
struct LinearField {
    Vec2 x0, u0;
    Mat2 G;
    Vec2 at(Vec2 x) const { return u0 + G * (x - x0); }
};

LinearField fit(const Assembly& assembly, int begin, int end, std::span<const Vec2> u) {
    LinearField field;
    const double weight = 1.0 / (end - begin);
    for (int b = begin; b < end; ++b) {
        field.x0 += weight * assembly.nodes.reference[assembly.bodies[b].centre_node];
        field.u0 += weight * u[assembly.bodies[b].centre_node];
    }
    Eigen::Matrix2d A = Eigen::Matrix2d::Zero(), B = Eigen::Matrix2d::Zero();
    for (int b = begin; b < end; ++b) {
        const int node = assembly.bodies[b].centre_node;
        const Vec2 x = assembly.nodes.reference[node] - field.x0, du = u[node] - field.u0;
        A += Eigen::Vector2d(x.x, x.y) * Eigen::RowVector2d(x.x, x.y);
        B += Eigen::Vector2d(du.x, du.y) * Eigen::RowVector2d(x.x, x.y);
    }
    if (A.determinant() <= 1e-12 * A.trace() * A.trace()) return field;  // all on a line: moved as one piece
    const Eigen::Matrix2d G = B * A.inverse();
    field.G = {G(0, 0), G(0, 1), G(1, 0), G(1, 1)};
    return field;
}

Vec2 moved_rigidly(const Assembly& assembly, const Body& body, Vec2 X, std::span<const Vec2> u) {
    const Vec2 arm = X - assembly.nodes.reference[body.centre_node];
    return u[body.centre_node] + turned(arm, u[body.centre_node + 1].x / body.radius_m) - arm;
}

}  // namespace

std::vector<Vec2> mesh_displacements(const Assembly& assembly, const Specimen& specimen, std::span<const Vec2> u) {
    const GrainMesh& mesh = specimen.mesh;
    std::vector<Vec2> displacements(mesh.nodes.size());
    if (assembly.bodies.front().kind == BodyKind::flexible) {
        for (std::size_t n = 0; n < displacements.size(); ++n) displacements[n] = u[assembly.node_of_mesh[n]];
        return displacements;
    }
    const int grains = static_cast<int>(mesh.vertex_count.size());
    const std::vector<int> first = first_bodies(assembly, grains);
    for (int g = 0; g < grains; ++g) {
        const bool alone = first[g + 1] - first[g] == 1;
        const LinearField field = alone ? LinearField{} : fit(assembly, first[g], first[g + 1], u);
        for (int n = mesh.node_begin[g]; n < mesh.node_begin[g + 1]; ++n)
            displacements[n] =
                alone ? moved_rigidly(assembly, assembly.bodies[first[g]], mesh.nodes[n], u) : field.at(mesh.nodes[n]);
    }
    return displacements;
}

void sum_grain_moments(const Assembly& assembly, const GrainMesh& mesh, std::span<Mat2> sums) {
    std::ranges::fill(sums, Mat2{});
    const auto add = [&](const ContactSide& side, Vec2 x, Vec2 force) {
        const int grain = assembly.bodies[side.body].grain;
        if (grain < 0) return;
        const Vec2 arm = x - mesh.nodes[mesh.centre_node[grain]];
        Mat2& sum = sums[grain];
        sum.xx += arm.x * force.x;
        sum.yy += arm.y * force.y;
        sum.xy += 0.5 * (arm.x * force.y + arm.y * force.x);
    };
    for (const Contact& contact : assembly.contacts) {
        if (contact.dropped || contact.material == inside_grains) continue;
        const ContactFrame frame = contact_frame(assembly, contact);
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
            const BondState bond = assembly.bond(p);
            const Vec2 x = frame.reference_point + assembly.points[p].along_m * frame.edge_tangent;
            const Vec2 on_b = bond.Fn_N * frame.n + bond.Fs_N * rot90(frame.n);
            add(contact.a, x, -on_b);
            add(contact.b, x, on_b);
        }
    }
    for (Mat2& sum : sums) sum.yx = sum.xy;
}

std::vector<Mat2> grain_stresses(const Assembly& assembly, const Specimen& specimen) {
    const GrainMesh& mesh = specimen.mesh;
    std::vector<Mat2> sums(mesh.vertex_count.size());
    sum_grain_moments(assembly, mesh, sums);
    for (std::size_t g = 0; g < sums.size(); ++g) {
        std::vector<Vec2> corners(mesh.nodes.begin() + mesh.node_begin[g],
                                  mesh.nodes.begin() + mesh.node_begin[g] + mesh.vertex_count[g]);
        const double per_volume = 1.0 / (signed_area(corners) * assembly.thickness_m);
        sums[g] = {per_volume * sums[g].xx, per_volume * sums[g].xy, per_volume * sums[g].xy, per_volume * sums[g].yy};
    }
    return sums;
}

}  // namespace feldspar
