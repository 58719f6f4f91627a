// Smooth joints: Jaeger's plane of weakness, friction and dilation in direct shear.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "feldspar/base/regression.hpp"
#include "feldspar/verify/bodies.hpp"
#include "feldspar/verify/topics.hpp"

namespace feldspar {
namespace {

using namespace bodies;

std::vector<CheckedValue> jaeger() {
    constexpr double c = 5e6, mu = 0.57735;
    std::vector<CheckedValue> compared;
    for (const int beta_deg : {45, 60, 75}) {
        TestSetup s = setup(make(with_joint(0.04, 0.08, beta_deg)), methods::uniaxial_compression);
        s.rock.joints = {smooth_joint(s.contact, mu, c, 3e6)};
        const double beta = beta_deg * std::numbers::pi / 180.0;
        compared.push_back({"normal at " + std::to_string(beta_deg) + " degrees",
                            1e-6 * 2.0 * c / ((1.0 - mu / std::tan(beta)) * std::sin(2.0 * beta)),
                            1e-6 * run_test(s, {}).properties.peak_stress_Pa});
    }
    return compared;
}

constexpr double kMu = 0.5, kTanPsi = 0.2;

// Shear force over normal force, means over the rows from a slip on.
double friction(const TestResult& r, double from_m) {
    double along = 0.0, across = 0.0;
    for (const HistoryRow& row : r.history)
        if (row.phase == Phase::loading && row.axial_strain * r.length_m > from_m) {
            along += row.axial_stress_Pa * r.section_m2;
            across += row.gauges[1];
        }
    return along / across;
}

// The edges of flexible grains tilt as they deform, and with them the planes on which they slide: measured 0.9968 of mu.
std::vector<CheckedValue> frictions() {
    return {{"rigid grains", kMu, friction(sheared_joint(GrainKind::rigid, kMu, kTanPsi, 0.0, 0.0, 0.004), 4e-5)},
            {"flexible grains", kMu, friction(sheared_joint(GrainKind::flexible, kMu, kTanPsi, 0.0, 0.0, 0.004), 4e-5)}};
}

constexpr double kLimit = 1e-4;

const TestResult& dilating() {
    static const TestResult r = sheared_joint(GrainKind::rigid, kMu, kTanPsi, kLimit, 0.0, 45.0 * kLimit);
    return r;
}

std::vector<CheckedValue> dilation() {
    std::vector<double> u, v;
    for (const HistoryRow& row : dilating().history)
        if (const double slip = row.axial_strain * dilating().length_m;
            row.phase == Phase::loading && slip > 0.3 * kLimit && slip < 0.9 * kLimit) {
            u.push_back(slip);
            v.push_back(row.gauges[0]);
        }
    return {{"", kTanPsi, regression_line(u, v).slope}};
}

std::vector<CheckedValue> rise() {
    const TestResult& r = dilating();
    const auto first = std::ranges::find_if(r.history, [](const HistoryRow& row) { return row.phase == Phase::loading; });
    double highest = 0.0;  // the normal stress had pushed the plate down before
    for (auto row = first; row != r.history.end(); ++row) highest = std::max(highest, row->gauges[0] - first->gauges[0]);
    return {{"", 1e6 * kTanPsi * kLimit, 1e6 * highest}};
}

std::vector<CheckedValue> spring() {
    constexpr double kStiffness = 1e8;  // Pa/m; the specimen gives way 1e-4 of what the spring does
    const TestResult r = sheared_joint(GrainKind::rigid, kMu, kTanPsi, 1e-3, kStiffness, 0.01);
    std::vector<double> u, stress;
    for (const HistoryRow& row : r.history)
        if (const double slip = row.axial_strain * r.length_m; row.phase == Phase::loading && slip > 4e-5) {
            u.push_back(slip);
            stress.push_back(row.gauges[1] / r.section_m2);
        }
    return {{"", 1e-6 * kStiffness * kTanPsi, 1e-6 * regression_line(u, stress).slope}};
}

}  // namespace

std::vector<Check> joint_checks() {
    return {
        {.name = "joints.jaeger",
         .sentence = "A rock with a smooth joint slides on it at the stress of Jaeger's plane of weakness.",
         .formula = "sigma_1 = 2 c / ((1 - mu cot b) sin 2b)",
         .source = "Jaeger 1960",
         .unit = "MPa",
         .bound = relative(5e-2),
         .reason = "the joint softens along its length, and the platens do not let the halves move freely",
         .compare = jaeger},
        {.name = "joints.friction",
         .sentence = "A smooth joint without cohesion slides in direct shear at its friction.",
         .formula = "T / N = mu",
         .source = "Coulomb",
         .bound = relative(5e-3),
         .reason = "the edges of flexible grains tilt with their strain",
         .compare = frictions},
        {.name = "joints.dilation",
         .sentence = "In direct shear the upper half rises by the tangent of the dilation angle; rigid grains.",
         .formula = "dv / du = tan psi",
         .source = "(H9)-(H11) of the theory of heterogeneity",
         .bound = relative(1e-3),
         .reason = "what still rings while it is sheared",
         .compare = dilation,
         .run = "dilating-joint"},
        {.name = "joints.dilation-strength",
         .sentence = "While it rises the joint bears the friction of its whole angle.",
         .formula = "T / N = mu",
         .source = "(H9)-(H11) of the theory of heterogeneity",
         .bound = relative(2e-3),
         .reason = "what still rings while it is sheared",
         .compare =
             [] {
                 return std::vector<CheckedValue>{{"", kMu, friction(dilating(), 0.3 * kLimit)}};
             },
         .run = "dilating-joint"},
        {.name = "joints.rise",
         .sentence = "It rises no further than its limit says.",
         .formula = "v = L tan psi",
         .source = "(H9)-(H11) of the theory of heterogeneity",
         .unit = "um",
         .bound = relative(5e-2),
         .reason = "before it slides the specimen is sheared, which lifts the plate a little",
         .compare = rise,
         .run = "dilating-joint"},
        {.name = "joints.dilation-behind-a-spring",
         .sentence = "Behind a spring the normal stress of a dilating joint grows with its slip; rigid grains.",
         .formula = "d sigma_n / du = K tan psi",
         .source = "(H9)-(H11) of the theory of heterogeneity",
         .unit = "MPa/m",
         .bound = relative(1e-3),
         .reason = "the specimen gives way 1e-4 of what the spring does, and some of it rings",
         .compare = spring},
    };
}

}  // namespace feldspar
