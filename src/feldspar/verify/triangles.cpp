// The elastic law of the triangles that grains are made of, alone and in a whole body.
#include <algorithm>
#include <cmath>

#include "feldspar/lab/body_energy.hpp"
#include "feldspar/laws/plane_elasticity.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/verify/bodies.hpp"
#include "feldspar/verify/topics.hpp"

namespace feldspar {
namespace {

using namespace bodies;

constexpr double kE = 25.8e9, kNu = 0.23;

Mat2 rotated(double angle, const Mat2& F) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * F.xx - s * F.yx, c * F.xy - s * F.yy, s * F.xx + c * F.yx, s * F.xy + c * F.yy};
}

Mat2 gradient(const Mat2& F) { return {F.xx - 1.0, F.xy, F.yx, F.yy - 1.0}; }

PlaneElasticity plane_stress() { return plane_elasticity(kE, kNu, PlaneState::stress); }

// Central differences of the energy.
Mat2 energy_slope(const Mat2& G, double h) {
    const PlaneElasticity D = plane_stress();
    const auto slope = [&](double Mat2::*entry) {
        Mat2 up = G, down = G;
        up.*entry += h;
        down.*entry -= h;
        return (strain_energy_density(D, up) - strain_energy_density(D, down)) / (2.0 * h);
    };
    return {slope(&Mat2::xx), slope(&Mat2::xy), slope(&Mat2::yx), slope(&Mat2::yy)};
}

std::vector<CheckedValue> stress_by_energy() {
    std::vector<CheckedValue> compared;
    for (const double size : {1e-1, 1e-3, 1e-5}) {
        const Mat2 G = {0.3 * size, -0.7 * size, 0.4 * size, -0.9 * size}, P = first_piola_stress(plane_stress(), G),
                   S = energy_slope(G, 1e-4 * size);
        const double largest = std::abs(P.yy);
        const char* how = size > 0.01 ? "10 %" : size > 1e-4 ? "0.1 %" : "0.001 %";
        for (const auto& [entry, label] :
             {std::pair{&Mat2::xx, "xx"}, std::pair{&Mat2::xy, "xy"}, std::pair{&Mat2::yx, "yx"}, std::pair{&Mat2::yy, "yy"}})
            compared.push_back({std::string(label) + ", strain " + how, P.*entry / largest, S.*entry / largest});
    }
    return compared;
}

// By how much the difference falls when the step is halved, as a power of two.
std::vector<CheckedValue> order_of_differences() {
    const Mat2 G = {0.03, -0.07, 0.04, -0.09};
    const double P = first_piola_stress(plane_stress(), G).yy;
    const double coarse = energy_slope(G, 2e-2).yy - P, fine = energy_slope(G, 1e-2).yy - P;
    return {{"", 2.0, std::log2(coarse / fine)}};
}

std::vector<CheckedValue> turned_stress() {
    const Mat2 F = {1.002, 0.0015, -0.0005, 0.997}, FR = rotated(0.7, F);
    const Mat2 expected = rotated(0.7, first_piola_stress(plane_stress(), gradient(F))),
               P = first_piola_stress(plane_stress(), gradient(FR));
    return {{"xx", 1e-6 * expected.xx, 1e-6 * P.xx},
            {"xy", 1e-6 * expected.xy, 1e-6 * P.xy},
            {"yx", 1e-6 * expected.yx, 1e-6 * P.yx},
            {"yy", 1e-6 * expected.yy, 1e-6 * P.yy}};
}

std::vector<CheckedValue> turned_energy() {
    const Mat2 F = {1.002, 0.0015, -0.0005, 0.997};
    return {{"", 1e-3 * strain_energy_density(plane_stress(), gradient(F)),
             1e-3 * strain_energy_density(plane_stress(), gradient(rotated(0.7, F)))}};
}

std::vector<CheckedValue> hooke() {
    constexpr double strain = 1e-7;
    const Mat2 stress = first_piola_stress(plane_stress(), {strain, 0, 0, -kNu * strain});
    const Mat2 plane =
        first_piola_stress(plane_elasticity(kE, kNu, PlaneState::strain), {strain, 0, 0, -kNu / (1.0 - kNu) * strain});
    return {{"plane stress, along", kE * strain, stress.xx},
            {"plane stress, across", 0.0, stress.yy},
            {"plane strain, along", kE / (1.0 - kNu * kNu) * strain, plane.xx},
            {"plane strain, across", 0.0, plane.yy}};
}

std::vector<CheckedValue> cauchy() {
    constexpr double lx = 1.1, ly = 0.95, angle = 0.7;  // large, so that the sections differ from the undeformed ones
    const Mat2 P = first_piola_stress(plane_stress(), {lx - 1.0, 0, 0, ly - 1.0});
    const double sx = P.xx / ly, sy = P.yy / lx, c = std::cos(angle), s = std::sin(angle);
    const Mat2 stress = cauchy_stress(plane_stress(), gradient(rotated(angle, {lx, 0, 0, ly})));
    return {{"xx", 1e-9 * (c * c * sx + s * s * sy), 1e-9 * stress.xx},
            {"yy", 1e-9 * (s * s * sx + c * c * sy), 1e-9 * stress.yy},
            {"xy", 1e-9 * c * s * (sx - sy), 1e-9 * stress.xy},
            {"yx", 1e-9 * c * s * (sx - sy), 1e-9 * stress.yx}};
}

Assembly small_body() { return assemble(*make(rectangle(0.02, 0.04)), ModelSpec{}, granite(), table7()); }

