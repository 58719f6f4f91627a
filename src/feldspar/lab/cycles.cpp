#include "feldspar/lab/cycles.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "feldspar/base/regression.hpp"
#include "feldspar/lab/damage_thresholds.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

constexpr double kFrom = 0.25, kTo = 0.75;  // of the range of stress: where slopes are read
constexpr double none = CycleProperties::none;

struct Rows {
    std::size_t from = 0, to = 0;  // both included
};

class Reader {
public:
    explicit Reader(const TestResult& result)
        : result_(result), sign_(method_of(result.test).loading.sign), evenly_(method_of(result.test).start.strained_evenly) {}

    double stress(std::size_t row) const { return sign_ * result_.history[row].axial_stress_Pa; }
    double strain(std::size_t row) const { return sign_ * result_.history[row].axial_strain; }
    // In the middle of the specimen; of one that is not strained evenly the axial strain is that of the loading motion, and there
    // is no other.
    double axial(std::size_t row) const { return evenly_ ? sign_ * result_.history[row].axial_strain_gauge : strain(row); }
    double lateral(std::size_t row) const { return evenly_ ? sign_ * result_.history[row].lateral_strain_gauge : none; }

    std::size_t largest(Rows rows) const {
        std::size_t found = rows.from;
        for (std::size_t r = rows.from; r <= rows.to; ++r)
            if (stress(r) > stress(found)) found = r;
        return found;
    }

    // Strains per stress where the stress is in the middle half between two stresses; not-a-number with fewer than two rows
    // there.
    struct Compliance {
        double strain = none, axial = none, lateral = none;
    };
    Compliance compliance(Rows rows, double low_Pa, double high_Pa) const {
        const double from = low_Pa + kFrom * (high_Pa - low_Pa), to = low_Pa + kTo * (high_Pa - low_Pa);
        std::vector<double> stresses, strains, axials, laterals;
        for (std::size_t r = rows.from; r <= rows.to; ++r) {
            if (stress(r) < from || stress(r) > to) continue;
            stresses.push_back(stress(r));
            strains.push_back(strain(r));
            axials.push_back(axial(r));
            laterals.push_back(lateral(r));
        }
        if (stresses.size() < 2) return {};
        return {regression_line(stresses, strains).slope, regression_line(stresses, axials).slope,
                regression_line(stresses, laterals).slope};
    }

    // From the state where it begins to its largest stress, measured from there.
    LoadingCurve curve(Rows rows) const {
        LoadingCurve curve;
        curve.stress_offset_Pa = stress(rows.from);
        for (std::size_t r = rows.from; r <= largest(rows); ++r)
            curve.points.push_back({stress(r) - curve.stress_offset_Pa, strain(r) - strain(rows.from),
                                    axial(r) - axial(rows.from), lateral(r) - lateral(rows.from), r});
        return curve;
    }

    const TestResult& result() const { return result_; }

private:
    const TestResult& result_;
    double sign_;
    bool evenly_;
};

// Stages of one cycle, as places in TestResult::stages.
struct Cycle {
    std::size_t first = 0, last = 0;
    std::optional<std::size_t> unloading;
};

std::vector<Cycle> split(const std::vector<StageRecord>& stages) {
    std::vector<Cycle> cycles;
    bool unloads = false;
    for (std::size_t s = 0; s < stages.size(); ++s) {
        const bool begins = stages[s].kind == StageKind::load && (cycles.empty() || cycles.back().unloading);
        if (begins || cycles.empty()) cycles.push_back({s, s, {}});
        cycles.back().last = s;
        if (stages[s].kind != StageKind::unload) continue;
        cycles.back().unloading = s;
        unloads = true;
    }
    return unloads ? cycles : std::vector<Cycle>{};
}

// Most cycles are unloaded before their volume turns, and the waves of the motion make a largest value close to the top: it must
// have fallen from there.
bool dilates(const LoadingCurve& curve) {
    constexpr double kFallen = 0.002;  // of the growth, as in (P9)
    const auto volume = [](const CurvePoint& p) { return p.strain_gauge + p.lateral_gauge; };
    double largest = 0.0;
    for (const CurvePoint& p : curve.points) largest = std::max(largest, volume(p));
    return volume(curve.points.back()) < (1.0 - kFallen) * largest;
}

