#include <cstdlib>
#include <utility>

#include "feldspar/ranks/communicator.hpp"

namespace feldspar {
namespace {

// How many, and which: Open MPI; MPICH and Intel MPI; MVAPICH.
constexpr std::pair<const char*, const char*> kNames[] = {
    {"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"}, {"PMI_SIZE", "PMI_RANK"}, {"MV2_COMM_WORLD_SIZE", "MV2_COMM_WORLD_RANK"}};

int number(const char* name) {
    const char* text = std::getenv(name);
    return text == nullptr ? 0 : std::atoi(text);
}

}  // namespace

int started_ranks() {
    for (const auto& [size, rank] : kNames)
        if (number(size) > 1) return number(size);
    return 1;
}

int started_rank() {
    for (const auto& [size, rank] : kNames)
        if (number(size) > 1) return number(rank);
    return 0;
}

}  // namespace feldspar
