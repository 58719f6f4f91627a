#include "feldspar/lab/stress_fields.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace feldspar {
namespace {

// From polar components at an angle to those along x and y.
Mat2 from_polar(double rr, double tt, double rt, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const double xx = c * c * rr + s * s * tt - 2.0 * c * s * rt, yy = s * s * rr + c * c * tt + 2.0 * c * s * rt;
    const double xy = c * s * (rr - tt) + (c * c - s * s) * rt;
    return {xx, xy, xy, yy};
}

// Airy's function f(r) cos n(angle - turn) with f = r^p + c r^-n + d r^(2 - n), r in radii: no traction at r = 1. For n = 1 the
// second of these is r^1, which has no stress. n = 0 is the field of an equal stress on all sides, f = r^2 / 2 - ln r.
StressField hole_field(double radius_m, int n, int p, double turn) {
    return [=](Vec2 place) {
        const double r = norm(place) / radius_m, angle = std::atan2(place.y, place.x);
        if (n == 0) return from_polar(1.0 - 1.0 / (r * r), 1.0 + 1.0 / (r * r), 0.0, angle);
        const double c = 0.5 * (p + n - 2), d = -1.0 - c;
        const double rp = std::pow(r, p - 2), rn = std::pow(r, -n - 2),
                     rd = std::pow(r, -n);  // powers over r^2, as stresses have them
        const double f = rp + c * rn + d * rd, slope = p * rp - n * c * rn + (2 - n) * d * rd;
        const double bend = p * (p - 1) * rp + n * (n + 1) * c * rn + (2 - n) * (1 - n) * d * rd;
        const double cosine = std::cos(n * (angle - turn)), sine = std::sin(n * (angle - turn));
        return from_polar((slope - n * n * f) * cosine, bend * cosine, n * (slope - f) * sine, angle);
    };
}

// The term of Williams' series that goes with r^(m / 2 - 1).
StressField tip_field(Vec2 ahead, double extent_m, int m, bool opens) {
    return [=](Vec2 place) {
        const double x = dot(place, ahead), y = dot(place, rot90(ahead)), angle = std::atan2(y, x), k = 0.5 * m - 1.0,
                     sign = m % 2 == 0 ? 1.0 : -1.0;
        // scaled so that the first has 1 / sqrt(2 pi r) ahead of the tip, the others are of its size at the extent
        const double size = std::pow(norm(place) / extent_m, k) / std::sqrt(2.0 * M_PI * extent_m);
        Mat2 s;
        if (opens) {
            s.xx = (2.0 + 0.5 * m + sign) * std::cos(k * angle) - k * std::cos((k - 2.0) * angle);
            s.yy = (2.0 - 0.5 * m - sign) * std::cos(k * angle) + k * std::cos((k - 2.0) * angle);
            s.xy = k * std::sin((k - 2.0) * angle) - (0.5 * m + sign) * std::sin(k * angle);
        } else {
            s.xx = (2.0 + 0.5 * m - sign) * std::sin(k * angle) - k * std::sin((k - 2.0) * angle);
            s.yy = (2.0 - 0.5 * m + sign) * std::sin(k * angle) + k * std::sin((k - 2.0) * angle);
            s.xy = (0.5 * m - sign) * std::cos(k * angle) - k * std::cos((k - 2.0) * angle);
        }
        const double factor = 0.5 * size;
        const double c = ahead.x, q = ahead.y, xx = factor * s.xx, yy = factor * s.yy, xy = factor * s.xy;
        const double turned_xy = c * q * (xx - yy) + (c * c - q * q) * xy;
        return Mat2{c * c * xx + q * q * yy - 2.0 * c * q * xy, turned_xy, turned_xy, q * q * xx + c * c * yy + 2.0 * c * q * xy};
    };
}

double product(const Mat2& l, const Mat2& r) { return l.xx * r.xx + l.xy * r.xy + l.yx * r.yx + l.yy * r.yy; }

}  // namespace

std::vector<StressField> fields_around_hole(double radius_m, bool uniform_only) {
    struct Term {
        int n, p;
    };
    constexpr Term uniform[] = {{2, 2}}, growing[] = {{1, 3}, {3, 3}, {2, 4}, {4, 4}};
    std::vector<StressField> fields = {hole_field(radius_m, 0, 2, 0.0)};
    const auto add = [&](const Term& term) {
        fields.push_back(hole_field(radius_m, term.n, term.p, 0.0));
        fields.push_back(hole_field(radius_m, term.n, term.p, 0.5 * M_PI / term.n));
    };
    for (const Term& term : uniform) add(term);
    if (uniform_only) return fields;
    for (const Term& term : growing) add(term);
    return fields;
}

std::vector<StressField> fields_around_tip(Vec2 ahead, double extent_m) {
    constexpr int terms = 6;
    std::vector<StressField> fields;
    for (int m = 1; m <= terms; ++m)
        for (const bool opens : {true, false})
            if (opens || m != 2)
                fields.push_back(tip_field(ahead, extent_m, m, opens));  // the second that shears is a rotation, without stress
    return fields;
}

std::vector<StressTerm> fitted_value(std::span<const StressSample> samples, std::span<const StressField> fields,
                                     std::span<const double> wanted) {
    struct Cell {
        std::int32_t cell;
        double area_m2;
        std::vector<Mat2> fields;
    };
    std::vector<Cell> cells;
    for (const StressSample& sample : samples) {
        if (cells.empty() || cells.back().cell != sample.cell)
            cells.push_back({sample.cell, 0.0, std::vector<Mat2>(fields.size())});
        Cell& cell = cells.back();
        cell.area_m2 += sample.area_m2;
        for (std::size_t k = 0; k < fields.size(); ++k) {
            const Mat2 s = fields[k](sample.at);
            Mat2& sum = cell.fields[k];
            sum = {sum.xx + sample.area_m2 * s.xx, sum.xy + sample.area_m2 * s.xy, sum.yx + sample.area_m2 * s.yx,
                   sum.yy + sample.area_m2 * s.yy};
        }
    }
    const auto size = static_cast<Eigen::Index>(fields.size());
    Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(size, size);
    for (const Cell& cell : cells)  // sums over the cell: mean times mean times area
        for (Eigen::Index k = 0; k < size; ++k)
            for (Eigen::Index l = 0; l < size; ++l) moments(k, l) += product(cell.fields[k], cell.fields[l]) / cell.area_m2;
    const Eigen::VectorXd scale = moments.diagonal().cwiseSqrt();
    if (!(scale.minCoeff() > 0.0)) return {};
    const Eigen::MatrixXd scaled = scale.cwiseInverse().asDiagonal() * moments * scale.cwiseInverse().asDiagonal();
    const Eigen::LDLT<Eigen::MatrixXd> solver(scaled);
    if (!(solver.rcond() > 1e-10)) return {};
    const Eigen::VectorXd value = Eigen::Map<const Eigen::VectorXd>(wanted.data(), size);
    const Eigen::VectorXd factors = scale.cwiseInverse().asDiagonal() * solver.solve(scale.cwiseInverse().asDiagonal() * value);
    std::vector<StressTerm> terms;
    for (const Cell& cell : cells) {
        Mat2 weight;
        for (Eigen::Index k = 0; k < size; ++k) {
            const Mat2& f = cell.fields[k];
            weight = {weight.xx + factors(k) * f.xx, weight.xy + factors(k) * f.xy, weight.yx + factors(k) * f.yx,
                      weight.yy + factors(k) * f.yy};
        }
        terms.push_back({cell.cell, weight});
    }
    return terms;
}

}  // namespace feldspar
