#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "feldspar/job/job_sections.hpp"
#include "feldspar/lab/scaling_rules.hpp"
#include "feldspar/lab/specimen_shape.hpp"
#include "feldspar/laws/softening.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

// The energy that a contact has stored when it reaches its strength, and that softening would have to dissipate at least.
void look_at_softening(const ContactMaterial& contact, const std::string& of, std::vector<std::string>& sentences) {
    if (contact.law == ContactLaw::brittle) return;
    const auto look = [&](const char* key, double energy_J_m2, double strength_Pa, double stiffness_Pa_m, const char* formula,
                          const char* what) {
        if (!SofteningEnvelope::make(contact.law, strength_Pa, stiffness_Pa_m, energy_J_m2).brittle) return;
        sentences.push_back(fmt::format(
            "{}{} = {:.4g} N/m is no more than {} = {:.4g} N/m, the elastic energy at the strength: {}, and {} has no say "
            "(docs/theory/contacts.md, section 5)",
            of, key, energy_J_m2, formula, 0.5 * strength_Pa * strength_Pa / stiffness_Pa_m, what, key));
    };
    look("Gfn", contact.Gfn_J_m2, contact.sigma_nt_Pa, contact.Kn_Pa_m, "sigma_nt^2 / (2 Kn)",
         "contacts break in tension without softening");
    if (contact.eta > 0.0)
        look("Gfs", contact.Gfs_J_m2, contact.tau_Pa, contact.eta * contact.Kn_Pa_m, "tau^2 / (2 eta Kn)",
             "contacts break in shear without softening, at tau + mu times the pressure");
}

// How far a contact gives, or a grain strains, before the contact breaks. The law measures gaps from the undeformed geometry, and
// the start of a test relies on small strains, so neither may be of the size of a grain. In rocks both are below a thousandth.
void look_at_softness(const Variant& variant, double grain_m, const std::string& of, std::vector<std::string>& sentences) {
    constexpr double kMost = 0.01;
    const ContactMaterial& contact = variant.contact;
    const auto look = [&](const char* what, double give_m, const char* remedy) {
        if (give_m > kMost * grain_m)
            sentences.push_back(
                fmt::format("{}{} = {:.3g} mm is {:.3g} times the mean grain diameter of {:.3g} mm: more than {:g} of it is "
                            "outside what the model is made for, and "
                            "the elastic start may not come to rest. {}",
                            of, what, 1e3 * give_m, give_m / grain_m, 1e3 * grain_m, kMost, remedy));
    };
    look("sigma_nt / Kn, by which a contact opens before it breaks,", contact.sigma_nt_Pa / contact.Kn_Pa_m,
         "Is Kn in the unit that you mean (Pa/m; rocks have about 1e14)?");
    if (contact.eta > 0.0)
        look("tau / (eta Kn), by which a contact slips before it breaks,", contact.tau_Pa / (contact.eta * contact.Kn_Pa_m),
             "Is Kn in the unit that you mean (Pa/m; rocks have about 1e14)?");
    if (variant.model.kind == GrainKind::flexible)
        look("sigma_nt d / E, by which a grain strains before a contact breaks,",
             contact.sigma_nt_Pa / variant.grain.E_Pa * grain_m, "Is E in the unit that you mean (rocks have 1 to 100 GPa)?");
}

