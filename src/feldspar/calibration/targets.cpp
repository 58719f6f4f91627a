// From what runs show to what the laboratory measured.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/calibration/calibration.hpp"
#include "feldspar/lab/rock_properties.hpp"
#include "feldspar/lab/strength_envelope.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/user_units.hpp"

namespace feldspar {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// By how much the intercept of a straight envelope and the measured UCS may differ, because real envelopes are curved.
constexpr double curvature_allowance = 0.25;
constexpr double ratio_allowance = 0.10;

bool of_envelope(const Target& target) {
    return target.name == "cohesion" || target.name == "friction_angle" || target.name == "hoek_brown_mi";
}

// A property that is one number of one kind of test.
Observable observable(const std::string& name, const std::string& property) {
    const RockProperty& read_from = *kept_rock_property(property);
    return {name, *read_from.tests.begin(), 0.0, read_from.quantity->kept_name(), name != "nu"};
}

double mean_of(const std::string& name, const std::vector<Observable>& quantities, const std::vector<double>& means) {
    for (std::size_t q = 0; q < quantities.size(); ++q)
        if (quantities[q].name == name) return means[q];
    return nan;
}

EnvelopeFit envelope(const std::vector<Observable>& quantities, const std::vector<double>& means) {
    std::vector<double> sigma3, sigma1;
    for (std::size_t q = 0; q < quantities.size(); ++q) {
        const bool confined = method_of(quantities[q].test).specimen.confined;
        if (!confined && quantities[q].name != "UCS") continue;
        sigma3.push_back(quantities[q].sigma3_Pa);
        sigma1.push_back(means[q]);
    }
    return fit_envelopes(std::move(sigma3), std::move(sigma1));
}

}  // namespace

std::vector<Observable> observables_for(const Calibration& calibration) {
    return observables_for(calibration.targets, calibration.sigma3_Pa);
}

std::vector<Observable> observables_for(const std::vector<Target>& targets, const std::vector<double>& sigma3_of_tests_Pa) {
    std::vector<Observable> all;
    const auto add = [&](const Observable& quantity) {
        if (std::none_of(all.begin(), all.end(), [&](const Observable& q) { return q.name == quantity.name; }))
            all.push_back(quantity);
    };
    const Observable ucs = observable("UCS", "UCS_Pa"), dts = observable("DTS", "DTS_Pa"), bts = observable("BTS", "BTS_Pa");
    const auto confined = [&](double sigma3_Pa) {
        add({fmt::format("sigma1 at {:g} MPa", sigma3_Pa / 1e6), method_of_confined_strength(), sigma3_Pa, strength_column});
    };
    for (const Target& target : targets) {
        if (target.name == "E" || target.name == "nu" || target.name == "sigma_ci" || target.name == "sigma_cd")
            add(observable(target.name, property_of(target)));
        if (target.name.starts_with("sigma_ci_over")) add(observable("sigma_ci", property_of({.name = "sigma_ci"})));
        if (target.name.starts_with("sigma_cd_over")) add(observable("sigma_cd", property_of({.name = "sigma_cd"})));
        if (target.name == "UCS" || target.name.ends_with("_over_UCS") || target.name.starts_with("UCS_over") ||
            of_envelope(target))
            add(ucs);
        if (target.name == "DTS" || target.name.ends_with("_DTS")) add(dts);
        if (target.name == "BTS" || target.name.find("BTS") != std::string::npos) add(bts);
        if (target.name == "sigma1") confined(target.sigma3_Pa);
        if (of_envelope(target))
            for (const double sigma3_Pa : sigma3_of_tests_Pa) confined(sigma3_Pa);
    }
    return all;
}

std::string property_of(const Target& target) {
    if (target.name == "sigma1") return confined_strength(target.sigma3_Pa);
    return property_of_laboratory(target.name == "sigma_ci" ? "sigma_ci_crack_volume" : target.name);
}

