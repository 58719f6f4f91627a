#include "feldspar/lab/scaling_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace feldspar {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Logarithms of the dimensionless groups, about the values in brackets, which are those of the paper's Tables 1 and 7 or nearby.
struct Groups {
    double t;    // tau / sigma_nt (3.5)
    double N;    // mu + sqrt(1 + mu^2)
    double k;    // Kn d / E (20)
    double eta;  // ks / kn (0.28)
    double bn;   // E Gfn / (sigma_nt^2 d): softening length over grain diameter
    double bs;   // E Gfs / (tau^2 d)
    double nu;   // of the grains, less 0.23; no logarithm
    double m;    // 1 / Weibull modulus; no logarithm
};

constexpr double kTau = 3.5, kStiffness = 20.0, kEta = 0.28, kNu = 0.23;

// Outside what the experiment has, a group counts as at its end: squares must not run away.
double within(double value, double low, double high) { return std::log(std::clamp(value, low, high)); }

Groups groups_of(const GrainMaterial& grain, const ContactMaterial& c, double grain_m, double inverse_modulus) {
    const double scale = grain.E_Pa / grain_m, mu = std::clamp(c.mu, 0.05, 1.25);
    return {within(c.tau_Pa / c.sigma_nt_Pa, 1.3, 8.5) - std::log(kTau),
            std::log(mu + std::sqrt(1.0 + mu * mu)),
            within(c.Kn_Pa_m / scale, 3.0, 120.0) - std::log(kStiffness),
            within(c.eta, 0.1, 1.0) - std::log(kEta),
            within(scale * c.Gfn_J_m2 / (c.sigma_nt_Pa * c.sigma_nt_Pa), 0.1, 15.0),
            within(scale * c.Gfs_J_m2 / (c.tau_Pa * c.tau_Pa), 0.15, 60.0),
            grain.nu - kNu,
            std::clamp(inverse_modulus, 0.0, 1.0)};
}

// Of tests/validation/first_parameters.py; the terms in m are what scatter leaves of an even rock's strength.
double ln_UCS(const Groups& g) {
    return 1.7721 + 0.8358 * g.t + 1.4184 * g.N + 0.0407 * g.bn + 0.1658 * g.bs + 0.0673 * g.k + 0.0479 * g.eta - 0.6127 * g.m;
}  // over sigma_nt
double ln_DTS(const Groups& g) {
    return -0.0931 + 0.0161 * g.t + 0.0753 * g.bn + 0.0534 * g.k + 0.0684 * g.eta - 2.5414 * g.m + 1.8212 * g.m * g.m;
}
double ln_BTS(const Groups& g) {
    return 0.0547 + 0.9838 * g.t + 0.3200 * g.N - 0.9578 * g.t * g.N + 0.1565 * g.bn + 0.0522 * g.bs + 0.1740 * g.k +
           0.1648 * g.eta - 1.1781 * g.m + 0.4611 * g.m * g.m;
}
double friction(const Groups& g) { return 13.7061 + 81.3965 * g.N - 7.1374 * g.t + 0.2417 * g.bs; }  // degrees
double E_loss(const Groups& g) {
    return std::exp(-2.6970 - 0.9807 * g.k - 0.2376 * g.eta - 0.0342 * g.nu);
}  // E of the grains over E of the rock, less 1
double ratio_of_Poisson(const Groups& g) { return 0.2318 + 0.9368 * g.nu - 0.0013 * g.k - 0.0098 * g.eta + 0.0092 * g.k * g.eta; }

// The way from low to high UCS over tensile strength, for -1 <= way <= 1: each parameter between the ends that the experiment has
// and the ranges of calibrations.
struct Way {
    double low, middle, high;
    double at(double way) const {
        return way < 0.0 ? std::exp(std::log(middle) - way * std::log(low / middle))
                         : std::exp(std::log(middle) + way * std::log(high / middle));
    }
};
constexpr Way kTauWay{1.6, 3.2, 6.0}, kMuWay{0.15, 0.45, 0.85}, kBrittleWay{8.0, 1.5, 0.25};
constexpr double kShearBrittle = 7.0;  // E Gfs / (tau^2 d): that of Table 7
constexpr double kMostShear = 200.0;   // Gfs / Gfn, the end of the experiment
constexpr double kAboveBorder = 2.5;   // times tau^2 / (2 eta Kn), below which shear is brittle
constexpr double kMostInverse = 1.0 / 1.3;
constexpr double kUsualModulusRatio = 350.0;  // E over UCS: the middle of what Deere and Miller (1966) call average, 200 to 500

