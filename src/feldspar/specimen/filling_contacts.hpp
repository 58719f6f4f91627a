// Which inner particles touch: inside a grain, across the edge of two grains, and along the outline.
#pragma once

#include <span>
#include <vector>

#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// (S9): discs of one grain whose Laguerre cells are neighbours are in contact if the gap between them is at most this share of
/// the diameter. With it the stiffness of Table 1 of the paper gives the paper's Young's modulus (docs/decisions: inner
/// particles).
constexpr double contact_gap = 0.30;

/// Pairs of discs of one grain in contact, by their numbers in the grain, ascending. Where these would leave a mechanism (discs
/// that hang on one contact, or pieces that turn against each other), the nearest pairs are added, so that the grain is rigid
/// when each contact holds its two discs together at one point, as a pin does.
std::vector<InsideContact> contacts_inside(std::span<const Vec2> centres, std::span<const double> radii_m, double diameter_m);

/// Fills `across` and `outline`.
/// @param rows  for each cell and each of its edges: the particles along it, from the edge's first vertex to its last
void join_grains(const Tessellation& cells, const std::vector<std::vector<std::vector<int>>>& rows, Filling& filling);

}  // namespace feldspar
