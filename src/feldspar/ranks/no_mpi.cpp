// In the place of mpi.cpp where the program is built without MPI.
#include <fmt/format.h>

#include "feldspar/base/error.hpp"
#include "feldspar/ranks/communicator.hpp"

namespace feldspar {

bool built_with_mpi() { return false; }

std::unique_ptr<Communicator> communicator_here() {
    const int ranks = started_ranks();
    if (ranks == 1) return alone();
    throw InputError({.key = "mpirun"},
                     fmt::format("{} programs were started together, but this one was built without MPI", ranks),
                     "a program built with -DFELDSPAR_MPI=ON, or feldspar run without mpirun");
}

}  // namespace feldspar
