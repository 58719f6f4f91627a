// Where to look next, and what is best by what is known.
#pragma once

#include <cstdint>
#include <vector>

#include "feldspar/calibration/learner.hpp"

namespace feldspar {

/// Points of the unit cube that fill it evenly: a Sobol sequence.
std::vector<std::vector<double>> evenly(std::size_t dimensions, std::size_t count, std::size_t skip = 0);

/// The parameters with the least expected misfit: what is well known goes before what is only guessed to be as good. Of about
/// equally good ones those nearest to `home`, where nothing else is said the middle of the ranges.
std::vector<double> best_point(const Learner& learner, std::size_t dimensions, std::vector<double> home = {});

/// Parameters where a run promises most: the largest expected improvement over the least expected misfit, one after the other,
/// each as if the ones before had been run. @param round  makes the candidates of each call different ones
std::vector<std::vector<double>> promising_points(Learner learner, std::size_t dimensions, std::size_t count, std::size_t round);

}  // namespace feldspar
