// Masses that make a step stable, and real ones: docs/theory/motion-and-mass.md.
#include "feldspar/model/masses.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "feldspar/model/attachment.hpp"

namespace feldspar {
namespace {

// A symmetric 2 x 2 tensor a node collects.
struct StiffnessTensor {
    double xx = 0.0, xy = 0.0, yy = 0.0;

    void add(double k, Vec2 n) {
        xx += k * n.x * n.x;
        xy += k * n.x * n.y;
        yy += k * n.y * n.y;
    }
    double largest_eigenvalue() const {
        const double half_trace = 0.5 * (xx + yy), half_difference = 0.5 * (xx - yy);
        return half_trace + std::sqrt(half_difference * half_difference + xy * xy);
    }
};

// How a point of a rigid body moves along n by the body's three degrees of freedom.
Eigen::Vector3d direction(Vec2 n, RigidAttachment::Weights arc) { return {n.x, n.y, dot(n, arc)}; }

double largest_eigenvalue(const Eigen::Matrix3d& tensor) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

// What a side weighs in the Cauchy-Schwarz bound: the sum of |N| of a triangle, 1 for a rigid body or a free plate, 0 for a
// plate whose motion is imposed.
double size(const Assembly&, const ContactSide&, const TriangleAttachment::Weights& N) {
    return std::abs(N[0]) + std::abs(N[1]) + std::abs(N[2]);
}
double size(const Assembly&, const ContactSide&, RigidAttachment::Weights) { return 1.0; }
double size(const Assembly& assembly, const ContactSide& side, PlateAttachment::Weights) {
    return assembly.nodes.inverse_mass[side.node[0]] == Vec2{} ? 0.0 : 1.0;
}

// Calls visit(kn, ks, n, weights of A, weights of B) for every point of a contact in the present state.
template <class Visit>
void visit_points(const Assembly& assembly, const Contact& contact, Visit visit) {
    const BondLaw law = assembly.law_of(contact);
    const ContactFrame frame = contact_frame(assembly, contact);
    with_attachments(contact, [&]<class A, class B>() {
        const A a(assembly, contact.a);
        const B b(assembly, contact.b);
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
            const Vec2 x = frame.reference_point + assembly.points[p].along_m * frame.edge_tangent;
            const double area = assembly.points[p].area_m2;
            visit(law.Kn_Pa_m * area, law.Ks_Pa_m * area, frame.n, a.at(x), b.at(x));
        }
    });
}

// Row sums of |K_FE| of the assembled grain, a node's two rows.
std::vector<Vec2> finite_element_row_sums(const Assembly& assembly) {
    std::vector<Vec2> sums(assembly.nodes.reference.size());
    std::vector<double> K;
    for (int b = 0; b < std::ssize(assembly.bodies); ++b) {
        const Body& body = assembly.bodies[b];
        if (body.kind != BodyKind::flexible) continue;
        const auto [D11, D12] = assembly.elasticity_of(b);
        const double D33 = 0.5 * (D11 - D12);
        const int n = body.node_count, dofs = 2 * n;
        const auto local = [&](int node) { return (node - body.first_node) / body.node_stride; };
        K.assign(static_cast<std::size_t>(dofs) * dofs, 0.0);
        for (int t = body.triangle_begin; t < body.triangle_end; ++t) {
            const Triangle& triangle = assembly.triangles[t];
            const Vec2 g1 = triangle.gradient[0], g2 = triangle.gradient[1];
            const std::array<Vec2, 3> g = {-(g1 + g2), g1, g2};
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    double* row = &K[static_cast<std::size_t>(2 * local(triangle.node[i])) * dofs];
                    const int column = 2 * local(triangle.node[j]);
                    const double V = triangle.volume_m3;
                    row[column] += V * (D11 * g[i].x * g[j].x + D33 * g[i].y * g[j].y);
                    row[column + 1] += V * (D12 * g[i].x * g[j].y + D33 * g[i].y * g[j].x);
                    row[dofs + column] += V * (D12 * g[i].y * g[j].x + D33 * g[i].x * g[j].y);
                    row[dofs + column + 1] += V * (D11 * g[i].y * g[j].y + D33 * g[i].x * g[j].x);
                }
        }
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < dofs; ++j) {
                sums[body.node(i)].x += std::abs(K[static_cast<std::size_t>(2 * i) * dofs + j]);
                sums[body.node(i)].y += std::abs(K[static_cast<std::size_t>(2 * i + 1) * dofs + j]);
            }
    }
    return sums;
}

