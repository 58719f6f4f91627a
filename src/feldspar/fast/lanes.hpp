// Vectors of as many doubles as one instruction takes, for the kernels of this room. Included only by pack_kernels.hpp, once for
// each instruction set, with FELDSPAR_LANES defined; everything has internal linkage, so that no code compiled for one
// instruction set can be linked into another.
#pragma once

#include <cstdint>

#include "feldspar/laws/number.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace feldspar {
namespace {

#define FELDSPAR_INLINE [[gnu::always_inline]] inline
#define FELDSPAR_LAMBDA __attribute__((always_inline))
#define FELDSPAR_APART [[gnu::noinline]]

constexpr int kWidth = FELDSPAR_LANES;

typedef double Real __attribute__((vector_size(8 * kWidth)));
typedef std::int64_t Mask __attribute__((vector_size(8 * kWidth)));  // all bits of a lane set or none
typedef double UnalignedReal __attribute__((vector_size(8 * kWidth), aligned(8)));
typedef double Quad __attribute__((vector_size(32)));
typedef double UnalignedQuad __attribute__((vector_size(32), aligned(8)));

FELDSPAR_INLINE Real all(double value) { return value - Real{}; }

FELDSPAR_INLINE Real load(const double* p) { return *reinterpret_cast<const UnalignedReal*>(p); }
FELDSPAR_INLINE void store(double* p, Real v) { *reinterpret_cast<UnalignedReal*>(p) = v; }

// The first `count` lanes; the others are 0.
FELDSPAR_INLINE Real load(const double* p, int count) {
    if (count == kWidth) return load(p);
    Real v{};
    for (int lane = 0; lane < count; ++lane) v[lane] = p[lane];
    return v;
}
FELDSPAR_INLINE void store(double* p, Real v, int count) {
    if (count == kWidth) return store(p, v);
    for (int lane = 0; lane < count; ++lane) p[lane] = v[lane];
}

FELDSPAR_INLINE Real absolute(Real v) { return reinterpret_cast<Real>(reinterpret_cast<Mask>(v) & INT64_MAX); }

FELDSPAR_INLINE Real square_root(Real v) {
#if defined(__AVX512F__) && FELDSPAR_LANES == 8
    return _mm512_sqrt_pd(v);
#elif defined(__AVX2__) && FELDSPAR_LANES == 4
    return _mm256_sqrt_pd(v);
#elif defined(__SSE2__) && FELDSPAR_LANES == 2
    return _mm_sqrt_pd(v);
#else
    for (int lane = 0; lane < kWidth; ++lane) v[lane] = __builtin_sqrt(v[lane]);
    return v;
#endif
}

// 1 / sqrt(v) and 1 / v, to rounding: where the processor has a first guess of 14 bits, by two steps of Newton, a third of the
// time of root and quotient.
FELDSPAR_INLINE Real inverse_root(Real v) {
#if defined(__AVX512F__) && FELDSPAR_LANES == 8
    Real y = _mm512_rsqrt14_pd(v);
    const Real half = 0.5 * v;
    Real missing = 0.5 - half * y * y;
    y += y * missing * (1.0 + 1.5 * missing);
    missing = 0.5 - half * y * y;
    return y + y * missing;
#else
    return 1.0 / square_root(v);
#endif
}
FELDSPAR_INLINE Real inverse_of(Real v) {
#if defined(__AVX512F__) && FELDSPAR_LANES == 8
    Real y = _mm512_rcp14_pd(v);
    y += y * (1.0 - v * y);
    return y + y * (1.0 - v * y);
#else
    return 1.0 / v;
#endif
}

// Keeps the compiler from moving what loads memory below this line to before the computation of v, which takes long.
FELDSPAR_INLINE void begin_now([[maybe_unused]] Real& v) {
#if defined(__AVX512F__) && FELDSPAR_LANES == 8
    asm volatile("" : "+v"(v) : : "memory");
#elif defined(__SSE2__) && FELDSPAR_LANES <= 4
    asm volatile("" : "+x"(v) : : "memory");
#endif
}

FELDSPAR_INLINE bool any(Mask m) {
#if defined(__AVX512DQ__) && FELDSPAR_LANES == 8
    return _mm512_movepi64_mask(reinterpret_cast<__m512i>(m)) != 0;
#elif defined(__AVX2__) && FELDSPAR_LANES == 4
    return _mm256_movemask_pd(reinterpret_cast<__m256d>(m)) != 0;
#elif defined(__SSE2__) && FELDSPAR_LANES == 2
    return _mm_movemask_pd(reinterpret_cast<__m128d>(m)) != 0;
#else
    std::int64_t bits = 0;
    for (int lane = 0; lane < kWidth; ++lane) bits |= m[lane];
    return bits != 0;
#endif
}

}  // namespace

/// A vector as the number type of a law.
template <>
struct NumberOf<Real> {
    FELDSPAR_INLINE static Real absolute(Real v) { return feldspar::absolute(v); }
    FELDSPAR_INLINE static Real square_root(Real v) { return feldspar::square_root(v); }
    FELDSPAR_INLINE static bool any(Mask m) { return feldspar::any(m); }
};