std::vector<CheckedValue> rigid_rotation() {
    Assembly assembly = small_body();
    Team team(1);
    for (int n = 0; n < assembly.nodes.count(); ++n)
        assembly.nodes.displacement[n] = turned(assembly.nodes.reference[n], 0.3) - assembly.nodes.reference[n];
    evaluate_forces(assembly, team, Strength::real);
    double largest = 0.0;
    for (const Vec2 f : assembly.nodes.force) largest = std::max(largest, norm(f));
    return {{"", 0.0, largest / (kE * assembly.thickness_m * 1e-3)}};
}

struct Strained {
    double largest_inside = 0.0, energy = 0.0, expected_energy = 0.0;
};

Strained homogeneous_strain() {
    Assembly assembly = small_body();
    Team team(1);
    constexpr double xx = 1e-6, yy = -2e-6, xy = 0.5e-6;
    for (int n = 0; n < assembly.nodes.count(); ++n) {
        const Vec2 X = assembly.nodes.reference[n];
        assembly.nodes.displacement[n] = {xx * X.x + xy * X.y, xy * X.x + yy * X.y};
    }
    evaluate_forces(assembly, team, Strength::real);
    Strained s;
    double volume = 0.0;
    for (const Body& grain : assembly.bodies)
        for (int i = grain.edge_end - grain.edge_begin; i < grain.node_count; ++i)
            s.largest_inside = std::max(s.largest_inside, norm(assembly.nodes.force[grain.node(i)]));
    s.largest_inside /= kE * 2e-6 * assembly.thickness_m * 1e-3;
    for (const Triangle& t : assembly.triangles) volume += t.volume_m3;
    const PlaneElasticity D = plane_stress();
    s.expected_energy = 0.5 * (D.D11 * (xx * xx + yy * yy) + 2.0 * D.D12 * xx * yy + 2.0 * (D.D11 - D.D12) * xy * xy) * volume;
    s.energy = stored_energy(assembly, 0.0).grains_J;
    return s;
}

}  // namespace

std::vector<Check> triangle_checks() {
    return {
        {.name = "triangles.stress-is-the-slope-of-the-energy",
         .sentence = "The stress of a triangle is the derivative of its energy, for small and large strains; given over the "
                     "largest component.",
         .formula = "P = dW / dF",
         .source = "docs/theory/triangles.md",
         .bound = absolute(1e-7),
         .reason = "central differences of relative step 1e-4: truncation 1e-8, rounding 1e-12 and, at the smallest strain, more",
         .compare = stress_by_energy},
        {.name = "triangles.order-of-the-slope",
         .sentence = "Central differences of the energy come to the stress with the second order in their step.",
         .formula = "log2(error(h) / error(h / 2)) = 2",
         .source = "Taylor's series",
         .bound = absolute(0.05),
         .reason = "terms of fourth order at a step of 2 %",
         .compare = order_of_differences},
        {.name = "triangles.rotation-turns-the-stress",
         .sentence = "A rotation turns the stress of a triangle and changes nothing else.",
         .formula = "P(R F) = R P(F)",
         .source = "docs/theory/triangles.md",
         .unit = "MPa",
         .bound = absolute(1e-4),
         .reason = "a millionth of the largest component",
         .compare = turned_stress},
        {.name = "triangles.rotation-keeps-the-energy",
         .sentence = "A rotation leaves the energy of a triangle as it is.",
         .formula = "W(R F) = W(F)",
         .source = "docs/theory/triangles.md",
         .unit = "kJ/m3",
         .bound = relative(1e-10),
         .reason = "rounding of strains of 0.2 %",
         .compare = turned_energy},
        {.name = "triangles.hooke",
         .sentence = "Pulled along one axis a triangle has Hooke's law, in plane stress and in plane strain.",
         .formula = "sigma = E eps, E / (1 - nu^2) eps",
         .source = "Hooke",
         .unit = "Pa",
         .bound = absolute(2.6e-3),
         .reason = "the finite strain of 1e-7 itself, of some 2600 Pa",
         .compare = hooke},
        {.name = "triangles.cauchy",
         .sentence = "The Cauchy stress of a large strain is force over the deformed section, and turns with the body.",
         .formula = "sigma = R diag(Px / ly, Py / lx) R^T",
         .source = "docs/theory/triangles.md",
         .unit = "GPa",
         .bound = absolute(1e-11),
         .reason = "rounding of some 2 GPa",
         .compare = cauchy},
        {.name = "triangles.rigid-rotation-of-a-body",
         .sentence = "A specimen that turns by 0.3 rad as a whole has no forces in it; largest force over E t 1 mm.",
         .formula = "F = 0",
         .source = "docs/theory/triangles.md",
         .bound = absolute(1e-9),
         .reason = "rounding of positions of 0.04 m",
         .compare = rigid_rotation},
        {.name = "triangles.homogeneous-strain-forces",
         .sentence = "Under a homogeneous strain the nodes inside of grains feel no force; largest one over E eps t 1 mm.",
         .formula = "F = 0",
         .source = "docs/theory/triangles.md",
         .bound = absolute(1e-8),
         .reason = "rounding over a strain of 1e-6",
         .compare =
             [] {
                 return std::vector<CheckedValue>{{"", 0.0, homogeneous_strain().largest_inside}};
             }},
        {.name = "triangles.homogeneous-strain-energy",
         .sentence = "A homogeneous strain has the elastic energy of Hooke's law.",
         .formula = "W = V (D11 (exx^2 + eyy^2) + 2 D12 exx eyy + 2 (D11 - D12) exy^2) / 2",
         .source = "docs/theory/triangles.md",
         .unit = "uJ",
         .bound = relative(1e-5),
         .reason = "the finite strain of 2e-6 itself",
         .compare =
             [] {
                 const Strained s = homogeneous_strain();
                 return std::vector<CheckedValue>{{"", 1e6 * s.expected_energy, 1e6 * s.energy}};
             }},
    };
}

}  // namespace feldspar