struct Wanted {
    double E_Pa, nu, UCS_Pa = nan, tension_Pa = nan;
    bool of_DTS = false;
    std::optional<double> friction_deg;
    std::vector<std::string> assumed;
};

Wanted wanted_of(const RockTargets& t) {
    Wanted w{};
    w.UCS_Pa = w.tension_Pa = nan;
    w.friction_deg = t.friction_angle_deg;
    if (t.UCS_Pa) w.UCS_Pa = *t.UCS_Pa;
    if (!t.UCS_Pa && t.cohesion_Pa && t.friction_angle_deg) {
        w.UCS_Pa = 2.0 * *t.cohesion_Pa * std::tan(std::numbers::pi / 4.0 + *t.friction_angle_deg * std::numbers::pi / 360.0);
        w.assumed.push_back(fmt::format("UCS = 2 c tan(45 deg + phi / 2) = {:.3g} MPa", 1e-6 * w.UCS_Pa));
    }
    if (t.UCS_Pa && t.cohesion_Pa && !t.friction_angle_deg && *t.UCS_Pa > 2.0 * *t.cohesion_Pa) {
        w.friction_deg = 2.0 * (std::atan(*t.UCS_Pa / (2.0 * *t.cohesion_Pa)) * 180.0 / std::numbers::pi - 45.0);
        w.assumed.push_back(fmt::format("friction angle of {:.3g} deg, from UCS = 2 c tan(45 deg + phi / 2)", *w.friction_deg));
    }
    if (t.BTS_Pa)
        w.tension_Pa = *t.BTS_Pa;
    else if (t.DTS_Pa)
        w.tension_Pa = *t.DTS_Pa, w.of_DTS = true;
    if (std::isnan(w.UCS_Pa) && std::isnan(w.tension_Pa)) throw std::invalid_argument("first_parameters: no strength");
    w.nu = t.nu.value_or(0.25);
    if (!t.nu) w.assumed.push_back("Poisson's ratio of 0.25");
    return w;
}

ContactMaterial contact_at(double way, double sigma_nt_Pa, const GrainMaterial& grain, double grain_m, std::optional<double> mu) {
    ContactMaterial c;
    const double scale = grain.E_Pa / grain_m;
    c.Kn_Pa_m = kStiffness * scale;
    c.eta = kEta;
    c.sigma_nt_Pa = sigma_nt_Pa;
    c.tau_Pa = kTauWay.at(way) * sigma_nt_Pa;
    c.mu = mu.value_or(kMuWay.at(way));
    c.Gfn_J_m2 = kBrittleWay.at(way) * sigma_nt_Pa * sigma_nt_Pa / scale;
    const double tau2 = c.tau_Pa * c.tau_Pa;
    c.Gfs_J_m2 = std::max(std::min(kShearBrittle * tau2 / scale, kMostShear * c.Gfn_J_m2),
                          kAboveBorder * tau2 / (2.0 * c.eta * c.Kn_Pa_m));
    return c;
}

// The friction coefficient with which the friction angle is met, within what the experiment has.
double mu_for(double friction_deg, double way, const GrainMaterial& grain, double grain_m, double inverse_modulus) {
    double low = 0.1, high = 0.9;
    for (int i = 0; i < 50; ++i) {
        const double mu = 0.5 * (low + high);
        const ContactMaterial c = contact_at(way, 1e7, grain, grain_m, mu);  // friction does not depend on the strength
        (friction(groups_of(grain, c, grain_m, inverse_modulus)) < friction_deg ? low : high) = mu;
    }
    return 0.5 * (low + high);
}

}  // namespace

const RuleErrors rule_errors{.UCS = 0.10, .DTS = 0.04, .BTS = 0.20, .friction_angle_deg = 7.4};

RockNumbers expected_rock(const GrainMaterial& grain, const ContactMaterial& contact, double grain_m, double inverse_modulus) {
    const Groups g = groups_of(grain, contact, grain_m, inverse_modulus);
    return {grain.E_Pa / (1.0 + E_loss(g)),
            ratio_of_Poisson(g),
            contact.sigma_nt_Pa * std::exp(ln_UCS(g)),
            contact.sigma_nt_Pa * std::exp(ln_DTS(g)),
            contact.sigma_nt_Pa * std::exp(ln_BTS(g)),
            friction(g)};
}

