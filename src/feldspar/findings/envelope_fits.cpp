#include "feldspar/findings/envelope_fits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "feldspar/base/angle.hpp"
#include "feldspar/base/counted.hpp"
#include "feldspar/lab/strength_envelope.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/user_units.hpp"

namespace feldspar {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using BySeed = std::map<std::uint64_t, double>;

/// Strengths of the tests of a kind whose peak was reached. A packing tested twice in the same way counts once.
BySeed strengths_of(std::span<const TestResult> results, MethodId kind) {
    BySeed found;
    for (const TestResult& r : results)
        if (r.test.kind == kind && r.properties.peak_reached && std::isfinite(r.properties.peak_stress_Pa))
            found.emplace(r.seed, r.properties.peak_stress_Pa);
    return found;
}

std::vector<StrengthPoint> compression_points(std::span<const TestResult> results) {
    std::map<std::pair<std::uint64_t, double>, double> found;
    for (const TestResult& r : results) {
        if (!method_of(r.test).loading.on_envelope || !r.properties.peak_reached || !std::isfinite(r.properties.peak_stress_Pa))
            continue;
        found.emplace(std::pair(r.seed, r.test.sigma3_Pa), r.properties.peak_stress_Pa);
    }
    std::vector<StrengthPoint> points;
    for (const auto& [place, sigma1] : found) points.push_back({place.first, place.second, sigma1});
    return points;
}

template <class Curve>
Goodness goodness(std::span<const StrengthPoint> points, const Curve& curve) {
    if (points.size() < 3) return {nan, nan};
    double mean = 0.0, squares = 0.0, residuals = 0.0;
    for (const StrengthPoint& p : points) mean += p.sigma1_Pa / static_cast<double>(points.size());
    for (const StrengthPoint& p : points) {
        squares += (p.sigma1_Pa - mean) * (p.sigma1_Pa - mean);
        residuals += std::pow(p.sigma1_Pa - curve(p.sigma3_Pa), 2);
    }
    return {std::sqrt(residuals / static_cast<double>(points.size())), squares > 0.0 ? 1.0 - residuals / squares : nan};
}

std::vector<StrengthAt> by_stress(const std::vector<StrengthPoint>& points) {
    std::map<double, std::vector<double>> found;
    for (const StrengthPoint& p : points) found[p.sigma3_Pa].push_back(p.sigma1_Pa);
    std::vector<StrengthAt> strengths;
    for (const auto& [sigma3, values] : found) strengths.push_back({sigma3, mean_interval(values)});
    return strengths;
}

std::size_t stresses_of(std::span<const StrengthPoint> points) {
    std::set<double> found;
    for (const StrengthPoint& p : points) found.insert(p.sigma3_Pa);
    return found.size();
}

std::vector<CurvePair> fit_packings(const std::vector<StrengthPoint>& points, const BySeed& DTS, bool with_tension) {
    std::vector<CurvePair> fits;
    for (auto from = points.begin(); from != points.end();) {
        const auto to = std::find_if(from, points.end(), [&](const StrengthPoint& p) { return p.seed != from->seed; });
        const std::span<const StrengthPoint> own(from, to);
        if (own.size() >= 2) {
            const auto tension = DTS.find(from->seed);
            fits.push_back(
                fit_curves(own, with_tension && tension != DTS.end() ? std::vector{tension->second} : std::vector<double>{}));
        }
        from = to;
    }
    return fits;
}

std::vector<EnvelopeConstant> constants_of(const std::vector<CurvePair>& packings, const CurvePair& joint) {
    std::vector<EnvelopeConstant> constants;
    const auto add = [&](const char* property, const auto& read) {
        std::vector<double> values;
        for (const CurvePair& pair : packings)
            if (const double value = read(pair); std::isfinite(value)) values.push_back(value);
        constants.push_back({property, mean_interval(values), read(joint)});
    };
    add("cohesion_Pa", [](const CurvePair& c) { return c.fit.cohesion_Pa; });
    add("friction_angle_deg", [](const CurvePair& c) { return c.fit.friction_angle_deg; });
    add("mohr_coulomb_N", [](const CurvePair& c) { return c.N; });
    add("UCS_fitted_Pa", [](const CurvePair& c) { return c.fit.UCS_fitted_Pa; });
    add("mohr_coulomb_tension_Pa", [](const CurvePair& c) { return c.mohr_coulomb_tension_Pa; });
    add("hoek_brown_mi", [](const CurvePair& c) { return c.fit.hoek_brown_mi; });
    add("hoek_brown_UCS_Pa", [](const CurvePair& c) { return c.fit.hoek_brown_UCS_Pa; });
    add("hoek_brown_tension_Pa", [](const CurvePair& c) { return c.hoek_brown_tension_Pa; });
    return constants;
}

/// (P21)
double pooled_scatter(const std::vector<StrengthAt>& strengths) {
    double squares = 0.0;
    int freedom = 0;
    for (const StrengthAt& s : strengths) {
        if (s.sigma1_Pa.count < 2) continue;
        squares += s.sigma1_Pa.standard_deviation * s.sigma1_Pa.standard_deviation * (s.sigma1_Pa.count - 1);
        freedom += s.sigma1_Pa.count - 1;
    }
    return freedom > 0 ? std::sqrt(squares / freedom) : nan;
}

template <class Curve>
CurveJudgement judge_curve(const std::vector<StrengthAt>& strengths, const Curve& curve) {
    CurveJudgement judgement;
    double squares = 0.0;
    for (const StrengthAt& s : strengths) {
        const double predicted = curve(s.sigma3_Pa);
        squares += std::pow(s.sigma1_Pa.mean - predicted, 2);
        if (s.sigma1_Pa.count < 2) continue;
        ++judgement.judged;
        if (predicted >= s.sigma1_Pa.low && predicted <= s.sigma1_Pa.high) ++judgement.through;
    }
    judgement.misfit_Pa = strengths.size() > 2 ? std::sqrt(squares / static_cast<double>(strengths.size())) : nan;
    return judgement;
}

std::string misfits(const EnvelopeFits& fits) {
    return fmt::format("the mean strengths lie {:.3g} MPa (rms) from the line and {:.3g} MPa from the parabola",
                       fits.mohr_coulomb.misfit_Pa * MPa, fits.hoek_brown.misfit_Pa * MPa);
}

std::string verdict_of(const EnvelopeFits& fits) {
    if (fits.packings.empty()) return "No packing has strengths at two different confining stresses: there is nothing to fit.";
    if (fits.strengths.size() < 3)
        return "Two confining stresses determine a curve with two constants: line and parabola both go through them, and nothing "
               "can be said of their fit.";
    const CurveJudgement &line = fits.mohr_coulomb, &parabola = fits.hoek_brown;
    if (!std::isfinite(parabola.misfit_Pa))
        return "The parabola does not exist: the strengths do not grow as Hoek-Brown's do. See the line's residuals.";
    const bool line_is_better = line.misfit_Pa < parabola.misfit_Pa;
    const char* better = line_is_better ? "the Mohr-Coulomb line" : "the Hoek-Brown parabola";
    if (line.judged == 0)
        return fmt::format("One packing: {}; whether that is more than scatter, only further packings can tell.", misfits(fits));
    const bool line_fits = line.through == line.judged, parabola_fits = parabola.through == parabola.judged;
    const std::string scatter =
        fmt::format("{}; packings scatter by {:.3g} MPa (standard deviation)", misfits(fits), fits.scatter_Pa * MPa);
    if (line_fits && parabola_fits)
        return fmt::format("Both curves stay within the 95 % intervals of all {} mean strengths: {}.", line.judged, scatter);
    if (line_fits != parabola_fits)
        return fmt::format("{} stays within the 95 % intervals of all {} mean strengths, {} only within {}: {}.",
                           line_fits ? "The Mohr-Coulomb line" : "The Hoek-Brown parabola", line.judged,
                           line_fits ? "the Hoek-Brown parabola" : "the Mohr-Coulomb line",
                           line_fits ? parabola.through : line.through, scatter);
    return fmt::format(
        "Neither curve stays within the 95 % intervals of all {} mean strengths (line: {}, parabola: {}); {} is nearer: {}.",
        line.judged, line.through, parabola.through, better, scatter);
}

std::string method_of(const EnvelopeFits& fits) {
    if (fits.packings.empty()) return {};
    std::vector<double> confined;
    for (const StrengthAt& s : fits.strengths)
        if (s.sigma3_Pa > 0.0) confined.push_back(s.sigma3_Pa * MPa);
    const bool uniaxial = fits.strengths.front().sigma3_Pa == 0.0;
    return fmt::format(
        "Mohr-Coulomb (sigma_1 = UCS_fitted + N sigma_3) and Hoek-Brown (intact rock: s = 1, a = 0.5; linear in sigma_3 after "
        "squaring) by least squares on the "
        "{}biaxial tests at sigma_3 = {:g} MPa, sigma_3 from {:g} to {:g} MPa; {}. Fitted on each of {}, then mean and 95 % "
        "interval over "
        "packings by Student's distribution; the joint fit takes all {} strengths at once.",
        uniaxial ? "uniaxial and " : "", fmt::join(confined, ", "), fits.strengths.front().sigma3_Pa * MPa,
        fits.strengths.back().sigma3_Pa * MPa,
        fits.with_tension ? "the parabola also goes through the direct tensile strengths (sigma_3 = -DTS, sigma_1 = 0)"
                          : "no tensile points",
        counted(fits.packings.size(), "packing"), fits.points.size());
}

std::vector<double> values_of(const BySeed& strengths) {
    std::vector<double> values;
    for (const auto& [seed, value] : strengths) values.push_back(value);
    return values;
}

}  // namespace

