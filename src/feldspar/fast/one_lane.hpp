// The vectors of lanes.hpp with a single lane: a thread of a device is a lane of a pack (gpu/). Included only by
// pack_kernels.hpp.
#pragma once

#include <cstdint>

#include "feldspar/laws/number.hpp"

namespace feldspar {
namespace {

#if defined(__CUDACC__)
#define FELDSPAR_INLINE FELDSPAR_HD __forceinline__
#define FELDSPAR_LAMBDA
#else
#define FELDSPAR_INLINE [[gnu::always_inline]] inline
#define FELDSPAR_LAMBDA __attribute__((always_inline))
#endif
#define FELDSPAR_APART FELDSPAR_INLINE

constexpr int kWidth = 1;

struct Mask {
    bool set = false;

    Mask() = default;
    FELDSPAR_INLINE explicit Mask(bool is_set) : set(is_set) {}
    FELDSPAR_INLINE explicit operator bool() const { return set; }
    FELDSPAR_INLINE bool operator[](int) const { return set; }
    FELDSPAR_INLINE friend Mask operator&(Mask a, Mask b) { return Mask(a.set && b.set); }
    FELDSPAR_INLINE friend Mask operator|(Mask a, Mask b) { return Mask(a.set || b.set); }
    FELDSPAR_INLINE friend Mask operator~(Mask a) { return Mask(!a.set); }
};

struct Real {
    double v = 0.0;

    Real() = default;
    FELDSPAR_INLINE Real(double value) : v(value) {}
    FELDSPAR_INLINE double& operator[](int) { return v; }
    FELDSPAR_INLINE double operator[](int) const { return v; }
    FELDSPAR_INLINE Real& operator+=(Real o) {
        v += o.v;
        return *this;
    }
    FELDSPAR_INLINE Real& operator-=(Real o) {
        v -= o.v;
        return *this;
    }
    FELDSPAR_INLINE Real& operator*=(Real o) {
        v *= o.v;
        return *this;
    }
    FELDSPAR_INLINE friend Real operator-(Real a) { return -a.v; }
    FELDSPAR_INLINE friend Real operator+(Real a, Real b) { return a.v + b.v; }
    FELDSPAR_INLINE friend Real operator-(Real a, Real b) { return a.v - b.v; }
    FELDSPAR_INLINE friend Real operator*(Real a, Real b) { return a.v * b.v; }
    FELDSPAR_INLINE friend Real operator/(Real a, Real b) { return a.v / b.v; }
    FELDSPAR_INLINE friend Mask operator<(Real a, Real b) { return Mask(a.v < b.v); }
    FELDSPAR_INLINE friend Mask operator>(Real a, Real b) { return Mask(a.v > b.v); }
    FELDSPAR_INLINE friend Mask operator<=(Real a, Real b) { return Mask(a.v <= b.v); }
    FELDSPAR_INLINE friend Mask operator>=(Real a, Real b) { return Mask(a.v >= b.v); }
    FELDSPAR_INLINE friend Mask operator==(Real a, Real b) { return Mask(a.v == b.v); }
    FELDSPAR_INLINE friend Mask operator!=(Real a, Real b) { return Mask(a.v != b.v); }
};

FELDSPAR_INLINE Real all(double value) { return value; }
FELDSPAR_INLINE Real load(const double* p) { return *p; }
FELDSPAR_INLINE void store(double* p, Real v) { *p = v.v; }
FELDSPAR_INLINE Real load(const double* p, int) { return *p; }
FELDSPAR_INLINE void store(double* p, Real v, int) { *p = v.v; }
FELDSPAR_INLINE Real absolute(Real v) { return std::abs(v.v); }
FELDSPAR_INLINE Real square_root(Real v) { return std::sqrt(v.v); }
FELDSPAR_INLINE Real inverse_root(Real v) { return 1.0 / std::sqrt(v.v); }
FELDSPAR_INLINE Real inverse_of(Real v) { return 1.0 / v.v; }
FELDSPAR_INLINE void begin_now(Real&) {}
FELDSPAR_INLINE bool any(Mask m) { return m.set; }
FELDSPAR_INLINE void store_where(double* p, Real v, Mask mask, int) {
    if (mask.set) *p = v.v;
}
FELDSPAR_INLINE Real load_where(const double* p, Mask mask) { return mask.set ? Real(*p) : Real{}; }
FELDSPAR_INLINE int lowest_bit(unsigned) { return 0; }  // a single lane reads for itself
FELDSPAR_INLINE Mask lanes_of(unsigned bits) { return Mask((bits & 1U) != 0); }

}  // namespace

template <>
struct NumberOf<Real> {
    FELDSPAR_INLINE static Real absolute(Real v) { return feldspar::absolute(v); }
    FELDSPAR_INLINE static Real square_root(Real v) { return feldspar::square_root(v); }
    FELDSPAR_INLINE static bool any(Mask m) { return m.set; }
};

namespace {

struct Real2 {
    Real x, y;
};

// Points stand on 16 bytes, lines on 64: a thread loads and stores 16 bytes at once.
FELDSPAR_INLINE Real2 load_points(const double* p) {
#if defined(__CUDA_ARCH__)
    const double2 v = *reinterpret_cast<const double2*>(p);
    return {v.x, v.y};
#else
    return {p[0], p[1]};
#endif
}
FELDSPAR_INLINE void store_points(double* p, Real2 v) {
#if defined(__CUDA_ARCH__)
    *reinterpret_cast<double2*>(p) = double2{v.x.v, v.y.v};
#else
    p[0] = v.x.v;
    p[1] = v.y.v;
#endif
}
FELDSPAR_INLINE Real2 load_points(const double* p, int) { return load_points(p); }
FELDSPAR_INLINE void store_points(double* p, Real2 v, int) { store_points(p, v); }

struct Real4 {
    Real q[4];
};

FELDSPAR_INLINE Real4 load_quads(double* const (&line)[kWidth]) {
    const Real2 lower = load_points(line[0]), upper = load_points(line[0] + 2);
    return {{lower.x, lower.y, upper.x, upper.y}};
}
FELDSPAR_INLINE void store_quads(double* const (&line)[kWidth], const Real4& v) {
    store_points(line[0], {v.q[0], v.q[1]});
    store_points(line[0] + 2, {v.q[2], v.q[3]});
}

}  // namespace
}  // namespace feldspar