FirstParameters first_parameters(const RockTargets& targets, double grain_m, double inverse_modulus) {
    Wanted w = wanted_of(targets);
    FirstParameters first;
    first.inverse_modulus = inverse_modulus;
    first.of_DTS = w.of_DTS;
    first.wanted_ratio = w.UCS_Pa / w.tension_Pa;
    w.E_Pa = targets.E_Pa ? *targets.E_Pa : kUsualModulusRatio * (std::isnan(w.UCS_Pa) ? 13.0 * w.tension_Pa : w.UCS_Pa);
    if (!targets.E_Pa) w.assumed.push_back(fmt::format("E = {:.3g} GPa", 1e-9 * w.E_Pa));

    // Stiffness does not depend on strengths: E and nu of the grains first.
    first.grain = {.E_Pa = w.E_Pa, .nu = std::clamp(w.nu, 0.05, 0.45)};
    for (int i = 0; i < 30; ++i) {
        const RockNumbers elastic = expected_rock(first.grain, contact_at(0.0, 1e7, first.grain, grain_m, {}), grain_m);
        first.grain.E_Pa *= w.E_Pa / elastic.E_Pa;
        first.grain.nu = std::clamp(first.grain.nu + w.nu - elastic.nu, 0.0, 0.45);
    }

    const auto contact_of = [&](double way, double sigma_nt_Pa) {
        std::optional<double> mu;
        if (w.friction_deg) mu = mu_for(*w.friction_deg, way, first.grain, grain_m, inverse_modulus);
        return contact_at(way, sigma_nt_Pa, first.grain, grain_m, mu);
    };
    const auto expected_of = [&](double way, double sigma_nt_Pa) {
        return expected_rock(first.grain, contact_of(way, sigma_nt_Pa), grain_m, inverse_modulus);
    };
    const auto ratio = [&](double way) {
        const RockNumbers e = expected_of(way, 1e7);
        return e.UCS_Pa / (w.of_DTS ? e.DTS_Pa : e.BTS_Pa);
    };
    constexpr int kSteps = 80;  // the rules have squares, so the ends need not be where the way ends
    double lowest_way = -1.0, highest_way = 1.0;
    for (int i = 0; i <= kSteps; ++i) {
        const double way = -1.0 + 2.0 * i / kSteps;
        if (ratio(way) < ratio(lowest_way)) lowest_way = way;
        if (ratio(way) > ratio(highest_way)) highest_way = way;
    }
    first.lowest_ratio = ratio(lowest_way);
    first.highest_ratio = ratio(highest_way);
    double way = 0.0;
    if (std::isnan(first.wanted_ratio)) {
        w.assumed.push_back(
            fmt::format("UCS over {} of {:.3g}, that of middle parameters", w.of_DTS ? "DTS" : "BTS", ratio(way)));
    } else {
        double low = std::min(lowest_way, highest_way), high = std::max(lowest_way, highest_way);
        const bool rises = lowest_way < highest_way;
        for (int i = 0; i < 60; ++i) {
            way = 0.5 * (low + high);
            ((ratio(way) < first.wanted_ratio) == rises ? low : high) = way;
        }
    }
    const RockNumbers of_one = expected_of(way, 1e6);  // strengths are proportional to sigma_nt
    const double sigma_nt_Pa =
        1e6 * (std::isnan(w.UCS_Pa) ? w.tension_Pa / (w.of_DTS ? of_one.DTS_Pa : of_one.BTS_Pa) : w.UCS_Pa / of_one.UCS_Pa);
    first.contact = contact_of(way, sigma_nt_Pa);
    first.expected = expected_rock(first.grain, first.contact, grain_m, inverse_modulus);
    first.friction_reached = !w.friction_deg || std::abs(first.expected.friction_angle_deg - *w.friction_deg) < 3.0;
    first.assumed = w.assumed;
    return first;
}

std::optional<double> scatter_for(const RockTargets& targets, double grain_m) {
    if (first_parameters(targets, grain_m, kMostInverse).wanted_ratio >
        first_parameters(targets, grain_m, kMostInverse).highest_ratio)
        return std::nullopt;
    double low = 0.0, high = kMostInverse;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        const FirstParameters first = first_parameters(targets, grain_m, middle);
        (first.wanted_ratio > first.highest_ratio ? low : high) = middle;
    }
    return high;
}

}  // namespace feldspar
