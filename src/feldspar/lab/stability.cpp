#include "feldspar/lab/stability.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "feldspar/base/rng.hpp"
#include "feldspar/step/advance_packs.hpp"

namespace feldspar {
namespace {

// The numbers of a bond as the body has them before anything happens.
bool as_new(const BondState& s) {
    for (const double value : {s.un_m, s.us_m, s.Fn_N, s.Fs_N, s.max_un_m, s.max_us_m, s.damage, s.fracture_J, s.friction_J})
        if (value != 0.0 || std::signbit(value)) return false;
    return true;
}

// Takes loads and bonds off a body at rest, and puts them back at the end. A copy of the body would be several times as large,
// and one of the bonds a tenth of it: of these only the few are kept that are not as new, such as those of plates.
class Unloaded {
public:
    Unloaded(Assembly& body, Team& team) : body_(body), team_(team), dead_loads_(body.dead_loads) {
        for (std::size_t i = 0; i < body_.bonds.un_m.size(); ++i)
            if (const BondState bond = body_.bonds.at(i); !as_new(bond)) bonds_.push_back({i, bond});
        exchange();
        renew(body_.bonds, team_);
        for (DeadLoad& load : body_.dead_loads) {  // springs press plates, whose masses allow for them
            load.pressure_Pa = 0.0;
            load.springs = false;
        }
    }
    ~Unloaded() {
        exchange();
        renew(body_.bonds, team_);
        for (const auto& [i, bond] : bonds_) body_.bonds.set(i, bond);
        body_.dead_loads = std::move(dead_loads_);
        Nodes& nodes = body_.nodes;
        for (Array<Vec2>* state : {&nodes.displacement, &nodes.velocity, &nodes.force})
            std::fill(state->begin(), state->end(), Vec2{});
    }
    Unloaded(const Unloaded&) = delete;
    Unloaded& operator=(const Unloaded&) = delete;

    static void renew(Bonds& b, Team& team) {
        in_shares(&team, static_cast<int>(b.un_m.size()), [&](IndexRange range, int) {
            for (Array<double>* quantity :
                 {&b.un_m, &b.us_m, &b.Fn_N, &b.Fs_N, &b.max_un_m, &b.max_us_m, &b.damage, &b.fracture_J, &b.friction_J})
                std::fill(quantity->begin() + range.begin, quantity->begin() + range.end, 0.0);
        });
    }

private:
    void exchange() {
        std::swap(body_.bonds.slip_m, slip_);
        std::swap(body_.weight, weight_);
    }

    Assembly& body_;
    Team& team_;
    std::vector<std::pair<std::size_t, BondState>> bonds_;
    Array<double> slip_;
    Array<Vec2> weight_;
    std::vector<DeadLoad> dead_loads_;
};

// K of the linearised body in the coordinates factor * q, from the forces of single steps. What a step has to look up in an
// unloaded body is looked up once: it is the same whatever the displacements are.
class Stiffness {
public:
    Stiffness(Assembly& assembly, Team& team, const Eigen::VectorXd& factor) : assembly_(assembly), team_(team), factor_(factor) {
        settings_.strength = Strength::unlimited;
        sort_out_packs(assembly);
        arrays_.emplace(assembly);
    }