// Row sums of a rigid body's exact stiffness: its own 3 x 3 block, and those that couple it with its neighbours.
class RigidRows {
public:
    explicit RigidRows(const Assembly& assembly)
        : own_(assembly.bodies.size(), Eigen::Matrix3d::Zero()), coupled_(assembly.bodies.size(), Eigen::Vector3d::Zero()) {
        for (const Contact& contact : assembly.contacts) add(assembly, contact);
    }
    /// Of the two translations, and of the turn.
    std::array<double, 2> of(int body) const {
        const Eigen::Vector3d rows = own_[body].cwiseAbs().rowwise().sum() + coupled_[body];
        return {std::max(rows[0], rows[1]), rows[2]};
    }

private:
    void add(const Assembly& assembly, const Contact& contact) {
        Eigen::Matrix3d ab = Eigen::Matrix3d::Zero();
        visit_points(assembly, contact, [&]<class WA, class WB>(double kn, double ks, Vec2 n, const WA& Na, const WB& Nb) {
            if constexpr (std::is_same_v<WA, RigidAttachment::Weights>) {
                for (const auto& [k, d] : {std::pair{kn, n}, std::pair{ks, rot90(n)}}) {
                    const Eigen::Vector3d a = direction(d, Na);
                    own_[contact.a.body] += k * a * a.transpose();
                    if constexpr (std::is_same_v<WB, RigidAttachment::Weights>) {
                        const Eigen::Vector3d b = direction(d, Nb);
                        own_[contact.b.body] += k * b * b.transpose();
                        ab += k * a * b.transpose();
                    } else {
                        coupled_[contact.a.body] +=
                            size(assembly, contact.b, Nb) * k * a.cwiseAbs() * (std::abs(d.x) + std::abs(d.y));
                    }
                }
            }
        });
        if (contact.plate) return;
        coupled_[contact.a.body] += ab.cwiseAbs().rowwise().sum();
        coupled_[contact.b.body] += ab.cwiseAbs().colwise().sum().transpose();
    }
    std::vector<Eigen::Matrix3d> own_;
    std::vector<Eigen::Vector3d> coupled_;
};

void set_mass(Nodes& nodes, int node, double mass) {
    nodes.mass[node] = mass;
    Vec2& inverse = nodes.inverse_mass[node];
    if (inverse.x != 0.0) inverse.x = 1.0 / mass;
    if (inverse.y != 0.0) inverse.y = 1.0 / mass;
}

// Springs that press plates: visit(node, stiffness, direction).
template <class Visit>
void add_springs(const Assembly& assembly, Visit visit) {
    for (const PressureEdge& edge : assembly.pressure_edges)
        if (const double k = assembly.dead_loads[edge.load].stiffness_Pa_m; k > 0.0)
            visit(edge.node_a, k * edge.plate_length_m * assembly.thickness_m, edge.outward);
}

