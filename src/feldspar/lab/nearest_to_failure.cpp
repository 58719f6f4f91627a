#include "feldspar/lab/nearest_to_failure.hpp"

#include <algorithm>
#include <cmath>

namespace feldspar {

NearestToFailure nearest_to_failure(const Assembly& assembly) {
    NearestToFailure nearest;
    for (std::size_t c = 0; c < assembly.contacts.size(); ++c) {
        const Contact& contact = assembly.contacts[c];
        if (contact.plate || contact.dropped || contact.new_contact) continue;
        const BondLaw law = assembly.law_of(contact);
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
            const BondState bond = assembly.bond(p);
            const double area = assembly.points[p].area_m2;
            if (bond.damage >= 1.0 || !(area > 0.0)) continue;
            const double tension = law.sigma_nt_Pa > 0.0 ? -bond.Fn_N / (law.sigma_nt_Pa * area) : 0.0;
            const double shear_limit = law.tau_Pa * area + law.mu * std::max(bond.Fn_N, 0.0);
            const double shear = law.tau_Pa > 0.0 ? std::abs(bond.Fs_N) / shear_limit : 0.0;
            const double share =
                bond.damage > 0.0 ? 1.0 : std::max(tension, shear);  // a softened point carries less, and is nearer
            const bool nearer = std::isnan(nearest.share) || bond.damage > nearest.damage ||
                                (bond.damage == nearest.damage && share > nearest.share);
            if (!nearer) continue;
            const bool pulled =
                bond.damage > 0.0 ? law.normal.damage(bond.max_un_m) >= law.shear.damage(bond.max_us_m) : tension > shear;
            nearest = {share, pulled, bond.damage, 0.5 * (assembly.origins[c].from + assembly.origins[c].to)};
        }
    }
    return nearest;
}

}  // namespace feldspar
