// Plane vectors and 2 x 2 matrices as plain values: no hidden state, no allocation.
#pragma once

#include <cmath>

#include "feldspar/base/device_code.hpp"

namespace feldspar {

/// A plane vector; the unit is that of the quantity it holds.
struct Vec2 {
    double x = 0.0;
    double y = 0.0;

    constexpr Vec2& operator+=(Vec2 o) {
        x += o.x;
        y += o.y;
        return *this;
    }
    constexpr Vec2& operator-=(Vec2 o) {
        x -= o.x;
        y -= o.y;
        return *this;
    }
    constexpr Vec2& operator*=(double s) {
        x *= s;
        y *= s;
        return *this;
    }
    friend constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
    friend constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
    friend constexpr Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
    friend constexpr Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
    friend constexpr Vec2 operator*(Vec2 a, double s) { return {s * a.x, s * a.y}; }
    friend constexpr bool operator==(Vec2 a, Vec2 b) = default;
};

constexpr double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }

/// The out-of-plane component of a x b: twice the signed area of the triangle (0, a, b).
constexpr double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

/// a turned by +90 degrees.
constexpr Vec2 rot90(Vec2 a) { return {-a.y, a.x}; }

FELDSPAR_HD inline double norm(Vec2 a) { return std::sqrt(dot(a, a)); }

/// a turned counter-clockwise by an angle, rad.
FELDSPAR_HD inline Vec2 turned(Vec2 a, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * a.x - s * a.y, s * a.x + c * a.y};
}

/// A 2 x 2 matrix, row by row.
struct Mat2 {
    double xx = 0.0, xy = 0.0;
    double yx = 0.0, yy = 0.0;

    friend constexpr Vec2 operator*(const Mat2& m, Vec2 a) { return {m.xx * a.x + m.xy * a.y, m.yx * a.x + m.yy * a.y}; }
};

}  // namespace feldspar
