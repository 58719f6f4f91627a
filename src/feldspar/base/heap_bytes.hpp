// How much memory the arrays of a structure hold, whichever it has: none that is added later is left out.
#pragma once

#include <array>
#include <type_traits>

#include "feldspar/base/members.hpp"

namespace feldspar {

namespace heap_detail {

template <class T>
struct IsArray : std::false_type {};
template <class T, std::size_t n>
struct IsArray<std::array<T, n>> : std::true_type {};

}  // namespace heap_detail

/// Bytes that vectors and strings in a plain structure, or in those that it is made of, have reserved.
template <class T>
double heap_bytes(const T& value) {
    if constexpr (std::is_trivially_copyable_v<T>)
        return 0.0;
    else if constexpr (requires {
                           value.capacity();
                           value.data();
                       }) {
        using Item = typename T::value_type;
        double sum = static_cast<double>(value.capacity() * sizeof(Item));
        if constexpr (!std::is_trivially_copyable_v<Item>)
            for (const Item& item : value) sum += heap_bytes(item);
        return sum;
    } else if constexpr (heap_detail::IsArray<T>::value) {
        double sum = 0.0;
        for (const auto& item : value) sum += heap_bytes(item);
        return sum;
    } else {
        return with_members(value, [](const auto&... member) { return (0.0 + ... + heap_bytes(member)); });
    }
}

}  // namespace feldspar