double dissipated(const EnergyLedger& energy) { return energy.fracture + energy.friction + energy.damping; }

void read_cracks(const TestResult& result, Rows rows, double sign, CycleProperties& p) {
    const long long from = result.history[rows.from].step, to = result.history[rows.to].step;
    const Crack* first = nullptr;
    for (const Crack& crack : result.cracks) {
        // A crack of a step belongs to the row behind it; cracks of step 0 to the first one.
        if (crack.step < from || crack.step >= to) continue;
        ++p.cracks;
        if (first == nullptr || crack.step < first->step) first = &crack;
    }
    if (first != nullptr) p.first_crack_Pa = sign * first->axial_stress_Pa;
}

CycleProperties read(const Reader& of, const Cycle& cycle, std::size_t origin, std::optional<double> unloaded_from_Pa) {
    const TestResult& result = of.result();
    const std::vector<StageRecord>& stages = result.stages;
    const Rows whole{stages[cycle.first].first_row, stages[cycle.last].last_row};
    const Rows loading{whole.from, cycle.unloading ? stages[*cycle.unloading].first_row : whole.to};
    CycleProperties p;
    p.first_stage = static_cast<int>(cycle.first) + 1;
    p.last_stage = static_cast<int>(cycle.last) + 1;
    const std::size_t peak = of.largest(loading);
    p.peak_stress_Pa = of.stress(peak);
    p.peak_strain = of.strain(peak);
    p.sigma3_Pa = result.history[peak].sigma3_Pa;
    if (unloaded_from_Pa)
        p.reloading_modulus_Pa =
            1.0 / of.compliance({whole.from, peak}, of.stress(whole.from), std::min(*unloaded_from_Pa, p.peak_stress_Pa)).strain;
    if (cycle.unloading) {
        const Rows unloading{stages[*cycle.unloading].first_row, stages[*cycle.unloading].last_row};
        const double top = of.stress(unloading.from), end = of.stress(unloading.to), left = end - of.stress(origin);
        const Reader::Compliance slope = of.compliance(unloading, end, top);
        p.unloading_modulus_Pa = 1.0 / slope.strain;
        p.permanent_axial_strain = of.axial(unloading.to) - of.axial(origin) - slope.axial * left;
        p.permanent_lateral_strain = of.lateral(unloading.to) - of.lateral(origin) - slope.lateral * left;
        p.permanent_volumetric_strain = p.permanent_axial_strain + p.permanent_lateral_strain;
    }
    read_cracks(result, whole, method_of(result.test).loading.sign, p);
    if (const LoadingCurve curve = of.curve(loading); curve.points.size() > 2 && curve.peak_Pa() > 0.0) {
        const DamageThresholds thresholds = damage_thresholds(curve, p.first_crack_Pa);
        p.sigma_ci_Pa = thresholds.crack_volume_Pa;
        if (dilates(curve)) p.sigma_cd_Pa = thresholds.reversal_Pa;
    }
    const EnergyLedger &before = result.history[whole.from].energy, &after = result.history[whole.to].energy;
    p.work_J = after.supplied() - before.supplied();
    p.dissipated_J = dissipated(after) - dissipated(before);
    return p;
}

}  // namespace

std::vector<CycleProperties> cycles_of(const TestResult& result) {
    std::vector<CycleProperties> cycles;
    if (result.stages.empty() || result.history.empty()) return cycles;
    const Reader of(result);
    const std::size_t origin = result.stages.front().first_row;
    std::optional<double> unloaded_from_Pa;
    double permanent_before = 0.0, damage = 0.0;
    for (const Cycle& cycle : split(result.stages)) {
        CycleProperties p = read(of, cycle, origin, unloaded_from_Pa);
        if (cycle.unloading) {
            unloaded_from_Pa = of.stress(result.stages[*cycle.unloading].first_row);
            if (std::isfinite(p.permanent_volumetric_strain)) {
                damage += permanent_before - p.permanent_volumetric_strain;  // (P54): dilation counts
                permanent_before = p.permanent_volumetric_strain;
                p.damage = damage;
            }
        }
        cycles.push_back(p);
    }
    return cycles;
}

}  // namespace feldspar
