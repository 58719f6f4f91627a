#include "feldspar/lab/post_peak.hpp"

#include <cmath>
#include <vector>

#include "feldspar/base/regression.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

// (P32): shares of the peak between which the branch is taken for straight, and how many of its points are read.
constexpr double kFrom = 0.9, kTo = 0.5;
constexpr int kPoints = 9;

struct BranchPoint {
    double stress_Pa, strain;
};

/// Where the branch leaves this stress for good: before that a specimen that was unloaded may carry it again.
bool leaves(const std::vector<BranchPoint>& branch, double stress_Pa, BranchPoint& found) {
    std::size_t last = branch.size();
    for (std::size_t i = branch.size(); i-- > 0 && last == branch.size();)
        if (branch[i].stress_Pa >= stress_Pa) last = i;
    if (last + 1 >= branch.size()) return false;  // never that high, or not below it at the end
    const BranchPoint &above = branch[last], &below = branch[last + 1];
    const double w = (above.stress_Pa - stress_Pa) / (above.stress_Pa - below.stress_Pa);
    found = {stress_Pa, above.strain + w * (below.strain - above.strain)};
    return true;
}

/// Strain over stress: its slope is finite where the branch is upright.
double compliance(const std::vector<BranchPoint>& branch, double peak_Pa) {
    std::vector<double> stresses, strains;
    for (int i = 0; i < kPoints; ++i) {
        BranchPoint point{};
        if (!leaves(branch, peak_Pa * (kFrom + (kTo - kFrom) * i / (kPoints - 1)), point)) return PostPeak::none;
        stresses.push_back(point.stress_Pa);
        strains.push_back(point.strain);
    }
    return regression_line(stresses, strains).slope;
}

}  // namespace

bool branch_is_followed(const TestResult& result) {
    return result.test.control != LoadControl::displacement && result.numerics.kind == NumericsKind::adaptive;
}

PostPeak post_peak(const TestResult& result, const Peak& peak, const LoadingCurve& curve, double E_Pa) {
    PostPeak p;
    if (!peak.reached || curve.points.empty()) return p;
    const EnergyLedger &at_peak = result.history[peak.row].energy, &at_end = result.history.back().energy;
    const double fracture = at_end.fracture - at_peak.fracture, friction = at_end.friction - at_peak.friction,
                 damping = at_end.damping - at_peak.damping;
    if (const double all = fracture + friction + damping; all > 0.0) {
        p.fracture_share = fracture / all;
        p.friction_share = friction / all;
        p.damping_share = damping / all;
    }
    if (!branch_is_followed(result) || !result.stages.empty()) return p;  // cycles cut the branch to pieces
    const double sign = method_of(result.test).loading.sign;
    std::vector<BranchPoint> branch;
    for (std::size_t i = peak.row; i < result.history.size(); ++i) {
        const HistoryRow& row = result.history[i];
        branch.push_back({sign * row.axial_stress_Pa - curve.stress_offset_Pa, sign * row.axial_strain});
    }
    const double slope = compliance(branch, curve.peak_Pa());
    p.modulus_Pa = 1.0 / slope;
    p.brittleness = 1.0 - E_Pa * slope;
    return p;
}

}  // namespace feldspar
