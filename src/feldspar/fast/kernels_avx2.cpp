#define FELDSPAR_LANES 4
#include "feldspar/fast/pack_kernels.hpp"

namespace feldspar {

const Kernels kernels_avx2{"avx2",      FELDSPAR_LANES, contacts,  grains,     rigid,
                           grain_lines, rigid_lines,    node_sums, unbalanced, energies};

}  // namespace feldspar
