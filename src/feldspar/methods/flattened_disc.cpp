#include "feldspar/methods/flattened_disc.hpp"

#include <algorithm>
#include <cmath>

namespace feldspar {
namespace {

// Of the disc, before it is measured. Rigid bodies with contacts of stiffness Kn per area, a diameter apart, have about Kn times
// it; an error of a third changes k by less than 0.1 %.
double expected_E_Pa(const Specimen& specimen, const ModelSpec& model, const GrainMaterial& grain,
                     const ContactMaterial& contact) {
    if (model.kind == GrainKind::flexible)
        return model.plane == PlaneState::strain ? grain.E_Pa / (1.0 - grain.nu * grain.nu) : grain.E_Pa;
    const double bodies_per_grain =
        model.kind == GrainKind::inner_particles ? std::max(1.0, specimen.spec.particles_per_grain) : 1.0;
    return contact.Kn_Pa_m * specimen.quality.mean_diameter_m / std::sqrt(bodies_per_grain);
}

}  // namespace

// Fits to finite elements (quarter of the disc, 864 quadrilaterals of nine nodes, nu 0.23) for 2 alpha = 10 to 40 degrees,
// hardness 0 to 1e4, mu 0 to 0.6 and beyond: within 0.002 of each.
double flat_coefficient(double angle_rad, const FlatLoading& loading) {
    if (!(angle_rad > 0.0)) return 1.0;
    const double a = 0.5 * angle_rad, a2 = a * a, h = loading.hardness;
    const double uniform = std::cos(a) * std::cos(a) * std::sin(a) / a - 0.112 * a * a2;
    const double rigid_less = 0.855 * a2 * (1.0 - 1.83 * a2);
    const double give = 0.43 * h * std::pow(1.0 + h, -0.17);  // 0 uniform, infinite rigid
    // Friction holds the flats together: as far as it goes, or until nothing slips on the plate.
    const double shear = loading.eta * h, held = 1.3 * shear * std::pow(1.0 + shear, -0.15);
    const double stuck = 0.236 * a * std::exp(-9.3 * a2) * held / (1.0 + held);
    const double sliding = 0.64 * a * (1.0 - 3.9 * a2) * loading.mu;
    const double ratio = stuck > 0.0 ? sliding / stuck : 0.0;
    const double friction_less = std::isfinite(ratio) ? stuck * ratio / std::pow(1.0 + std::pow(ratio, 4.0), 0.25) : stuck;
    return uniform - rigid_less * give / (1.0 + give) - friction_less;
}

double flat_coefficient(const Specimen& specimen, const ModelSpec& model, const GrainMaterial& grain,
                        const ContactMaterial& contact, const TestSpec& test) {
    const double angle = specimen.spec.outline.flat_angle_rad;
    if (!(angle > 0.0)) return 1.0;
    const double half_width_m = specimen.outline.radius_m * std::sin(0.5 * angle);
    const double Kn = test.plate_Kn_Pa_m.value_or(test.plate_stiffness_factor * contact.Kn_Pa_m);
    return flat_coefficient(
        angle, {Kn * half_width_m / expected_E_Pa(specimen, model, grain, contact), contact.eta, test.plate_mu.value_or(0.4)});
}

}  // namespace feldspar
