#include "feldspar/base/rng.hpp"

#include <array>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/seed_seq.hpp>
#include <boost/random/uniform_01.hpp>
#include <boost/random/uniform_int_distribution.hpp>

namespace feldspar {

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) {
    // The name enters through its FNV-1a hash: fixed by its letters alone, unlike std::hash.
    std::uint64_t hash = 14695981039346656037ULL;
    for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 1099511628211ULL;
    const std::array<std::uint32_t, 4> words = {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                                                static_cast<std::uint32_t>(hash), static_cast<std::uint32_t>(hash >> 32)};
    boost::random::seed_seq sequence(words.begin(), words.end());
    engine_.seed(sequence);
}

double RandomStream::uniform() { return boost::random::uniform_01<double>()(engine_); }
double RandomStream::normal() { return boost::random::normal_distribution<double>()(engine_); }
std::uint64_t RandomStream::index(std::uint64_t count) {
    return boost::random::uniform_int_distribution<std::uint64_t>(0, count - 1)(engine_);
}

}  // namespace feldspar
