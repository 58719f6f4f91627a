#define FELDSPAR_LANES 2
#include "feldspar/fast/pack_kernels.hpp"

namespace feldspar {

const Kernels kernels_portable{"portable",  FELDSPAR_LANES, contacts,  grains,     rigid,
                               grain_lines, rigid_lines,    node_sums, unbalanced, energies};

}  // namespace feldspar