namespace {

// Stores the lanes of the mask among the first `count`, and leaves the memory of the others alone: another thread may be at it.
FELDSPAR_INLINE void store_where(double* p, Real v, Mask mask, int count) {
#if defined(__AVX512DQ__) && FELDSPAR_LANES == 8
    _mm512_mask_storeu_pd(p, static_cast<__mmask8>(_mm512_movepi64_mask(reinterpret_cast<__m512i>(mask)) & ((1U << count) - 1U)),
                          v);
#else
    for (int lane = 0; lane < count; ++lane)
        if (mask[lane]) p[lane] = v[lane];
#endif
}

// The lanes of the mask; the others are 0, and their memory is not looked at.
FELDSPAR_INLINE Real load_where(const double* p, Mask mask) {
#if defined(__AVX512DQ__) && FELDSPAR_LANES == 8
    return _mm512_maskz_loadu_pd(static_cast<__mmask8>(_mm512_movepi64_mask(reinterpret_cast<__m512i>(mask))), p);
#else
    Real v{};
    for (int lane = 0; lane < kWidth; ++lane)
        if (mask[lane]) v[lane] = p[lane];
    return v;
#endif
}

// Number of the lowest bit that is set.
FELDSPAR_INLINE int lowest_bit(unsigned bits) { return __builtin_ctz(bits); }

// Lanes whose bit is set.
FELDSPAR_INLINE Mask lanes_of(unsigned bits) {
    Mask m{};
    for (int lane = 0; lane < kWidth; ++lane) m[lane] = bits >> lane & 1U ? -1 : 0;
    return m;
}

struct Real2 {
    Real x, y;
};

// Points (x, y), (x, y), ... of consecutive lanes.
FELDSPAR_INLINE Real2 load_points(const double* p) {
    const Real a = load(p), b = load(p + kWidth);
#if FELDSPAR_LANES == 8
    return {__builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14), __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15)};
#elif FELDSPAR_LANES == 4
    return {__builtin_shufflevector(a, b, 0, 2, 4, 6), __builtin_shufflevector(a, b, 1, 3, 5, 7)};
#else
    return {__builtin_shufflevector(a, b, 0, 2), __builtin_shufflevector(a, b, 1, 3)};
#endif
}
FELDSPAR_INLINE void store_points(double* p, Real2 v) {
#if FELDSPAR_LANES == 8
    store(p, __builtin_shufflevector(v.x, v.y, 0, 8, 1, 9, 2, 10, 3, 11));
    store(p + kWidth, __builtin_shufflevector(v.x, v.y, 4, 12, 5, 13, 6, 14, 7, 15));
#elif FELDSPAR_LANES == 4
    store(p, __builtin_shufflevector(v.x, v.y, 0, 4, 1, 5));
    store(p + kWidth, __builtin_shufflevector(v.x, v.y, 2, 6, 3, 7));
#else
    store(p, __builtin_shufflevector(v.x, v.y, 0, 2));
    store(p + kWidth, __builtin_shufflevector(v.x, v.y, 1, 3));
#endif
}
FELDSPAR_INLINE Real2 load_points(const double* p, int count) {
    if (count == kWidth) return load_points(p);
    Real2 v{};
    for (int lane = 0; lane < count; ++lane) {
        v.x[lane] = p[2 * lane];
        v.y[lane] = p[2 * lane + 1];
    }
    return v;
}
FELDSPAR_INLINE void store_points(double* p, Real2 v, int count) {
    if (count == kWidth) return store_points(p, v);
    for (int lane = 0; lane < count; ++lane) {
        p[2 * lane] = v.x[lane];
        p[2 * lane + 1] = v.y[lane];
    }
}

// Each of kWidth values twice, in two vectors: for x and y.
FELDSPAR_INLINE void twice(Real v, Real& lower, Real& upper) {
#if FELDSPAR_LANES == 8
    lower = __builtin_shufflevector(v, v, 0, 0, 1, 1, 2, 2, 3, 3);
    upper = __builtin_shufflevector(v, v, 4, 4, 5, 5, 6, 6, 7, 7);
#elif FELDSPAR_LANES == 4
    lower = __builtin_shufflevector(v, v, 0, 0, 1, 1);
    upper = __builtin_shufflevector(v, v, 2, 2, 3, 3);
#else
    lower = __builtin_shufflevector(v, v, 0, 0);
    upper = __builtin_shufflevector(v, v, 1, 1);
#endif
}

// Four quantities of each lane, from four consecutive doubles of a line a lane: a transposition.
struct Real4 {
    Real q[4];
};

FELDSPAR_INLINE Quad load_quad(const double* p) { return *reinterpret_cast<const UnalignedQuad*>(p); }
FELDSPAR_INLINE void store_quad(double* p, Quad v) { *reinterpret_cast<UnalignedQuad*>(p) = v; }

#if FELDSPAR_LANES == 8
FELDSPAR_INLINE Real both(Quad lower, Quad upper) { return __builtin_shufflevector(lower, upper, 0, 1, 2, 3, 4, 5, 6, 7); }

