// Random numbers in named streams from one seed: adding a stream never changes the numbers of another.
#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <cstdint>
#include <string_view>

namespace feldspar {

/// One stream. The distributions come from Boost.Random, whose results are the same on every platform, unlike the standard's.
class RandomStream {
public:
    /// @param seed  the run's seed
    /// @param name  what the numbers are for, for example "grain sizes"
    RandomStream(std::uint64_t seed, std::string_view name);

    /// Uniform in [0, 1).
    double uniform();
    /// Uniform in [low, high).
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// Standard normal.
    double normal();
    /// Uniform integer in [0, count).
    std::uint64_t index(std::uint64_t count);

private:
    boost::random::mt19937_64 engine_;
};

}  // namespace feldspar
