#include "feldspar/base/running_hash.hpp"

#include <xxhash.h>

#include <new>

namespace feldspar {

void RunningHash::Free::operator()(XXH3_state_s* state) const { XXH3_freeState(state); }

RunningHash::RunningHash() : state_(XXH3_createState()) {
    if (state_ == nullptr || XXH3_64bits_reset(state_.get()) != XXH_OK) throw std::bad_alloc();
}

void RunningHash::add(const void* data, std::size_t bytes) { XXH3_64bits_update(state_.get(), data, bytes); }

std::uint64_t RunningHash::digest() const { return XXH3_64bits_digest(state_.get()); }

std::uint64_t hash_of_bytes(const void* data, std::size_t bytes) { return XXH3_64bits(data, bytes); }

}  // namespace feldspar
