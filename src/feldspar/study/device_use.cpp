#include "feldspar/study/device_use.hpp"

#include <fmt/format.h>

#include "feldspar/base/error.hpp"
#include "feldspar/gpu/device.hpp"
#include "feldspar/lab/on_device.hpp"

namespace feldspar {

std::function<std::unique_ptr<StepDevice>()> opener_for(const TestSetup& setup, const DeviceUse& use,
                                                        const std::function<void(const std::string&)>& note) {
    if (!use.open) return {};
    const CardNeeds needs = card_needs(setup, {});
    std::string why = needs.not_ported;
    if (why.empty() && needs.bytes > use.memory_bytes)
        why = fmt::format("the test takes some {:.3g} MB of the card's memory, which has {:.3g} MB", needs.bytes / 1e6,
                          use.memory_bytes / 1e6);
    if (why.empty()) return use.open;
    if (!use.where_possible) throw InputError({.key = "--device"}, why, "cpu, or auto", "run this test on the processor");
    if (note) note("runs on the processor: " + why);
    return {};
}

}  // namespace feldspar
