// Discontinuities on the grain edges of a specimen: a joint runs along the edges that lie nearest to its trace, between the
// grains on its two sides.
#pragma once

#include <set>
#include <utility>
#include <vector>

#include "feldspar/model/heterogeneity_spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// The traces of a joint on a specimen: those given, or those of its set, drawn from the specimen's seed.
std::vector<std::vector<Vec2>> traces_of(const JointSpec& joint, const Specimen& specimen);

/// The edges of cells that a joint takes: between two cells whose centres lie on different sides of the trace, beside it and not
/// beyond its ends.
class JointEdges {
public:
    /// @throws InputError  no edge lies along a joint that is given by lines
    JointEdges(const Specimen& specimen, const JointSpec& joint);

    bool holds(int cell_a, int cell_b) const { return pairs_.count(std::minmax(cell_a, cell_b)) > 0; }

private:
    std::set<std::pair<int, int>> pairs_;
};

/// @throws InputError  a grain that joints without strength cut off from all its neighbours
void require_no_loose_grain(const Specimen& specimen, const std::vector<JointSpec>& joints,
                            const std::vector<const JointEdges*>& edges);

}  // namespace feldspar
