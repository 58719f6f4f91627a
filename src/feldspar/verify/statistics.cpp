// What is read of many numbers: strength envelopes, magnitudes and moments of acoustic events, fractal dimension.
#include <cmath>
#include <memory>
#include <numbers>

#include "feldspar/base/rng.hpp"
#include "feldspar/lab/acoustic_emission.hpp"
#include "feldspar/lab/strength_envelope.hpp"
#include "feldspar/verify/topics.hpp"

namespace feldspar {
namespace {

std::vector<CheckedValue> mohr_coulomb() {
    constexpr double c = 21e6;
    const double s = std::sin(53.0 * std::numbers::pi / 180.0), N = (1.0 + s) / (1.0 - s), ucs = 2.0 * c * std::sqrt(N);
    const EnvelopeFit fit = fit_envelopes({0.0, 4e6, 10e6}, {ucs, ucs + N * 4e6, ucs + N * 10e6});
    return {{"cohesion, MPa", 21.0, 1e-6 * fit.cohesion_Pa},
            {"friction angle, degrees", 53.0, fit.friction_angle_deg},
            {"UCS of the line, MPa", 1e-6 * ucs, 1e-6 * fit.UCS_fitted_Pa}};
}

std::vector<CheckedValue> hoek_brown() {
    constexpr double mi = 28.0, sci = 120e6;
    const std::vector<double> s3{0.0, 4e6, 10e6, 20e6};
    std::vector<double> s1;
    for (const double s : s3) s1.push_back(s + sci * std::sqrt(mi * s / sci + 1.0));
    const EnvelopeFit fit = fit_envelopes(s3, s1);
    return {{"mi", mi, fit.hoek_brown_mi}, {"sigma_ci, MPa", 120.0, 1e-6 * fit.hoek_brown_UCS_Pa}};
}

std::vector<CheckedValue> b_of_an_example() {
    const std::vector<double> m{2.0, 2.5, 2.1, 2.2, 2.5, 2.2, 2.6, 2.3, 2.7, 2.2, 2.4, 2.0,
                                2.7, 2.2, 2.3, 2.1, 2.4, 2.6, 2.2, 2.2, 2.7, 2.4, 2.2, 2.5};
    return {{"", 1.114920, b_value(m, 2.0, 0.1).b}};
}

std::vector<CheckedValue> b_of_many() {
    RandomStream random(11, "magnitudes");
    std::vector<double> m;
    for (int i = 0; i < 20000; ++i) m.push_back(-6.0 - std::log(1.0 - random.uniform()) / (1.3 * std::log(10.0)));
    return {{"", 1.3, b_value(m, -6.0).b}};
}

// A test of one crack with a normal along y, in a rock of 60 GPa and 0.25.
AcousticEvent event_of(Crack crack) {
    TestResult r;
    auto specimen = std::make_shared<Specimen>();
    specimen->quality.cell_sizes.mean_m = 0.003;
    r.specimen = specimen;
    r.grain = {60e9, 0.25, 2700.0};
    r.length_m = 0.15;
    r.travel_steps = 400.0;
    crack.step = 1;
    crack.area_m2 = 1e-4;
    crack.normal = {0.0, 1.0};
    r.cracks = {crack};
    return acoustic_emission(r).events.at(0);
}

constexpr double kG = 60e9 / 2.5, kLambda = 2.0 * kG * 0.25 / 0.75;  // plane stress

Crack with_energy(double energy_J) {
    Crack c;
    c.energy_J = energy_J;
    return c;
}

AcousticEvent opening() {
    Crack c = with_energy(1e-3);
    c.opening_m = 1e-6;
    return event_of(c);
}

AcousticEvent sliding() {
    Crack c = with_energy(1e-3);
    c.slip_m = -1e-6;
    return event_of(c);
}

std::vector<CheckedValue> moment_tensors() {
    const AcousticEvent open = opening(), slide = sliding();
    return {{"opens: across", 1e-4 * (kLambda + 2.0 * kG) * 1e-6, open.moment_Nm.yy},
            {"opens: along", 1e-4 * kLambda * 1e-6, open.moment_Nm.xx},
            {"slides: shear", 1e-4 * kG * 1e-6, slide.moment_Nm.xy},
            {"slides: across", 0.0, slide.moment_Nm.yy}};
}

std::vector<CheckedValue> isotropies() {
    return {{"opens", 100.0 * (2.0 * kLambda + 2.0 * kG) / (2.0 * kLambda + 4.0 * kG), opening().isotropy},
            {"slides", 0.0, sliding().isotropy}};
}

std::vector<CheckedValue> magnitudes() {
    return {{"energy of 2.4 mJ", 2.0 / 3.0 * (std::log10(2.4e-3) - 4.8), event_of(with_energy(2.4e-3)).magnitude},
            {"moment of 2.4 N m", 2.0 / 3.0 * std::log10(1e-4 * kG * 1e-6) - 6.07, sliding().moment_magnitude}};
}

std::vector<CheckedValue> dimensions() {
    RandomStream random(5, "places");
    std::vector<Vec2> plane, line;
    for (int i = 0; i < 5000; ++i) {
        plane.push_back({random.uniform(), random.uniform()});
        line.push_back({random.uniform(), 0.0});
    }
    return {{"in the plane", 2.0, correlation_dimension(plane)}, {"on a line", 1.0, correlation_dimension(line)}};
}

}  // namespace

std::vector<Check> statistics_checks() {
    return {
        {.name = "statistics.mohr-coulomb",
         .sentence = "Strengths on a line of Mohr and Coulomb give back its cohesion and its friction angle.",
         .formula = "sigma_1 = 2 c sqrt(N) + N sigma_3, N = (1 + sin phi) / (1 - sin phi)",
         .source = "(P12)",
         .bound = relative(1e-10),
         .reason = "rounding",
         .compare = mohr_coulomb},
        {.name = "statistics.hoek-brown",
         .sentence = "Strengths on a parabola of Hoek and Brown give back its mi and its uniaxial strength.",
         .formula = "sigma_1 = sigma_3 + sigma_ci sqrt(mi sigma_3 / sigma_ci + 1)",
         .source = "(P13)",
         .bound = relative(1e-10),
         .reason = "rounding",
         .compare = hoek_brown},
        {.name = "statistics.b-value",
         .sentence = "The b-value of 24 magnitudes in bins of 0.1 is that of the published example.",
         .formula = "b = ln(1 + dM / (mean M - M_c)) / (dM ln 10)",
         .source = "(P69); Tinti and Mulargia 1987; SeismoStats",
         .bound = absolute(1e-6),
         .reason = "the digits that are published",
         .compare = b_of_an_example},
        {.name = "statistics.b-value-of-many",
         .sentence = "The b-value of 20000 magnitudes that are drawn with a slope is that slope.",
         .formula = "b = log10(e) / (mean M - M_c)",
         .source = "(P69); Aki 1965",
         .bound = absolute(0.028),
         .reason = "three standard errors, b / sqrt(n) each",
         .compare = b_of_many},
        {.name = "statistics.magnitude",
         .sentence = "Magnitudes of energy and of moment are those of Gutenberg and Richter and of seismology.",
         .formula = "2/3 (log10 E - 4.8); 2/3 log10 M0 - 6.07",
         .source = "(P65), (P67)",
         .bound = absolute(1e-9),
         .reason = "rounding",
         .compare = magnitudes},
        {.name = "statistics.moment-tensor",
         .sentence = "A crack has the moment tensor of what it opens and slides.",
         .formula = "M = A (lambda (d . n) 1 + G (d n + n d))",
         .source = "(P66)",
         .unit = "N m",
         .bound = absolute(1e-9),
         .reason = "rounding of some N m",
         .compare = moment_tensors},
        {.name = "statistics.isotropy",
         .sentence = "A crack that opens is explosive, one that slides has no volume.",
         .formula = "R = 100 tr M / (|tr M| + sum |deviatoric eigenvalues|)",
         .source = "(P68); Feignier and Young 1992",
         .bound = absolute(1e-9),
         .reason = "rounding",
         .compare = isotropies},
        {.name = "statistics.fractal-dimension",
         .sentence = "Places at random in the plane have the dimension 2, on a line 1.",
         .formula = "C(r) ~ r^D",
         .source = "(P70)",
         .bound = absolute(0.25),
         .reason = "the edge takes some off",
         .compare = dimensions},
    };
}

}  // namespace feldspar
