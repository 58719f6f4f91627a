// What both benchmark programs are about: the Augig granite's grains and contacts, Tables 1 and 7 of the paper.
#pragma once

#include "feldspar/model/spec.hpp"

namespace feldspar::benchmarks {

inline constexpr double kSmallestGrain = 0.002, kLargestGrain = 0.004;  // m
inline constexpr GrainMaterial kGranite{25.8e9, 0.23, 2650.0};

inline ContactMaterial granite_contact(GrainKind grains) {
    ContactMaterial contact;
    contact.Kn_Pa_m = grains == GrainKind::flexible ? 18e13 : grains == GrainKind::rigid ? 1.08e13 : 4.9e13;
    contact.eta = grains == GrainKind::inner_particles ? 0.30 : 0.28;
    contact.sigma_nt_Pa = 8.5e6;
    contact.tau_Pa = 29.75e6;
    contact.mu = 0.4;
    contact.Gfn_J_m2 = 20.0;
    contact.Gfs_J_m2 = 800.0;
    return contact;
}

}  // namespace feldspar::benchmarks
