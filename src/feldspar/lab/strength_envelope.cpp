#include "feldspar/lab/strength_envelope.hpp"

#include <cmath>
#include <limits>

#include "feldspar/base/angle.hpp"
#include "feldspar/base/regression.hpp"

namespace feldspar {

namespace {

double root_of_slope(double friction_angle_deg) { return std::tan(in_radians(45.0 + 0.5 * friction_angle_deg)); }

}  // namespace

double mohr_coulomb_UCS_Pa(double cohesion_Pa, double friction_angle_deg) {
    return 2.0 * cohesion_Pa * root_of_slope(friction_angle_deg);
}

double mohr_coulomb_slope(double friction_angle_deg) {
    return root_of_slope(friction_angle_deg) * root_of_slope(friction_angle_deg);
}

EnvelopeFit fit_envelopes(std::vector<double> sigma3_Pa, std::vector<double> sigma1_Pa, const std::vector<double>& DTS_Pa) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EnvelopeFit fit;
    fit.cohesion_Pa = fit.friction_angle_deg = fit.UCS_fitted_Pa = nan;
    fit.hoek_brown_mi = fit.hoek_brown_UCS_Pa = fit.UCS_measured_Pa = nan;
    for (std::size_t i = 0; i < sigma3_Pa.size(); ++i) {
        if (sigma3_Pa[i] == 0.0) fit.UCS_measured_Pa = sigma1_Pa[i];
    }

    // (P12): sigma_1 = UCS_fitted + N sigma_3
    const Line line = regression_line(sigma3_Pa, sigma1_Pa);
    const double N = line.slope;
    fit.UCS_fitted_Pa = line.intercept;
    if (N > 0.0) {
        fit.friction_angle_deg = in_degrees(std::asin((N - 1.0) / (N + 1.0)));
        fit.cohesion_Pa = line.intercept / (2.0 * std::sqrt(N));
    }

    // (P13): (sigma_1 - sigma_3)^2 = mi sigma_ci sigma_3 + sigma_ci^2, a straight line in sigma_3
    std::vector<double> minor = sigma3_Pa, squares;
    for (std::size_t i = 0; i < sigma3_Pa.size(); ++i)
        squares.push_back((sigma1_Pa[i] - sigma3_Pa[i]) * (sigma1_Pa[i] - sigma3_Pa[i]));
    for (const double DTS : DTS_Pa) {
        minor.push_back(-DTS);
        squares.push_back(DTS * DTS);
    }
    const Line parabola = regression_line(minor, squares);
    if (parabola.intercept > 0.0) {
        fit.hoek_brown_UCS_Pa = std::sqrt(parabola.intercept);
        fit.hoek_brown_mi = parabola.slope / fit.hoek_brown_UCS_Pa;
    }
    fit.sigma3_Pa = std::move(sigma3_Pa);
    fit.sigma1_Pa = std::move(sigma1_Pa);
    return fit;
}

}  // namespace feldspar