// Values that no rock is known to have; more often a unit is wrong than the rock is odd.
void look_at_plausibility(const Variant& variant, const std::string& of, std::vector<std::string>& sentences) {
    const auto look = [&](const std::string& key, double value, double low, double high, const char* unit, const char* why) {
        if (value < low || value > high)
            sentences.push_back(fmt::format("{}{} = {:.4g}{} lies outside what rocks have ({:g} to {:g}{}): {}", of, key, value,
                                            unit, low, high, unit, why));
    };
    const auto look_at = [&](const ContactMaterial& contact, const std::string& place) {
        look(place + "mu", contact.mu, 0.0, 2.0, "",
             "joints and grain boundaries slide at 0.3 to 1; 2 is an angle of 63 degrees (phi takes an angle)");
        look(place + "eta", contact.eta, 0.05, 1.5, "", "is it kn/ks? Then it is kratio");
        if (contact.law == ContactLaw::brittle || contact.Gfn_J_m2 == 0.0) return;
        look(place + "Gfn", contact.Gfn_J_m2, 0.05, 1000.0, " N/m",
             "grain boundaries of granite have 12 to 38 N/m (Zhou and others 2025)");
        look(place + "Gfs", contact.Gfs_J_m2, 1.0, 1e5, " N/m", "in shear 5 to 300 times as much as in tension is usual here");
    };
    look_at(variant.contact, "");
    for (const JointSpec& joint : variant.rock.joints) look_at(joint.contact, "joint \"" + joint.name + "\": ");
    if (variant.model.kind == GrainKind::flexible)
        look("E", variant.grain.E_Pa / 1e9, 0.5, 200.0, " GPa", "is E in the unit that you mean?");
    look("density", variant.grain.density_kg_m3, 1000.0, 6000.0, " kg/m3", "is it in the unit that you mean?");
    for (const Scattered quantity : scattered_quantities)
        if (const Distribution& d = variant.rock.scatter[quantity];
            d.kind == DistributionKind::weibull && d.weibull_modulus < 1.5 && d.lowest < 0.02 && quantity != Scattered::E)
            sentences.push_back(
                fmt::format("{}{} scatters with a Weibull modulus of {:.3g} and no cut-off: one contact in a hundred has less "
                            "than {:.2g} of the mean. lowest = 0.1 leaves these out "
                            "(docs/theory/heterogeneity.md, section 6)",
                            of, name(quantity), d.weibull_modulus,
                            std::pow(0.01, 1.0 / d.weibull_modulus) / std::tgamma(1.0 + 1.0 / d.weibull_modulus)));
    for (const std::string& remark : variant.rock.remarks) sentences.push_back(of + remark);
}

double known(const Job& job, const char* key, double otherwise) {
    const auto found = job.laboratory.find(key);
    return found == job.laboratory.end() ? otherwise : found->second;
}

// Whether the column would bend aside before it breaks, by what is expected of the rock: the laboratory's numbers, else E of the
// grains or contacts and the Mohr-Coulomb strength of the contacts. The measured strength is up to 1.4 times that and E a sixth
// lower, so the warning begins below the limit; the test's own verdict goes by what was measured.
void look_at_slenderness(const Job& job, std::vector<std::string>& sentences) {
    constexpr double kCaution = 0.75;
    const SpecimenSpec& specimen = job.specimen;
    if (specimen.outline.shape != Shape::rectangle && specimen.outline.shape != Shape::polygon) return;
    const Outline outline = make_outline(specimen);
    const Box box = bounding_box(outline);
    const double width = section_widths(outline).narrowest, height = box.upper.y - box.lower.y;
    if (!(width > 0.0)) return;
    for (const Variant& variant : job.variants) {
        const ContactMaterial& contact = variant.contact;
        const double own_E = variant.model.kind == GrainKind::flexible
                                 ? variant.grain.E_Pa
                                 : contact.Kn_Pa_m * typical_diameter_m(specimen.grain_sizes);
        const double E = known(job, "E", own_E);
        const double root_N = contact.mu + std::sqrt(1.0 + contact.mu * contact.mu),
                     UCS = known(job, "UCS", 2.0 * contact.tau_Pa * root_N);
        const bool pressed = std::any_of(job.tests.begin(), job.tests.end(), [&](const TestSpec& test) {
            return variant.runs(test.kind) && method_of(test).loading.bends;
        });
        const double limit = slenderest(E, UCS);
        if (!pressed || height / width <= kCaution * limit) continue;
        sentences.push_back(
            fmt::format("{}the specimen is {:.3g} times as high as wide. A column of an expected E of {:.3g} GPa bends aside at "
                        "{:.3g} MPa (Euler, platens that may slide); with an expected strength of {:.3g} MPa that happens above "
                        "height / width of {:.3g}, and what a straight test then measures is no strength and gets no grade "
                        "above C. Laboratories use 2 to 3",
                        variant.name.empty() ? "" : variant.name + ": ", height / width, E / 1e9,
                        euler_stress_Pa(E, width, height) / 1e6, UCS / 1e6, limit));
    }
}

