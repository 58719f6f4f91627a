// What is read of the record of a notched specimen that is bent, whatever its outline: stiffness, work of fracture, cracks
// (docs/theory/properties.md, (P40)).
#pragma once

#include <span>
#include <string_view>

#include "feldspar/methods/method.hpp"

namespace feldspar {

/// Of a row of the history, N.
double load_N(const MethodReading& reading, const HistoryRow& row);

/// Load over the reading of a gauge when the load first reaches half of its largest value, N/m; not-a-number without the gauge.
double secant_N_m(const MethodReading& reading, std::string_view gauge);

/// Work of the loading, its elastic start too, over the ligament (P40), J/m2; not-a-number of a record that ends above a tenth of
/// the largest load.
double work_of_fracture_J_m2(const MethodReading& reading, double ligament_m, double thickness_m);

/// E Gf / sigma_t^2 of the contacts, m: a toughness means something only where it is small beside notch and ligament.
/// Not-a-number of a law that does not soften.
/// @param E_Pa  of the specimen; where it is not a number that of the grains counts
double softening_length_m(const MethodReading& reading, double E_Pa);

/// Length of all cracks (their shares of grain edges), m.
double length_of_cracks_m(const MethodReading& reading);

/// Length of the shortest chain of cracks from a notch's tip, which may lie inside a grain that the crack goes around, to the
/// highest crack, m.
double main_crack_m(const MethodReading& reading, Vec2 tip);

/// Length (m) of the shortest chain of cracks from a notch's tip to the end of a crack that lies highest; gaps of up to a quarter
/// of a grain are bridged. 0 without cracks at the tip. Costs time with the square of the number of cracks. @param reach_m  how
/// near to the tip a chain may begin
double chain_of_cracks_m(std::span<const Crack> cracks, Vec2 tip, double grain_m, double reach_m);

}  // namespace feldspar