FELDSPAR_INLINE Real4 load_quads(const double* const (&line)[kWidth]) {
    const Real r0 = both(load_quad(line[0]), load_quad(line[2])), r1 = both(load_quad(line[1]), load_quad(line[3]));
    const Real r2 = both(load_quad(line[4]), load_quad(line[6])), r3 = both(load_quad(line[5]), load_quad(line[7]));
    const Real t0 = __builtin_shufflevector(r0, r1, 0, 8, 2, 10, 4, 12, 6, 14),
               t1 = __builtin_shufflevector(r0, r1, 1, 9, 3, 11, 5, 13, 7, 15);
    const Real t2 = __builtin_shufflevector(r2, r3, 0, 8, 2, 10, 4, 12, 6, 14),
               t3 = __builtin_shufflevector(r2, r3, 1, 9, 3, 11, 5, 13, 7, 15);
    return {{__builtin_shufflevector(t0, t2, 0, 1, 4, 5, 8, 9, 12, 13), __builtin_shufflevector(t1, t3, 0, 1, 4, 5, 8, 9, 12, 13),
             __builtin_shufflevector(t0, t2, 2, 3, 6, 7, 10, 11, 14, 15),
             __builtin_shufflevector(t1, t3, 2, 3, 6, 7, 10, 11, 14, 15)}};
}

FELDSPAR_INLINE void store_quads(double* const (&line)[kWidth], const Real4& v) {
    const Real s0 = __builtin_shufflevector(v.q[0], v.q[1], 0, 8, 2, 10, 4, 12, 6, 14),
               s1 = __builtin_shufflevector(v.q[0], v.q[1], 1, 9, 3, 11, 5, 13, 7, 15);
    const Real s2 = __builtin_shufflevector(v.q[2], v.q[3], 0, 8, 2, 10, 4, 12, 6, 14),
               s3 = __builtin_shufflevector(v.q[2], v.q[3], 1, 9, 3, 11, 5, 13, 7, 15);
    const Real even_low = __builtin_shufflevector(s0, s2, 0, 1, 8, 9, 2, 3, 10, 11),
               even_high = __builtin_shufflevector(s0, s2, 4, 5, 12, 13, 6, 7, 14, 15);
    const Real odd_low = __builtin_shufflevector(s1, s3, 0, 1, 8, 9, 2, 3, 10, 11),
               odd_high = __builtin_shufflevector(s1, s3, 4, 5, 12, 13, 6, 7, 14, 15);
    const auto split = [](double* first, double* second, Real r) {
        store_quad(first, _mm512_castpd512_pd256(r));
        store_quad(second, _mm512_extractf64x4_pd(r, 1));
    };
    split(line[0], line[2], even_low);
    split(line[4], line[6], even_high);
    split(line[1], line[3], odd_low);
    split(line[5], line[7], odd_high);
}
#elif FELDSPAR_LANES == 4
FELDSPAR_INLINE Real4 transposed(Real r0, Real r1, Real r2, Real r3) {
    const Real t0 = __builtin_shufflevector(r0, r1, 0, 4, 2, 6), t1 = __builtin_shufflevector(r0, r1, 1, 5, 3, 7);
    const Real t2 = __builtin_shufflevector(r2, r3, 0, 4, 2, 6), t3 = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);
    return {{__builtin_shufflevector(t0, t2, 0, 1, 4, 5), __builtin_shufflevector(t1, t3, 0, 1, 4, 5),
             __builtin_shufflevector(t0, t2, 2, 3, 6, 7), __builtin_shufflevector(t1, t3, 2, 3, 6, 7)}};
}
FELDSPAR_INLINE Real4 load_quads(const double* const (&line)[kWidth]) {
    return transposed(load_quad(line[0]), load_quad(line[1]), load_quad(line[2]), load_quad(line[3]));
}
FELDSPAR_INLINE void store_quads(double* const (&line)[kWidth], const Real4& v) {
    const Real4 t = transposed(v.q[0], v.q[1], v.q[2], v.q[3]);
    for (int lane = 0; lane < kWidth; ++lane) store_quad(line[lane], t.q[lane]);
}
#else
FELDSPAR_INLINE Real4 load_quads(const double* const (&line)[kWidth]) {
    const Real a = load(line[0]), b = load(line[1]), c = load(line[0] + 2), d = load(line[1] + 2);
    return {{__builtin_shufflevector(a, b, 0, 2), __builtin_shufflevector(a, b, 1, 3), __builtin_shufflevector(c, d, 0, 2),
             __builtin_shufflevector(c, d, 1, 3)}};
}
FELDSPAR_INLINE void store_quads(double* const (&line)[kWidth], const Real4& v) {
    for (int half = 0; half < 2; ++half) {
        store(line[0] + 2 * half, __builtin_shufflevector(v.q[2 * half], v.q[2 * half + 1], 0, 2));
        store(line[1] + 2 * half, __builtin_shufflevector(v.q[2 * half], v.q[2 * half + 1], 1, 3));
    }
}
#endif

}  // namespace
}  // namespace feldspar
