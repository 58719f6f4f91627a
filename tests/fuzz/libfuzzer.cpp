// One target as a program of libFuzzer: FUZZ_TARGET is its name.
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace feldspar::fuzz {
void FUZZ_TARGET(std::string_view input);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    feldspar::fuzz::FUZZ_TARGET(std::string_view(reinterpret_cast<const char*>(data), size));
    return 0;
}
