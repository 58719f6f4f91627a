#include "feldspar/lab/multi_stage.hpp"

#include <algorithm>

#include "feldspar/lab/strength_envelope.hpp"

namespace feldspar {

MultiStageProperties multi_stage(const TestResult& result, const Peak& peak) {
    MultiStageProperties p;
    const std::vector<HistoryRow>& history = result.history;
    const auto volume = [&](std::size_t row) { return history[row].axial_strain_gauge + history[row].lateral_strain_gauge; };
    for (const StageRecord& stage : result.stages) {
        if (stage.kind != StageKind::load) continue;
        std::size_t turn = stage.first_row;
        for (std::size_t row = stage.first_row; row <= std::min(stage.last_row, std::max(stage.first_row, peak.row)); ++row)
            if (volume(row) > volume(turn)) turn = row;
        p.sigma3_Pa.push_back(history[stage.last_row].sigma3_Pa);
        p.reversal_Pa.push_back(turn == stage.first_row || turn == stage.last_row ? MultiStageProperties::none
                                                                                  : history[turn].axial_stress_Pa);
    }
    if (p.sigma3_Pa.empty()) return p;
    const bool last_failed = peak.reached && static_cast<std::size_t>(history[peak.row].stage) == result.stages.size();
    const double last3 = p.sigma3_Pa.back();
    if (last_failed) p.peak_over_reversal = (peak.stress_Pa - last3) / (p.reversal_Pa.back() - last3);
    for (std::size_t i = 0; i < p.sigma3_Pa.size(); ++i)
        p.strength_Pa.push_back(p.sigma3_Pa[i] + p.peak_over_reversal * (p.reversal_Pa[i] - p.sigma3_Pa[i]));
    if (last_failed) p.strength_Pa.back() = peak.stress_Pa;
    if (p.sigma3_Pa.size() < 2 || !std::all_of(p.strength_Pa.begin(), p.strength_Pa.end(), [](double s) { return s == s; }))
        return p;
    const EnvelopeFit fit = fit_envelopes(p.sigma3_Pa, p.strength_Pa);
    p.cohesion_Pa = fit.cohesion_Pa;
    p.friction_angle_deg = fit.friction_angle_deg;
    return p;
}

}  // namespace feldspar
