#include "feldspar/lab/specimen_shape.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "feldspar/methods/method.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

bool even(double narrowest, double widest) { return widest <= (1.0 + uniform_width) * narrowest; }

/// Between the outline's lowest and highest point.
double height_of(const Outline& outline) {
    const Box box = bounding_box(outline);
    return box.upper.y - box.lower.y;
}

}  // namespace

double euler_stress_Pa(double E_Pa, double width_m, double height_m) {
    const double slenderness = height_m / width_m;
    return std::numbers::pi * std::numbers::pi * E_Pa / (12.0 * slenderness * slenderness);
}

double slenderest(double E_Pa, double strength_Pa) { return std::numbers::pi * std::sqrt(E_Pa / (12.0 * strength_Pa)); }

void note_section(const TestResult& result, TestProperties& p) {
    if (!result.specimen || result.specimen->outline.is_disc || method_of(result.test).reading != Reading::column) return;
    const SectionWidths widths = section_widths(result.specimen->outline);
    if (!(widths.narrowest > 0.0)) return;
    p.section_width_m = widths.narrowest;
    if (even(widths.narrowest, widths.widest)) return;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    std::string remark = fmt::format(
        "Stresses are taken over the narrowest section, {:.4g} mm wide; the widest is {:.4g} mm. The strain is "
        "not uniform along the height, so moduli from the platens are not given",
        1e3 * widths.narrowest, 1e3 * widths.widest);
    p.E_secant_Pa = p.E_tangent_Pa = p.E_average_Pa = nan;
    // the gauge's stress is that of the narrowest section, which must be its own
    if (!even(widths.narrowest, widths.gauge_widest)) {
        p.E_gauge_Pa = p.E_initial_Pa = p.nu = p.nu_tangent = p.nu_initial = nan;
        p.sigma_ci_crack_volume_Pa = p.sigma_ci_lateral_strain_Pa = p.sigma_cd_Pa = nan;
        remark += ", nor is anything from the strain gauge, in whose window the width varies too";
    }
    p.remarks.push_back(remark + fmt::format(" (widths may vary by {:g} %).", 100.0 * uniform_width));
}

void look_at_buckling(const TestResult& result, QuasiStaticEvidence& evidence) {
    if (!result.specimen || !method_of(result.test).loading.bends) return;
    const TestProperties& p = result.properties;
    const SectionWidths widths = section_widths(result.specimen->outline);
    const double strength = p.peak_stress_Pa - result.test.sigma3_Pa;
    double E = p.E_secant_Pa;
    for (const double other : {p.E_gauge_Pa, p.E_initial_Pa, result.model.kind == GrainKind::flexible ? result.grain.E_Pa : 0.0})
        if (!(E > 0.0)) E = other;
    if (!(widths.narrowest > 0.0) || !(E > 0.0) || !(strength > 0.0)) return;
    const double height = height_of(result.specimen->outline), critical = euler_stress_Pa(E, widths.narrowest, height);
    if (strength <= critical) return;
    evidence.grade = 'C';
    evidence.verdict += fmt::format(
        " A column of this shape (height / width {:.3g}) would bend aside at {:.3g} MPa, Euler's stress for "
        "platens that may slide, before it breaks at {:.3g} MPa: the number is not the strength of such a "
        "column, and no grade above C is given. With this modulus and strength, height / width must stay below {:.3g}.",
        height / widths.narrowest, 1e-6 * critical, 1e-6 * strength, slenderest(E, strength));
}

}  // namespace feldspar
