// Arrays that vector instructions stream through: a std::vector that begins on a cache line.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace feldspar {

template <class T>
struct CacheLineAllocator {
    using value_type = T;
    static constexpr std::align_val_t kAlignment{64};

    CacheLineAllocator() = default;
    template <class U>
    CacheLineAllocator(const CacheLineAllocator<U>&) {}

    T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kAlignment)); }
    void deallocate(T* p, std::size_t) { ::operator delete(p, kAlignment); }
    friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
};

template <class T>
using Array = std::vector<T, CacheLineAllocator<T>>;

}  // namespace feldspar
