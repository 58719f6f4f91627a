#include <fmt/format.h>

#include "feldspar/job/job.hpp"
#include "feldspar/laws/softening.hpp"

namespace feldspar {
namespace {

// The energy that a contact has stored when it reaches its strength, and that softening would have to dissipate at least.
void look_at_softening(const ContactMaterial& contact, const std::string& of, std::vector<std::string>& sentences) {
    if (contact.law == ContactLaw::brittle) return;
    const auto look = [&](const char* key, double energy_J_m2, double strength_Pa, double stiffness_Pa_m, const char* formula, const char* what) {
        if (!SofteningEnvelope::make(contact.law, strength_Pa, stiffness_Pa_m, energy_J_m2).brittle) return;
        sentences.push_back(fmt::format("{}{} = {:.4g} N/m is no more than {} = {:.4g} N/m, the elastic energy at the strength: {}, and {} has no say "
                                        "(docs/theory/contacts.md, section 5)",
                                        of, key, energy_J_m2, formula, 0.5 * strength_Pa * strength_Pa / stiffness_Pa_m, what, key));
    };
    look("Gfn", contact.Gfn_J_m2, contact.sigma_nt_Pa, contact.Kn_Pa_m, "sigma_nt^2 / (2 Kn)", "contacts break in tension without softening");
    if (contact.eta > 0.0)
        look("Gfs", contact.Gfs_J_m2, contact.tau_Pa, contact.eta * contact.Kn_Pa_m, "tau^2 / (2 eta Kn)",
             "contacts break in shear without softening, at tau + mu times the pressure");
}

}  // namespace

std::vector<std::string> warnings(const Job& job) {
    std::vector<std::string> sentences;
    for (const Variant& variant : job.variants) look_at_softening(variant.contact, variant.name.empty() ? "" : variant.name + ": ", sentences);
    return sentences;
}

}  // namespace feldspar
