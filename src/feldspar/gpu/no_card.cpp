// In a program that was built without support for cards.
#include "feldspar/base/error.hpp"
#include "feldspar/gpu/backend.hpp"

namespace feldspar {

bool built_for_cards() { return false; }

std::unique_ptr<Backend> cuda_backend(DeviceProvenance&) {
    throw InputError({.key = "--device"}, "this program was built without support for graphics cards", "cpu, or auto",
                     "build it with -DFELDSPAR_CUDA=ON, which needs the CUDA toolkit");
}

}  // namespace feldspar