double CurvePair::mohr_coulomb_at(double sigma3_Pa) const { return fit.UCS_fitted_Pa + N * sigma3_Pa; }

double CurvePair::hoek_brown_at(double sigma3_Pa) const {
    const double inside = fit.hoek_brown_mi * sigma3_Pa / fit.hoek_brown_UCS_Pa + 1.0;
    return inside >= 0.0 ? sigma3_Pa + fit.hoek_brown_UCS_Pa * std::sqrt(inside) : nan;
}

CurvePair fit_curves(std::span<const StrengthPoint> points, const std::vector<double>& DTS_Pa) {
    CurvePair pair;
    std::vector<double> sigma3, sigma1;
    for (const StrengthPoint& p : points) {
        sigma3.push_back(p.sigma3_Pa);
        sigma1.push_back(p.sigma1_Pa);
    }
    pair.fit = fit_envelopes(std::move(sigma3), std::move(sigma1), DTS_Pa);
    if (!points.empty()) pair.fit.seed = points.front().seed;
    const double sine = std::sin(in_radians(pair.fit.friction_angle_deg));
    pair.N = (1.0 + sine) / (1.0 - sine);
    // (P19)
    pair.mohr_coulomb_tension_Pa = pair.fit.UCS_fitted_Pa / pair.N;
    const double mi = pair.fit.hoek_brown_mi;
    pair.hoek_brown_tension_Pa = 0.5 * pair.fit.hoek_brown_UCS_Pa * (std::sqrt(mi * mi + 4.0) - mi);
    pair.mohr_coulomb = goodness(points, [&](double s) { return pair.mohr_coulomb_at(s); });
    pair.hoek_brown = goodness(points, [&](double s) { return pair.hoek_brown_at(s); });
    if (stresses_of(points) < 3)
        pair.mohr_coulomb.R2 = pair.hoek_brown.R2 = nan;  // a line through two mean strengths says nothing of lines
    return pair;
}

