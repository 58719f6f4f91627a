// Sorting of things that carry a number of a grain, a vertex or a body: in time that grows with how many they are, and no faster.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace feldspar {

/// As std::stable_sort, which takes memory of its own also for a few.
template <class Iterator, class Less>
void sort_few(Iterator begin, Iterator end, const Less& less) {
    constexpr std::ptrdiff_t few = 32;
    if (end - begin > few) return std::stable_sort(begin, end, less);
    for (Iterator next = begin + 1; next < end; ++next)
        for (Iterator at = next; at != begin && less(*at, *(at - 1)); --at) std::iter_swap(at, at - 1);
}

/// Sorts by a number that few items share, and items of one number by `less`: the order of std::stable_sort by both, without its
/// logarithm, and without the square that std::sort may come near to where items are nearly in order.
/// @param numbers  how many there are
/// @param number   of an item: from 0 to below `numbers`
/// @return begin of each number's items, and the end of the last: numbers + 1
template <class Item, class Number, class Less>
std::vector<std::size_t> sort_in_buckets(std::vector<Item>& items, std::size_t numbers, const Number& number, const Less& less) {
    std::vector<std::size_t> begin(numbers + 1, 0);
    for (const Item& item : items) ++begin[static_cast<std::size_t>(number(item)) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Item> sorted(items.size());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (Item& item : items) sorted[next[static_cast<std::size_t>(number(item))]++] = std::move(item);
    items = std::move(sorted);
    const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    for (std::size_t n = 0; n < numbers; ++n)
        if (begin[n + 1] - begin[n] > 1) sort_few(at(begin[n]), at(begin[n + 1]), less);
    return begin;
}

}  // namespace feldspar
