#include "feldspar/specimen/grain_sizes.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/special_functions/erf.hpp>
#include <fmt/format.h>

#include "feldspar/base/error.hpp"

namespace feldspar {
namespace {

constexpr const char* diameter_key = "specimen.grains.diameter";

/// Standard normal distribution function.
double phi(double z) { return 0.5 * std::erfc(-z * std::sqrt(0.5)); }

/// Phi(b) - Phi(a) for a <= b, taken in the lower tail, where small differences keep their digits.
double phi_between(double a, double b) { return a > 0.0 ? phi(-a) - phi(-b) : phi(b) - phi(a); }

/// Truncation of a log-normal in standard units.
struct LogNormal {
    double s, a, b;
    explicit LogNormal(const GrainSizeSpec& g)
        : s(g.log_standard_deviation), a(std::log(g.minimum_m / g.median_m) / s), b(std::log(g.maximum_m / g.median_m) / s) {}
    double moment_factor(double k) const { return phi_between(a - k * s, b - k * s) / phi_between(a, b); }
};

/// Share of a sieve interval in the number of grains, not normalised: the integral of d^-3 over the interval times the
/// area fraction per ln d.
double interval_number(SievePoint low, SievePoint high) {
    const double fraction = (high.passing - low.passing) / std::log(high.diameter_m / low.diameter_m);
    return fraction * 0.5 * (1.0 / (low.diameter_m * low.diameter_m) - 1.0 / (high.diameter_m * high.diameter_m));
}

void check_bounds(const GrainSizeSpec& spec) {
    if (!(spec.minimum_m > 0.0) || !(spec.maximum_m >= spec.minimum_m) || !std::isfinite(spec.maximum_m)) {
        throw InputError({"", 0, 0, diameter_key}, fmt::format("diameters from {:g} m to {:g} m", spec.minimum_m, spec.maximum_m),
                         "a minimum greater than zero and a maximum not below it");
    }
}

void check_log_normal(const GrainSizeSpec& spec) {
    check_bounds(spec);
    if (!(spec.median_m > 0.0) || !(spec.log_standard_deviation > 0.0) || !std::isfinite(spec.log_standard_deviation)) {
        throw InputError({"", 0, 0, diameter_key},
                         fmt::format("median {:g} m, standard deviation of ln(diameter) {:g}", spec.median_m, spec.log_standard_deviation),
                         "both greater than zero");
    }
    const LogNormal d(spec);
    if (!(phi_between(d.a, d.b) > 1e-6)) {
        throw InputError({"", 0, 0, diameter_key},
                         fmt::format("hardly any grain of the log-normal distribution lies between {:g} m and {:g} m", spec.minimum_m, spec.maximum_m),
                         "bounds that hold at least a millionth of the distribution");
    }
}

void check_sieve(const GrainSizeSpec& spec) {
    const auto& sieve = spec.sieve;
    if (sieve.size() < 2 || sieve.front().passing != 0.0 || sieve.back().passing != 1.0 || !(sieve.front().diameter_m > 0.0)) {
        throw InputError({"", 0, 0, diameter_key}, fmt::format("a sieve curve of {} points", sieve.size()),
                         "at least two points, the first with passing 0 at a diameter greater than zero, the last with passing 1");
    }
    for (std::size_t i = 1; i < sieve.size(); ++i) {
        if (!(sieve[i].diameter_m > sieve[i - 1].diameter_m) || !(sieve[i].passing >= sieve[i - 1].passing)) {
            throw InputError({"", 0, 0, diameter_key},
                             fmt::format("point {} of the sieve curve ({:g} m, passing {:g}) lies below the one before it", i + 1,
                                         sieve[i].diameter_m, sieve[i].passing),
                             "increasing diameters with passing that never falls");
        }
    }
}

}  // namespace

void check_grain_sizes(const GrainSizeSpec& spec) {
    switch (spec.kind) {
        case GrainSizeKind::uniform: return check_bounds(spec);
        case GrainSizeKind::log_normal: return check_log_normal(spec);
        case GrainSizeKind::sieve: return check_sieve(spec);
    }
}

DiameterMoments diameter_moments(const GrainSizeSpec& spec) {
    check_grain_sizes(spec);
    const double a = spec.minimum_m, b = spec.maximum_m;
    if (spec.kind == GrainSizeKind::uniform) return {0.5 * (a + b), (a * a + a * b + b * b) / 3.0};
    if (spec.kind == GrainSizeKind::log_normal) {
        const LogNormal d(spec);
        const double m = spec.median_m, s2 = d.s * d.s;
        return {m * std::exp(0.5 * s2) * d.moment_factor(1.0), m * m * std::exp(2.0 * s2) * d.moment_factor(2.0)};
    }
    double number = 0.0, first = 0.0;
    for (std::size_t i = 1; i < spec.sieve.size(); ++i) {
        const SievePoint low = spec.sieve[i - 1], high = spec.sieve[i];
        number += interval_number(low, high);
        first += (high.passing - low.passing) / std::log(high.diameter_m / low.diameter_m) * (1.0 / low.diameter_m - 1.0 / high.diameter_m);
    }
    return {first / number, 1.0 / number};  // the integral of d^2 d^-3, weighted so, is the whole area: 1
}

double counting_diameter(const GrainSizeSpec& spec) {
    const DiameterMoments moments = diameter_moments(spec);
    return spec.kind == GrainSizeKind::uniform ? moments.mean_m : std::sqrt(moments.mean_square_m2);
}

double largest_of_sieve_m(const std::vector<SievePoint>& sieve) {
    const auto all = std::find_if(sieve.begin(), sieve.end(), [](SievePoint p) { return p.passing >= 1.0; });
    return (all == sieve.end() ? sieve.back() : *all).diameter_m;
}

namespace {

double sample_log_normal(const GrainSizeSpec& spec, double u) {
    const LogNormal d(spec);
    // In the lower half, for accuracy: an upper-tail window is mirrored.
    const bool mirrored = d.a > 0.0;
    const double low = mirrored ? -d.b : d.a, high = mirrored ? -d.a : d.b;
    const double p = phi(low) + u * (phi(high) - phi(low));
    const double z = -std::sqrt(2.0) * boost::math::erfc_inv(std::clamp(2.0 * p, 1e-300, 2.0 - 1e-15));
    return std::clamp(spec.median_m * std::exp(d.s * (mirrored ? -z : z)), spec.minimum_m, spec.maximum_m);
}

double sample_sieve(const std::vector<SievePoint>& sieve, const std::vector<double>& cumulative, double u) {
    const double target = u * cumulative.back();
    std::size_t i = 1;
    while (i + 1 < sieve.size() && cumulative[i] <= target) ++i;
    const double part = std::clamp((target - cumulative[i - 1]) / (cumulative[i] - cumulative[i - 1]), 0.0, 1.0);
    const double fine = 1.0 / (sieve[i - 1].diameter_m * sieve[i - 1].diameter_m);
    const double coarse = 1.0 / (sieve[i].diameter_m * sieve[i].diameter_m);
    return 1.0 / std::sqrt(fine - part * (fine - coarse));
}

}  // namespace

namespace {

/// By how much the area of a random sample may miss that of the distribution, as a share of it.
constexpr double most_area_missed = 0.1;

double diameter_at(const GrainSizeSpec& spec, const std::vector<double>& cumulative, double u) {
    switch (spec.kind) {
        case GrainSizeKind::uniform: return spec.minimum_m + u * (spec.maximum_m - spec.minimum_m);
        case GrainSizeKind::log_normal: return sample_log_normal(spec, u);
        case GrainSizeKind::sieve: return sample_sieve(spec.sieve, cumulative, u);
    }
    return spec.minimum_m;
}

}  // namespace

std::vector<double> sample_diameters(const GrainSizeSpec& spec, int count, RandomStream& random) {
    check_grain_sizes(spec);
    std::vector<double> cumulative = {0.0};
    for (std::size_t i = 1; i < spec.sieve.size() && spec.kind == GrainSizeKind::sieve; ++i) {
        cumulative.push_back(cumulative.back() + interval_number(spec.sieve[i - 1], spec.sieve[i]));
    }
    std::vector<double> diameters;
    diameters.reserve(static_cast<std::size_t>(std::max(0, count)));
    double squares = 0.0;
    for (int i = 0; i < count; ++i) {
        diameters.push_back(diameter_at(spec, cumulative, random.uniform()));
        squares += diameters.back() * diameters.back();
    }
    const double wanted = count * diameter_moments(spec).mean_square_m2;
    if (std::abs(squares - wanted) <= most_area_missed * wanted) return diameters;
    for (int i = 0; i < count; ++i) diameters[static_cast<std::size_t>(i)] = diameter_at(spec, cumulative, (i + random.uniform()) / count);
    return diameters;
}

}  // namespace feldspar
