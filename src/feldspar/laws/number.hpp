// What a law may ask of a number, so that its text stands once: a law is written over a number type, which is double in the
// readable stages and a vector of doubles in the kernels of fast/. The arithmetic, the comparisons and the conditional operator
// act lane by lane; what else is needed stands in NumberOf, which each type brings along.
//
// The functions are always inlined: code that is compiled for one instruction set must not be linked into another.
#pragma once

#include <cmath>
#include <type_traits>

#include "feldspar/base/device_code.hpp"

#if defined(__CUDACC__)
#define FELDSPAR_LAW __host__ __device__ __forceinline__
#else
#define FELDSPAR_LAW [[gnu::always_inline]] inline
#endif

namespace feldspar {

/// Operations that have another name for each number type.
template <class Real>
struct NumberOf;

template <>
struct NumberOf<double> {
    FELDSPAR_HD static double absolute(double v) { return std::abs(v); }
    FELDSPAR_HD static double square_root(double v) { return std::sqrt(v); }
    FELDSPAR_HD static bool any(bool mask) { return mask; }
};

/// Type of a comparison: bool, or a vector whose lanes have all bits set or none.
template <class Real>
using MaskOf = decltype(Real{} < Real{});

/// Of a mask what a condition leaves, be the condition one for all lanes or one a lane.
template <class Mask>
FELDSPAR_LAW Mask where(Mask mask, bool condition) {
    return condition ? mask : Mask{};
}
template <class Mask>
requires(!std::is_same_v<Mask, bool>) FELDSPAR_LAW Mask where(Mask mask, Mask condition) { return mask & condition; }

/// Whether a condition may hold: of one for all lanes itself, so that what hangs on it is left out; of one a lane always, as a
/// look would cost more.
FELDSPAR_LAW bool maybe(bool condition) { return condition; }
template <class Mask>
requires(!std::is_same_v<Mask, bool>) FELDSPAR_LAW bool maybe(Mask) { return true; }

/// The same value in all lanes.
template <class Real>
FELDSPAR_LAW Real number(double value) {
    return value - Real{};
}

template <class Real>
FELDSPAR_LAW Real larger(Real a, Real b) {
    return a > b ? a : b;
}
template <class Real>
FELDSPAR_LAW Real smaller(Real a, Real b) {
    return a < b ? a : b;
}

}  // namespace feldspar
