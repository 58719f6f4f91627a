// Bodies that the proofs share: those of the checks (verify/bodies.hpp), and what tests alone need.
#pragma once

#include <algorithm>
#include <string>

#include "../table7.hpp"
#include "feldspar/verify/bodies.hpp"

namespace feldspar::fixtures {

using namespace feldspar::bodies;

/// Two minerals, strengths and stiffnesses that scatter, broken contacts, and a joint.
inline Heterogeneity uneven_rock() {
    Heterogeneity rock;
    Mineral stiff{"stiff", 0.6, {60e9, 0.1, 2700.0}}, soft{"soft", 0.4, {20e9, 0.3, 3000.0}};
    rock.minerals.phases = {stiff, soft};
    PhasePair pair{1, 1, {}};
    pair.changes.Kn_Pa_m = 9e13;
    pair.changes.sigma_nt_Pa = 5e6;
    pair.changes.mu = 0.2;
    rock.minerals.pairs = {pair};
    rock.scatter[Scattered::strength] = {.kind = DistributionKind::weibull, .weibull_modulus = 2.0};
    rock.scatter[Scattered::stiffness] = {.kind = DistributionKind::log_normal, .variation = 0.3};
    rock.scatter[Scattered::E] = {
        .kind = DistributionKind::normal, .variation = 0.1, .lowest = 0.05, .correlation_length_m = 0.005};
    rock.initial_cracks = {.broken = 0.1, .opening_m = 1e-7};
    JointSpec joint;
    joint.name = "joint";
    joint.lines_m = {{{0.0, 0.012}, {0.02, 0.02}}};
    joint.contact = table7();
    joint.contact.sigma_nt_Pa = joint.contact.tau_Pa = 1e6;
    joint.contact.Gfn_J_m2 = joint.contact.Gfs_J_m2 = 0.0;
    rock.joints = {joint};
    return rock;
}

/// As the name of a test's case.
inline std::string label(const ModelSpec& m) {
    std::string text = name(m.kind);
    text += m.kind == GrainKind::inner_particles ? std::string("_") + name(m.normal) : std::string("_") + name(m.contact);
    std::replace(text.begin(), text.end(), '-', '_');
    return text;
}

inline RunControl threads(int count) {
    RunControl control;
    control.threads = count;
    return control;
}

}  // namespace feldspar::fixtures