// Paper, equations (20)-(21).
void set_masses_by_rows(Assembly& assembly, double factor) {
    const std::vector<Vec2> rows = finite_element_row_sums(assembly);
    std::vector<double> K(rows.size());
    for (std::size_t i = 0; i < K.size(); ++i) K[i] = std::max(rows[i].x, rows[i].y);
    for (const Contact& contact : assembly.contacts)
        visit_points(assembly, contact, [&]<class WA, class WB>(double kn, double ks, Vec2, const WA& Na, const WB& Nb) {
            if constexpr (std::is_same_v<WA, TriangleAttachment::Weights>)
                for (int i = 0; i < 3; ++i) K[contact.a.node[i]] += 2.0 * (kn + ks) * std::abs(Na[i]);
            if constexpr (std::is_same_v<WB, TriangleAttachment::Weights>)
                for (int i = 0; i < 3; ++i) K[contact.b.node[i]] += 2.0 * (kn + ks) * std::abs(Nb[i]);
            if constexpr (std::is_same_v<WB, PlateAttachment::Weights>) K[contact.b.node[0]] += 2.0 * (kn + ks);
        });
    if (std::any_of(assembly.bodies.begin(), assembly.bodies.end(),
                    [](const Body& body) { return body.kind == BodyKind::rigid; })) {
        const RigidRows rigid(assembly);
        for (int b = 0; b < std::ssize(assembly.bodies); ++b) {
            if (assembly.bodies[b].kind != BodyKind::rigid) continue;
            const auto [translation, turn] = rigid.of(b);
            K[assembly.bodies[b].centre_node] = translation;
            K[assembly.bodies[b].centre_node + 1] = turn;
        }
    }
    add_springs(assembly, [&](int node, double k, Vec2) { K[node] += k; });
    for (int i = 0; i < assembly.nodes.count(); ++i) set_mass(assembly.nodes, i, 0.25 * factor * K[i]);
}

// (M8)-(M11): k (sum of g u)^2 <= k S (sum of what each side adds), with S the sizes of both sides.
void set_masses_by_tensors(Assembly& assembly, double factor) {
    const std::vector<Vec2> rows = finite_element_row_sums(assembly);
    std::vector<StiffnessTensor> T(rows.size());
    std::vector<Eigen::Matrix3d> rigid(assembly.bodies.size(), Eigen::Matrix3d::Zero());
    for (std::size_t i = 0; i < T.size(); ++i) T[i] = {rows[i].x, 0.0, rows[i].y};
    const auto add = [&]<class Weights>(const ContactSide& side, const Weights& N, double k, Vec2 n) {
        if constexpr (std::is_same_v<Weights, TriangleAttachment::Weights>) {
            for (int i = 0; i < 3; ++i) T[side.node[i]].add(k * std::abs(N[i]), n);
        } else if constexpr (std::is_same_v<Weights, RigidAttachment::Weights>) {
            const Eigen::Vector3d d = direction(n, N);
            rigid[side.body] += k * d * d.transpose();
        } else {
            T[side.node[0]].add(k, n);
        }
    };
    for (const Contact& contact : assembly.contacts)
        visit_points(assembly, contact, [&](double kn, double ks, Vec2 n, const auto& Na, const auto& Nb) {
            const double S = size(assembly, contact.a, Na) + size(assembly, contact.b, Nb);
            for (const auto& [k, d] : {std::pair{kn, n}, std::pair{ks, rot90(n)}}) {
                add(contact.a, Na, S * k, d);
                add(contact.b, Nb, S * k, d);
            }
        });
    add_springs(assembly, [&](int node, double k, Vec2 n) { T[node].add(k, n); });
    for (int i = 0; i < assembly.nodes.count(); ++i) set_mass(assembly.nodes, i, 0.25 * factor * T[i].largest_eigenvalue());
    for (std::size_t b = 0; b < assembly.bodies.size(); ++b) {
        const Body& body = assembly.bodies[b];
        if (body.kind != BodyKind::rigid) continue;
        const double mass = 0.25 * factor * largest_eigenvalue(rigid[b]);
        set_mass(assembly.nodes, body.centre_node, mass);
        set_mass(assembly.nodes, body.centre_node + 1, mass);
    }
}

// Of the bodies that are no plates.
double mean_density(const Assembly& assembly) {
    double first = 0.0, sum = 0.0;
    int count = 0;
    bool alike = true;
    for (const Body& body : assembly.bodies) {
        if (body.kind == BodyKind::plate) continue;
        if (count++ == 0) first = body.density_kg_m3;
        alike = alike && body.density_kg_m3 == first;
        sum += body.density_kg_m3;
    }
    return alike ? first : sum / count;
}