    // w = factor * K (factor * q) - share * w.
    void apply(const Eigen::VectorXd& q, double share, Eigen::VectorXd& w) {
        constexpr double kAmplitude = 1e-12;  // m: rotations of 1e-8, far from both nonlinearity and rounding
        Nodes& nodes = assembly_.nodes;
        const double scale = kAmplitude / largest(q);
        Unloaded::renew(assembly_.bonds, team_);
        in_shares(&team_, nodes.count(), [&](IndexRange range, int) {
            for (int n = range.begin; n < range.end; ++n)
                nodes.displacement[n] =
                    nodes.velocity[n] = {scale * (factor_[2 * n] * q[2 * n]), scale * (factor_[2 * n + 1] * q[2 * n + 1])};
        });
        // Contacts feel the velocity, triangles the displacement; where it all goes then is of no interest.
        PlatenWork none;
        write_lines(assembly_, team_, settings_, *arrays_);
        advance_packs(assembly_, team_, settings_, *arrays_, -1, 1, none);
        in_shares(&team_, nodes.count(), [&](IndexRange range, int) {
            for (int n = range.begin; n < range.end; ++n) {
                w[2 * n] = factor_[2 * n] * (-nodes.force[n].x / scale) - share * w[2 * n];
                w[2 * n + 1] = factor_[2 * n + 1] * (-nodes.force[n].y / scale) - share * w[2 * n + 1];
            }
        });
    }

private:
    double largest(const Eigen::VectorXd& q) const {
        std::vector<double> of_threads(static_cast<std::size_t>(team_.size()), 0.0);
        in_shares(&team_, static_cast<int>(q.size()), [&](IndexRange range, int thread) {
            double most = 0.0;
            for (int i = range.begin; i < range.end; ++i) most = std::max(most, std::abs(factor_[i] * q[i]));
            of_threads[static_cast<std::size_t>(thread)] = most;
        });
        return *std::max_element(of_threads.begin(), of_threads.end());
    }

    Assembly& assembly_;
    Team& team_;
    const Eigen::VectorXd& factor_;
    StepSettings settings_;
    std::optional<KernelArrays> arrays_;
};

// Numbers of a vector, by all threads of the team; sums over them stay with one, in an order that does not depend on their
// number.
template <class Change>
void for_each_number(Team& team, Eigen::VectorXd& x, Change change) {
    in_shares(&team, static_cast<int>(x.size()), [&](IndexRange range, int) {
        for (int i = range.begin; i < range.end; ++i) x[i] = change(x[i], i);
    });
}

}  // namespace

double largest_omega2(Assembly& assembly, Team& team) {
    assert(
        std::all_of(assembly.nodes.displacement.begin(), assembly.nodes.displacement.end(), [](Vec2 u) { return u == Vec2{}; }));
    const Unloaded unloaded(assembly, team);
    const int dofs = 2 * assembly.nodes.count(), iterations = 80;
    Eigen::VectorXd root_inverse_mass(dofs);  // 0 where the motion is imposed
    for (int n = 0; n < assembly.nodes.count(); ++n) {
        root_inverse_mass[2 * n] = std::sqrt(assembly.nodes.inverse_mass[n].x);
        root_inverse_mass[2 * n + 1] = std::sqrt(assembly.nodes.inverse_mass[n].y);
    }
    RandomStream random(1, "stability");
    Eigen::VectorXd q(dofs), w = Eigen::VectorXd::Zero(dofs);  // w: the vector before q, until the next takes its place
    for (int i = 0; i < dofs; ++i) q[i] = root_inverse_mass[i] > 0.0 ? random.uniform(-1.0, 1.0) : 0.0;
    q.normalize();
    Stiffness stiffness(assembly, team, root_inverse_mass);
    Eigen::VectorXd alpha(iterations), beta(iterations);
    int steps = 0;
    double last_beta = 0.0;
    for (; steps < iterations; ++steps) {
        stiffness.apply(q, last_beta, w);
        alpha[steps] = q.dot(w);
        for_each_number(team, w, [&, share = alpha[steps]](double value, int i) { return value - share * q[i]; });
        last_beta = w.norm();
        beta[steps] = last_beta;
        if (last_beta < 1e-12 * std::abs(alpha[0])) {
            ++steps;
            break;
        }
        for_each_number(team, w, [&](double value, int) { return value / last_beta; });
        std::swap(w, q);
    }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    if (steps == 1) return alpha[0];
    solver.computeFromTridiagonal(alpha.head(steps), beta.head(steps - 1), Eigen::EigenvaluesOnly);
    return solver.eigenvalues().maxCoeff();
}

}  // namespace feldspar
