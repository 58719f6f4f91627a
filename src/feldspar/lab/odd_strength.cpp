#include "feldspar/lab/odd_strength.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/base/counted.hpp"
#include "feldspar/lab/loading_curve.hpp"
#include "feldspar/lab/per_cent.hpp"
#include "feldspar/lab/scaling_rules.hpp"
#include "feldspar/laws/softening.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double kFarBelow = 0.4;   // of the expected strength: the rules miss by a sixth (docs/validation/first-parameters.md)
constexpr std::size_t kAtOnce = 3;  // rows of loading before the peak

double grain_m(const TestResult& result) { return result.specimen ? result.specimen->quality.mean_diameter_m : 0.0; }

bool softens(const TestResult& result) {
    return result.contact.law != ContactLaw::brittle && result.contact.Gfn_J_m2 > 0.0 && result.contact.sigma_nt_Pa > 0.0;
}

// What the rules expect of this test; not-a-number where they were not measured: other grains, a rock of several minerals, with
// joints or initial cracks, a specimen with holes or notches, a test whose strength is no UCS, DTS or BTS.
double expected_strength(const TestResult& result) {
    const Heterogeneity& rock = result.rock;
    if (result.model.kind != GrainKind::flexible || !softens(result) || !(grain_m(result) > 0.0) ||
        !result.specimen->outline.cutouts.empty() || result.specimen->quality.crystals > 0)
        return nan;
    if (!rock.minerals.phases.empty() || rock.crystal.any() || rock.initial_cracks.any() || !rock.joints.empty()) return nan;
    double inverse_modulus = 0.0;
    for (const Scattered quantity : scattered_quantities) {
        const Distribution& d = rock.scatter[quantity];
        if (!d.scatters()) continue;
        if (quantity != Scattered::strength || d.kind != DistributionKind::weibull || d.correlation_length_m > 0.0) return nan;
        inverse_modulus = 1.0 / d.weibull_modulus;
    }
    const RockNumbers expected = expected_rock(result.grain, result.contact, grain_m(result), inverse_modulus);
    const std::string_view strength = method_of(result.test).strength.name;
    if (strength == "UCS") return expected.UCS_Pa;
    if (strength == "DTS") return expected.DTS_Pa;
    if (strength == "BTS") return expected.BTS_Pa;
    return nan;
}

std::string nearest_sentence(const TestResult& result) {
    const NearestToFailure& n = result.nearest;
    if (std::isnan(n.share)) return {};
    const std::string where = fmt::format("at ({:.1f}, {:.1f}) mm", 1e3 * n.place.x, 1e3 * n.place.y),
                      mode = n.in_tension ? "tension" : "shear";
    if (n.damage > 0.0)
        return fmt::format(" The contact nearest to failure, {}, had softened in {}: {} of its strength there was gone.", where,
                           mode, per_cent(n.damage));
    return fmt::format(" The contact nearest to failure, {}, bore {} of its strength in {}.", where, per_cent(n.share), mode);
}

std::string expected_sentence(double expected_Pa, double largest_Pa) {
    if (!(expected_Pa > 0.0)) return {};
    return fmt::format(" By the scaling rules such contacts bear about {:.3g} MPa; the largest stress was {:.3g} MPa.",
                       1e-6 * expected_Pa, 1e-6 * largest_Pa);
}

void look_for_failure(const TestResult& result, const TestProperties& p, double expected_Pa,
                      std::vector<std::string>& sentences) {
    if (p.peak_reached || (!result.cracks.empty() && !result.stages.empty())) return;  // tests with stages go where these lead
    if (result.test.stop_fraction > 0.95) return;  // the user has it end before a fall counts as a peak (P2)
    const double largest = largest_stress(result);
    const std::string begin = result.cracks.empty()
                                  ? fmt::format("Nothing broke: {}.", result.stop_reason)
                                  : fmt::format("The strength was not reached: {}, with {}.", result.stop_reason,
                                                counted(static_cast<long long>(result.cracks.size()), "crack"));
    sentences.push_back(begin + nearest_sentence(result) + expected_sentence(expected_Pa, largest));
}

void look_at_ductility(const TestResult& result, std::vector<std::string>& sentences) {
    const double over_grain = softening_over_grain(result);
    if (!(over_grain > ductile_over_grain)) return;
    sentences.push_back(
        fmt::format("Gfn = {:.4g} N/m makes contacts that cannot break brittly: they soften over E Gfn / sigma_nt^2 = {:.3g} mm, "
                    "{:.3g} mean grain diameters (rocks: 0.3 to 20). "
                    "Grain boundaries of granite have 12 to 38 N/m (Zhou and others 2025).",
                    result.contact.Gfn_J_m2, 1e3 * over_grain * grain_m(result), over_grain));
}

std::string snap_sentence(const TestResult& result) {
    const ContactMaterial& c = result.contact;
    if (!softens(result) || !SofteningEnvelope::make(c.law, c.sigma_nt_Pa, c.Kn_Pa_m, c.Gfn_J_m2).brittle) return {};
    return fmt::format(
        " Gfn = {:.4g} N/m is less than the elastic energy sigma_nt^2 / (2 Kn) = {:.4g} N/m of a contact at its strength: "
        "contacts break at once.",
        c.Gfn_J_m2, 0.5 * c.sigma_nt_Pa * c.sigma_nt_Pa / c.Kn_Pa_m);
}

void look_for_early_failure(const TestResult& result, const TestProperties& p, double expected_Pa,
                            std::vector<std::string>& sentences) {
    if (!p.peak_reached || result.cracks.empty()) return;
    const auto peak = find_peak(result);
    std::size_t rows = 0;
    for (std::size_t i = 0; peak && i < peak->row; ++i) rows += result.history[i].phase == Phase::loading;
    const bool at_once = rows < kAtOnce && result.numerics.kind == NumericsKind::adaptive,
               early = expected_Pa > 0.0 && p.peak_stress_Pa < kFarBelow * expected_Pa;
    if (!early && !(at_once && expected_Pa > 0.0 && p.peak_stress_Pa < expected_Pa / (1.0 + kFarBelow))) return;
    const Crack* first = first_crack(result);
    sentences.push_back(
        fmt::format("It failed early: at {:.3g} MPa, {:.2g} % of the {:.3g} MPa that such contacts bear by the scaling rules; "
                    "the first crack, in {}, was at ({:.1f}, {:.1f}) mm.{}",
                    1e-6 * p.peak_stress_Pa, 100.0 * p.peak_stress_Pa / expected_Pa, 1e-6 * expected_Pa,
                    first->mode == CrackMode::tensile ? "tension" : "shear", 1e3 * first->place.x, 1e3 * first->place.y,
                    snap_sentence(result)));
}

}  // namespace

double softening_over_grain(const TestResult& result) {
    if (!softens(result) || !(grain_m(result) > 0.0)) return 0.0;
    const double E = result.model.kind == GrainKind::flexible ? result.grain.E_Pa : result.contact.Kn_Pa_m * grain_m(result);
    return E * result.contact.Gfn_J_m2 / (result.contact.sigma_nt_Pa * result.contact.sigma_nt_Pa) / grain_m(result);
}

std::vector<std::string> why_odd(const TestResult& result, const TestProperties& properties) {
    std::vector<std::string> sentences;
    if (result.interrupted || result.stop_reason.empty() || !result.specimen) return sentences;  // no test that ended by itself
    const double expected_Pa = expected_strength(result);
    look_for_failure(result, properties, expected_Pa, sentences);
    look_at_ductility(result, sentences);
    look_for_early_failure(result, properties, expected_Pa, sentences);
    return sentences;
}

}  // namespace feldspar