EnvelopeFits fit_series(std::span<const TestResult> results, bool with_tension) {
    EnvelopeFits fits;
    fits.with_tension = with_tension;
    fits.points = compression_points(results);
    fits.strengths = by_stress(fits.points);
    const BySeed UCS = strengths_of(results, method_of_strength("UCS")), DTS = strengths_of(results, method_of_strength("DTS")),
                 BTS = strengths_of(results, method_of_strength("BTS"));
    fits.UCS_measured = mean_interval(values_of(UCS));
    if (!DTS.empty()) fits.tension.push_back({"DTS_Pa", mean_interval(values_of(DTS))});
    if (!BTS.empty()) fits.tension.push_back({"BTS_Pa", mean_interval(values_of(BTS))});
    fits.packings = fit_packings(fits.points, DTS, with_tension);
    fits.joint = fit_curves(fits.points, with_tension ? values_of(DTS) : std::vector<double>{});
    fits.constants = constants_of(fits.packings, fits.joint);
    fits.scatter_Pa = pooled_scatter(fits.strengths);
    fits.mohr_coulomb = judge_curve(fits.strengths, [&](double s) { return fits.joint.mohr_coulomb_at(s); });
    fits.hoek_brown = judge_curve(fits.strengths, [&](double s) { return fits.joint.hoek_brown_at(s); });
    fits.method = method_of(fits);
    fits.verdict = verdict_of(fits);
    return fits;
}

}  // namespace feldspar