// Whether these contacts can bear what the laboratory has measured, roughly: a unit that is wrong is wrong by a thousand, a
// strength that was taken for another by ten.
void look_at_expectation(const Job& job, const Variant& variant, const std::string& of, std::vector<std::string>& sentences) {
    constexpr double kFactor = 3.0;
    const ContactMaterial& c = variant.contact;
    if (variant.model.kind != GrainKind::flexible || variant.rock.any() || c.law == ContactLaw::brittle || !(c.Gfn_J_m2 > 0.0) ||
        !(c.Gfs_J_m2 > 0.0) || !(c.sigma_nt_Pa > 0.0) || !(c.tau_Pa > 0.0) || !(c.eta > 0.0))
        return;
    const RockNumbers expected = expected_rock(variant.grain, c, typical_diameter_m(job.specimen.grain_sizes));
    const auto look = [&](const char* name, double expected_Pa) {
        const double measured_Pa = known(job, name, expected_Pa);
        if (expected_Pa > kFactor * measured_Pa || measured_Pa > kFactor * expected_Pa)
            sentences.push_back(
                fmt::format("{}such contacts bear a {} of about {:.3g} MPa by the scaling rules "
                            "(docs/validation/first-parameters.md), the laboratory has {:.3g} MPa: are the strengths in the "
                            "unit that you mean? feldspar new laboratory --{} ... finds first ones",
                            of, name, 1e-6 * expected_Pa, 1e-6 * measured_Pa, name));
    };
    look("UCS", expected.UCS_Pa);
    look("BTS", expected.BTS_Pa);
    look("DTS", expected.DTS_Pa);
}

// Narrow flats spare the disc's ends less: it may break there before its centre does.
void look_at_flats(const Job& job, std::vector<std::string>& sentences) {
    constexpr double kDegrees = std::numbers::pi / 180.0, kEnough = 20.0 * kDegrees;
    for (const TestSpec& test : job.tests) {
        const double angle = specimen_of(job, test).outline.flat_angle_rad;
        if (!(angle > 0.0) || angle >= kEnough * (1.0 - 1e-9)) continue;
        sentences.push_back(
            fmt::format("the flats of the Brazilian disc have {:.3g} degrees: from 20 degrees on cracks start in the centre "
                        "(Wang and others 2004); with less they "
                        "may start beside the flats, and the strength is then no tensile strength",
                        angle / kDegrees));
        return;
    }
}

// Cells of a file are the same for every seed.
void look_at_seeds(const Job& job, std::vector<std::string>& sentences) {
    if (!job.specimen.given_cells.given() || job.seeds.size() < 2) return;
    const bool draws = std::any_of(job.variants.begin(), job.variants.end(), [](const Variant& v) {
        return v.rock.contacts_differ() || v.rock.grains_differ() || v.model.kind == GrainKind::inner_particles;
    });
    if (draws || job.specimen.crystal_sizes)
        sentences.push_back(
            fmt::format("the cells of a file are the same for each of the {} seeds: these draw minerals, scatter, crystals and "
                        "inner particles only, so the scatter between grain structures is not seen",
                        job.seeds.size()));
    else
        sentences.push_back(
            fmt::format("the cells of a file are the same for every seed, and nothing else is drawn: the {} seeds repeat one "
                        "specimen. One seed is enough",
                        job.seeds.size()));
}

}  // namespace

std::vector<std::string> warnings(const Job& job) {
    std::vector<std::string> sentences;
    for (const Variant& variant : job.variants) {
        const std::string of = variant.name.empty() ? "" : variant.name + ": ";
        look_at_softening(variant.contact, of, sentences);
        look_at_plausibility(variant, of, sentences);
        look_at_expectation(job, variant, of, sentences);
        look_at_softness(variant, typical_diameter_m(job.specimen.grain_sizes), of, sentences);
    }
    look_at_slenderness(job, sentences);
    look_at_flats(job, sentences);
    look_at_seeds(job, sentences);
    return sentences;
}

}  // namespace feldspar
