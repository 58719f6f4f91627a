#include "feldspar/specimen/grain_sizes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"

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
        throw InputError(
            {"", 0, 0, diameter_key},
            fmt::format("median {:g} m, standard deviation of ln(diameter) {:g}", spec.median_m, spec.log_standard_deviation),
            "both greater than zero");
    }
    const LogNormal d(spec);
    if (!(phi_between(d.a, d.b) > 1e-6)) {
        throw InputError({"", 0, 0, diameter_key},
                         fmt::format("hardly any grain of the log-normal distribution lies between {:g} m and {:g} m",
                                     spec.minimum_m, spec.maximum_m),
                         "bounds that hold at least a millionth of the distribution");
    }
}

void check_sieve(const GrainSizeSpec& spec) {
    const auto& sieve = spec.sieve;
    if (sieve.size() < 2 || sieve.front().passing != 0.0 || sieve.back().passing != 1.0 || !(sieve.front().diameter_m > 0.0)) {
        throw InputError(
            {"", 0, 0, diameter_key}, fmt::format("a sieve curve of {} points", sieve.size()),
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
        case GrainSizeKind::uniform:
            return check_bounds(spec);
        case GrainSizeKind::log_normal:
            return check_log_normal(spec);
        case GrainSizeKind::sieve:
            return check_sieve(spec);
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
        first += (high.passing - low.passing) / std::log(high.diameter_m / low.diameter_m) *
                 (1.0 / low.diameter_m - 1.0 / high.diameter_m);
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
        case GrainSizeKind::uniform:
            return spec.minimum_m + u * (spec.maximum_m - spec.minimum_m);
        case GrainSizeKind::log_normal:
            return sample_log_normal(spec, u);
        case GrainSizeKind::sieve:
            return sample_sieve(spec.sieve, cumulative, u);
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
    for (int i = 0; i < count; ++i)
        diameters[static_cast<std::size_t>(i)] = diameter_at(spec, cumulative, (i + random.uniform()) / count);
    return diameters;
}

double smallest_of(const GrainSizeSpec& spec) {
    if (spec.kind != GrainSizeKind::sieve) return spec.minimum_m;
    std::size_t first = 0;  // below the last sieve that nothing passes there are no grains
    while (first + 1 < spec.sieve.size() && spec.sieve[first + 1].passing <= 0.0) ++first;
    return spec.sieve[first].diameter_m;
}

double largest_of(const GrainSizeSpec& spec) {
    return spec.kind == GrainSizeKind::sieve ? largest_of_sieve_m(spec.sieve) : spec.maximum_m;
}

SizeSummary summary_of(std::vector<double> diameters) {
    if (diameters.empty()) return {};
    std::sort(diameters.begin(), diameters.end());
    double sum = 0.0, area = 0.0, below = 0.0;
    for (const double d : diameters) {
        sum += d;
        area += d * d;
    }
    SizeSummary summary{sum / static_cast<double>(diameters.size()), diameters.front(), diameters.back(), diameters.back()};
    for (const double d : diameters) {
        below += d * d;
        if (below < 0.5 * area) continue;
        summary.D50_m = d;
        break;
    }
    return summary;
}

namespace {

/// Grains of each phase for a unit of area, 1/m^2, by (H7) and (H8): each cell is a disc with a film e = e0 D / (d + D) around
/// it, where D is the mean diameter of the neighbours, by their perimeters; e0 is such that the discs have the share 1 - n of the
/// area.
std::vector<double> grains_per_area(const std::vector<PhaseSizes>& phases, double porosity) {
    std::vector<DiameterMoments> moments;
    double widest = 0.0;
    for (const PhaseSizes& phase : phases) {
        moments.push_back(diameter_moments(phase.sizes));
        widest = std::max(widest, largest_of(phase.sizes));
    }
    std::vector<double> numbers(phases.size());
    double neighbours = widest;
    const auto share_of_discs = [&](double e0) {
        double sum = 0.0;
        for (std::size_t p = 0; p < phases.size(); ++p) {
            const DiameterMoments& m = moments[p];
            const double e = e0 * neighbours / (m.mean_m + neighbours);
            numbers[p] = phases[p].share / (0.25 * std::numbers::pi * (m.mean_square_m2 + 4.0 * e * m.mean_m + 4.0 * e * e));
            sum += 0.25 * std::numbers::pi * numbers[p] * m.mean_square_m2;
        }
        return sum;
    };
    for (int round = 0; round < 20; ++round) {  // each numbers for the next mean of the neighbours
        double low = 0.0, high = widest;
        while (share_of_discs(high) > 1.0 - porosity) high *= 2.0;
        for (int i = 0; i < 100; ++i) {
            const double middle = 0.5 * (low + high);
            (share_of_discs(middle) > 1.0 - porosity ? low : high) = middle;
        }
        double squares = 0.0, perimeters = 0.0;
        for (std::size_t p = 0; p < phases.size(); ++p) {
            squares += numbers[p] * moments[p].mean_square_m2;
            perimeters += numbers[p] * moments[p].mean_m;
        }
        neighbours = squares / perimeters;
    }
    return numbers;
}

/// E[d^2; d <= D] of a distribution by number, m^2, in closed form.
double partial_square(const GrainSizeSpec& spec, double d) {
    if (d <= smallest_of(spec)) return 0.0;
    if (d >= largest_of(spec)) return diameter_moments(spec).mean_square_m2;
    if (spec.kind == GrainSizeKind::uniform) {
        if (spec.maximum_m == spec.minimum_m) return 0.0;
        return (d * d * d - spec.minimum_m * spec.minimum_m * spec.minimum_m) / (3.0 * (spec.maximum_m - spec.minimum_m));
    }
    if (spec.kind == GrainSizeKind::log_normal) {
        GrainSizeSpec below = spec;
        below.maximum_m = d;
        const LogNormal whole(spec), part(below);
        return diameter_moments(below).mean_square_m2 * phi_between(part.a, part.b) / phi_between(whole.a, whole.b);
    }
    double passing = 0.0;
    for (std::size_t i = 1; i < spec.sieve.size(); ++i) {
        const SievePoint low = spec.sieve[i - 1], high = spec.sieve[i];
        if (d >= high.diameter_m)
            passing = high.passing;
        else if (d > low.diameter_m)
            passing = low.passing +
                      (high.passing - low.passing) * std::log(d / low.diameter_m) / std::log(high.diameter_m / low.diameter_m);
    }
    return passing * diameter_moments(spec).mean_square_m2;
}

}  // namespace

std::vector<int> grains_of_phases(const std::vector<PhaseSizes>& phases, double area_m2, double porosity) {
    double sum = 0.0;
    for (const PhaseSizes& phase : phases) {
        check_grain_sizes(phase.sizes);
        sum += phase.share;
    }
    if (!(std::abs(sum - 1.0) < 1e-6))
        throw InputError({"", 0, 0, "material.phase.share"}, fmt::format("the shares of the minerals add up to {:.6g}", sum),
                         "1 (100 %)");
    const std::vector<double> numbers = grains_per_area(phases, porosity);
    std::vector<int> counts;
    for (std::size_t p = 0; p < phases.size(); ++p) {
        const PhaseSizes& phase = phases[p];
        const double count = area_m2 * numbers[p];
        if (count < 0.5)
            throw InputError({"", 0, 0, "material.phase.diameter"},
                             fmt::format("the share of \"{}\", {:.3g} %, is less than half a grain of its size", phase.name,
                                         100.0 * phase.share),
                             "a share of a grain or more", "smaller grains of it, a larger share, or a larger specimen");
        if (count > 1e8)
            throw InputError({"", 0, 0, "material.phase.diameter"},
                             fmt::format("the grains of \"{}\" would be {:.3g}", phase.name, count), "larger grains");
        counts.push_back(static_cast<int>(std::lround(count)));
    }
    return counts;
}

PhasedDiameters sample_by_phase(const std::vector<PhaseSizes>& phases, const std::vector<int>& counts, RandomStream& random) {
    PhasedDiameters sample;
    for (std::size_t p = 0; p < phases.size(); ++p) {
        const GrainSizeSpec& spec = phases[p].sizes;
        std::vector<double> cumulative = {0.0};
        for (std::size_t i = 1; i < spec.sieve.size() && spec.kind == GrainSizeKind::sieve; ++i)
            cumulative.push_back(cumulative.back() + interval_number(spec.sieve[i - 1], spec.sieve[i]));
        for (int i = 0; i < counts[p]; ++i) {
            sample.diameters_m.push_back(diameter_at(spec, cumulative, (i + random.uniform()) / counts[p]));
            sample.phases.push_back(static_cast<int>(p));
        }
    }
    return sample;
}

std::vector<PhaseFill> fill_of_phases(const Specimen& specimen) {
    const std::size_t phases = specimen.packing.phase_names.size();
    std::vector<PhaseFill> fills(phases);
    std::vector<std::vector<double>> discs(phases), cells(phases);
    double total = 0.0;
    for (std::size_t g = 0; g < specimen.packing.phases.size(); ++g) {
        const auto p = static_cast<std::size_t>(specimen.packing.phases[g]);
        const double area = signed_area(corners_of_cell(specimen.cells, static_cast<int>(g)));
        ++fills[p].grains;
        fills[p].area_share += area;
        total += area;
        cells[p].push_back(2.0 * std::sqrt(area / std::numbers::pi));
    }
    const Packing& packed = specimen.packed.centres.empty() ? specimen.packing : specimen.packed;
    for (std::size_t i = 0; i < packed.phases.size(); ++i)
        discs[static_cast<std::size_t>(packed.phases[i])].push_back(2.0 * packed.radii_m[i]);
    for (std::size_t p = 0; p < phases; ++p) {
        fills[p].area_share /= total;
        fills[p].discs = summary_of(std::move(discs[p]));
        fills[p].cells = summary_of(std::move(cells[p]));
    }
    return fills;
}

GrainSizeSpec mixture_of(const std::vector<PhaseSizes>& phases, double porosity) {
    constexpr int kPoints = 200;
    const std::vector<double> numbers = grains_per_area(phases, porosity);
    double low = std::numeric_limits<double>::infinity(), high = 0.0, all = 0.0;
    for (std::size_t p = 0; p < phases.size(); ++p) {
        low = std::min(low, smallest_of(phases[p].sizes));
        high = std::max(high, largest_of(phases[p].sizes));
        all += numbers[p] * diameter_moments(phases[p].sizes).mean_square_m2;
    }
    GrainSizeSpec mixture;
    if (!(high > low * (1.0 + 1e-9))) {
        mixture.minimum_m = low;
        mixture.maximum_m = high;
        return mixture;
    }
    mixture.kind = GrainSizeKind::sieve;
    for (int i = 0; i <= kPoints; ++i) {
        const double d = i == kPoints ? high : low * std::pow(high / low, static_cast<double>(i) / kPoints);
        double passing = 0.0;
        for (std::size_t p = 0; p < phases.size(); ++p) passing += numbers[p] * partial_square(phases[p].sizes, d) / all;
        mixture.sieve.push_back({d, i == 0 ? 0.0 : i == kPoints ? 1.0 : std::min(passing, 1.0)});
    }
    for (std::size_t i = 1; i < mixture.sieve.size(); ++i)
        mixture.sieve[i].passing = std::max(mixture.sieve[i].passing, mixture.sieve[i - 1].passing);  // rounding
    return mixture;
}

}  // namespace feldspar
