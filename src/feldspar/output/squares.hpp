// A large specimen in squares, for pictures: no screen shows a million grains, and no browser draws them. Internal to this room.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// A result with squares in the place of grains. Each is two triangles, of one stress and one damage: the means over what lies
/// in it, weighted by area. Its corners move as the mean of what lies in the squares around them.
struct Squares {
    TestResult
        result;  ///< mesh, snapshots, minerals (in each square that with the largest area) and cracks; no contacts, no cells
    double side_m = 0.0;
    double grains_in_one = 0.0;        ///< mean number
    std::size_t crack_every = 1;       ///< so many cracks of the test stand for one here
    std::vector<int> square_of_crack;  ///< of those that are here; -1: in none
};

/// The most cracks that a picture has.
inline constexpr std::size_t most_cracks_drawn = 40'000;
/// How many cracks of a test stand for one that is drawn, at least 1.
constexpr std::size_t cracks_for_one(std::size_t cracks) {
    return std::max<std::size_t>(1, (cracks + most_cracks_drawn - 1) / most_cracks_drawn);
}

/// @param result  with a specimen, and snapshots of its mesh
/// @param count   of squares that would cover the specimen's area, at least 1
Squares in_squares(const TestResult& result, std::size_t count);

}  // namespace feldspar
