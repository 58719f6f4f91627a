// How the threads of a program are shared between independent computations that run side by side. Whatever is chosen here, a
// result has the same bits; only the time differs.
#pragma once

#include <span>
#include <vector>

namespace feldspar {

/// Threads for the next computation to start.
/// @param free     threads that nobody has, at least 1
/// @param places   how many more may start now, at least 1, this one included
/// @param useful   more threads than this would only wait for each other
int share_for_next(int free, int places, int useful);

/// Hands `free` threads out to computations that run already, to those with the fewest first: when nothing is left to start,
/// these end sooner. @param threads  what each has  @param useful  what each can use  @return what each has then
std::vector<int> shares_with(int free, std::span<const int> threads, std::span<const int> useful);

}  // namespace feldspar