double value_of(const Target& target, const std::vector<Observable>& quantities, const std::vector<double>& means) {
    const auto mean = [&](const std::string& name) { return mean_of(name, quantities, means); };
    if (target.name == "UCS_over_BTS") return mean("UCS") / mean("BTS");
    if (target.name == "UCS_over_DTS") return mean("UCS") / mean("DTS");
    if (target.name == "sigma_ci_over_UCS") return mean("sigma_ci") / mean("UCS");
    if (target.name == "sigma_cd_over_UCS") return mean("sigma_cd") / mean("UCS");
    if (target.name == "BTS_over_DTS") return mean("BTS") / mean("DTS");
    if (target.name == "cohesion") return envelope(quantities, means).cohesion_Pa;
    if (target.name == "friction_angle") return envelope(quantities, means).friction_angle_deg;
    if (target.name == "hoek_brown_mi") return envelope(quantities, means).hoek_brown_mi;
    return mean(target.label());
}

bool needs(const Target& target, const std::vector<Observable>& quantities, std::size_t quantity) {
    std::vector<double> sigma3_Pa;
    for (const Observable& q : quantities)
        if (method_of(q.test).specimen.confined) sigma3_Pa.push_back(q.sigma3_Pa);
    const std::vector<Observable> own = observables_for({target}, sigma3_Pa);
    return std::any_of(own.begin(), own.end(), [&](const Observable& q) { return q.name == quantities[quantity].name; });
}

double target_value(std::string_view name, const std::vector<Target>& targets) {
    const auto found = std::find_if(targets.begin(), targets.end(), [&](const Target& target) { return target.name == name; });
    return found == targets.end() ? nan : found->value;
}

double wanted_UCS_Pa(const std::vector<Target>& targets) {
    const double UCS = target_value("UCS", targets);
    return std::isfinite(UCS) ? UCS
                              : mohr_coulomb_UCS_Pa(target_value("cohesion", targets), target_value("friction_angle", targets));
}

double wanted_strength_Pa(const TestSpec& test, const std::vector<Target>& targets) {
    const double UCS = wanted_UCS_Pa(targets);
    if (!method_of(test).loading.on_envelope) return nan;
    if (!is_confined(test)) return UCS;
    for (const Target& target : targets)
        if (target.name == "sigma1" && target.sigma3_Pa == test.sigma3_Pa) return target.value;
    return UCS + mohr_coulomb_slope(target_value("friction_angle", targets)) * test.sigma3_Pa;
}

std::vector<std::string> contradictions(const std::vector<Target>& targets) {
    const auto value = [&](const char* name) { return target_value(name, targets); };
    std::vector<std::string> sentences;
    const double UCS = value("UCS"), c = value("cohesion"), phi = value("friction_angle");
    const double intercept = mohr_coulomb_UCS_Pa(c, phi);
    if (std::abs(intercept / UCS - 1.0) > curvature_allowance)
        sentences.push_back(
            fmt::format("A cohesion of {:.4g} MPa and a friction angle of {:.4g} deg mean a uniaxial strength of 2 c sqrt(N) = "
                        "{:.4g} MPa, but UCS is to be {:.4g} MPa; "
                        "the curvature of an envelope accounts for {:.0f} % at most.",
                        c / 1e6, phi, intercept / 1e6, UCS / 1e6, 100.0 * curvature_allowance));
    const auto ratio = [&](const char* name, double above, double below) {
        const double given = value(name);
        if (std::abs(above / below / given - 1.0) > ratio_allowance)
            sentences.push_back(
                fmt::format("{} is to be {:.4g}, but the two strengths, which are targets too, have a ratio of {:.4g}.", name,
                            given, above / below));
    };
    ratio("UCS_over_BTS", UCS, value("BTS"));
    ratio("UCS_over_DTS", UCS, value("DTS"));
    ratio("BTS_over_DTS", value("BTS"), value("DTS"));
    return sentences;
}

}  // namespace feldspar
