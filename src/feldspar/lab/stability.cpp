#include "feldspar/lab/stability.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "feldspar/base/rng.hpp"

namespace feldspar {
namespace {

// Takes loads and bonds off a body at rest, and puts them back at the end. A copy of the body would be several times as large.
class Unloaded {
public:
    explicit Unloaded(Assembly& body) : body_(body), dead_loads_(body.dead_loads) {
        exchange();
        body_.bonds.resize(body_.points.size());
        for (DeadLoad& load : body_.dead_loads) {  // springs press plates, whose masses allow for them
            load.pressure_Pa = 0.0;
            load.springs = false;
        }
    }
    ~Unloaded() {
        exchange();
        body_.dead_loads = std::move(dead_loads_);
        Nodes& nodes = body_.nodes;
        for (Array<Vec2>* state : {&nodes.displacement, &nodes.velocity, &nodes.force})
            std::fill(state->begin(), state->end(), Vec2{});
    }
    Unloaded(const Unloaded&) = delete;
    Unloaded& operator=(const Unloaded&) = delete;

private:
    void exchange() {
        std::swap(body_.bonds, bonds_);
        std::swap(body_.weight, weight_);
    }

    Assembly& body_;
    Bonds bonds_;
    Array<Vec2> weight_;
    std::vector<DeadLoad> dead_loads_;
};

// K x of the linearised body for x = factor * q, from the forces of one step, times factor.
void apply_stiffness(Assembly& assembly, Team& team, const Eigen::VectorXd& factor, const Eigen::VectorXd& q,
                     Eigen::VectorXd& w) {
    constexpr double kAmplitude = 1e-12;  // m: rotations of 1e-8, far from both nonlinearity and rounding
    Nodes& nodes = assembly.nodes;
    StepSettings settings;
    settings.strength = Strength::unlimited;
    const double scale = kAmplitude / factor.cwiseProduct(q).lpNorm<Eigen::Infinity>();
    const std::size_t bonds = assembly.points.size();
    assembly.bonds.resize(0);  // keeps the memory: this is done 80 times
    assembly.bonds.resize(bonds);
    for (int n = 0; n < nodes.count(); ++n)
        nodes.displacement[n] =
            nodes.velocity[n] = {scale * (factor[2 * n] * q[2 * n]), scale * (factor[2 * n + 1] * q[2 * n + 1])};
    PlatenWork none;
    advance(assembly, team, settings, -1, 1,
            none);  // contacts feel the velocity, triangles the displacement; where it all goes then is of no interest
    for (int n = 0; n < nodes.count(); ++n) {
        w[2 * n] = factor[2 * n] * (-nodes.force[n].x / scale);
        w[2 * n + 1] = factor[2 * n + 1] * (-nodes.force[n].y / scale);
    }
}

}  // namespace

double largest_omega2(Assembly& assembly, Team& team) {
    assert(
        std::all_of(assembly.nodes.displacement.begin(), assembly.nodes.displacement.end(), [](Vec2 u) { return u == Vec2{}; }));
    const Unloaded unloaded(assembly);
    const int dofs = 2 * assembly.nodes.count(), iterations = 80;
    Eigen::VectorXd root_inverse_mass(dofs);  // 0 where the motion is imposed
    for (int n = 0; n < assembly.nodes.count(); ++n) {
        root_inverse_mass[2 * n] = std::sqrt(assembly.nodes.inverse_mass[n].x);
        root_inverse_mass[2 * n + 1] = std::sqrt(assembly.nodes.inverse_mass[n].y);
    }
    RandomStream random(1, "stability");
    Eigen::VectorXd q(dofs), previous = Eigen::VectorXd::Zero(dofs), w(dofs);
    for (int i = 0; i < dofs; ++i) q[i] = root_inverse_mass[i] > 0.0 ? random.uniform(-1.0, 1.0) : 0.0;
    q.normalize();
    Eigen::VectorXd alpha(iterations), beta(iterations);
    int steps = 0;
    double last_beta = 0.0;
    for (; steps < iterations; ++steps) {
        apply_stiffness(assembly, team, root_inverse_mass, q, w);
        w -= last_beta * previous;
        alpha[steps] = q.dot(w);
        w -= alpha[steps] * q;
        last_beta = w.norm();
        beta[steps] = last_beta;
        if (last_beta < 1e-12 * std::abs(alpha[0])) {
            ++steps;
            break;
        }
        std::swap(previous, q);
        q = w / last_beta;
    }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    if (steps == 1) return alpha[0];
    solver.computeFromTridiagonal(alpha.head(steps), beta.head(steps - 1), Eigen::EigenvaluesOnly);
    return solver.eigenvalues().maxCoeff();
}

}  // namespace feldspar
