// XXH3, 64 bits, of bytes as they come.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

struct XXH3_state_s;

namespace feldspar {

/// The checksum of all bytes that were added, in their order: the same as hash_of_bytes() of them in one piece.
class RunningHash {
public:
    RunningHash();

    void add(const void* data, std::size_t bytes);
    std::uint64_t digest() const;

private:
    struct Free {
        void operator()(XXH3_state_s* state) const;
    };
    std::unique_ptr<XXH3_state_s, Free> state_;
};

/// Of bytes in one piece.
std::uint64_t hash_of_bytes(const void* data, std::size_t bytes);

}  // namespace feldspar
