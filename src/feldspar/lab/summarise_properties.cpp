// summarise(): from the tests of several packings to the properties of the rock, each with its range (P11)-(P13).
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "feldspar/base/median.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/lab/strength_envelope.hpp"

namespace feldspar {

namespace {

/// A property's value on each packing. A packing tested twice in the same way keeps its first value.
using BySeed = std::map<std::uint64_t, double>;

void add(PropertySummary& summary, const std::string& name, const BySeed& values) {
    if (values.empty()) return;
    PropertyStatistics s;
    for (const auto& [seed, value] : values) {
        s.seeds.push_back(seed);
        s.values.push_back(value);
    }
    s.median = median(s.values);
    s.minimum = *std::min_element(s.values.begin(), s.values.end());
    s.maximum = *std::max_element(s.values.begin(), s.values.end());
    summary.values[name] = std::move(s);
}

BySeed ratio(const BySeed& above, const BySeed& below) {
    BySeed paired;
    for (const auto& [seed, value] : above) {
        const auto other = below.find(seed);
        if (other != below.end() && other->second > 0.0) paired[seed] = value / other->second;
    }
    return paired;
}

/// `read` from every test of a kind for which it is a number.
BySeed collect(std::span<const TestResult> results, TestKind kind, const std::function<double(const TestProperties&)>& read) {
    BySeed values;
    for (const TestResult& r : results) {
        if (r.test.kind != kind) continue;
        if (r.interrupted && !r.properties.peak_reached) continue;
        if (const double value = read(r.properties); std::isfinite(value)) values.emplace(r.seed, value);
    }
    return values;
}

double strength(const TestProperties& p) { return p.peak_reached ? p.peak_stress_Pa : std::nan(""); }

/// A packing's strengths by confining stress: uniaxial at 0, biaxial at its sigma_3.
using Envelope = std::map<double, double>;

std::map<std::uint64_t, Envelope> envelopes(std::span<const TestResult> results) {
    std::map<std::uint64_t, Envelope> found;
    for (const TestResult& r : results) {
        const bool uniaxial = r.test.kind == TestKind::uniaxial_compression;
        if (!uniaxial && r.test.kind != TestKind::biaxial) continue;
        const double sigma1 = strength(r.properties);
        if (std::isfinite(sigma1)) found[r.seed].emplace(uniaxial ? 0.0 : r.test.sigma3_Pa, sigma1);
    }
    return found;
}

std::string method(const std::vector<EnvelopeFit>& fits) {
    if (fits.empty()) return {};
    std::set<std::string> tests;
    std::vector<std::uint64_t> seeds;
    std::set<double> sigma3;
    for (const EnvelopeFit& fit : fits) {
        seeds.push_back(fit.seed);
        sigma3.insert(fit.sigma3_Pa.begin(), fit.sigma3_Pa.end());
    }
    std::vector<double> confined;
    for (const double s : sigma3) {
        if (s > 0.0) confined.push_back(s / 1e6);
    }
    const bool uniaxial = *sigma3.begin() == 0.0;
    return fmt::format(
        "Mohr-Coulomb (sigma_1 = UCS_fitted + N sigma_3) and Hoek-Brown (intact, no tensile points) by least squares on the {}biaxial "
        "tests (sigma_3 = {:g} MPa) of each packing, sigma_3 from {:g} to {:g} MPa; then median and range over {} packing{} (seed{} {}).",
        uniaxial ? "uniaxial and " : "", fmt::join(confined, ", "), *sigma3.begin() / 1e6, *sigma3.rbegin() / 1e6, seeds.size(),
        seeds.size() == 1 ? "" : "s", seeds.size() == 1 ? "" : "s", fmt::join(seeds, ", "));
}

void add_envelopes(PropertySummary& summary, std::span<const TestResult> results) {
    std::map<double, BySeed> by_sigma3;
    for (const auto& [seed, envelope] : envelopes(results)) {
        std::vector<double> sigma3, sigma1;
        for (const auto& [s3, s1] : envelope) {
            sigma3.push_back(s3);
            sigma1.push_back(s1);
            if (s3 > 0.0) by_sigma3[s3][seed] = s1;
        }
        if (sigma3.size() < 2) continue;
        summary.fits.push_back(fit_envelopes(std::move(sigma3), std::move(sigma1)));
        summary.fits.back().seed = seed;
    }
    for (const auto& [s3, values] : by_sigma3) add(summary, fmt::format("sigma1_at_sigma3_{:g}MPa_Pa", s3 / 1e6), values);
    const auto add_fitted = [&](const std::string& name, double EnvelopeFit::* member) {
        BySeed values;
        for (const EnvelopeFit& fit : summary.fits) {
            if (std::isfinite(fit.*member)) values[fit.seed] = fit.*member;
        }
        add(summary, name, values);
    };
    add_fitted("cohesion_Pa", &EnvelopeFit::cohesion_Pa);
    add_fitted("friction_angle_deg", &EnvelopeFit::friction_angle_deg);
    add_fitted("UCS_fitted_Pa", &EnvelopeFit::UCS_fitted_Pa);
    add_fitted("hoek_brown_mi", &EnvelopeFit::hoek_brown_mi);
    add_fitted("hoek_brown_UCS_Pa", &EnvelopeFit::hoek_brown_UCS_Pa);
    summary.envelope_method = method(summary.fits);
}

}  // namespace

PropertySummary summarise(std::span<const TestResult> results) {
    PropertySummary summary;
    const auto add_uniaxial = [&](const std::string& name, double TestProperties::* member) {
        add(summary, name, collect(results, TestKind::uniaxial_compression, [member](const TestProperties& p) { return p.*member; }));
    };
    add_uniaxial("E_Pa", &TestProperties::E_secant_Pa);
    add_uniaxial("E_tangent_Pa", &TestProperties::E_tangent_Pa);
    add_uniaxial("E_average_Pa", &TestProperties::E_average_Pa);
    add_uniaxial("E_gauge_Pa", &TestProperties::E_gauge_Pa);
    add_uniaxial("nu", &TestProperties::nu);
    add_uniaxial("nu_tangent", &TestProperties::nu_tangent);
    add_uniaxial("E_initial_Pa", &TestProperties::E_initial_Pa);
    add_uniaxial("nu_initial", &TestProperties::nu_initial);
    add_uniaxial("first_crack_Pa", &TestProperties::first_crack_Pa);
    add_uniaxial("sigma_ci_crack_count_Pa", &TestProperties::sigma_ci_crack_count_Pa);
    add_uniaxial("sigma_ci_crack_volume_Pa", &TestProperties::sigma_ci_crack_volume_Pa);
    add_uniaxial("sigma_ci_lateral_strain_Pa", &TestProperties::sigma_ci_lateral_strain_Pa);
    add_uniaxial("sigma_cd_Pa", &TestProperties::sigma_cd_Pa);
    // Not the post-peak modulus: it jumps from minus to plus infinity where the branch is upright, and has no median there.
    add(summary, "brittleness_k1", collect(results, TestKind::uniaxial_compression, [](const TestProperties& p) { return p.post_peak.brittleness; }));

    const BySeed ucs = collect(results, TestKind::uniaxial_compression, strength);
    const BySeed dts = collect(results, TestKind::direct_tension, strength);
    const BySeed bts = collect(results, TestKind::brazilian, strength);
    add(summary, "UCS_Pa", ucs);
    add(summary, "DTS_Pa", dts);
    add(summary, "BTS_Pa", bts);
    const auto add_brazilian = [&](const std::string& name, double BrazilianFailure::* member) {
        add(summary, name, collect(results, TestKind::brazilian, [member](const TestProperties& p) { return p.brazilian.*member; }));
    };
    add_brazilian("BTS_first_dip_Pa", &BrazilianFailure::first_dip_Pa);
    add_brazilian("BTS_largest_Pa", &BrazilianFailure::largest_Pa);
    add(summary, "BTS_valid_share", collect(results, TestKind::brazilian, [](const TestProperties& p) { return p.brazilian.valid ? 1.0 : 0.0; }));
    add(summary, "UCS_over_DTS", ratio(ucs, dts));
    add(summary, "UCS_over_BTS", ratio(ucs, bts));
    add(summary, "BTS_over_DTS", ratio(bts, dts));
    add_envelopes(summary, results);
    return summary;
}

}  // namespace feldspar
