// summarise(): from the tests of several packings to the properties of the rock, each with its range (P11)-(P13).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "feldspar/base/angle.hpp"
#include "feldspar/base/counted.hpp"
#include "feldspar/base/median.hpp"
#include "feldspar/base/regression.hpp"
#include "feldspar/lab/rock_properties.hpp"
#include "feldspar/lab/strength_envelope.hpp"
#include "feldspar/methods/method.hpp"

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

double strength(const TestProperties& p) { return p.peak_reached ? p.peak_stress_Pa : std::nan(""); }

/// A property that is read from one test, of every such test for which it is a number.
BySeed collect(std::span<const TestResult> results, const RockProperty& property) {
    BySeed values;
    for (const TestResult& r : results) {
        if (!property.tests.contains(r.test.kind)) continue;
        if (r.interrupted && !r.properties.peak_reached) continue;
        const double value = property.of_broken_only ? strength(r.properties) : property.quantity->value(r);
        if (std::isfinite(value)) values.emplace(r.seed, value);
    }
    return values;
}

/// A packing's strengths by confining stress: uniaxial at 0.
using Envelope = std::map<double, double>;

std::map<std::uint64_t, Envelope> envelopes(std::span<const TestResult> results) {
    std::map<std::uint64_t, Envelope> found;
    for (const TestResult& r : results) {
        if (!method_of(r.test).loading.on_envelope) continue;
        const double sigma1 = strength(r.properties);
        if (std::isfinite(sigma1)) found[r.seed].emplace(r.test.sigma3_Pa, sigma1);
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
        "Mohr-Coulomb (sigma_1 = UCS_fitted + N sigma_3) and Hoek-Brown (intact, no tensile points) by least squares on the "
        "{}biaxial "
        "tests (sigma_3 = {:g} MPa) of each packing, sigma_3 from {:g} to {:g} MPa; then median and range over {} (seed{} {}).",
        uniaxial ? "uniaxial and " : "", fmt::join(confined, ", "), *sigma3.begin() / 1e6, *sigma3.rbegin() / 1e6,
        counted(seeds.size(), "packing"), seeds.size() == 1 ? "" : "s", fmt::join(seeds, ", "));
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
    for (const auto& [s3, values] : by_sigma3) add(summary, confined_strength(s3), values);
    for (const RockProperty& property : rock_properties()) {
        if (property.source != RockProperty::Source::envelope) continue;
        BySeed values;
        for (const EnvelopeFit& fit : summary.fits) {
            if (std::isfinite(fit.*property.fit)) values[fit.seed] = fit.*property.fit;
        }
        add(summary, property.kept_name(), values);
    }
    summary.envelope_method = method(summary.fits);
}

// (P63) of each packing sheared under two normal stresses or more.
void add_shear_envelopes(PropertySummary& summary, std::span<const TestResult> results) {
    std::map<std::uint64_t, std::map<double, const TestResult*>> found;
    for (const TestResult& r : results)
        if (method_of(r.test).specimen.sheared && r.properties.peak_reached) found[r.seed].emplace(r.test.sigma3_Pa, &r);
    const auto value = [](const TestResult& r, std::string_view name) { return test_quantity(name).value(r); };
    for (const auto& [seed, tests] : found) {
        ShearFit fit;
        fit.seed = seed;
        std::vector<double> normal, residual;
        for (const auto& [stress, result] : tests) {
            fit.normal_Pa.push_back(value(*result, "shear_normal_stress"));
            fit.peak_Pa.push_back(value(*result, "shear_strength"));
            fit.residual_Pa.push_back(value(*result, "shear_strength_residual"));
            if (!std::isfinite(fit.residual_Pa.back())) continue;
            normal.push_back(value(*result, "shear_normal_stress_residual"));
            residual.push_back(fit.residual_Pa.back());
        }
        if (tests.size() < 2) continue;
        const auto degrees = [](double slope) { return in_degrees(std::atan(slope)); };
        const Line peak = regression_line(fit.normal_Pa, fit.peak_Pa), end = regression_line(normal, residual);
        fit.cohesion_Pa = peak.intercept;
        fit.friction_angle_deg = degrees(peak.slope);
        fit.residual_cohesion_Pa = end.intercept;
        fit.residual_friction_angle_deg = degrees(end.slope);
        summary.shear_fits.push_back(std::move(fit));
    }
    for (const RockProperty& property : rock_properties()) {
        if (property.source != RockProperty::Source::shear_envelope) continue;
        BySeed values;
        for (const ShearFit& fit : summary.shear_fits)
            if (std::isfinite(fit.*property.shear_fit)) values[fit.seed] = fit.*property.shear_fit;
        add(summary, property.kept_name(), values);
    }
}

}  // namespace

PropertySummary summarise(std::span<const TestResult> results) {
    PropertySummary summary;
    for (const RockProperty& property : rock_properties()) {
        if (property.source == RockProperty::Source::test) add(summary, property.kept_name(), collect(results, property));
        if (property.source == RockProperty::Source::ratio)
            add(summary, property.kept_name(),
                ratio(collect(results, *rock_property(property.above)), collect(results, *rock_property(property.below))));
    }
    add_envelopes(summary, results);
    add_shear_envelopes(summary, results);
    return summary;
}

}  // namespace feldspar
