#include "device_option.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "feldspar/base/error.hpp"
#include "feldspar/gpu/device.hpp"
#include "say.hpp"

namespace feldspar {

DeviceUse device_use(const std::string& wanted, Provenance& provenance) {
    if (wanted == "cpu") return {};
    DeviceProvenance card;
    try {
        card = card_here();
        provenance.device = fmt::format("{} (CUDA driver {}, compute capability {}, {} precision)", card.card, card.driver,
                                        card.capability, card.precision);
    } catch (const InputError& error) {
        if (wanted != "auto") throw;
        say(stderr, "the tests run on the processor: {}\n", error.problem());
        return {};
    }
    say(stderr, "the steps are made on {}\n", provenance.device);
    return {open_card, card.memory_bytes, wanted == "auto"};
}

}  // namespace feldspar