double mean_grain_radius(const Assembly& assembly) {
    double sum = 0.0;
    int count = 0;
    for (const Body& body : assembly.bodies) {
        if (body.kind == BodyKind::plate) continue;
        sum += body.radius_m;
        ++count;
    }
    return sum / count;
}

}  // namespace

void set_scaled_masses(Assembly& assembly, MassBound bound, double factor) {
    if (bound == MassBound::row_sum) {
        set_masses_by_rows(assembly, factor);
    } else {
        set_masses_by_tensors(assembly, factor);
    }
}

namespace {

// Of the nodes of grains and particles, kg; of a turn the moment of inertia over the radius squared.
std::vector<double> real_masses(const Assembly& assembly) {
    std::vector<double> mass(assembly.nodes.reference.size(), 0.0);
    for (const Body& body : assembly.bodies) {
        for (int t = body.triangle_begin; t < body.triangle_end; ++t)
            for (const int node : assembly.triangles[t].node)
                mass[node] += body.density_kg_m3 * assembly.triangles[t].volume_m3 / 3.0;
        if (body.kind != BodyKind::rigid) continue;
        mass[body.centre_node] = body.density_kg_m3 * body.volume_m3;
        mass[body.centre_node + 1] = body.density_kg_m3 * body.volume_m3 * body.gyration_m2 / (body.radius_m * body.radius_m);
    }
    return mass;
}

}  // namespace

Array<Vec2> weights(const Assembly& assembly, Vec2 gravity_m_s2) {
    std::vector<double> mass = real_masses(assembly);
    for (const Body& body : assembly.bodies)
        if (body.kind == BodyKind::rigid) mass[body.centre_node + 1] = 0.0;  // gravity turns nothing
    Array<Vec2> weight(mass.size());
    for (std::size_t n = 0; n < mass.size(); ++n) weight[n] = mass[n] * gravity_m_s2;
    return weight;
}

void set_real_masses(Assembly& assembly) {
    std::vector<double> mass = real_masses(assembly);
    const double density_kg_m3 = mean_density(assembly);
    for (const PressureEdge& edge : assembly.pressure_edges)
        if (edge.plate_length_m > 0.0)
            mass[edge.node_a] = density_kg_m3 * edge.plate_length_m * assembly.thickness_m * mean_grain_radius(assembly);
    for (int i = 0; i < assembly.nodes.count(); ++i)
        if (mass[i] > 0.0) set_mass(assembly.nodes, i, mass[i]);
}

double add_mass(Nodes& nodes, int node, double mass_kg) {
    set_mass(nodes, node, nodes.mass[node] + mass_kg);
    const double free_x = nodes.inverse_mass[node].x != 0.0, free_y = nodes.inverse_mass[node].y != 0.0;
    const Vec2 v = nodes.velocity[node];
    return 0.5 * mass_kg * (free_x * v.x * v.x + free_y * v.y * v.y);
}

double add_contact_mass(Assembly& assembly, const Contact& contact, double factor) {
    double kinetic = 0.0;
    Nodes& nodes = assembly.nodes;
    const auto add = [&]<class Weights>(const ContactSide& side, const Weights& N, double k) {
        if constexpr (std::is_same_v<Weights, TriangleAttachment::Weights>) {
            for (int i = 0; i < 3; ++i) kinetic += add_mass(nodes, side.node[i], 0.25 * factor * k * std::abs(N[i]));
        } else if constexpr (std::is_same_v<Weights, RigidAttachment::Weights>) {
            for (const int node : {side.node[0], side.node[1]})
                kinetic += add_mass(nodes, node, 0.25 * factor * k * (1.0 + dot(N, N)));
        } else {
            kinetic += add_mass(nodes, side.node[0], 0.25 * factor * k);
        }
    };
    visit_points(assembly, contact, [&](double kn, double ks, Vec2, const auto& Na, const auto& Nb) {
        const double k = (size(assembly, contact.a, Na) + size(assembly, contact.b, Nb)) * std::max(kn, ks);
        add(contact.a, Na, k);
        add(contact.b, Nb, k);
    });
    return kinetic;
}

}  // namespace feldspar
