#include "benchmarks/calibration.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace feldspar::benchmarks {
namespace {

// x <- x a + b with a < 1 tends to 1, so that it stays an ordinary number for ever.
constexpr double kFactor = 0.999, kSummand = 0.001;
constexpr int kRounds = 2000;      // between two looks at the clock: 1 to 10 us
constexpr int kAccumulators = 12;  // in flight at once: more than the units times their latency (2 x 4 on most)

/// What a loop returns, so that the compiler cannot drop it, and the floating-point operations that it made.
struct Done {
    double sum;
    double operations;
};

#if defined(__x86_64__)

// Each body is written for one vector width and called only where the machine has it; the rest of the program does not need it.
__attribute__((target("avx512f"))) Done rounds_512() {
    __m512d x[kAccumulators];
    const __m512d a = _mm512_set1_pd(kFactor), b = _mm512_set1_pd(kSummand);
    for (__m512d& value : x) value = _mm512_set1_pd(0.5);
    for (int round = 0; round < kRounds; ++round)
#pragma GCC unroll 12
        for (int i = 0; i < kAccumulators; ++i) x[i] = _mm512_fmadd_pd(x[i], a, b);
    __m512d sum = x[0];
    for (int i = 1; i < kAccumulators; ++i) sum = _mm512_add_pd(sum, x[i]);
    alignas(64) double lanes[8];
    _mm512_store_pd(lanes, sum);
    return {lanes[0] + lanes[7], 2.0 * 8 * kAccumulators * kRounds};
}

__attribute__((target("avx2,fma"))) Done rounds_256() {
    __m256d x[kAccumulators];
    const __m256d a = _mm256_set1_pd(kFactor), b = _mm256_set1_pd(kSummand);
    for (__m256d& value : x) value = _mm256_set1_pd(0.5);
    for (int round = 0; round < kRounds; ++round)
#pragma GCC unroll 12
        for (int i = 0; i < kAccumulators; ++i) x[i] = _mm256_fmadd_pd(x[i], a, b);
    __m256d sum = x[0];
    for (int i = 1; i < kAccumulators; ++i) sum = _mm256_add_pd(sum, x[i]);
    alignas(32) double lanes[4];
    _mm256_store_pd(lanes, sum);
    return {lanes[0] + lanes[3], 2.0 * 4 * kAccumulators * kRounds};
}

#endif

// Anywhere else: a product and a sum, two lanes an accumulator for the compiler to pair.
Done rounds_portable() {
    double x[2 * kAccumulators];
    for (double& value : x) value = 0.5;
    for (int round = 0; round < kRounds; ++round)
        for (double& value : x) value = value * kFactor + kSummand;
    double sum = 0.0;
    for (const double value : x) sum += value;
    return {sum, 2.0 * 2 * kAccumulators * kRounds};
}

using Rounds = Done (*)();

struct Choice {
    int bits;
    Rounds rounds;
};

Choice choose() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f")) return {512, rounds_512};
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return {256, rounds_256};
#endif
    return {128, rounds_portable};
}

// How many GFLOP/s `rounds` makes in about so many seconds.
double rate_of(Rounds rounds, double seconds) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    double operations = 0.0, elapsed = 0.0, sum = 0.0;
    do {
        const Done done = rounds();
        operations += done.operations;
        sum += done.sum;
        elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
    } while (elapsed < seconds);
    volatile double kept = sum;  // the results are used
    static_cast<void>(kept);
    return 1e-9 * operations / elapsed;
}

// Of the calling thread.
double thread_seconds() {
    std::timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

int vector_bits() { return choose().bits; }

double multiply_add_rate(double seconds) {
    const Rounds rounds = choose().rounds;
    rate_of(rounds, 0.1 * seconds);  // wide units wake up in some microseconds, which are not counted
    return rate_of(rounds, seconds);
}

double read_rate(double seconds) {
    constexpr std::size_t kNumbers = std::size_t{1} << 20, kPart = kNumbers / 64, kLanes = 16;
    thread_local const std::vector<double> numbers(kNumbers, 1.0);
    thread_local std::size_t place = 0;  // goes on where the last call ended
    double sums[kLanes] = {}, bytes = 0.0, elapsed = 0.0;
    const double begin = thread_seconds();
    do {
        for (std::size_t i = place; i < place + kPart; i += kLanes)
            for (std::size_t k = 0; k < kLanes; ++k) sums[k] += numbers[i + k];
        place = (place + kPart) % kNumbers;
        bytes += static_cast<double>(kPart * sizeof(double));
        elapsed = thread_seconds() - begin;
    } while (elapsed < seconds);
    double sum = 0.0;
    for (const double one : sums) sum += one;
    volatile double kept = sum;  // the results are used
    static_cast<void>(kept);
    return 1e-9 * bytes / elapsed;
}

Rates slowest_rates(Team& team, double seconds) {
    std::vector<Rates> rates(static_cast<std::size_t>(team.size()));
    team.run([&](int thread) {
        Rates& own = rates[static_cast<std::size_t>(thread)];
        team.barrier();
        own.memory = read_rate(0.5 * seconds);
        team.barrier();
        own.multiply_add = multiply_add_rate(0.5 * seconds);
    });
    Rates slowest = rates.front();
    for (const Rates& one : rates) {
        slowest.multiply_add = std::min(slowest.multiply_add, one.multiply_add);
        slowest.memory = std::min(slowest.memory, one.memory);
    }
    return slowest;
}

}  // namespace feldspar::benchmarks
