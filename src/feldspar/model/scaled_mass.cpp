// Masses that make a step stable: docs/theory/motion-and-mass.md.
#include <algorithm>
#include <cmath>
#include <vector>

#include "feldspar/model/assemble.hpp"

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

// Calls visit(node, |N|, sum of |N|, kn, ks, n) for every node of every point of a contact, in the undeformed state for
// bonded contacts and with the remembered shape functions for all.
template <class Visit>
void visit_contact_stiffness(const Assembly& body, const Contact& contact, Visit visit) {
    const BondLaw& law = body.laws[contact.material];
    const Vec2 n = contact_frame(body, contact).n;
    for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
        const InitialShape& shape = body.initial_shapes[p];
        const double kn = law.Kn_Pa_m * body.points[p].area_m2, ks = law.Ks_Pa_m * body.points[p].area_m2;
        double sum = 0.0;
        for (int i = 0; i < 3; ++i) sum += std::abs(shape.a[i]) + (contact.b.grain >= 0 ? std::abs(shape.b[i]) : 0.0);
        for (int i = 0; i < 3; ++i) {
            visit(contact.a.node[i], std::abs(shape.a[i]), sum, kn, ks, n);
            if (contact.b.grain >= 0) visit(contact.b.node[i], std::abs(shape.b[i]), sum, kn, ks, n);
        }
    }
}

// Row sums of |K_FE| of the assembled grain, a node's two rows.
std::vector<Vec2> finite_element_row_sums(const Assembly& body) {
    std::vector<Vec2> sums(body.nodes.reference.size());
    const double D11 = body.elasticity.D11, D12 = body.elasticity.D12, D33 = 0.5 * (D11 - D12);
    std::vector<double> K;
    for (const Grain& grain : body.grains) {
        const int n = grain.node_end - grain.node_begin, dofs = 2 * n;
        K.assign(static_cast<std::size_t>(dofs) * dofs, 0.0);
        for (int t = grain.triangle_begin; t < grain.triangle_end; ++t) {
            const Triangle& triangle = body.triangles[t];
            const Vec2 g1 = triangle.gradient[0], g2 = triangle.gradient[1];
            const std::array<Vec2, 3> g = {-(g1 + g2), g1, g2};
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    double* row = &K[static_cast<std::size_t>(2 * (triangle.node[i] - grain.node_begin)) * dofs];
                    const int column = 2 * (triangle.node[j] - grain.node_begin);
                    const double V = triangle.volume_m3;
                    row[column] += V * (D11 * g[i].x * g[j].x + D33 * g[i].y * g[j].y);
                    row[column + 1] += V * (D12 * g[i].x * g[j].y + D33 * g[i].y * g[j].x);
                    row[dofs + column] += V * (D12 * g[i].y * g[j].x + D33 * g[i].x * g[j].y);
                    row[dofs + column + 1] += V * (D11 * g[i].y * g[j].y + D33 * g[i].x * g[j].x);
                }
        }
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < dofs; ++j) {
                sums[grain.node_begin + i].x += std::abs(K[static_cast<std::size_t>(2 * i) * dofs + j]);
                sums[grain.node_begin + i].y += std::abs(K[static_cast<std::size_t>(2 * i + 1) * dofs + j]);
            }
    }
    return sums;
}

void set_mass(Nodes& nodes, int node, double mass) {
    nodes.mass[node] = mass;
    Vec2& inverse = nodes.inverse_mass[node];
    if (inverse.x != 0.0) inverse.x = 1.0 / mass;
    if (inverse.y != 0.0) inverse.y = 1.0 / mass;
}

}  // namespace

void set_scaled_masses(Assembly& body, MassBound bound, double factor) {
    const std::vector<Vec2> rows = finite_element_row_sums(body);
    const int count = body.nodes.count();
    if (bound == MassBound::row_sum) {
        std::vector<double> K(count);
        for (int i = 0; i < count; ++i) K[i] = std::max(rows[i].x, rows[i].y);
        for (const Contact& contact : body.contacts)
            visit_contact_stiffness(body, contact, [&](int node, double N, double, double kn, double ks, Vec2) { K[node] += 2.0 * (kn + ks) * N; });
        for (int i = 0; i < count; ++i) set_mass(body.nodes, i, 0.25 * factor * K[i]);
        return;
    }
    std::vector<StiffnessTensor> T(count);
    for (int i = 0; i < count; ++i) T[i] = {rows[i].x, 0.0, rows[i].y};
    for (const Contact& contact : body.contacts)
        visit_contact_stiffness(body, contact, [&](int node, double N, double sum, double kn, double ks, Vec2 n) {
            T[node].add(sum * N * kn, n);
            T[node].add(sum * N * ks, rot90(n));
        });
    for (int i = 0; i < count; ++i) set_mass(body.nodes, i, 0.25 * factor * T[i].largest_eigenvalue());
}

void set_real_masses(Assembly& body, double density_kg_m3) {
    std::vector<double> mass(body.nodes.reference.size(), 0.0);
    for (const Triangle& triangle : body.triangles)
        for (const int node : triangle.node) mass[node] += density_kg_m3 * triangle.volume_m3 / 3.0;
    for (int i = 0; i < body.nodes.count(); ++i) set_mass(body.nodes, i, mass[i]);
}

double add_mass(Nodes& nodes, int node, double mass_kg) {
    set_mass(nodes, node, nodes.mass[node] + mass_kg);
    const double free_x = nodes.inverse_mass[node].x != 0.0, free_y = nodes.inverse_mass[node].y != 0.0;
    const Vec2 v = nodes.velocity[node];
    return 0.5 * mass_kg * (free_x * v.x * v.x + free_y * v.y * v.y);
}

double add_contact_mass(Assembly& body, const Contact& contact, double factor) {
    double kinetic = 0.0;
    visit_contact_stiffness(body, contact, [&](int node, double N, double sum, double kn, double ks, Vec2) {
        kinetic += add_mass(body.nodes, node, 0.25 * factor * sum * N * std::max(kn, ks));
    });
    return kinetic;
}

}  // namespace feldspar
