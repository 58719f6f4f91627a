#include "feldspar/lab/stability.hpp"

#include <cmath>

#include <Eigen/Dense>

#include "feldspar/base/rng.hpp"

namespace feldspar {
namespace {

// K x of the linearised body, from the forces of one step.
void apply_stiffness(Assembly& assembly, Team& team, const Eigen::VectorXd& x, Eigen::VectorXd& Kx) {
    constexpr double kAmplitude = 1e-12;   // m: rotations of 1e-8, far from both nonlinearity and rounding
    Nodes& nodes = assembly.nodes;
    StepSettings settings;
    settings.strength = Strength::unlimited;
    const double scale = kAmplitude / x.lpNorm<Eigen::Infinity>();
    const std::size_t bonds = assembly.points.size();
    assembly.bonds.resize(0);   // keeps the memory: this is done 80 times
    assembly.bonds.resize(bonds);
    for (int n = 0; n < nodes.count(); ++n) nodes.displacement[n] = nodes.velocity[n] = {scale * x[2 * n], scale * x[2 * n + 1]};
    PlatenWork none;
    advance(assembly, team, settings, -1, 1, none);   // contacts feel the velocity, triangles the displacement; where it all goes then is of no interest
    for (int n = 0; n < nodes.count(); ++n) {
        Kx[2 * n] = -nodes.force[n].x / scale;
        Kx[2 * n + 1] = -nodes.force[n].y / scale;
    }
}

}  // namespace

double largest_omega2(Assembly assembly, Team& team) {
    const int dofs = 2 * assembly.nodes.count(), iterations = 80;
    for (DeadLoad& load : assembly.dead_loads) {   // springs press plates, whose masses allow for them
        load.pressure_Pa = 0.0;
        load.springs = false;
    }
    assembly.weight = {};
    Eigen::VectorXd root_inverse_mass(dofs);   // 0 where the motion is imposed
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
        const Eigen::VectorXd x = root_inverse_mass.cwiseProduct(q);
        apply_stiffness(assembly, team, x, w);
        w = root_inverse_mass.cwiseProduct(w) - last_beta * previous;
        alpha[steps] = q.dot(w);
        w -= alpha[steps] * q;
        last_beta = w.norm();
        beta[steps] = last_beta;
        if (last_beta < 1e-12 * std::abs(alpha[0])) {
            ++steps;
            break;
        }
        previous = q;
        q = w / last_beta;
    }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    if (steps == 1) return alpha[0];
    solver.computeFromTridiagonal(alpha.head(steps), beta.head(steps - 1), Eigen::EigenvaluesOnly);
    return solver.eigenvalues().maxCoeff();
}

}  // namespace feldspar
