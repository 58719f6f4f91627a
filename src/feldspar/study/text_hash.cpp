#include "feldspar/study/text_hash.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstdint>

namespace feldspar {

std::string hash_of_text(const std::string& text) {
    const XXH128_hash_t value = XXH3_128bits(text.data(), text.size());
    return fmt::format("{:016x}{:016x}", static_cast<std::uint64_t>(value.high64), static_cast<std::uint64_t>(value.low64));
}

}  // namespace feldspar
